//! `tyndall presets`: what is shipped, what a preset means, and whether files are presets.

use super::presets_colour::{Colours, deep_water, zenith};
use super::presets_show::{as_json, as_text};
use super::presets_water;
use super::text::{print, say};
use crate::error::{Error, Result};
use crate::plan::load_waters;
use crate::preset::schema::{Kind, schema};
use crate::preset::{self, PresetKind};
use std::path::{Path, PathBuf};

/// List, show and check presets of planets and waters.
#[derive(clap::Args, Debug)]
#[command(before_help = "Example: tyndall presets show earth
         tyndall presets check my-planet.json")]
pub struct Args {
    #[command(subcommand)]
    pub action: Option<Action>,
}

/// What to do with presets; `list` without any.
#[derive(clap::Subcommand, Debug)]
pub enum Action {
    /// Names and descriptions of the shipped presets
    #[command(before_help = "Example: tyndall presets list --json")]
    List {
        /// JSON instead of a table
        #[arg(long)]
        json: bool,
    },
    /// A preset in SI and the physics it implies: optical depths, scale heights, asymmetry, colour of the zenith
    /// (of deep water)
    #[command(
        before_help = "Example: tyndall presets show earth --set constituents.aerosol.density_factor=10"
    )]
    Show {
        /// Shipped name or path of a JSON file
        preset: String,
        /// Change a value before it is read; repeatable
        #[arg(long, value_name = "path.to.key=value")]
        set: Vec<String>,
        /// Wavelengths in nm
        #[arg(long, value_delimiter = ',', default_value = "400,440,550,680,750")]
        wavelengths: Vec<f64>,
        /// JSON with the whole resolved preset
        #[arg(long)]
        json: bool,
        /// Leave out the colour, which takes a solve: seconds where the air is thick
        #[arg(long)]
        no_colour: bool,
    },
    /// Read preset files (folders: their *.json) and say for each whether it holds; exit code 2 if one does not
    #[command(before_help = "Example: tyndall presets check my-planets/")]
    Check {
        /// Files or folders; the shipped presets without any
        paths: Vec<PathBuf>,
    },
    /// The JSON Schema (draft 2020-12) of preset files, for editors
    #[command(before_help = "Example: tyndall presets schema planet")]
    Schema {
        /// Of which presets [default: of both]
        kind: Option<Kind>,
    },
}

/// Runs the command.
pub fn run(args: &Args) -> Result<()> {
    match &args.action {
        None => list(false),
        Some(Action::List { json }) => list(*json),
        Some(Action::Show { preset, set, wavelengths, json, no_colour }) => {
            show(preset, set, wavelengths, *json, !no_colour)
        }
        Some(Action::Check { paths }) => check(paths),
        Some(Action::Schema { kind }) => print(&format!("{:#}\n", schema(*kind))),
    }
}

fn list(json: bool) -> Result<()> {
    let planets = preset::shipped().into_iter().map(|p| ("planet", p));
    let waters = preset::shipped_waters().into_iter().map(|w| ("water", w));
    let shipped: Vec<(&str, (&str, String))> = planets.chain(waters).collect();
    if json {
        let entry = |(kind, (name, description)): &(&str, (&str, String))| serde_json::json!({"name": name, "kind": kind, "description": description});
        let list: Vec<_> = shipped.iter().map(entry).collect();
        return print(&format!("{:#}\n", serde_json::Value::Array(list)));
    }
    let width = shipped.iter().map(|p| p.1.0.len()).max().unwrap_or(0);
    let line = |(kind, (name, text)): &(&str, (&str, String))| match *kind {
        "water" => format!("{name:width$}  water: {text}\n"),
        _ => format!("{name:width$}  {text}\n"),
    };
    print(&shipped.iter().map(line).collect::<String>())
}

fn show(name: &str, set: &[String], wavelengths: &[f64], json: bool, colour: bool) -> Result<()> {
    if let Some(w) = wavelengths.iter().find(|w| !(200.0..=4000.0).contains(*w)) {
        return Err(Error::Argument(format!("--wavelengths {w}: must be between 200 and 4000 nm")));
    }
    if preset::is_water(name) {
        let water = preset::load_water(name, set)?;
        let colours = if colour { Some(deep_water(&water)?) } else { None };
        let physics = if json {
            presets_water::as_json(&water, wavelengths)
        } else {
            presets_water::as_text(&water, wavelengths)
        };
        return print(&with_colours(physics, colours, json)?);
    }
    let planet = preset::load(name, set)?;
    let colours = colour.then(|| zenith(&planet));
    let physics = if json { as_json(&planet, wavelengths) } else { as_text(&planet, wavelengths) };
    print(&with_colours(physics, colours, json)?)
}

/// Adds colours to what is told of a preset: at the end of a text, in JSON under `physics`.
fn with_colours(physics: String, colours: Option<Colours>, json: bool) -> Result<String> {
    let Some(colours) = colours else { return Ok(physics) };
    if !json {
        return Ok(physics + &colours.text);
    }
    let mut report: serde_json::Value =
        serde_json::from_str(&physics).map_err(|e| Error::Argument(format!("report of a preset: {e}")))?;
    report["physics"][colours.key] = colours.json;
    Ok(format!("{report:#}\n"))
}

fn check(paths: &[PathBuf]) -> Result<()> {
    let mut names: Vec<String> = Vec::new();
    for path in paths {
        names.extend(files(path)?);
    }
    if paths.is_empty() {
        let shipped = preset::shipped_names().chain(preset::shipped_water_names());
        names.extend(shipped.map(str::to_string));
    }
    let mut bad = 0;
    for name in &names {
        match checked(name) {
            Ok((what, warnings)) => {
                print(&format!("ok   {name}: {what}\n"))?;
                warnings.iter().for_each(|w| say(&format!("warning: {name}: {w}")));
            }
            Err(error) => {
                bad += 1;
                // An error about a spectrum names that file.
                let error = error.to_string();
                let about = if error.contains(name.as_str()) { String::new() } else { format!("{name}: ") };
                print(&format!("bad  {about}{error}\n"))?;
            }
        }
    }
    match bad {
        0 => Ok(()),
        _ => Err(Error::Argument(format!("{bad} of {} presets do not hold", names.len()))),
    }
}

/// Reads a preset of any kind, and what a scene names: what is in it, and warnings.
fn checked(name: &str) -> Result<(String, Vec<String>)> {
    let constituents = |count: usize| format!("{count} constituents");
    match preset::kind(name) {
        Some(PresetKind::Water) => {
            preset::load_water(name, &[]).map(|w| (constituents(w.substances.len() - 1), w.warnings))
        }
        Some(PresetKind::Scene) => {
            let scene = preset::load_scene(name)?;
            let mut warnings = preset::load(&scene.planet, &[])?.warnings;
            for water in load_waters(&scene)? {
                warnings.extend(water.warnings);
            }
            Ok((format!("a scene of {}", scene.planet), warnings))
        }
        _ => preset::load(name, &[]).map(|p| (constituents(p.constituents.len()), p.warnings)),
    }
}

/// A file itself, or the JSON files of a folder in the order of their names.
fn files(path: &Path) -> Result<Vec<String>> {
    if !path.is_dir() {
        return Ok(vec![path.display().to_string()]);
    }
    let entries = std::fs::read_dir(path).map_err(|e| Error::reading(path, e))?;
    let mut list = Vec::new();
    for entry in entries {
        let file = entry.map_err(|e| Error::reading(path, e))?.path();
        if file.extension().is_some_and(|e| e == "json") {
            list.push(file.display().to_string());
        }
    }
    if list.is_empty() {
        return Err(Error::file(path, "no .json file in this folder"));
    }
    list.sort();
    Ok(list)
}
