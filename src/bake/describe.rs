//! What `bake.json` says before anything is measured: settings, colour, constants, tables.

use super::files::Files;
use super::versions;
use crate::colour::weights::ColourWeights;
use crate::files::manifest::{Adapted, Colour, GridKind, Manifest, Preset, SCHEMA_VERSION, Wavelengths};
use crate::layout::compact;
use crate::layout::settings::Settings;
use crate::layout::water::WaterTables;
use crate::medium::{Medium, Role};
use crate::preset::{Planet, Water};
use crate::spectrum::{Adaptation, chromaticity};
use serde_json::Value;
use std::collections::BTreeMap;

/// The manifest of a bake, without its other files, quality and warnings.
pub(crate) fn manifest(
    planet: &Planet,
    settings: &Settings,
    palette: &ColourWeights,
    medium: &Medium,
    files: &Files,
) -> Manifest {
    Manifest {
        schema_version: SCHEMA_VERSION,
        tool: versions::tool(settings),
        preset: Preset { name: planet.name.clone(), hash: planet.hash(), resolved: planet.resolved() },
        settings: settings.json(),
        wavelengths: Wavelengths { kind: GridKind::Points, nm: settings.wavelengths_nm.clone() },
        colour: colour(palette),
        constants: constants(planet, palette, medium, &settings.compact.folded),
        waters: Vec::new(),
        tables: files.tables.iter().map(|t| t.entry.clone()).collect(),
        files: Vec::new(),
        quality: Value::Null,
        warnings: Vec::new(),
        manifest_blake3: String::new(),
    }
}

/// The colour space, its white and all matrices of the air.
pub(crate) fn colour(palette: &ColourWeights) -> Colour {
    let rows = |weights: Vec<[f64; 3]>| {
        (0..3).map(|c| weights.iter().map(|w| w[c]).collect()).collect::<Vec<Vec<f64>>>()
    };
    let mut matrices = BTreeMap::new();
    matrices.insert("rgb_from_all_wavelengths".into(), rows(palette.rgb_weights()));
    matrices.insert("rgb_from_four".into(), rows(palette.four_rgb_weights()));
    matrices.insert("xyz_from_all_wavelengths".into(), rows(palette.weights.clone()));
    matrices.insert("xyz_from_four".into(), rows(palette.four_weights.clone()));
    matrices.insert("xyz_to_rgb".into(), palette.rgb.from_xyz.iter().map(|r| r.to_vec()).collect());
    let adapted = |(from, by): ([f64; 2], Adaptation)| Adapted { from, by };
    Colour {
        space: palette.rgb.space.name().into(),
        observer: palette.beholder.name().into(),
        white: chromaticity(palette.rgb.space.white()),
        adaptation: palette.rgb.adapted.map(adapted),
        matrices,
    }
}

/// Adds what the waters' tables need.
pub(crate) fn add_waters(manifest: &mut Manifest, waters: &[Water], tables: &WaterTables) {
    manifest.colour.matrices.extend(tables.matrices.clone());
    manifest.constants.extend(tables.constants.clone());
    let preset = |w: &Water| Preset { name: w.name.clone(), hash: w.hash(), resolved: w.resolved() };
    manifest.waters = waters.iter().map(preset).collect();
}

fn constants(
    planet: &Planet,
    palette: &ColourWeights,
    medium: &Medium,
    folded: &[String],
) -> BTreeMap<String, Vec<f64>> {
    let (groups, _) = compact::groups_to_fold(medium, folded);
    let is_aerosol = |g: &Vec<usize>| medium.constituents[g[0]].role == Role::Aerosol;
    let row = groups.iter().position(is_aerosol).unwrap_or(0);
    let mut constants = coefficients(&groups, palette, medium);
    constants.extend([
        ("four_wavelengths_nm".to_string(), palette.four_nm()),
        (
            "ground_albedo_at_four".to_string(),
            palette.four.iter().map(|&w| medium.ground_albedo[w]).collect(),
        ),
        ("ground_radius_m".to_string(), vec![medium.ground_radius]),
        ("top_radius_m".to_string(), vec![medium.top_radius]),
        ("star_angular_radius_rad".to_string(), vec![planet.star.angular_radius]),
        ("elek2010_aerosol_phase_row".to_string(), vec![row as f64]),
    ]);
    constants.extend(star(planet, palette));
    constants
}

/// Light of the star: its illuminance, and its irradiance at the wavelengths of the bake.
pub(crate) fn star(planet: &Planet, palette: &ColourWeights) -> [(String, Vec<f64>); 2] {
    let irradiance = planet.star.irradiance.at_all(&palette.wavelengths_nm);
    [
        ("star_illuminance_lx".to_string(), vec![palette.star_xyz[1]]),
        ("star_irradiance_at_wavelengths_w_m2_nm".to_string(), irradiance),
    ]
}

/// What each constituent does where its density is 1, for those who march rays themselves, and its row of the phase
/// table (of what scatters). Its density is that of the resolved preset.
fn coefficients(
    groups: &[Vec<usize>],
    palette: &ColourWeights,
    medium: &Medium,
) -> BTreeMap<String, Vec<f64>> {
    let mut constants = BTreeMap::new();
    for (k, c) in medium.constituents.iter().enumerate() {
        let key = |what: &str| format!("constituent_{}_{what}", c.name);
        let at_four = |value: &dyn Fn(usize) -> f64| palette.four.iter().map(|&w| value(w)).collect();
        constants.insert(key("scattering_at_four_per_m"), at_four(&|w| c.scattering[w]));
        constants.insert(key("extinction_at_four_per_m"), at_four(&|w| c.scattering[w] + c.absorption[w]));
        let row = groups.iter().position(|g| g.contains(&k)).map(|row| row as f64);
        constants.insert(key("phase_row"), row.into_iter().collect());
    }
    constants
}
