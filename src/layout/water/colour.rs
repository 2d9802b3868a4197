//! Colours of a water from four wavelengths: a matrix fitted on its own light.

use super::skylight::Split;
use super::slabs;
use crate::colour::weights::{ColourError, ColourWeights, judge};
use crate::error::Result;
use crate::medium::Medium;
use crate::preset::{Planet, Water};
use crate::spectrum::{DEFAULT_RIDGE, Reconstruction, fit_weights, multiply};
use crate::transport::slab::{Layer, Light, WaterOrders, leaving};
use crate::transport::solve::Solution;
use rayon::prelude::*;

/// Depths over the largest one, views and suns of the sample; the two halves of it have no common view.
const DEPTHS: [[f64; 4]; 2] = [[0.01, 0.04, 0.16, 1.0], [0.02, 0.08, 0.3, 0.7]];
const VIEWS: [[f64; 2]; 2] = [[0.25, 0.9], [0.45, 1.0]];
const SUNS: [[f64; 3]; 2] = [[0.1, 0.4, 0.9], [0.05, 0.25, 0.65]];

/// Spectra of the light that leaves a water at all wavelengths of the bake, over the star's irradiance: the
/// training sample (0) or the held-out one (1).
pub fn spectra(
    water: &Water,
    medium: &Medium,
    solution: &Solution,
    split: &Split,
    half: usize,
) -> Vec<Vec<f64>> {
    let media = water.medium(&medium.wavelengths_nm);
    let slabs = slabs(&media);
    let (r, count) = (medium.ground_radius, slabs.len());
    let lights: Vec<(f64, Vec<f64>, Vec<f64>)> = SUNS[half]
        .iter()
        .map(|&s| (s, solution.sun_transmittance(r, s), solution.ground_irradiance(s)))
        .collect();
    // `[wavelength][depth, view, sun]`
    let rows: Vec<Vec<f64>> = (0..count)
        .into_par_iter()
        .map(|w| {
            let mut row = Vec::new();
            for share in DEPTHS[half] {
                let layer = Layer::new(&slabs[w], share * water.largest_depth);
                for mu in VIEWS[half] {
                    for (mu_s, direct, diffuse) in &lights {
                        let sky = split.parts(*mu_s, w, diffuse[w]);
                        let light = Light { sky, ..Light::sun(*mu_s, direct[w] * mu_s) };
                        let [own, bed] = leaving(&media, w, &layer, mu, light, WaterOrders::All);
                        row.push(own + bed);
                    }
                }
            }
            row
        })
        .collect();
    (0..rows[0].len()).map(|k| rows.iter().map(|row| row[k]).collect()).collect()
}

/// Linear RGB (rows) from the four wavelengths of the bake, cd/m² sr, and ΔE2000 on held-out light: of the sky's own
/// weights and of these. The water's, because the weights of a sky are no good for spectra that end at 600 nm.
pub(crate) fn fit(
    planet: &Planet,
    water: &Water,
    medium: &Medium,
    solution: &Solution,
    split: &Split,
    palette: &ColourWeights,
) -> Result<(Vec<Vec<f64>>, [ColourError; 2])> {
    let reconstruction = Reconstruction::new(&palette.wavelengths_nm, &planet.star.irradiance);
    let [training, held_out] = [0, 1].map(|half| spectra(water, medium, solution, split, half));
    let four = |all: &[Vec<f64>]| -> Vec<Vec<f64>> {
        all.iter().map(|t| palette.four.iter().map(|&w| t[w]).collect()).collect()
    };
    let colours = |all: &[Vec<f64>]| all.iter().map(|t| reconstruction.xyz(t)).collect::<Vec<_>>();
    let targets = colours(&training);
    let weights = fit_weights(&four(&training), &targets, &palette.four_weights, DEFAULT_RIDGE)?;
    let (few, judges) = (four(&held_out), colours(&held_out));
    let error = [&palette.four_weights, &weights].map(|weights| judge(weights, &few, &judges));
    let rgb: Vec<[f64; 3]> = weights.iter().map(|w| multiply(&palette.rgb.from_xyz, *w)).collect();
    Ok(((0..3).map(|c| rgb.iter().map(|w| w[c]).collect()).collect(), error))
}
