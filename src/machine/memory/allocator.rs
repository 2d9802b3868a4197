//! The end of memory: a line and an exit code, where Rust's own end is an abort.

use crate::machine::output;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The system's allocator for programs, which ends the process as a failure of the machine where there is no more.
pub struct Allocator;

// SAFETY: every call goes to the system's allocator, whose answers are handed on as they are, or never.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        had(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        had(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, block: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        had(unsafe { System.realloc(block, layout, size) }, size)
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        unsafe { System.dealloc(block, layout) }
    }
}

#[inline]
fn had(block: *mut u8, size: usize) -> *mut u8 {
    if block.is_null() {
        end(size);
    }
    block
}

/// What is still done before the process ends.
static CLEAN_UP: OnceLock<fn()> = OnceLock::new();

/// Has `clean_up` called where the end of memory ends the process. The first call counts.
pub fn clean_up_at_the_end_of_memory(clean_up: fn()) {
    let _ = CLEAN_UP.set(clean_up);
}

/// Whether some thread is ending the process.
static ENDING: AtomicBool = AtomicBool::new(false);

thread_local! {
    /// Whether it is this one.
    static HERE: Cell<bool> = const { Cell::new(false) };
}

#[cold]
#[inline(never)]
fn end(size: usize) -> ! {
    if HERE.replace(true) {
        // Not even the end can be had.
        std::process::abort();
    }
    while ENDING.swap(true, Ordering::SeqCst) {
        std::thread::sleep(Duration::from_secs(1));
    }
    output::say_without_memory(format_args!("error: memory: {size} bytes more cannot be had"));
    if let Some(clean_up) = CLEAN_UP.get() {
        clean_up();
    }
    std::process::exit(3);
}
