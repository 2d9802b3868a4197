//! Ctrl-C and SIGTERM: the half-written folders of this process are removed before it ends.

use super::mark;
use crate::error::{Error, Result};
use crate::machine::memory::clean_up_at_the_end_of_memory;
use crate::machine::output::say;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

static STOPPED: AtomicBool = AtomicBool::new(false);
/// The temporary folders that exist now.
static LIVE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Whether the user has asked this process to stop.
pub fn interrupted() -> bool {
    STOPPED.load(Ordering::SeqCst)
}

/// From now on Ctrl-C and SIGTERM (and a closed terminal) remove this process's temporary folders and end it
/// with the exit code of [`Error::Interrupted`] and a line on standard error; so does the end of memory, with its own.
/// For the command line's `main`; to be called once.
///
/// What this process was started to ignore (`nohup`, `trap '' HUP`) it goes on ignoring.
///
/// # Errors
/// `Machine` if there is no thread to be had for it.
pub fn handle_interrupts() -> Result<()> {
    let ignored = signals::ignored();
    let watched = ctrlc::set_handler(stop);
    ignored.into_iter().for_each(signals::ignore);
    clean_up_at_the_end_of_memory(remove_what_can_be);
    watched.map_err(|e| Error::machine("the watch for Ctrl-C", io::Error::other(e)))
}

#[cfg(unix)]
mod signals {
    /// Those of the signals that end this process which it ignores now.
    pub fn ignored() -> Vec<i32> {
        let is_ignored = |signal: &i32| {
            let mut now = std::mem::MaybeUninit::<libc::sigaction>::zeroed();
            // SAFETY: nothing is changed, and what is asked for is written where there is room for it.
            let asked = unsafe { libc::sigaction(*signal, std::ptr::null(), now.as_mut_ptr()) };
            // SAFETY: all zeros are one of its values, too.
            asked == 0 && unsafe { now.assume_init() }.sa_sigaction == libc::SIG_IGN
        };
        [libc::SIGHUP, libc::SIGINT, libc::SIGTERM].into_iter().filter(is_ignored).collect()
    }

    pub fn ignore(signal: i32) {
        // SAFETY: no handler is named.
        unsafe { libc::signal(signal, libc::SIG_IGN) };
    }
}

#[cfg(not(unix))]
mod signals {
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

fn lock() -> MutexGuard<'static, Vec<PathBuf>> {
    LIVE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Makes a temporary folder and registers it: the process is not stopped between the two.
pub(super) fn create_dir(folder: &Path) -> io::Result<()> {
    let mut live = lock();
    fs::create_dir(folder)?;
    live.push(folder.to_path_buf());
    Ok(())
}

pub(super) fn register(folder: &Path) {
    lock().push(folder.to_path_buf());
}

/// Forgets a temporary folder, which stays.
pub(super) fn forget(folder: &Path) {
    lock().retain(|other| other != folder);
}

/// Removes a temporary folder and forgets it.
pub(super) fn discard(folder: &Path) {
    let mut live = lock();
    remove(folder);
    live.retain(|other| other != folder);
}

/// Runs `step` whole: the process is not stopped in its middle, and it is not begun once the process is
/// stopping.
pub(super) fn undisturbed<T>(step: impl FnOnce() -> Result<T>) -> Result<T> {
    let _live = lock();
    if interrupted() { Err(Error::Interrupted) } else { step() }
}

/// Removes a folder or a file, as far as that is possible; what stays is swept by a later bake. Another thread may be
/// adding files at this moment, so one failure is not the end.
pub(super) fn remove(folder: &Path) {
    for _ in 0..5 {
        let file = fs::symlink_metadata(folder).is_ok_and(|m| !m.is_dir());
        let removed = if file { fs::remove_file(folder) } else { remove_marked(folder) };
        if removed.is_ok() || !folder.exists() {
            return;
        }
    }
}

/// The mark goes last: killed in the middle, this leaves what a later bake still knows.
fn remove_marked(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        match entry.file_type()?.is_dir() {
            true => fs::remove_dir_all(entry.path())?,
            false if entry.file_name() == mark::MARK => {}
            false => fs::remove_file(entry.path())?,
        }
    }
    fs::remove_dir_all(folder)
}
