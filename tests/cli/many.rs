//! Several presets in one run: side by side within a bound of memory, each for itself.

use super::run::*;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// A run over presets of small tables.
fn many(out: &Path, presets: &[&str], more: &[&str]) -> Command {
    let mut command = small_bake(presets[0], out, &[&["--layout", "compact"], more].concat());
    command.args(&presets[1..]);
    command
}

/// The line of a preset in the table at the end.
fn line<'a>(done: &'a Ran, preset: &str) -> &'a str {
    done.out.lines().find(|l| l.starts_with(preset)).unwrap_or_else(|| panic!("{preset}: {}", done.out))
}

/// A folder with a preset that is none, one whose values are wrong, and one that is good.
fn mixed() -> (tempfile::TempDir, [String; 3]) {
    let dir = tempfile::tempdir().unwrap();
    let good = include_str!("../../presets/planets/earth-paper.json");
    let texts = ["{".to_string(), good.replace("0.76,", "1.76,"), good.replace("earth-paper", "mine")];
    let files = ["broken.json", "wrong.json", "mine.json"].map(|n| dir.path().join(n));
    files.iter().zip(texts).for_each(|(file, text)| fs::write(file, text).unwrap());
    (dir, files.map(|f| f.display().to_string()))
}

/// Bad presets among good ones: one line each on stderr, the good ones stand whole, the table tells of all in the
/// order asked for, and the exit code is that of the errors.
#[test]
fn a_bad_preset_stops_no_other() {
    let (dir, [broken, wrong, mine]) = mixed();
    let out = dir.path().join("out");
    let done = ran(many(&out, &[&broken, "earth", &wrong, &mine], &[]).output().unwrap());
    assert_eq!(done.code, Some(2), "{}", done.err);
    let errors: Vec<&str> = done.err.lines().collect();
    assert_eq!(errors.len(), 3, "{}", done.err);
    assert!(
        errors[0].starts_with("error: ") && errors[0].contains("broken.json: malformed JSON"),
        "{}",
        done.err
    );
    assert!(errors[1].contains("wrong.json: constituents[1].phase.g = 1.76"), "{}", done.err);
    assert_eq!(errors[2], "error: 2 of 4 failed");
    assert_eq!(names(&out), ["earth", "mine"]);
    for good in ["earth", "mine"] {
        holds(&out.join(good));
        assert!(line(&done, good).contains(&format!("out/{good}")), "{}", done.out);
    }
    for bad in [&broken, &wrong] {
        assert!(line(&done, bad).contains("failed: "), "{}", done.out);
    }
    let at = |name: &str| done.out.find(name).unwrap();
    assert!(
        at(&broken) < at("\nearth") && at("\nearth") < at(&wrong) && at(&wrong) < at("\nmine"),
        "{}",
        done.out
    );
}

/// As JSON each preset has a line, in the order asked for; one that was baked says how well, one that failed why.
#[test]
fn outcomes_as_json() {
    let (dir, [broken, _, mine]) = mixed();
    let out = dir.path().join("out");
    let done = ran(many(&out, &[&mine, &broken], &["--json", "--orders", "auto"]).output().unwrap());
    assert_eq!(done.code, Some(2), "{}", done.err);
    let lines: Vec<Value> = done.out.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    assert_eq!(lines.len(), 2);
    assert_eq!((&lines[0]["preset"], &lines[0]["outcome"]), (&"mine".into(), &"baked".into()));
    let quality = &manifest(&out.join("mine"))["quality"];
    let regions = quality["compact_against_direct_integration"].as_object().unwrap();
    let largest = regions.values().filter_map(|r| r["per_wavelength"]["max"].as_f64()).fold(0.0, f64::max);
    assert_eq!(lines[0]["worst_table_error"]["error"], largest);
    assert_eq!(lines[0]["energy_balance_error"], quality["solver"]["energy_balance_error"]);
    let bytes: usize = files(&out.join("mine")).values().map(Vec::len).sum();
    assert_eq!(
        (&lines[0]["bytes"], &lines[0]["files"]),
        (&bytes.into(), &files(&out.join("mine")).len().into())
    );
    assert_eq!((&lines[1]["outcome"], &lines[1]["exit_code"]), (&"failed".into(), &2.into()));
    assert!(lines[1]["error"].as_str().unwrap().contains("malformed JSON"));
}

/// Where a preset is bad and the disk is too, the exit code is the higher one: the machine's.
#[test]
fn the_highest_exit_code_counts() {
    let (dir, [broken, _, mine]) = mixed();
    let file = dir.path().join("file");
    fs::write(&file, "mine").unwrap();
    let done = ran(many(&file.join("out"), &[&broken, &mine, "earth"], &[]).output().unwrap());
    assert_eq!(done.code, Some(3), "{}", done.err);
    assert!(
        done.err.contains("error: mine: ") && done.err.ends_with("error: 3 of 3 failed\n"),
        "{}",
        done.err
    );
}

/// The bytes are the same side by side, one after another for want of memory, and alone.
#[test]
fn bytes_do_not_depend_on_neighbours() {
    let dir = tempfile::tempdir().unwrap();
    let presets = ["earth", "mars", "earth-blog"];
    let all = |name: &str, more: &[&str]| {
        let out = dir.path().join(name);
        let done = ran(many(&out, &presets, more).output().unwrap());
        assert_eq!(done.code, Some(0), "{}", done.err);
        files(&out)
    };
    let beside = all("beside", &["--memory", "8GiB", "--threads", "3"]);
    assert!(beside == all("alone", &["--memory", "1MB", "--threads", "1"]));
    let alone = files(&bake("mars", &dir.path().join("single"), &["--layout", "compact"]));
    assert!(alone.iter().all(|(file, bytes)| beside[&format!("mars/{file}")] == *bytes));
}

/// A preset that needs more than the bound is told and baked all the same.
#[test]
fn talk_of_memory() {
    let dir = tempfile::tempdir().unwrap();
    let mut command = command();
    command.args(["bake", "earth", "earth-paper", "--memory", "1MB", "--layout", "compact", "--out"]);
    let done = ran(command.arg(dir.path()).args(SMALL).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    assert!(
        done.err.contains("earth: needs some") && done.err.contains("over the bound of 1 MB: runs alone")
    );
    assert!(
        done.err.contains("earth-paper: begins") && done.err.contains("earth-paper: done in"),
        "{}",
        done.err
    );
}

/// The estimate of memory against what a process took at most, for tables of two sizes: not less than nine tenths
/// of it, so that the bound holds, and not over twice as much, so that it is used.
#[cfg(target_os = "linux")]
#[test]
fn the_estimate_of_memory() {
    use tyndall::internals::layout::elek2010::Elek2010Layout;
    use tyndall::internals::layout::settings::Settings;
    let dir = tempfile::tempdir().unwrap();
    for (text, size) in [("32x128x32x8", [32, 128, 32, 8]), ("48x128x48x8", [48, 128, 48, 8])] {
        let mut command = command();
        command.args(["bake", "earth-paper", "--layout", "elek2010", "--perf", "--size", text, "--out"]);
        let done = ran(command.arg(dir.path()).output().unwrap());
        assert_eq!(done.code, Some(0), "{}", done.err);
        let peak = done.out.split("peak memory ").nth(1).unwrap().split(' ').next().unwrap();
        let peak = 1e6 * peak.parse::<f64>().unwrap();
        let settings =
            Settings { layouts: vec![&Elek2010Layout], elek2010_size: size, ..Settings::default() };
        let planet = tyndall::internals::preset::load("earth-paper", &[]).unwrap();
        let ratio = tyndall::internals::bake::memory::estimate(&planet, &settings) as f64 / peak;
        assert!((0.9..2.0).contains(&ratio), "{text}: estimate over {peak} bytes is {ratio}");
    }
}

/// All shipped planets, thick ones too (few orders, small tables): each in its folder, each a line.
#[test]
fn all_planets() {
    let dir = tempfile::tempdir().unwrap();
    let mut command = command();
    command.args(["bake", "--all", "--quiet", "--layout", "elek2010", "--out"]).arg(dir.path()).args(SMALL);
    let done = ran(command.output().unwrap());
    assert_eq!((done.code, done.err.as_str()), (Some(0), ""));
    let mut shipped: Vec<&str> = tyndall::internals::preset::shipped_names().collect();
    for name in &shipped {
        assert!(line(&done, &format!("{name} ")).contains(name), "{}", done.out);
        assert!(dir.path().join(name).join("bake.json").is_file(), "{name}");
    }
    shipped.sort_unstable();
    assert_eq!(names(dir.path()), shipped);
}

fn stopped(mut command: Command, out: &Path, begun: &[&str]) -> Output {
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = std::time::Instant::now();
    while !begun.iter().all(|b| names(out).iter().any(|n| n.starts_with(&format!(".{b}.tmp-")))) {
        assert!(start.elapsed() < Duration::from_secs(60), "the bakes do not begin: {:?}", names(out));
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(1000));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    child.wait_with_output().unwrap()
}

/// Ctrl-C while two are baked side by side: both old bakes stand as they were, and nothing beside them.
#[cfg(unix)]
#[test]
fn interrupted_all_old_bakes_are_whole() {
    let dir = tempfile::tempdir().unwrap();
    let presets = ["earth", "earth-paper"];
    let done = ran(many(dir.path(), &presets, &[]).output().unwrap());
    assert_eq!(done.code, Some(0), "{}", done.err);
    let before = files(dir.path());
    let mut again = command();
    again.args(["bake", "--quiet", "--wavelengths", "90", "--memory", "8GiB", "--threads", "2", "--out"]);
    again.arg(dir.path()).args(presets);
    let done = ran(stopped(again, dir.path(), &presets));
    assert_eq!(done.code, Some(3), "{}", done.err);
    assert_eq!(names(dir.path()), presets);
    assert!(files(dir.path()) == before);
}
