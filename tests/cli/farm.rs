//! Many planets from a list: shards, and several processes on one list and one folder, one of which is killed.

#![cfg(unix)]

use super::run::*;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

const OPTIONS: [&str; 4] = ["--layout", "elek2010", "--threads", "1"];

/// A folder with so many planets and their list, with a comment, a blank line and a shipped planet in it.
fn planets(count: usize) -> (tempfile::TempDir, PathBuf, Vec<String>) {
    let dir = tempfile::tempdir().unwrap();
    let preset = include_str!("../../presets/planets/earth-paper.json");
    let mut names: Vec<String> = (0..count).map(|k| format!("moon-{k}")).collect();
    for (k, name) in names.iter().enumerate() {
        let albedo = format!("\"albedo\": 0.{:02}", k + 10);
        let text = preset.replace("earth-paper", name).replace("\"albedo\": 0.45", &albedo);
        fs::write(dir.path().join(format!("{name}.json")), text).unwrap();
    }
    let list = dir.path().join("planets.txt");
    let lines: Vec<String> = names.iter().map(|name| format!("{name}.json")).collect();
    fs::write(&list, format!("# moons\n\n{}  # the last\nearth\n", lines.join("\n"))).unwrap();
    names.push("earth".into());
    names.sort();
    (dir, list, names)
}

fn worker(list: &Path, out: &Path, more: &[&str]) -> Child {
    let mut command = command();
    command
        .args(["bake", "--list"])
        .arg(list)
        .arg("--out")
        .arg(out)
        .args(&SMALL[..])
        .args(OPTIONS)
        .args(more);
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// Shards of one list, one after another: each planet is in one of them, all of them are there, and the whole list then
/// finds nothing to do. A shard that the list is too short for is empty and no failure.
#[test]
fn shards() {
    let (dir, list, names) = planets(4);
    let out = dir.path().join("out");
    let mut told = String::new();
    for shard in ["1/2", "2/2", "9/9"] {
        let done = ran(worker(&list, &out, &["--shard", shard, "--json"]).wait_with_output().unwrap());
        assert_eq!(done.code, Some(0), "{}", done.err);
        told += &done.out;
    }
    assert_eq!(told.matches("\"outcome\":\"baked\"").count(), names.len(), "{told}");
    assert_eq!(super::run::names(&out), names);
    let again = ran(worker(&list, &out, &["--json"]).wait_with_output().unwrap());
    assert_eq!(again.out.matches("\"outcome\":\"reused\"").count(), names.len(), "{}", again.out);
    let checked = ran(worker(&list, &out, &["--check"]).wait_with_output().unwrap());
    assert_eq!((checked.code, checked.out.lines().count()), (Some(0), names.len()), "{}", checked.out);
}

/// Three processes take the same list into the same folder, and the first is killed at work: the others do what it had
/// not finished, nothing is baked twice, nothing is lost, nothing is left beside the bakes.
#[test]
fn racing_processes_and_a_killed_one() {
    let (dir, list, names) = planets(7);
    let out = dir.path().join("out");
    let first = worker(&list, &out, &[]);
    let start = Instant::now();
    let begun = || {
        fs::read_dir(&out)
            .is_ok_and(|mut e| e.any(|e| e.unwrap().file_name().to_string_lossy().contains(".tmp-")))
    };
    while !begun() {
        assert!(start.elapsed() < Duration::from_secs(60), "the bakes do not begin");
        std::thread::sleep(Duration::from_millis(1));
    }
    let others = [worker(&list, &out, &[]), worker(&list, &out, &[])];
    let killed =
        std::process::Command::new("kill").args(["-KILL", &first.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let first = ran(first.wait_with_output().unwrap());
    assert_eq!(first.code, None, "killed at work");
    let mut logs = first.err;
    for other in others {
        let done = ran(other.wait_with_output().unwrap());
        assert_eq!(done.code, Some(0), "{}", done.err);
        assert!(names.iter().all(|name| done.out.contains(&format!("out/{name}"))), "{}", done.out);
        logs += &done.err;
    }
    assert_eq!(super::run::names(&out), names);
    for name in &names {
        holds(&out.join(name));
        let times = logs.matches(&format!("{name}: done in")).count();
        assert_eq!(times, 1, "{name}: {logs}");
    }
}

/// Lists that name nothing, or no file, are bad input; so is a shard that is none.
#[test]
fn bad_lists() {
    let dir = tempfile::tempdir().unwrap();
    let (list, out) = (dir.path().join("list"), dir.path().join("out"));
    let code = |more: &[&str]| ran(worker(&list, &out, more).wait_with_output().unwrap()).code;
    assert_eq!(code(&[]), Some(2));
    fs::write(&list, "# nothing\n").unwrap();
    assert_eq!(code(&[]), Some(2));
    fs::write(&list, "no-such-planet\n").unwrap();
    assert_eq!(code(&[]), Some(2));
    assert_eq!(code(&["--shard", "3/2"]), Some(2));
    assert!(!out.exists() || names(&out).is_empty());
}
