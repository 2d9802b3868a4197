//! The bake from a planet to the bytes of every file.

use super::palette::Palette;
use super::settings::{Layout, Settings, Solver};
use super::tables::Baked;
use super::{compact, elek2010, extinction, pictures, report, skies, spectral, water};
use crate::error::{Error, Result};
use crate::export::manifest::{
    Colour, GridKind, Manifest, OtherFile, Preset, SCHEMA_VERSION, Table, Tool, Wavelengths,
};
use crate::export::{Atlas, exr};
use crate::medium::{Medium, Role};
use crate::preset::Planet;
use crate::sky::water::WaterSky;
use crate::sky::{AerosolPhase, Sky};
use crate::spectrum::RANGE;
use crate::transport::solve::{Orders, Resolution, Solution, worst};
use rayon::prelude::*;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::path::Path;

/// Every file of a bake, `bake.json` among them, and what is to be told.
pub struct Product {
    /// Path inside the bake, and content.
    pub files: Vec<(String, Vec<u8>)>,
    pub manifest: Manifest,
}

/// Residual above which a chosen number of orders is called too small.
const RESIDUAL_WARNING: f64 = 0.01;
/// Error of the energy balance above which the bake warns.
const BALANCE_WARNING: f64 = 3e-3;

/// Bakes a planet. `stage` is called with the name of each stage as it begins.
pub fn bake(planet: &Planet, settings: &Settings, stage: &mut dyn FnMut(&str)) -> Result<Product> {
    stage("media");
    let full = planet.medium(&settings.wavelengths_nm);
    full.check().map_err(|reason| Error::Argument(format!("{}: {reason}", planet.name)))?;
    let paper = full.similarity();
    let wants = |layout| settings.layouts.contains(&layout);
    let mut warnings = planet.warnings.clone();
    warnings.extend(outside_vision(&settings.wavelengths_nm));

    stage("solve");
    let full_light =
        wants(Layout::Compact).then(|| Solution::new(&full, &Resolution::TABLES, settings.orders));
    stage("solve paper's medium");
    let paper_light = (wants(Layout::Elek2010) || full_light.is_none())
        .then(|| Solution::new(&paper, &Resolution::PAPER, settings.orders));

    stage("colours");
    let (medium, light) = match (&full_light, &paper_light) {
        (Some(light), _) => (&full, light),
        (None, Some(light)) => (&paper, light),
        (None, None) => unreachable!("one of the two was solved"),
    };
    let palette = Palette::fit(
        &settings.wavelengths_nm,
        &planet.star.irradiance,
        settings.space,
        &skies::sample(light, medium, 0.0),
        &skies::sample(light, medium, 1.0),
    )?;

    let mut baked = Vec::new();
    let mut counts = Map::new();
    if let (true, Some(light)) = (wants(Layout::Elek2010), &paper_light) {
        stage("elek2010 tables");
        let (tables, oddities) = match settings.solver {
            Solver::Moments => elek2010::tables(&paper, light, &palette, settings.elek2010_size),
            Solver::Literal { samples } => {
                super::literal::tables(&paper, light, &palette, settings, samples)?
            }
        };
        baked.extend(tables);
        let groups = compact::groups(&full);
        if !groups.is_empty() {
            baked.push(extinction::phase(&full, &palette, elek2010::LAYOUT, &groups));
        }
        counts.insert("elek2010 colours outside the gamut, set to 0".into(), json!(oddities.negative));
        counts.insert(
            "elek2010 aerosol light lost where the sun is behind the planet, share".into(),
            json!(crate::quality::digits(oddities.aerosol_lost)),
        );
    }
    if let Some(light) = &full_light {
        stage("compact tables");
        let (tables, negative) = compact::tables(&full, light, &palette, settings.compact_sizes);
        baked.extend(tables);
        counts.insert("compact multiple scattering below 0, set to dark".into(), json!(negative));
    }
    let waters = &settings.waters.list;
    let mut water_tables = None;
    if !waters.is_empty() {
        stage("water tables");
        let mut filled = water::tables(planet, settings, medium, light, &palette)?;
        baked.append(&mut filled.tables);
        water_tables = Some(filled);
        warnings.extend(waters.iter().flat_map(|w| w.warnings.iter().map(|t| format!("{}: {t}", w.name))));
    }

    stage("encode");
    let mut files = Files::encode(&baked)?;
    if let (true, Some(light)) = (settings.spectral, &paper_light) {
        files.extra.extend(spectral::files(&paper, light, planet, settings)?);
    }
    let mut manifest = manifest(planet, settings, &palette, &full, &files);
    if let Some(filled) = &water_tables {
        manifest.colour.matrices.extend(filled.matrices.clone());
        manifest.constants.extend(filled.constants.clone());
        let preset = |w: &crate::preset::Water| Preset {
            name: w.name.clone(),
            hash: w.hash(),
            resolved: w.resolved(),
        };
        manifest.waters = waters.iter().map(preset).collect();
    }
    let water_skies: Vec<WaterSky> = waters
        .iter()
        .map(|w| {
            WaterSky::new(Path::new("the bake in memory"), &manifest, &w.name, &files.named(water::LAYOUT))
        })
        .collect::<Result<_>>()?;
    let open = |layout: Layout| -> Result<Option<Sky>> {
        if !wants(layout) {
            return Ok(None);
        }
        Sky::new(Path::new("the bake in memory"), &manifest, layout.name(), &files.of(layout)).map(Some)
    };
    let (compact_sky, paper_sky) = (open(Layout::Compact)?, open(Layout::Elek2010)?);

    stage("report");
    let mut quality = Map::new();
    quality.insert(
        "colour".into(),
        json!({
            "all_wavelengths_delta_e_2000": report::colour(&palette.error),
            "four_wavelengths_delta_e_2000": report::colour(&palette.four_error),
        }),
    );
    let full_truth = full_light.as_ref().map(|light| report::truths(&full, light));
    if let (Some(light), Some(truth), Some(sky)) = (&full_light, &full_truth, &compact_sky) {
        quality.insert("solver".into(), report::solver(&full, light));
        quality.insert("compact_against_direct_integration".into(), report::compact(sky, &palette, truth));
    }
    if let (Some(light), Some(sky)) = (&paper_light, &paper_sky) {
        quality.insert("paper_medium_solver".into(), report::solver(&paper, light));
        let own = report::truths(&paper, light);
        let own = report::elek2010(sky, &palette, &own, AerosolPhase::Isotropic);
        quality.insert("elek2010_against_its_own_medium".into(), own);
        if let Some(truth) = &full_truth {
            let full = report::elek2010(sky, &palette, truth, AerosolPhase::Preset);
            quality.insert("elek2010_against_the_full_medium".into(), full);
        }
    }
    if let Some(filled) = &water_tables {
        let found = water::report(waters, medium, light, &palette, filled, &water_skies);
        quality.insert("water".into(), found);
    }
    counts.insert("stored halves".into(), files.odd_halves());
    quality.insert("counts".into(), Value::Object(counts));
    for (name, light) in [("full", &full_light), ("paper's", &paper_light)] {
        warnings.extend(light.iter().flat_map(|l| solver_warnings(name, l, settings)));
    }
    for key in ["solver", "paper_medium_solver"] {
        let error = quality.get(key).and_then(|s| s["energy_balance_error"].as_f64());
        if let Some(error) = error.filter(|e| e.abs() > BALANCE_WARNING) {
            warnings.push(format!("energy balance of the {key}: {:+.2} % of the light", 100.0 * error));
        }
    }

    stage("picture");
    let sky = compact_sky.as_ref().or(paper_sky.as_ref()).expect("a layout was baked");
    let (picture, errors) = pictures::preview(sky, planet, &named(waters, &water_skies))?;
    if errors > 0 {
        warnings.push(format!("preview.png: {errors} pixels that no display can show (in magenta)"));
    }
    files.extra.push((
        "preview.png".into(),
        "skies at several sun heights and the planet from space".into(),
        picture,
    ));

    manifest.files = files
        .extra
        .iter()
        .map(|(file, about, bytes)| OtherFile {
            file: file.clone(),
            blake3: hash(bytes),
            about: about.clone(),
        })
        .collect();
    manifest.quality = Value::Object(quality);
    manifest.warnings = warnings;
    let text = manifest.to_json()?;
    let mut out: Vec<(String, Vec<u8>)> =
        files.tables.into_iter().map(|f| (f.entry.file.clone(), f.bytes)).collect();
    out.extend(files.extra.into_iter().map(|(file, _, bytes)| (file, bytes)));
    out.push(("bake.json".into(), text.into_bytes()));
    Ok(Product { files: out, manifest })
}

fn named<'a>(waters: &'a [crate::preset::Water], skies: &'a [WaterSky]) -> Vec<(&'a str, &'a WaterSky)> {
    waters.iter().map(|w| w.name.as_str()).zip(skies).collect()
}

/// A warning where wavelengths lie outside those that colours are made of.
fn outside_vision(nm: &[f64]) -> Option<String> {
    let (from, to) = RANGE;
    let outside = nm.iter().filter(|w| !(from..=to).contains(*w)).count();
    (outside > 0).then(|| {
        format!(
            "{outside} of {} wavelengths lie outside {from} to {to} nm, which is all that colours see; spectra \
             of the preset are held at their ends where they are not given",
            nm.len()
        )
    })
}

fn solver_warnings(name: &str, solution: &Solution, settings: &Settings) -> Vec<String> {
    let worst = worst(&solution.report.residual);
    match settings.orders {
        Orders::Converged { tolerance } if worst > 10.0 * tolerance => vec![format!(
            "{name} medium: not converged after {} applications, residual {worst:.2e}",
            solution.report.applications
        )],
        Orders::First(n) if worst > RESIDUAL_WARNING => vec![format!(
            "{name} medium: {n} orders leave {:.1} % of the light for the next one at some place; --orders auto sums all",
            100.0 * worst
        )],
        _ => Vec::new(),
    }
}

fn hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().to_string()
}

/// Encoded tables, and files that are none.
struct Files {
    tables: Vec<TableFile>,
    /// Path, what it is, content.
    extra: Vec<(String, String, Vec<u8>)>,
}

struct TableFile {
    atlas: Atlas,
    entry: Table,
    bytes: Vec<u8>,
}

impl Files {
    fn encode(baked: &[Baked]) -> Result<Files> {
        let encode = |b: &Baked| -> Result<TableFile> {
            let atlas = b.atlas();
            let bytes = exr::to_exr_bytes(&atlas)?;
            let entry = b.entry(&atlas, hash(&bytes));
            Ok(TableFile { atlas, entry, bytes })
        };
        Ok(Files { tables: baked.par_iter().map(encode).collect::<Result<_>>()?, extra: Vec::new() })
    }

    fn of(&self, layout: Layout) -> BTreeMap<String, Atlas> {
        self.named(layout.name())
    }

    fn named(&self, layout: &str) -> BTreeMap<String, Atlas> {
        let of_layout = self.tables.iter().filter(|t| t.entry.layout == layout);
        of_layout.map(|t| (t.entry.name.clone(), t.atlas.clone())).collect()
    }

    /// Zero, subnormal and largest halves of each table.
    fn odd_halves(&self) -> Value {
        let mut out = Map::new();
        for t in &self.tables {
            let (mut zero, mut subnormal, mut all) = (0usize, 0usize, 0usize);
            for channel in &t.atlas.channels {
                let crate::export::Samples::Half(values) = &channel.samples else { continue };
                all += values.len();
                for v in values {
                    zero += usize::from(v.to_bits() & 0x7fff == 0);
                    subnormal += usize::from((1..0x0400).contains(&(v.to_bits() & 0x7fff)));
                }
            }
            let name = format!("{}/{}", t.entry.layout, t.entry.name);
            out.insert(name, json!({ "values": all, "zero": zero, "subnormal": subnormal }));
        }
        Value::Object(out)
    }
}

fn manifest(
    planet: &Planet,
    settings: &Settings,
    palette: &Palette,
    medium: &Medium,
    files: &Files,
) -> Manifest {
    let rows = |weights: Vec<[f64; 3]>| {
        (0..3).map(|c| weights.iter().map(|w| w[c]).collect()).collect::<Vec<Vec<f64>>>()
    };
    let mut matrices = BTreeMap::new();
    matrices.insert("rgb_from_all_wavelengths".into(), rows(palette.rgb_weights()));
    matrices.insert("rgb_from_four".into(), rows(palette.four_rgb_weights()));
    matrices.insert("xyz_from_all_wavelengths".into(), rows(palette.weights.clone()));
    matrices.insert("xyz_from_four".into(), rows(palette.four_weights.clone()));
    matrices.insert("xyz_to_rgb".into(), palette.space.from_xyz().iter().map(|r| r.to_vec()).collect());
    let white = palette.space.white();
    Manifest {
        schema_version: SCHEMA_VERSION,
        tool: Tool { name: "tyndall".into(), version: env!("CARGO_PKG_VERSION").into() },
        preset: Preset { name: planet.name.clone(), hash: planet.hash(), resolved: planet.resolved() },
        settings: settings.json(),
        wavelengths: Wavelengths { kind: GridKind::Points, nm: settings.wavelengths_nm.clone() },
        colour: Colour {
            space: palette.space.name().into(),
            observer: "CIE 1931 2 degrees".into(),
            white: crate::spectrum::chromaticity(white),
            matrices,
        },
        constants: constants(planet, palette, medium),
        waters: Vec::new(),
        tables: files.tables.iter().map(|t| t.entry.clone()).collect(),
        files: Vec::new(),
        quality: Value::Null,
        warnings: Vec::new(),
    }
}

fn constants(planet: &Planet, palette: &Palette, medium: &Medium) -> BTreeMap<String, Vec<f64>> {
    let groups = compact::groups(medium);
    let is_aerosol = |g: &Vec<usize>| medium.constituents[g[0]].role == Role::Aerosol;
    let row = groups.iter().position(is_aerosol).unwrap_or(0);
    BTreeMap::from([
        ("four_wavelengths_nm".to_string(), palette.four_nm()),
        (
            "ground_albedo_at_four".to_string(),
            palette.four.iter().map(|&w| medium.ground_albedo[w]).collect(),
        ),
        ("ground_radius_m".to_string(), vec![medium.ground_radius]),
        ("top_radius_m".to_string(), vec![medium.top_radius]),
        ("star_illuminance_lx".to_string(), vec![palette.star_xyz[1]]),
        ("star_angular_radius_rad".to_string(), vec![planet.star.angular_radius]),
        (
            "star_irradiance_at_wavelengths_w_m2_nm".to_string(),
            planet.star.irradiance.at_all(&palette.wavelengths_nm),
        ),
        ("elek2010_aerosol_phase_row".to_string(), vec![row as f64]),
    ])
}
