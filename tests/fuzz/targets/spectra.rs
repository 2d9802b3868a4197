//! Any text as a CSV of spectra: refused in one line, or spectra with a value everywhere.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;
use tyndall::commands::colour_input::parse;

fuzz_target!(|text: &str| match parse(Path::new("fuzz.csv"), text) {
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    Ok(list) => assert!(list.iter().all(|s| s.spectrum.at(550.0).is_finite())),
});
