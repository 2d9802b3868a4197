//! A bake from the same preset, settings and program is not made twice; a stale or damaged one is.

use super::run::*;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The cheapest layout.
const ONE: [&str; 2] = ["--layout", "elek2010"];

/// The outcome of a small bake of `earth-paper` and what stands there then.
fn outcome(out: &Path, more: &[&str]) -> String {
    let done = ran(small_bake("earth-paper", out, &[&ONE, more, &["--json"]].concat()).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    holds(&out.join("earth-paper"));
    let told: Value = serde_json::from_str(&done.out).unwrap();
    let bytes: usize = files(&out.join("earth-paper")).values().map(Vec::len).sum();
    assert_eq!(told["bytes"], bytes);
    told["outcome"].as_str().unwrap().to_string()
}

/// What `--check` says, with its exit code.
fn check(out: &Path, more: &[&str]) -> (Option<i32>, String) {
    let done = ran(small_bake("earth-paper", out, &[&ONE, more, &["--check"]].concat()).output().unwrap());
    (done.code, done.out)
}

/// Nothing is written the second time, the same bytes with --force; with another setting they are others.
#[test]
fn the_same_is_left() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path();
    assert_eq!(check(out, &[]).0, Some(1));
    assert_eq!(outcome(out, &[]), "baked");
    let before = files(out);
    let written = fs::metadata(out.join("earth-paper/bake.json")).unwrap().modified().unwrap();
    assert_eq!(outcome(out, &[]), "reused");
    assert_eq!(fs::metadata(out.join("earth-paper/bake.json")).unwrap().modified().unwrap(), written);
    assert_eq!(outcome(out, &["--force"]), "baked");
    assert_ne!(fs::metadata(out.join("earth-paper/bake.json")).unwrap().modified().unwrap(), written);
    assert!(files(out) == before);
    assert_eq!(outcome(out, &["--orders", "3"]), "baked");
    assert!(files(out) != before);
}

/// Each kind of staleness has its line, exit code 1, and is mended by a bake, which `--check` then finds current.
#[test]
fn what_is_stale_is_baked_again() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path();
    let folder = out.join("earth-paper");
    let same = |bake: &[&str], expected: &[&str], damage: &dyn Fn()| {
        damage();
        let (code, told) = check(out, bake);
        assert_eq!(code, Some(1), "{told}");
        assert_eq!(told.lines().count(), expected.len(), "{told}");
        for (line, what) in told.lines().zip(expected) {
            assert!(line.contains(what), "{what}: {line}");
        }
        assert_eq!(outcome(out, bake), "baked");
        assert_eq!(check(out, bake).0, Some(0));
    };
    let edit = |from: &str, to: &str| {
        let text = fs::read_to_string(folder.join("bake.json")).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(folder.join("bake.json"), text.replacen(from, to, 1)).unwrap();
    };
    let none: &dyn Fn() = &|| {};
    same(&[], &["bake.json: there is no bake"], none);
    same(&["--set", "top.height_km=66"], &["preset.top_radius_m: "], none);
    same(&["--orders", "3"], &["preset.top_radius_m", "settings.orders.first: 2 → 3"], none);
    same(&["--wavelengths", "6"], &["settings.orders.first: 3 → 2", "wavelengths_nm"], none);
    same(&["--colour-space", "rec2020"], &["wavelengths_nm", "colour.space: \"srgb\" → \"rec2020\""], none);
    same(&[], &["colour.space"], none);
    same(&[], &["elek2010/scattering.exr: is missing"], &|| {
        fs::remove_file(folder.join("elek2010/scattering.exr")).unwrap();
    });
    same(&[], &["preview.png: its bytes"], &|| fs::write(folder.join("preview.png"), "mine").unwrap());
    same(&[], &["bake.json: was changed"], &|| edit("\"observer\": \"CIE", "\"observer\": \"cie"));
    same(&[], &["tool.version", "bake.json: was changed"], &|| {
        edit(&format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION")), "\"version\": \"0.0.1\"");
    });
    same(&[], &["bake.json: line 1"], &|| fs::write(folder.join("bake.json"), "{").unwrap());
}

/// Blanks in the manifest may change, as a repository with other line ends does it; a file more is no harm.
#[test]
fn what_does_not_count() {
    let dir = tempfile::tempdir().unwrap();
    outcome(dir.path(), &[]);
    let path = dir.path().join("earth-paper/bake.json");
    let text = fs::read_to_string(&path).unwrap();
    fs::write(&path, text.replace('\n', "\r\n")).unwrap();
    fs::write(dir.path().join("earth-paper/preview.png.meta"), "an engine's").unwrap();
    assert_eq!(check(dir.path(), &[]).0, Some(0));
}

/// Make bakes when a spectrum changes that the preset reads, and not when nothing does: by the rules that --depfile
/// writes, in a folder with a blank in its name.
#[test]
fn make_knows_what_a_bake_needs() {
    if std::process::Command::new("make").arg("--version").output().is_err() {
        eprintln!("skipped: there is no make here");
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let here = dir.path().join("my planets");
    fs::create_dir(&here).unwrap();
    let preset = include_str!("../../presets/planets/earth-paper.json").replace("earth-paper", "mine");
    let with_file = preset.replace("\"albedo\": 0.45", "\"albedo\": \"ground.csv\"");
    fs::write(here.join("mine.json"), with_file).unwrap();
    let ground = |share: f64| {
        let text = format!("# source: project choice: a test\nwavelength_nm,share\n400,0.1\n700,{share}\n");
        fs::write(here.join("ground.csv"), text).unwrap();
    };
    ground(0.3);
    let options = format!("--layout compact {}", SMALL[2..].join(" "));
    // A program of the test's own, which may be given another time. By other programs: a file that this process has
    // open for writing, if only in a child of another test, cannot be run.
    let run = |name: &str, arguments: &[&str]| {
        let status = std::process::Command::new(name).args(arguments).current_dir(&here).status();
        assert!(status.unwrap().success(), "{name}");
    };
    run("cp", &[env!("CARGO_BIN_EXE_tyndall"), "tyndall"]);
    let rule = format!(
        "out/mine/bake.json:\n\t./tyndall bake mine.json {options} --depfile bake.d\n-include bake.d\n"
    );
    fs::write(here.join("Makefile"), rule).unwrap();
    let make = || {
        let mut make = std::process::Command::new("make");
        let done = ran(make.current_dir(&here).env_remove("MAKEFLAGS").output().unwrap());
        assert_eq!(done.code, Some(0), "{}{}", done.out, done.err);
        done.out
    };
    assert!(make().contains(" files, "));
    let depfile = fs::read_to_string(here.join("bake.d")).unwrap();
    assert!(depfile.starts_with("out/mine/bake.json:") && depfile.contains("ground.csv"), "{depfile}");
    assert!(make().contains("up to date"));
    std::thread::sleep(std::time::Duration::from_millis(20));
    ground(0.4);
    assert!(make().contains(" files, "));
    assert!(manifest(&here.join("out/mine"))["preset"].to_string().contains("0.4"));
    // Another build of the same algorithms: asked once, with nothing to do, and not again.
    std::thread::sleep(std::time::Duration::from_millis(20));
    run("touch", &["tyndall"]);
    assert!(make().contains("there already"));
    assert!(make().contains("up to date"));
}
