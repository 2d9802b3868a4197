//! Any text as a water's preset: refused in one line, or a water that can be computed with.
#![no_main]

use libfuzzer_sys::fuzz_target;
use tyndall::preset::{self, Water};

fuzz_target!(|text: &str| match preset::read_water("fuzz.json", text, &[]) {
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    Ok(water) => {
        let medium = water.medium(&[400.0, 550.0, 700.0]);
        assert!(medium.absorption.iter().all(|v| v.is_finite() && *v >= 0.0));
        assert!(medium.refractive_index.iter().all(|n| *n >= 1.0));
        assert!(Water::from_resolved(&water.resolved()).is_ok_and(|w| w == water));
    }
});
