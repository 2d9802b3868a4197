//! Input that means harm, or that a slip of the pen made huge: refused in one line, before it takes memory or time.

use super::run::*;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

/// Panics unless the run ends with `code` in one line that says `reason`, and soon.
fn refused<S: AsRef<std::ffi::OsStr>>(arguments: &[S], code: i32, reason: &str) {
    let start = Instant::now();
    let done = tyndall(arguments);
    assert_eq!((done.code, done.err.lines().count()), (Some(code), 1), "{reason}: {}{}", done.out, done.err);
    assert!(done.err.contains(reason) && !done.err.contains('\u{1b}'), "`{reason}` is not in: {}", done.err);
    assert!(start.elapsed() < Duration::from_secs(60), "{reason}: {:?}", start.elapsed());
}

/// Line breaks and a terminal's commands in keys, values and cells are shown as escapes.
#[test]
fn errors_stay_on_one_line() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str, text: &str| {
        fs::write(dir.path().join(name), text).unwrap();
        dir.path().join(name).to_str().unwrap().to_string()
    };
    let paper = include_str!("../../presets/planets/earth-paper.json");
    let unknown = at("a.json", &paper.replacen("\"ground\"", "\"gro\\n\\u001b[31mund\"", 1));
    refused(&["bake", &unknown], 2, "gro\\n\\u{1b}[31mund");
    let twice = at("b.json", "{\"a\\nb\": 1, \"a\\nb\": 2}");
    refused(&["bake", &twice], 2, "key `a\\nb` is given twice");
    refused(&["bake", "earth", "--set", "ground.al\nbedo=1"], 2, "al\\nbedo");
    let points = at("c.csv", "altitude_m,mu_view,mu_sun,azimuth_deg\n0,\"1\n\u{1b}[31m\",0,0\n");
    refused(&["sample", earth().to_str().unwrap(), "--points", &points], 2, "mu_view = 1\\n\\u{1b}[31m");
    let spectra = at("d.csv", "wavelength_nm,\"a\nb\"\n400,x\n");
    refused(&["colour", &spectra], 2, "a\\nb = `x`");
}

/// Devices that never end, in the place of every file that a user names.
#[cfg(target_os = "linux")]
#[test]
fn endless_files() {
    let bake = earth().to_str().unwrap();
    for words in [
        &["bake", "/dev/zero"][..],
        &["bake", "--list", "/dev/zero"],
        &["plan", "/dev/zero"],
        &["presets", "show", "/dev/zero"],
        &["bake", "earth", "--waters", "/dev/zero"],
        &["colour", "/dev/zero"],
    ] {
        refused(words, 2, "bytes, which are the most");
    }
    for words in
        [&["sample", bake, "--points", "/dev/zero"][..], &["reference", "earth", "--points", "/dev/zero"]]
    {
        refused(words, 2, "a row of more than 65536 bytes");
    }
    for words in [&["verify", "/dev/zero"][..], &["diff", bake, "/dev/zero"]] {
        refused(words, 2, "not a file but a device");
    }
}

/// A bake whose manifest names other files than its own: nothing outside its folder is opened, by any command.
#[cfg(target_os = "linux")]
#[test]
fn manifests_that_point_elsewhere() {
    for file in ["/dev/zero", "../earth/compact/multiple.exr", ""] {
        let (dir, bake) = changed(&|m| {
            for table in m["tables"].as_array_mut().unwrap() {
                table["file"] = json!(file);
            }
        });
        let points = dir.path().join("views.csv");
        fs::write(&points, VIEWS).unwrap();
        let (bake, points, out) = (bake.to_str().unwrap(), points.to_str().unwrap(), dir.path().join("out"));
        refused(&["sample", bake, "--points", points], 2, "outside the bake");
        refused(&["diff", earth().to_str().unwrap(), bake], 2, "outside the bake");
        refused(&["recolour", bake, "--star", "4000", "--out", out.to_str().unwrap()], 2, "outside the bake");
        let done = verify(Path::new(bake));
        assert!(done.code == Some(1) && done.out.contains("outside the bake"), "{}", done.out);
    }
}

/// The name in a manifest becomes a folder's when the bake is recoloured, and must not lead out of `--out`.
#[test]
fn names_that_lead_elsewhere() {
    for name in ["../evil", "/tmp/evil", "a/b", "..", "a\nb", ""] {
        let (dir, bake) = changed(&|m| {
            m["preset"]["name"] = json!(name);
            m["preset"]["resolved"]["name"] = json!(name);
        });
        let out = dir.path().join("deep/out");
        refused(
            &["recolour", bake.to_str().unwrap(), "--star", "4000", "--out", out.to_str().unwrap()],
            2,
            "name: must consist of",
        );
        assert_eq!(names(dir.path()), ["earth"]);
    }
}

/// Settings that are no object: recolouring writes into them.
#[test]
fn settings_of_another_kind() {
    for settings in [json!("x"), json!([1]), json!(3), json!(null)] {
        let (dir, bake) = changed(&|m| m["settings"] = settings.clone());
        let out = dir.path().join("out");
        let words = ["recolour", bake.to_str().unwrap(), "--star", "4000", "--out", out.to_str().unwrap()];
        refused(&words, 2, "settings: must be an object");
    }
}

/// A file's name with a line break is told by `verify` on one line, as every difference is.
#[test]
fn differences_stay_on_one_line() {
    let (_dir, bake) = changed(&|m| m["files"][0]["file"] = json!("a\nb: fine\u{1b}[2J"));
    let done = verify(&bake);
    assert!(done.out.contains("a\\nb: fine\\u{1b}[2J: is missing"), "{}", done.out);
    assert!(done.out.lines().all(|line| line.contains(": ")) && !done.out.contains('\u{1b}'), "{}", done.out);
}

/// A copy of the small bake with another manifest.
fn changed(change: &dyn Fn(&mut Value)) -> (tempfile::TempDir, std::path::PathBuf) {
    let (dir, bake) = earth_to_damage();
    let mut value = manifest(&bake);
    change(&mut value);
    fs::write(bake.join("bake.json"), value.to_string()).unwrap();
    (dir, bake)
}

/// Tables of a terabyte: 500 wavelengths of the largest spectral files. The largest there may be of one kind.
#[test]
fn bakes_beyond_all_memory() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let many: Vec<String> = (400..900).map(|nm| nm.to_string()).collect();
    let many = many.join(",");
    let huge = ["--spectral", "--wavelengths", &many, "--size", "512x512x16x16", "--out", out];
    refused(&[&["bake", "earth", "--quiet"], &huge[..]].concat(), 3, "of memory, and ");
    assert!(names(dir.path()).is_empty(), "{:?}", names(dir.path()));
    let waters = ["--waters", "clear-ocean", "--size", "water=99999999999x99999999999x3", "--out", out];
    refused(&[&["bake", "earth"], &waters[..]].concat(), 2, "three numbers from 2 to 1024");
    refused(&["bake", "earth", "--wavelengths", &format!("{many},901")], 2, "more than 500 wavelengths");
}

/// Presets that are read fast and would be computed with for hours: profiles and phase functions of a million nodes,
/// lists within lists, a name of a megabyte.
#[test]
fn presets_of_a_million() {
    let dir = tempfile::tempdir().unwrap();
    let paper: Value = serde_json::from_str(include_str!("../../presets/planets/earth-paper.json")).unwrap();
    let refused = |name: &str, change: &dyn Fn(&mut Value), reason: &str| {
        let mut value = paper.clone();
        change(&mut value);
        let file = dir.path().join(name);
        fs::write(&file, value.to_string()).unwrap();
        refused(&["bake", file.to_str().unwrap(), "--out", dir.path().to_str().unwrap()], 2, reason);
    };
    let million = || (0..1_000_000).collect::<Vec<u32>>();
    refused(
        "profile.json",
        &|m| {
            m["constituents"][0]["profile"] = json!({ "kind": "linear", "source": "me",
                "altitudes_m": million(), "densities": vec![1; 1_000_000] })
        },
        "1000000 altitudes: 1000 are the most",
    );
    refused(
        "phase.json",
        &|m| {
            let angles: Vec<f64> = million().iter().map(|k| f64::from(*k) * 180.0 / 999_999.0).collect();
            m["constituents"][0]["phase"] = json!({ "kind": "tabulated", "source": "me",
                "angles_deg": angles, "values": vec![1; 1_000_000] })
        },
        "are the most",
    );
    refused("name.json", &|m| m["name"] = json!("n".repeat(1 << 20)), "100 letters at most");
    refused("key.json", &|m| m["k".repeat(8 << 20)] = json!("x"), "unknown key; known are `");
    let deep = dir.path().join("deep.json");
    fs::write(&deep, "[".repeat(1 << 20)).unwrap();
    super::hostile::refused(&["bake", deep.to_str().unwrap()], 2, "recursion limit exceeded");
}

/// A pipe with the name of an unfinished bake is nobody's bake: it is not waited for.
#[cfg(unix)]
#[test]
fn a_pipe_beside_the_bake() {
    let dir = tempfile::tempdir().unwrap();
    let pipe = dir.path().join(".earth.tmp-0123456789abcdef");
    assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    holds(&bake("earth", dir.path(), &["--layout", "compact"]));
}
