//! The rooms of `src`: which may know which. A room is a folder or file right under `src`; what it knows is what its
//! `use` declarations and paths name, its unit tests aside.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// A room a line, lowest first, with the rooms that it knows. Every name on the right stands further up on the left, so
/// that the list itself excludes circles.
const ROOMS: &str = "
error:
machine:    error
math:
geometry:   math
spectrum:   error
medium:     error
mapping:    machine
transport:  geometry machine math medium
algorithm1: error geometry machine mapping medium
reference:  geometry medium
files:      error geometry machine spectrum
preset:     error files medium spectrum
quality:    geometry mapping
colour:     error files machine mapping medium quality spectrum transport
layout:     algorithm1 colour error files geometry machine mapping medium preset quality spectrum transport
bake:       colour error files geometry layout machine mapping medium preset quality spectrum transport
methods:    algorithm1 bake error files geometry layout machine mapping medium preset spectrum transport
plan:       bake colour error geometry layout mapping medium preset quality spectrum transport
chart:      algorithm1 bake error files geometry layout machine medium methods preset quality reference spectrum transport
commands:   algorithm1 bake chart colour error files geometry layout machine mapping medium methods plan preset quality reference spectrum transport
";

/// Each room with those that it knows.
fn rooms() -> impl Iterator<Item = (&'static str, Vec<&'static str>)> {
    let lines = ROOMS.lines().filter_map(|line| line.split_once(':'));
    lines.map(|(room, known)| (room, known.split_whitespace().collect()))
}

/// What look-ups know: no solver and no preset. (Which layouts there are, they ask `layout`, whose list knows more.)
const LOOK_UPS_KNOW: &[&str] = &["error", "files", "geometry", "layout", "mapping", "medium", "spectrum"];

/// Whether a file looks tables up, and knows no solver.
fn looks_up(inside: &Path) -> bool {
    inside.ends_with("lookup.rs")
        || ["layout/sky", "layout/shader"].iter().any(|folder| inside.starts_with(folder))
}

/// Files of the library under a folder; the two programs are none.
fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        match path.is_dir() {
            true if name == "bin" => {}
            true => sources(&path, found),
            false if name.ends_with(".rs") && name != "main.rs" && name != "lib.rs" => found.push(path),
            false => {}
        }
    }
}

/// A source without comments and strings, so that braces and paths in it are code.
fn code(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skip = match c {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '\'' if rest.starts_with("'\\") => rest[2..].find('\'').map_or(1, |end| end + 3),
            '\'' if rest[1..].chars().nth(1) == Some('\'') => {
                2 + rest[1..].chars().next().unwrap().len_utf8()
            }
            '"' => quoted(rest),
            _ => {
                out.push(c);
                c.len_utf8()
            }
        };
        rest = &rest[skip..];
    }
    out
}

/// Length of a string literal with both quotes.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    for (at, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return at + 1,
            '\\' => escaped = !escaped,
            _ => escaped = false,
        }
    }
    text.len()
}

/// Without what stands behind `#[cfg(test)]`, which ends a file.
fn without_tests(code: &str) -> &str {
    code.split("#[cfg(test)]\nmod tests {").next().unwrap()
}

/// First names of all paths that begin with `head::`, groups in braces included.
fn named<'a>(code: &'a str, head: &str) -> Vec<&'a str> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = Vec::new();
    for (at, _) in code.match_indices(head) {
        if code[..at].ends_with(|c| is_name(c) || c == ':') {
            continue;
        }
        let rest = &code[at + head.len()..];
        match rest.strip_prefix('{') {
            Some(group) => {
                // Names at depth 0 of the group.
                let (mut depth, mut fresh) = (0usize, true);
                for (k, c) in group.char_indices() {
                    match c {
                        '}' if depth == 0 => break,
                        '{' => depth += 1,
                        '}' => depth -= 1,
                        ',' if depth == 0 => fresh = true,
                        c if fresh && is_name(c) => {
                            out.push(group[k..].split(|c| !is_name(c)).next().unwrap());
                            fresh = false;
                        }
                        _ => {}
                    }
                }
            }
            None => out.push(rest.split(|c| !is_name(c)).next().unwrap()),
        }
    }
    out
}

/// `super::` out of a room, as often as the file is deep in it: the way to other rooms that does not name the crate.
fn reaches_out(code: &str, depth: usize) -> bool {
    code.contains(&"super::".repeat(depth + 1))
}

#[test]
fn rooms_know_only_rooms_below() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let allowed: BTreeMap<&str, Vec<&str>> = rooms().collect();
    assert!(allowed.len() > 15, "only {} rooms found", allowed.len());
    let mut files = Vec::new();
    sources(&src, &mut files);
    assert!(files.len() > 200, "only {} files found", files.len());
    let (mut wrong, mut used) = (Vec::new(), BTreeSet::new());
    for file in files {
        let inside = file.strip_prefix(&src).unwrap();
        let parts: Vec<&str> = inside.iter().map(|p| p.to_str().unwrap().trim_end_matches(".rs")).collect();
        let room = parts[0];
        let text = code(&fs::read_to_string(&file).unwrap());
        let text = without_tests(&text);
        let depth = parts.len() - usize::from(parts.last() == Some(&"mod"));
        if reaches_out(text, depth.saturating_sub(1)) {
            wrong.push(format!("{}: leaves its room by `super::`: write `crate::`", inside.display()));
        }
        let Some(known) = allowed.get(room) else {
            wrong.push(format!("{}: the room `{room}` is not in the list", inside.display()));
            continue;
        };
        for name in named(text, "crate::") {
            // What begins with a capital letter is re-exported by lib.rs: the error.
            let other = if name.starts_with(char::is_uppercase) { "error" } else { name };
            if other == room || !allowed.contains_key(other) {
                continue;
            }
            used.insert((room.to_owned(), other.to_owned()));
            if looks_up(inside) && !LOOK_UPS_KNOW.contains(&other) {
                wrong.push(format!("{}: a look-up may not know `{other}`", inside.display()));
            }
            if !known.contains(&other) {
                wrong.push(format!("{}: `{room}` may not know `{other}`", inside.display()));
            }
        }
    }
    for (room, known) in rooms() {
        for other in known.into_iter().filter(|o| !used.contains(&(room.to_owned(), (*o).to_owned()))) {
            wrong.push(format!("`{room}` does not use `{other}` any more: take it from the list"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_list_has_no_circles() {
    let mut lower = BTreeSet::new();
    for (room, known) in rooms() {
        for other in known {
            assert!(lower.contains(other), "`{room}` knows `{other}`, which is not below it");
        }
        lower.insert(room);
    }
}

/// Errors are one type, with what a user needs to mend them: no text alone.
#[test]
fn errors_are_one_type() {
    let mut files = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"), &mut files);
    for file in files {
        let text = code(&fs::read_to_string(&file).unwrap());
        assert!(!answers_with_text(without_tests(&text)), "{}: Result<…, String>", file.display());
    }
    assert!(answers_with_text("fn f() -> Result<[f64; 2], String> {"));
    assert!(answers_with_text("type Read<T> = std::result::Result<(Vec<T>, u8),\n    String,\n>;"));
    assert!(!answers_with_text("fn f() -> Result<BTreeMap<String, String>>, g: Vec<(u8, String)>"));
}

/// Whether a `Result` has text for its error.
fn answers_with_text(code: &str) -> bool {
    code.match_indices("Result<").any(|(at, head)| {
        let (mut depth, mut last) = (1, String::new());
        for c in code[at + head.len()..].chars() {
            match c {
                '<' | '(' | '[' => depth += 1,
                '>' | ')' | ']' => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                break;
            }
            last.push(c);
            // What stands behind a comma outside brackets; a comma after the last argument is none.
            if c == ',' && depth == 1 {
                last.push('\0');
            }
        }
        let arguments = last.split(",\0").map(str::trim).filter(|argument| !argument.is_empty());
        arguments.skip(1).last().is_some_and(|error| matches!(error, "String" | "&'static str"))
    })
}

/// The reader sees groups, nested ones too, and neither comments nor strings.
#[test]
fn paths_are_found() {
    let text =
        code("use crate::{a::b, c::{d, e}, f}; // crate::g\nlet x = \"crate::h\"; crate::i::j('{', '\\'');");
    assert_eq!(named(&text, "crate::"), ["a", "c", "f", "i"]);
    assert!(reaches_out("super::super::x", 1) && !reaches_out("super::x", 1));
}
