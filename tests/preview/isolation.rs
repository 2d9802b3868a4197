//! The preview proves that the files are enough: of the library it uses what reads and checks them, nothing that solves.

use std::fs;
use std::path::Path;

/// The paths that follow each `tyndall::` in a source, up to a group in braces.
fn used(source: &str) -> Vec<String> {
    let path = |text: &str| -> String {
        text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect()
    };
    source
        .split("tyndall::internals::")
        .flat_map(|part| part.split("tyndall::"))
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap().split(',').map(path).collect::<Vec<_>>(),
            None => vec![path(rest)],
        })
        .collect()
}

/// What reads bakes: their files, and look-ups, which know no solver (`tests/architecture.rs`).
const READERS: [&str; 8] = [
    "Error",
    "Result",
    "files::",
    "geometry::",
    "machine::output",
    "layout::sky",
    "layout::shader",
    "layout::water::lookup",
];

#[test]
fn no_solver_code_is_used() {
    assert_eq!(
        used(
            "use tyndall::{Error, Result};\nuse tyndall::internals::bake::{self, run};\ntyndall::internals::layout::sky::open()"
        ),
        ["Error", "Result", "bake::", "layout::sky::open"]
    );
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bin/tyndall-preview");
    let mut files = 0;
    for path in fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
        if path.extension().is_none_or(|e| e != "rs") {
            continue;
        }
        files += 1;
        for name in used(&fs::read_to_string(&path).unwrap()) {
            let allowed = READERS.iter().any(|reader| name.starts_with(reader));
            assert!(allowed, "{}: tyndall::{name}", path.display());
        }
    }
    assert!(files > 10, "{files} files");
}
