//! Every help opens with an example that works.

use super::run::*;
use clap::Args;
use std::fs;
use tyndall::internals::commands;

pub const COMMANDS: [&str; 14] = [
    "bake",
    "diff",
    "recolour",
    "sample",
    "reference",
    "verify",
    "chart",
    "plan",
    "colour",
    "presets",
    "presets list",
    "presets show",
    "presets check",
    "presets schema",
];

/// The command lines with which a help opens.
fn examples(command: &str) -> Vec<String> {
    let done = words(&format!("{command} --help"));
    assert_eq!(done.code, Some(0));
    let text = done.out.strip_prefix("Example: ").unwrap_or_else(|| panic!("{command}: {}", done.out));
    let lines = text.lines().take_while(|line| !line.is_empty()).map(|line| line.split('#').next().unwrap());
    lines.flat_map(|line| line.split(" && ")).map(|line| line.trim().to_string()).collect()
}

/// What the command's own parser says to an example.
fn parse(example: &str) -> Result<(), clap::Error> {
    let words: Vec<&str> = example.split_whitespace().collect();
    assert_eq!(words[0], "tyndall", "{example}");
    let named = clap::Command::new("tyndall");
    let parser = match words[1] {
        "bake" => commands::bake::Args::augment_args(named),
        "sample" => commands::sample::Args::augment_args(named),
        "reference" => commands::reference::Args::augment_args(named),
        "diff" => commands::diff::Args::augment_args(named),
        "recolour" => commands::recolour::Args::augment_args(named),
        "verify" => commands::verify::Args::augment_args(named),
        "chart" => commands::chart::Args::augment_args(named),
        "plan" => commands::plan::Args::augment_args(named),
        "colour" => commands::colour::Args::augment_args(named),
        "presets" => commands::presets::Args::augment_args(named),
        other => panic!("{example}: {other} is not tested"),
    };
    parser.try_get_matches_from(&words[1..]).map(drop)
}

/// Every example is one of the command whose help it opens, and its arguments are understood. A slip in one of
/// them would not be, or the test could not fail.
#[test]
fn examples_are_understood() {
    assert!(examples("").iter().all(|example| parse(example).is_ok()));
    for command in COMMANDS {
        for example in examples(command) {
            assert!(example.starts_with(&format!("tyndall {command}")), "{command}: {example}");
            parse(&example).unwrap_or_else(|e| panic!("{example}: {e}"));
            assert!(parse(&format!("{example} --no-such-option")).is_err());
        }
    }
}

/// Every command in the list of commands is tested here.
#[test]
fn no_command_is_left_out() {
    let help = words("--help").out;
    let list = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let listed = list.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    for command in listed.filter_map(|line| line.split_whitespace().next()).filter(|name| *name != "help") {
        assert!(COMMANDS.contains(&command), "{command}");
    }
}

/// Examples run as they are printed, in a folder with the files that they name; those of minutes are left out.
#[test]
fn examples_run() {
    let (dir, bake) = earth_to_damage();
    let here = dir.path();
    fs::create_dir(here.join("out")).unwrap();
    fs::rename(bake, here.join("out/earth")).unwrap();
    fs::write(here.join("views.csv"), VIEWS).unwrap();
    fs::write(here.join("spectra.csv"), "wavelength_nm,a\n400,1\n700,2\n").unwrap();
    fs::create_dir(here.join("my-planets")).unwrap();
    let preset = concat!(env!("CARGO_MANIFEST_DIR"), "/presets/planets/earth-paper.json");
    for place in ["my-planet.json", "my-planets/a.json"] {
        fs::copy(preset, here.join(place)).unwrap();
    }
    for example in COMMANDS.iter().flat_map(|command| examples(command)) {
        let words: Vec<&str> = example.split_whitespace().skip(1).collect();
        if ["bake", "plan", "reference", "chart"].contains(&words[0]) {
            continue;
        }
        let done = ran(command().args(&words).current_dir(here).output().unwrap());
        assert_eq!(done.code, Some(0), "{example}: {}", done.err);
        assert!(!done.out.is_empty(), "{example}");
    }
}
