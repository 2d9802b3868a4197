//! `tyndall presets` as a process.

use std::process::{Command, Output};

fn tyndall(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tyndall")).arg("presets").args(arguments).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The list has every shipped preset with its description, and it is what comes without a word.
#[test]
fn list_names_what_is_shipped() {
    let text = stdout(&tyndall(&["list"]));
    assert_eq!(text, stdout(&tyndall(&[])));
    for (name, description) in tyndall::preset::shipped() {
        assert!(description.len() > 20 && text.contains(name) && text.contains(&description), "{text}");
    }
    let json: serde_json::Value = serde_json::from_str(&stdout(&tyndall(&["list", "--json"]))).unwrap();
    assert_eq!(json[0]["name"], "earth");
}

/// `show --json` holds a preset that is the preset: it can be read back, and the hash is its own. The optical
/// depths shown are those of the medium.
#[test]
fn show_tells_the_whole_preset() {
    let output = tyndall(&["show", "earth-paper", "--json", "--wavelengths", "440,550"]);
    let report: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let planet = tyndall::preset::Planet::from_resolved(&report["preset"]).unwrap();
    assert_eq!(report["hash"], planet.hash());
    let depth = planet.medium(&[440.0, 550.0]).vertical_optical_depth();
    assert_eq!(report["physics"]["optical_depth"], serde_json::json!(depth));
    let denser = tyndall(&["show", "earth-paper", "--set", "constituents.aerosol.density_factor=10"]);
    let text = stdout(&denser);
    assert!(text.contains("density factor 10") && text.contains("0.25200"), "{text}");
}

/// `check` says one line a file, goes on after a bad one and leaves with 2.
#[test]
fn check_counts_bad_files() {
    let folder = tempfile::tempdir().unwrap();
    let good = include_str!("../presets/planets/earth-paper.json");
    std::fs::write(folder.path().join("a.json"), good.replace("0.76,", "1.76,")).unwrap();
    std::fs::write(folder.path().join("b.json"), good).unwrap();
    std::fs::write(folder.path().join("c.json"), "{").unwrap();
    let output = tyndall(&["check", folder.path().to_str().unwrap()]);
    let text = stdout(&output);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(output.status.code(), Some(2));
    assert!(lines.len() == 3 && lines[1].starts_with("ok "), "{text}");
    assert!(
        lines[0].starts_with("bad ") && lines[0].contains("a.json: constituents[1].phase.g = 1.76"),
        "{text}"
    );
    assert!(lines[2].contains("c.json: malformed JSON") && lines[2].contains("line 1 column 1"), "{text}");
    assert!(String::from_utf8_lossy(&output.stderr).contains("2 of 3"));
    assert!(tyndall(&["check"]).status.success());
}

/// Wrong names and wrong paths are input errors that name what was meant.
#[test]
fn slips_are_named() {
    for (arguments, meant) in [
        (&["show", "erth"][..], "`earth`"),
        (&["show", "earth", "--set", "grond.albedo=0"], "`ground`"),
        (&["show", "earth", "--set", "ground.albdo=0"], "`albedo`"),
        (&["show", "earth", "--wavelengths", "0"], "between 200 and 4000"),
        (&["check", "no-such-file.json"], "1 of 1"),
    ] {
        let output = tyndall(arguments);
        let talk = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(talk.contains(meant), "{arguments:?}: {talk}");
    }
}
