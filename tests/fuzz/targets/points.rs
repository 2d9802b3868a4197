//! Any bytes as a CSV of views: refused in one line, or views that can be answered.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::path::Path;
use tyndall::points::parse_points;

fuzz_target!(|bytes: &[u8]| match parse_points(Path::new("fuzz.csv"), bytes) {
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    Ok(points) => assert!(points.iter().all(|p| p.altitude >= 0.0 && p.nu().is_finite())),
});
