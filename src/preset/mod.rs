//! Presets: from a JSON file, shipped or the user's own, to a validated planet in SI.
//!
//! Two types and one border. `raw` is the file as written: any JSON, with the path of every value for error
//! messages. [`Planet`] is what the rest of the program sees: every number checked, in SI, named spectra looked
//! up. The modules `read_*` are the border, and the only place that knows the units of files.

mod bounds;
mod coefficient;
mod files;
mod find;
mod fournier_forand;
mod json;
mod kind;
mod library;
mod lost;
pub mod names;
mod overrides;
mod phase;
mod planet;
mod raw;
mod rayleigh;
mod read_coefficient;
mod read_constituent;
mod read_phase;
mod read_planet;
mod read_profile;
mod read_scene;
mod read_spectrum;
mod read_water;
mod scene;
pub mod schema;
mod water;

pub use coefficient::Coefficient;
pub use files::{planet_files, water_files};
pub use find::check_known;
pub use kind::{PresetKind, kind};
pub use library::{
    parse as read_spectrum, shipped, shipped_names, shipped_scenes, shipped_water_names, shipped_waters,
};
pub use phase::{AsymmetryParameter, KingFactor, PhaseLaw};
pub use planet::{Optics, Planet, Star, Substance};
pub use rayleigh::{AIR_NUMBER_DENSITY, air_cross_section, air_king_factor, air_refractivity};
pub use scene::{Budget, Metric, Scene, SceneWater, Tolerance};
pub use water::{Water, WaterLaw, WaterSubstance};

use crate::error::Result;
use find::find;
use kind::refuse_other;
use raw::Raw;

/// A planet by the name of a shipped preset (`earth`) or by the path of a JSON file, with `path.to.key=value`
/// overrides applied to the JSON before it is read (see `overrides.rs`).
///
/// Errors name the file, the key's path, the value and the reason; an unknown name brings the nearest one.
pub fn load(name_or_path: &str, set: &[String]) -> Result<Planet> {
    let (file, text) = find(name_or_path, PresetKind::Planet)?;
    read(&file, &text, set)
}

/// A water by the name of a shipped preset (`clear-ocean`) or by the path of a JSON file; as [`load`].
pub fn load_water(name_or_path: &str, set: &[String]) -> Result<Water> {
    let (file, text) = find(name_or_path, PresetKind::Water)?;
    read_water(&file, &text, set)
}

/// A scene by the name of a shipped one (`walk`) or by the path of a JSON file; as [`load`].
pub fn load_scene(name_or_path: &str) -> Result<Scene> {
    let (file, text) = find(name_or_path, PresetKind::Scene)?;
    read_scene(&file, &text)
}

/// A scene from JSON text; `file` is for messages only.
pub fn read_scene(file: &str, text: &str) -> Result<Scene> {
    let value = json::parse(file, text)?;
    refuse_other(file, &value, PresetKind::Scene)?;
    read_scene::scene(&Raw::root(file, &value))
}

/// Whether a name or path means a water and not a planet: a shipped water, or a file with its mark.
pub fn is_water(name_or_path: &str) -> bool {
    kind(name_or_path) == Some(PresetKind::Water)
}

/// Whether `name` is that of a shipped preset, which [`load`] then takes, and not the path of a file.
pub fn is_shipped(name: &str) -> bool {
    shipped_names().any(|shipped| shipped == name)
}

/// A planet from JSON text; `file` names it in errors and is the folder's origin for its spectra.
pub fn read(file: &str, text: &str, set: &[String]) -> Result<Planet> {
    let value = changed(file, text, set)?;
    refuse_other(file, &value, PresetKind::Planet)?;
    let root = Raw::root(file, &value);
    // Before the sources: a number under a key that nobody knows is a slip in the key, whatever its source.
    let planet = read_planet::planet(&root)?;
    root.check_sources()?;
    Ok(planet)
}

/// A water from JSON text, as [`read`].
pub fn read_water(file: &str, text: &str, set: &[String]) -> Result<Water> {
    let value = changed(file, text, set)?;
    refuse_other(file, &value, PresetKind::Water)?;
    let root = Raw::root(file, &value);
    // Before the sources: a number under a key that nobody knows is a slip in the key, whatever its source.
    let water = read_water::water(&root)?;
    root.check_sources()?;
    Ok(water)
}

fn changed(file: &str, text: &str, set: &[String]) -> Result<serde_json::Value> {
    let mut value = json::parse(file, text)?;
    for assignment in set {
        overrides::apply(&mut value, file, assignment)?;
    }
    Ok(value)
}
