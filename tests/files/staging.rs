//! A bake's folder: replaced whole, or left as it was.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use tempfile::{TempDir, tempdir};
use tyndall::internals::files::signals::handle_interrupts;
use tyndall::internals::files::staging::Staging;

/// A bake of two files, both holding `text`.
pub fn bake(target: &Path, text: &str) -> tyndall::Result<()> {
    let staging = Staging::begin(target)?;
    staging.write("compact/x.exr", text.as_bytes())?;
    staging.write("bake.json", text.as_bytes())?;
    staging.commit()
}

/// The text of a whole bake; panics if its two files disagree.
pub fn text_of(target: &Path) -> String {
    let [manifest, table] =
        ["bake.json", "compact/x.exr"].map(|f| fs::read_to_string(target.join(f)).unwrap());
    assert_eq!(manifest, table, "a mixture of two bakes");
    manifest
}

/// The names in a folder, hidden ones too.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn with_old_bake() -> (TempDir, PathBuf) {
    let dir = tempdir().unwrap();
    let target = dir.path().join("mars");
    bake(&target, "old").unwrap();
    (dir, target)
}

#[test]
fn a_bake_replaces_the_one_before_and_leaves_nothing_beside_it() {
    let (dir, target) = with_old_bake();
    bake(&target, "new").unwrap();
    assert_eq!(text_of(&target), "new");
    assert_eq!(names(dir.path()), ["mars"]);
}

/// BLAKE3 of no bytes is printed in the specification of BLAKE3.
#[test]
fn the_hash_of_a_file_is_its_blake3() {
    let dir = tempdir().unwrap();
    let staging = Staging::begin(&dir.path().join("mars")).unwrap();
    let hash = staging.write("empty", b"").unwrap();
    assert_eq!(hash, "af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262");
}

/// A failure in mid-bake, here a full disk or a solver's error, drops the staging.
#[test]
fn an_abandoned_bake_leaves_the_old_one_and_nothing_beside_it() {
    let (dir, target) = with_old_bake();
    let staging = Staging::begin(&target).unwrap();
    staging.write("bake.json", b"half").unwrap();
    assert_eq!(names(dir.path()).len(), 2);
    drop(staging);
    assert_eq!(text_of(&target), "old");
    assert_eq!(names(dir.path()), ["mars"]);
}

#[test]
fn a_bake_without_manifest_is_not_committed() {
    let (dir, target) = with_old_bake();
    let staging = Staging::begin(&target).unwrap();
    staging.write("compact/x.exr", b"new").unwrap();
    assert!(staging.commit().is_err());
    assert_eq!((text_of(&target), names(dir.path())), ("old".into(), vec!["mars".into()]));
}

#[test]
fn paths_outside_the_bake_are_refused() {
    let (_dir, target) = with_old_bake();
    let staging = Staging::begin(&target).unwrap();
    for outside in ["../x", "/x", "a/../../x"] {
        assert_eq!(staging.write(outside, b"x").unwrap_err().exit_code(), 2, "{outside}");
    }
}

#[test]
fn spaces_unicode_links_and_missing_parents_are_no_obstacle() {
    let dir = tempdir().unwrap();
    let deep = dir.path().join("tables of 火星/Größe 1/mars");
    bake(&deep, "one").unwrap();
    let link = dir.path().join("link");
    std::os::unix::fs::symlink(&deep, &link).unwrap();
    bake(&link, "two").unwrap();
    assert_eq!(text_of(&deep), "two");
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink(), "the link itself stays");
    let nowhere = dir.path().join("nowhere");
    std::os::unix::fs::symlink(dir.path().join("missing"), &nowhere).unwrap();
    assert_eq!(bake(&nowhere, "three").unwrap_err().exit_code(), 2);
}

/// Eight threads, twenty bakes each, for one folder: at the end one of them stands there whole.
#[test]
fn racing_bakes_end_with_one_whole_bake() {
    let (dir, target) = with_old_bake();
    std::thread::scope(|scope| {
        for worker in 0..8 {
            let target = &target;
            scope.spawn(move || (0..20).for_each(|k| bake(target, &format!("{worker} {k}")).unwrap()));
        }
    });
    assert!(text_of(&target).ends_with(" 19"));
    assert_eq!(names(dir.path()), ["mars"]);
}

#[test]
fn a_folder_that_is_no_bake_is_not_replaced() {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("thesis.txt"), "years").unwrap();
    let error = bake(dir.path(), "new").unwrap_err();
    assert_eq!(error.exit_code(), 2, "{error}");
    assert_eq!(names(dir.path()), ["thesis.txt"]);
}

/// An output folder below a file cannot be made, whoever asks: the machine failed, in one line.
#[test]
fn an_impossible_folder_is_the_machines_failure() {
    let dir = tempdir().unwrap();
    fs::write(dir.path().join("file"), "").unwrap();
    let error = bake(&dir.path().join("file/mars"), "new").unwrap_err();
    assert_eq!((error.exit_code(), error.to_string().lines().count()), (3, 1), "{error}");
}

/// Not a test but the process that other tests stop: bakes into $TYNDALL_TEST_BAKE, and never ends.
#[test]
#[ignore = "run by other tests, as a process to be stopped"]
fn child_that_bakes_for_ever() {
    let target = PathBuf::from(std::env::var_os("TYNDALL_TEST_BAKE").unwrap());
    handle_interrupts().unwrap();
    let staging = Staging::begin(&target).unwrap();
    staging.write("bake.json", b"half").unwrap();
    println!("\nin the middle");
    std::thread::sleep(std::time::Duration::from_secs(60));
    unreachable!("nobody stopped this process: {}", target.display());
}

/// Starts the child and waits until it is in the middle of its bake.
fn child_in_mid_bake(target: &Path) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    // It hears Ctrl-C even where these tests run in the background of a shell, which ignores it there.
    let heard = || {
        // SAFETY: no handler is named.
        unsafe { libc::signal(libc::SIGINT, libc::SIG_DFL) };
        Ok(())
    };
    // SAFETY: a call that may be made between fork and exec.
    unsafe { std::os::unix::process::CommandExt::pre_exec(&mut command, heard) };
    let mut child = command
        .args(["--ignored", "--exact", "--nocapture", "files::staging::child_that_bakes_for_ever"])
        .env("TYNDALL_TEST_BAKE", target)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let lines = BufReader::new(child.stdout.take().unwrap()).lines();
    assert!(lines.map_while(Result::ok).any(|line| line == "in the middle"), "the child did not start");
    child
}

/// kill -9 gives no chance to clean up: the old bake is whole, and the next bake sweeps the rest.
#[test]
fn a_killed_bake_leaves_the_old_one_and_is_swept_by_the_next() {
    let (dir, target) = with_old_bake();
    let mut child = child_in_mid_bake(&target);
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(text_of(&target), "old");
    assert_eq!(names(dir.path()).len(), 2, "the killed process's folder is still there");
    bake(&target, "new").unwrap();
    assert_eq!((text_of(&target), names(dir.path())), ("new".into(), vec!["mars".into()]));
}

/// The folder of a process that lives is not swept, though it is as old as that of a dead one.
#[test]
fn a_running_bake_is_not_swept_by_another() {
    let (dir, target) = with_old_bake();
    let mut child = child_in_mid_bake(&target);
    bake(&target, "new").unwrap();
    assert_eq!(names(dir.path()).len(), 2, "the running process's folder is still there");
    child.kill().unwrap();
    child.wait().unwrap();
}

/// SIGTERM and Ctrl-C: the temporary folder goes, the exit code is 3, one line says what happened.
#[test]
fn a_stopped_bake_cleans_up_and_says_so() {
    for signal in ["-TERM", "-INT"] {
        let (dir, target) = with_old_bake();
        let mut child = child_in_mid_bake(&target);
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        assert_eq!(child.wait().unwrap().code(), Some(3));
        let mut said = String::new();
        child.stderr.take().unwrap().read_to_string(&mut said).unwrap();
        assert!(said.contains("interrupted; what stood in the output folder before is untouched"), "{said}");
        assert_eq!((text_of(&target), names(dir.path())), ("old".into(), vec!["mars".into()]));
    }
}

/// Where the system cannot exchange two folders, there is no bake for a moment: one moved aside by a process that was
/// killed then is put back by the next bake, even if that one fails.
#[test]
fn a_bake_left_aside_is_put_back() {
    let (dir, target) = with_old_bake();
    let mut child = child_in_mid_bake(&target);
    let theirs = names(dir.path()).into_iter().find(|name| name != "mars").unwrap();
    fs::rename(&target, dir.path().join(theirs).join("old")).unwrap();
    drop(Staging::begin(&target).unwrap());
    assert!(!target.exists(), "its process lives");
    child.kill().unwrap();
    child.wait().unwrap();
    drop(Staging::begin(&target).unwrap());
    assert_eq!((text_of(&target), names(dir.path())), ("old".into(), vec!["mars".into()]));
}

/// A folder that begins like one of a bake's is a user's, whatever is in it, and stays; so does a bake under such a name.
#[test]
fn folders_of_users_are_not_swept() {
    let (dir, target) = with_old_bake();
    let users = [".mars.old-x", ".mars.tmp-x", ".mars.tmp-0123456789abcdef", ".mars.old-0123456789abcdef"];
    for (k, name) in users.iter().enumerate() {
        let folder = dir.path().join(name);
        match k {
            0 => fs::create_dir(folder).unwrap(),
            1 => bake(&folder, "mine").unwrap(),
            _ => {
                fs::create_dir(&folder).unwrap();
                fs::write(folder.join("thesis.txt"), "years").unwrap();
                fs::write(folder.join(".tyndall"), "notes").unwrap();
            }
        }
    }
    fs::remove_dir_all(&target).unwrap();
    bake(&target, "new").unwrap();
    let mut wanted: Vec<String> = users.iter().map(|name| name.to_string()).chain(["mars".into()]).collect();
    wanted.sort();
    assert_eq!((text_of(&target), names(dir.path())), ("new".into(), wanted));
    assert_eq!(text_of(&dir.path().join(users[1])), "mine");
    assert_eq!(fs::read_to_string(dir.path().join(users[3]).join("thesis.txt")).unwrap(), "years");
}
