//! What a command says, where it cannot be written: exit code 3 and no panic on a full disk, silence where nobody reads.

#![cfg(target_os = "linux")]

use super::run::*;
use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};

fn full() -> File {
    File::options().write(true).open("/dev/full").unwrap()
}

/// Commands that answer on standard output, and what they need beside them.
fn answers(folder: &Path) -> Vec<Command> {
    let at = |name: &str, text: &str| {
        fs::write(folder.join(name), text).unwrap();
        folder.join(name).to_str().unwrap().to_string()
    };
    let points = at("views.csv", VIEWS);
    let narrow = at("narrow.csv", "wavelength_nm,a\n500,1\n600,2\n");
    let bake = earth().to_str().unwrap();
    let lines: [&[&str]; 15] = [
        &["sample", bake, "--points", &points],
        &["sample", bake, "--points", &points, "--layout", "elek2010"],
        &["reference", "earth", "--points", &points, "--paths", "1", "--wavelengths", "550"],
        &[
            "reference",
            "earth",
            "--points",
            &points,
            "--paths",
            "1",
            "--wavelengths",
            "550",
            "--stderr",
            "0.1%",
            "--per-order",
        ],
        &["colour", &narrow],
        &["colour", &narrow, "--json"],
        &["presets"],
        &["presets", "schema"],
        &["presets", "show", "earth", "--no-colour"],
        &["presets", "check"],
        &["verify", bake],
        &["diff", bake, bake, "--views", "1"],
        &["--version"],
        &["bake", "--help"],
        &["help", "presets"],
    ];
    lines
        .iter()
        .map(|words| of(words))
        .chain([small_bake("earth", folder, &["--layout", "elek2010"])])
        .collect()
}

fn of(words: &[&str]) -> Command {
    let mut command = command();
    command.args(words);
    command
}

/// Every command: 3 with a line that names standard output where that is full, 0 and silence where it is closed.
#[test]
fn answers_that_nobody_can_keep() {
    let dir = tempfile::tempdir().unwrap();
    for mut command in answers(dir.path()) {
        let done = ran(command.stdout(full()).output().unwrap());
        assert_eq!(done.code, Some(3), "{command:?}: {}", done.err);
        assert!(done.err.contains("standard output: No space left"), "{command:?}: {}", done.err);
    }
    for mut command in answers(dir.path()) {
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let done = ran(child.wait_with_output().unwrap());
        assert_eq!(done.code, Some(0), "{command:?}: {}", done.err);
        assert!(!done.err.contains("error:") && !done.err.contains("panic"), "{command:?}: {}", done.err);
    }
}

/// Commands that talk: their answer is whole wherever the talk goes, and the exit code is 3 where it is lost on a full
/// disk.
#[test]
fn talk_that_nobody_can_keep() {
    let dir = tempfile::tempdir().unwrap();
    let mut talked = 0;
    for (mut heard, (mut lost, mut closed)) in
        answers(dir.path()).into_iter().zip(answers(dir.path()).into_iter().zip(answers(dir.path())))
    {
        let wanted = ran(heard.output().unwrap());
        assert_eq!(wanted.code, Some(0), "{heard:?}: {}", wanted.err);
        let code = if wanted.err.is_empty() { 0 } else { 3 };
        talked += usize::from(code == 3);
        let lost_in =
            ran(lost.stdout(Stdio::piped()).stderr(full()).spawn().unwrap().wait_with_output().unwrap());
        assert_eq!(lost_in.code, Some(code), "{lost:?}");
        let mut child = closed.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stderr.take());
        let closed_on = ran(child.wait_with_output().unwrap());
        assert_eq!(closed_on.code, Some(0), "{closed:?}");
        // A bake's answer says whether it was there already.
        if !wanted.out.contains(" files, ") {
            assert!(lost_in.out == wanted.out && closed_on.out == wanted.out, "{heard:?}");
        }
    }
    assert!(talked >= 4, "{talked} commands talk");
}

/// Several bakes and bakes that fail talk most; an error keeps its own exit code where nobody can read of it.
#[test]
fn errors_that_nobody_can_keep() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().to_str().unwrap();
    let mut bakes = command();
    bakes.args(["bake", "earth", "mars", "--layout", "elek2010", "--out", out]).args(SMALL);
    for (command, code) in [
        (&mut bakes, 3),
        (&mut of(&["bake", "no-such-planet", "earth", "--check", "--out", out]), 2),
        (&mut of(&["verify", "no-such-bake"]), 2),
        (&mut of(&["colour", "--blackbody", "-1"]), 2),
        (&mut of(&["no-such-command"]), 2),
        (&mut of(&["presets", "check", "no-such-file.json"]), 2),
    ] {
        let done = command.stdout(Stdio::null()).stderr(full()).status().unwrap();
        assert_eq!(done.code(), Some(code), "{command:?}");
    }
    holds(&dir.path().join("mars"));
}

/// What prints by itself panics where nobody reads: all goes through one module.
#[test]
fn one_module_speaks() {
    fn sources(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
        for path in fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
            match path.is_dir() {
                true => sources(&path, found),
                false => found.push(path),
            }
        }
    }
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    sources(&root, &mut all);
    assert!(all.len() > 100, "{} sources", all.len());
    for path in all.iter().filter(|p| **p != root.join("machine/output.rs")) {
        let text = fs::read_to_string(path).unwrap();
        for word in ["println!", "print!", "dbg!", "io::stdout", "io::stderr", "stdout()", "stderr()"] {
            assert!(!text.contains(word), "{}: {word}", path.display());
        }
    }
}
