//! Where a bake may land: names that shells trip over, links, folders that are not there yet or not ours.

use super::run::*;
use std::fs;

/// Bakes, verifies and samples in a folder whose name has spaces, quotes and letters beyond ASCII.
#[test]
fn spaces_and_unicode() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("my 'skies' — Erde/größer\t地球");
    let bake = bake("earth", &out, &["--layout", "compact"]);
    assert_eq!(names(&out), ["earth"]);
    holds(&bake);
    assert!(sample(&bake, &[])[ZENITH][0] > 0.0);
}

/// A link to the out folder, or in the place of the bake itself, is followed and stays a link.
#[cfg(unix)]
#[test]
fn links_are_followed() {
    let dir = tempfile::tempdir().unwrap();
    let [out, link, elsewhere] = ["out", "link", "elsewhere"].map(|name| dir.path().join(name));
    fs::create_dir_all(&out).unwrap();
    fs::create_dir_all(&elsewhere).unwrap();
    std::os::unix::fs::symlink(&out, &link).unwrap();
    std::os::unix::fs::symlink(&elsewhere, out.join("earth")).unwrap();
    let at = bake("earth", &link, &["--layout", "compact"]);
    assert_eq!(at, link.join("earth"));
    for place in [&at, &out.join("earth"), &elsewhere] {
        holds(place);
    }
    for place in [link.as_path(), &out.join("earth")] {
        assert!(fs::symlink_metadata(place).unwrap().is_symlink(), "{}", place.display());
    }
    assert_eq!((names(dir.path()).len(), names(&out)), (3, vec!["earth".into()]));
}

/// A folder of somebody's own files is not replaced by a bake, and is told before any work is done.
#[test]
fn a_folder_that_is_no_bake_is_left_alone() {
    let dir = tempfile::tempdir().unwrap();
    fs::create_dir(dir.path().join("earth")).unwrap();
    fs::write(dir.path().join("earth/thesis.txt"), "years").unwrap();
    let done = ran(small_bake("earth", dir.path(), &[]).output().unwrap());
    assert!(done.code == Some(2) && done.err.contains("not a bake"), "{}", done.err);
    assert_eq!(names(&dir.path().join("earth")), ["thesis.txt"]);
}
