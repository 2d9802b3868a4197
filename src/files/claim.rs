//! Who of several processes bakes a folder: a lock file beside it, `.NAME.lock`, held by the one at work. The kernel
//! lets go of the lock when its process dies, however it dies, so that nothing waits for the dead.

use super::bounded_read;
use super::interrupt::{self, interrupted};
use crate::error::{Error, Result};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The right to bake a folder, until it is dropped.
pub struct Claim {
    path: PathBuf,
    _file: File,
}

/// What stands in a lock file that this program made. One without it, which somebody else made, serves as well, and
/// stays.
const TEXT: &str = "tyndall bakes the folder of this name\n";

impl Claim {
    /// The claim of `target`, which need not exist; none while another process has it.
    ///
    /// # Errors
    /// `Machine` if the lock file cannot be made, `File` if something that is no file stands in its place.
    pub fn try_take(target: &Path) -> Result<Option<Claim>> {
        let path = beside(target)?;
        loop {
            let file = match open(&path) {
                // It was taken away in this moment.
                Err(e) if e.kind() == ErrorKind::NotFound && fs::symlink_metadata(&path).is_err() => continue,
                opened => opened.map_err(|e| unusable(&path, e))?,
            };
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => return Ok(None),
                Err(TryLockError::Error(e)) => return Err(Error::machine(&path, e)),
            }
            // Whoever had it took the file away in the moment before it was locked here.
            if is_still(&file, &path) {
                if is_ours(&path) {
                    interrupt::register(&path);
                }
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
        match is_ours(&self.path) {
            true => interrupt::discard(&self.path),
            false => interrupt::forget(&self.path),
        }
    }
}

/// The lock file, made where there is none; what stands in it already is left as it is.
fn open(path: &Path) -> io::Result<File> {
    match File::options().write(true).create_new(true).open(path) {
        Ok(mut file) => {
            let written = file.write_all(TEXT.as_bytes());
            written.inspect_err(|_| drop(fs::remove_file(path))).map(|()| file)
        }
        Err(e) if e.kind() == ErrorKind::AlreadyExists => {
            bounded_read::regular(path, File::options().write(true))
        }
        Err(e) => Err(e),
    }
}

/// What stands in its place is the user's to mend, the rest the machine's.
fn unusable(path: &Path, e: io::Error) -> Error {
    match e.kind() {
        ErrorKind::NotFound | ErrorKind::InvalidData | ErrorKind::IsADirectory => Error::file(path, e),
        _ => Error::machine(path, e),
    }
}

/// Whether a lock file is one that this program made: no link, and no file of another content.
fn is_ours(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_file())
        && bounded_read::named_text(path, TEXT.len() as u64).is_ok_and(|text| text == TEXT)
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

    /// A file or a link of the lock's name serves as a lock and is as it was afterwards, and so is what the link leads to.
    #[cfg(unix)]
    #[test]
    fn what_others_have_in_its_place() {
        let dir = tempfile::tempdir().unwrap();
        let [lock, thesis, target] = [".phobos.lock", "thesis.txt", "phobos"].map(|n| dir.path().join(n));
        fs::write(&thesis, "years").unwrap();
        for link in [true, false] {
            match link {
                true => std::os::unix::fs::symlink(&thesis, &lock).unwrap(),
                false => fs::write(&lock, "mine").unwrap(),
            }
            let held = Claim::take(&target).unwrap();
            assert!(Claim::try_take(&target).unwrap().is_none());
            drop(held);
            assert_eq!(fs::read_to_string(&thesis).unwrap(), "years");
            assert_eq!(fs::read_to_string(&lock).unwrap(), if link { "years" } else { "mine" });
            fs::remove_file(&lock).unwrap();
        }
    }

    /// A folder, a pipe or a link to nothing in its place is refused at once.
    #[cfg(unix)]
    #[test]
    fn what_is_no_file_is_refused() {
        let dir = tempfile::tempdir().unwrap();
        let [lock, target] = [".phobos.lock", "phobos"].map(|n| dir.path().join(n));
        let refused = || {
            let error = Claim::take(&target).err().expect("refused");
            assert!(error.exit_code() == 2 && error.to_string().contains(".phobos.lock"), "{error}");
        };
        fs::create_dir(&lock).unwrap();
        refused();
        fs::remove_dir(&lock).unwrap();
        std::os::unix::fs::symlink("nothing", &lock).unwrap();
        refused();
        fs::remove_file(&lock).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&lock).status().unwrap().success());
        refused();
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
