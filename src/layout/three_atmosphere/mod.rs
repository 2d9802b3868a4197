//! The files that the npm package `@takram/three-atmosphere` loads, in the mapping of Bruneton 2017: light of the
//! medium as the preset states it, solved at all wavelengths of the bake and stored as linear RGB.
//!
//! What its shaders do with them, per component of RGB: sky = `scattering` · p_R(ν) + `single_mie_scattering` · p_M(ν),
//! with the Rayleigh phase function p_R = 3 (1 + ν²) / 16π and that of Cornette & Shanks for one g, p_M. So light last
//! scattered by gas and all that was scattered more than once is divided by p_R at each node, and light scattered once
//! by aerosols by p_M, whatever their own phase function is. Channel A of `scattering` is the red of
//! `single_mie_scattering`, from which the package guesses the other two where that file is not loaded.

mod bruneton;
mod light;
pub mod lookup;
mod parameters;
mod phase;
mod tables;

use super::judge::{Truth, in_rgb};
use super::settings::Settings;
use super::sky::{AerosolPhase, Sky, Source};
use super::table_data::TableData;
use super::{Filled, Ingredients, Layout, MediumKind};
use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::mapping::Elek2010;
use crate::medium::Medium;
use crate::preset::Planet;
use crate::transport::solve::Solution;
use serde_json::{Value, json};
use std::collections::BTreeMap;

pub use bruneton::Bruneton;
use phase::{cornette_shanks, rayleigh};

/// Name of the layout and of its folder.
pub const LAYOUT: &str = "three-atmosphere";
/// Raised when the bytes of this layout change (see [`crate::bake::versions`]).
pub const ALGORITHM_VERSION: u32 = 1;
/// The package's unit of luminance, cd/m²: what its own tables give for sunlight of radiance 1 (its
/// `sunRadianceToLuminance`, weighted as sRGB's luminance), so that one exposure suits its tables and ours.
pub const LUMINANCE_UNIT: f64 = 75_716.9;

/// The layout's files, and what is odd about them.
pub struct Tables {
    pub tables: Vec<TableData>,
    /// The text of `parameters.json`.
    pub parameters: String,
    /// Numbers that look-ups need besides, for the manifest.
    pub constants: BTreeMap<String, Vec<f64>>,
    /// Colours outside the gamut, set to 0.
    pub negative: usize,
}

/// Fills the layout. `solution` must be of `medium`, the preset's own.
///
/// # Errors
/// A parameter that JSON cannot hold.
pub fn tables(
    planet: &Planet,
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
) -> Result<Tables> {
    let mapping = Bruneton::new(medium.ground_radius, medium.top_radius, Bruneton::SIZE)
        .expect("a checked shell and the package's sizes");
    let g = phase::best_g(medium, palette, &mapping);
    let light = light::scattering(medium, solution, palette, &mapping);
    let sky = light::irradiance(solution, palette, medium);
    let scale = tables::scale(&light, &sky, &mapping, g);
    let (tables, negative) = tables::all(solution, palette, &mapping, g, scale, &light, sky);
    let parameters = parameters::text(planet, medium, palette, &mapping, g, scale)?;
    let colours = parameters::Colours::new(medium, palette);
    let constants = BTreeMap::from([
        ("three_atmosphere_mie_g".to_string(), vec![g]),
        ("three_atmosphere_ground_albedo_rgb".to_string(), colours.ground_albedo.to_vec()),
        ("three_atmosphere_star_rgb_lx".to_string(), colours.star_lx.to_vec()),
    ]);
    Ok(Tables { tables, parameters, constants, negative })
}

/// Files of the npm package @takram/three-atmosphere.
pub struct ThreeAtmosphereLayout;

impl Layout for ThreeAtmosphereLayout {
    fn name(&self) -> &'static str {
        LAYOUT
    }

    fn version(&self) -> u32 {
        ALGORITHM_VERSION
    }

    fn about(&self) -> Option<&'static str> {
        Some("Files of the npm package @takram/three-atmosphere")
    }

    fn medium(&self) -> MediumKind {
        MediumKind::Full
    }

    fn has_windows(&self) -> bool {
        false
    }

    fn mappings(&self, medium: &Medium, _: &Settings) -> Vec<Elek2010> {
        Elek2010::new(medium.ground_radius, medium.top_radius, Bruneton::SIZE).into_iter().collect()
    }

    /// All orders, single scattering by aerosols, and orders beyond the first.
    fn texels(&self, _: &Medium, _: &Settings) -> usize {
        3 * Bruneton::SIZE.iter().product::<usize>()
    }

    fn fill(&self, from: &Ingredients) -> Result<Filled> {
        let found = tables(from.planet, from.full, from.solution, from.palette)?;
        let mut filled = Filled { tables: found.tables, constants: found.constants, ..Filled::default() };
        let negative = "three-atmosphere colours outside the gamut, set to 0";
        filled.counts.insert(negative.into(), json!(found.negative));
        let about = "parameters for the AtmosphereParameters of @takram/three-atmosphere";
        let path = format!("{LAYOUT}/parameters.json");
        filled.files.push((path, about.into(), found.parameters.into_bytes()));
        Ok(filled)
    }

    fn open(&self, source: &Source) -> Result<Box<dyn Sky>> {
        Ok(Box::new(lookup::ThreeAtmosphere::new(source)?))
    }

    fn report_key(&self) -> &'static str {
        "three_atmosphere_against_direct_integration"
    }

    fn judge(&self, sky: &dyn Sky, palette: &ColourWeights, truths: &[Truth]) -> Value {
        in_rgb(sky, palette, truths, AerosolPhase::Preset)
    }

    fn remedy(&self) -> &'static str {
        "its sizes are its reader's own, and layout compact errs less"
    }
}
