//! A bake is stale when its bytes would change: `ALGORITHM_VERSION`s say so. Hashes of small bakes are kept in
//! `tests/data/bytes.json` with the versions that made them. Bytes that change without a version fail here, and so does a
//! version that is raised for nothing.
//!
//! After a version was raised, `TYNDALL_RECORD_BYTES=1 cargo test --release --test cli bytes` writes the file anew, and
//! fails so that nobody takes it for a check.

use super::run::*;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use tyndall::internals::bake::versions;
use tyndall::internals::layout;

/// Which bakes: what each holds that no other does. Their options come after those of [`SMALL`].
const BAKES: [(&str, &str, &str); 13] = [
    ("elek2010", "earth", "--layout elek2010"),
    ("compact", "earth", "--layout compact"),
    ("three-atmosphere", "earth-blog", "--layout three-atmosphere --wavelengths 3 --orders 1"),
    ("containers", "earth-paper", "--formats exr,ktx2,dds,npy"),
    ("spectral", "earth-paper", "--layout elek2010 --spectral --colour-space rec2020"),
    ("literal", "earth-paper", "--layout elek2010 --solver literal"),
    ("water", "earth-paper", "--layout elek2010 --waters clear-ocean --size water=3x4x5 --wavelengths 3"),
    (
        "underwater",
        "earth-paper",
        "--layout elek2010 --waters muddy --underwater --size water=2x2x2 --water-orders 1",
    ),
    ("thick", "venus", "--layout elek2010 --orders auto"),
    ("cloudtop", "venus-cloudtop", "--orders auto"),
    ("thin", "earth-sparse10", "--orders auto"),
    ("dusty", "mars", "--orders auto --wavelengths 440,550,680"),
    ("window", "earth", "--altitudes 0..12km --suns -6..60 --views sky"),
];

/// Hashes by bake and part of it; a part is a layout, `water`, or what all share.
type Hashes = BTreeMap<String, BTreeMap<String, String>>;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Record {
    algorithms: BTreeMap<String, u32>,
    bakes: Hashes,
}

/// Everything of a bake that no layout owns: `bake.json`, pictures, spectral files.
const SHARED: &str = "shared";

fn kept() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/bytes.json")
}

fn part_of(file: &str) -> String {
    let folder = file.split('/').next().unwrap();
    let own = folder != versions::SOLVER && versions::all().contains_key(folder);
    if own { folder.into() } else { SHARED.into() }
}

/// `bake.json` without what says who made it, without the hashes of other files, which have their own here, and without
/// warnings: the same in other words makes no bake stale.
fn of_manifest(bytes: &[u8]) -> Vec<u8> {
    fn bare(value: &mut Value) {
        if let Value::Object(map) = value {
            map.retain(|key, _| !["blake3", "manifest_blake3", "tool", "warnings"].contains(&key.as_str()));
            map.values_mut().for_each(bare);
        } else if let Value::Array(list) = value {
            list.iter_mut().for_each(bare);
        }
    }
    let mut manifest: Value = serde_json::from_slice(bytes).unwrap();
    bare(&mut manifest);
    manifest.to_string().into_bytes()
}

fn hashes(bake: &Path) -> BTreeMap<String, String> {
    let mut parts: BTreeMap<String, blake3::Hasher> = BTreeMap::new();
    for (file, bytes) in files(bake) {
        let bytes = if file == "bake.json" { of_manifest(&bytes) } else { bytes };
        let hasher = parts.entry(part_of(&file)).or_default();
        hasher.update(file.as_bytes()).update(&[0]).update(blake3::hash(&bytes).as_bytes());
    }
    parts.into_iter().map(|(part, hasher)| (part, hasher.finalize().to_hex().to_string())).collect()
}

/// All bakes of today, and the compact one under another star.
fn today() -> Record {
    let dir = tempfile::tempdir().unwrap();
    let mut bakes = Hashes::new();
    for (name, preset, options) in BAKES {
        let options: Vec<&str> = options.split(' ').collect();
        let folder = bake(preset, &dir.path().join(name), &options);
        bakes.insert(name.into(), hashes(&folder));
    }
    let compact = dir.path().join("compact/earth");
    let redder = dir.path().join("redder");
    let line = format!("recolour {} --star 4000 --out {}", compact.display(), redder.display());
    let done = words(&line);
    assert_eq!(done.code, Some(0), "{}", done.err);
    bakes.insert("recoloured".into(), hashes(&redder));
    Record { algorithms: versions::all(), bakes }
}

/// The algorithms whose bytes changed, with the bakes that show it. What all share follows the layouts of the same
/// bake; where it changed alone, or where every layout did, it was the solver.
fn changed(old: &Hashes, new: &Hashes) -> BTreeMap<String, BTreeSet<String>> {
    let mut found: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    for name in old.keys().chain(new.keys()).collect::<BTreeSet<_>>() {
        let parts = |hashes: &Hashes| hashes.get(name).cloned().unwrap_or_default();
        let (was, is) = (parts(old), parts(new));
        let all: BTreeSet<&String> = was.keys().chain(is.keys()).collect();
        let differ: BTreeSet<&String> =
            all.into_iter().filter(|part| was.get(*part) != is.get(*part)).collect();
        let alone = differ.len() == 1 && differ.iter().all(|part| *part == SHARED);
        for part in differ.into_iter().filter(|part| alone || *part != SHARED) {
            let algorithm = if part == SHARED { versions::SOLVER } else { part };
            found.entry(algorithm.into()).or_default().insert(name.clone());
        }
    }
    if layout::ALL.iter().all(|layout| found.contains_key(layout.name())) {
        let bakes = std::mem::take(&mut found).into_values().flatten().collect();
        found.insert(versions::SOLVER.into(), bakes);
    }
    found
}

/// What is to be done, a line each; nothing where every change of bytes has its version and every version its change.
fn complaints(old: &Record, new: &Record) -> Vec<String> {
    let changed = changed(&old.bakes, &new.bakes);
    let raised: BTreeSet<&String> =
        new.algorithms.keys().filter(|k| old.algorithms.get(*k) != new.algorithms.get(*k)).collect();
    let by_solver = raised.iter().any(|name| *name == versions::SOLVER);
    let mut lines = Vec::new();
    for (name, bakes) in changed.iter().filter(|(name, _)| !by_solver && !raised.contains(name)) {
        lines
            .push(format!("bytes of {bakes:?} changed: raise ALGORITHM_VERSION of {name} ({})", place(name)));
    }
    for name in raised {
        let shown = changed.contains_key(name) || name == versions::SOLVER && !changed.is_empty();
        match (old.algorithms.get(name), new.algorithms.get(name)) {
            (Some(was), Some(is)) if is < was => lines.push(format!("{name}: version {is} was once {was}")),
            (Some(was), _) if !shown => {
                lines.push(format!(
                    "version of {name} was raised and no byte changed: {was} again ({})",
                    place(name)
                ));
            }
            _ => {}
        }
    }
    lines
}

fn place(algorithm: &str) -> &'static str {
    match algorithm {
        "elek2010" => "src/bake/elek2010.rs",
        "compact" => "src/bake/compact.rs",
        "three-atmosphere" => "src/bake/three_atmosphere/mod.rs",
        "water" => "src/bake/water/mod.rs",
        _ => "src/transport/mod.rs",
    }
}

#[test]
fn bytes_and_versions_change_together() {
    let new = today();
    let record = std::env::var_os("TYNDALL_RECORD_BYTES").is_some();
    let old: Record = match std::fs::read(kept()) {
        Ok(bytes) => serde_json::from_slice(&bytes).unwrap(),
        Err(_) if record => new.clone(),
        Err(e) => panic!("{}: {e}", kept().display()),
    };
    let lines = complaints(&old, &new);
    assert!(lines.is_empty(), "\n{}\n", lines.join("\n"));
    if record {
        std::fs::write(kept(), serde_json::to_string_pretty(&new).unwrap() + "\n").unwrap();
        panic!(
            "{} is written anew: commit it with the change, and run this without TYNDALL_RECORD_BYTES",
            kept().display()
        );
    }
    assert!(old == new, "versions were raised: run this once with TYNDALL_RECORD_BYTES=1");
}

/// The judge itself, on records made up: each layout alone, all of them, shared bytes alone, versions without a change.
#[test]
fn the_judge_of_bytes() {
    let record = |versions: [u32; 4], bytes: [&str; 4]| {
        let names = ["compact", "elek2010", "solver", "three-atmosphere"];
        let algorithms = names.iter().zip(versions).map(|(name, v)| (name.to_string(), v)).collect();
        let one = |layout: &str, own: &str, shared: &str| {
            let parts = [(layout, own), (SHARED, shared)].map(|(k, v)| (k.to_string(), v.to_string()));
            (layout.to_string(), BTreeMap::from(parts))
        };
        let [compact, elek, shared, three] = bytes;
        let shared = |own: &str| format!("{shared} of {own}");
        let bakes = [("compact", compact), ("elek2010", elek), ("three-atmosphere", three)];
        Record { algorithms, bakes: bakes.map(|(layout, own)| one(layout, own, &shared(own))).into() }
    };
    let old = record([1; 4], ["a"; 4]);
    let told = |versions, bytes| complaints(&old, &record(versions, bytes)).join("; ");
    assert_eq!(told([1; 4], ["a"; 4]), "");
    assert!(told([1; 4], ["b", "a", "a", "a"]).contains("raise ALGORITHM_VERSION of compact"));
    assert_eq!(told([2, 1, 1, 1], ["b", "a", "a", "a"]), "");
    assert!(told([1; 4], ["b", "b", "a", "b"]).contains("raise ALGORITHM_VERSION of solver"));
    assert!(told([1; 4], ["a", "a", "b", "a"]).contains("raise ALGORITHM_VERSION of solver"));
    assert_eq!(told([1, 1, 2, 1], ["b", "b", "a", "a"]), "");
    assert!(told([1, 2, 1, 1], ["b", "a", "a", "a"]).contains("elek2010 was raised and no byte changed"));
    assert!(told([1, 1, 2, 1], ["a"; 4]).contains("solver was raised and no byte changed"));
    assert!(complaints(&record([2; 4], ["b"; 4]), &old).iter().any(|line| line.contains("was once 2")));
}
