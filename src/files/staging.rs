//! A bake's folder, written beside its final place and moved there whole: interrupted, failed or killed, a bake
//! leaves the old one as it was, and what is in it of others.

use super::foreign::carry;
use super::interrupt::{self, interrupted};
use super::mark;
use super::replace::{MANIFEST, Way, check_replaceable, replace};
use super::sweep::{prefix, sweep};
use crate::error::{Error, Result};
use rayon::prelude::*;
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};

/// A folder being written. Dropped without [`Staging::commit`], it is removed.
pub struct Staging {
    target: PathBuf,
    /// A folder beside the target with a [`mark`], the bake to be, and the one that was.
    temp: PathBuf,
    new: PathBuf,
    _mark: File,
    /// Not to be removed: something in it has no other place.
    kept: bool,
}

/// The bake to be, in a folder of a [`Staging`], and the one that was, for as long as it may have to be put back.
pub(super) const NEW: &str = "new";
pub(super) const OLD: &str = "old";
/// The one that was, once it need not be put back.
const GONE: &str = "gone";

impl Staging {
    /// A new temporary folder beside `target`, which need not exist; a link is followed. Sweeps what earlier
    /// bakes of this folder left behind when they were killed.
    ///
    /// # Errors
    /// `File` if something that is not a bake stands at `target`; `Machine` if the folder cannot be made.
    pub fn begin(target: &Path) -> Result<Staging> {
        let target = resolve(target)?;
        sweep(&target);
        check_replaceable(&target)?;
        for _ in 0..100 {
            let temp = beside(&target);
            match interrupt::create_dir(&temp) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => continue,
                made => made.map_err(|e| Error::machine(&target, e))?,
            }
            let new = temp.join(NEW);
            return match mark::put(&temp).and_then(|mark| fs::create_dir(&new).map(|()| mark)) {
                Ok(mark) => Ok(Staging { target, temp, new, _mark: mark, kept: false }),
                Err(e) => {
                    interrupt::discard(&temp);
                    Err(Error::machine(target, e))
                }
            };
        }
        Err(Error::machine(target, io::Error::other("no free name for a temporary folder beside it")))
    }

    /// Removes what earlier bakes of this folder left beside it when they were killed, as far as that is possible.
    pub fn sweep_beside(target: &Path) {
        if let Ok(target) = resolve(target) {
            sweep(&target);
        }
    }

    /// Writes a file of the bake, its path relative to the bake's folder. Returns the BLAKE3 hash of `bytes`,
    /// 64 hexadecimal digits.
    pub fn write(&self, relative: &str, bytes: &[u8]) -> Result<String> {
        if !Path::new(relative).components().all(|c| matches!(c, Component::Normal(_))) {
            return Err(Error::Argument(format!("{relative}: not a path inside a bake")));
        }
        if interrupted() {
            return Err(Error::Interrupted);
        }
        let path = self.new.join(relative);
        let folder = path.parent().unwrap_or(&self.new);
        let written = fs::create_dir_all(folder)
            .and_then(|()| File::create_new(&path))
            .and_then(|mut file| file.write_all(bytes));
        written.map_err(|e| self.failed(self.target.join(relative), e))?;
        Ok(blake3::hash(bytes).to_hex().to_string())
    }

    /// Puts the folder in its place and removes the bake that stood there. Files in that which are not the bake's own
    /// stay.
    ///
    /// # Errors
    /// As [`Staging::begin`], and `Interrupted`; the old bake is then untouched.
    pub fn commit(self) -> Result<()> {
        self.commit_by(Way::Exchange)
    }

    fn commit_by(mut self, way: Way) -> Result<()> {
        if !self.new.join(MANIFEST).is_file() {
            return Err(Error::Argument(format!("{}: a bake needs its {MANIFEST}", self.target.display())));
        }
        sync(&self.new).map_err(|e| self.failed(self.target.clone(), e))?;
        // Before the exchange, so that engines that watch the folder miss none of theirs for a moment.
        carry(&self.target, &self.new).map_err(|(file, e)| self.failed(self.target.join(file), e))?;
        let aside = self.temp.join(OLD);
        let replaced = interrupt::undisturbed(|| replace(&self.new, &self.target, &aside, way));
        // The old bake could not be put back: a later bake tries again.
        self.kept = replaced.is_err() && aside.join(MANIFEST).is_file();
        let old = replaced?;
        if let Some(parent) = self.target.parent() {
            sync_folder(parent).map_err(|e| self.failed(parent.to_path_buf(), e))?;
        }
        let Some(old) = old else { return Ok(()) };
        // What came since, or stood there only for a moment.
        if let Err((file, e)) = carry(&old, &self.target) {
            self.kept = true;
            return Err(self.failed(old.join(file), e));
        }
        // From here on nobody puts it back.
        let _ = fs::rename(&old, self.temp.join(GONE));
        Ok(())
    }

    /// The file is named by the place that it was meant for: the temporary folder is no business of the user.
    fn failed(&self, path: PathBuf, e: io::Error) -> Error {
        if interrupted() { Error::Interrupted } else { Error::machine(path, e) }
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        match self.kept {
            true => interrupt::forget(&self.temp),
            false => interrupt::discard(&self.temp),
        }
    }
}

/// The real place of `target`, its parent made if need be.
fn resolve(target: &Path) -> Result<PathBuf> {
    if let Ok(real) = fs::canonicalize(target) {
        return Ok(real);
    }
    if fs::symlink_metadata(target).is_ok_and(|m| m.is_symlink()) {
        return Err(Error::file(target, "a link that leads nowhere"));
    }
    let name = target.file_name().ok_or_else(|| {
        Error::Argument(format!("{}: not a name for the folder of a bake", target.display()))
    })?;
    let parent = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    fs::create_dir_all(parent).map_err(|e| Error::machine(parent, e))?;
    Ok(fs::canonicalize(parent).map_err(|e| Error::machine(parent, e))?.join(name))
}

/// `.earth.tmp-` and a random number for the folder `earth`: hidden, on the same filesystem, known by its
/// beginning, and distinct even from those of processes in other containers, which may have our number.
fn beside(target: &Path) -> PathBuf {
    let mut name = prefix(target);
    name.push(format!("{:016x}", RandomState::new().build_hasher().finish()));
    target.with_file_name(name)
}

/// Every file and folder below `root` is on the disk when this returns, so that the rename cannot get there
/// before them.
pub(super) fn sync(root: &Path) -> io::Result<()> {
    let mut folders = vec![root.to_path_buf()];
    let mut files = Vec::new();
    let mut next = 0;
    while next < folders.len() {
        for entry in fs::read_dir(&folders[next])? {
            let entry = entry?;
            match entry.file_type()? {
                kind if kind.is_dir() => folders.push(entry.path()),
                // Links and pipes of others have nothing of their own to be written.
                kind if kind.is_file() => files.push(entry.path()),
                _ => {}
            }
        }
        next += 1;
    }
    files.par_iter().try_for_each(|file| File::open(file)?.sync_all())?;
    folders.iter().try_for_each(|folder| sync_folder(folder))
}

#[cfg(unix)]
fn sync_folder(folder: &Path) -> io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In each of the ways in which a folder takes the place of another, files of others stay what they were, in every
    /// depth; those of the old bake go.
    #[test]
    fn files_of_others_stay_in_every_way() {
        for way in [Way::Exchange, Way::Aside, Way::InPlace] {
            let dir = tempfile::tempdir().unwrap();
            let target = dir.path().join("mars");
            let bake = |files: &[&str]| {
                let staging = Staging::begin(&target).unwrap();
                let list: Vec<_> = files.iter().map(|file| serde_json::json!({ "file": file })).collect();
                files.iter().for_each(|file| drop(staging.write(file, b"new").unwrap()));
                let manifest = serde_json::json!({ "tables": list }).to_string();
                staging.write(MANIFEST, manifest.as_bytes()).unwrap();
                staging.commit_by(way).unwrap();
            };
            bake(&["elek2010/a.exr", "compact/b.exr"]);
            let others = ["elek2010/a.exr.meta", "compact/.import/b", "notes.txt"].map(PathBuf::from);
            for file in &others {
                fs::create_dir_all(target.join(file).parent().unwrap()).unwrap();
                fs::write(target.join(file), "mine").unwrap();
            }
            let time = |file: &PathBuf| fs::metadata(target.join(file)).unwrap().modified().unwrap();
            let before = others.each_ref().map(time);
            for _ in 0..2 {
                bake(&["compact/b.exr", "c.png"]);
                let mut found = crate::files::foreign::foreign(&target);
                found.sort_by_key(|file| others.iter().position(|other| other == file));
                assert_eq!(found, others, "{way:?}");
                assert_eq!(others.each_ref().map(time), before, "{way:?}");
                assert!(others.iter().all(|file| fs::read(target.join(file)).unwrap() == b"mine"));
                assert!(!target.join("elek2010/a.exr").exists() && target.join("c.png").exists());
                assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
            }
        }
    }

    /// A folder that can neither be exchanged nor moved, as under an overlay filesystem, is replaced all the same, and a
    /// failure in its middle (a folder where a table should be) brings the old bake back.
    #[test]
    fn a_failure_in_the_middle_brings_the_old_bake_back() {
        let dir = tempfile::tempdir().unwrap();
        let target = dir.path().join("mars");
        let bake = |files: &[(&str, &str)], way| {
            let staging = Staging::begin(&target).unwrap();
            files.iter().for_each(|(file, text)| drop(staging.write(file, text.as_bytes()).unwrap()));
            let list: Vec<_> = files.iter().map(|(file, _)| serde_json::json!({ "file": file })).collect();
            let manifest = serde_json::json!({ "tables": list }).to_string();
            staging.write(MANIFEST, manifest.as_bytes()).unwrap();
            staging.commit_by(way)
        };
        bake(&[("a", "old")], Way::InPlace).unwrap();
        fs::create_dir(target.join("b")).unwrap();
        fs::write(target.join("b/notes.txt"), "mine").unwrap();
        let error = bake(&[("a", "new"), ("b", "new")], Way::InPlace).unwrap_err();
        assert_eq!(error.exit_code(), 3, "{error}");
        assert_eq!(fs::read_to_string(target.join("a")).unwrap(), "old");
        assert_eq!(fs::read_to_string(target.join("b/notes.txt")).unwrap(), "mine");
        assert!(target.join(MANIFEST).is_file() && fs::read_dir(dir.path()).unwrap().count() == 1);
    }
}
