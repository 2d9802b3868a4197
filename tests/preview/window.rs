//! The window, on a display without a screen. Needs Xvfb and xdotool; skipped with a notice where they are not there.

use super::run::*;
use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A display that ends with the test.
struct Display {
    server: Child,
    name: String,
}

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
        let mut server = Command::new("Xvfb")
            .args(["-displayfd", "1", "-screen", "0", "640x480x24"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let mut line = String::new();
        BufReader::new(server.stdout.take().unwrap()).read_line(&mut line).unwrap();
        Some(Display { server, name: format!(":{}", line.trim()) })
    }

    fn xdotool(&self, line: &str) -> String {
        let out = Command::new("xdotool").env("DISPLAY", &self.name).args(line.split(' ')).output().unwrap();
        String::from_utf8_lossy(&out.stdout).trim().to_string()
    }

    fn title(&self) -> String {
        self.xdotool("search --name PgUp getwindowname")
    }

    fn key(&self, key: &str) {
        let window = self.xdotool("search --name PgUp");
        self.xdotool(&format!("windowfocus {window}"));
        self.xdotool(&format!("key {key}"));
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
        assert!(start.elapsed() < Duration::from_secs(90), "{what} did not come about");
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// Presses a key for something to come about, again after a while: a display without a window manager may lose one.
fn press(display: &Display, key: &str, what: &str, holds: impl Fn() -> bool) {
    let mut pressed: Option<Instant> = None;
    until(what, || {
        if pressed.is_none_or(|at| at.elapsed() > Duration::from_secs(25)) {
            display.key(key);
            pressed = Some(Instant::now());
        }
        holds()
    });
}

/// Copies a bake over another, the manifest last, as a bake that is written anew.
fn put(bake: &str, to: &Path) {
    for folder in ["compact", "elek2010", "water", ""] {
        if !Path::new(bake).join(folder).is_dir() {
            continue;
        }
        fs::create_dir_all(to.join(folder)).unwrap();
        for path in fs::read_dir(Path::new(bake).join(folder)).unwrap().map(|e| e.unwrap().path()) {
            if path.is_file() {
                fs::copy(&path, to.join(folder).join(path.file_name().unwrap())).unwrap();
            }
        }
    }
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
    let mut program = preview_command()
        .args([bake.to_str().unwrap(), "--size", "160x90"])
        .current_dir(dir.path())
        .env("DISPLAY", &display.name)
        .env_remove("WAYLAND_DISPLAY")
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    until("the title", || display.title().contains("earth compact tables"));
    press(&display, "Tab", "the other layout", || display.title().contains("earth elek2010"));
    press(&display, "p", "the screenshot", || dir.path().join("preview-001.png").exists());
    put(wet(), &bake);
    until("the bake that was written anew", || display.title().contains("mars elek2010"));
    press(&display, "w", "the first water", || display.title().contains("clear-ocean 10.0 m deep"));
    press(&display, "w", "the second water", || display.title().contains("muddy"));
    press(&display, "w", "land", || !display.title().contains("deep"));
    display.key("Escape");
    let mut status = None;
    until("the end", || {
        status = program.try_wait().unwrap();
        status.is_some()
    });
    let mut said = String::new();
    std::io::Read::read_to_string(&mut program.stderr.take().unwrap(), &mut said).unwrap();
    assert!(status.unwrap().success() && !said.contains("error:"), "{status:?}: {said}");
}
