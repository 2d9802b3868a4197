//! What kind of preset a file is, so that one that is given in another's place is called by its name.

use super::find::kind_of_shipped;
use super::json;
use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::bounded_read::MOST_JSON;
use serde_json::Value;
use std::path::Path;

/// Kinds of JSON files that this tool reads or writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PresetKind {
    Planet,
    Water,
    Scene,
    /// The manifest of a bake.
    Bake,
}

impl PresetKind {
    pub const ALL: [PresetKind; 4] =
        [PresetKind::Planet, PresetKind::Water, PresetKind::Scene, PresetKind::Bake];

    /// Keys of the whole file that no other kind has.
    fn marks(self) -> &'static [&'static str] {
        match self {
            PresetKind::Planet => &["ground", "top", "star"],
            PresetKind::Water => &["pure_water", "seabed", "refractive_index", "largest_depth_m"],
            PresetKind::Scene => &["planet", "observer", "sun", "view", "tolerance", "budget"],
            PresetKind::Bake => &["schema_version", "tool", "tables", "quality", "files"],
        }
    }

    /// With its article.
    pub fn name(self) -> &'static str {
        match self {
            PresetKind::Planet => "a planet",
            PresetKind::Water => "a water",
            PresetKind::Scene => "a scene",
            PresetKind::Bake => "the manifest of a bake",
        }
    }

    /// Which command takes one of these.
    pub fn taken_by(self, name: &str) -> String {
        match self {
            PresetKind::Planet => format!("`tyndall bake {name}` takes it"),
            PresetKind::Water => format!("`tyndall bake PLANET --waters {name}` takes it"),
            PresetKind::Scene => format!("`tyndall plan {name}` takes it"),
            PresetKind::Bake => "`tyndall sample` and `verify` take its folder".into(),
        }
    }
}

/// The kind of which a file has the most marks; none where it has no mark, or as many of two kinds.
fn of(value: &Value) -> Option<PresetKind> {
    let best = PresetKind::ALL.into_iter().max_by_key(|&kind| marks(value, kind))?;
    let most = marks(value, best);
    let rivals = PresetKind::ALL.into_iter().filter(|&kind| marks(value, kind) == most).count();
    (most > 0 && rivals == 1).then_some(best)
}

fn marks(value: &Value, kind: PresetKind) -> usize {
    kind.marks().iter().filter(|key| value.get(**key).is_some()).count()
}

/// Refuses a file that is of another kind: it has marks of that one and none of the kind that is wanted.
///
/// # Errors
/// `Argument`: nothing in the file is wrong.
pub(super) fn refuse_other(file: &str, value: &Value, wanted: PresetKind) -> Result<()> {
    match of(value) {
        Some(other) if marks(value, wanted) == 0 && marks(value, other) > 1 => {
            let taken_by = other.taken_by(file);
            Err(Error::Argument(format!("{file} is {}, not {}: {taken_by}", other.name(), wanted.name())))
        }
        _ => Ok(()),
    }
}

/// The kind of a shipped preset, or that of a file by its keys; none for what cannot be read or has no marks.
pub fn kind(name_or_path: &str) -> Option<PresetKind> {
    if let Some(kind) = kind_of_shipped(name_or_path) {
        return Some(kind);
    }
    // A pipe is read once, for what it is asked for.
    let text = bounded_read::named_text(Path::new(name_or_path), MOST_JSON).ok()?;
    of(&json::parse(name_or_path, &text).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// A file with a slip in a key keeps its kind, and is left to the reader that names the slip.
    #[test]
    fn kinds_are_told_by_their_keys() {
        let slip = json!({"pure_watr": {}, "seabed": {}, "largest_depth_m": 3});
        assert_eq!(of(&slip), Some(PresetKind::Water));
        assert!(refuse_other("a", &slip, PresetKind::Water).is_ok());
        let error = refuse_other("a", &slip, PresetKind::Planet).unwrap_err().to_string();
        assert!(error.contains("a is a water, not a planet"), "{error}");
        assert_eq!(of(&json!({"name": "x"})), None);
        assert_eq!(of(&json!([1])), None);
        assert!(refuse_other("a", &json!({"sun": {}}), PresetKind::Planet).is_ok());
    }
}
