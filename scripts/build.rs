//! Gives the program a fingerprint of the sources that decide what a bake holds, so that a bake of another build
//! of the same version is known for what it is.

use std::fs;
use std::path::{Path, PathBuf};

/// Folders of `src` that write no byte of a table.
const APART: [&str; 2] = ["src/bin", "src/commands"];

fn main() {
    let mut files = vec![PathBuf::from("Cargo.lock")];
    for root in ["src", "presets"] {
        collect(Path::new(root), &mut files);
    }
    files.sort();
    let mut hash = Fnv::default();
    for file in &files {
        println!("cargo::rerun-if-changed={}", file.display());
        // The parts of a path apart, since systems separate them differently; line ends likewise.
        file.components().for_each(|part| hash.add(part.as_os_str().as_encoded_bytes()));
        let bytes = fs::read(file).unwrap_or_default();
        hash.add(&bytes.into_iter().filter(|&b| b != b'\r').collect::<Vec<u8>>());
    }
    println!("cargo::rustc-env=TYNDALL_SOURCE={:032x}", hash.0);
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    // A folder counts as changed when a file comes or goes.
    println!("cargo::rerun-if-changed={}", folder.display());
    for path in fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            if !APART.iter().any(|apart| path == Path::new(apart)) {
                collect(&path, files);
            }
        } else {
            files.push(path);
        }
    }
}

/// FNV-1a of 128 bits: enough to tell builds apart, and no dependency of the build. Chunks end with a zero byte.
struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Fnv(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes.iter().chain(&[0]) {
            self.0 = (self.0 ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b);
        }
    }
}
