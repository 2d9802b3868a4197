//! What the water tables lose, and what the paper's simplifications cost, by water.

use super::{WaterTables, slabs};
use crate::bake::palette::Palette;
use crate::bake::report::{DARK, colour};
use crate::medium::{Medium, WaterMedium};
use crate::preset::Water;
use crate::quality::{Distribution, digits, relative_errors};
use crate::sky::Component;
use crate::sky::water::{WaterSky, WaterView};
use crate::transport::slab::{
    Layer, Light, Slab, WaterOrders, fresnel, lazanyi_szirmay_kalos, leaving, phase_mean,
};
use crate::transport::solve::Solution;
use rayon::prelude::*;
use serde_json::{Map, Value, json};

/// Depths over the largest, view cosines and sun cosines of the report's views, none on a texel.
const DEPTHS: [f64; 6] = [0.0013, 0.011, 0.037, 0.093, 0.31, 0.77];
const VIEWS: [f64; 5] = [0.07, 0.23, 0.52, 0.81, 0.987];
const SUNS: [f64; 5] = [0.06, 0.19, 0.43, 0.71, 0.968];

/// Errors of the tables against the slab solver, of the single-scattering shortcut, of the azimuth left out, of
/// the colours, and of the paper's Fresnel term.
pub fn report(
    waters: &[Water],
    medium: &Medium,
    solution: &Solution,
    palette: &Palette,
    tables: &WaterTables,
    skies: &[WaterSky],
) -> Value {
    let mut out = Map::new();
    let suns: Vec<(f64, Vec<f64>, Vec<f64>)> = SUNS
        .iter()
        .map(|&s| (s, solution.sun_transmittance(medium.ground_radius, s), solution.ground_irradiance(s)))
        .collect();
    for (water, sky) in waters.iter().zip(skies) {
        let media = water.medium(&palette.four_nm());
        let slabs = slabs(&media);
        let cases: Vec<(f64, f64, usize)> = DEPTHS
            .iter()
            .flat_map(|d| VIEWS.iter().flat_map(move |v| (0..SUNS.len()).map(move |s| (*d, *v, s))))
            .collect();
        let judged: Vec<[Vec<f64>; 3]> = cases
            .par_iter()
            .map(|&(share, mu, s)| {
                let depth = share * water.largest_depth;
                let (mu_s, direct, diffuse) = &suns[s];
                let light = |w: usize| Light {
                    mu_s: *mu_s,
                    direct: direct[palette.four[w]] * mu_s,
                    diffuse: diffuse[palette.four[w]],
                };
                let all = |orders| -> Vec<f64> {
                    let one = |w| {
                        let layer = Layer::new(&slabs[w], depth);
                        leaving(&media, w, &layer, mu, light(w), orders).iter().sum()
                    };
                    (0..slabs.len()).map(one).collect()
                };
                let truth = all(WaterOrders::All);
                let found = sky.leaving(&WaterView { depth, mu, mu_s: *mu_s }, Component::Total);
                let single = relative_errors(&all(WaterOrders::Single), &truth, DARK);
                let spread = (0..slabs.len())
                    .filter(|&w| truth[w] > DARK)
                    .map(|w| azimuth(&media, w, &slabs[w], depth, mu, light(w)) / truth[w])
                    .collect();
                [relative_errors(&found, &truth, DARK), single, spread]
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
            "azimuth_half_spread_of_light_scattered_once": Distribution::of(part(2)).json(),
            "lazanyi_szirmay_kalos_largest_error_of_reflectance": digits((0..=1000).map(off).fold(0.0, f64::max)),
        });
        if let Some(error) = tables.colours.get(&water.name) {
            entry["four_wavelengths_delta_e_2000"] = colour(error);
        }
        out.insert(water.name.clone(), entry);
    }
    Value::Object(out)
}

/// Half the range over azimuth of the light that leaves along `mu` after one scattering: what a table without
/// azimuth drops, to the order in which it is largest.
fn azimuth(media: &WaterMedium, w: usize, slab: &Slab, depth: f64, mu: f64, light: Light) -> f64 {
    let surface = slab.surface;
    let (view, sun) = (surface.cosine_in_water(mu), surface.cosine_in_water(light.mu_s));
    let mean = phase_mean(|nu| media.phase(w, nu), view, -sun);
    if mean <= 0.0 {
        return 0.0;
    }
    let layer = Layer::new(slab, depth);
    let [once, _] = leaving(media, w, &layer, mu, Light { diffuse: 0.0, ..light }, WaterOrders::Single);
    let sines = ((1.0 - view * view) * (1.0 - sun * sun)).max(0.0).sqrt();
    let values = (0..=18).map(|k| {
        let azimuth = std::f64::consts::PI * f64::from(k) / 18.0;
        media.phase(w, -view * sun + sines * libm::cos(azimuth))
    });
    let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(a, b), v| (a.min(v), b.max(v)));
    once * 0.5 * (high - low) / mean
}
