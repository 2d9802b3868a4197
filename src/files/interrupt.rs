//! The half-written folders of this process, which are removed before it ends.

use super::mark;
use crate::error::{Error, Result};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

pub(super) static STOPPED: AtomicBool = AtomicBool::new(false);
/// The temporary folders that exist now.
pub(super) static LIVE: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Whether the user has asked this process to stop.
pub fn interrupted() -> bool {
    STOPPED.load(Ordering::SeqCst)
}

pub(super) fn lock() -> MutexGuard<'static, Vec<PathBuf>> {
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
