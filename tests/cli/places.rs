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

/// A preset may be a link, with its spectrum beside the link; a link that leads nowhere is told, whichever it stands for.
#[cfg(unix)]
#[test]
fn presets_behind_links_and_links_to_nothing() {
    use std::os::unix::fs::symlink;
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str| dir.path().join(name);
    let preset = include_str!("../../presets/planets/earth-paper.json").replace("earth-paper", "mine");
    fs::write(at("real.json"), preset).unwrap();
    symlink("real.json", at("link.json")).unwrap();
    holds(&bake(at("link.json").to_str().unwrap(), dir.path(), &["--layout", "compact"]));
    for (name, to) in [("nothing.json", "gone.json"), ("round.json", "round.json")] {
        symlink(to, at(name)).unwrap();
        let done = ran(small_bake(at(name).to_str().unwrap(), dir.path(), &[]).output().unwrap());
        assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{}", done.err);
        assert!(done.err.contains(name), "{}", done.err);
    }
    symlink("gone", at("out")).unwrap();
    fs::create_dir(at("bakes")).unwrap();
    symlink("gone", at("bakes/earth")).unwrap();
    for (out, code) in [("out", 3), ("bakes", 2)] {
        let done = ran(small_bake("earth", &at(out), &[]).output().unwrap());
        assert_eq!((done.code, done.err.lines().count()), (Some(code), 1), "{out}: {}", done.err);
    }
    assert!(!at("gone").exists() && names(&at("bakes")) == ["earth"]);
}

/// Names that look like options, behind `--` or a folder, and names at the limit of the system and beyond it.
#[test]
fn names_like_options_and_long_names() {
    let dir = tempfile::tempdir().unwrap();
    let preset = include_str!("../../presets/planets/earth-paper.json").replace("earth-paper", "mine");
    fs::write(dir.path().join("-x.json"), preset).unwrap();
    let mut command = command();
    command
        .args(["bake", "--quiet", "--out=-out", "--layout", "compact"])
        .args(SMALL)
        .args(["--", "-x.json"]);
    let done = ran(command.current_dir(dir.path()).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    holds(&dir.path().join("-out/mine"));
    let long = dir.path().join("n".repeat(255));
    holds(&bake("earth", &long, &["--layout", "compact"]));
    for name in ["n".repeat(256), "n/".repeat(3000)] {
        let done = ran(small_bake("earth", &dir.path().join(&name), &[]).output().unwrap());
        assert_eq!((done.code, done.err.lines().count()), (Some(3), 1), "{}", done.err);
        let done = tyndall(&["verify", &name]);
        assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{}", done.err);
    }
}

/// Somebody who may not write where the bake should go, or not read what it needs, is told so in a line, by kind: a
/// folder is the machine's (3), a file the user's (2). Only root can become somebody else.
#[cfg(target_os = "linux")]
#[test]
fn folders_and_files_of_others() {
    use std::os::unix::fs::PermissionsExt;
    let dir = tempfile::tempdir().unwrap();
    let mode = |path: &std::path::Path, mode: u32| {
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    };
    mode(dir.path(), 0o755);
    let (program, out) = (dir.path().join("tyndall"), dir.path().join("out"));
    fs::copy(env!("CARGO_BIN_EXE_tyndall"), &program).unwrap();
    let old = bake("earth", &out, &["--layout", "compact"]);
    let before = files(&old);
    let secret = dir.path().join("secret.json");
    fs::write(&secret, "{}").unwrap();
    mode(&secret, 0o600);
    let nobody = |words: &[&str]| {
        let mut command = std::process::Command::new("setpriv");
        command.args(["--reuid", "65534", "--regid", "65534", "--clear-groups"]).arg(&program).args(words);
        command.current_dir("/").output().map(ran)
    };
    match nobody(&["presets", "list"]) {
        Ok(done) if done.code == Some(0) => {}
        other => return eprintln!("skipped: nobody else can run here: {other:?}"),
    }
    let new = out.join("new").to_str().unwrap().to_string();
    let (out, old) = (out.to_str().unwrap(), old.to_str().unwrap());
    let small =
        [&["bake", "earth", "--quiet", "--layout", "compact", "--out", out, "--force"], &SMALL[..]].concat();
    for (words, code, reason) in [
        (&small[..], 3, "Permission denied"),
        (&["recolour", old, "--star", "4000", "--out", &new], 3, "Permission denied"),
        (&["presets", "show", secret.to_str().unwrap()], 2, "Permission denied"),
        (&["verify", old], 0, ""),
    ] {
        let done = nobody(words).unwrap();
        assert_eq!(done.code, Some(code), "{words:?}: {}{}", done.out, done.err);
        assert!(done.err.contains(reason) && done.err.lines().count() <= 1, "{words:?}: {}", done.err);
    }
    assert!(files(std::path::Path::new(old)) == before && names(std::path::Path::new(out)) == ["earth"]);
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
