//! JSON Schemas (draft 2020-12) of preset files, for editors and other tools.
//!
//! Kinds, units, bounds and names of shipped spectra are the reader's own constants. Keys are stated a second time
//! here; tests hold both lists together. What a schema cannot say is left to `tyndall presets check`: relations
//! between numbers (lists that rise and are equally long, bottom < top), names given twice, files that are missing,
//! and what formulas make of good numbers.

mod air;
mod coefficient;
mod parts;
mod phase;
mod planet;
#[cfg(test)]
pub mod record;
#[cfg(test)]
mod tests;
mod water;

use super::read_water::MARK;
use parts::definitions;
use serde_json::{Map, Value, json};

/// What a schema describes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Kind {
    Planet,
    Water,
}

/// The schema of one kind of preset, or of both, told apart by the key that only waters have.
pub fn schema(kind: Option<Kind>) -> Value {
    let mut defs = definitions();
    let of = |name: &str| json!({ "$ref": format!("#/$defs/{name}") });
    let (title, root) = match kind {
        Some(Kind::Planet) => ("planet", of("planet")),
        Some(Kind::Water) => ("water", of("water")),
        None => {
            let either = json!({ "if": { "required": [MARK] }, "then": of("water"), "else": of("planet") });
            ("planet or water", either)
        }
    };
    if kind != Some(Kind::Water) {
        planet::define(&mut defs);
    }
    if kind != Some(Kind::Planet) {
        water::define(&mut defs);
    }
    let Value::Object(root) = root else { unreachable!("an object was made") };
    let mut out: Map<String, Value> = Map::new();
    out.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    out.insert("title".into(), json!(format!("tyndall preset: {title}")));
    out.extend(root);
    out.insert("$defs".into(), Value::Object(defs));
    Value::Object(out)
}
