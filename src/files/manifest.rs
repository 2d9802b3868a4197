//! `bake.json`: everything that a reader of a bake's files has to know, and nothing of the machine or the moment.

use super::bounded_read;
use crate::error::{Error, Result};
use crate::spectrum::Adaptation;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

pub use super::replace::MANIFEST;
use super::sweep::in_between;

/// The version of the form of `bake.json` that this tool writes, and the newest that it reads.
pub const SCHEMA_VERSION: u64 = 1;

/// A whole `bake.json`. The order of fields is that of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    pub schema_version: u64,
    pub tool: Tool,
    pub preset: Preset,
    /// The waters that were baked with the planet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub waters: Vec<Preset>,
    /// The settings of the bake that decide its bytes: sizes, orders, solver.
    pub settings: Value,
    pub wavelengths: Wavelengths,
    pub colour: Colour,
    /// Numbers that look-ups need beside the tables; each name says its unit.
    pub constants: BTreeMap<String, Vec<f64>>,
    pub tables: Vec<Table>,
    /// Files beside the tables: pictures, the same tables in other containers.
    pub files: Vec<OtherFile>,
    /// The quality report: orders and residual, errors by region, energy balance, counts of odd values.
    pub quality: Value,
    pub warnings: Vec<String>,
    /// [`Manifest::own_hash`]; empty where nothing sealed it.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub manifest_blake3: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tool {
    pub name: String,
    pub version: String,
    /// The version of each algorithm that decided a byte: `solver`, a layout, `water`.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub algorithms: BTreeMap<String, u32>,
    /// A fingerprint that bakes held before `algorithms`; such a bake is read, and stale.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    pub name: String,
    /// [`hash_of`] `resolved`.
    pub hash: String,
    /// The preset with every default filled in, in SI units.
    pub resolved: Value,
}

/// The wavelengths at which the bake was solved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wavelengths {
    pub kind: GridKind,
    /// Points, or centres of bins, nm.
    pub nm: Vec<f64>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GridKind {
    /// Each wavelength stands for a bin around it; spectra are averaged over it.
    Bins,
    /// Point samples, exact there.
    Points,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Colour {
    /// E.g. `srgb`: its primaries, always linear.
    pub space: String,
    /// E.g. `CIE 1931 2 degrees`.
    pub observer: String,
    /// Chromaticity x, y of the white.
    pub white: [f64; 2],
    /// The white that was adapted to the space's own; part of every matrix to RGB.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptation: Option<Adapted>,
    /// By what they take and give, e.g. `xyz_to_rgb`; a row for each output.
    pub matrices: BTreeMap<String, Vec<Vec<f64>>>,
}

/// A chromatic adaptation to the white of a space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adapted {
    /// Chromaticity x, y of what becomes white.
    pub from: [f64; 2],
    pub by: Adaptation,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Table {
    pub layout: String,
    pub name: String,
    /// Path inside the bake, parts separated by `/`.
    pub file: String,
    /// BLAKE3 of the file, 64 hexadecimal digits.
    pub blake3: String,
    /// Texels along each axis, in the order of `axes`; x runs fastest.
    pub shape: Vec<usize>,
    pub axes: Vec<Axis>,
    pub packing: Packing,
    pub encoding: Encoding,
    pub channels: Vec<ChannelInfo>,
    /// The same table, bit for bit, in other containers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub containers: Vec<InContainer>,
}

/// A table in a container besides EXR.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InContainer {
    /// `ktx2`, `dds` or `npy`.
    pub format: String,
    pub file: String,
    pub blake3: String,
    /// Sizes as a reader of the file finds them.
    pub shape: Vec<usize>,
    pub about: String,
}

impl Table {
    /// Path and hash of every file of the table, EXR first.
    pub fn files(&self) -> impl Iterator<Item = (&String, &String)> {
        [(&self.file, &self.blake3)].into_iter().chain(self.containers.iter().map(|c| (&c.file, &c.blake3)))
    }
}

/// How texels follow a physical coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axis {
    pub name: String,
    pub size: usize,
    /// From the coordinate to the texel, and back, with the names in `constants`.
    pub formula: String,
    pub constants: BTreeMap<String, f64>,
    /// Of the coordinate; `1` for a cosine.
    pub unit: String,
}

/// Where the slices of a volume lie in the picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Packing {
    pub slice_width: usize,
    pub slice_height: usize,
    pub slices: usize,
    pub columns: usize,
    pub rows: usize,
    /// `row-major`: slice s lies in column s mod columns, row s / columns.
    pub slice_order: String,
    /// The number of a slice from the texels of the axes that slices share, e.g. `azimuth * 32 + sun`.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub slice_index: String,
    pub origin: Origin,
}

/// The corner of the picture where slice 0 and texel (0, 0) of each slice lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    TopLeft,
    BottomLeft,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChannelInfo {
    pub name: String,
    pub quantity: String,
    pub unit: String,
    pub sample: Precision,
    /// The smallest and the largest stored sample.
    pub range: [f64; 2],
    /// Where it differs from the table's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub encoding: Option<Encoding>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    Half,
    Float,
}

/// From the stored sample to the quantity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Encoding {
    pub kind: EncodingKind,
    pub scale: f64,
    /// Added to the stored sample before the exponential (`log`) or after the product (`linear`).
    pub offset: f64,
    /// A stored sample at or below it means 0 (`log` only).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub floor: Option<f64>,
    /// The same in words of a shader.
    pub decode: String,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EncodingKind {
    Linear,
    Log,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OtherFile {
    pub file: String,
    pub blake3: String,
    pub about: String,
}

impl Encoding {
    /// The quantity is the stored sample times `scale`.
    pub fn linear(scale: f64) -> Self {
        let decode = "value = scale * stored + offset".to_string();
        Encoding { kind: EncodingKind::Linear, scale, offset: 0.0, floor: None, decode }
    }

    /// The quantity is scale · exp(stored + offset), and 0 where the stored sample is `floor` or less.
    pub fn log(scale: f64, offset: f64, floor: f64) -> Self {
        let decode = "value = stored <= floor ? 0 : scale * exp(stored + offset)".to_string();
        Encoding { kind: EncodingKind::Log, scale, offset, floor: Some(floor), decode }
    }

    /// The quantity that a stored sample means.
    pub fn decode(&self, stored: f64) -> f64 {
        match self.kind {
            EncodingKind::Linear => self.scale * stored + self.offset,
            EncodingKind::Log if self.floor.is_some_and(|floor| stored <= floor) => 0.0,
            EncodingKind::Log => self.scale * libm::exp(stored + self.offset),
        }
    }
}

/// Bytes of a manifest at most. It holds the preset with every spectrum and phase function resolved, a number a line.
pub(super) const MOST_MANIFEST: u64 = 1 << 30;

/// The hash of a resolved preset: BLAKE3 of its compact JSON text, 64 hexadecimal digits.
pub fn hash_of(resolved: &Value) -> String {
    blake3::hash(resolved.to_string().as_bytes()).to_hex().to_string()
}

impl Manifest {
    /// The text of `bake.json`, with every number in the shortest form that reads back exactly.
    ///
    /// # Errors
    /// `NotFinite` if a number is infinite or not a number, which JSON cannot hold.
    pub fn to_json(&self) -> Result<String> {
        let refuse = |reason: String| Error::NotFinite { table: MANIFEST.into(), place: reason };
        let text = serde_json::to_string_pretty(self).map_err(|e| refuse(e.to_string()))? + "\n";
        match serde_json::from_str::<Manifest>(&text) {
            Ok(back) if back == *self => Ok(text),
            Ok(_) => Err(refuse("a field that does not read back".into())),
            Err(e) => Err(refuse(located(&e))),
        }
    }

    /// The manifest of the bake at `bake`: its folder or its `bake.json`.
    ///
    /// # Errors
    /// `File` if it is missing, malformed (with line and column), or of a newer version.
    pub fn read(bake: &Path) -> Result<Manifest> {
        let folder = if bake.ends_with(MANIFEST) { bake.parent().unwrap_or(bake) } else { bake };
        // Looks that found nothing to wait for, one after another.
        let mut vain = 0;
        for _ in 0..LOOKS {
            let start = Instant::now();
            match read_now(bake) {
                // Some bake takes the place of another in this moment.
                Err(_) if in_between(folder) => {
                    vain = 0;
                    std::thread::sleep(Duration::from_millis(10));
                }
                // It may have done so since; what takes long to find out is another fault.
                Err(_) if vain < 2 && start.elapsed() < Duration::from_millis(50) => vain += 1,
                found => return found,
            }
        }
        read_now(bake)
    }

    /// As [`Manifest::read`], for a text already in memory; `path` is for messages only.
    pub fn parse(path: &Path, text: &str) -> Result<Manifest> {
        let malformed = |e: serde_json::Error| Error::file(path, located(&e));
        let any: Value = serde_json::from_str(text).map_err(malformed)?;
        match any.get("schema_version").map(|v| (v, v.as_u64())) {
            None => Err(Error::file(path, "not the manifest of a bake: it has no schema_version")),
            Some((_, Some(SCHEMA_VERSION))) => serde_json::from_str(text).map_err(malformed),
            Some((_, Some(newer))) if newer > SCHEMA_VERSION => Err(Error::file(
                path,
                format!(
                    "schema_version {newer} is newer than this tool, which knows {SCHEMA_VERSION}: update tyndall"
                ),
            )),
            Some((other, _)) => Err(Error::file(path, format!("schema_version {other} is unknown"))),
        }
    }
}

/// Looks at a folder in which another bake takes the place of the old one.
const LOOKS: usize = 100;

fn read_now(bake: &Path) -> Result<Manifest> {
    let path = path_in(bake)?;
    let text = match bake.is_dir() {
        true => bounded_read::part_text(bake, MANIFEST, MOST_MANIFEST)?,
        false => bounded_read::named_text(&path, MOST_MANIFEST)?,
    };
    Manifest::parse(&path, &text)
}

fn path_in(bake: &Path) -> Result<PathBuf> {
    let inside = if bake.is_dir() { bake.join(MANIFEST) } else { bake.to_path_buf() };
    if inside.exists() {
        return Ok(inside);
    }
    let reason = if bake.is_dir() { "not a bake: there is no bake.json in it" } else { "no such bake" };
    Err(Error::file(bake, reason))
}

/// Line and column first, then the reason.
fn located(e: &serde_json::Error) -> String {
    let text = e.to_string();
    let reason = text.rsplit_once(" at line ").map_or(text.as_str(), |(reason, _)| reason);
    format!("line {}, column {}: {}", e.line(), e.column(), reason.replace('\n', " "))
}
