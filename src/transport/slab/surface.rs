//! A flat water surface: light in and out of the slab.

use super::fresnel::{fresnel, refract};
use std::f64::consts::PI;

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

    /// Radiance below the surface of an evenly bright sky of unit irradiance: (1 − F) n² / π inside Snell's
    /// window, 0 outside.
    pub fn sky_in_water(&self, mu_water: f64) -> f64 {
        (1.0 - self.reflects_down(mu_water)) * self.n * self.n / PI
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
        let (mut above, mut below) = (0.0, 0.0);
        for k in 0..STEPS {
            let mu = (k as f64 + 0.5) * step;
            above += 2.0 * mu * (1.0 - fresnel(mu, 1.4)) * step;
            below += 2.0 * PI * mu * s.sky_in_water(mu) * step;
        }
        assert!((above - below).abs() < 1e-4, "{above} {below}");
        assert_eq!(s.sun_in_water(-0.1), 0.0);
        assert!((Surface { n: 1.0 }.sun_in_water(0.3) - 1.0).abs() < 1e-14);
    }
}
