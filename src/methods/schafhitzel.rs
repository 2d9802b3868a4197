//! Schafhitzel, Falk & Ertl 2007, "Real-time rendering of planets with atmospheres": light scattered once, phase function
//! included, in a 3D table of altitude, sun and view.
//!
//! Altitude is even, both angles are even in their cosines (their pseudo code's MapToUnit). View and sun lie in one plane
//! through the zenith when the table is filled, the sun on the side looked at; there is no axis of azimuth. The ground is
//! lit and seen through O'Neil's 2D table (their §4.2); the factor K F_r / λ⁴ in their Eqs. 9 and 10, which belongs to
//! scattering, is left out.

use super::air::{Air, Rgb, on_ray, through};
use super::columns::SunDepth;
use super::oneil::DepthTable;
use super::texture::{TEXEL, to_halves};
use super::{Family, Method, Prepared, PreparedSky};
use crate::error::Result;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::mapping::{Array, texel};
use crate::preset::Planet;

/// Texels of altitude, sun and view; 128 each were published.
pub struct Schafhitzel {
    pub size: [usize; 3],
}

/// Steps along each view while the table is filled ("can be set very high").
const STEPS: usize = 50;
/// Texels of the table of optical depth.
const DEPTH_SIZE: [usize; 2] = [256, 256];

impl Method for Schafhitzel {
    fn family(&self) -> Family {
        Family::Schafhitzel2007
    }

    fn setting(&self) -> String {
        let [x, y, z] = self.size;
        format!("{x}×{y}×{z}")
    }

    fn prepare(&self, planet: &Planet) -> Result<Prepared> {
        Ok(Prepared::timed(|| {
            let air = Air::new(planet);
            let mut table = fill(&air, self.size);
            to_halves(&mut table);
            let depth = DepthTable::new(&air, DEPTH_SIZE);
            Sky { air, table, depth }
        }))
    }
}

/// Cosine of texel `k` of `count`.
fn cosine(k: usize, count: usize) -> f64 {
    2.0 * k as f64 / (count - 1) as f64 - 1.0
}

/// RGB over `[altitude, view, sun]`.
fn fill(air: &Air, [altitudes, suns, views]: [usize; 3]) -> Array<Rgb, 3> {
    let sun_depth = SunDepth::new(air);
    let mut table = Array::zero([altitudes, views, suns]);
    table.for_each_slab(|i, slab| {
        let altitude = air.height() * i as f64 / (altitudes - 1) as f64;
        for (j, row) in slab.chunks_exact_mut(suns).enumerate() {
            let (r, mu) = (air.ground_radius + altitude, cosine(j, views));
            let hits_ground = air.is_blocked(r, mu);
            let ray = Ray::new(air, View { r, mu, mu_s: 1.0, nu: mu, hits_ground }, altitude);
            for (k, texel) in row.iter_mut().enumerate() {
                let mu_s = cosine(k, suns);
                let nu = mu * mu_s + ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).sqrt();
                *texel = air.colour(ray.light(air, &sun_depth, mu_s, nu));
            }
        }
    });
    table
}

/// What all suns of a view share.
struct Ray {
    view: View,
    altitude: f64,
    step: f64,
    /// `[step][part]`: density, and transmittance to the start.
    densities: Vec<f64>,
    seen: Vec<Rgb>,
}

impl Ray {
    fn new(air: &Air, view: View, altitude: f64) -> Self {
        let step = air.length(view.r, view.mu, view.hits_ground) / STEPS as f64;
        let (mut densities, mut seen, mut passed) = (Vec::new(), Vec::new(), vec![0.0; air.parts.len()]);
        for k in 0..STEPS {
            let here: Vec<f64> =
                air.densities(on_ray(&view, altitude, (k as f64 + 0.5) * step).altitude).collect();
            passed.iter_mut().zip(&here).for_each(|(p, d)| *p += 0.5 * step * d);
            seen.push(through(air.depth(&passed)));
            passed.iter_mut().zip(&here).for_each(|(p, d)| *p += 0.5 * step * d);
            densities.extend(here);
        }
        Ray { view, altitude, step, densities, seen }
    }

    fn light(&self, air: &Air, sun_depth: &SunDepth, mu_s: f64, nu: f64) -> Rgb {
        let view = View { mu_s, nu, ..self.view };
        let parts = air.parts.len();
        let mut scattered = vec![[0.0; 3]; parts];
        for k in 0..STEPS {
            let sun = sun_depth.sunlight(&on_ray(&view, self.altitude, (k as f64 + 0.5) * self.step));
            for (sum, density) in scattered.iter_mut().zip(&self.densities[k * parts..]) {
                (0..3).for_each(|c| sum[c] += density * self.seen[k][c] * sun[c] * self.step);
            }
        }
        let mut out = [0.0; 3];
        for (part, sum) in air.parts.iter().zip(&scattered) {
            let phase = part.phase(nu);
            (0..3).for_each(|c| out[c] += part.scattering[c] * phase[c] * sum[c]);
        }
        out
    }
}

struct Sky {
    air: Air,
    table: Array<Rgb, 3>,
    depth: DepthTable,
}

impl Sky {
    /// Sunlight off the ground that arrives: the depth of the way is that from the ground to the top, less what of that
    /// lies behind the observer.
    fn ground(&self, view: &View, altitude: f64) -> Rgb {
        let air = &self.air;
        let end = on_ray(view, altitude, air.length(view.r, view.mu, true));
        let depth = |altitude: f64, mu: f64| {
            let (mut densities, mut columns) = (Vec::new(), Vec::new());
            self.depth.read(altitude, mu, &mut densities, &mut columns);
            air.depth(&columns)
        };
        let [whole, behind, sun] = [depth(0.0, -end.mu), depth(altitude, -view.mu), depth(0.0, end.mu_s)];
        let light = air.ground(through(sun), end.mu_s);
        std::array::from_fn(|c| light[c] * libm::exp(behind[c] - whole[c]))
    }
}

impl PreparedSky for Sky {
    fn radiance(&self, point: &Point) -> Rgb {
        let Some(view) = self.air.enter(point) else { return [0.0; 3] };
        let altitude = self.air.altitude(point);
        let [altitudes, views, suns] = self.table.shape();
        let place = [
            texel(altitude / self.air.height(), altitudes),
            texel(0.5 * (1.0 + view.mu), views),
            texel(0.5 * (1.0 + view.mu_s), suns),
        ];
        let mut out = self.table.interpolate(&place);
        if view.hits_ground {
            let ground = self.air.colour(self.ground(&view, altitude));
            (0..3).for_each(|c| out[c] += ground[c]);
        }
        out
    }

    fn bytes(&self) -> usize {
        self.table.values().len() * TEXEL + self.depth.bytes()
    }

    fn fetches(&self, point: &Point) -> usize {
        let ground = |v: View| if v.hits_ground { 3 * self.depth.fetches() } else { 0 };
        self.air.enter(point).map_or(0, |v| 1 + ground(v))
    }
}
