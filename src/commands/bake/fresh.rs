//! Whether the bake that stands in a folder is the one that would be written now, without solving anything.

use super::super::text::print;
use super::super::verify::{Difference, lost_or_changed};
use super::summary::Outcome;
use super::{Args, Done};
use crate::bake::provenance;
use crate::error::{Error, Line, Result};
use crate::files::changes::Change;
use crate::files::manifest::{MANIFEST, Manifest};
use crate::layout::settings::Settings;
use crate::preset::Planet;
use serde_json::json;
use std::path::Path;

/// What in `folder` is not as a bake of `planet` would leave it: what it was made from, and files that are missing or
/// changed. Empty where a bake would write the same bytes. Files that are not the bake's own do not count.
pub(super) fn stale(folder: &Path, planet: &Planet, settings: &Settings) -> Vec<Difference> {
    let manifest = match Manifest::read(folder) {
        Ok(manifest) => manifest,
        Err(_) if !folder.join(MANIFEST).exists() => return vec![difference(MANIFEST, "there is no bake")],
        Err(Error::File { reason, .. }) => return vec![difference(MANIFEST, reason)],
        Err(other) => return vec![difference(MANIFEST, other.to_string())],
    };
    let made_from =
        provenance::differences(&provenance::recorded(&manifest), &provenance::asked(planet, settings));
    let mut found: Vec<Difference> = made_from.iter().map(changed).collect();
    if manifest.manifest_blake3.is_empty() || !manifest.seal_holds() {
        found.push(difference(MANIFEST, "was changed since it was baked (another BLAKE3)"));
    }
    found.extend(lost_or_changed(folder, &manifest));
    found
}

fn changed(change: &Change) -> Difference {
    let text = change.to_string();
    let what = text[change.key.len()..].trim_start_matches(": ").to_string();
    difference(&change.key, what)
}

fn difference(place: &str, what: impl Into<String>) -> Difference {
    Difference { place: place.into(), what: what.into() }
}

/// The bake in `folder` as an outcome, if it is the one asked for.
pub(super) fn current(folder: &Path, planet: &Planet, settings: &Settings) -> Option<Done> {
    if !stale(folder, planet, settings).is_empty() {
        return None;
    }
    let manifest = Manifest::read(folder).ok()?;
    let tables = manifest.tables.iter().flat_map(|t| t.files().map(|f| f.0.as_str()));
    let files: Vec<&str> =
        tables.chain(manifest.files.iter().map(|f| f.file.as_str())).chain([MANIFEST]).collect();
    let size = |file: &&str| std::fs::metadata(folder.join(file)).map(|m| m.len() as usize).ok();
    Some(Done {
        folder: folder.to_path_buf(),
        files: files.len(),
        bytes: files.iter().map(size).sum::<Option<usize>>()?,
        warnings: manifest.warnings,
        quality: manifest.quality.as_object().cloned().unwrap_or_default(),
        stages: Vec::new(),
        need: 0,
        reused: true,
    })
}

/// `--check`: a line for each thing that is stale, or an object of JSON for each preset; nothing is solved.
///
/// # Errors
/// `Check` if a bake is stale; where a preset cannot be read, that error, or how many of several failed.
pub(super) fn check(
    args: &Args,
    all: &[Settings],
    asked: &[String],
    planets: Vec<Result<Planet>>,
) -> Result<()> {
    let (mut out, mut outcomes) = (String::new(), Vec::new());
    for ((asked_name, settings), planet) in asked.iter().zip(all).zip(planets) {
        let (name, result) = match planet {
            Err(error) => (asked_name.clone(), Err(error)),
            Ok(planet) => {
                let found = stale(
                    &args.out.join(&planet.name),
                    &planet,
                    &super::of_preset(args, settings, asked_name),
                );
                (planet.name, Ok(found))
            }
        };
        out.push_str(&told(args, &name, &result));
        let folder = args.out.join(&name);
        let result = match result {
            Err(error) => Err(error),
            Ok(found) if found.is_empty() => Ok(Done::nothing(folder)),
            Ok(_) => Err(Error::Check(format!("{}: the bake is stale", folder.display()))),
        };
        outcomes.push(Outcome { name, result });
    }
    print(&out)?;
    super::summary::failure(outcomes)
}

fn told(args: &Args, name: &str, result: &Result<Vec<Difference>>) -> String {
    let folder = args.out.join(name);
    let folder = folder.display();
    if args.json {
        let answer = match result {
            Ok(found) => {
                let outcome = if found.is_empty() { "current" } else { "stale" };
                json!({ "preset": name, "folder": folder.to_string(), "outcome": outcome, "stale": found })
            }
            Err(e) => json!({ "preset": name, "outcome": "failed", "error": e.to_string() }),
        };
        return format!("{answer}\n");
    }
    match result {
        Ok(found) if found.is_empty() => format!("{folder}: current\n"),
        Ok(found) => found
            .iter()
            .map(|d| format!("{}: {}: {}\n", Line(&folder), Line(&d.place), Line(&d.what)))
            .collect(),
        Err(error) => format!("{name}: failed: {error}\n"),
    }
}
