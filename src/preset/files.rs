//! Which files on disk a preset is read from, for those who bake again when one of them changes.

use super::{PresetKind, changed, find, is_shipped, library, shipped_water_names};
use crate::error::Result;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The JSON file of a planet and the CSV files that it names; of a shipped one those that `set` brings in. The
/// planet is one that [`super::load`] takes.
///
/// # Errors
/// As [`super::load`].
pub fn planet_files(name_or_path: &str, set: &[String]) -> Result<Vec<PathBuf>> {
    let (file, text) = find(name_or_path, PresetKind::Planet)?;
    files(&file, &changed(&file, &text, set)?, !is_shipped(name_or_path))
}

/// The same of a water.
///
/// # Errors
/// As [`super::load_water`].
pub fn water_files(name_or_path: &str) -> Result<Vec<PathBuf>> {
    let (file, text) = find(name_or_path, PresetKind::Water)?;
    let shipped = shipped_water_names().any(|name| name == name_or_path);
    files(&file, &changed(&file, &text, &[])?, !shipped)
}

fn files(file: &str, value: &Value, on_disk: bool) -> Result<Vec<PathBuf>> {
    let mut found: Vec<PathBuf> = on_disk.then(|| Path::new(file).to_path_buf()).into_iter().collect();
    collect(value, file, &mut found);
    Ok(found)
}

/// Every text that is a spectrum on disk; what stands under `source`, `description` and the like is prose.
fn collect(value: &Value, beside: &str, found: &mut Vec<PathBuf>) {
    const PROSE: [&str; 4] = ["source", "description", "name", "$schema"];
    match value {
        Value::String(text) => found.extend(library::spectrum_path(text, beside)),
        Value::Array(list) => list.iter().for_each(|item| collect(item, beside, found)),
        Value::Object(map) => map
            .iter()
            .filter(|(key, _)| !PROSE.contains(&key.as_str()))
            .for_each(|(_, item)| collect(item, beside, found)),
        _ => {}
    }
}
