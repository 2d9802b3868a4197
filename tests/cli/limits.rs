//! What a process is started with: signals that it ignores, limits of its memory, disks that are full or layered.

#![cfg(target_os = "linux")]

use super::run::*;
use crate::mounted::Mounted;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A small bake, behind a shell that runs `first`, at its work.
fn begun(first: &str, out: &Path) -> Child {
    let bake = small_bake("earth", out, &["--layout", "compact", "--orders", "6"]);
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{first}; exec \"$0\" \"$@\"")]).arg(bake.get_program()).args(bake.get_args());
    let child = shell.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let start = Instant::now();
    let begun = || out.exists() && names(out).iter().any(|name| name.starts_with(".earth.tmp-"));
    while !begun() {
        assert!(start.elapsed() < Duration::from_secs(120), "the bake does not begin");
        std::thread::sleep(Duration::from_millis(1));
    }
    child
}

/// Whether this test's own process ignores a signal, as its children would then.
fn ignored_here(number: u32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).unwrap();
    u64::from_str_radix(line.trim(), 16).unwrap() >> (number - 1) & 1 == 1
}

/// What was ignored at the start, as `nohup` does with the end of its terminal, stays ignored, each signal by itself; the
/// others end the bake.
#[test]
fn signals_that_are_ignored() {
    for (name, number, others) in
        [("HUP", 1, ["INT", "TERM"]), ("INT", 2, ["TERM", "HUP"]), ("TERM", 15, ["HUP", "INT"])]
    {
        if ["HUP", "INT", "TERM"].iter().zip([1, 2, 15]).any(|(_, n)| ignored_here(n)) {
            return eprintln!("skipped: signals are ignored here already");
        }
        let send = |child: &Child, name: &str| {
            let sent = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
            assert!(sent.unwrap().success());
        };
        let dir = tempfile::tempdir().unwrap();
        let child = begun(&format!("trap '' {name}"), dir.path());
        send(&child, name);
        let done = ran(child.wait_with_output().unwrap());
        assert_eq!(done.code, Some(0), "{name} ({number}): {}", done.err);
        holds(&dir.path().join("earth"));
        let dir = tempfile::tempdir().unwrap();
        let child = begun(&format!("trap '' {name}"), dir.path());
        send(&child, others[0]);
        let done = ran(child.wait_with_output().unwrap());
        // Unless it was done already.
        assert!(matches!(done.code, Some(3 | 0)), "{}: {:?} {}", others[0], done.code, done.err);
    }
}

/// Under any limit of its memory a command does its work or ends with a line and 3; no abort, no panic.
#[test]
fn limits_of_memory() {
    let dir = tempfile::tempdir().unwrap();
    let points = dir.path().join("views.csv");
    fs::write(&points, VIEWS).unwrap();
    let out = dir.path().join("out");
    let bake = [
        "bake",
        "earth",
        "--quiet",
        "--layout",
        "compact",
        "--orders",
        "1",
        "--memory",
        "8GiB",
        "--out",
        out.to_str().unwrap(),
    ];
    let sample = ["sample", earth().to_str().unwrap(), "--points", points.to_str().unwrap(), "--exact"];
    let mut failed = 0;
    for limit in ["v 60000", "v 120000", "v 200000", "d 30000", "d 100000"] {
        for words in
            [&bake[..], &sample, &["presets", "show", "earth"], &["verify", earth().to_str().unwrap()]]
        {
            let mut shell = Command::new("sh");
            shell
                .args(["-c", &format!("ulimit -{limit}; exec \"$0\" \"$@\"")])
                .arg(env!("CARGO_BIN_EXE_tyndall"));
            let done = ran(shell.args(words).output().unwrap());
            // What the loader of the system says where not even the program fits is not ours.
            if matches!(done.code, Some(126 | 127))
                || done.err.contains("error while loading shared libraries")
            {
                continue;
            }
            assert!(matches!(done.code, Some(0 | 3)), "{limit}, {words:?}: {:?}: {}", done.code, done.err);
            if done.code == Some(3) {
                failed += 1;
                let line = done.err.lines().last().unwrap_or_default();
                assert!(line.starts_with("error: "), "{limit}, {words:?}: {}", done.err);
            }
        }
    }
    assert!(failed > 0, "no limit was too tight");
    assert!(!out.exists() || names(&out).iter().all(|name| name == "earth"), "{:?}", names(&out));
}

/// More memory than a limit leaves is refused before the solve, with what there is.
#[test]
fn a_limit_is_seen_before_the_solve() {
    let dir = tempfile::tempdir().unwrap();
    let mut shell = Command::new("sh");
    shell.args(["-c", "ulimit -v 150000; exec \"$0\" bake earth --quiet --out \"$1\""]);
    let done = ran(shell.arg(env!("CARGO_BIN_EXE_tyndall")).arg(dir.path()).output().unwrap());
    assert_eq!((done.code, done.err.lines().count()), (Some(3), 1), "{}", done.err);
    assert!(done.err.contains("of memory, and") && done.err.contains("are free"), "{}", done.err);
}

/// A chart on a disk that its picture fills leaves what was whole before it, and finished parts of its work.
#[test]
fn a_chart_on_a_full_disk() {
    let Some(disk) = Mounted::new("size=60k") else { return };
    let dir = tempfile::tempdir().unwrap();
    let mut chart = command();
    chart
        .arg("chart")
        .arg(gas(dir.path()))
        .args(["--views", "1", "--only", "Nishita", "--quiet", "--out"])
        .arg(disk.path());
    let done = ran(chart.output().unwrap());
    assert!(done.code == Some(3) && done.err.contains("gas.svg: No space left"), "{}", done.err);
    assert!(!done.err.contains(".tyndall"), "{}", done.err);
    let left: Vec<String> = files(disk.path()).into_keys().collect();
    let whole = |name: &String| [".csv", ".svg", ".png", ".json"].iter().any(|end| name.ends_with(end));
    assert!(left.iter().all(|name| whole(name) && !name.contains(".t")), "{left:?}");
}

/// A depfile on a full disk stays what it was.
#[test]
fn a_depfile_on_a_full_disk() {
    let Some(disk) = Mounted::new("size=8k") else { return };
    let dir = tempfile::tempdir().unwrap();
    bake("earth", dir.path(), &["--layout", "compact"]);
    let depfile = disk.path().join("mine.d");
    fs::write(&depfile, "old").unwrap();
    fs::write(disk.path().join("rest"), [0; 4096]).unwrap();
    let mut bake = small_bake("earth", dir.path(), &["--layout", "compact"]);
    let done = ran(bake.arg("--depfile").arg(&depfile).output().unwrap());
    assert!(
        done.code == Some(3) && done.err.contains("mine.d: No space left"),
        "{:?}: {}",
        done.code,
        done.err
    );
    assert_eq!((fs::read_to_string(&depfile).unwrap().as_str(), names(disk.path()).len()), ("old", 2));
}

/// A bake that comes from an image, under an overlay filesystem, cannot be moved (EXDEV); one that is a mount of its own
/// cannot either (EBUSY). Both are replaced file by file, and what is not the bake's stays.
#[test]
fn bakes_that_cannot_be_moved() {
    let Some(disk) = Mounted::new("size=64m") else { return };
    let at = |name: &str| disk.path().join(name);
    for name in ["lower", "upper", "work", "merged"] {
        fs::create_dir(at(name)).unwrap();
    }
    bake("earth", &at("lower"), &[]);
    fs::write(at("lower/earth/compact/multiple.exr.meta"), "mine").unwrap();
    let options = format!(
        "lowerdir={},upperdir={},workdir={}",
        at("lower").display(),
        at("upper").display(),
        at("work").display()
    );
    let _overlay = Unmount::of(&["-t", "overlay", "-o", &options, "overlay"], &at("merged"));
    let _mount = Unmount::of(&["-t", "tmpfs", "tmpfs"], &{
        fs::create_dir_all(at("mounted/earth")).unwrap();
        at("mounted/earth")
    });
    for (out, first) in [(at("merged"), false), (at("mounted"), true)] {
        let folder = out.join("earth");
        if first {
            bake("earth", &out, &[]);
            fs::write(folder.join("compact/multiple.exr.meta"), "mine").unwrap();
        }
        for albedo in ["0.2", "0.7"] {
            let set = format!("ground.albedo={albedo}");
            bake("earth", &out, &["--layout", "elek2010", "--set", &set]);
            holds(&folder);
            assert_eq!(fs::read_to_string(folder.join("compact/multiple.exr.meta")).unwrap(), "mine");
            assert!(!folder.join("compact/multiple.exr").exists());
            assert_eq!(names(&out), ["earth"]);
            assert!(manifest(&folder)["preset"].to_string().contains(albedo));
        }
    }
}

/// A mount that goes with the test; none where it cannot be had.
struct Unmount(std::path::PathBuf);

impl Unmount {
    fn of(options: &[&str], at: &Path) -> Option<Self> {
        let mounted = Command::new("mount").args(options).arg(at).output().unwrap();
        mounted.status.success().then(|| Unmount(at.to_path_buf()))
    }
}

impl Drop for Unmount {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}
