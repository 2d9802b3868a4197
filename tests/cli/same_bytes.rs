//! Same input, same bytes: over runs, thread counts and instruction sets.

use super::run::*;
use std::collections::BTreeMap;

fn bytes(more: &[&str]) -> BTreeMap<String, Vec<u8>> {
    let dir = tempfile::tempdir().unwrap();
    files(&bake("earth", dir.path(), &[&["--spectral", "--wavelengths", "17"], more].concat()))
}

/// Every file of a bake with all that it can write and more wavelengths than one pass of the solver holds. What
/// depends on the order of a sum, the number of workers or the width of vectors would show. One instruction set is that
/// of the first bake, made again.
#[test]
fn over_runs_threads_and_instruction_sets() {
    let one = bytes(&["--threads", "1"]);
    assert!(one.len() >= 14 && one.contains_key("spectral/scattering_gas.exr"), "{:?}", one.keys());
    let mut others = vec![vec!["--threads", "5"]];
    for isa in ["baseline", "avx2", "avx512"] {
        let has = words(&format!("sample {} --points no-such-file --isa {isa}", earth().display()));
        match has.err.contains("this machine has") {
            true => eprintln!("skipped: {}", has.err.trim()),
            false => others.push(vec!["--isa", isa]),
        }
    }
    for more in others {
        let other = bytes(&more);
        assert!(one.keys().eq(other.keys()), "{more:?}: {:?}", other.keys());
        for (file, bytes) in &one {
            assert!(other[file] == *bytes, "{more:?}: {file} differs");
        }
    }
}

/// Answers of tables and of the solver are as independent of the machine as the tables are.
#[test]
fn answers_do_not_depend_on_threads_or_instruction_set() {
    let plain = sample(earth(), &["--exact", "--threads", "1", "--isa", "baseline"]);
    assert_eq!(sample(earth(), &["--exact", "--threads", "2"]), plain);
}
