//! What the tests share: bakes, both programs as processes, their answers as numbers.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// How a process ended and what it said.
#[derive(Debug)]
pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

fn ran(output: Output) -> Ran {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ran { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
}

pub fn tyndall(arguments: &[&str]) -> Ran {
    ran(Command::new(env!("CARGO_BIN_EXE_tyndall")).args(arguments).output().unwrap())
}

/// As without a desktop session, where Mesa's layer that chooses a device would talk on stderr.
pub fn preview_command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tyndall-preview"));
    command.env_remove("XDG_RUNTIME_DIR");
    command
}

pub fn preview(arguments: &[&str]) -> Ran {
    ran(preview_command().args(arguments).output().unwrap())
}

/// Tables coarse enough for a bake of a second, each axis of another size so that none can stand for another.
fn bake(preset: &str, orders: &str, waters: &str) -> PathBuf {
    bake_of(preset, orders, waters, &[])
}

/// The same of a preset with other values.
fn bake_of(preset: &str, orders: &str, waters: &str, changes: &[&str]) -> PathBuf {
    let changed = if changes.is_empty() { "" } else { "-changed" };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("preview-{orders}-{waters}{changed}"));
    let line = "--quiet --wavelengths 5 --size elek2010=12x32x16x5 --size compact=9x20x18x5 \
                --size compact-single=10x24x20x6 --size water=14x18x22 --out";
    let mut arguments = vec!["bake", preset, "--orders", orders, "--waters", waters];
    arguments.extend(line.split_whitespace());
    arguments.push(folder.to_str().unwrap());
    arguments.extend(changes.iter().flat_map(|change| ["--set", change]));
    let done = tyndall(&arguments);
    assert_eq!(done.code, Some(0), "{}", done.err);
    folder.join(preset)
}

/// A bake of `earth`: two groups that scatter, one that only absorbs.
pub fn earth() -> &'static str {
    static EARTH: OnceLock<PathBuf> = OnceLock::new();
    EARTH.get_or_init(|| bake("earth", "3", "none")).to_str().unwrap()
}

/// `earth` with light scattered once.
pub fn earth_once() -> &'static str {
    static EARTH: OnceLock<PathBuf> = OnceLock::new();
    EARTH.get_or_init(|| bake("earth", "1", "none")).to_str().unwrap()
}

/// A bake of `mars`: another radius, dust thicker than the gas.
pub fn mars() -> &'static str {
    static MARS: OnceLock<PathBuf> = OnceLock::new();
    MARS.get_or_init(|| bake("mars", "3", "none")).to_str().unwrap()
}

/// Air so thick that the altitude axis is finer in a layer of it.
pub fn thick() -> &'static str {
    static THICK: OnceLock<PathBuf> = OnceLock::new();
    let dense = ["constituents.air.density_factor=60", "constituents.aerosol.density_factor=60"];
    THICK.get_or_init(|| bake_of("earth-paper", "3", "none", &dense)).to_str().unwrap()
}

/// `mars` with a clear and a thick water.
pub fn wet() -> &'static str {
    static WET: OnceLock<PathBuf> = OnceLock::new();
    WET.get_or_init(|| bake("mars", "3", "clear-ocean,muddy")).to_str().unwrap()
}

/// Whether there is a driver; said once where there is none.
pub fn gpu() -> bool {
    static GPU: OnceLock<bool> = OnceLock::new();
    *GPU.get_or_init(|| {
        let dir = tempfile::tempdir().unwrap();
        let points = write_points(dir.path(), &[[0.0, 1.0, 1.0, 0.0]]);
        let done = preview(&[earth(), "--points", &points]);
        let none = done.code == Some(3) && done.err.contains("no GPU was found");
        if none {
            assert!(std::env::var("TYNDALL_GPU_TESTS").as_deref() != Ok("required"), "{}", done.err);
            eprintln!("SKIPPED: {}", done.err);
        }
        !none
    })
}

/// Altitude, mu, mu_s, azimuth in degrees of each view, to a CSV file.
pub fn write_points(folder: &Path, points: &[[f64; 4]]) -> String {
    let mut text = "altitude_m,mu_view,mu_sun,azimuth_deg\n".to_string();
    for [altitude, mu, mu_s, azimuth] in points {
        text += &format!("{altitude},{mu},{mu_s},{azimuth}\n");
    }
    let path = folder.join("points.csv");
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_string()
}

/// Numbers of an answer per view: four wavelengths a view in rows of their own, or three colours in one row.
fn numbers(text: &str, layout: &str) -> Vec<Vec<f64>> {
    let rows: Vec<Vec<f64>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|v| v.parse().unwrap_or(f64::NAN)).collect())
        .collect();
    match layout {
        "compact" => rows.chunks(4).map(|r| r.iter().map(|row| row[5]).collect()).collect(),
        _ => rows.iter().map(|row| row[4..7].to_vec()).collect(),
    }
}

/// What the shaders answer.
pub fn shader(bake: &str, layout: &str, points: &[[f64; 4]], more: &[&str]) -> Vec<Vec<f64>> {
    let dir = tempfile::tempdir().unwrap();
    let path = write_points(dir.path(), points);
    let mut arguments = vec![bake, "--layout", layout, "--points", &path];
    arguments.extend(more);
    let done = preview(&arguments);
    assert_eq!(done.code, Some(0), "{}", done.err);
    // Of waters, wavelengths in both layouts.
    let answers = numbers(&done.out, if more.contains(&"--water") { "compact" } else { layout });
    assert_eq!(answers.len(), points.len());
    answers
}

/// What `tyndall sample` answers of a water.
pub fn sample_water(bake: &str, water: &str, depth: &str, points: &[[f64; 4]]) -> Vec<Vec<f64>> {
    let dir = tempfile::tempdir().unwrap();
    let path = write_points(dir.path(), points);
    let done = tyndall(&["sample", bake, "--points", &path, "--water", water, "--depth", depth]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    numbers(&done.out, "compact")
}

/// What `tyndall sample` answers.
pub fn sample(bake: &str, layout: &str, points: &[[f64; 4]]) -> Vec<Vec<f64>> {
    let dir = tempfile::tempdir().unwrap();
    let path = write_points(dir.path(), points);
    let done = tyndall(&["sample", bake, "--layout", layout, "--points", &path]);
    assert_eq!(done.code, Some(0), "{}", done.err);
    numbers(&done.out, layout)
}

/// The first of a list of a manifest's constants.
pub fn constant(bake: &str, name: &str) -> f64 {
    manifest(bake)["constants"][name][0].as_f64().unwrap()
}

pub fn manifest(bake: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(Path::new(bake).join("bake.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}
