//! The light of a planet's own sky on a water surface, from above.

use crate::geometry::Point;
use crate::geometry::view::View;
use crate::medium::Medium;
use crate::transport::slab::{Dome, fresnel, gauss_legendre};
use crate::transport::solve::{Solution, lowest_sun};
use rayon::prelude::*;
use std::f64::consts::PI;

/// A sky over the ground under one sun, by rings of even azimuth mean.
pub struct Skylight {
    /// `[ring]`: cosine of the zenith angle, and the irradiance of a horizontal surface by the ring over the star's,
    /// per wavelength.
    rings: Vec<(f64, Vec<f64>)>,
}

/// Refractive index by which the sky is split for all waters of a bake: of seawater.
const TYPICAL: f64 = 1.34;

/// Rings and azimuths of a half turn for tables, and where the whole sky is taken for the truth.
pub(super) const COARSE: [usize; 2] = [8, 8];
pub const FINE: [usize; 2] = [14, 14];

impl Skylight {
    /// Integrates the sky of a solution, Gauss–Legendre over zenith cosines, midpoints that crowd at the sun over
    /// azimuth.
    pub fn new(medium: &Medium, solution: &Solution, mu_s: f64, [rings, azimuths]: [usize; 2]) -> Skylight {
        let all: Vec<usize> = (0..medium.constituents.len()).collect();
        let dark = solution.ground_irradiance(mu_s).iter().all(|e| *e <= 0.0);
        let ring = |(mu, weight): (f64, f64)| -> (f64, Vec<f64>) {
            let mut sum = vec![0.0; medium.wavelengths_nm.len()];
            // azimuth = π x²: d(azimuth) = 2π x dx.
            for k in 0..if dark { 0 } else { azimuths } {
                let x = (k as f64 + 0.5) / azimuths as f64;
                let point = Point { altitude: 0.0, mu, mu_s, azimuth_deg: 180.0 * x * x };
                let Some(view) = View::enter(&point, medium.ground_radius, medium.top_radius) else {
                    continue;
                };
                let light = solution.radiance(&view, &all).scattering;
                let share = 2.0 * x / azimuths as f64 * 2.0 * PI * mu * weight;
                sum.iter_mut().zip(&light).for_each(|(s, l)| *s += share * l);
            }
            (mu, sum)
        };
        Skylight { rings: gauss_legendre(rings).into_iter().map(ring).collect() }
    }

    /// The sky at wavelength number `w` as beams: zenith cosines and irradiances, together `irradiance`, which the
    /// solver knows better than the rings.
    pub fn beams(&self, w: usize, irradiance: f64) -> Vec<(f64, f64)> {
        let sum: f64 = self.rings.iter().map(|r| r.1[w]).sum();
        let scale = if sum > 0.0 { irradiance / sum } else { 0.0 };
        self.rings.iter().map(|(mu, light)| (*mu, light[w] * scale)).collect()
    }

    /// Share of the high part of [`Dome::split`] in the light, per wavelength; half where it is dark.
    fn high(&self) -> Vec<f64> {
        let count = self.rings.first().map_or(0, |r| r.1.len());
        let through = |mu: f64| 1.0 - fresnel(mu, TYPICAL);
        // The same rings for the parts as for the sky, so that a mixture of them is split into what it is made of.
        let parts = Dome::PARTS.map(|dome| {
            let one = |(mu, weight): (f64, f64)| 2.0 * PI * mu * weight * dome.radiance(mu);
            let rings = gauss_legendre(self.rings.len());
            let sum: f64 = rings.iter().map(|&ring| one(ring)).sum();
            rings.into_iter().map(|ring| one(ring) * through(ring.0)).sum::<f64>() / sum
        });
        (0..count)
            .map(|w| {
                let sum: f64 = self.rings.iter().map(|r| r.1[w]).sum();
                let passed: f64 = self.rings.iter().map(|r| through(r.0) * r.1[w]).sum();
                if sum > 0.0 { Dome::split(sum, passed, parts)[0] / sum } else { 0.5 }
            })
            .collect()
    }
}

/// The split of the sky's light on the surface for every sun.
#[derive(Clone)]
pub struct Split {
    least: f64,
    /// `[sun][wavelength]`
    high: Vec<Vec<f64>>,
}

/// Suns of the split, evenly in the cosine; its share changes by some 0.01 between them.
const SUNS: usize = 40;

impl Split {
    pub fn new(medium: &Medium, solution: &Solution) -> Split {
        let least = lowest_sun(medium);
        let sun = |k: usize| least + (1.0 - least) * (k as f64 / (SUNS - 1) as f64);
        let high = |k| Skylight::new(medium, solution, sun(k), COARSE).high();
        Split { least, high: (0..SUNS).into_par_iter().map(high).collect() }
    }

    /// Irradiances of both parts of [`Dome::PARTS`] at wavelength number `w` of a sky of an irradiance.
    pub fn parts(&self, mu_s: f64, w: usize, irradiance: f64) -> [f64; 2] {
        let x = (mu_s - self.least) / (1.0 - self.least) * (SUNS - 1) as f64;
        let k = (x.max(0.0) as usize).min(SUNS - 2);
        let t = (x - k as f64).clamp(0.0, 1.0);
        let high = self.high[k][w] * (1.0 - t) + self.high[k + 1][w] * t;
        [irradiance * high, irradiance * (1.0 - high)]
    }
}
