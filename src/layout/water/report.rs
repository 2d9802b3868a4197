//! What the water tables lose, and what the paper's simplifications cost, by water.

use super::lookup::{WaterSky, WaterView};
use super::within::Judge;
use super::{FINE, Skylight, WaterTables, slabs};
use crate::colour::weights::ColourWeights;
use crate::layout::sky::Component;
use crate::medium::Medium;
use crate::preset::Water;
use crate::quality::DARK;
use crate::quality::{Distribution, digits, relative_errors};
use crate::transport::slab::{
    Azimuths, Layer, Light, Surface, WaterOrders, azimuth_half_spread, fresnel, gauss_legendre,
    lazanyi_szirmay_kalos, leaving,
};
use crate::transport::solve::Solution;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

/// Depths over the largest, view cosines and sun cosines of the report's views, none on a texel.
const DEPTHS: [f64; 6] = [0.0013, 0.011, 0.037, 0.093, 0.31, 0.77];
const VIEWS: [f64; 5] = [0.07, 0.23, 0.52, 0.81, 0.987];
const SUNS: [f64; 5] = [0.06, 0.19, 0.43, 0.71, 0.968];

/// Light on the surface under one sun, at the four wavelengths.
struct Sun {
    mu_s: f64,
    direct: Vec<f64>,
    /// The sky in two parts, as tables have it; whole; and taken for evenly bright.
    parts: Vec<[f64; 2]>,
    beams: Vec<Vec<(f64, f64)>>,
    even: Vec<Vec<(f64, f64)>>,
}

impl Sun {
    fn new(
        medium: &Medium,
        solution: &Solution,
        palette: &ColourWeights,
        tables: &WaterTables,
        mu_s: f64,
    ) -> Sun {
        let (direct, sky) =
            (solution.sun_transmittance(medium.ground_radius, mu_s), solution.ground_irradiance(mu_s));
        let whole = Skylight::new(medium, solution, mu_s, FINE);
        let four = &palette.four;
        let even =
            |e: f64| gauss_legendre(FINE[0]).into_iter().map(|(mu, w)| (mu, 2.0 * mu * w * e)).collect();
        Sun {
            mu_s,
            direct: four.iter().map(|&w| direct[w] * mu_s).collect(),
            parts: four.iter().map(|&w| tables.split.parts(mu_s, w, sky[w])).collect(),
            beams: four.iter().map(|&w| whole.beams(w, sky[w])).collect(),
            even: four.iter().map(|&w| even(sky[w])).collect(),
        }
    }
}

/// Errors of the tables against the slab solver, of the single-scattering shortcut, of the azimuth left out, of
/// the sky taken in parts or for even, of the colours, and of the paper's Fresnel term. Tables for observers under water
/// hold the sun's light scattered so often as `orders` says.
pub fn report(
    waters: &[Water],
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    tables: &WaterTables,
    skies: &[WaterSky],
    orders: WaterOrders,
) -> Value {
    let mut out = Map::new();
    let judge = Judge { medium, solution, palette, tables, orders };
    let suns: Vec<Sun> = SUNS.par_iter().map(|&s| Sun::new(medium, solution, palette, tables, s)).collect();
    for (water, sky) in waters.iter().zip(skies) {
        let media = water.medium(&palette.four_nm());
        let slabs = slabs(&media);
        let at = |w: usize| Azimuths::new(&media, w, Surface { n: media.refractive_index[w] });
        let azimuths: Vec<Azimuths> = (0..slabs.len()).into_par_iter().map(at).collect();
        let cases: Vec<(f64, f64, usize)> = DEPTHS
            .iter()
            .flat_map(|d| VIEWS.iter().flat_map(move |v| (0..SUNS.len()).map(move |s| (*d, *v, s))))
            .collect();
        let judged: Vec<[Vec<f64>; 5]> = cases
            .par_iter()
            .map(|&(share, mu, s)| {
                let (sun, depth) = (&suns[s], share * water.largest_depth);
                let layers: Vec<Layer> = slabs.iter().map(|slab| Layer::new(slab, depth)).collect();
                let all = |orders, lights: Vec<Light>| -> Vec<f64> {
                    let one = |(w, light)| leaving(&media, w, &layers[w], mu, light, orders).iter().sum();
                    lights.into_iter().enumerate().map(one).collect()
                };
                let each = 0..slabs.len();
                let parts = |w: usize| Light { sky: sun.parts[w], ..Light::sun(sun.mu_s, sun.direct[w]) };
                let even = |w: usize| Light { sky: [0.0; 2], beams: &sun.even[w], ..parts(w) };
                let whole = |w: usize| Light { sky: [0.0; 2], beams: &sun.beams[w], ..parts(w) };
                let truth = all(WaterOrders::All, each.clone().map(parts).collect());
                let found = sky.leaving(&WaterView { depth, mu, mu_s: sun.mu_s }, Component::Total);
                let single = relative_errors(
                    &all(WaterOrders::First(1), each.clone().map(parts).collect()),
                    &truth,
                    DARK,
                );
                let spread = each
                    .clone()
                    .filter(|&w| truth[w] > DARK)
                    .map(|w| {
                        let layers = azimuths[w].layers(depth);
                        azimuth_half_spread(&media, w, &layers, mu, (sun.mu_s, sun.direct[w])) / truth[w]
                    })
                    .collect();
                let skies = all(WaterOrders::All, each.clone().map(whole).collect());
                let even = all(WaterOrders::All, each.map(even).collect());
                let even = relative_errors(&even, &skies, DARK);
                let parts = relative_errors(&truth, &skies, DARK);
                [relative_errors(&found, &truth, DARK), single, spread, even, parts]
            })
            .collect();
        let part = |k: usize| judged.iter().flat_map(|j| j[k].clone()).collect::<Vec<f64>>();
        let n = media.refractive_index[0];
        let off = |k: u32| {
            let mu = f64::from(k) / 1000.0;
            (lazanyi_szirmay_kalos(mu, n) - fresnel(mu, n)).abs()
        };
        let mut entry = json!({
            "tables_against_solver": Distribution::of(part(0)).json(),
            "single_scattering_against_all_orders": Distribution::of(part(1)).json(),
            "azimuth_half_spread": Distribution::of(part(2)).json(),
            "sky_in_two_parts_against_the_whole_sky": Distribution::of(part(4)).json(),
            "even_sky_against_the_whole_sky": Distribution::of(part(3)).json(),
            "lazanyi_szirmay_kalos_largest_error_of_reflectance": digits((0..=1000).map(off).fold(0.0, f64::max)),
        });
        if let Some(found) = judge.report(water, &media, &slabs, sky) {
            entry["underwater_tables_against_solver"] = found;
        }
        if let Some([sky, own]) = tables.colours.get(&water.name) {
            entry["four_wavelengths_delta_e_2000"] = own.json();
            entry["four_wavelengths_delta_e_2000_with_the_weights_of_the_sky"] = sky.json();
        }
        out.insert(water.name.clone(), entry);
    }
    Value::Object(out)
}
