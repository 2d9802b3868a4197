//! What a bake is made from: as it would be made now, and as a manifest says that it was made. Where the two are
//! equal, so are the bytes.

use super::versions;
use crate::files::changes::{Change, changes};
use crate::files::manifest::{Manifest, Tool};
use crate::layout::settings::Settings;
use crate::preset::Planet;
use serde_json::{Map, Value, json};

/// Tool, preset, waters, settings, wavelengths and colour of a bake that is asked for.
pub fn asked(planet: &Planet, settings: &Settings) -> Value {
    let waters = settings.waters.list.iter().map(|w| (w.name.clone(), w.resolved()));
    joined(
        &versions::tool(settings),
        planet.resolved(),
        waters.collect(),
        settings.json(),
        &settings.wavelengths_nm,
        json!({ "space": settings.rgb.space.name(), "white": crate::spectrum::chromaticity(settings.rgb.space.white()) }),
    )
}

/// The same of a bake that was made.
pub fn recorded(manifest: &Manifest) -> Value {
    let waters = manifest.waters.iter().map(|w| (w.name.clone(), w.resolved.clone()));
    joined(
        &manifest.tool,
        manifest.preset.resolved.clone(),
        waters.collect(),
        manifest.settings.clone(),
        &manifest.wavelengths.nm,
        json!({ "space": manifest.colour.space, "white": manifest.colour.white }),
    )
}

/// What differs between two of these. Whether the preset is a shipped one follows from the rest in most cases, and
/// is told only where it is all that differs.
pub fn differences(old: &Value, new: &Value) -> Vec<Change> {
    let mut found = changes(old, new);
    if found.len() > 1 {
        found.retain(|change| change.key != "settings.shipped_preset");
    }
    found
}

fn joined(
    tool: &Tool,
    preset: Value,
    waters: Map<String, Value>,
    settings: Value,
    wavelengths_nm: &[f64],
    colour: Value,
) -> Value {
    json!({
        "tool": tool,
        "preset": preset,
        "waters": waters,
        "settings": settings,
        "wavelengths_nm": wavelengths_nm,
        "colour": colour,
    })
}
