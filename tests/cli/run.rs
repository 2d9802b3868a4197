//! What the tests share: the binary as a process, a small bake, and its answers as numbers.

use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// Options of a bake that takes about a second: tables far too small for use, and two orders.
pub const SMALL: [&str; 10] = [
    "--size",
    "elek2010=4x8x6x3",
    "--size",
    "compact=4x8x6x3",
    "--size",
    "compact-single=4x8x6x3",
    "--wavelengths",
    "5",
    "--orders",
    "2",
];

/// How a process ended and what it said.
#[derive(Debug)]
pub struct Ran {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

/// The program, which hears Ctrl-C even where these tests run in the background of a shell, which ignores it there.
pub fn command() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_tyndall"));
    #[cfg(unix)]
    {
        use std::os::unix::process::CommandExt;
        let heard = || {
            // SAFETY: no handler is named.
            unsafe { libc::signal(libc::SIGINT, libc::SIG_DFL) };
            Ok(())
        };
        // SAFETY: a call that may be made between fork and exec.
        unsafe { command.pre_exec(heard) };
    }
    command
}

pub fn ran(output: Output) -> Ran {
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Ran { code: output.status.code(), out: text(&output.stdout), err: text(&output.stderr) }
}

pub fn tyndall<S: AsRef<OsStr>>(arguments: &[S]) -> Ran {
    ran(command().args(arguments).output().unwrap())
}

/// A command line in one text, split at spaces.
pub fn words(line: &str) -> Ran {
    tyndall(&line.split_whitespace().collect::<Vec<_>>())
}

/// The command of a small bake; `more` comes after the options of [`SMALL`] and wins over them.
pub fn small_bake(preset: &str, out: &Path, more: &[&str]) -> Command {
    // An option given twice is an error, so that those given again are left out of SMALL.
    let kept = SMALL.chunks(2).filter(|pair| pair[0] == "--size" || !more.contains(&pair[0])).flatten();
    let mut command = command();
    command.args(["bake", preset, "--quiet", "--out"]).arg(out).args(kept).args(more);
    command
}

/// Bakes small tables, which must succeed, and returns their folder.
pub fn bake(preset: &str, out: &Path, more: &[&str]) -> PathBuf {
    let done = ran(small_bake(preset, out, more).output().unwrap());
    assert_eq!(done.code, Some(0), "bake {preset} {more:?}: {}", done.err);
    PathBuf::from(done.out.rsplit_once(": ").unwrap().0)
}

/// A small bake of `earth` that tests may read but not change.
pub fn earth() -> &'static Path {
    static EARTH: OnceLock<PathBuf> = OnceLock::new();
    EARTH.get_or_init(|| bake("earth", &Path::new(env!("CARGO_TARGET_TMPDIR")).join("cli"), &[]))
}

/// A copy of [`earth`] that a test may damage, in a folder that is removed with it.
pub fn earth_to_damage() -> (tempfile::TempDir, PathBuf) {
    let dir = tempfile::tempdir().unwrap();
    let bake = dir.path().join("earth");
    for (file, bytes) in files(earth()) {
        fs::create_dir_all(bake.join(&file).parent().unwrap()).unwrap();
        fs::write(bake.join(file), bytes).unwrap();
    }
    (dir, bake)
}

/// A preset of the air of `earth-paper` without its aerosol, whose light is soon solved: its file, in a folder.
pub fn gas(folder: &Path) -> PathBuf {
    let mut preset: Value =
        serde_json::from_str(include_str!("../../presets/planets/earth-paper.json")).unwrap();
    preset["name"] = "gas".into();
    preset["constituents"].as_array_mut().unwrap().truncate(1);
    let file = folder.join("gas.json");
    fs::write(&file, preset.to_string()).unwrap();
    file
}

/// Every file below a folder, by its path in it.
pub fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
        let name = entry.file_name().unwrap().to_str().unwrap().to_string();
        if entry.is_dir() {
            found.extend(files(&entry).into_iter().map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else {
            found.insert(name, fs::read(&entry).unwrap());
        }
    }
    found
}

/// The names in a folder, hidden ones too.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub fn verify(bake: &Path) -> Ran {
    tyndall(&[OsStr::new("verify"), bake.as_os_str()])
}

/// Panics unless `verify` finds a whole bake.
pub fn holds(bake: &Path) {
    let done = verify(bake);
    assert_eq!(done.code, Some(0), "{}{}", done.out, done.err);
}

pub fn manifest(bake: &Path) -> Value {
    serde_json::from_slice(&fs::read(bake.join("bake.json")).unwrap()).unwrap()
}

/// Views of day and night, from the ground, inside, and outside the shell; the last but one misses the planet.
pub const VIEWS: &str = "altitude_m,mu_view,mu_sun,azimuth_deg
0,1,0.5,0
0,0.05,0.1,30
1000,-0.9,0.7,90
10000,-0.5,-0.1,180
0,0.2,-0.25,0
66000,-1,1,0
1000000,-0.95,0.3,20
1000000,0.5,0.3,20
0,0,-1,0
";
/// Numbers in [`VIEWS`] of the zenith by day, of the nadir from the top under the sun, and of the one that
/// misses.
pub const ZENITH: usize = 0;
pub const NADIR: usize = 5;
pub const MISSES: usize = 7;

/// What `sample` answers at [`VIEWS`]: per view, the values of all wavelengths, or red, green and blue.
pub fn sample(bake: &Path, more: &[&str]) -> Vec<Vec<f64>> {
    let dir = tempfile::tempdir().unwrap();
    let points = dir.path().join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let mut command = command();
    command.arg("sample").arg(bake).arg("--points").arg(points).args(more);
    let done = ran(command.output().unwrap());
    assert_eq!(done.code, Some(0), "sample {more:?}: {}", done.err);
    answers(&done.out)
}

fn answers(csv: &str) -> Vec<Vec<f64>> {
    let mut lines = csv.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let values = match head[4] {
        "wavelength_nm" => 5..6,
        _ => 4..7,
    };
    let mut all: Vec<(Vec<&str>, Vec<f64>)> = Vec::new();
    for line in lines {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!(cells.len(), head.len(), "{line}");
        let numbers = cells[values.clone()].iter().map(|v| v.parse::<f64>().unwrap());
        match all.last_mut().filter(|last| last.0 == cells[..4]) {
            Some(last) => last.1.extend(numbers),
            None => all.push((cells[..4].to_vec(), numbers.collect())),
        }
    }
    all.into_iter().map(|(_, values)| values).collect()
}

/// Panics unless the bake is whole and all its light finite and not negative: in the tables (whose ranges
/// `verify` holds against the files) and in the answers of every layout.
pub fn sound(bake: &Path) {
    holds(bake);
    let manifest = manifest(bake);
    for table in manifest["tables"].as_array().unwrap() {
        for channel in table["channels"].as_array().unwrap() {
            let encoding = channel.get("encoding").unwrap_or(&table["encoding"]);
            let low = channel["range"][0].as_f64().unwrap();
            assert!(encoding["kind"] == "log" || low >= 0.0, "{}: {channel}", table["file"]);
        }
        let answers = sample(bake, &["--layout", table["layout"].as_str().unwrap()]);
        assert_eq!(answers.len(), VIEWS.lines().count() - 1);
        let good = |v: &f64| v.is_finite() && *v >= 0.0;
        assert!(answers.iter().flatten().all(good), "{}: {answers:?}", table["layout"]);
        assert!(answers[MISSES].iter().all(|v| *v == 0.0), "{answers:?}");
    }
}
