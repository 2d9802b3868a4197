//! `tyndall diff`: by how much two bakes differ, and what of their presets and settings makes them differ.

mod tables;
mod tell;
mod views;

use super::text;
use crate::bake::provenance;
use crate::error::{Error, Result};
use crate::files::changes::Change;
use crate::files::manifest::Manifest;
use crate::quality::Distribution;
use std::path::{Path, PathBuf};

/// Arguments of `tyndall diff`.
#[derive(Debug, clap::Args)]
#[command(
    about = "By how much two bakes differ, in their tables and on views, in radiance and ΔE2000; and why",
    before_help = "Example: tyndall diff out/earth out/earth --tolerance 1%",
    after_help = "A difference of radiance is |b - a| over the larger of the two. Of stored texels it is relative to the \
                  larger of the two and to 1/10000 of the table's largest value at least, so that the dark of the \
                  night counts for what it is. ΔE2000 has white D65 and both colours scaled so that A's has Y = 0.18. \
                  Views are those of the report in bake.json: random, by regions, the same in every run.
Exit code 0: done; 1: a difference is beyond a tolerance; 2: no bakes to compare."
)]
pub struct Args {
    /// The folder of a bake
    pub a: PathBuf,
    /// The folder of another
    pub b: PathBuf,
    /// Largest difference of radiance and of texels that may be, e.g. 1% or 0.01: beyond it the exit code is 1. So it
    /// is where one bake has a table that the other has not, or of another shape
    #[arg(long, value_name = "SHARE", value_parser = share)]
    pub tolerance: Option<f64>,
    /// Largest ΔE2000 of a view that may be
    #[arg(long, value_name = "DELTA_E")]
    pub tolerance_delta_e: Option<f64>,
    /// Views of each region
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub views: u32,
    /// Answer in JSON: {"a", "b", "same", "holds", "changes", "tables", "views"}
    #[arg(long)]
    pub json: bool,
}

/// A share as `1%` or `0.01`.
fn share(text: &str) -> Result<f64> {
    let (number, scale) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    match number.trim().parse::<f64>() {
        Ok(v) if v >= 0.0 && v.is_finite() => Ok(v * scale),
        _ => Err("expected a share such as 1% or 0.01".into()),
    }
}

/// A bake and its place.
pub struct Bake {
    pub folder: PathBuf,
    pub manifest: Manifest,
}

/// What two bakes have not in common.
pub struct Found {
    /// What they were made from.
    pub changes: Vec<Change>,
    pub tables: Vec<TableDifference>,
    pub views: Vec<ViewDifference>,
}

/// What differs in a table.
pub struct TableDifference {
    /// `layout/name`.
    pub table: String,
    pub what: Texels,
}

pub enum Texels {
    /// Not a bit.
    Same,
    /// Of every texel and channel, relative.
    Differ(Distribution),
    /// They cannot be compared, for this reason.
    Apart(String),
}

/// What differs in the views of a region, as a layout answers them.
pub struct ViewDifference {
    pub layout: String,
    pub region: &'static str,
    /// What radiance is: `spectral radiance` at the layout's wavelengths, or `luminance`.
    pub quantity: &'static str,
    pub radiance: Distribution,
    pub delta_e: Distribution,
}

/// Prints the differences.
///
/// # Errors
/// `Check` if one is beyond a tolerance, `File` if a bake is missing or damaged.
pub fn run(args: &Args) -> Result<()> {
    let found = compare(&args.a, &args.b, args.views as usize)?;
    let beyond = found.beyond(args);
    text::print(&tell::told(args, &found, beyond.is_empty()))?;
    match beyond.as_slice() {
        [] => Ok(()),
        [first, rest @ ..] => {
            let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
            Err(Error::Check(format!("beyond the tolerance: {first}{more}")))
        }
    }
}

/// What two bakes have not in common, with so many views of each region.
///
/// # Errors
/// `File` if a bake is missing or damaged.
pub fn compare(a: &Path, b: &Path, views: usize) -> Result<Found> {
    let (a, b) = (open(a)?, open(b)?);
    Ok(Found {
        changes: provenance::differences(
            &provenance::recorded(&a.manifest),
            &provenance::recorded(&b.manifest),
        ),
        tables: tables::compare(&a, &b)?,
        views: views::compare(&a, &b, views)?,
    })
}

fn open(bake: &Path) -> Result<Bake> {
    let manifest = Manifest::read(bake)?;
    let folder = if bake.is_dir() { bake } else { bake.parent().unwrap_or(Path::new(".")) };
    Ok(Bake { folder: folder.to_path_buf(), manifest })
}

impl Found {
    /// No table and no view differs.
    pub fn nothing(&self) -> bool {
        let quiet = |d: &Distribution| d.max == 0.0;
        self.tables.iter().all(|t| matches!(t.what, Texels::Same))
            && self.views.iter().all(|v| quiet(&v.radiance) && quiet(&v.delta_e))
    }

    /// What lies beyond the tolerances asked for.
    fn beyond(&self, args: &Args) -> Vec<String> {
        let mut out = Vec::new();
        if let Some(most) = args.tolerance {
            for t in &self.tables {
                match &t.what {
                    Texels::Differ(d) if d.max > most => {
                        out.push(format!("{} {}", t.table, tell::percent(d.max)))
                    }
                    Texels::Apart(why) => out.push(format!("{} {why}", t.table)),
                    _ => {}
                }
            }
            let views = self.views.iter().filter(|v| v.radiance.max > most);
            out.extend(
                views.map(|v| format!("{}, {}: {}", v.layout, v.region, tell::percent(v.radiance.max))),
            );
        }
        if let Some(most) = args.tolerance_delta_e {
            let views = self.views.iter().filter(|v| v.delta_e.max > most);
            out.extend(views.map(|v| format!("{}, {}: ΔE2000 {:.2}", v.layout, v.region, v.delta_e.max)));
        }
        out
    }
}
