//! What cannot be drawn: one clear line, the exit code of the interface, no panic.

use super::run::*;
use std::fs;
use std::path::Path;

fn refused(done: &Ran, code: i32, words: &[&str]) {
    assert_eq!(done.code, Some(code), "{}", done.err);
    assert!(!done.err.contains("panicked"), "{}", done.err);
    assert_eq!(done.err.trim_end().lines().count(), 1, "{}", done.err);
    for word in words {
        assert!(done.err.contains(word), "{word} is not in: {}", done.err);
    }
}

/// A folder with a copy of a bake's manifest and, of its tables, those of one layout.
fn copy(bake: &str, to: &Path) {
    for folder in ["", "compact"] {
        fs::create_dir_all(to.join(folder)).unwrap();
        for entry in fs::read_dir(Path::new(bake).join(folder)).unwrap().map(|e| e.unwrap().path()) {
            if entry.is_file() {
                fs::copy(&entry, to.join(folder).join(entry.file_name().unwrap())).unwrap();
            }
        }
    }
}

fn draw(bake: &Path, more: &[&str]) -> Ran {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("x.png");
    let mut arguments = vec![bake.to_str().unwrap(), "--headless", "--out", out.to_str().unwrap()];
    arguments.extend(more);
    preview(&arguments)
}

/// With no driver at all the message names packages that bring one; that is the machine's fault: 3.
#[test]
#[cfg(target_os = "linux")]
fn without_a_gpu_the_message_says_what_to_install() {
    let done = preview_command()
        .args([earth(), "--headless", "--out", "never.png"])
        .envs(["VK_ICD_FILENAMES", "VK_DRIVER_FILES"].map(|name| (name, "/nowhere.json")))
        .output()
        .unwrap();
    let err = String::from_utf8(done.stderr).unwrap();
    let done = Ran { code: done.status.code(), out: String::new(), err };
    refused(&done, 3, &["no GPU was found", "mesa-vulkan-drivers"]);
    assert!(!Path::new("never.png").exists());
}

/// Files that are no bake, of a newer schema, truncated, or another than the one that was baked: the user's, 2.
#[test]
fn wrong_files_are_named() {
    let dir = tempfile::tempdir().unwrap();
    refused(&draw(&dir.path().join("nowhere"), &[]), 2, &["nowhere", "no such bake"]);
    refused(&draw(dir.path(), &[]), 2, &["bake.json"]);

    let bake = dir.path().join("bake");
    copy(earth(), &bake);
    let manifest = fs::read_to_string(bake.join("bake.json")).unwrap();
    let newer = manifest.replacen("\"schema_version\": 1", "\"schema_version\": 999", 1);
    assert_ne!(newer, manifest);
    fs::write(bake.join("bake.json"), newer).unwrap();
    refused(&draw(&bake, &[]), 2, &["bake.json", "999", "newer"]);
    fs::write(bake.join("bake.json"), &manifest[..manifest.len() / 2]).unwrap();
    refused(&draw(&bake, &[]), 2, &["bake.json", "line"]);
    fs::write(bake.join("bake.json"), &manifest).unwrap();

    let table = bake.join("compact/multiple.exr");
    let bytes = fs::read(&table).unwrap();
    fs::write(&table, &bytes[..bytes.len() / 2]).unwrap();
    refused(&draw(&bake, &[]), 2, &["multiple.exr"]);
    fs::copy(bake.join("compact/single_air.exr"), &table).unwrap();
    refused(&draw(&bake, &[]), 2, &["multiple.exr", "not the file that was baked"]);
    fs::remove_file(&table).unwrap();
    refused(&draw(&bake, &[]), 2, &["multiple.exr"]);
}

/// Arguments that make no picture: 2. Those that the parser refuses come with its usage lines.
#[test]
fn wrong_arguments_are_named() {
    for (line, word) in [
        ("--size 0x0", "--size"),
        ("--size 0x10", "--size"),
        ("--size 10", "--size"),
        ("--sun 91", "--sun"),
        ("--altitude -1", "--altitude"),
        ("--exposure bright", "--exposure"),
        ("--layout three", "--layout"),
        ("--field 0", "--field"),
    ] {
        let done = draw(Path::new(earth()), &line.split(' ').collect::<Vec<_>>());
        assert_eq!(done.code, Some(2), "{line}: {}", done.err);
        assert!(done.err.contains(word) && !done.err.contains("panicked"), "{line}: {}", done.err);
    }
}

/// What only the GPU or the bake can refuse.
#[test]
fn what_does_not_fit_is_named() {
    if !gpu() {
        return;
    }
    refused(&draw(Path::new(earth()), &["--size", "32768x32768"]), 2, &["--size 32768x32768", "pixels"]);
    refused(&draw(Path::new(earth()), &["--g", "0.5"]), 2, &["--g", "elek2010"]);
    let water = |bake: &str, line: &str| draw(Path::new(bake), &line.split(' ').collect::<Vec<_>>());
    refused(&water(earth(), "--water muddy"), 2, &["--water muddy", "no waters", "--waters"]);
    refused(&water(wet(), "--water algae"), 2, &["--water algae", "clear-ocean, muddy"]);
    refused(&water(wet(), "--water muddy --depth 101"), 2, &["--depth 101", "muddy", "0 to 100 m"]);
    refused(&water(wet(), "--water muddy --depth -1"), 2, &["--depth -1", "0 to 100 m"]);
    refused(&preview(&[earth(), "--headless"]), 2, &["--out"]);
    let nowhere = preview(&[earth(), "--headless", "--size", "8x8", "--out", "/nowhere/x.png"]);
    refused(&nowhere, 3, &["/nowhere/x.png"]);
}

/// A device that is lost, whatever is done with it: the machine's fault, in one line that says so. (Destroyed on purpose;
/// the driver's word and this one come by the same callback.)
#[test]
fn a_lost_device_is_told() {
    if !gpu() {
        return;
    }
    for more in [&["--relief"][..], &["--method", "march"], &["--layout", "elek2010"]] {
        let mut all = vec!["--size", "16x9", "--lose-device"];
        all.extend(more);
        refused(&draw(Path::new(earth()), &all), 3, &["GPU: the device was lost"]);
    }
    let bench = [earth(), "--bench", "--size", "16x9", "--frames", "2", "--lose-device"];
    refused(&preview(&bench), 3, &["GPU: the device was lost"]);
    let dir = tempfile::tempdir().unwrap();
    let points = write_points(dir.path(), &[[0.0, 1.0, 1.0, 0.0]]);
    refused(&preview(&[earth(), "--points", &points, "--lose-device"]), 3, &["GPU: the device was lost"]);
}
