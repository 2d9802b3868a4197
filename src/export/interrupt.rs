//! Ctrl-C and SIGTERM: the half-written folders of this process are removed before it ends.

use crate::error::{Error, Result};
use std::fs;
use std::io::{self, Write};
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
/// with the exit code of [`Error::Interrupted`]. For the command line's `main`; to be called once.
pub fn handle_interrupts() -> Result<()> {
    ctrlc::set_handler(stop).map_err(|e| Error::Argument(format!("cannot watch for Ctrl-C: {e}")))
}

/// Runs on a thread of its own. The lock is kept to the end, so that no commit can begin any more, and one
/// that has begun is waited for.
fn stop() {
    STOPPED.store(true, Ordering::SeqCst);
    let live = lock();
    live.iter().for_each(|folder| remove(folder));
    // Not eprintln, which panics where stderr is gone with its terminal: the process would then run on.
    let _ = writeln!(std::io::stderr(), "tyndall: {}", Error::Interrupted);
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
        let removed = if file { fs::remove_file(folder) } else { fs::remove_dir_all(folder) };
        if removed.is_ok() || !folder.exists() {
            return;
        }
    }
}
