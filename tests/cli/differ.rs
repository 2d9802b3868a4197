//! `tyndall diff`: what it finds, against differences that are known beforehand.

use super::run::*;
use serde_json::Value;
use std::path::Path;

fn diff(a: &Path, b: &Path, more: &[&str]) -> Ran {
    let mut command = command();
    ran(command.arg("diff").arg(a).arg(b).args(more).output().unwrap())
}

fn told(a: &Path, b: &Path, more: &[&str]) -> (Option<i32>, Value) {
    let done = diff(a, b, &[more, &["--json"]].concat());
    assert!(!done.out.is_empty(), "{}", done.err);
    (done.code, serde_json::from_str(&done.out).unwrap())
}

fn numbers<'a>(told: &'a Value, what: &'a str, which: &'a str) -> impl Iterator<Item = f64> + 'a {
    told["views"].as_array().unwrap().iter().map(move |v| v[what][which].as_f64().unwrap())
}

/// A bake against itself: no difference, under the strictest tolerance.
#[test]
fn itself() {
    let done = diff(earth(), earth(), &["--tolerance", "0", "--tolerance-delta-e", "0"]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.ends_with("no difference\n"), "{}", done.out);
    let (_, told) = told(earth(), earth(), &[]);
    assert_eq!((&told["same"], told["changes"].as_array().unwrap().len()), (&true.into(), 0));
}

/// A star twice as bright: every view by half of the larger, in every region and layout; what is stored over the
/// star's irradiance is the same, what is stored in cd/m² differs by half; L* goes from 49.5 to 66.5 wherever
/// one looks, a ΔE2000 of 15.4 for a grey and little more for a sky.
#[test]
fn a_star_twice_as_bright() {
    let dir = tempfile::tempdir().unwrap();
    // At 1/√2 of the distance there is twice the light, and the disc is larger, which no table sees.
    let near =
        bake("earth-paper", &dir.path().join("near"), &["--set", "star.distance_au=0.70710678118654752"]);
    let far = bake("earth-paper", &dir.path().join("far"), &[]);
    let (code, told) = told(&far, &near, &[]);
    assert_eq!(code, Some(0));
    for median in numbers(&told, "radiance", "median") {
        assert!((median - 0.5).abs() < 1e-3, "{median}");
    }
    assert!(numbers(&told, "delta_e_2000", "median").all(|d| (15.3..16.0).contains(&d)), "{}", told["views"]);
    let tables = told["tables"].as_array().unwrap();
    let table = |name: &str| tables.iter().find(|t| t["table"] == name).unwrap();
    assert_eq!(table("compact/transmittance")["same"], true);
    let keys: Vec<&str> =
        told["changes"].as_array().unwrap().iter().map(|c| c["key"].as_str().unwrap()).collect();
    assert!(keys.contains(&"preset.star.distance_m") && keys.iter().all(|k| !k.contains("constituents")));
    assert_eq!(diff(&far, &near, &["--tolerance", "51%"]).code, Some(0));
    let beyond = diff(&far, &near, &["--tolerance", "49%"]);
    assert_eq!(beyond.code, Some(1), "{}", beyond.err);
    assert!(beyond.err.contains("beyond the tolerance: "), "{}", beyond.err);
}

/// Tables of other sizes, layouts and wavelengths are told apart, and views are compared all the same, as luminance
/// where the wavelengths are others. A tolerance holds for what cannot be compared too.
#[test]
fn other_settings() {
    let dir = tempfile::tempdir().unwrap();
    let one = bake("earth", &dir.path().join("one"), &["--layout", "compact", "--wavelengths", "7"]);
    let (code, told) = told(earth(), &one, &["--tolerance", "1000%"]);
    assert_eq!(code, Some(1));
    let tables = told["tables"].as_array().unwrap();
    assert!(tables.iter().any(|t| t["table"] == "elek2010/scattering" && t["reason"] == "is in A only"));
    assert!(told["views"].as_array().unwrap().iter().all(|v| v["layout"] == "compact"));
    let text = told["changes"].to_string();
    assert!(text.contains("settings.layouts") && text.contains("wavelengths_nm"), "{text}");
    assert_eq!(told["views"][0]["quantity"], "luminance");
    let day = numbers(&told, "radiance", "median").next().unwrap();
    assert!(day > 0.0 && day < 0.2, "the same planet by day, a little off: {day}");
}

/// A table whose file is damaged is an error of the input, not a difference; so is a folder that is no bake.
#[test]
fn damaged_bakes() {
    let (dir, bake) = earth_to_damage();
    std::fs::write(bake.join("compact/multiple.exr"), "x").unwrap();
    let done = diff(earth(), &bake, &[]);
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{}", done.err);
    assert!(done.err.contains("compact/multiple.exr"), "{}", done.err);
    assert_eq!(diff(earth(), dir.path(), &[]).code, Some(2));
    assert_eq!(diff(earth(), earth(), &["--tolerance", "-1"]).code, Some(2));
}
