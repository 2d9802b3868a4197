//! A new folder in the place of an old one, with no moment at which neither stands there where the operating
//! system allows it (Linux, macOS), and as short a moment as possible elsewhere.

use super::foreign::carry;
use super::in_place;
use super::sweep::in_between;
use crate::error::{Error, Result};
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The file that makes a folder a bake.
pub const MANIFEST: &str = "bake.json";

/// Other processes may replace the same folder in the same moment; each round lost means one of theirs won.
const ROUNDS: usize = 1000;

/// Whether a bake may take the place of `target`: there is nothing, or an empty folder, or another bake.
///
/// # Errors
/// `File` if something else stands there; it is left alone.
pub fn check_replaceable(target: &Path) -> Result<()> {
    // A folder that another process moves away and removes in this moment looks strange half-way: only what
    // looks the same for a while is refused.
    for look in 0..MOST_LOOKS {
        if looks_replaceable(target)? {
            return Ok(());
        }
        if look >= LOOKS && !in_between(target) {
            break;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Err(Error::file(target, format!("not replaced: the folder is not empty and not a bake (no {MANIFEST})")))
}

const LOOKS: usize = 250;
/// Where another bake says that it is at it.
const MOST_LOOKS: usize = 5000;

fn looks_replaceable(target: &Path) -> Result<bool> {
    match fs::read_dir(target) {
        Ok(mut entries) => Ok(target.join(MANIFEST).is_file() || entries.next().is_none()),
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(true),
        Err(e) if e.kind() == ErrorKind::NotADirectory => {
            Err(Error::file(target, "there is a file where the folder of the bake should be"))
        }
        Err(e) => Err(Error::machine(target, e)),
    }
}

/// How a folder takes the place of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// Both change places in one step.
    Exchange,
    /// The old one is moved aside first: for a moment nothing stands there.
    Aside,
    /// File by file, for a folder that cannot be moved.
    InPlace,
}

/// Moves the folder `new` to `target`, in that `way` or, where the system cannot, the next of [`Way`]. Returns where the
/// folder that stood there before is now, or a copy of its bake, to be removed by the caller. `aside` is a free name.
pub fn replace(new: &Path, target: &Path, aside: &Path, mut way: Way) -> Result<Option<PathBuf>> {
    for _ in 0..ROUNDS {
        check_replaceable(target)?;
        let step = if fs::symlink_metadata(target).is_err() {
            fs::rename(new, target).map(|()| None)
        } else {
            match way {
                Way::Exchange => swap(new, target).map(|()| Some(new.to_path_buf())),
                Way::Aside => move_aside(new, target, aside).map(|()| Some(aside.to_path_buf())),
                Way::InPlace => in_place::put(new, target, aside).map(|()| {
                    // Its files are in the target now.
                    let _ = fs::remove_dir_all(new);
                    Some(aside.to_path_buf())
                }),
            }
        };
        match step {
            Ok(old) => return Ok(old),
            Err(e) if way == Way::Exchange && (unsupported(&e) || immovable(&e)) => way = Way::Aside,
            Err(e) if way == Way::Aside && immovable(&e) => way = Way::InPlace,
            // Another process put its folder there, or took it away, since we looked.
            Err(e) if raced(&e) && new.exists() => {}
            Err(e) => return Err(Error::machine(target, e)),
        }
    }
    Err(Error::machine(target, io::Error::other("other processes keep replacing this folder")))
}

fn move_aside(new: &Path, target: &Path, aside: &Path) -> io::Result<()> {
    fs::rename(target, aside)?;
    fs::rename(new, target).inspect_err(|_| {
        // Back to where it was; if another bake stands there by now, the older one has no place any more, but what in
        // it is not the bake's.
        if fs::rename(aside, target).is_err() && target.exists() && carry(aside, target).is_ok() {
            super::interrupt::remove(aside);
        }
    })
}

fn raced(e: &io::Error) -> bool {
    matches!(e.kind(), ErrorKind::NotFound | ErrorKind::DirectoryNotEmpty | ErrorKind::AlreadyExists)
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn swap(a: &Path, b: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE).map_err(io::Error::from)
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
fn swap(_: &Path, _: &Path) -> io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

/// A folder from under an overlay filesystem, or one that is a mount.
fn immovable(e: &io::Error) -> bool {
    matches!(e.kind(), ErrorKind::CrossesDevices | ErrorKind::ResourceBusy)
}

/// Filesystems that cannot exchange say so in several ways.
fn unsupported(e: &io::Error) -> bool {
    matches!(e.kind(), ErrorKind::Unsupported | ErrorKind::InvalidInput)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bake(folder: &Path, text: &str) {
        fs::create_dir(folder).unwrap();
        fs::write(folder.join(MANIFEST), text).unwrap();
    }

    /// In every way, the new folder ends in the place of the old one, and the
    /// old one is handed back whole.
    #[test]
    fn the_old_folder_is_handed_back_whole() {
        for way in [Way::Exchange, Way::Aside, Way::InPlace] {
            let dir = tempfile::tempdir().unwrap();
            let [new, target, aside] = ["new", "target", "aside"].map(|n| dir.path().join(n));
            bake(&new, "new");
            bake(&target, "old");
            let old = replace(&new, &target, &aside, way).unwrap().unwrap();
            assert_eq!(fs::read_to_string(target.join(MANIFEST)).unwrap(), "new");
            assert_eq!(fs::read_to_string(old.join(MANIFEST)).unwrap(), "old");
        }
    }

    /// Four threads replace one folder thirty times each, by moving the old one aside or file by file: every call ends,
    /// and what stands there at the end, and each old folder handed back, is whole.
    #[test]
    fn racing_without_an_exchange_loses_no_folder_half_way() {
        [Way::Aside, Way::InPlace].into_iter().for_each(race);
    }

    fn race(way: Way) {
        let dir = tempfile::tempdir().unwrap();
        let target = &dir.path().join("target");
        std::thread::scope(|scope| {
            for worker in 0..4 {
                let [new, aside] = ["new", "aside"].map(|n| dir.path().join(format!("{n}{worker}")));
                scope.spawn(move || {
                    for round in 0..30 {
                        bake(&new, &format!("{worker} {round}"));
                        if let Some(old) = replace(&new, target, &aside, way).unwrap() {
                            assert!(old.join(MANIFEST).is_file());
                            fs::remove_dir_all(old).unwrap();
                        }
                    }
                });
            }
        });
        assert!(fs::read_to_string(target.join(MANIFEST)).unwrap().ends_with(" 29"));
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    /// Where nothing stands, or an empty folder, there is no old bake to hand back or it is empty.
    #[test]
    fn an_empty_place_is_taken() {
        let dir = tempfile::tempdir().unwrap();
        let [new, target, aside] = ["new", "target", "aside"].map(|n| dir.path().join(n));
        bake(&new, "one");
        assert_eq!(replace(&new, &target, &aside, Way::Exchange).unwrap(), None);
        fs::remove_dir_all(&target).unwrap();
        fs::create_dir(&target).unwrap();
        bake(&new, "two");
        let old = replace(&new, &target, &aside, Way::Exchange).unwrap().unwrap();
        assert_eq!(fs::read_dir(old).unwrap().count(), 0);
        assert_eq!(fs::read_to_string(target.join(MANIFEST)).unwrap(), "two");
    }

    /// A folder with files but no manifest belongs to someone else.
    #[test]
    fn what_is_no_bake_is_left_alone() {
        let dir = tempfile::tempdir().unwrap();
        fs::write(dir.path().join("thesis.txt"), "years").unwrap();
        assert_eq!(check_replaceable(dir.path()).unwrap_err().exit_code(), 2);
        assert_eq!(check_replaceable(&dir.path().join("thesis.txt")).unwrap_err().exit_code(), 2);
        assert!(check_replaceable(&dir.path().join("nothing")).is_ok());
    }
}
