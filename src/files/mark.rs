//! The mark by which a bake knows the folders that bakes write into: a file in it, locked for as long as its process
//! lives. A name alone is no mark: what a user calls `.earth.tmp-x` is the user's.

use super::bounded_read;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

/// The file in a marked folder.
pub(super) const MARK: &str = ".tyndall";

/// What stands in it, and nothing else.
const TEXT: &str =
    "tyndall writes a bake in this folder. Once that process is dead, the next bake removes it.\n";

/// Marks a new folder as this process's, until the file that is returned is closed: the kernel does that when the
/// process dies, however it dies. Where the system has no locks, nobody ever takes the owner for dead.
pub(super) fn put(folder: &Path) -> io::Result<File> {
    let mut file = File::options().read(true).write(true).create_new(true).open(folder.join(MARK))?;
    // Before the text: who finds the whole text finds the lock, too.
    let _ = file.lock();
    file.write_all(TEXT.as_bytes())?;
    Ok(file)
}

/// The lock of a marked folder whose process is dead; none of any other folder, or of what is no folder.
pub(super) fn take_dead(folder: &Path) -> Option<File> {
    let mark = folder.join(MARK);
    let kind = |path: &Path| fs::symlink_metadata(path).ok().map(|m| m.file_type());
    if !kind(folder)?.is_dir() || !kind(&mark)?.is_file() {
        return None;
    }
    let file = bounded_read::regular(&mark, File::options().read(true).write(true)).ok()?;
    file.try_lock().ok()?;
    let mut text = String::new();
    (&file).take(TEXT.len() as u64 + 1).read_to_string(&mut text).ok()?;
    (text == TEXT).then_some(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only the whole mark of a process that is gone counts: not that of a living one, another text, or none.
    #[test]
    fn the_mark_of_the_dead() {
        let dir = tempfile::tempdir().unwrap();
        assert!(take_dead(dir.path()).is_none());
        let alive = put(dir.path()).unwrap();
        assert!(take_dead(dir.path()).is_none());
        drop(alive);
        assert!(take_dead(dir.path()).is_some());
        for text in ["", "mine", &TEXT[1..], &format!("{TEXT}\n")] {
            fs::write(dir.path().join(MARK), text).unwrap();
            assert!(take_dead(dir.path()).is_none(), "{text:?}");
        }
        fs::remove_file(dir.path().join(MARK)).unwrap();
        fs::create_dir(dir.path().join(MARK)).unwrap();
        assert!(take_dead(dir.path()).is_none() && take_dead(&dir.path().join(MARK)).is_none());
    }
}
