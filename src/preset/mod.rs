//! Presets: from a JSON file, shipped or the user's own, to a validated planet in SI.
//!
//! Two types and one border. `raw` is the file as written: any JSON, with the path of every value for error
//! messages. [`Planet`] is what the rest of the program sees: every number checked, in SI, named spectra looked
//! up. The modules `read_*` are the border, and the only place that knows the units of files.

mod bounds;
mod coefficient;
mod files;
mod fournier_forand;
mod json;
mod library;
mod lost;
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
pub use library::{
    parse as read_spectrum, shipped, shipped_names, shipped_scenes, shipped_water_names, shipped_waters,
};
pub use phase::{KingFactor, PhaseLaw, Stated};
pub use planet::{Optics, Planet, Star, Substance};
pub use rayleigh::{AIR_NUMBER_DENSITY, air_cross_section, air_king_factor, air_refractivity};
pub use scene::{Budget, Metric, Scene, SceneWater, Tolerance};
pub use water::{Water, WaterLaw, WaterSubstance};

use crate::error::{Error, Result};
use crate::input::{self, MOST_JSON};
use raw::Raw;
use std::path::Path;

/// A planet by the name of a shipped preset (`earth`) or by the path of a JSON file, with `path.to.key=value`
/// overrides applied to the JSON before it is read (see `overrides.rs`).
///
/// Errors name the file, the key's path, the value and the reason; an unknown name brings the nearest one.
pub fn load(name_or_path: &str, set: &[String]) -> Result<Planet> {
    let (file, text) = find(name_or_path)?;
    read(&file, &text, set)
}

/// A water by the name of a shipped preset (`clear-ocean`) or by the path of a JSON file; as [`load`].
pub fn load_water(name_or_path: &str, set: &[String]) -> Result<Water> {
    let (file, text) = find_water(name_or_path)?;
    read_water(&file, &text, set)
}

/// A scene by the name of a shipped one (`walk`) or by the path of a JSON file; as [`load`].
pub fn load_scene(name_or_path: &str) -> Result<Scene> {
    let (file, text) = match library::scene(name_or_path) {
        Some((file, text)) => (file, text.to_string()),
        None => {
            let names = library::shipped_scenes().into_iter().map(|s| s.0).collect();
            find_file(name_or_path, "scene", names)?
        }
    };
    read_scene(&file, &text)
}

/// A scene from JSON text; `file` is for messages only.
pub fn read_scene(file: &str, text: &str) -> Result<Scene> {
    read_scene::scene(&Raw::root(file, &json::parse(file, text)?))
}

/// Whether a name or path means a water and not a planet: a shipped water, or a file with its mark.
pub fn is_water(name_or_path: &str) -> bool {
    if shipped_water_names().any(|shipped| shipped == name_or_path) {
        return true;
    }
    if is_shipped(name_or_path) {
        return false;
    }
    // A pipe is read once, for what it is asked for: a planet.
    let text = input::named_text(Path::new(name_or_path), MOST_JSON);
    let value = text.ok().and_then(|t| serde_json::from_str::<serde_json::Value>(&t).ok());
    value.is_some_and(|v| v.get(read_water::MARK).is_some())
}

/// Whether `name` is that of a shipped preset, which [`load`] then takes, and not the path of a file.
pub fn is_shipped(name: &str) -> bool {
    shipped_names().any(|shipped| shipped == name)
}

/// A planet from JSON text; `file` names it in errors and is the folder's origin for its spectra.
pub fn read(file: &str, text: &str, set: &[String]) -> Result<Planet> {
    let value = changed(file, text, set)?;
    let root = Raw::root(file, &value);
    root.check_sources()?;
    read_planet::planet(&root)
}

/// A water from JSON text, as [`read`].
pub fn read_water(file: &str, text: &str, set: &[String]) -> Result<Water> {
    let value = changed(file, text, set)?;
    let root = Raw::root(file, &value);
    root.check_sources()?;
    read_water::water(&root)
}

fn changed(file: &str, text: &str, set: &[String]) -> Result<serde_json::Value> {
    let mut value = json::parse(file, text)?;
    for assignment in set {
        overrides::apply(&mut value, file, assignment)?;
    }
    Ok(value)
}

/// A file and its text; the nearest of the names where it is neither a path nor one of them.
fn find_file(name_or_path: &str, what: &str, names: Vec<&str>) -> Result<(String, String)> {
    let path = Path::new(name_or_path);
    if path.extension().is_some() || path.components().count() > 1 {
        let text = input::text(path, MOST_JSON)?;
        return Ok((name_or_path.to_string(), text));
    }
    let nearest = raw::nearest(name_or_path, names);
    Err(Error::Argument(format!(
        "no {what} is called `{name_or_path}`; the nearest is `{nearest}` (a path to a .json file works too)"
    )))
}

fn find_water(name_or_path: &str) -> Result<(String, String)> {
    if let Some((file, text)) = library::water(name_or_path) {
        return Ok((file, text.to_string()));
    }
    let path = Path::new(name_or_path);
    if path.extension().is_some() || path.components().count() > 1 {
        let text = input::text(path, MOST_JSON)?;
        return Ok((name_or_path.to_string(), text));
    }
    let nearest = raw::nearest(name_or_path, shipped_water_names());
    Err(Error::Argument(format!(
        "no water is called `{name_or_path}`; the nearest is `{nearest}` (a path to a .json file works too)"
    )))
}

/// File name for messages, and the text.
fn find(name_or_path: &str) -> Result<(String, String)> {
    if let Some((file, text)) = library::planet(name_or_path) {
        return Ok((file, text.to_string()));
    }
    let path = Path::new(name_or_path);
    if path.extension().is_some() || path.components().count() > 1 {
        let text = input::text(path, MOST_JSON)?;
        return Ok((name_or_path.to_string(), text));
    }
    let nearest = raw::nearest(name_or_path, shipped_names());
    Err(Error::Argument(format!(
        "no preset is called `{name_or_path}`; the nearest is `{nearest}` (a path to a .json file works too)"
    )))
}
