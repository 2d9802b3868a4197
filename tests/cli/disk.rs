//! The machine fails: exit code 3, one line, and the bake that stood there is whole.

use super::run::*;
use crate::mounted::Mounted;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use tempfile::tempdir;

/// A bake into `out`, where one stands already, fails as the machine's failures do and changes nothing.
fn fails_and_changes_nothing(out: &Path, reason: &str) {
    let before = files(&out.join("earth"));
    let done = ran(small_bake("earth", out, &["--orders", "1", "--layout", "compact"]).output().unwrap());
    assert_eq!((done.code, done.err.lines().count()), (Some(3), 1), "{}", done.err);
    assert!(done.err.contains(reason) && done.err.contains("earth"), "{}", done.err);
    holds(&out.join("earth"));
    assert!(files(&out.join("earth")) == before && names(out) == ["earth"], "{:?}", names(out));
}

/// A bake takes some 300 kB here: the first fits, the second does not fit beside it.
#[test]
fn a_full_disk() {
    let Some(disk) = Mounted::new("size=512k") else { return };
    bake("earth", disk.path(), &["--layout", "compact"]);
    fails_and_changes_nothing(disk.path(), "No space left on device");
}

/// Root may write anywhere but on a filesystem that is mounted read-only.
#[test]
fn a_read_only_disk() {
    let Some(disk) = Mounted::new("size=4m") else { return };
    bake("earth", disk.path(), &["--layout", "compact"]);
    let remount = Command::new("mount").args(["-o", "remount,ro"]).arg(disk.path()).status().unwrap();
    assert!(remount.success());
    fails_and_changes_nothing(disk.path(), "Read-only file system");
}

/// A path under a file can hold no folder; it is told before any work is done.
#[test]
fn a_path_under_a_file() {
    let dir = tempdir().unwrap();
    let file = dir.path().join("file");
    fs::write(&file, "mine").unwrap();
    let done = ran(small_bake("earth", &file.join("out"), &[]).output().unwrap());
    assert_eq!((done.code, done.err.lines().count()), (Some(3), 1), "{}", done.err);
    assert!(done.err.contains("Not a directory"), "{}", done.err);
    assert_eq!(fs::read_to_string(&file).unwrap(), "mine");
}

/// Answers that cannot be written are a failure; a reader that has seen enough (`| head`) is not.
#[cfg(target_os = "linux")]
#[test]
fn standard_output_is_full_or_closed() {
    let views = tempdir().unwrap();
    let points = views.path().join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let commands = || {
        let mut verify = command();
        verify.arg("verify").arg(earth());
        let mut sample = command();
        sample.arg("sample").arg(earth()).arg("--points").arg(&points);
        [verify, sample, small_bake("earth", &views.path().join("out"), &["--layout", "compact"])]
    };
    for mut command in commands() {
        let full = File::options().write(true).open("/dev/full").unwrap();
        let done = ran(command.stdout(full).output().unwrap());
        assert_eq!(done.code, Some(3), "{command:?}: {}", done.err);
        assert!(done.err.contains("standard output: No space left"), "{}", done.err);
    }
    for mut command in commands() {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let done = ran(child.wait_with_output().unwrap());
        assert_eq!(done.code, Some(0), "{command:?}: {}", done.err);
    }
}
