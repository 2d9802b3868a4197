//! Fuzzing in small, without a fuzzer: seeds of every kind of input, kept findings among them, and what becomes of them
//! by changes at random, always the same ones. `scripts/fuzz` runs the same functions for hours, led by coverage.

#[path = "fuzz/bodies/mod.rs"]
mod bodies;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// Numbers at random (xorshift64*, Vigna 2016), the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % n.max(1)
    }
}

/// What readers look for or stumble over.
const WORDS: [&str; 20] = [
    "\n",
    "\r",
    "\t",
    "\"",
    ",",
    "#",
    "=",
    "x",
    "..",
    "-1",
    "1e999",
    "NaN",
    "inf",
    "0x",
    "null",
    "[[[[",
    "{}",
    "\u{1b}[31m",
    "\u{2028}",
    "99999999999999999999",
];

fn changed(seed: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..1 + random.below(4) {
        let at = random.below(bytes.len() + 1);
        match random.below(7) {
            0 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            1 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            2 => bytes.truncate(at),
            3 => {
                let until = (at + random.below(16)).min(bytes.len());
                bytes.drain(at..until);
            }
            4 => {
                let word = WORDS[random.below(WORDS.len())].bytes();
                bytes.splice(at..at, word);
            }
            5 if !other.is_empty() => {
                let from = random.below(other.len());
                let until = (from + 1 + random.below(64)).min(other.len());
                bytes.splice(at..at, other[from..until].iter().copied());
            }
            _ => bytes.extend((0..random.below(24)).map(|_| random.below(256) as u8)),
        }
    }
    bytes
}

/// The kept inputs of a target, in the order of their names.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/fuzz/corpus").join(target);
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files.iter().map(|file| std::fs::read(file).unwrap()).collect()
}

/// The target whose bytes are choices: changes of a few of them would try little.
const CHOICES: &str = "any_bake";

/// For `xxd -r -p`, which makes a seed of it.
fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The number in a variable of the environment.
fn asked(name: &str) -> Option<u64> {
    std::env::var(name).ok()?.parse().ok()
}

/// Runs a target on its seeds and on so many changes of them, or on so many strings of random bytes where those are
/// choices. Edits of files of ours need no seed: any bytes are some. `TYNDALL_FUZZ_RUNS` is another number of inputs,
/// `TYNDALL_FUZZ_SEED` gives others.
fn run(target: &str, count: usize) {
    let seeds = seeds(target);
    assert!(!seeds.is_empty(), "{target}");
    let count = asked("TYNDALL_FUZZ_RUNS").map_or(count, |runs| runs as usize);
    let mut random = Random(0x9e37_79b9_7f4a_7c15 ^ asked("TYNDALL_FUZZ_SEED").unwrap_or(0) << 8);
    let inputs = (0..count).map(|_| {
        if target == CHOICES {
            return (0..100).map(|_| random.below(256) as u8).collect();
        }
        let [seed, other] = [0, 1].map(|_| &seeds[random.below(seeds.len())]);
        changed(seed, other, &mut random)
    });
    let broken = |input: &Vec<u8>| {
        catch_unwind(AssertUnwindSafe(|| bodies::run(target, input))).is_err().then(|| {
            let text = String::from_utf8_lossy(input);
            format!("{text:?} {}", hex(input))
        })
    };
    let broken: Vec<String> =
        seeds.iter().cloned().chain(inputs.collect::<Vec<_>>()).filter_map(|input| broken(&input)).collect();
    assert!(broken.is_empty(), "{target}: {} inputs:\n{}", broken.len(), broken.join("\n"));
}

macro_rules! targets {
    ($($name:ident: $count:literal),* $(,)?) => {
        $(#[test] fn $name() { run(stringify!($name), $count); })*

        /// Every target has its test.
        #[test]
        fn all_are_run() {
            let tested = [$(stringify!($name)),*];
            assert!(bodies::ALL.iter().all(|(name, _)| tested.contains(name)) && tested.len() == bodies::ALL.len());
        }
    };
}

// Counts that take a second or two each.
targets! {
    planet: 3000,
    water: 3000,
    scene: 20000,
    set: 3000,
    solve: 600,
    points: 50000,
    spectra: 50000,
    spectrum: 200000,
    chart: 2000,
    options: 20000,
    list: 4000,
    exr: 5000,
    skies: 2000,
    manifest: 1000,
    package: 40,
    folder: 60,
    recolour: 4,
    any_bake: 100,
}
