//! What is not the bake's own: files that engines put beside assets, and folders and files of users with names like ours.

#![cfg(unix)]

use super::run::*;
use std::fs;
use std::path::Path;

const COMPACT: [&str; 2] = ["--layout", "compact"];

/// Side files of Unity, Godot and by hand: `verify` holds and lists them, in JSON too, a bake that is there already
/// stays, and every kind of new bake keeps them. A table that is damaged is still told.
#[test]
fn side_files_of_engines() {
    let dir = tempfile::tempdir().unwrap();
    let bake = bake("earth", dir.path(), &[]);
    let others =
        ["bake.json.meta", "compact/multiple.exr.import", "elek2010/scattering.exr.uid", "mine/notes.txt"];
    for file in others {
        fs::create_dir_all(bake.join(file).parent().unwrap()).unwrap();
        fs::write(bake.join(file), file).unwrap();
    }
    let kept = |when: &str| {
        let done = verify(&bake);
        assert_eq!(done.code, Some(0), "{when}: {}{}", done.out, done.err);
        for file in others {
            assert!(done.out.contains(&format!("{file}: foreign")), "{when}: {}", done.out);
            assert_eq!(fs::read_to_string(bake.join(file)).unwrap(), file, "{when}");
        }
        let json = tyndall(&["verify".as_ref(), bake.as_os_str(), "--json".as_ref()]);
        let json: serde_json::Value = serde_json::from_str(&json.out).unwrap();
        assert_eq!((&json["holds"], &json["foreign"]), (&true.into(), &others.into()), "{when}");
        assert_eq!(names(dir.path()), ["earth"], "{when}");
    };
    kept("first");
    let again = ran(small_bake("earth", dir.path(), &[]).output().unwrap());
    assert!(again.out.contains("there already"), "{}", again.out);
    kept("found there");
    for more in [&["--force"][..], &["--set", "ground.albedo=0.5"], &COMPACT] {
        super::run::bake("earth", dir.path(), more);
        kept(&more.join(" "));
    }
    assert!(!bake.join("elek2010/scattering.exr").exists(), "tables of the bake before are gone");
    fs::write(bake.join("bake.json"), "{").unwrap();
    super::run::bake("earth", dir.path(), &COMPACT);
    kept("a manifest that could not be read");
    fs::write(bake.join("compact/multiple.exr"), "x").unwrap();
    let done = verify(&bake);
    assert!(done.code == Some(1) && done.out.contains("compact/multiple.exr: its bytes"), "{}", done.out);
}

/// Every file below a folder, and the folder itself where it is empty.
fn all(folder: &Path) -> Vec<(String, Vec<u8>)> {
    files(folder).into_iter().collect()
}

/// Folders and files of users whose names begin like those of unfinished bakes and their locks: none is touched, neither
/// by a bake, nor by one that finds a bake there, nor by one from a list.
#[test]
fn names_like_ours() {
    let dir = tempfile::tempdir().unwrap();
    let names =
        [".earth.old-x", ".earth.tmp-x", ".earth.old-0123456789abcdef", ".earth.tmp-0123456789abcdef"];
    for name in names {
        fs::create_dir(dir.path().join(name)).unwrap();
    }
    // One is left empty, one holds a thesis, two hold a bake.
    fs::write(dir.path().join(names[1]).join("thesis.txt"), "years").unwrap();
    for name in &names[2..] {
        for (file, bytes) in files(earth()) {
            let path = dir.path().join(name).join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, bytes).unwrap();
        }
    }
    fs::write(dir.path().join(".earth.lock"), "mine").unwrap();
    fs::write(dir.path().join("list"), "earth\n").unwrap();
    let before: Vec<_> = names.iter().map(|name| all(&dir.path().join(name))).collect();
    let from_list = |more: &[&str]| {
        let mut command = command();
        command.args(["bake", "--list"]).arg(dir.path().join("list")).arg("--out").arg(dir.path());
        command.args(&SMALL[..]).args(COMPACT).args(more);
        let done = ran(command.output().unwrap());
        assert_eq!(done.code, Some(0), "{}", done.err);
    };
    bake("earth", dir.path(), &COMPACT);
    bake("earth", dir.path(), &COMPACT);
    from_list(&[]);
    from_list(&["--force"]);
    holds(&dir.path().join("earth"));
    let after: Vec<_> = names.iter().map(|name| all(&dir.path().join(name))).collect();
    assert!(before == after);
    assert_eq!(fs::read_to_string(dir.path().join(".earth.lock")).unwrap(), "mine");
    let mut wanted: Vec<&str> = names.into_iter().chain([".earth.lock", "earth", "list"]).collect();
    wanted.sort();
    assert_eq!(super::run::names(dir.path()), wanted);
}
