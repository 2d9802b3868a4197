//! Who of several processes bakes a folder: a lock file beside it, `.NAME.lock`, held by the one at work. The kernel
//! lets go of the lock when its process dies, however it dies, so that nothing waits for the dead.

use super::interrupt::{self, interrupted};
use crate::error::{Error, Result};
use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The right to bake a folder, until it is dropped.
pub struct Claim {
    path: PathBuf,
    _file: File,
}

impl Claim {
    /// The claim of `target`, which need not exist; none while another process has it.
    ///
    /// # Errors
    /// `Machine` if the lock file cannot be made.
    pub fn try_take(target: &Path) -> Result<Option<Claim>> {
        let path = beside(target)?;
        loop {
            // What stands there is not emptied: it might be a link to somebody's file.
            let mut open = File::options();
            let file = open.write(true).create(true).truncate(false).open(&path);
            let file = file.map_err(|e| Error::machine(&path, e))?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(e)) => return Err(Error::machine(&path, e)),
            }
            // Whoever had it took the file away in the moment before it was locked here.
            if is_still(&file, &path) {
                interrupt::register(&path);
                return Ok(Some(Claim { path, _file: file }));
            }
        }
    }

    /// The claim of `target`, once the process that has it is done.
    ///
    /// # Errors
    /// As [`Claim::try_take`], and `Interrupted`.
    pub fn take(target: &Path) -> Result<Claim> {
        loop {
            if let Some(claim) = Claim::try_take(target)? {
                return Ok(claim);
            }
            if interrupted() {
                return Err(Error::Interrupted);
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        interrupt::discard(&self.path);
    }
}

fn beside(target: &Path) -> Result<PathBuf> {
    let name = target.file_name().ok_or_else(|| {
        Error::Argument(format!("{}: not a name for the folder of a bake", target.display()))
    })?;
    let parent = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(|e| Error::machine(parent, e))?;
    Ok(parent.join(format!(".{}.lock", name.to_string_lossy())))
}

#[cfg(unix)]
fn is_still(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    match (file.metadata(), fs::metadata(path)) {
        (Ok(held), Ok(there)) => (held.dev(), held.ino()) == (there.dev(), there.ino()),
        _ => false,
    }
}

/// A file that is open cannot be taken away there.
#[cfg(not(unix))]
fn is_still(_: &File, _: &Path) -> bool {
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

    /// A link of the lock's name is gone afterwards, and the file it led to is as it was.
    #[cfg(unix)]
    #[test]
    fn a_link_in_its_place() {
        let dir = tempfile::tempdir().unwrap();
        let thesis = dir.path().join("thesis.txt");
        fs::write(&thesis, "years").unwrap();
        std::os::unix::fs::symlink(&thesis, dir.path().join(".phobos.lock")).unwrap();
        drop(Claim::take(&dir.path().join("phobos")).unwrap());
        assert_eq!(fs::read_to_string(&thesis).unwrap(), "years");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    /// One has it at a time, however many want it, each gets it, and nothing is left.
    #[test]
    fn one_at_a_time() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("phobos");
        let (inside, done) = (AtomicUsize::new(0), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..20 {
                        let claim = loop {
                            if let Some(claim) = Claim::try_take(&target).unwrap() {
                                break claim;
                            }
                            std::thread::yield_now();
                        };
                        assert_eq!(inside.fetch_add(1, SeqCst), 0);
                        done.fetch_add(1, SeqCst);
                        inside.fetch_sub(1, SeqCst);
                        drop(claim);
                    }
                });
            }
        });
        assert_eq!(done.into_inner(), 80);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
        let held = Claim::take(&target).unwrap();
        assert!(Claim::try_take(&target).unwrap().is_none());
        drop(held);
        assert!(Claim::try_take(&target).unwrap().is_some());
    }
}
