//! What baked tables answer, from their files alone: the look-ups that an engine does, in double precision.
//!
//! Knows manifests and decoded pictures, nothing of presets or of the solver.

mod check;
pub(in crate::internals::layout) mod volume;

use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::manifest::{Manifest, Table};
use crate::files::{Atlas, exr};
use crate::geometry::Point;
use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;
use volume::{Plane, Volume};

/// Which part of the light is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Component {
    Total,
    Scattering,
    Ground,
}

/// A phase function to put on aerosol light in place of the table's own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AerosolPhase {
    /// The preset's, from the phase table.
    Preset,
    /// Isotropic: the medium that the paper's layout was solved for.
    Isotropic,
}

/// What the answers of a layout are.
#[derive(Clone, Debug, PartialEq)]
pub enum Channels {
    /// Radiance over solar irradiance, 1/sr, at these wavelengths, nm.
    Wavelengths(Vec<f64>),
    /// Linear RGB: luminance over the star's illuminance, 1/sr.
    Rgb,
}

/// A layout of a bake, ready to answer.
pub trait Sky: Send + Sync {
    fn channels(&self) -> Channels;

    /// What of a view the tables do not hold, as key, value and reason, where they are for a window that it is not in:
    /// there [`Sky::radiance`] answers with the nearest that they do hold.
    fn outside(&self, point: &Point) -> Option<(&'static str, f64, String)>;

    /// The light that arrives at a point of view, one value a channel, 1/sr.
    fn radiance(&self, point: &Point, component: Component, phase: AerosolPhase) -> Vec<f64>;

    /// Sunlight that arrives at an observer in the air, on a plane normal to it, linear RGB over the star's illuminance.
    fn sunlight(&self, altitude: f64, mu_s: f64) -> [f64; 3];

    /// The light of [`Sky::radiance`] as linear RGB over the star's illuminance, 1/sr.
    fn rgb(&self, point: &Point, component: Component) -> [f64; 3];
}

/// Opens one layout of a bake on disk.
///
/// # Errors
/// `File` for a missing, truncated or foreign file, or one that the manifest does not describe.
pub fn open(bake: &Path, manifest: &Manifest, layout: &str) -> Result<Box<dyn Sky>> {
    of_pictures(bake, manifest, layout, &pictures(bake, manifest, layout)?)
}

/// One layout from pictures in memory, by table name. `bake` is for messages.
///
/// # Errors
/// `File` for pictures that the manifest does not describe, `Argument` for a layout that there is not.
pub fn of_pictures(
    bake: &Path,
    manifest: &Manifest,
    layout: &str,
    pictures: &BTreeMap<String, Atlas>,
) -> Result<Box<dyn Sky>> {
    let Some(found) = super::named(layout) else {
        return Err(Error::Argument(format!("layout {layout}: not one that this tool can read")));
    };
    found.open(&Source::new(bake, manifest, layout, pictures)?)
}

/// The pictures of a layout's tables, by table name. Whether they are what their manifest says, [`of_pictures`] finds.
///
/// # Errors
/// `File` for a file that is missing, damaged, or another than the one that was baked.
pub fn pictures(bake: &Path, manifest: &Manifest, layout: &str) -> Result<BTreeMap<String, Atlas>> {
    let folder = if bake.is_dir() { bake } else { bake.parent().unwrap_or(Path::new(".")) };
    let tables = manifest.tables.iter().filter(|t| t.layout == layout);
    tables.map(|table| Ok((table.name.clone(), picture(folder, table)?))).collect()
}

/// Reads the file of a table.
///
/// # Errors
/// `File` for a file that is missing, damaged, or another than the one that was baked.
pub fn picture(folder: &Path, table: &Table) -> Result<Atlas> {
    let path = folder.join(&table.file);
    let bytes = bounded_read::part(folder, &table.file).map_err(|e| Error::reading(&path, e))?;
    let atlas = exr::from_exr_bytes(&path, &bytes)?;
    if blake3::hash(&bytes).to_hex().as_str() != table.blake3 {
        return Err(Error::file(&path, "not the file that was baked (bake.json has another BLAKE3)"));
    }
    Ok(atlas)
}

/// Where a layout's tables come from.
pub struct Source<'a> {
    pub(in crate::internals::layout) bake: &'a Path,
    pub(in crate::internals::layout) manifest: &'a Manifest,
    pub(in crate::internals::layout) layout: &'a str,
    pub(in crate::internals::layout) pictures: &'a BTreeMap<String, Atlas>,
}

impl<'a> Source<'a> {
    /// Errors: `File` with the key of the first number of the manifest that no bake has.
    pub(in crate::internals::layout) fn new(
        bake: &'a Path,
        manifest: &'a Manifest,
        layout: &'a str,
        pictures: &'a BTreeMap<String, Atlas>,
    ) -> Result<Self> {
        let source = Source { bake, manifest, layout, pictures };
        source.check()?;
        Ok(source)
    }

    pub(in crate::internals::layout) fn refuse(&self, reason: impl fmt::Display) -> Error {
        Error::file(self.bake, reason)
    }

    pub(in crate::internals::layout) fn table(&self, name: &str) -> Result<(&Table, &Atlas)> {
        let found = self.manifest.tables.iter().find(|t| t.layout == self.layout && t.name == name);
        match (found, self.pictures.get(name)) {
            (Some(table), Some(atlas)) => Ok((table, atlas)),
            _ => Err(self.refuse(format!("layout {} has no table {name}", self.layout))),
        }
    }

    pub(in crate::internals::layout) fn has(&self, name: &str) -> bool {
        self.manifest.tables.iter().any(|t| t.layout == self.layout && t.name == name)
    }

    pub(in crate::internals::layout) fn volume(&self, name: &str) -> Result<Volume> {
        let (table, atlas) = self.table(name)?;
        Volume::new(table, atlas).map_err(|reason| self.refuse(reason))
    }

    pub(in crate::internals::layout) fn plane(&self, name: &str) -> Result<Plane> {
        let (table, atlas) = self.table(name)?;
        Plane::new(table, atlas).map_err(|reason| self.refuse(reason))
    }

    /// A list of numbers of the manifest.
    pub(in crate::internals::layout) fn constant(&self, name: &str) -> Result<Vec<f64>> {
        let found = self.manifest.constants.get(name);
        found.cloned().ok_or_else(|| self.refuse(format!("bake.json: constants.{name} is missing")))
    }

    pub(in crate::internals::layout) fn number(&self, name: &str) -> Result<f64> {
        let list = self.constant(name)?;
        list.first().copied().ok_or_else(|| self.refuse(format!("bake.json: constants.{name} is empty")))
    }

    /// A colour matrix as rows R, G, B.
    pub(in crate::internals::layout) fn matrix(&self, name: &str) -> Result<Vec<Vec<f64>>> {
        let found = self.manifest.colour.matrices.get(name);
        match found {
            Some(m) if m.len() == 3 => Ok(m.clone()),
            _ => {
                Err(self
                    .refuse(format!("bake.json: colour.matrices.{name} is missing or has not three rows")))
            }
        }
    }
}

pub(in crate::internals::layout) fn multiply(matrix: &[Vec<f64>], values: &[f64]) -> [f64; 3] {
    std::array::from_fn(|c| matrix[c].iter().zip(values).map(|(m, v)| m * v).sum())
}
