//! The preview proves that the files are enough: of the library it uses what reads and checks them, nothing that solves.

use std::fs;
use std::path::Path;

/// The names that follow each `tyndall::` in a source.
fn used(source: &str) -> Vec<String> {
    let name =
        |text: &str| text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    source
        .split("tyndall::")
        .skip(1)
        .flat_map(|rest| match rest.strip_prefix('{') {
            Some(list) => list.split('}').next().unwrap().split(',').map(name).collect::<Vec<_>>(),
            None => vec![name(rest)],
        })
        .collect()
}

#[test]
fn no_solver_code_is_used() {
    assert_eq!(used("use tyndall::{Error, Result};\ntyndall::bake::run()"), ["Error", "Result", "bake"]);
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/bin/tyndall-preview");
    let mut files = 0;
    for path in fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()) {
        if path.extension().is_none_or(|e| e != "rs") {
            continue;
        }
        files += 1;
        for name in used(&fs::read_to_string(&path).unwrap()) {
            let allowed =
                ["Error", "Result", "error", "export", "output", "points", "sky"].contains(&name.as_str());
            assert!(allowed, "{}: tyndall::{name}", path.display());
        }
    }
    assert!(files > 10, "{files} files");
}
