//! The disk fails: one line, exit code 3, and the old bake is whole.

use super::staging::{bake, names, text_of};
use crate::mounted::Mounted;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::tempdir;

/// The bake of `text` fails as the machine's failures do; the old one stands alone in `folder`.
fn fails_and_leaves_the_old_bake(folder: &Path, text: &str, reason: &str) {
    let error = bake(&folder.join("mars"), text).unwrap_err();
    assert_eq!((error.exit_code(), error.to_string().lines().count()), (3, 1), "{error}");
    assert!(error.to_string().contains(reason), "{error}");
    assert_eq!((text_of(&folder.join("mars")), names(folder)), ("old".into(), vec!["mars".into()]));
}

/// 64 KiB hold the old bake, not a new one of 1 MiB.
#[test]
fn a_full_disk() {
    let Some(disk) = Mounted::new("size=64k") else { return };
    bake(&disk.path().join("mars"), "old").unwrap();
    fails_and_leaves_the_old_bake(disk.path(), &"x".repeat(1 << 20), "mars/compact/x.exr: No space left");
}

/// Root may write anywhere but on a filesystem that is mounted read-only.
#[test]
fn a_read_only_disk() {
    let Some(disk) = Mounted::new("size=64k") else { return };
    bake(&disk.path().join("mars"), "old").unwrap();
    let remount = Command::new("mount").args(["-o", "remount,ro"]).arg(disk.path()).status().unwrap();
    assert!(remount.success());
    fails_and_leaves_the_old_bake(disk.path(), "new", "Read-only file system");
}

/// Needs no rights, unlike a full disk: a limit on the size of files fails the same write, in a process of
/// its own, since a limit cannot be lifted again.
#[test]
fn a_file_larger_than_this_user_may_write() {
    let dir = tempdir().unwrap();
    bake(&dir.path().join("mars"), "old").unwrap();
    let status = Command::new("sh")
        .args([
            "-c",
            "trap '' XFSZ; ulimit -f 8; exec \"$0\" --ignored --exact files::disk::child_under_a_limit",
        ])
        .arg(std::env::current_exe().unwrap())
        .env("TYNDALL_TEST_FOLDER", dir.path())
        // Where this suite's own output goes to a file, the limit would hold for that one too.
        .stdout(std::process::Stdio::null())
        .status();
    assert!(status.unwrap().success());
}

/// Not a test but the process in which the test above happens.
#[test]
#[ignore = "run by another test, as a process with a limit"]
fn child_under_a_limit() {
    let folder = PathBuf::from(std::env::var_os("TYNDALL_TEST_FOLDER").unwrap());
    fails_and_leaves_the_old_bake(&folder, &"x".repeat(1 << 20), "mars/compact/x.exr: File too large");
}
