//! The medium as the older methods see it: three wavelengths, and rays through a shell.

use crate::algorithm1::{altitude_along, radius_along};
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::medium::{DensityProfile, PhaseFunction};
use crate::preset::Planet;
use crate::spectrum::ColourSpace;
use std::f64::consts::FRAC_1_PI;

/// Red, green and blue, or a quantity at their wavelengths.
pub(super) type Rgb = [f64; 3];

/// Wavelengths of red, green and blue, nm (Nishita et al. 1993 and the 2022 article after it).
pub(super) const WAVELENGTHS_NM: Rgb = [680.0, 550.0, 440.0];

/// One constituent: where it is, what it removes and scatters where its density is 1, 1/m.
pub(super) struct Part {
    pub density: DensityProfile,
    pub scattering: Rgb,
    pub extinction: Rgb,
    phase: [PhaseFunction; 3],
}

impl Part {
    pub(super) fn phase(&self, nu: f64) -> Rgb {
        std::array::from_fn(|c| self.phase[c].value(nu))
    }
}

/// A planet at three wavelengths.
pub(super) struct Air {
    pub ground_radius: f64,
    pub top_radius: f64,
    pub parts: Vec<Part>,
    pub albedo: Rgb,
    /// What radiance over irradiance is multiplied by.
    weights: Rgb,
}

impl Air {
    pub(super) fn new(planet: &Planet) -> Self {
        let medium = planet.medium(&WAVELENGTHS_NM);
        let parts = medium.constituents.iter().map(|c| Part {
            density: c.density.clone(),
            scattering: std::array::from_fn(|w| c.scattering[w]),
            extinction: std::array::from_fn(|w| c.extinction(w)),
            phase: std::array::from_fn(|w| c.phase[w].clone()),
        });
        Air {
            ground_radius: medium.ground_radius,
            top_radius: medium.top_radius,
            parts: parts.collect(),
            albedo: std::array::from_fn(|w| medium.ground_albedo[w]),
            weights: weights(planet),
        }
    }

    pub(super) fn height(&self) -> f64 {
        self.top_radius - self.ground_radius
    }

    /// Linear RGB over the star's illuminance of radiance over its irradiance.
    pub(super) fn colour(&self, radiance: Rgb) -> Rgb {
        std::array::from_fn(|c| radiance[c] * self.weights[c])
    }

    /// The view where it enters the shell; none where it misses.
    pub(super) fn enter(&self, point: &Point) -> Option<View> {
        View::enter(point, self.ground_radius, self.top_radius)
    }

    /// Altitude of a view's start, m; exact where the observer is inside.
    pub(super) fn altitude(&self, point: &Point) -> f64 {
        point.altitude.min(self.height())
    }

    /// Length of a ray to the ground or to the top, m.
    pub(super) fn length(&self, r: f64, mu: f64, hits_ground: bool) -> f64 {
        let end = if hits_ground { self.ground_radius } else { self.top_radius };
        let root = (r * r * (mu * mu - 1.0) + end * end).max(0.0).sqrt();
        (if hits_ground { -r * mu - root } else { root - r * mu }).max(0.0)
    }

    /// True where a ray meets the planet.
    pub(super) fn is_blocked(&self, r: f64, mu: f64) -> bool {
        mu < 0.0 && r * r * (1.0 - mu * mu) < self.ground_radius * self.ground_radius
    }

    /// Densities of all parts at an altitude.
    pub(super) fn densities(&self, altitude: f64) -> impl Iterator<Item = f64> {
        self.parts.iter().map(move |p| p.density.at(altitude))
    }

    /// Optical depth of columns, one a part, m.
    pub(super) fn depth(&self, columns: &[f64]) -> Rgb {
        let mut depth = [0.0; 3];
        for (part, column) in self.parts.iter().zip(columns) {
            (0..3).for_each(|c| depth[c] += part.extinction[c] * column);
        }
        depth
    }

    /// Radiance of the ground under direct sunlight of transmittance `sun`: Lambert, no other light.
    pub(super) fn ground(&self, sun: Rgb, mu_s: f64) -> Rgb {
        std::array::from_fn(|c| self.albedo[c] * FRAC_1_PI * sun[c] * mu_s.max(0.0))
    }
}

/// A place on a ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnRay {
    pub altitude: f64,
    pub r: f64,
    pub mu: f64,
    pub mu_s: f64,
}

/// The place at a distance `s` along a view that starts at `altitude`.
pub(super) fn on_ray(view: &View, altitude: f64, s: f64) -> OnRay {
    let r = radius_along(view.r, view.mu, s);
    OnRay {
        altitude: altitude_along(view.r, altitude, view.mu, s).max(0.0),
        r,
        mu: ((view.r * view.mu + s) / r).clamp(-1.0, 1.0),
        mu_s: ((view.r * view.mu_s + s * view.nu) / r).clamp(-1.0, 1.0),
    }
}

/// e^−depth.
pub(super) fn through(depth: Rgb) -> Rgb {
    depth.map(|d| libm::exp(-d))
}

/// The star's irradiance at the three wavelengths, as red, green and blue whose luminance is 1: the "three constants"
/// that make radiances colours, brought to the star's illuminance.
fn weights(planet: &Planet) -> Rgb {
    let constants = WAVELENGTHS_NM.map(|nm| planet.star.irradiance.at(nm));
    let luminance = ColourSpace::Srgb.to_xyz()[1];
    let sum: f64 = (0..3).map(|c| luminance[c] * constants[c]).sum();
    constants.map(|v| v / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The article's constants 1.474, 1.8504 and 1.91198 with sRGB's luminances 0.2126, 0.7152 and 0.0722 sum to 1.7748;
    /// sunlight without air is then of luminance 1 and redder than it is blue by 1.474 : 1.91198.
    #[test]
    fn three_constants_are_the_colour_of_the_star() {
        let air = Air::new(&crate::preset::load("earth-blog", &[]).unwrap());
        let white = air.colour([1.0; 3]);
        assert!(
            (white[0] - 1.474 / 1.7748).abs() < 1e-4 && (white[2] / white[0] - 1.91198 / 1.474).abs() < 1e-9
        );
    }

    /// Straight up the length is the height of the shell, and a level ray from the ground follows Pythagoras; downwards
    /// from 10 km the ground is 10 km away.
    #[test]
    fn lengths_of_rays() {
        let air = Air::new(&crate::preset::load("mars", &[]).unwrap());
        let (g, t) = (air.ground_radius, air.top_radius);
        assert!((air.length(g, 1.0, false) - (t - g)).abs() < 1e-3);
        assert!((air.length(g, 0.0, false) - (t * t - g * g).sqrt()).abs() < 1e-3);
        assert!((air.length(g + 1e4, -1.0, true) - 1e4).abs() < 1e-3);
        assert!(
            air.is_blocked(g + 1e4, -0.5) && !air.is_blocked(g + 1e4, -0.01) && !air.is_blocked(g + 1e4, 0.2)
        );
    }
}
