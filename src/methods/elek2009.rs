//! Elek 2009, "Rendering parametrizable planetary atmospheres with multiple scattering in real-time": light scattered any
//! number of times in 3D tables of altitude, view and sun; the azimuth comes back by the phase function alone, which is
//! put on all light, however often it was scattered.
//!
//! A table for each distinct phase function p, three wavelengths, halves: light scattered once without its phase
//! function, plus 4π times the azimuth mean of the rest, so that p = 1/4π gives that mean back. Axes are those of Elek &
//! Kmoch 2010 without azimuth. The tables are filled by this project's solver, all orders: what is left is the error of
//! three axes and three wavelengths. Ground light as there: direct and diffuse.

use super::air::{Air, Rgb, WAVELENGTHS_NM, on_ray, through};
use super::columns::SunDepth;
use super::texture::{TEXEL, to_halves};
use super::{Family, Method, Prepared, PreparedSky};
use crate::error::Result;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::layout::compact::groups;
use crate::machine::lanes::Lanes;
use crate::mapping::{Array, Elek2010, texel};
use crate::medium::{Medium, PhaseFunction};
use crate::preset::Planet;
use crate::transport::azimuth::midpoint_azimuths;
use crate::transport::fill::{RayIntegrator, RayLight, SunPairs, Wanted};
use crate::transport::solve::{Orders, Resolution, Solution};
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_PI, PI};

/// Texels of altitude, view and sun.
pub struct Elek2009 {
    pub size: [usize; 3],
}

/// Azimuths whose mean is stored.
const AZIMUTHS: usize = 6;
/// Texels of the diffuse irradiance of the ground.
const AMBIENT_SIZE: usize = 256;

impl Method for Elek2009 {
    fn family(&self) -> Family {
        Family::Elek2009
    }

    fn setting(&self) -> String {
        let [x, y, z] = self.size;
        format!("{x}×{y}×{z}")
    }

    fn prepare(&self, planet: &Planet) -> Result<Prepared> {
        Ok(Prepared::timed(|| Sky::new(planet, self.size)))
    }
}

struct Sky {
    air: Air,
    map: Elek2010,
    /// A table of RGB a phase function, over `[altitude, view, sun]`.
    tables: Vec<(PhaseLaws, Array<Rgb, 3>)>,
    sun_depth: SunDepth,
    /// Diffuse irradiance of the ground over the star's, on the sun axis.
    ambient: Array<Rgb, 1>,
}

/// A phase function at the three wavelengths.
type PhaseLaws = [PhaseFunction; 3];

impl Sky {
    fn new(planet: &Planet, size: [usize; 3]) -> Self {
        let medium = planet.medium(&WAVELENGTHS_NM);
        let solution = Solution::new(
            &medium,
            &Resolution::TABLES,
            Orders::Converged { tolerance: crate::layout::settings::TOLERANCE },
        );
        let [altitudes, views, suns] = size;
        let map = Elek2010::new(medium.ground_radius, medium.top_radius, [altitudes, views, suns, 2]);
        let map = map.expect("sizes are this project's own");
        let air = Air::new(planet);
        let sun_depth = SunDepth::new(&air);
        let long = map.resized([altitudes, views, AMBIENT_SIZE, 2]).expect("a valid size");
        let ambient = Array::fill([AMBIENT_SIZE], |[k]| {
            let light = solution.ground_irradiance(long.mu_s(k));
            std::array::from_fn(|c| light[c])
        });
        let tables = fill(&medium, &solution, &map, &air);
        Sky { air, map, tables, sun_depth, ambient }
    }

    /// Transmittance of a way to the ground.
    fn seen(&self, view: &View, altitude: f64) -> Rgb {
        let end = on_ray(view, altitude, self.air.length(view.r, view.mu, true));
        let depth = |altitude: f64, mu: f64| self.sun_depth.depth(altitude, mu);
        let (whole, behind) = (depth(0.0, -end.mu), depth(altitude, -view.mu));
        through(std::array::from_fn(|c| whole[c] - behind[c]))
    }

    fn ground(&self, end_mu_s: f64, seen: Rgb) -> Rgb {
        let place = super::air::OnRay { altitude: 0.0, r: self.air.ground_radius, mu: 0.0, mu_s: end_mu_s };
        let direct = self.air.ground(self.sun_depth.sunlight(&place), end_mu_s);
        let diffuse = match self.map.sun_coordinate(end_mu_s) {
            Some(x) => self.ambient.interpolate(&[texel(x, AMBIENT_SIZE)]),
            None => [0.0; 3],
        };
        std::array::from_fn(|c| seen[c] * (direct[c] + self.air.albedo[c] * FRAC_1_PI * diffuse[c]))
    }
}

fn fill(medium: &Medium, solution: &Solution, map: &Elek2010, air: &Air) -> Vec<(PhaseLaws, Array<Rgb, 3>)> {
    let [altitudes, views, suns, _] = map.size();
    let groups = groups(medium);
    let mu_s: Vec<f64> = (0..suns).map(|k| map.mu_s(k)).collect();
    let pairs = SunPairs::new(&mu_s, &midpoint_azimuths(AZIMUTHS));
    // Three wavelengths are one batch.
    let batch = &solution.batches[0];
    let painter = RayIntegrator::new(solution, batch, &groups);
    let each = groups.len() * suns;
    let mut rays = vec![[0.0; 3]; altitudes * views * each];
    rays.par_chunks_mut(each.max(1)).enumerate().for_each_init(RayLight::default, |light, (ray, out)| {
        let altitude = map.inner_altitude(ray / views);
        let (mu, hits_ground) = map.mu(altitude, ray % views);
        painter.ray(medium.ground_radius + altitude, mu, hits_ground, &pairs, Wanted::Both, light);
        for (n, texel) in out.iter_mut().enumerate() {
            let at = n * AZIMUTHS..(n + 1) * AZIMUTHS;
            let mean = |light: &[Lanes], c: usize| {
                light[at.clone()].iter().map(|v| f64::from(v[c])).sum::<f64>() / AZIMUTHS as f64
            };
            let sum = |c: usize| mean(&light.single, c) + 4.0 * PI * mean(&light.multiple, c);
            *texel = air.colour(std::array::from_fn(sum));
        }
    });
    let table = |g: usize| {
        let at = |[i, j, k]: [usize; 3]| rays[(i * views + j) * each + g * suns + k];
        let mut table = Array::fill([altitudes, views, suns], at);
        to_halves(&mut table);
        table
    };
    let law = |g: usize| std::array::from_fn(|w| medium.constituents[groups[g][0]].phase[w].clone());
    (0..groups.len()).map(|g| (law(g), table(g))).collect()
}

impl PreparedSky for Sky {
    fn radiance(&self, point: &Point) -> Rgb {
        let Some(view) = self.air.enter(point) else { return [0.0; 3] };
        let altitude = self.air.altitude(point);
        let mut out = [0.0; 3];
        if let Some([sun, _]) = self.map.sun_texels(view.mu_s, 1.0) {
            let [altitudes, ..] = self.map.size();
            let place = [
                texel(self.map.altitude_coordinate(altitude), altitudes),
                self.map.view_texel(altitude, view.mu, view.hits_ground),
                sun,
            ];
            for (laws, table) in &self.tables {
                let light = table.interpolate(&place);
                (0..3).for_each(|c| out[c] += light[c] * laws[c].value(view.nu));
            }
        }
        if view.hits_ground {
            let length = self.air.length(view.r, view.mu, true);
            let ground = self
                .air
                .colour(self.ground(on_ray(&view, altitude, length).mu_s, self.seen(&view, altitude)));
            (0..3).for_each(|c| out[c] += ground[c]);
        }
        out
    }

    fn bytes(&self) -> usize {
        let table = |t: &(PhaseLaws, Array<Rgb, 3>)| t.1.values().len();
        let planes = self.sun_depth.texels() + AMBIENT_SIZE;
        (self.tables.iter().map(table).sum::<usize>() + planes) * TEXEL
    }

    fn fetches(&self, point: &Point) -> usize {
        // Phase functions are formulas; ground: depths of the way to it and towards the sun, and ambient light.
        let ground = |v: View| if v.hits_ground { 4 } else { 0 };
        self.air.enter(point).map_or(0, |v| self.tables.len() + ground(v))
    }
}
