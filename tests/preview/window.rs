//! The window, on a display without a screen. Needs Xvfb and xdotool; skipped with a notice where they are not there.

use super::drop::drop_on;
use super::pictures::{picture, read_png};
use super::run::*;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A display that ends with the test. There is one at a time: a window draws without pause, in software on all cores.
struct Display {
    server: Child,
    name: String,
    _turn: MutexGuard<'static, ()>,
}

static ONE: Mutex<()> = Mutex::new(());

impl Display {
    fn new() -> Option<Display> {
        let has = |program: &str| {
            let paths = std::env::var_os("PATH").unwrap_or_default();
            std::env::split_paths(&paths).any(|folder| folder.join(program).is_file())
        };
        if !(has("Xvfb") && has("xdotool")) {
            eprintln!(
                "SKIPPED: the window wants Xvfb and xdotool (Debian: xvfb xdotool libxkbcommon-x11-0 libxcursor1 libxi6)"
            );
            return None;
        }
        let turn = ONE.lock().unwrap_or_else(PoisonError::into_inner);
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "640x480x24"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut line).unwrap();
        assert!(!line.trim().is_empty(), "Xvfb does not start");
        Some(Display { server, name: format!(":{}", line.trim()), _turn: turn })
    }

    fn xdotool(&self, line: &str) -> String {
        let out = Command::new("xdotool").env("DISPLAY", &self.name).args(line.split(' ')).output().unwrap();
        String::from_utf8_lossy(&out.stdout).trim().to_string()
    }

    fn title(&self) -> String {
        self.xdotool("search --name PgUp getwindowname")
    }

    fn window(&self) -> String {
        self.xdotool("search --name PgUp")
    }

    fn key(&self, key: &str) {
        self.xdotool(&format!("windowfocus {}", self.window()));
        self.xdotool(&format!("key {key}"));
    }

    /// A window on a bake; the folder takes its screenshots, and what it says on stderr.
    fn open(&self, folder: &Path, bake: &str, more: &[&str]) -> Child {
        preview_command()
            .arg(bake)
            .args(more)
            .current_dir(folder)
            .env("DISPLAY", &self.name)
            .env_remove("WAYLAND_DISPLAY")
            .stdout(Stdio::null())
            .stderr(fs::File::create(folder.join("stderr")).unwrap())
            .spawn()
            .unwrap()
    }
}

impl Drop for Display {
    fn drop(&mut self) {
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

/// Waits for what must come about, for as long as a loaded machine may take.
fn until(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(600), "{what} did not come about");
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Presses a key for something to come about, again after a while: a display without a window manager may lose one.
fn press(display: &Display, key: &str, what: &str, mut holds: impl FnMut() -> bool) {
    let mut pressed: Option<Instant> = None;
    until(what, || {
        if holds() {
            return true;
        }
        if pressed.is_none_or(|at| at.elapsed() > Duration::from_secs(60)) {
            display.key(key);
            pressed = Some(Instant::now());
        }
        false
    });
}

/// Writes a manifest beside its place and moves it there, as bakes do: a window that looks finds the old or the new one.
fn put_manifest(text: impl AsRef<[u8]>, folder: &Path) {
    let beside = folder.join("bake.new");
    fs::write(&beside, text).unwrap();
    fs::rename(beside, folder.join("bake.json")).unwrap();
}

/// Copies a bake over another, the manifest last, as a bake that is written anew.
fn put(bake: &str, to: &Path) {
    for folder in ["compact", "elek2010", "water", ""] {
        if !Path::new(bake).join(folder).is_dir() {
            continue;
        }
        fs::create_dir_all(to.join(folder)).unwrap();
        for path in fs::read_dir(Path::new(bake).join(folder)).unwrap().map(|e| e.unwrap().path()) {
            if path.is_file() && !path.ends_with("bake.json") {
                fs::copy(&path, to.join(folder).join(path.file_name().unwrap())).unwrap();
            }
        }
    }
    put_manifest(fs::read(Path::new(bake).join("bake.json")).unwrap(), to);
}

/// Has a window closed by its key: the program's exit code.
fn quit(display: &Display, program: &mut Child) -> Option<i32> {
    let mut status = None;
    press(display, "Escape", "the end", || {
        status = program.try_wait().unwrap();
        status.is_some()
    });
    status.unwrap().code()
}

/// Waits for a program that ends by itself: its exit code.
fn end(program: &mut Child) -> Option<i32> {
    let mut status = None;
    until("the end", || {
        status = program.try_wait().unwrap();
        status.is_some()
    });
    status.unwrap().code()
}

fn said(folder: &Path) -> String {
    fs::read_to_string(folder.join("stderr")).unwrap()
}

/// A window opens with the bake in its title; Tab switches the layout, P leaves a picture, a bake written anew is
/// loaded, W goes through its waters and back to land, Escape ends the program, which found nothing to complain of.
#[test]
fn a_window_opens_and_obeys() {
    if !gpu() {
        return;
    }
    let Some(display) = Display::new() else { return };
    let dir = tempfile::tempdir().unwrap();
    let bake = dir.path().join("bake");
    put(earth(), &bake);
    let mut program = display.open(dir.path(), bake.to_str().unwrap(), &["--size", "160x90"]);
    until("the title", || display.title().contains("earth compact tables"));
    press(&display, "Tab", "the other layout", || display.title().contains("earth elek2010"));
    press(&display, "p", "the screenshot", || dir.path().join("preview-001.png").exists());
    put(wet(), &bake);
    until("the bake that was written anew", || display.title().contains("mars elek2010"));
    press(&display, "w", "the first water", || display.title().contains("clear-ocean 10.0 m deep"));
    press(&display, "w", "the second water", || display.title().contains("muddy"));
    press(&display, "w", "land", || !display.title().contains("deep"));
    assert_eq!((quit(&display, &mut program), said(dir.path()).as_str()), (Some(0), ""));
}

/// A folder dropped on the window is loaded. One that is no bake, a bake written anew that is cut off, and one of a newer
/// schema are told in a line, and the picture that is there stays.
#[test]
fn what_cannot_be_loaded_leaves_the_picture() {
    if !gpu() {
        return;
    }
    let Some(display) = Display::new() else { return };
    let dir = tempfile::tempdir().unwrap();
    let bake = dir.path().join("bake");
    put(earth(), &bake);
    let mut program = display.open(dir.path(), mars(), &["--size", "160x90"]);
    until("the title", || display.title().contains("mars compact tables"));
    let drop = |folder: &Path| drop_on(&display.name, display.window().parse().unwrap(), folder);
    drop(&bake);
    until("the bake that was dropped", || display.title().contains("earth compact tables"));

    let mut lines = 0;
    let mut line = |word: &str| {
        lines += 1;
        until(word, || said(dir.path()).lines().count() == lines);
        let last = said(dir.path()).lines().last().unwrap().to_string();
        assert!(last.starts_with("error: ") && last.contains(word), "{last}");
        assert!(display.title().contains("earth compact tables"), "{}", display.title());
    };
    let empty = dir.path().join("empty");
    fs::create_dir(&empty).unwrap();
    drop(&empty);
    line("empty");
    let manifest = fs::read_to_string(bake.join("bake.json")).unwrap();
    put_manifest(&manifest[..manifest.len() / 2], &bake);
    line("bake.json");
    let newer = manifest.replacen("\"schema_version\": 1", "\"schema_version\": 999", 1);
    put_manifest(newer, &bake);
    line("999");
    put(mars(), &bake);
    until("a sound bake again", || display.title().contains("mars compact tables"));
    assert_eq!(quit(&display, &mut program), Some(0), "{}", said(dir.path()));
}

fn is_png(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "png")
}

/// The aerosol's g that a title names.
fn g_of(title: &str) -> Option<f64> {
    title.split(", g ").nth(1)?.split(' ').next()?.parse().ok()
}

/// G in the window turns the aerosol's g up, and the picture is the one that `--g` draws with the g of the title, another
/// than before. (How far a press turns it is a unit test's: a display may lose a press, or repeat one.)
#[test]
fn g_is_turned_live() {
    if !gpu() {
        return;
    }
    let Some(display) = Display::new() else { return };
    let dir = tempfile::tempdir().unwrap();
    let line = "--layout elek2010 --size 96x54 --exposure 14";
    let mut program = display.open(dir.path(), mars(), &line.split(' ').collect::<Vec<_>>());
    until("the title", || display.title().contains("mars elek2010"));
    assert_eq!(g_of(&display.title()), None, "{}", display.title());
    let mut turned = 0.76;
    while turned < 0.855 {
        let before = turned;
        press(&display, "g", "a larger g", || {
            turned = g_of(&display.title()).unwrap_or(turned);
            turned > before
        });
    }
    // Presses that still wait are let through: the title is the same after as before the picture, the last one there is.
    let shots = || fs::read_dir(dir.path()).unwrap().filter(|e| is_png(&e.as_ref().unwrap().path())).count();
    let g = loop {
        let (before, already) = (g_of(&display.title()), shots());
        press(&display, "p", "a screenshot", || shots() > already);
        std::thread::sleep(Duration::from_secs(3));
        if before == g_of(&display.title()) {
            break before.unwrap();
        }
    };
    assert_eq!((quit(&display, &mut program), said(dir.path()).as_str()), (Some(0), ""));
    let shown = read_png(&dir.path().join(format!("preview-{:03}.png", shots()))).2;
    let apart = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap();
    let wanted = picture(mars(), &format!("{line} --g {g}")).2;
    assert!(apart(&shown, &wanted) <= 1, "g {g}: {}", apart(&shown, &wanted));
    let before = picture(mars(), line).2;
    assert!(apart(&shown, &before) > 10, "g {g}: {}", apart(&shown, &before));
}

/// A window of one pixel, a hidden one and one that is large again: frames go on, and nothing is said. (X11 has no windows
/// of no size; of other systems' the program draws none.)
#[test]
fn windows_shrink_and_hide() {
    if !gpu() {
        return;
    }
    let Some(display) = Display::new() else { return };
    let dir = tempfile::tempdir().unwrap();
    let mut program = display.open(dir.path(), earth(), &["--size", "160x90", "--relief"]);
    until("the title", || display.title().contains("earth compact tables"));
    let window = display.window();
    display.xdotool(&format!("windowsize {window} 1 1"));
    press(&display, "Tab", "the other layout", || display.title().contains("earth elek2010"));
    display.xdotool(&format!("windowunmap {window}"));
    display.xdotool(&format!("windowmap {window}"));
    display.xdotool(&format!("windowsize {window} 200 100"));
    press(&display, "p", "the new size", || {
        let shots = fs::read_dir(dir.path()).unwrap().map(|e| e.unwrap().path());
        shots.filter(|p| is_png(p)).any(|p| {
            let whole = fs::metadata(&p).is_ok_and(|m| m.len() > 1000);
            whole && std::panic::catch_unwind(|| read_png(&p)).is_ok_and(|(w, h, _)| (w, h) == (200, 100))
        })
    });
    assert_eq!((quit(&display, &mut program), said(dir.path()).as_str()), (Some(0), ""));
}

/// A device that is lost while frames are drawn ends the window with one line and the machine's exit code.
#[test]
fn a_device_lost_under_a_window_is_told() {
    if !gpu() {
        return;
    }
    let Some(display) = Display::new() else { return };
    let dir = tempfile::tempdir().unwrap();
    let mut program = display.open(dir.path(), earth(), &["--size", "160x90", "--lose-device"]);
    assert_eq!(end(&mut program), Some(3));
    let said = said(dir.path());
    assert!(said.starts_with("error: GPU: the device was lost") && said.lines().count() == 1, "{said}");
}
