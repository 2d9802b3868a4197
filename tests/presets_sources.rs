//! Every constant under `presets/` says where it comes from, and the reader lets none in that does not.

use serde_json::{Map, Value, json};
use std::fs;
use std::path::PathBuf;
use tyndall::internals::preset;

/// The files of a folder of presets.
fn files(folder: &str) -> Vec<PathBuf> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("presets").join(folder);
    let mut list: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|e| e.unwrap().path()).collect();
    list.sort();
    assert!(list.len() >= 5, "{list:?}");
    list
}

/// True of a number, and of a list that holds one at any depth.
fn numeric(value: &Value) -> bool {
    value.is_number() || value.as_array().is_some_and(|list| list.iter().any(numeric))
}

/// Calls `visit` with the place (as a JSON pointer) and content of every object that holds a number.
fn objects(value: &Value, place: &str, visit: &mut dyn FnMut(&str, &Map<String, Value>)) {
    match value {
        Value::Object(map) => {
            if map.values().any(numeric) {
                visit(place, map);
            }
            map.iter().for_each(|(k, v)| objects(v, &format!("{place}/{k}"), visit));
        }
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(k, v)| objects(v, &format!("{place}/{k}"), visit));
        }
        _ => {}
    }
}

/// A citation names a year (or a data sheet that is kept up to date), or it is a choice of this project with its
/// reason; "see above" is neither.
fn cites(source: &str) -> bool {
    let reason = source.split_once("project choice: ").is_some_and(|(_, why)| why.len() > 5);
    let year = |word: &str| {
        let digits: String = word.chars().filter(char::is_ascii_digit).collect();
        digits.len() == 4 && (digits.starts_with("19") || digits.starts_with("20"))
    };
    let words = source.split(|c: char| c.is_whitespace() || ",;:()/-".contains(c));
    reason || source.contains("Fact Sheet") || words.into_iter().any(year)
}

/// Each object with numbers has a source that is one; without it the reader refuses the file and says so.
#[test]
fn every_number_of_every_preset() {
    let mut seen = 0;
    for folder in ["planets", "waters"] {
        for path in files(folder) {
            let whole: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
            let mut places = Vec::new();
            objects(&whole, "", &mut |place, map| {
                let source = map.get("source").and_then(Value::as_str).unwrap_or_default();
                assert!(cites(source), "{path:?} {place}: source `{source}`");
                places.push(place.to_string());
            });
            assert!(places.len() >= 2, "{path:?}: {places:?}");
            for place in places {
                for bad in [None, Some(json!("")), Some(json!(" \t")), Some(json!(1999))] {
                    let mut changed = whole.clone();
                    let object = changed.pointer_mut(&place).unwrap().as_object_mut().unwrap();
                    object.shift_remove("source");
                    object.extend(bad.clone().map(|b| ("source".to_string(), b)));
                    let text = changed.to_string();
                    let error = match folder {
                        "planets" => preset::read("p.json", &text, &[]).unwrap_err(),
                        _ => preset::read_water("p.json", &text, &[]).unwrap_err(),
                    };
                    let line = error.to_string();
                    assert_eq!(error.exit_code(), 2);
                    assert!(
                        line.contains("source") && line.starts_with("p.json: "),
                        "{path:?} {place} {bad:?}: {line}"
                    );
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 500, "{seen}");
}

/// Every table of numbers says above its header where it comes from; the reader's refusal of one that does not is
/// tried beside it, in `library.rs`.
#[test]
fn every_spectrum() {
    for path in files("spectra") {
        let text = fs::read_to_string(&path).unwrap();
        let header = text.lines().position(|line| line.starts_with("wavelength_nm,")).unwrap();
        let sources: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("# source: ")).collect();
        assert!(sources.len() == 1 && sources.iter().all(|s| cites(s)), "{path:?}: {sources:?}");
        assert!(text.lines().take(header).all(|line| line.starts_with('#')), "{path:?}");
    }
}
