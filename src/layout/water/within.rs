//! What the tables for observers under water lose, at views drawn at random.

use super::WaterTables;
use super::lookup::{WaterSky, WaterView};
use crate::colour::weights::ColourWeights;
use crate::layout::sky::Component;
use crate::medium::{Medium, WaterMedium};
use crate::preset::Water;
use crate::quality::DARK;
use crate::quality::{Distribution, digits, relative_errors};
use crate::transport::slab::{Layer, Light, Slab, WaterOrders, within};
use crate::transport::solve::Solution;
use rayon::prelude::*;
use serde_json::{Value, json};
use sobol_burley::sample;

/// Views: enough for a 95th percentile at four wavelengths, few enough to take a small share of the bake.
const VIEWS: usize = 150;
/// Lowest sun, by its cosine: below, little light enters.
const LEAST_SUN: f64 = 0.05;
const SEED: u32 = 3;

/// Light on the water and the water itself, at the four wavelengths of the tables.
pub(super) struct Judge<'a> {
    pub medium: &'a Medium,
    pub solution: &'a Solution,
    pub palette: &'a ColourWeights,
    pub tables: &'a WaterTables,
    pub orders: WaterOrders,
}

/// One view: the water's depth and the observer's (m), view and sun.
type Place = (WaterView, f64);

impl Judge<'_> {
    /// Errors of the underwater tables against the slab solver, relative, and where they are largest; none without those
    /// tables.
    pub(super) fn report(
        &self,
        water: &Water,
        media: &WaterMedium,
        slabs: &[Slab],
        sky: &WaterSky,
    ) -> Option<Value> {
        if !sky.has_underwater() {
            return None;
        }
        let places: Vec<Place> = (0..VIEWS as u32).map(|k| place(k, water.largest_depth)).collect();
        let judged: Vec<(Vec<f64>, Vec<f64>)> = places
            .par_iter()
            .map(|(view, observer)| {
                let found = sky.within(view, *observer, Component::Total).unwrap_or_default();
                (found, self.truth(media, slabs, view, *observer))
            })
            .collect();
        let errors = judged.iter().flat_map(|(found, truth)| relative_errors(found, truth, DARK)).collect();
        let mut out = Distribution::of(errors).json();
        out["worst"] = self.worst(&places, &judged);
        Some(out)
    }

    /// Radiance over the star's irradiance by the slab solver, as `sample --exact` answers.
    fn truth(&self, media: &WaterMedium, slabs: &[Slab], view: &WaterView, observer: f64) -> Vec<f64> {
        let direct = self.solution.sun_transmittance(self.medium.ground_radius, view.mu_s);
        let diffuse = self.solution.ground_irradiance(view.mu_s);
        let at = |(k, slab): (usize, &Slab)| {
            let w = self.palette.four[k];
            let parts = self.tables.split.parts(view.mu_s, w, diffuse[w]);
            let light = Light { sky: parts, ..Light::sun(view.mu_s, direct[w] * view.mu_s) };
            let share = observer / view.depth;
            within(media, k, &Layer::new(slab, view.depth), (view.mu, share), light, self.orders).iter().sum()
        };
        slabs.iter().enumerate().map(at).collect()
    }

    /// The view and wavelength of the largest error.
    fn worst(&self, places: &[Place], judged: &[(Vec<f64>, Vec<f64>)]) -> Value {
        let error = |found: f64, truth: f64| match (found / truth - 1.0).abs() {
            e if e.is_nan() => f64::INFINITY,
            e => e,
        };
        let all = judged.iter().enumerate().flat_map(|(n, (found, truth))| {
            found.iter().zip(truth).enumerate().map(move |(k, (f, t))| (n, k, *f, *t))
        });
        let lit = all.filter(|(_, _, _, truth)| *truth > DARK);
        let Some((n, k, found, truth)) = lit.max_by(|a, b| error(a.2, a.3).total_cmp(&error(b.2, b.3)))
        else {
            return Value::Null;
        };
        let (view, observer) = &places[n];
        json!({
            "depth_m": digits(view.depth),
            "observer_depth_m": digits(*observer),
            "mu_view": digits(view.mu),
            "mu_sun": digits(view.mu_s),
            "nm": digits(self.palette.four_nm()[k]),
            "tables": digits(found),
            "solver": digits(truth),
        })
    }
}

/// View number `k` of a water of so many metres: the same for every bake (Sobol points scrambled after Owen).
fn place(k: u32, largest: f64) -> Place {
    let u = |dimension: u32| f64::from(sample(k, dimension, SEED));
    // The cube of an even number gives shallow water its share; not 0, where there is none.
    let depth = largest * (u(0) * u(0) * u(0)).max(1e-6);
    let view = WaterView { depth, mu: 2.0 * u(1) - 1.0, mu_s: LEAST_SUN + (1.0 - LEAST_SUN) * u(2) };
    (view, depth * u(3))
}
