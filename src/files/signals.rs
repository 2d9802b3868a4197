//! What ends the program early: Ctrl-C, SIGTERM, a closed terminal, the end of memory.

use super::interrupt::{LIVE, STOPPED, lock, remove};
use crate::error::{Error, Result};
use crate::machine::memory::clean_up_at_the_end_of_memory;
use crate::machine::output::say;
use std::io;
use std::sync::atomic::Ordering;

/// From now on Ctrl-C and SIGTERM (and a closed terminal) remove this process's temporary folders and end it
/// with the exit code of [`Error::Interrupted`] and a line on standard error; so does the end of memory, with its own.
/// For the command line's `main`; to be called once.
///
/// What this process was started to ignore (`nohup`, `trap '' HUP`) it goes on ignoring.
///
/// # Errors
/// `Machine` if there is no thread to be had for it.
pub fn handle_interrupts() -> Result<()> {
    let ignored = disposition::ignored();
    let watched = ctrlc::set_handler(stop);
    ignored.into_iter().for_each(disposition::ignore);
    clean_up_at_the_end_of_memory(remove_what_can_be);
    watched.map_err(|e| Error::machine("the watch for Ctrl-C", io::Error::other(e)))
}

#[cfg(unix)]
mod disposition {
    /// Those of the signals that end this process which it ignores now.
    pub(super) fn ignored() -> Vec<i32> {
        let is_ignored = |signal: &i32| {
            let mut now = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
            // SAFETY: nothing is changed, and what is asked for is written where there is room for it.
            let asked = unsafe { libc::sigaction(*signal, std::ptr::null(), now.as_mut_ptr()) };
            // SAFETY: all zeros are one of its values, too.
            asked == 0 && unsafe { now.assume_init() }.sa_sigaction == libc::SIG_IGN
        };
        [libc::SIGHUP, libc::SIGINT, libc::SIGTERM].into_iter().filter(is_ignored).collect()
    }

    pub(super) fn ignore(signal: i32) {
        // SAFETY: no handler is named.
        unsafe { libc::signal(signal, libc::SIG_IGN) };
    }
}

#[cfg(not(unix))]
mod disposition {
    pub fn ignored() -> Vec<i32> {
        Vec::new()
    }

    pub fn ignore(_: i32) {}
}

/// Removes the temporary folders of this process as far as that is possible now, without waiting for another thread.
fn remove_what_can_be() {
    STOPPED.store(true, Ordering::SeqCst);
    if let Ok(live) = LIVE.try_lock() {
        live.iter().for_each(|folder| remove(folder));
    }
}

/// Runs on a thread of its own. The lock is kept to the end, so that no commit can begin any more, and one
/// that has begun is waited for.
fn stop() {
    STOPPED.store(true, Ordering::SeqCst);
    let live = lock();
    live.iter().for_each(|folder| remove(folder));
    say(&format!("tyndall: {}", Error::Interrupted));
    std::process::exit(i32::from(Error::Interrupted.exit_code()));
}
