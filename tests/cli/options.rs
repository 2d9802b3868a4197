//! Each option of `bake` does what it says.

use super::run::*;
use serde_json::{Value, json};
use tempfile::{TempDir, tempdir};

/// A bake with options, found sound, with its manifest.
fn baked(options: &str) -> (TempDir, std::path::PathBuf, Value) {
    let dir = tempdir().unwrap();
    let bake = bake("earth", dir.path(), &options.split_whitespace().collect::<Vec<_>>());
    sound(&bake);
    let manifest = manifest(&bake);
    (dir, bake, manifest)
}

/// More orders are more light; the manifest says how many; a number too small is warned of, and `auto` is not
/// too small and leaves less than its tolerance.
#[test]
fn orders() {
    let mut last = 0.0;
    for n in [1, 3] {
        let (_dir, bake, manifest) = baked(&format!("--orders {n} --layout compact"));
        assert_eq!(manifest["settings"]["orders"], json!({ "first": n }));
        assert!(manifest["warnings"].to_string().contains("--orders auto sums all"));
        let zenith = sample(&bake, &[])[ZENITH][0];
        assert!(zenith > last, "{n}: {zenith}");
        last = zenith;
    }
    let (_dir, bake, manifest) = baked("--orders auto --layout compact");
    assert!(!manifest["warnings"].to_string().contains("orders"), "{}", manifest["warnings"]);
    assert!(sample(&bake, &[])[ZENITH][0] > last);
}

/// One wavelength, fewer than the four of the compact layout, a list, and more than a pass of the solver.
#[test]
fn wavelengths() {
    let warned = |manifest: &Value| manifest["warnings"].to_string().contains("lie outside 380 to 780 nm");
    for (given, count) in [("1", 1), ("440,550,680", 3), ("17", 17)] {
        let (_dir, bake, manifest) = baked(&format!("--wavelengths {given} --layout compact"));
        assert!(!warned(&manifest), "{}", manifest["warnings"]);
        let nm = manifest["wavelengths"]["nm"].as_array().unwrap();
        assert_eq!(nm.len(), count, "{given}");
        let four = manifest["constants"]["four_wavelengths_nm"].as_array().unwrap();
        assert_eq!(four.len(), count.min(4), "{given}");
        assert!(four.iter().all(|w| nm.contains(w)), "{given}");
        assert_eq!(sample(&bake, &["--layout", "compact"])[ZENITH].len(), count.min(4));
    }
    let (_dir, _bake, outside) = baked("--wavelengths 300,550,900 --layout compact");
    assert!(warned(&outside), "{}", outside["warnings"]);
    assert_eq!(outside["wavelengths"]["nm"], json!([300.0, 550.0, 900.0]));
}

/// Algorithm 1 taken literally, with tables this small, still sees about the sky that the solver sees: half to
/// twice of it at the zenith by day.
#[test]
fn the_literal_solver() {
    let (_dir, literal, manifest) = baked("--solver literal --layout elek2010");
    assert!(manifest["settings"]["solver"]["literal"]["samples"].as_u64().is_some());
    let (a, b) = (sample(&literal, &[]), sample(earth(), &["--layout", "elek2010"]));
    for (a, b) in a[ZENITH].iter().zip(&b[ZENITH]) {
        assert!((0.5..2.0).contains(&(a / b)), "{a} for {b}");
    }
}

/// A layout alone is a folder alone, and its bytes are those that it has beside the other.
#[test]
fn layouts() {
    let all = files(earth());
    for layout in ["elek2010", "compact"] {
        let (_dir, bake, _) = baked(&format!("--layout {layout}"));
        assert_eq!(names(&bake), ["bake.json", layout, "preview.png"]);
        let name = format!("{layout}/scattering.exr").replace("compact/scattering", "compact/multiple");
        let alone = files(&bake);
        assert!(alone.contains_key(&name) && all.contains_key(&name), "{name}");
        assert!(
            all.keys().filter(|f| f.starts_with(layout)).eq(alone.keys().filter(|f| f.starts_with(layout)))
        );
    }
}

/// A size is what the manifest says and what the files hold (`verify` compares the two).
#[test]
fn sizes() {
    let (_dir, _bake, manifest) = baked("--size 6x10x4x2 --size compact=2x4x3x2");
    let shape = |file: &str| {
        let tables = manifest["tables"].as_array().unwrap();
        tables.iter().find(|t| t["file"] == file).unwrap()["shape"].clone()
    };
    assert_eq!(shape("elek2010/scattering.exr"), json!([6, 10, 4, 2]));
    assert_eq!(shape("compact/multiple.exr"), json!([2, 4, 3, 2]));
    assert_eq!(shape("compact/single_air.exr"), json!([4, 8, 6, 3]));
}

/// Spectral files have a channel for each wavelength, named as other readers expect (Fichet et al. 2021).
#[test]
fn spectral_files() {
    let (_dir, bake, manifest) = baked("--spectral --wavelengths 440,550,680");
    for name in ["gas", "aerosol"] {
        let file = bake.join(format!("spectral/scattering_{name}.exr"));
        let image = exr::prelude::read_first_flat_layer_from_file(&file).unwrap();
        let channels = &image.layer_data.channel_data.list;
        let held: Vec<String> = channels.iter().map(|c| c.name.to_string()).collect();
        assert_eq!(held, ["S0.440,000000nm", "S0.550,000000nm", "S0.680,000000nm"]);
        let values: Vec<f32> = channels.iter().flat_map(|c| c.sample_data.values_as_f32()).collect();
        assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0) && values.iter().any(|v| *v > 0.0));
        assert!(manifest["files"].to_string().contains(&format!("spectral/scattering_{name}.exr")));
    }
}

/// Wider primaries have other numbers for the same light: luminance, from the second row of each space's matrix
/// to XYZ, stays.
#[test]
fn colour_spaces() {
    let mut luminances = Vec::new();
    for (space, y) in [("srgb", [0.2126, 0.7152, 0.0722]), ("rec2020", [0.2627, 0.6780, 0.0593])] {
        let (_dir, bake, manifest) = baked(&format!("--colour-space {space} --layout elek2010"));
        assert_eq!(manifest["colour"]["space"], space);
        let rgb = sample(&bake, &[])[NADIR].clone();
        luminances.push(rgb.iter().zip(y).map(|(v, y)| v * y).sum::<f64>());
    }
    assert!((luminances[1] / luminances[0] - 1.0).abs() < 0.01, "{luminances:?}");
}

/// `--set` changes the planet that is baked, and the manifest holds the changed one.
#[test]
fn set_changes_the_planet() {
    let (_dir, bake, manifest) = baked("--layout compact --set constituents.aerosol.density_factor=10");
    assert_eq!(manifest["preset"]["resolved"]["constituents"][2]["density_factor"], json!(10.0));
    let (dusty, clear) = (sample(&bake, &[]), sample(earth(), &[]));
    assert!(dusty[1][0] != clear[1][0] && dusty[ZENITH][3] > 1.5 * clear[ZENITH][3], "{dusty:?} {clear:?}");
}

/// Several presets in one run, and the time of each stage where it is asked for.
#[test]
fn several_presets() {
    let dir = tempdir().unwrap();
    let mut both = small_bake("earth", dir.path(), &["--layout", "compact", "--perf"]);
    let done = ran(both.arg("earth-paper").output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(done.out.matches(" s CPU").count() > 8, "{}", done.out);
    for name in ["earth", "earth-paper"] {
        holds(&dir.path().join(name));
        assert_eq!(manifest(&dir.path().join(name))["preset"]["name"], name);
    }
}
