//! A flat water surface: light in and out of the slab.

use super::fresnel::{fresnel, refract};
use std::f64::consts::PI;

/// A sky of unit irradiance of the surface, by its radiance against the cosine `mu` of the zenith angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dome {
    /// The same everywhere, 1/π.
    Even,
    /// In proportion to mu: 3 mu / 2π.
    High,
    /// In proportion to (1 − mu)²: 6 (1 − mu)² / π.
    Low,
}

impl Dome {
    /// The two parts that skies are made of here: no mixture of them lets less light into water than any sky of
    /// Earth's air does, which 1 − mu for the second would.
    pub const PARTS: [Dome; 2] = [Dome::High, Dome::Low];

    /// Radiance, 1/sr.
    pub fn radiance(self, mu: f64) -> f64 {
        match self {
            Dome::Even => 1.0 / PI,
            Dome::High => 1.5 * mu / PI,
            Dome::Low => 6.0 * (1.0 - mu) * (1.0 - mu) / PI,
        }
    }

    /// Irradiances of both parts that together have the irradiance of a sky and of which as much gets through a
    /// surface, `passed`; `parts` is what does of each. None is below 0, where the sum is kept.
    pub fn split(irradiance: f64, passed: f64, parts: [f64; 2]) -> [f64; 2] {
        let high = (passed - irradiance * parts[1]) / (parts[0] - parts[1]);
        let high = high.clamp(0.0, irradiance.max(0.0));
        [high, irradiance.max(0.0) - high]
    }
}

/// A surface between air and a medium of refractive index `n`; 1 is no surface at all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    pub n: f64,
}

impl Surface {
    /// Cosine in the water of a ray of cosine `mu` in the air.
    pub fn cosine_in_water(&self, mu: f64) -> f64 {
        // n ≥ 1: every ray finds its way in.
        refract(mu, self.n).unwrap_or(mu)
    }

    /// Cosine in the water beyond which nothing leaves, √(1 − 1/n²).
    pub fn critical(&self) -> f64 {
        (1.0 - 1.0 / (self.n * self.n)).max(0.0).sqrt()
    }

    /// Share of light on its way up that the underside reflects: 1 beyond the critical angle.
    pub fn reflects_down(&self, mu_water: f64) -> f64 {
        fresnel(mu_water, 1.0 / self.n)
    }

    /// Irradiance on a plane normal to the refracted beam, just below the surface, over that normal to the sun's
    /// beam above: (1 − F) mu_a / mu_w; 0 for a sun at or below the horizon.
    pub fn sun_in_water(&self, mu_s: f64) -> f64 {
        if mu_s <= 0.0 {
            return 0.0;
        }
        (1.0 - fresnel(mu_s, self.n)) * mu_s / self.cosine_in_water(mu_s)
    }

    /// Radiance above the surface over that below it along a ray that leaves at cosine `mu` in the air:
    /// (1 − F) / n².
    pub fn leaves(&self, mu: f64) -> f64 {
        (1.0 - fresnel(mu, self.n)) / (self.n * self.n)
    }

    /// Radiance below the surface of a sky: (1 − F) n² of that above along the refracted ray inside Snell's
    /// window, 0 outside.
    pub fn sky_in_water(&self, dome: Dome, mu_water: f64) -> f64 {
        let Some(above) = refract(mu_water, 1.0 / self.n) else { return 0.0 };
        (1.0 - self.reflects_down(mu_water)) * self.n * self.n * dome.radiance(above)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Energy: the sun's flux through the surface is what Fresnel lets pass, and an even sky brings as much
    /// through Snell's window as the hemisphere's mean transmittance lets in.
    #[test]
    fn what_passes_is_conserved() {
        let s = Surface { n: 1.4 };
        let passed = s.sun_in_water(0.6) * s.cosine_in_water(0.6);
        assert!((passed - 0.6 * (1.0 - fresnel(0.6, 1.4))).abs() < 1e-15);
        const STEPS: usize = 200_000;
        let step = 1.0 / STEPS as f64;
        for dome in [Dome::Even, Dome::High, Dome::Low] {
            let (mut all, mut above, mut below) = (0.0, 0.0, 0.0);
            for k in 0..STEPS {
                let mu = (k as f64 + 0.5) * step;
                let light = 2.0 * PI * mu * dome.radiance(mu) * step;
                all += light;
                above += light * (1.0 - fresnel(mu, 1.4));
                below += 2.0 * PI * mu * s.sky_in_water(dome, mu) * step;
            }
            assert!(
                (all - 1.0).abs() < 1e-9 && (above - below).abs() < 1e-4,
                "{dome:?} {all} {above} {below}"
            );
        }
        assert_eq!(s.sun_in_water(-0.1), 0.0);
        assert!((Surface { n: 1.0 }.sun_in_water(0.3) - 1.0).abs() < 1e-14);
    }

    /// A sky that is a mixture of both parts is split into what it was mixed from. Where
    /// no mixture fits, all of the light is in one part.
    #[test]
    fn skies_are_split() {
        let parts = [0.96, 0.88];
        for mixed in [[0.3, 0.5], [0.6, 0.1], [1.0, 0.0]] {
            let split = Dome::split(mixed[0] + mixed[1], parts[0] * mixed[0] + parts[1] * mixed[1], parts);
            assert!((split[0] - mixed[0]).abs() < 1e-12 && (split[1] - mixed[1]).abs() < 1e-12, "{split:?}");
        }
        assert_eq!(Dome::split(2.0, 1.95, parts), [2.0, 0.0]);
        assert_eq!(Dome::split(2.0, 0.2, parts), [0.0, 2.0]);
    }
}
