//! Files in a bake's folder that are not the bake's: what engines write beside assets (`*.meta`, `*.import`, `*.uid`),
//! and notes of users. They are told, kept from bake to bake, and never a failure.

use super::bounded_read;
use super::replace::MANIFEST;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// What a manifest says of files; the rest of it may be of another version.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Lists {
    tables: Vec<Listed>,
    files: Vec<Listed>,
}

#[derive(Default, Deserialize)]
#[serde(default)]
struct Listed {
    file: String,
    containers: Vec<Listed>,
}

/// Files that the bake in `folder` calls its own, by their paths there; of a manifest that cannot be read only itself.
pub fn listed(folder: &Path) -> BTreeSet<PathBuf> {
    let text = bounded_read::named_text(&folder.join(MANIFEST), super::manifest::MOST_MANIFEST);
    listed_in(&text.unwrap_or_default())
}

fn listed_in(manifest: &str) -> BTreeSet<PathBuf> {
    let lists: Lists = serde_json::from_str(manifest).unwrap_or_default();
    let all = lists.tables.iter().chain(&lists.files);
    let names = all.flat_map(|l| std::iter::once(&l.file).chain(l.containers.iter().map(|c| &c.file)));
    let inside = names.filter(|name| bounded_read::is_inside(name)).map(PathBuf::from);
    inside.chain([PathBuf::from(MANIFEST)]).collect()
}

/// Every file below a folder by its path there, links as what they are; a folder that cannot be looked into counts as a
/// file.
///
/// # Errors
/// Where `folder` itself cannot be looked into.
pub fn walk(folder: &Path) -> io::Result<BTreeSet<PathBuf>> {
    let mut found = BTreeSet::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(inside) = folders.pop() {
        let entries = match fs::read_dir(folder.join(&inside)) {
            Err(e) if inside.as_os_str().is_empty() => return Err(e),
            // Gone since, or somebody else's.
            Err(e) if e.kind() == ErrorKind::NotFound => continue,
            Err(_) => {
                found.insert(inside);
                continue;
            }
            Ok(entries) => entries,
        };
        for entry in entries.flatten() {
            let path = inside.join(entry.file_name());
            match entry.file_type().is_ok_and(|kind| kind.is_dir()) {
                true => folders.push(path),
                false => drop(found.insert(path)),
            }
        }
    }
    Ok(found)
}

/// Files in the folder of a bake that its manifest does not list; none where nothing stands there.
pub fn foreign(folder: &Path) -> Vec<PathBuf> {
    // Another bake may take the place of this one between the two: then its files would look foreign.
    for _ in 0..LOOKS {
        let own = listed(folder);
        let all = walk(folder).unwrap_or_default();
        if listed(folder) == own {
            return all.difference(&own).cloned().collect();
        }
    }
    Vec::new()
}

const LOOKS: usize = 20;

/// Puts the foreign files of the bake `from` into `to` as well, where there is nothing of that name: as the same files
/// where the system can, so that engines find them as they left them.
///
/// # Errors
/// The file that cannot be kept, and why.
pub fn carry(from: &Path, to: &Path) -> Result<(), (PathBuf, io::Error)> {
    for file in foreign(from) {
        let (old, new) = (from.join(&file), to.join(&file));
        match keep(&old, &new) {
            // It is gone since, or `to` has one.
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::AlreadyExists) => {}
            kept => kept.map_err(|e| (file, e))?,
        }
    }
    Ok(())
}

fn keep(old: &Path, new: &Path) -> io::Result<()> {
    if let Some(parent) = new.parent() {
        fs::create_dir_all(parent)?;
    }
    match fs::hard_link(old, new) {
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::AlreadyExists) => Err(e),
        Err(_) => copy(old, new),
        Ok(()) => Ok(()),
    }
}

/// A copy of a file or link where nothing stands, with its time.
pub fn copy(old: &Path, new: &Path) -> io::Result<()> {
    let found = fs::symlink_metadata(old)?;
    if found.is_symlink() {
        return link(&fs::read_link(old)?, new);
    }
    let mut from = bounded_read::regular(old, fs::File::options().read(true))?;
    let mut to = fs::File::create_new(new)?;
    let copied = io::copy(&mut from, &mut to).and_then(|_| to.set_permissions(found.permissions()));
    // The time is a nicety.
    let _ = found.modified().and_then(|time| to.set_modified(time));
    copied.inspect_err(|_| drop(fs::remove_file(new)))
}

#[cfg(unix)]
fn link(to: &Path, at: &Path) -> io::Result<()> {
    std::os::unix::fs::symlink(to, at)
}

#[cfg(not(unix))]
fn link(_: &Path, _: &Path) -> io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables, their containers and other files are a bake's own, and its manifest; a path that leads out is nobody's.
    #[test]
    fn what_a_manifest_lists() {
        let text = r#"{"schema_version": 99, "tables": [{"file": "a/b.exr", "containers": [{"file": "a/b.dds", "x": 1}]}],
            "files": [{"file": "c.png", "about": "d"}, {"file": "../e"}, {"file": "/f"}, {}]}"#;
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<BTreeSet<_>>();
        assert_eq!(listed_in(text), paths(&["a/b.exr", "a/b.dds", "c.png", MANIFEST]));
        for damaged in ["", "{", "[]", "{\"tables\": 3}"] {
            assert_eq!(listed_in(damaged), paths(&[MANIFEST]), "{damaged}");
        }
    }

    /// Foreign files in every depth are kept as they are, links too; what the new bake has of the same name is its own.
    #[cfg(unix)]
    #[test]
    fn foreign_files_are_carried() {
        let dir = tempfile::tempdir().unwrap();
        let [old, new] = ["old", "new"].map(|name| dir.path().join(name));
        for (file, text) in [
            ("old/bake.json", r#"{"files": [{"file": "a.exr"}, {"file": "gone.exr"}]}"#),
            ("old/a.exr", "old"),
            ("old/a.exr.meta", "guid"),
            ("old/x/y/z.import", "mine"),
            ("old/taken", "old"),
            ("old/gone.exr", "old"),
            ("new/bake.json", "{}"),
            ("new/a.exr", "new"),
            ("new/taken", "new"),
        ] {
            fs::create_dir_all(dir.path().join(file).parent().unwrap()).unwrap();
            fs::write(dir.path().join(file), text).unwrap();
        }
        std::os::unix::fs::symlink("nowhere", old.join("link")).unwrap();
        for _ in 0..2 {
            carry(&old, &new).unwrap();
            let read = |file: &str| fs::read_to_string(new.join(file)).unwrap();
            assert_eq!([read("a.exr"), read("a.exr.meta"), read("x/y/z.import")], ["new", "guid", "mine"]);
            assert_eq!((read("taken"), new.join("gone.exr").exists()), ("new".into(), false));
            assert_eq!(fs::read_link(new.join("link")).unwrap(), Path::new("nowhere"));
        }
        copy(&old.join("link"), &new.join("link 2")).unwrap();
        copy(&old.join("a.exr.meta"), &new.join("meta 2")).unwrap();
        assert_eq!(fs::read(new.join("meta 2")).unwrap(), b"guid");
        assert!(copy(&old.join("a.exr"), &new.join("a.exr")).is_err());
        assert!(carry(&dir.path().join("nothing"), &new).is_ok());
    }
}
