//! Planets that lack something: each bakes, and its light is what physics leaves of it.

use super::run::*;
use serde_json::Value;
use std::f64::consts::PI;
use std::fs;
use std::path::PathBuf;

const ALBEDO: f64 = 0.294;

/// A small bake of `earth` with only some of its constituents.
fn bake_of(constituents: &[&str], more: &[&str]) -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    let text = fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/presets/planets/earth.json")).unwrap();
    let mut planet: Value = serde_json::from_slice(&text).unwrap();
    planet["name"] = "part".into();
    let kept = |c: &Value| constituents.contains(&c["name"].as_str().unwrap());
    planet["constituents"].as_array_mut().unwrap().retain(kept);
    assert_eq!(planet["constituents"].as_array().unwrap().len(), constituents.len());
    let file = dir.path().join("part.json");
    fs::write(&file, planet.to_string()).unwrap();
    let bake = bake(file.to_str().unwrap(), dir.path(), more);
    (dir, bake)
}

/// Without air the sky is black and the ground sends back albedo / π of the light.
#[test]
fn vacuum() {
    let (_dir, bake) = bake_of(&[], &["--layout", "compact"]);
    sound(&bake);
    let answers = sample(&bake, &[]);
    assert!(answers[ZENITH].iter().all(|v| *v == 0.0), "{answers:?}");
    assert!(answers[NADIR].iter().all(|v| (v * PI / ALBEDO - 1.0).abs() < 1e-4), "{answers:?}");
}

/// Ozone alone scatters nothing: a black sky, and ground light dimmed by the optical depth of ozone twice.
#[test]
fn an_absorber_alone() {
    let (_dir, bake) = bake_of(&["ozone"], &["--layout", "compact"]);
    sound(&bake);
    let answers = sample(&bake, &[]);
    assert!(answers[ZENITH].iter().all(|v| *v == 0.0), "{answers:?}");
    let nm: Vec<f64> =
        serde_json::from_value(manifest(&bake)["constants"]["four_wavelengths_nm"].clone()).unwrap();
    let depth = tyndall::internals::preset::load(
        "earth",
        &["constituents.air=null".into(), "constituents.aerosol=null".into()],
    )
    .unwrap()
    .medium(&nm)
    .vertical_optical_depth();
    for (radiance, depth) in answers[NADIR].iter().zip(depth) {
        let left = ALBEDO / PI * libm::exp(-2.0 * depth);
        assert!((radiance / left - 1.0).abs() < 1e-3, "{radiance} is not {left}");
    }
}

/// The paper's layout of planets on which nothing scatters.
#[test]
fn nothing_scatters_in_the_layout_of_the_paper() {
    for constituents in [&[][..], &["ozone"]] {
        let (_dir, bake) = bake_of(constituents, &[]);
        sound(&bake);
        assert!(sample(&bake, &["--layout", "elek2010"])[ZENITH].iter().all(|v| *v == 0.0));
    }
}

/// Gas scatters blue light most, and so is the sky at noon; aerosol does not nearly as much.
#[test]
fn gas_alone_and_aerosol_alone() {
    let mut blueness = Vec::new();
    for constituent in ["air", "aerosol"] {
        let (_dir, bake) = bake_of(&[constituent], &[]);
        sound(&bake);
        let sky = sample(&bake, &["--layout", "compact"])[ZENITH].clone();
        let rgb = sample(&bake, &["--layout", "elek2010"])[ZENITH].clone();
        assert!(sky.iter().chain(&rgb).all(|v| *v > 0.0), "{constituent}: {sky:?} {rgb:?}");
        let singles = manifest(&bake)["tables"]
            .as_array()
            .unwrap()
            .iter()
            .filter(|t| t["name"].as_str().unwrap().starts_with("single_"))
            .count();
        assert_eq!(singles, 1, "{constituent}");
        blueness.push(sky[0] / sky[3]);
    }
    assert!(blueness[0] > 3.0 && blueness[1] < 2.0, "{blueness:?}");
}
