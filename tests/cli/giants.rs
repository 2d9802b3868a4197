//! Planets unlike ours: air that is black at a wavelength, and air that no light gets through.

use super::run::{bake, manifest, sound};
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

/// A giant whose gas takes all light at some red wavelengths, as methane does.
fn methane() -> Value {
    let exponential = json!({ "kind": "exponential", "scale_height_km": 28, "source": "x" });
    let band = [1e-12, 2e-12, 1e-6, 1e-5, 1e-6, 2e-3, 1e-5, 2e-3];
    json!({
        "name": "giant",
        "description": "x",
        "ground": { "radius_km": 25000, "albedo": 0.5, "source": "x" },
        "top": { "height_km": 500, "source": "x" },
        "star": { "black_body_k": 5772, "radius_km": 695_700, "distance_au": 19, "source": "x" },
        "constituents": [
            {
                "name": "gas",
                "role": "gas",
                "profile": exponential,
                "scattering": { "kind": "power_law", "per_km": 5e-4, "at_nm": 550, "angstrom_exponent": 4, "source": "x" },
                "phase": { "kind": "rayleigh" },
            },
            {
                "name": "methane",
                "role": "gas",
                "profile": exponential,
                "absorption": {
                    "kind": "table",
                    "wavelengths_nm": [380, 500, 600, 619, 640, 725, 750, 780],
                    "per_m": band,
                    "source": "x",
                },
            },
        ],
    })
}

fn preset(folder: &Path, planet: &Value) -> PathBuf {
    let path = folder.join("planet.json");
    fs::write(&path, planet.to_string()).unwrap();
    path
}

fn small(planet: &Value, more: &[&str]) -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    let path = preset(dir.path(), planet);
    let baked = bake(path.to_str().unwrap(), &dir.path().join("out"), more);
    (dir, baked)
}

fn warnings(bake: &Path) -> Vec<String> {
    let manifest = manifest(bake);
    manifest["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap().to_string()).collect()
}

/// Wavelengths that never reach the ground are a fact of the skies there: the four wavelengths span the spectrum, the
/// error of colours is that of real skies and is warned of where it is large, and those skies are kept for `recolour`.
#[test]
fn a_black_wavelength_leaves_skies_to_choose_by() {
    let window = ["--altitudes", "0m", "--views", "sky"];
    let (_dir, baked) =
        small(&methane(), &[&window[..], &["--wavelengths", "15", "--layout", "compact"]].concat());
    let found = manifest(&baked);
    let four: Vec<f64> = found["constants"]["four_wavelengths_nm"]
        .as_array()
        .unwrap()
        .iter()
        .map(|v| v.as_f64().unwrap())
        .collect();
    assert!(four[0] < 500.0 && four[3] > 580.0, "{four:?}");
    let error = &found["quality"]["colour"]["four_wavelengths_delta_e_2000"];
    assert!(error["median"].as_f64().unwrap() > 0.0, "{error}");
    let off = error["p95"].as_f64().unwrap();
    let told = warnings(&baked);
    assert_eq!(
        told.iter().any(|w| w.contains(&format!("of {off:.1} on one sky"))),
        off > 3.0,
        "{off}: {told:?}"
    );
    assert!(baked.join("compact/skies.exr").exists());
}

/// Wavelengths that leave out red are warned of with what was left out, and so is a planet without any sky to tell how
/// far colours are off.
#[test]
fn wavelengths_that_span_no_spectrum_are_warned_of() {
    let mut planet = methane();
    let (_dir, baked) = small(&planet, &["--wavelengths", "400,420,440,460,480", "--layout", "compact"]);
    let told = warnings(&baked);
    assert!(told.iter().any(|w| w.contains("400 to 480 nm do not span what eyes see")), "{told:?}");
    planet["constituents"] = json!([]);
    planet["ground"]["albedo"] = json!(0);
    let (_dir, baked) = small(&planet, &["--layout", "compact"]);
    assert!(!warnings(&baked).iter().any(|w| w.contains("span")), "five even wavelengths do");
}

/// Depths beyond what halves hold are stored by a scale that the manifest tells, and both layouts agree on the light.
#[test]
fn air_of_any_depth_is_stored() {
    for depth in [500.0, 90_000.0] {
        let mut planet = methane();
        planet["ground"] = json!({ "radius_km": 6371, "albedo": 0.3, "source": "x" });
        planet["constituents"] = json!([{
            "name": "air",
            "role": "gas",
            "profile": { "kind": "exponential", "scale_height_km": 8, "source": "x" },
            "scattering": { "kind": "power_law", "optical_depth": depth, "at_nm": 550, "angstrom_exponent": 0, "source": "x" },
            "phase": { "kind": "rayleigh" },
        }]);
        planet["top"]["height_km"] = json!(60);
        let (_dir, baked) = small(&planet, &["--wavelengths", "3"]);
        sound(&baked);
        let manifest = manifest(&baked);
        let tables = manifest["tables"].as_array().unwrap();
        let table = tables.iter().find(|t| t["file"] == "elek2010/transmittance.exr").unwrap();
        let scale = table["encoding"]["scale"].as_f64().unwrap();
        let deepest = scale * table["channels"][0]["range"][1].as_f64().unwrap();
        // Along the horizon there is more than straight up.
        assert!(deepest > 10.0 * depth && deepest < 1e3 * depth, "{depth}: {deepest}");
        assert_eq!(scale == 1.0, depth == 500.0, "{scale}");
        assert_eq!(libm::log2(scale).fract(), 0.0, "{scale}");
    }
}
