//! Views drawn at random from a stated range, as a camera there would meet them.

use crate::geometry::Point;
use crate::mapping::{Views, Window};
use sobol_burley::sample;

/// Share of the views from inside the air that lie close to the horizon: a twelfth of the sphere, where most of a
/// picture's detail is.
const HORIZON: f64 = 0.25;
/// Lowest sun of scopes that do not state one, degrees: nautical twilight ends there.
pub(super) const LOWEST_SUN: f64 = -12.0;
/// How close, degrees.
const CLOSE: f64 = 5.0;

/// Where observers, suns and views may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scope {
    /// Altitudes of observers, m; they may be above the air.
    pub altitudes: [f64; 2],
    /// Elevations of the sun over the observer's horizontal, degrees.
    pub suns: [f64; 2],
    /// Elevations of the view, degrees.
    pub elevations: [f64; 2],
    /// Azimuths between view and sun, degrees, 0 to 180.
    pub azimuths: [f64; 2],
    /// Views that meet the ground are left out.
    pub sky_only: bool,
}

impl Scope {
    /// All that a window's tables hold, for a shell between two radii, m.
    pub fn of_window(window: &Window, ground: f64, top: f64) -> Scope {
        Scope {
            altitudes: window.altitudes.unwrap_or([0.0, top - ground]),
            suns: window.suns.unwrap_or([LOWEST_SUN, 90.0]),
            elevations: [-90.0, 90.0],
            azimuths: [0.0, 180.0],
            sky_only: window.views == Views::Sky,
        }
    }

    /// `count` views, even in altitude, sun and azimuth and over the solid angle, but that a quarter of those from inside
    /// the air are close to the horizon; from outside even over the disc of the shell. Another `seed` gives other
    /// views, as random to these as any (Sobol points scrambled after Owen).
    pub fn views(&self, count: usize, seed: u32, ground: f64, top: f64) -> Vec<Point> {
        let u = |k: usize, dimension: u32| f64::from(sample(k as u32, dimension, seed));
        (0..count).map(|k| self.view(std::array::from_fn(|d| u(k, d as u32)), ground, top)).collect()
    }

    fn view(&self, u: [f64; 5], ground: f64, top: f64) -> Point {
        let altitude = between(self.altitudes, u[0]);
        let mu_s = sine(between(self.suns, u[1]));
        let r = ground + altitude;
        let mu =
            if r > top { self.outside(u[2], r, [ground, top]) } else { self.inside(u[2], u[3], r, ground) };
        Point { altitude, mu, mu_s, azimuth_deg: between(self.azimuths, u[4]) }
    }

    /// Cosine of a view from inside the air.
    fn inside(&self, u: f64, which: f64, r: f64, ground: f64) -> f64 {
        let horizon = -((r - ground) * (r + ground)).max(0.0).sqrt() / r;
        // A hair above, where single precision does not see the ground.
        let least = if self.sky_only { libm::asin(horizon).to_degrees() + 1e-3 } else { -90.0 };
        let ends = self.elevations.map(|e| e.max(least));
        if which >= HORIZON {
            return between(ends.map(sine), u);
        }
        let middle = libm::asin(horizon).to_degrees();
        let close = [middle - CLOSE, middle + CLOSE].map(|e| e.clamp(ends[0], ends[1]));
        sine(between(close, u))
    }

    /// Cosine of a view from outside that meets the shell (or, of the sky alone, passes the planet).
    fn outside(&self, u: f64, r: f64, [ground, top]: [f64; 2]) -> f64 {
        // Even in the square of the distance at which the ray passes the centre; just inside the shell's edge, where a
        // ray has some length.
        let square = |elevation: f64| 1.0 - sine(elevation) * sine(elevation);
        let [disc, whole] = [(ground / r) * (ground / r), (top / r) * (top / r)];
        let least = if self.sky_only { disc * (1.0 + 1e-9) } else { 0.0 };
        // In air so thin that those are on the planet's disc, half of what is seen of the shell beside it.
        let most = (0.998 * whole).max(disc + 0.5 * (whole - disc)).max(least);
        let ends = self.elevations.map(|e| square(e.min(0.0)).clamp(least, most));
        -(1.0 - between(ends, u)).sqrt()
    }
}

fn between([low, high]: [f64; 2], u: f64) -> f64 {
    low + (high - low) * u
}

fn sine(degrees: f64) -> f64 {
    libm::sin(degrees.to_radians())
}

#[cfg(test)]
mod tests {
    use super::*;

    const GROUND: f64 = 1000e3;
    const TOP: f64 = 1100e3;

    /// Every view has its altitude, sun, elevation and azimuth in range, from inside and from outside; those of the sky
    /// alone miss the planet, and those from outside meet the shell.
    #[test]
    fn views_lie_in_their_scope() {
        let scope = Scope {
            altitudes: [20e3, 300e3],
            suns: [-7.0, 31.0],
            elevations: [-80.0, 40.0],
            azimuths: [20.0, 90.0],
            sky_only: true,
        };
        let views = scope.views(800, 3, GROUND, TOP);
        for p in &views {
            let degrees = |cosine: f64| libm::asin(cosine).to_degrees();
            assert!((20e3..=300e3).contains(&p.altitude) && (20.0..=90.0).contains(&p.azimuth_deg));
            assert!(
                (-7.001..=31.001).contains(&degrees(p.mu_s)) && (-80.001..=40.001).contains(&degrees(p.mu))
            );
            let across = (GROUND + p.altitude) * (1.0 - p.mu * p.mu).sqrt();
            assert!(p.mu > 0.0 || across > GROUND, "{p:?}");
            assert!(p.altitude <= 100e3 || (p.mu < 0.0 && across < TOP), "{p:?}");
        }
        assert_ne!(views, scope.views(800, 4, GROUND, TOP));
    }

    /// One altitude and one sun stay what they are.
    #[test]
    fn ranges_without_extent() {
        let scope = Scope {
            altitudes: [2.0; 2],
            suns: [35.0; 2],
            elevations: [-90.0, 90.0],
            azimuths: [0.0, 180.0],
            sky_only: false,
        };
        let views = scope.views(200, 1, GROUND, TOP);
        assert!(views.iter().all(|p| p.altitude == 2.0 && p.mu_s == libm::sin(35.0_f64.to_radians())));
        let close = views.iter().filter(|p| p.mu.abs() < 0.1).count();
        assert!((50..90).contains(&close), "a quarter and a tenth of the rest: {close}");
    }
}
