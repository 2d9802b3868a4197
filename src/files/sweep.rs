//! What bakes leave beside a folder when they are killed: found by its mark and removed, and a bake that was moved aside
//! in that moment is put back.

use super::foreign::carry;
use super::replace::MANIFEST;
use super::staging::{NEW, OLD};
use super::{in_place, interrupt, mark};
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::{Path, PathBuf};

/// How the names of folders begin in which bakes of `target` are written: `.earth.tmp-` for `earth`.
pub(super) fn prefix(target: &Path) -> OsString {
    let mut name = OsString::from(".");
    name.push(target.file_name().unwrap_or(OsStr::new("bake")));
    name.push(".tmp-");
    name
}

/// Folders beside `target` with such a name, whoever made them.
fn beside(target: &Path) -> Vec<PathBuf> {
    let parent = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let start = prefix(target);
    let begins = |path: &PathBuf| {
        path.file_name().is_some_and(|n| n.as_encoded_bytes().starts_with(start.as_encoded_bytes()))
    };
    let entries = fs::read_dir(parent).into_iter().flatten().flatten();
    entries.map(|entry| entry.path()).filter(begins).collect()
}

/// Removes the folders of dead bakes of `target`, as far as that is possible.
pub(super) fn sweep(target: &Path) {
    for folder in beside(target) {
        let Some(_lock) = mark::take_dead(&folder) else { continue };
        if nothing_lost(&folder, target) {
            interrupt::remove(&folder);
        }
    }
}

/// Whether some bake of `target` has moved the old one aside and not yet put its own in the place: for a moment there is
/// no bake, where the system cannot exchange two folders.
pub(super) fn in_between(target: &Path) -> bool {
    beside(target).iter().any(|folder| folder.join(mark::MARK).is_file() && folder.join(OLD).is_dir())
}

/// Brings back what a dead bake had taken out of the place of `target`; whether nothing of it is left to be kept.
fn nothing_lost(folder: &Path, target: &Path) -> bool {
    let (new, old) = (folder.join(NEW), folder.join(OLD));
    if old.is_dir() && !target.join(MANIFEST).is_file() {
        let whole = old.join(MANIFEST).is_file();
        if whole && fs::rename(&old, target).is_ok() {
            return true;
        }
        // Not where another bake has come between.
        if !target.join(MANIFEST).is_file() && in_place::back(&new, target, &old).is_err() {
            return false;
        }
    }
    if !target.join(MANIFEST).is_file() {
        return true;
    }
    // Whichever of the two is the old bake: its baker may have been killed before the files of others were out of it.
    [new, old].iter().filter(|bake| bake.join(MANIFEST).is_file()).all(|bake| carry(bake, target).is_ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bake of files with these texts.
    fn bake(folder: &Path, files: &[(&str, &str)]) {
        let list: Vec<_> = files.iter().map(|(file, _)| serde_json::json!({ "file": file })).collect();
        let manifest = serde_json::json!({ "files": list }).to_string();
        for (file, text) in files.iter().copied().chain([(MANIFEST, manifest.as_str())]) {
            fs::create_dir_all(folder.join(file).parent().unwrap()).unwrap();
            fs::write(folder.join(file), text).unwrap();
        }
    }

    /// A folder with the bake `mars` of files `a`, `b/c` and one of somebody else's, and the folder of a dead process.
    fn old_and_dead() -> (tempfile::TempDir, PathBuf, PathBuf) {
        let dir = tempfile::tempdir().unwrap();
        let [target, dead] = ["mars", ".mars.tmp-1"].map(|name| dir.path().join(name));
        bake(&target, &[("a", "old"), ("b/c", "old")]);
        fs::write(target.join("a.meta"), "mine").unwrap();
        fs::create_dir(&dead).unwrap();
        mark::put(&dead).unwrap();
        (dir, target, dead)
    }

    fn is_old(dir: &Path) {
        let read = |file: &str| fs::read_to_string(dir.join("mars").join(file)).unwrap();
        assert_eq!([read("a"), read("b/c"), read("a.meta")], ["old", "old", "mine"]);
        assert_eq!(crate::files::foreign::foreign(&dir.join("mars")), [Path::new("a.meta")]);
        assert_eq!(fs::read_dir(dir).unwrap().count(), 1);
    }

    /// Killed between the two renames: the old bake is put back. Of a process that lives nothing is touched.
    #[test]
    fn killed_between_two_renames() {
        let (dir, target, dead) = old_and_dead();
        bake(&dead.join(NEW), &[("a", "new"), ("d", "new")]);
        fs::rename(&target, dead.join(OLD)).unwrap();
        let lives = mark::take_dead(&dead).unwrap();
        sweep(&target);
        assert!(in_between(&target) && !target.exists());
        drop(lives);
        sweep(&target);
        is_old(dir.path());
        assert!(!in_between(&target));
    }

    /// Killed while files were put into a folder that cannot be moved, at every step: the old bake is put back.
    #[test]
    fn killed_in_the_middle_of_a_folder() {
        for moved in [&[][..], &["a"], &["a", "d/e"]] {
            let (dir, target, dead) = old_and_dead();
            bake(&dead.join(NEW), &[("a", "new"), ("d/e", "new")]);
            bake(&dead.join(OLD), &[("a", "old"), ("b/c", "old")]);
            fs::remove_file(target.join(MANIFEST)).unwrap();
            fs::remove_dir_all(target.join("b")).unwrap();
            for file in moved {
                fs::create_dir_all(target.join(file).parent().unwrap()).unwrap();
                fs::rename(dead.join(NEW).join(file), target.join(file)).unwrap();
            }
            sweep(&target);
            is_old(dir.path());
            assert!(!target.join("d").exists(), "{moved:?}");
        }
    }

    /// Killed once the new bake was in its place: it stays, and a file of somebody else's that came last is kept.
    #[test]
    fn killed_at_the_end() {
        for place in [NEW, OLD] {
            let (dir, target, dead) = old_and_dead();
            fs::rename(&target, dead.join(place)).unwrap();
            bake(&target, &[("a", "new")]);
            sweep(&target);
            let read = |file: &str| fs::read_to_string(target.join(file)).unwrap();
            assert_eq!([read("a"), read("a.meta")], ["new", "mine"]);
            assert!(!target.join("b").exists() && fs::read_dir(dir.path()).unwrap().count() == 1);
        }
    }

    /// Half a bake, or a whole one whose user has removed the old one, goes.
    #[test]
    fn killed_before_the_end() {
        let (dir, target, dead) = old_and_dead();
        bake(&dead.join(NEW), &[("a", "new"), ("d", "new")]);
        sweep(&target);
        is_old(dir.path());
        fs::create_dir(&dead).unwrap();
        mark::put(&dead).unwrap();
        bake(&dead.join(NEW), &[("a", "new")]);
        fs::write(dead.join(NEW).join("a.meta"), "mine").unwrap();
        fs::remove_dir_all(&target).unwrap();
        sweep(&target);
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
    }
}
