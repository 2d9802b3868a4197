//! Tables for a part of altitudes, suns and views, and tables left out.

use super::run::*;
use serde_json::Value;
use std::path::Path;

/// Sizes at which a whole table is visibly coarse.
const COARSE: [&str; 6] =
    ["--size", "compact=6x16x12x4", "--size", "compact-single=6x16x12x4", "--size", "elek2010=6x16x12x4"];

/// Answers at views (altitude, elevation of the view, of the sun, azimuth; degrees).
fn ask(bake: &Path, views: &[[f64; 4]], more: &[&str]) -> Ran {
    let dir = tempfile::tempdir().unwrap();
    let sine = |degrees: f64| libm::sin(degrees.to_radians());
    let mut text = "altitude_m,mu_view,mu_sun,azimuth_deg\n".to_string();
    for [altitude, view, sun, azimuth] in views {
        text += &format!("{altitude},{},{},{azimuth}\n", sine(*view), sine(*sun));
    }
    let points = dir.path().join("views.csv");
    std::fs::write(&points, text).unwrap();
    let mut command = command();
    command.arg("sample").arg(bake).arg("--points").arg(points).args(more);
    ran(command.output().unwrap())
}

fn values(done: &Ran) -> Vec<f64> {
    assert_eq!(done.code, Some(0), "{}", done.err);
    let value = |line: &str| line.split(',').nth(5).unwrap().parse().unwrap();
    done.out.lines().skip(1).map(value).collect()
}

/// Mean relative error of the tables.
fn error(bake: &Path, views: &[[f64; 4]], truth: &[f64]) -> f64 {
    let found = values(&ask(bake, views, &[]));
    assert_eq!(found.len(), truth.len());
    let errors = found.iter().zip(truth).map(|(f, t)| (f / t - 1.0).abs());
    errors.sum::<f64>() / found.len() as f64
}

/// Views of a walk: heights 0 to 200 m, suns 20 to 50 degrees.
fn walk() -> Vec<[f64; 4]> {
    let golden = |k: usize, step: f64| (k as f64 * step).fract();
    (1..25)
        .map(|k| {
            let (altitude, view) = (200.0 * golden(k, 0.618), 1.0 + 88.0 * golden(k, 0.755));
            [altitude, view, 20.0 + 30.0 * golden(k, 0.57), 180.0 * golden(k, 0.43)]
        })
        .collect()
}

/// As many texels on a part of the altitudes and suns answer there better than on all of them; a single altitude and a
/// single sun with a texel each better still, and with a tenth of the texels.
#[test]
fn a_window_is_finer_than_the_whole() {
    let dir = tempfile::tempdir().unwrap();
    let out = |name: &str| dir.path().join(name);
    let layout = ["--layout", "compact", "--wavelengths", "440,500,560,620", "--orders", "1"];
    let whole = bake("earth-paper", &out("whole"), &[&COARSE[..], &layout].concat());
    let window = ["--altitudes", "0..200m", "--suns", "20..50", "--views", "sky"];
    let part = bake("earth-paper", &out("part"), &[&COARSE[..], &layout, &window].concat());
    // Wavelengths given, so that all bakes have the same four.
    let truth = values(&ask(&whole, &walk(), &["--exact"]));
    let (coarse, fine) = (error(&whole, &walk(), &truth), error(&part, &walk(), &truth));
    assert!(fine < 0.5 * coarse && fine < 0.01, "{fine} {coarse}");
    holds(&part);

    let one = ["--size", "compact=1x24x1x6", "--size", "compact-single=1x24x1x6", "--altitudes", "2m"];
    let point = bake("earth-paper", &out("one"), &[&one[..], &layout, &["--suns", "35"]].concat());
    let here: Vec<[f64; 4]> = walk().iter().map(|v| [2.0, v[1], 35.0, v[3]]).collect();
    let truth = values(&ask(&whole, &here, &["--exact"]));
    let (coarse, fine) = (error(&whole, &here, &truth), error(&point, &here, &truth));
    assert!(fine < 0.5 * coarse && fine < 0.005, "{fine} {coarse}");
    let bytes = |bake: &Path| files(&bake.join("compact")).values().map(Vec::len).sum::<usize>();
    assert!(bytes(&point) < bytes(&whole), "{} {}", bytes(&point), bytes(&whole));
    let manifest = manifest(&point);
    assert_eq!(manifest["settings"]["suns_deg"], serde_json::json!([35.0, 35.0]));
    let formula = &table(&manifest, "multiple")["axes"][0]["formula"];
    assert!(formula.as_str().unwrap().contains("window_low"), "{formula}");
}

fn table<'a>(manifest: &'a Value, name: &str) -> &'a Value {
    manifest["tables"].as_array().unwrap().iter().find(|t| t["name"] == name).unwrap()
}

/// Both layouts answer in a window; what lies outside is refused in one line that says the view, the value and what the
/// tables hold, and is no obstacle to direct integration.
#[test]
fn views_outside_the_window_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    let window = ["--altitudes", "0..1km", "--suns", "-4..60", "--views", "sky"];
    let bake = bake("mars", dir.path(), &window);
    let inside = [[500.0, 30.0, 10.0, 20.0]];
    for layout in ["compact", "elek2010"] {
        let more = ["--layout", layout];
        assert_eq!(ask(&bake, &inside, &more).code, Some(0));
        let refused = |view: [f64; 4], what: &str, range: &str| {
            let done = ask(&bake, &[inside[0], view], &more);
            assert_eq!((done.code, done.err.lines().count()), (Some(2), 1), "{}", done.err);
            assert!(
                done.err.contains(&format!("view 2, {what}")) && done.err.contains(range),
                "{}",
                done.err
            );
        };
        refused([2000.0, 30.0, 10.0, 0.0], "altitude_m = 2000", "0.0 to 1000.0 m");
        refused([500.0, 30.0, -8.0, 0.0], "mu_sun = -0.139", "-4.00 to 60.00 degrees");
        refused([500.0, -40.0, 10.0, 0.0], "mu_view = -0.64", "the sky alone");
    }
    let anywhere = ["--exact", "--wavelengths", "550", "--orders", "1"];
    assert_eq!(ask(&bake, &[[2000.0, -30.0, 70.0, 0.0]], &anywhere).code, Some(0));
    // From outside, the sun is that where the ray enters: the tables reach further than the observer's.
    let orbit = bake_orbit(dir.path());
    assert_eq!(ask(&orbit, &[[400e3, -60.0, 30.0, 0.0], [400e3, -20.0, 30.0, 180.0]], &[]).code, Some(0));
    let done = ask(&orbit, &[[10.0, 60.0, 30.0, 0.0]], &[]);
    assert!(done.code == Some(2) && done.err.contains("and above"), "{}", done.err);
}

fn bake_orbit(out: &Path) -> std::path::PathBuf {
    bake("earth-paper", out, &["--layout", "compact", "--altitudes", "400km", "--suns", "30"])
}

/// Folded into the table of the rest, the light that the gas scatters once has no table, and answers stay near; without
/// the table of what scatters, too. One texel of azimuth is the mean over it.
#[test]
fn tables_can_be_left_out() {
    let dir = tempfile::tempdir().unwrap();
    let layout = ["--layout", "compact", "--size", "compact=6x24x12x6"];
    let views: Vec<[f64; 4]> = walk().iter().map(|v| [v[0], v[1].min(60.0), v[2], v[3]]).collect();
    let whole = bake("earth", &dir.path().join("whole"), &layout);
    let less = ["--fold", "air", "--without", "scatterers"];
    let less = bake("earth", &dir.path().join("less"), &[&layout[..], &less].concat());
    let names = |bake: &Path| -> Vec<String> {
        files(&bake.join("compact"))
            .keys()
            .filter(|n| n.starts_with('s') && *n != "skies.exr")
            .cloned()
            .collect()
    };
    assert_eq!(names(&whole), ["scatterers.exr", "single_aerosol.exr", "single_air.exr"]);
    assert_eq!(names(&less), ["single_aerosol.exr"]);
    let (a, b) = (values(&ask(&whole, &views, &[])), values(&ask(&less, &views, &[])));
    let off: f64 = a.iter().zip(&b).map(|(a, b)| (b / a - 1.0).abs()).sum::<f64>() / a.len() as f64;
    assert!(off > 1e-4 && off < 0.04, "{off}");
    holds(&less);

    let mean = ["--layout", "compact", "--size", "compact=4x8x6x1", "--size", "compact-single=4x8x6x1"];
    let mean = bake("earth", &dir.path().join("mean"), &mean);
    let around =
        |azimuth: f64| values(&ask(&mean, &[[0.0, 30.0, 40.0, azimuth]], &["--component", "scattering"]));
    let manifest = manifest(&mean);
    assert_eq!(table(&manifest, "multiple")["shape"], serde_json::json!([4, 8, 6, 1]));
    assert!(around(0.0)[0] > around(60.0)[0], "phase functions are still there");
}

/// Ranges that mean nothing, sizes that need a window, and parts that other options need.
#[test]
fn bad_windows_are_refused() {
    let refused = |arguments: &str, reason: &str| {
        let done = words(&format!("bake earth --out /dev/null/no {arguments}"));
        assert!(done.code == Some(2) && done.err.contains(reason), "{arguments}: {}", done.err);
    };
    refused("--altitudes 5..2km", "must not be greater");
    refused("--suns 90..100", "between -90 and 90");
    refused("--size compact=1x44x40x8", "needs --altitudes");
    refused("--altitudes 2m --size compact=1x44x1x8", "1 of sun --suns");
    refused("--size compact-transmittance=48", "two numbers");
    refused("--suns 30 --spectral", "whole tables");
    refused("--fold air --layout elek2010", "layout compact");
    refused("--tolerance 1", "per cent or one in");
    refused("--tolerance 1% --size compact=8x8x8x4", "cannot be used with");
    refused("--waters sandy --water-depths 1,2", "2 for 1 of --waters");
    refused("--waters sandy --water-depths 9000", "depths up to");
    let dir = tempfile::tempdir().unwrap();
    let done = ran(small_bake("earth", dir.path(), &["--fold", "ozone"]).output().unwrap());
    assert!(done.code == Some(2) && done.err.contains("there is air, aerosol"), "{}", done.err);
}
