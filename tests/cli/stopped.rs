//! Bakes that are killed, interrupted, or race for one folder: what stands there is a whole bake at any moment.

#![cfg(unix)]

use super::run::*;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A bake of full size, which takes far longer than the tests wait, that has begun its work.
fn long_bake(out: &Path) -> Child {
    let mut bake = command();
    bake.args(["bake", "earth", "--quiet", "--wavelengths", "90", "--memory", "8GiB", "--out"]).arg(out);
    let child = bake.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    while !names(out).iter().any(|name| name.starts_with(".earth.tmp-")) {
        assert!(start.elapsed() < Duration::from_secs(120), "the bake does not begin: {:?}", names(out));
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(1000));
    child
}

fn signal(child: &Child, name: &str) {
    let sent = Command::new("kill").args([name, &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// Ctrl-C and SIGTERM end a bake with 3 and nothing left beside the old bake. SIGKILL cannot be answered: what
/// it leaves is swept by the next bake.
#[test]
fn the_old_bake_is_whole() {
    let dir = tempfile::tempdir().unwrap();
    let old = bake("earth", dir.path(), &["--layout", "compact"]);
    let before = files(&old);
    for name in ["-INT", "-TERM", "-KILL"] {
        let child = long_bake(dir.path());
        signal(&child, name);
        let done = ran(child.wait_with_output().unwrap());
        if name == "-KILL" {
            assert_eq!((done.code, names(dir.path()).len()), (None, 2), "{:?}", names(dir.path()));
        } else {
            assert_eq!((done.code, names(dir.path())), (Some(3), vec!["earth".into()]), "{name}");
            assert!(done.err.contains("interrupted"), "{name}: {}", done.err);
        }
        holds(&old);
        assert!(files(&old) == before, "{name}");
    }
    bake("earth", dir.path(), &["--layout", "compact"]);
    assert_eq!(names(dir.path()), ["earth"]);
    assert!(files(&old) == before);
}

/// A closed terminal takes stderr with it: the bake ends all the same.
#[test]
fn nobody_reads_what_it_says() {
    let dir = tempfile::tempdir().unwrap();
    let mut child = long_bake(dir.path());
    drop(child.stderr.take());
    signal(&child, "-TERM");
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() && start.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(20));
    }
    // Ends it if it did not end by itself, so that a failure leaves no process behind.
    let _ = child.kill();
    assert_eq!((child.wait().unwrap().code(), names(dir.path())), (Some(3), vec![]));
}

/// Five bakes race for one folder, again and again, and some are killed without a chance to tidy up: what stands there
/// afterwards is a whole bake, and one more bake sweeps what the dead have left.
#[test]
fn five_race_and_some_are_killed() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path().join("earth");
    let bake = |k: usize| {
        let set = format!("ground.albedo=0.{k}");
        small_bake("earth", dir.path(), &["--layout", "elek2010", "--threads", "1", "--set", &set])
    };
    let start = |k| bake(k).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut killed = 0;
    for round in 0..4 {
        let racers: Vec<Child> = (1..6).map(start).collect();
        for (k, mut racer) in racers.into_iter().enumerate() {
            // Other moments in every round, from the first files to the last rename.
            if k % 2 == 0 {
                std::thread::sleep(Duration::from_millis(100 + 80 * round as u64 + 50 * k as u64));
                racer.kill().unwrap();
            }
            let done = ran(racer.wait_with_output().unwrap());
            killed += usize::from(done.code.is_none());
            assert!(matches!(done.code, None | Some(0)), "{}", done.err);
        }
        // Not while others are at it: between two files `verify` would find the next bake in the place of the last.
        if folder.exists() {
            holds(&folder);
        }
    }
    assert!(killed > 0, "all were too fast to be killed");
    let last = ran(bake(7).output().unwrap());
    assert_eq!((last.code, names(dir.path())), (Some(0), vec!["earth".into()]), "{}", last.err);
    holds(&folder);
}

/// Two processes bake different planets of one name into one folder: both succeed, and what stands at the end
/// is all of one of them.
#[test]
fn two_bakes_race_for_one_folder() {
    let dir = tempfile::tempdir().unwrap();
    let start = |albedo: &str| {
        let set = format!("ground.albedo={albedo}");
        let mut bake = small_bake("earth", dir.path(), &["--layout", "compact", "--set", &set]);
        bake.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    };
    let racers = [start("0.1"), start("0.9")];
    for racer in racers {
        let done = ran(racer.wait_with_output().unwrap());
        assert_eq!(done.code, Some(0), "{}", done.err);
    }
    assert_eq!(names(dir.path()), ["earth"]);
    let winner = dir.path().join("earth");
    holds(&winner);
    let albedo = manifest(&winner)["constants"]["ground_albedo_at_four"][0].as_f64().unwrap();
    assert!([0.1, 0.9].contains(&albedo), "{albedo}");
}
