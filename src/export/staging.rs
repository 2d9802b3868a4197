//! A bake's folder, written beside its final place and moved there whole: interrupted, failed or killed, a bake
//! leaves the old one as it was.

use super::interrupt::{self, interrupted};
use super::replace::{MANIFEST, check_replaceable, replace};
use crate::error::{Error, Result};
use rayon::prelude::*;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::hash::{BuildHasher, Hasher, RandomState};
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};

/// A folder being written. Dropped without [`Staging::commit`], it is removed.
pub struct Staging {
    target: PathBuf,
    temp: PathBuf,
    /// An advisory lock on `temp`: the kernel releases it when the process dies, however it dies, and a later
    /// bake then knows that the folder is nobody's. `None` where folders cannot be opened (Windows).
    _lock: Option<File>,
}

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
            let temp = beside(&target, "tmp");
            match interrupt::create_dir(&temp) {
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => continue,
                made => made.map_err(|e| Error::machine(&target, e))?,
            }
            let lock = File::open(&temp).ok().filter(|folder| folder.lock().is_ok());
            // Another bake may have swept the folder in the moment before it was locked.
            if temp.is_dir() {
                return Ok(Staging { target, temp, _lock: lock });
            }
            interrupt::discard(&temp);
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
        let path = self.temp.join(relative);
        let folder = path.parent().unwrap_or(&self.temp);
        let written = fs::create_dir_all(folder)
            .and_then(|()| File::create_new(&path))
            .and_then(|mut file| file.write_all(bytes));
        written.map_err(|e| self.failed(self.target.join(relative), e))?;
        Ok(blake3::hash(bytes).to_hex().to_string())
    }

    /// Puts the folder in its place and removes the bake that stood there.
    ///
    /// # Errors
    /// As [`Staging::begin`], and `Interrupted`; the old bake is then untouched.
    pub fn commit(self) -> Result<()> {
        if !self.temp.join(MANIFEST).is_file() {
            return Err(Error::Argument(format!("{}: a bake needs its {MANIFEST}", self.target.display())));
        }
        sync(&self.temp).map_err(|e| self.failed(self.target.clone(), e))?;
        let aside = beside(&self.target, "old");
        let old = interrupt::undisturbed(|| replace(&self.temp, &self.target, &aside, true))?;
        if let Some(parent) = self.target.parent() {
            sync_folder(parent).map_err(|e| self.failed(parent.to_path_buf(), e))?;
        }
        if let Some(old) = old {
            interrupt::remove(&old);
        }
        Ok(())
    }

    /// The file is named by the place that it was meant for: the temporary folder is no business of the user.
    fn failed(&self, path: PathBuf, e: io::Error) -> Error {
        if interrupted() { Error::Interrupted } else { Error::machine(path, e) }
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        interrupt::discard(&self.temp);
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
fn beside(target: &Path, kind: &str) -> PathBuf {
    let mut name = prefix(target, kind);
    name.push(format!("{:016x}", RandomState::new().build_hasher().finish()));
    target.with_file_name(name)
}

fn prefix(target: &Path, kind: &str) -> OsString {
    let mut name = OsString::from(".");
    name.push(target.file_name().unwrap_or(OsStr::new("bake")));
    name.push(format!(".{kind}-"));
    name
}

/// Removes the temporary folders of dead processes; a bake that one of them had moved aside and not replaced
/// is put back first.
fn sweep(target: &Path) {
    let Some(entries) = target.parent().and_then(|parent| fs::read_dir(parent).ok()) else { return };
    let begins = |path: &Path, kind: &str| {
        let start = prefix(target, kind);
        path.file_name().is_some_and(|n| n.as_encoded_bytes().starts_with(start.as_encoded_bytes()))
    };
    for path in entries.flatten().map(|entry| entry.path()) {
        let (temp, old) = (begins(&path, "tmp"), begins(&path, "old"));
        // No pipe of that name, which would not open, and no link to somebody's folder.
        let ours = (temp || old) && fs::symlink_metadata(&path).is_ok_and(|m| m.is_dir());
        let open = || File::open(&path).ok().filter(|f| f.try_lock().is_ok());
        let Some(_lock) = ours.then(open).flatten() else {
            continue;
        };
        let back = old && path.join(MANIFEST).is_file() && fs::rename(&path, target).is_ok();
        if !back {
            interrupt::remove(&path);
        }
    }
}

/// Every file and folder below `root` is on the disk when this returns, so that the rename cannot get there
/// before them.
fn sync(root: &Path) -> io::Result<()> {
    let mut folders = vec![root.to_path_buf()];
    let mut files = Vec::new();
    let mut next = 0;
    while next < folders.len() {
        for entry in fs::read_dir(&folders[next])? {
            let entry = entry?;
            let list = if entry.file_type()?.is_dir() { &mut folders } else { &mut files };
            list.push(entry.path());
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
