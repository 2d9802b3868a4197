//! What fuzzing runs, a function for each kind of input: it panics where an input is neither refused in one line nor
//! taken as something sound. Shared by the targets of cargo-fuzz and by the test `fuzzed`, which needs no fuzzer.

mod any_bake;
mod bakes;
mod choices;
mod edits;
mod options;
mod package;
mod presets;
mod solver;
mod tables;

use std::path::Path;

/// Takes any bytes.
pub type Body = fn(&[u8]);

/// Name and function of every kind of input.
pub const ALL: [(&str, Body); 18] = [
    ("planet", presets::planet),
    ("water", presets::water),
    ("scene", presets::scene),
    ("set", presets::set),
    ("solve", solver::solve),
    ("points", tables::points),
    ("spectra", tables::spectra),
    ("spectrum", tables::spectrum),
    ("chart", tables::chart),
    ("options", options::bake),
    ("list", options::planets),
    ("exr", bakes::exr),
    ("skies", bakes::skies),
    ("manifest", bakes::manifest),
    ("package", package::tables),
    ("folder", bakes::folder),
    ("recolour", bakes::recoloured),
    ("any_bake", any_bake::any_bake),
];

/// Runs the function of a name.
#[allow(dead_code, reason = "the targets run by name, the test runs all")]
pub fn run(name: &str, bytes: &[u8]) {
    let (_, body) = ALL.iter().find(|a| a.0 == name).expect("a target of that name");
    body(bytes)
}

/// A refusal is of the input, and one line without anything that a terminal takes for a command.
fn refused(error: &tyndall::Error) {
    assert_eq!(error.exit_code(), 2, "{error}");
    one_line(&error.to_string());
}

fn one_line(text: &str) {
    assert!(!text.contains(|c: char| c.is_control()) && text.len() < 100_000, "{text:?}");
}

/// A file's name in messages.
fn file() -> &'static Path {
    Path::new("fuzzed")
}

/// Whether a number of something physical is one.
fn good(v: f64) -> bool {
    v.is_finite() && v >= 0.0
}
