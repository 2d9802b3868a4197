//! From a name or a path to a file's text; a name that nobody knows brings what was meant.

use super::kind::PresetKind;
use super::library::{self, shipped_names, shipped_water_names};
use super::names;
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::bounded_read::MOST_JSON;
use std::path::Path;

/// Layouts, which are taken for presets where a comma is missing in a list of them.
const LAYOUTS: [&str; 3] = ["compact", "elek2010", "three-atmosphere"];

/// File name for messages, and the text.
///
/// # Errors
/// `Argument` for an unknown name, `File` for a file that cannot be read.
pub(super) fn find(name_or_path: &str, wanted: PresetKind) -> Result<(String, String)> {
    let shipped = match wanted {
        PresetKind::Planet => library::planet(name_or_path),
        PresetKind::Water => library::water(name_or_path),
        PresetKind::Scene => library::scene(name_or_path),
        PresetKind::Bake => None,
    };
    if let Some((file, text)) = shipped {
        return Ok((file, text.to_string()));
    }
    if is_path(name_or_path) {
        return Ok((name_or_path.to_string(), bounded_read::text(Path::new(name_or_path), MOST_JSON)?));
    }
    Err(unknown(name_or_path, wanted))
}

/// Refuses a name of a planet that nobody knows and a path at which nothing is, without reading anything.
///
/// # Errors
/// `Argument` for an unknown name, `File` for a path at which nothing can be read.
pub fn check_known(name_or_path: &str) -> Result<()> {
    if library::planet(name_or_path).is_some() {
        return Ok(());
    }
    if !is_path(name_or_path) {
        return Err(unknown(name_or_path, PresetKind::Planet));
    }
    let path = Path::new(name_or_path);
    std::fs::metadata(path).map(drop).map_err(|e| Error::reading(path, e))
}

fn is_path(text: &str) -> bool {
    let path = Path::new(text);
    path.extension().is_some() || path.components().count() > 1
}

/// Names of what is shipped of a kind.
fn shipped(kind: PresetKind) -> Vec<&'static str> {
    match kind {
        PresetKind::Planet => shipped_names().collect(),
        PresetKind::Water => shipped_water_names().collect(),
        PresetKind::Scene => library::scene_names().collect(),
        PresetKind::Bake => Vec::new(),
    }
}

/// The kind of a shipped preset of this name.
pub(super) fn kind_of_shipped(name: &str) -> Option<PresetKind> {
    PresetKind::ALL.into_iter().find(|&kind| shipped(kind).contains(&name))
}

fn unknown(name: &str, wanted: PresetKind) -> Error {
    let what = match wanted {
        PresetKind::Planet => "preset",
        PresetKind::Water => "water",
        PresetKind::Scene => "scene",
        PresetKind::Bake => "bake",
    };
    let another = |is: &str, use_it: String| {
        let kind = if wanted == PresetKind::Planet { "a planet" } else { wanted.name() };
        Error::Argument(format!("`{name}` is {is}, not {kind}: {use_it}"))
    };
    if let Some(kind) = kind_of_shipped(name) {
        return another(kind.name(), kind.taken_by(name));
    }
    if LAYOUTS.contains(&name) {
        return another("a layout", format!("`tyndall bake PLANET --layout {name}` writes it"));
    }
    if library::spectrum_names().any(|spectrum| spectrum == name) {
        return another("a spectrum", "a preset names it where a spectrum is wanted".into());
    }
    let meant = match names::nearest(name, shipped(wanted)) {
        Some(near) => format!("the nearest is `{near}`"),
        None => {
            of_another_kind(name).unwrap_or_else(|| format!("shipped are {}", shipped(wanted).join(", ")))
        }
    };
    Error::Argument(format!("no {what} is called `{name}`; {meant} (a path to a .json file works too)"))
}

/// A name of another kind with a slip in it.
fn of_another_kind(name: &str) -> Option<String> {
    let near = |kind: PresetKind| Some((names::nearest(name, shipped(kind))?, kind));
    let (near, kind) = PresetKind::ALL.into_iter().find_map(near)?;
    Some(format!("the nearest is `{near}`, {}: {}", kind.name(), kind.taken_by(near)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every layout is known by its name where it is given as a preset.
    #[test]
    fn no_layout_is_left_out() {
        let all = crate::layout::ALL.map(|layout| layout.name());
        assert_eq!(all, LAYOUTS);
    }

    /// What is given in the place of another kind is called by its own; a slip in such a name too.
    #[test]
    fn names_of_other_kinds_are_told() {
        let told = |name: &str, wanted| unknown(name, wanted).to_string();
        for (name, wanted, is) in [
            (
                "clear-ocean",
                PresetKind::Planet,
                "`clear-ocean` is a water, not a planet: `tyndall bake PLANET --waters",
            ),
            (
                "compact",
                PresetKind::Planet,
                "`compact` is a layout, not a planet: `tyndall bake PLANET --layout",
            ),
            ("walk", PresetKind::Planet, "`walk` is a scene, not a planet: `tyndall plan walk`"),
            ("earth", PresetKind::Water, "`earth` is a planet, not a water: `tyndall bake earth`"),
            ("earth", PresetKind::Scene, "`earth` is a planet, not a scene"),
            ("muddy", PresetKind::Scene, "`muddy` is a water, not a scene"),
            ("sun-tsis1-hsrs", PresetKind::Planet, "`sun-tsis1-hsrs` is a spectrum, not a planet"),
            ("clear-ocaen", PresetKind::Planet, "the nearest is `clear-ocean`, a water"),
            ("erth", PresetKind::Planet, "no preset is called `erth`; the nearest is `earth` ("),
            ("neptune", PresetKind::Planet, "no preset is called `neptune`; shipped are earth, "),
        ] {
            let text = told(name, wanted);
            assert!(text.contains(is), "{name}: {text}");
        }
    }
}
