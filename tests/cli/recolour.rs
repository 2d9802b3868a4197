//! `tyndall recolour` against a bake of the same thing.

use super::run::*;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A small bake of `earth-paper` whose orders and wavelengths are enough for colours to mean something.
fn source(out: &Path, more: &[&str]) -> PathBuf {
    bake("earth-paper", out, &[&["--layout", "compact", "--wavelengths", "9"], more].concat())
}

fn recoloured(bake: &Path, out: &Path, more: &[&str]) -> PathBuf {
    let mut command = command();
    let done = ran(command.arg("recolour").arg(bake).arg("--out").arg(out).args(more).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    let folder = out.join("earth-paper");
    sound(&folder);
    folder
}

fn colour(bake: &Path) -> Value {
    let manifest = manifest(bake);
    serde_json::json!({ "colour": manifest["colour"], "four": manifest["constants"]["four_wavelengths_nm"],
        "star": manifest["constants"]["star_illuminance_lx"], "preset": manifest["preset"]["resolved"]["star"] })
}

/// Nothing asked for: every number of the colours is that of the source, to the last bit, and so are the tables.
#[test]
fn the_same_again() {
    let dir = tempfile::tempdir().unwrap();
    let one = source(dir.path(), &["--colour-space", "acescg"]);
    let other = recoloured(&one, &dir.path().join("again"), &[]);
    assert_eq!(colour(&one), colour(&other));
    let (before, after) = (files(&one), files(&other));
    assert!(before.keys().eq(after.keys()));
    assert!(before.iter().all(|(file, bytes)| file == "bake.json" || after[file] == *bytes));
}

/// A star of 4000 K, and wide primaries: the numbers are those of a bake under that star, to the last bit where that bake
/// chooses the same four wavelengths, and the light that both answer is one and the same.
#[test]
fn another_star_and_space() {
    let dir = tempfile::tempdir().unwrap();
    let one = source(&dir.path().join("sun"), &[]);
    let wanted = ["--colour-space", "aces2065-1", "--white", "star", "--adaptation", "cat02"];
    let baked =
        source(&dir.path().join("baked"), &[&wanted[..], &["--set", "star.black_body_k=4000"]].concat());
    let other = recoloured(&one, &dir.path().join("red"), &[&wanted[..], &["--star", "4000"]].concat());
    let (found, expected) = (colour(&other), colour(&baked));
    assert_eq!(found["star"], expected["star"]);
    assert_eq!(found["preset"], expected["preset"]);
    assert_eq!(
        found["colour"]["matrices"]["rgb_from_all_wavelengths"],
        expected["colour"]["matrices"]["rgb_from_all_wavelengths"]
    );
    assert_eq!(found["colour"]["adaptation"], expected["colour"]["adaptation"]);
    if found["four"] == expected["four"] {
        assert_eq!(found, expected);
        for language in ["wgsl", "glsl", "hlsl"] {
            let file = format!("compact/lookup.{language}");
            let [before, found, wanted] =
                [&one, &other, &baked].map(|bake| std::fs::read_to_string(bake.join(&file)).unwrap());
            assert!(found == wanted && found != before, "{file}");
        }
    }
    let told = words(&format!("diff {} {} --json", other.display(), baked.display()));
    let told: Value = serde_json::from_str(&told.out).unwrap();
    let day = &told["views"][0];
    assert!(day["delta_e_2000"]["median"].as_f64().unwrap() < 0.5, "{day}");
}

/// The star's own light is white where it is asked for: red, green and blue of it, from the matrix of all wavelengths and
/// its irradiance, are equal to a thousandth (that matrix is a fit), and not so without.
#[test]
fn the_star_is_white() {
    let dir = tempfile::tempdir().unwrap();
    let one = source(dir.path(), &[]);
    let spread = |bake: &Path| {
        let told = manifest(bake);
        let rows = told["colour"]["matrices"]["rgb_from_all_wavelengths"].as_array().unwrap().clone();
        let sums: Vec<f64> =
            rows.iter().map(|r| r.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).sum()).collect();
        sums.iter().fold(0.0, |most: f64, v| most.max((v / sums[1] - 1.0).abs()))
    };
    let white = recoloured(&one, &dir.path().join("white"), &["--star", "3000", "--white", "star"]);
    let plain = recoloured(&one, &dir.path().join("plain"), &["--star", "3000"]);
    assert!(spread(&white) < 5e-3, "{}", spread(&white));
    assert!(spread(&plain) > 0.3, "{}", spread(&plain));
}

/// Another observer sees other numbers, says who it is, and sees the same light about alike.
#[test]
fn another_observer() {
    let dir = tempfile::tempdir().unwrap();
    let one = source(dir.path(), &[]);
    let wide = recoloured(&one, &dir.path().join("wide"), &["--observer", "cie1964-10deg"]);
    assert_eq!(manifest(&wide)["colour"]["observer"], "CIE 1964 10 degrees");
    let (a, b) = (sample(&one, &[]), sample(&wide, &[]));
    assert_eq!(a, b, "the tables hold the same light");
    let y = |bake: &Path| manifest(bake)["constants"]["star_illuminance_lx"][0].as_f64().unwrap();
    let ratio = y(&wide) / y(&one);
    assert!((1.0..1.15).contains(&ratio), "both weigh sunlight about alike: {ratio}");
}

/// Without the compact layout there is nothing to recolour; onto itself is refused; damage is found.
#[test]
fn refused() {
    let dir = tempfile::tempdir().unwrap();
    let paper = bake("earth-paper", &dir.path().join("paper"), &["--layout", "elek2010"]);
    let one = source(&dir.path().join("one"), &[]);
    let say = |bake: &Path, out: &Path, more: &str| {
        words(&format!("recolour {} --out {} {more}", bake.display(), out.display()))
    };
    let other = dir.path().join("other");
    for (done, reason) in [
        (say(&paper, &other, ""), "no layout compact"),
        (say(&one, &dir.path().join("one"), ""), "would replace itself"),
        (say(&one, &other, "--star 5"), "100 to 1000000"),
        (say(&one, &other, "--white d66"), "a chromaticity such as"),
    ] {
        assert_eq!(done.code, Some(2), "{reason}: {}", done.err);
        assert!(done.err.contains(reason), "{reason}: {}", done.err);
    }
    std::fs::write(one.join("compact/skies.exr"), "x").unwrap();
    let done = say(&one, &other, "");
    assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{}", done.err);
    assert!(!other.exists());
}
