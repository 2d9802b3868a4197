//! Optical depth to the top, finely tabulated: what the older methods' own nested marches towards the sun come to when
//! they are run with many steps, as preparing a table allows.

use super::air::{Air, OnRay, Rgb};
use crate::algorithm1::altitude_along;
use crate::mapping::{Array, Elek2010, texel};

/// Texels of altitude and distance to the top.
const SIZE: [usize; 2] = [96, 192];
/// Intervals of the quadrature of a column; even, for Simpson's rule.
const INTERVALS: usize = 128;

pub(super) struct SunDepth {
    map: Elek2010,
    depths: Array<Rgb, 2>,
}

impl SunDepth {
    pub(super) fn new(air: &Air) -> Self {
        let map = Elek2010::new(air.ground_radius, air.top_radius, [SIZE[0], 2 * SIZE[1], 2, 2]);
        let map = map.expect("a planet that was read has a shell");
        let depths = Array::fill(SIZE, |[i, j]| {
            let altitude = map.altitude(i);
            let (mu, _) = map.mu(altitude, SIZE[1] + j);
            depth(air, altitude, mu, map.distance(altitude, mu, false))
        });
        SunDepth { map, depths }
    }

    /// Transmittance towards a sun; 0 behind the planet.
    pub(super) fn sunlight(&self, place: &OnRay) -> Rgb {
        if self.map.hits_ground(place.altitude, place.mu_s) {
            return [0.0; 3];
        }
        super::air::through(self.depth(place.altitude, place.mu_s))
    }

    /// Optical depth to the top in a direction that leaves.
    pub(super) fn depth(&self, altitude: f64, mu: f64) -> Rgb {
        let at = [
            texel(self.map.altitude_coordinate(altitude), SIZE[0]),
            texel(self.map.view_coordinate(altitude, mu, false), SIZE[1]),
        ];
        self.depths.interpolate(&at)
    }

    pub(super) fn texels(&self) -> usize {
        self.depths.values().len()
    }
}

/// Optical depth of a ray that leaves: both ways from its lowest point.
fn depth(air: &Air, altitude: f64, mu: f64, length: f64) -> Rgb {
    let r = air.ground_radius + altitude;
    if mu >= 0.0 {
        return rising(air, altitude, mu, length);
    }
    let to_lowest = -r * mu;
    let lowest = altitude_along(r, altitude, mu, to_lowest).max(0.0);
    let parts = [to_lowest, length - to_lowest].map(|length| rising(air, lowest, 0.0, length));
    std::array::from_fn(|c| parts[0][c] + parts[1][c])
}

/// The same upwards, by Simpson's rule in t with s = length · t², dense at the low end.
fn rising(air: &Air, altitude: f64, mu: f64, length: f64) -> Rgb {
    let mut columns = vec![0.0; air.parts.len()];
    for k in 0..=INTERVALS {
        let t = k as f64 / INTERVALS as f64;
        let ends = if k == 0 || k == INTERVALS { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
        let weight = ends * 2.0 * length * t / (3.0 * INTERVALS as f64);
        let there = altitude_along(air.ground_radius + altitude, altitude, mu, length * t * t);
        for (column, density) in columns.iter_mut().zip(air.densities(there.max(0.0))) {
            *column += weight * density;
        }
    }
    air.depth(&columns)
}
