//! Light scattered once, marched at every look-up: Nishita et al. 1993 by brute force, with a second march towards the
//! sun at every step, and with O'Neil's 2D table in place of that (as the 2022 article does both).
//!
//! Steps are even and sampled in their middles. Light of the ground is direct sunlight; nothing is scattered twice.

use super::air::{Air, OnRay, Rgb, on_ray, through};
use super::oneil::DepthTable;
use super::{Family, Method, Prepared, PreparedSky};
use crate::error::Result;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::preset::Planet;

/// Brute force: so many steps along the view, and towards the sun at each.
pub struct Nishita {
    pub steps: usize,
    pub sun_steps: usize,
}

/// The same with a 2D table of optical depth, texels of altitude and zenith angle.
pub struct OneilMarch {
    pub steps: usize,
    pub size: [usize; 2],
}

impl Method for Nishita {
    fn family(&self) -> Family {
        Family::Nishita1993
    }

    fn setting(&self) -> String {
        format!("{} × {} steps", self.steps, self.sun_steps)
    }

    fn prepare(&self, planet: &Planet) -> Result<Prepared> {
        let (steps, sun_steps) = (self.steps, self.sun_steps);
        Ok(Prepared::timed(|| March { air: Air::new(planet), steps, sun: Sun::Marched(sun_steps) }))
    }
}

impl Method for OneilMarch {
    fn family(&self) -> Family {
        Family::Oneil2004
    }

    fn setting(&self) -> String {
        format!("{} steps, table {}×{}", self.steps, self.size[0], self.size[1])
    }

    fn prepare(&self, planet: &Planet) -> Result<Prepared> {
        let (steps, size) = (self.steps, self.size);
        Ok(Prepared::timed(|| {
            let air = Air::new(planet);
            let sun = Sun::Tabled(DepthTable::new(&air, size));
            March { air, steps, sun }
        }))
    }
}

/// Where columns towards the sun come from.
enum Sun {
    Marched(usize),
    Tabled(DepthTable),
}

struct March {
    air: Air,
    steps: usize,
    sun: Sun,
}

impl March {
    /// Densities at a place, and transmittance towards the sun.
    fn sample(&self, place: &OnRay, densities: &mut Vec<f64>, columns: &mut Vec<f64>) -> Rgb {
        densities.clear();
        columns.clear();
        match &self.sun {
            Sun::Tabled(table) => table.read(place.altitude, place.mu_s, densities, columns),
            Sun::Marched(steps) => {
                densities.extend(self.air.densities(place.altitude));
                columns.resize(self.air.parts.len(), 0.0);
                if self.air.is_blocked(place.r, place.mu_s) {
                    return [0.0; 3];
                }
                march_columns(&self.air, place, *steps, columns);
            }
        }
        through(self.air.depth(columns))
    }

    /// Radiance of a view from inside the shell, over the star's irradiance at the three wavelengths, 1/sr.
    fn light(&self, view: &View, altitude: f64) -> Rgb {
        let air = &self.air;
        let length = air.length(view.r, view.mu, view.hits_ground);
        let step = length / self.steps as f64;
        let (mut densities, mut to_sun) = (Vec::new(), Vec::new());
        let mut passed = vec![0.0; air.parts.len()];
        let mut scattered = vec![[0.0; 3]; air.parts.len()];
        for k in 0..self.steps {
            let place = on_ray(view, altitude, (k as f64 + 0.5) * step);
            let sun = self.sample(&place, &mut densities, &mut to_sun);
            passed.iter_mut().zip(&densities).for_each(|(p, d)| *p += 0.5 * step * d);
            let seen = through(air.depth(&passed));
            passed.iter_mut().zip(&densities).for_each(|(p, d)| *p += 0.5 * step * d);
            for (sum, density) in scattered.iter_mut().zip(&densities) {
                (0..3).for_each(|c| sum[c] += density * seen[c] * sun[c] * step);
            }
        }
        let mut out = [0.0; 3];
        for (part, sum) in air.parts.iter().zip(&scattered) {
            let phase = part.phase(view.nu);
            (0..3).for_each(|c| out[c] += part.scattering[c] * phase[c] * sum[c]);
        }
        if view.hits_ground {
            let ground = on_ray(view, altitude, length);
            let ground = OnRay { altitude: 0.0, r: air.ground_radius, ..ground };
            let sun =
                if ground.mu_s > 0.0 { self.sample(&ground, &mut densities, &mut to_sun) } else { [0.0; 3] };
            let (light, seen) = (air.ground(sun, ground.mu_s), through(air.depth(&passed)));
            (0..3).for_each(|c| out[c] += light[c] * seen[c]);
        }
        out
    }
}

/// Columns to the top in a direction, one a part, m.
pub(super) fn march_columns(air: &Air, place: &OnRay, steps: usize, columns: &mut [f64]) {
    let sunward = View { r: place.r, mu: place.mu_s, mu_s: 0.0, nu: 0.0, hits_ground: false };
    let step = air.length(place.r, place.mu_s, false) / steps as f64;
    for k in 0..steps {
        let there = on_ray(&sunward, place.altitude, (k as f64 + 0.5) * step);
        for (column, density) in columns.iter_mut().zip(air.densities(there.altitude)) {
            *column += density * step;
        }
    }
}

impl PreparedSky for March {
    fn radiance(&self, point: &Point) -> Rgb {
        let Some(view) = self.air.enter(point) else { return [0.0; 3] };
        self.air.colour(self.light(&view, self.air.altitude(point)))
    }

    fn bytes(&self) -> usize {
        match &self.sun {
            Sun::Marched(_) => 0,
            Sun::Tabled(table) => table.bytes(),
        }
    }

    fn fetches(&self, point: &Point) -> usize {
        match (&self.sun, self.air.enter(point)) {
            (Sun::Tabled(table), Some(view)) => {
                (self.steps + usize::from(view.hits_ground)) * table.fetches()
            }
            _ => 0,
        }
    }
}
