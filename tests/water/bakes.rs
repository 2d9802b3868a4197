//! Waters in bakes, by the command line: tables, answers, refusals.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn tyndall(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_tyndall")).args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The air is small and its light that of two orders, solved as much in bakes as in exact answers.
const SMALL: [&str; 11] = [
    "--quiet",
    "--layout",
    "compact",
    "--wavelengths",
    "5",
    "--size",
    "compact=4x8x8x3",
    "--size",
    "compact-single=4x8x8x2",
    "--orders",
    "2",
];

/// A bake of `earth-paper` whose air is small and whose waters are `waters`.
fn bake(out: &Path, waters: &str, more: &[&str]) -> PathBuf {
    let mut arguments = vec!["bake", "earth-paper", "--out", out.to_str().unwrap(), "--waters", waters];
    arguments.extend(SMALL);
    arguments.extend(more);
    let done = tyndall(&arguments);
    assert!(done.status.success(), "{}", text(&done.stderr));
    out.join("earth-paper")
}

fn manifest(bake: &Path) -> Value {
    serde_json::from_slice(&fs::read(bake.join("bake.json")).unwrap()).unwrap()
}

/// Views down onto the water: straight, slanted, grazing, from a height, and in twilight.
const VIEWS: [(f64, f64, f64); 6] = [
    (0.0, -1.0, 0.8),
    (0.0, -0.5, 0.31),
    (0.0, -0.13, 0.95),
    (5000.0, -0.7, 0.5),
    (0.0, -0.66, 0.04),
    (0.0, -0.9, -0.03),
];

fn sample(bake: &Path, more: &[&str]) -> Vec<f64> {
    let views = bake.parent().unwrap().join("views.csv");
    let lines: String = VIEWS.iter().map(|(z, mu, s)| format!("{z},{mu},{s},40\n")).collect();
    fs::write(&views, format!("altitude_m,mu_view,mu_sun,azimuth_deg\n{lines}")).unwrap();
    let mut arguments = vec!["sample", bake.to_str().unwrap(), "--points", views.to_str().unwrap()];
    arguments.extend(more);
    let done = tyndall(&arguments);
    assert!(done.status.success(), "{more:?}: {}", text(&done.stderr));
    let radiance = |line: &str| line.split(',').nth(5).unwrap().parse::<f64>().unwrap();
    text(&done.stdout).lines().skip(1).map(radiance).collect()
}

/// What the files answer is what the slab solver says, for the water's own light, the bed's and both; both parts
/// add up; and depth 0 is the bed alone. Halves and 32 depths lose up to 1 % each, the surface's light near the
/// horizon (from another, coarser solve of the air than the answers') as much.
#[test]
fn tables_answer_what_the_solver_says() {
    let dir = tempfile::tempdir().unwrap();
    let bake = bake(dir.path(), "tropical", &[]);
    assert!(tyndall(&["verify", bake.to_str().unwrap()]).status.success());
    for depth in ["0.7", "12", "85"] {
        let mut parts = Vec::new();
        for component in ["total", "scattering", "ground"] {
            let ask = ["--water", "tropical", "--depth", depth, "--component", component];
            let found = sample(&bake, &ask);
            // Each exact answer solves the air anew. The parts add up, below, so that one of them is enough.
            let exact = depth == "12" && component != "scattering";
            let truth = if exact { sample(&bake, &[&ask[..], &["--exact"]].concat()) } else { found.clone() };
            assert_eq!(found.len(), truth.len());
            for (k, (f, t)) in found.iter().zip(&truth).enumerate() {
                // Answers take the whole sky, tables two parts of it: most apart under a sun at the horizon.
                let low = VIEWS[k / (found.len() / VIEWS.len())].2 < 0.1;
                let limit = if low { 0.04 } else { 0.02 } * t + 1e-9;
                assert!((f - t).abs() < limit, "{depth} m {component} value {k}: {f} is not {t}");
            }
            parts.push(found);
        }
        for ((total, own), bed) in parts[0].iter().zip(&parts[1]).zip(&parts[2]) {
            assert!((total - own - bed).abs() < 1e-6 * total, "{total} is not {own} + {bed}");
        }
    }
    let own = sample(&bake, &["--water", "tropical", "--depth", "0", "--component", "scattering"]);
    let bed = sample(&bake, &["--water", "tropical", "--depth", "0", "--component", "ground"]);
    assert!(own.iter().all(|v| *v == 0.0) && bed.iter().all(|v| *v > 0.0), "{own:?} {bed:?}");
}

/// The manifest says of every table what it holds; the paper's size is the default; the report measures what the
/// paper's shortcuts cost; and no planet's bake has water unasked.
#[test]
fn manifest_and_report() {
    let dir = tempfile::tempdir().unwrap();
    let bake = bake(dir.path(), "clear-ocean,muddy", &[]);
    let m = manifest(&bake);
    let table = |name: &str| -> Value {
        let all = m["tables"].as_array().unwrap();
        all.iter().find(|t| t["layout"] == "water" && t["name"] == name).unwrap().clone()
    };
    assert_eq!(table("clear-ocean")["shape"], serde_json::json!([32, 64, 64]));
    assert_eq!(table("clear-ocean")["file"], "water/clear-ocean.exr");
    assert_eq!(table("fresnel")["shape"], serde_json::json!([256, 4, 2]));
    for name in ["muddy_sky", "muddy_seabed", "muddy_seabed_sun", "muddy_seabed_depth", "irradiance"] {
        assert!(table(name)["channels"].as_array().unwrap().len() == 4, "{name}");
    }
    assert_eq!(m["waters"][1]["name"], "muddy");
    for water in ["clear-ocean", "muddy"] {
        let q = &m["quality"]["water"][water];
        let tables = &q["tables_against_solver"];
        assert!(tables["median"].as_f64().unwrap() < 0.002, "{water} {tables}");
        assert!(tables["max"].as_f64().unwrap() < 0.03, "{water} {tables}");
        let single = q["single_scattering_against_all_orders"]["median"].as_f64().unwrap();
        assert!(single > 0.005, "{water}: one scattering cannot be all, {single}");
    }
    let plain = self::bake(&dir.path().join("plain"), "none", &[]);
    assert!(!plain.join("water").exists() && manifest(&plain).get("waters").is_none());
}

/// The shortcut is darker than the whole light; the same bake has the same bytes with other threads; tables for
/// observers under water answer at the surface what leaves it.
#[test]
fn options() {
    let dir = tempfile::tempdir().unwrap();
    let with = |folder: &str, size: &str, more: &[&str]| {
        bake(&dir.path().join(folder), "sandy", &[&["--size", size][..], more].concat())
    };
    let (size, tiny) = ("water=12x16x12", "water=3x4x3");
    let all = with("a", size, &["--underwater"]);
    let single = with("b", size, &["--water-orders", "1"]);
    let [once, again] = ["1", "3"]
        .map(|threads| with(threads, tiny, &["--water-orders", "1", "--underwater", "--threads", threads]));
    for entry in fs::read_dir(once.join("water")).unwrap() {
        let file = entry.unwrap().file_name();
        let read = |bake: &Path| fs::read(bake.join("water").join(&file)).unwrap();
        assert!(read(&once) == read(&again), "{file:?}");
    }
    let ask = ["--water", "sandy", "--depth", "6", "--component", "scattering"];
    let more = with("d", size, &["--water-orders", "3"]);
    let [whole, single, three] = [&all, &single, &more].map(|bake| sample(bake, &ask));
    let rises = |k: usize| single[k] > 0.0 && single[k] < three[k] && three[k] < whole[k];
    assert!((0..4).all(rises), "{single:?} {three:?} {whole:?}");
    // Solved afresh with the orders of the bake, and at a depth in the water.
    let exact = sample(&more, &[&ask[..], &["--exact"]].concat());
    assert!(exact.iter().zip(&three).take(4).all(|(e, t)| (e / t - 1.0).abs() < 0.06), "{exact:?} {three:?}");
    let deep = [&ask[..], &["--observer-depth", "2"]].concat();
    let (seen, exact) = (sample(&all, &deep), sample(&all, &[&deep[..], &["--exact"]].concat()));
    let off = |k: usize| (seen[k] / exact[k] - 1.0).abs();
    assert!((0..4).all(|k| off(k) < 0.1), "{seen:?} {exact:?}");
    // Straight down from just below the surface, over what leaves: n² / (1 − F) of normal incidence.
    let within = sample(&all, &[&ask[..], &["--observer-depth", "0"]].concat());
    let n: f64 = 1.344;
    let f = ((n - 1.0) / (n + 1.0)) * ((n - 1.0) / (n + 1.0));
    let ratio = within[0] / whole[0] * (1.0 - f) / (n * n);
    assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
}

/// Slips are named and refused with exit code 2.
#[test]
fn slips_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let bake = bake(dir.path(), "muddy", &["--size", "water=4x4x4"]);
    let bake = bake.to_str().unwrap();
    let views = dir.path().join("views.csv");
    fs::write(&views, "altitude_m,mu_view,mu_sun,azimuth_deg\n0,-1,1,0\n").unwrap();
    let up = dir.path().join("up.csv");
    fs::write(&up, "altitude_m,mu_view,mu_sun,azimuth_deg\n0,0.5,1,0\n").unwrap();
    let (views, up) = (views.to_str().unwrap(), up.to_str().unwrap());
    for (arguments, meant) in [
        (vec!["bake", "earth", "--waters", "mudy"], "`muddy`"),
        (vec!["bake", "earth", "--waters", "none,muddy"], "`none`"),
        (vec!["bake", "earth", "--waters", "muddy,muddy"], "two are named muddy"),
        (vec!["bake", "earth", "--underwater"], "needs --waters"),
        (vec!["bake", "earth", "--water-orders", "2"], "needs --waters"),
        (vec!["bake", "earth", "--waters", "muddy", "--water-orders", "0"], "a number from 1"),
        (vec!["bake", "earth", "--waters", "muddy", "--size", "water=1x4x4"], "three numbers"),
        (vec!["sample", bake, "--points", views, "--water", "muddy"], "--depth"),
        (vec!["sample", bake, "--points", views, "--water", "sandy", "--depth", "1"], "there is muddy"),
        (vec!["sample", bake, "--points", views, "--water", "muddy", "--depth", "101"], "0 to 100 m"),
        (
            vec!["reference", "earth", "--points", views, "--water", "muddy", "--depth", "0"],
            "--depth 0: must be over 0",
        ),
        (vec!["sample", bake, "--points", up, "--water", "muddy", "--depth", "1"], "look down"),
        (
            vec![
                "sample",
                bake,
                "--points",
                views,
                "--water",
                "muddy",
                "--depth",
                "2",
                "--observer-depth",
                "1",
            ],
            "--underwater",
        ),
    ] {
        let done = tyndall(&arguments);
        assert_eq!(done.status.code(), Some(2), "{arguments:?}");
        assert!(text(&done.stderr).contains(meant), "{arguments:?}: {}", text(&done.stderr));
    }
}
