//! A bake into a folder that cannot be moved: one that comes from an image under an overlay filesystem (its rename ends in
//! EXDEV), or one that is a mount of its own. Its files are replaced one by one, `bake.json` last, for which they are
//! copied aside first: whoever dies in the middle leaves all that brings the old bake back.

use super::foreign::{copy, listed, walk};
use super::replace::MANIFEST;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Puts the files of `new` into the folder `target`; the files of the bake that stood there are in `aside` then.
///
/// # Errors
/// Where a file cannot be written; the old bake is back then, or, where not even that can be written, whole in `aside`.
pub(super) fn put(new: &Path, target: &Path, aside: &Path) -> io::Result<()> {
    // One at a time, where the system can lock folders.
    let _turn = fs::File::open(target).ok().filter(|folder| folder.lock().is_ok());
    fs::create_dir(aside)?;
    let placed = copied_aside(target, aside).and_then(|old| {
        let step = put_files(new, target, &old);
        // Not removed below if it is all that there is.
        step.or_else(|e| back(new, target, aside).map_err(io::Error::other).and(Err(e)))
    });
    if placed.as_ref().is_err_and(|_| target.join(MANIFEST).is_file() || !aside.join(MANIFEST).is_file()) {
        super::interrupt::remove(aside);
    }
    placed
}

/// Copies the files of the bake that stands in `target`, its manifest last, and returns which they are.
fn copied_aside(target: &Path, aside: &Path) -> io::Result<BTreeSet<PathBuf>> {
    let old = listed(target);
    ordered(old.iter().cloned().collect()).try_for_each(|file| match copied(target, aside, &file) {
        Err(e) if e.kind() == ErrorKind::NotFound => Ok(()),
        done => done,
    })?;
    super::staging::sync(aside)?;
    Ok(old)
}

fn put_files(new: &Path, target: &Path, old: &BTreeSet<PathBuf>) -> io::Result<()> {
    let files = walk(new)?;
    absent(fs::remove_file(target.join(MANIFEST)))?;
    old.iter().filter(|file| !files.contains(*file)).for_each(|file| remove(target, file));
    ordered(files.into_iter().collect()).try_for_each(|file| moved(new, target, &file))
}

/// Brings the bake back that [`put`] copied to `aside` before it ended half-way: what of `new` is in `target` goes.
///
/// # Errors
/// Where a file cannot be written; the copy is whole then.
pub(super) fn back(new: &Path, target: &Path, aside: &Path) -> io::Result<()> {
    let left = walk(new)?;
    listed(new).iter().filter(|file| !left.contains(*file)).for_each(|file| remove(target, file));
    ordered(walk(aside)?.into_iter().collect()).try_for_each(|file| {
        remove(target, &file);
        copied(aside, target, &file)
    })
}

/// The manifest last: a folder without it is no bake.
fn ordered(files: Vec<PathBuf>) -> impl Iterator<Item = PathBuf> {
    let (last, first): (Vec<_>, Vec<_>) = files.into_iter().partition(|file| file == Path::new(MANIFEST));
    first.into_iter().chain(last)
}

fn absent(removed: io::Result<()>) -> io::Result<()> {
    removed.or_else(|e| if e.kind() == ErrorKind::NotFound { Ok(()) } else { Err(e) })
}

/// Removes a file, and its folder where that is empty then.
fn remove(folder: &Path, file: &Path) {
    let _ = fs::remove_file(folder.join(file));
    if let Some(inside) = file.parent().filter(|p| !p.as_os_str().is_empty()) {
        let _ = fs::remove_dir(folder.join(inside));
    }
}

fn copied(from: &Path, to: &Path, file: &Path) -> io::Result<()> {
    if let Some(parent) = to.join(file).parent() {
        fs::create_dir_all(parent)?;
    }
    copy(&from.join(file), &to.join(file))
}

/// By a rename where both are on one filesystem.
fn moved(from: &Path, to: &Path, file: &Path) -> io::Result<()> {
    if let Some(parent) = to.join(file).parent() {
        fs::create_dir_all(parent)?;
    }
    match fs::rename(from.join(file), to.join(file)) {
        Err(e) if e.kind() == ErrorKind::CrossesDevices => {
            absent(fs::remove_file(to.join(file)))?;
            copied(from, to, file)?;
            fs::File::open(to.join(file))?.sync_all()?;
            fs::remove_file(from.join(file))
        }
        done => done,
    }
}
