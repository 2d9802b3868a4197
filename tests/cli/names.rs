//! Names that nobody knows, and names of another kind than is wanted: said at once, before anything is written.

use super::run::*;
use std::fs;
use std::path::Path;

fn refused(line: &str, reasons: &[&str]) {
    let done = words(line);
    assert_eq!(done.code, Some(2), "{line}: {}", done.err);
    assert!(done.out.is_empty(), "{line}: {}", done.out);
    for reason in reasons {
        assert!(done.err.contains(reason), "{line}: {reason} is not in: {}", done.err);
    }
}

/// What is given where another kind is wanted is called by its own name, with the command that takes it.
#[test]
fn a_name_of_another_kind_is_told() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().display();
    for (line, reason) in [
        (
            "bake clear-ocean",
            "`clear-ocean` is a water, not a planet: `tyndall bake PLANET --waters clear-ocean`",
        ),
        ("bake compact", "`compact` is a layout, not a planet: `tyndall bake PLANET --layout compact`"),
        ("bake walk", "`walk` is a scene, not a planet: `tyndall plan walk`"),
        ("bake earth --waters mars", "`mars` is a planet, not a water"),
        ("bake earth --waters compact", "`compact` is a layout, not a water"),
    ] {
        refused(&format!("{line} --out {out}"), &[reason]);
    }
    refused("plan earth", &["`earth` is a planet, not a scene: `tyndall bake earth`"]);
    refused("presets show walk", &["`walk` is a scene, not a planet"]);
    assert!(names(dir.path()).is_empty());
}

/// Files too, by their keys: a water and a scene are no planets, whatever their names; nor is a bake's manifest.
#[test]
fn a_file_of_another_kind_is_told() {
    let presets = concat!(env!("CARGO_MANIFEST_DIR"), "/presets");
    refused(
        &format!("bake {presets}/waters/muddy.json"),
        &["muddy.json is a water, not a planet", "--waters"],
    );
    refused(&format!("bake {presets}/scenes/walk.json"), &["walk.json is a scene, not a planet", "plan"]);
    refused(&format!("bake {}/bake.json", earth().display()), &["is the manifest of a bake, not a planet"]);
    refused(&format!("bake earth --waters {presets}/planets/mars.json"), &["is a planet, not a water"]);
    refused(&format!("plan {presets}/planets/mars.json"), &["mars.json is a planet, not a scene"]);
}

/// A scene is a preset that can be checked, with the planet and the waters that it names.
#[test]
fn scenes_are_checked() {
    let dir = tempfile::tempdir().unwrap();
    let good = include_str!("../../presets/scenes/ocean.json");
    let at = |name: &str, text: &str| {
        let file = dir.path().join(name);
        fs::write(&file, text).unwrap();
        words(&format!("presets check {}", file.display()))
    };
    let done = words("presets check walk ocean");
    assert_eq!(
        (done.code, done.out.matches("a scene of earth").count()),
        (Some(0), 2),
        "{}{}",
        done.out,
        done.err
    );
    assert_eq!(at("a.json", good).code, Some(0));
    for (from, to, reason) in [
        ("\"tolerance\"", "\"tolerence\"", "unknown key; the nearest known one is `tolerance`"),
        ("\"earth\"", "\"erth\"", "no preset is called `erth`; the nearest is `earth`"),
    ] {
        let text = good.replacen(from, to, 1);
        assert_ne!(text, good);
        let done = at("b.json", &text);
        assert!(done.code == Some(2) && done.out.contains(reason), "{}{}", done.out, done.err);
    }
}

/// One unknown name among good ones, a path to nothing, a key of --set that one of the planets has not, a constituent
/// to fold that is not there: nothing is written at all.
#[test]
fn a_slip_among_several_names_stops_the_run() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("out");
    let run = |presets: &[&str], more: &[&str]| {
        let mut command = small_bake(presets[0], &out, more);
        ran(command.args(&presets[1..]).output().unwrap())
    };
    for (presets, more, reason) in [
        (&["earth", "marz", "venuz"][..], &[][..], "2 of 3 presets were refused; nothing was baked"),
        (&["earth", "marz"], &[], "error: no preset is called `marz`; the nearest is `mars`"),
        (&["earth", "no-such.json"], &[], "error: no-such.json: No such file"),
        (&["earth", "mars"], &["--set", "constituents.ozone.density_factor=2"], "--set constituents.ozone"),
        (&["earth", "mars"], &["--fold", "aerosol"], "--fold aerosol: nothing of that name scatters here"),
        (&["earth"], &["--waters", "clear-ocean,mudy"], "no water is called `mudy`; the nearest is `muddy`"),
        (&["earth"], &["--layout", "compact,elek2011"], "elek2011"),
        (&["earth"], &["--size", "compakt=4x8x6x3"], "compakt is not one of elek2010"),
    ] {
        let done = run(presets, more);
        assert!(done.code == Some(2) && done.err.contains(reason), "{presets:?} {more:?}: {}", done.err);
        assert!(!out.exists() || names(&out).is_empty(), "{presets:?} {more:?}");
    }
    let list = dir.path().join("list");
    fs::write(&list, "earth\nmarz\n").unwrap();
    let done = words(&format!("bake --list {} --out {}", list.display(), out.display()));
    assert!(done.code == Some(2) && done.err.contains("1 of 2 presets were refused"), "{}", done.err);
    assert!(!Path::new(&out).exists() || names(&out).is_empty());
}

/// A layout that a bake has not is refused with those that it has.
#[test]
fn a_layout_that_is_not_there_is_named() {
    let dir = tempfile::tempdir().unwrap();
    let points = dir.path().join("v.csv");
    fs::write(&points, VIEWS).unwrap();
    let line = format!("sample {} --points {} --layout", earth().display(), points.display());
    refused(
        &format!("{line} compakt"),
        &["--layout compakt: not in this bake; the nearest known one is `compact`"],
    );
    refused(&format!("{line} bruneton"), &["known are `elek2010`, `compact`"]);
}

/// A bake in the place of one that had more layouts says which are gone.
#[test]
fn a_layout_that_goes_is_told() {
    let dir = tempfile::tempdir().unwrap();
    bake("earth", dir.path(), &[]);
    let out = dir.path().to_str().unwrap();
    let small = SMALL.join(" ");
    let done = words(&format!("bake earth --out {out} {small} --layout compact"));
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.err.contains("layout elek2010 of the bake before is gone"), "{}", done.err);
    let done = words(&format!("bake earth --out {out} {small} --layout compact --force"));
    assert!(!done.err.contains("is gone"), "{}", done.err);
}
