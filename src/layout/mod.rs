//! Ways to store light: a folder a layout, with its tables, how they are filled, looked up and held against the solver.
//!
//! A new layout is a folder and a line in [`ALL`].

pub mod compact;
pub mod elek2010;
pub mod extinction;
pub mod judge;
pub mod settings;
pub mod shader;
pub mod sky;
pub mod table_data;
pub mod three_atmosphere;
pub mod water;

use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::mapping::Elek2010;
use crate::medium::Medium;
use crate::preset::Planet;
use crate::transport::solve::Solution;
use judge::Truth;
use serde_json::{Map, Value};
use settings::Settings;
use sky::{Sky, Source};
use std::collections::BTreeMap;
use std::fmt;
use table_data::TableData;

/// A way to store a sky.
pub trait Layout: Sync {
    /// As in `bake.json`, as a folder of a bake, and after `--layout`.
    fn name(&self) -> &'static str;

    /// For the help of `--layout`, where the name does not say it.
    fn about(&self) -> Option<&'static str> {
        None
    }

    /// Raised when the bytes of its files change (see [`crate::bake::versions`]).
    fn version(&self) -> u32;

    /// The medium whose light its tables hold.
    fn medium(&self) -> MediumKind;

    /// Whether it can hold a part of altitudes, suns and views.
    fn has_windows(&self) -> bool {
        true
    }

    /// Parameterisations of its tables over altitude.
    fn mappings(&self, medium: &Medium, settings: &Settings) -> Vec<Elek2010>;

    /// Texels of its tables over four axes: what they take in memory.
    fn texels(&self, medium: &Medium, settings: &Settings) -> usize;

    /// Fills its tables. Errors: settings that it cannot be filled by.
    fn fill(&self, from: &Ingredients) -> Result<Filled>;

    /// Look-ups in its tables. Errors: `File` for tables that are none of it.
    fn open(&self, source: &Source) -> Result<Box<dyn Sky>>;

    /// Key of the quality report under which its tables stand against the truth of their own medium, by region.
    fn report_key(&self) -> &'static str;

    /// Errors of its tables against the truth of their own medium, by region.
    fn judge(&self, sky: &dyn Sky, palette: &ColourWeights, truths: &[Truth]) -> Value;

    /// What a user can do where its tables miss the day.
    fn remedy(&self) -> &'static str;
}

/// All layouts, in the order of reports: the most exact first.
pub static ALL: [&dyn Layout; 3] =
    [&compact::CompactLayout, &elek2010::Elek2010Layout, &three_atmosphere::ThreeAtmosphereLayout];

/// The layout of a name.
pub fn named(name: &str) -> Option<&'static dyn Layout> {
    ALL.into_iter().find(|layout| layout.name() == name)
}

/// Layouts are one where their names are.
impl PartialEq for dyn Layout {
    fn eq(&self, other: &dyn Layout) -> bool {
        self.name() == other.name()
    }
}

impl Eq for dyn Layout {}

impl fmt::Debug for dyn Layout {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// A medium that light is solved in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MediumKind {
    /// As the preset states it.
    Full,
    /// The paper's simplification of it, in which aerosols scatter isotropically.
    Paper,
}

/// What tables are filled from.
pub struct Ingredients<'a> {
    pub planet: &'a Planet,
    pub settings: &'a Settings,
    /// As the preset states it.
    pub full: &'a Medium,
    pub paper: &'a Medium,
    /// The light in the layout's own medium.
    pub solution: &'a Solution,
    pub palette: &'a ColourWeights,
}

/// A layout's tables, and what goes with them.
#[derive(Default)]
pub struct Filled {
    pub tables: Vec<TableData>,
    /// What was odd about them, for the quality report.
    pub counts: Map<String, Value>,
    /// For the manifest.
    pub constants: BTreeMap<String, Vec<f64>>,
    /// Path, what it is, content.
    pub files: Vec<(String, String, Vec<u8>)>,
}
