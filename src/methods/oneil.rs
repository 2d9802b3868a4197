//! O'Neil's 2D table (2004) as the 2022 article fills it: against altitude and the cosine of the zenith angle, both even,
//! the density of each constituent and its column to the top; a ray that meets the planet has a column of 1e20.
//!
//! Single precision, texel centres at the ends of both axes. That the filter mixes 1e20 with its neighbours next to the
//! horizon is the method's own.

use super::air::{Air, OnRay};
use super::march::march_columns;
use crate::mapping::texel;
use rayon::prelude::*;

/// A column that lets nothing through, m.
const BLOCKED: f32 = 1e20;
/// Steps of the march of each column.
const STEPS: usize = 500;

pub(super) struct DepthTable {
    height: f64,
    parts: usize,
    /// `[altitude][zenith angle][part]`: density and column, m.
    texels: Vec<[f32; 2]>,
    size: [usize; 2],
}

impl DepthTable {
    pub(super) fn new(air: &Air, size: [usize; 2]) -> Self {
        let parts = air.parts.len();
        let [altitudes, angles] = size;
        let texel = |n: usize| {
            let altitude = air.height() * (n / angles) as f64 / (altitudes - 1) as f64;
            let mu = 2.0 * (n % angles) as f64 / (angles - 1) as f64 - 1.0;
            let place = OnRay { altitude, r: air.ground_radius + altitude, mu, mu_s: mu };
            let mut columns = vec![0.0; parts];
            let blocked = air.is_blocked(place.r, mu);
            if !blocked {
                march_columns(air, &place, STEPS, &mut columns);
            }
            let column = |c: f64| if blocked { BLOCKED } else { c as f32 };
            let pair = air.densities(altitude).zip(columns);
            pair.map(|(density, c)| [density as f32, column(c)]).collect::<Vec<_>>()
        };
        let texels = (0..altitudes * angles).into_par_iter().flat_map_iter(texel).collect();
        DepthTable { height: air.height(), parts, texels, size }
    }

    /// Adds to the lists densities, and columns to the top in a direction, one a part.
    pub(super) fn read(&self, altitude: f64, mu: f64, densities: &mut Vec<f64>, columns: &mut Vec<f64>) {
        let (i, x) = texel(altitude / self.height, self.size[0]);
        let (j, y) = texel(0.5 * (1.0 + mu), self.size[1]);
        let row = self.size[1] * self.parts;
        let corner = i * row + j * self.parts;
        for part in corner..corner + self.parts {
            let [low, high] = [part, part + row].map(|n| (self.texels[n], self.texels[n + self.parts]));
            let mix = |k: usize| {
                let along = |(a, b): ([f32; 2], [f32; 2])| f64::from(a[k]) * (1.0 - y) + f64::from(b[k]) * y;
                along(low) * (1.0 - x) + along(high) * x
            };
            densities.push(mix(0));
            columns.push(mix(1));
        }
    }

    /// Density and column of each part, as 32-bit floats.
    pub(super) fn bytes(&self) -> usize {
        self.texels.len() * 2 * 4
    }

    /// Textures of four channels that hold them.
    pub(super) fn fetches(&self) -> usize {
        (2 * self.parts).div_ceil(4)
    }
}
