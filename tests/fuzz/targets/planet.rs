//! Any text as a planet's preset: refused in one line, or a planet that can be computed with.
#![no_main]

use libfuzzer_sys::fuzz_target;
use tyndall::preset::{self, Planet};

fuzz_target!(|text: &str| match preset::read("fuzz.json", text, &[]) {
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    Ok(planet) => {
        let medium = planet.medium(&[400.0, 550.0, 700.0]);
        assert!(medium.vertical_optical_depth().iter().all(|d| d.is_finite() && *d >= 0.0));
        let phases = medium.constituents.iter().flat_map(|c| &c.phase).map(|p| p.value(0.3));
        assert!(phases.into_iter().all(|v| v.is_finite() && v >= 0.0));
        assert!(Planet::from_resolved(&planet.resolved()).is_ok_and(|p| p == planet));
    }
});
