//! Files that are opened by name: pipes in their place, on which nobody waits for ever, and links that lead elsewhere.

#![cfg(unix)]

use super::run::*;
use std::fs;
use std::io::Write;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

fn pipe(path: &Path) -> String {
    assert!(Command::new("mkfifo").arg(path).status().unwrap().success());
    path.to_str().unwrap().to_string()
}

/// As [`ran`], of a command that is killed where it does not end.
fn soon(mut command: Command) -> Ran {
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if start.elapsed() > Duration::from_secs(120) {
            child.kill().unwrap();
            panic!("does not end: {command:?}");
        }
        std::thread::sleep(Duration::from_millis(20));
    }
    ran(child.wait_with_output().unwrap())
}

/// A pipe to which nobody writes, in the place of every file that is opened by its name: a line that names it, exit code 2.
#[test]
fn pipes_that_nobody_writes_to() {
    let (dir, bake) = earth_to_damage();
    let at = |name: &str| pipe(&dir.path().join(name));
    let (preset, points, list, spectrum) = (at("a.json"), at("b.csv"), at("c.txt"), at("d.csv"));
    let mine = include_str!("../../presets/planets/earth-paper.json")
        .replace("\"albedo\": 0.45", &format!("\"albedo\": \"{spectrum}\""));
    fs::write(dir.path().join("mine.json"), mine).unwrap();
    let mine = dir.path().join("mine.json").to_str().unwrap().to_string();
    let (out, old) = (dir.path().join("out").to_str().unwrap().to_string(), bake.to_str().unwrap());
    fs::create_dir(&out).unwrap();
    pipe(&Path::new(&out).join(".earth.lock"));
    fs::write(dir.path().join("list"), "earth\n").unwrap();
    let good_list = dir.path().join("list").to_str().unwrap().to_string();
    let named: [(&[&str], &str); 12] = [
        (&["bake", &preset, "--out", &out], "a.json"),
        (&["presets", "show", &preset], "a.json"),
        (&["plan", &preset], "a.json"),
        (&["bake", "earth", "--waters", &preset, "--out", &out], "a.json"),
        (&["sample", old, "--points", &points], "b.csv"),
        (&["reference", "earth", "--points", &points], "b.csv"),
        (&["colour", &points], "b.csv"),
        (&["bake", "--list", &list, "--out", &out], "c.txt"),
        (&["presets", "show", &mine], "d.csv"),
        (&["bake", "--list", &good_list, "--out", &out, "--layout", "compact"], ".earth.lock"),
        (&["verify", &points], "b.csv"),
        (&["recolour", &points, "--star", "4000", "--out", &out], "b.csv"),
    ];
    for (words, name) in named {
        let mut command = command();
        command.args(words);
        let done = soon(command);
        assert_eq!((done.code, done.err.lines().count() >= 1), (Some(2), true), "{words:?}: {}", done.err);
        let last = done.err.lines().last().unwrap();
        assert!(last.starts_with("error: ") && last.contains(name), "{words:?}: {}", done.err);
    }
    fs::remove_file(bake.join("compact/multiple.exr")).unwrap();
    pipe(&bake.join("compact/multiple.exr"));
    let mut verify = command();
    verify.arg("verify").arg(&bake);
    let done = soon(verify);
    assert!(
        done.code == Some(1) && done.out.contains("multiple.exr: cannot be read: not a file"),
        "{}",
        done.out
    );
    fs::remove_file(bake.join("bake.json")).unwrap();
    pipe(&bake.join("bake.json"));
    let mut verify = command();
    verify.arg("verify").arg(&bake);
    let done = soon(verify);
    assert!(done.code == Some(2) && done.err.contains("bake.json: not a file but"), "{}", done.err);
}

/// A pipe with a writer, however late its bytes, is read as a file is.
#[test]
fn pipes_with_a_writer() {
    let dir = tempfile::tempdir().unwrap();
    let named = pipe(&dir.path().join("spectra.csv"));
    let wanted = "wavelength_nm,a\n360,1\n830,2\n";
    let file = dir.path().join("file.csv");
    fs::write(&file, wanted).unwrap();
    let plain = tyndall(&["colour".as_ref(), file.as_os_str()]);
    assert_eq!(plain.code, Some(0), "{}", plain.err);
    for pause in [0, 3000] {
        let named = named.clone();
        let writer = std::thread::spawn(move || {
            let mut pipe = fs::File::options().write(true).open(named).unwrap();
            std::thread::sleep(Duration::from_millis(pause));
            pipe.write_all(wanted.as_bytes()).unwrap();
        });
        let mut command = command();
        command.arg("colour").arg(dir.path().join("spectra.csv"));
        let done = soon(command);
        assert_eq!((done.code, &done.out), (Some(0), &plain.out), "{}", done.err);
        writer.join().unwrap();
    }
}

/// A pipe or a device in the place of `--depfile` is written to, one that nobody reads is refused; a file is replaced
/// whole.
#[test]
fn depfiles() {
    let dir = tempfile::tempdir().unwrap();
    bake("earth", dir.path(), &["--layout", "compact"]);
    let with = |depfile: &str| {
        let mut bake = small_bake("earth", dir.path(), &["--layout", "compact"]);
        bake.args(["--depfile", depfile]);
        soon(bake)
    };
    let file = dir.path().join("mine.d");
    fs::write(&file, "old").unwrap();
    let mut open = fs::File::open(&file).unwrap();
    assert_eq!(with(file.to_str().unwrap()).code, Some(0));
    assert_eq!(std::io::read_to_string(&mut open).unwrap(), "old", "who reads it reads all of it");
    assert!(fs::read_to_string(&file).unwrap().contains("earth/bake.json:"));
    let done = with("/dev/stdout");
    assert!(done.code == Some(0) && done.out.contains("earth/bake.json:"), "{}{}", done.out, done.err);
    let refused = with(&pipe(&dir.path().join("pipe.d")));
    assert!(refused.code == Some(3) && refused.err.contains("pipe.d"), "{}", refused.err);
    assert_eq!(names(dir.path()), ["earth", "mine.d", "pipe.d"]);
}

/// A table, a folder of tables or the manifest that is a link out of the bake is not read; one that stays inside is.
#[test]
fn links_out_of_a_bake() {
    for part in ["compact/multiple.exr", "compact", "bake.json"] {
        let (dir, bake) = earth_to_damage();
        let points = dir.path().join("views.csv");
        fs::write(&points, VIEWS).unwrap();
        let sampled =
            || tyndall(&["sample".as_ref(), bake.as_os_str(), "--points".as_ref(), points.as_os_str()]);
        // Inside: under another name.
        fs::rename(bake.join(part), bake.join("elsewhere")).unwrap();
        let up = if part.contains('/') { "../elsewhere" } else { "elsewhere" };
        symlink(up, bake.join(part)).unwrap();
        holds(&bake);
        assert_eq!(sampled().code, Some(0), "{part}: {}", sampled().err);
        // Outside, by a whole path and by one that leads up.
        fs::rename(bake.join("elsewhere"), dir.path().join("elsewhere")).unwrap();
        let up = if part.contains('/') { "../../elsewhere" } else { "../elsewhere" };
        for to in [dir.path().join("elsewhere").as_path(), Path::new(up)] {
            fs::remove_file(bake.join(part)).unwrap();
            symlink(to, bake.join(part)).unwrap();
            let done = sampled();
            assert_eq!(
                (done.code, done.out.as_str(), done.err.lines().count()),
                (Some(2), "", 1),
                "{}",
                done.err
            );
            assert!(done.err.contains(part) && done.err.contains("leads out of the bake"), "{}", done.err);
            let done = verify(&bake);
            assert!(matches!(done.code, Some(1 | 2)), "{part}: {}", done.out);
            assert!((done.out + &done.err).contains("leads out of the bake"), "{part}");
        }
    }
}

/// A bake whose manifest has lost its hash of itself is not whole.
#[test]
fn a_manifest_without_its_hash() {
    let (_dir, bake) = earth_to_damage();
    let mut value = manifest(&bake);
    value.as_object_mut().unwrap().remove("manifest_blake3").unwrap();
    fs::write(bake.join("bake.json"), serde_json::to_string_pretty(&value).unwrap()).unwrap();
    let done = verify(&bake);
    assert!(done.code == Some(1) && done.out.contains("bake.json: has no manifest_blake3"), "{}", done.out);
}
