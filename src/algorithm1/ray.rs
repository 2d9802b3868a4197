//! The view ray of one (altitude, view) row of a table, sampled for the trapezoidal rule. All suns and
//! azimuths of the row share it.

use super::air::{Air, altitude_along, radius_along, simpson};
use crate::geometry::view_sun_cosine;
use crate::machine::lanes::Lanes;
use crate::mapping::{Elek2010, Texel, texel};

/// Intervals of the quadrature of optical depth between two samples; even, for Simpson's rule.
const DEPTH_INTERVALS: usize = 8;

/// One sample P of a ray.
pub(super) struct Sample {
    /// Distance from the observer, m.
    s: f64,
    radius: f64,
    pub altitude: f64,
    pub mu: f64,
    /// U and V of P and the ray's direction.
    pub u: Texel,
    v: Texel,
    /// For gas and aerosol: σ ρ(P) e^−t(P_a, P) ds, with the weight of the trapezoidal rule in ds.
    pub strength: [Lanes; 2],
}

/// A ray from an observer P_a to the ground or the top, P_b.
pub(super) struct Ray {
    radius: f64,
    mu: f64,
    pub hits_ground: bool,
    pub samples: Vec<Sample>,
    /// e^−t(P_a, P_b).
    pub transmittance: Lanes,
}

impl Ray {
    /// The ray of row (i, j), with `count` equidistant samples from P_a to P_b, both included.
    #[inline(always)]
    pub(super) fn trace(air: &Air, map: &Elek2010, [i, j]: [usize; 2], count: usize) -> Self {
        let (altitude, top) = (map.altitude(i), map.altitude(map.size()[0] - 1));
        let (mu, hits_ground) = map.mu(altitude, j);
        let radius = map.radius(i);
        let step = map.distance(altitude, mu, hits_ground) / (count - 1) as f64;
        let altitude_at = |s: f64| altitude_along(radius, altitude, mu, s).clamp(0.0, top);
        let mut depth = Lanes::ZERO;
        let mut transmittance = Lanes::splat(1.0);
        let samples = (0..count)
            .map(
                #[inline(always)]
                |k| {
                    let s = step * k as f64;
                    if k > 0 {
                        depth += segment_depth(air, step, |part| altitude_at(s - step + part));
                        transmittance = (depth * -1.0).exp();
                    }
                    let weight = if k == 0 || k + 1 == count { 0.5 * step } else { step };
                    let altitude_here = altitude_at(s);
                    let radius_here = radius_along(radius, mu, s);
                    let mu_here = ((radius * mu + s) / radius_here).clamp(-1.0, 1.0);
                    let u = texel(map.altitude_coordinate(altitude_here), map.size()[0]);
                    let v = map.view_texel(altitude_here, mu_here, hits_ground);
                    let strength =
                        air.scattering(altitude_here).map(|sigma| sigma * transmittance * weight as f32);
                    Sample { s, radius: radius_here, altitude: altitude_here, mu: mu_here, u, v, strength }
                },
            )
            .collect();
        Ray { radius, mu, hits_ground, samples, transmittance }
    }

    /// P_b, the last sample: on the ground or at the top.
    #[inline(always)]
    pub(super) fn end(&self) -> &Sample {
        &self.samples[self.samples.len() - 1]
    }

    /// Cosine of the angle between the ray and the sun, the same all along it.
    #[inline(always)]
    pub(super) fn nu(&self, mu_s: f64, cos_azimuth: f64) -> f64 {
        view_sun_cosine(self.mu, mu_s, cos_azimuth)
    }

    /// Cosine of the sun's zenith angle at a sample.
    #[inline(always)]
    pub(super) fn mu_s_at(&self, sample: &Sample, mu_s: f64, nu: f64) -> f64 {
        ((self.radius * mu_s + sample.s * nu) / sample.radius).clamp(-1.0, 1.0)
    }

    /// At a sample, cosines of the sun's zenith angle and of the azimuth between it and the ray.
    #[inline(always)]
    pub(super) fn sun_at(&self, sample: &Sample, mu_s: f64, nu: f64) -> (f64, f64) {
        let mu_s_here = self.mu_s_at(sample, mu_s, nu);
        let sines = ((1.0 - sample.mu * sample.mu) * (1.0 - mu_s_here * mu_s_here)).max(0.0).sqrt();
        // Along the vertical, or with the sun in it, every azimuth is the same.
        let cos_azimuth = if sines > 1e-12 { (nu - sample.mu * mu_s_here) / sines } else { 1.0 };
        (mu_s_here, cos_azimuth)
    }

    /// Texels around a sample, the ray's direction and the sun; none where it is dark.
    #[inline(always)]
    pub(super) fn place(&self, map: &Elek2010, sample: &Sample, mu_s: f64, nu: f64) -> Option<[Texel; 4]> {
        let (mu_s_here, cos_azimuth) = self.sun_at(sample, mu_s, nu);
        map.sun_texels(mu_s_here, cos_azimuth).map(|[w, r]| [sample.u, sample.v, w, r])
    }
}

/// Optical depth of one interval between samples (Eq. 6); `altitude` by the distance from its start.
#[inline(always)]
fn segment_depth(air: &Air, length: f64, altitude: impl Fn(f64) -> f64) -> Lanes {
    let at = |k: usize| altitude(length * k as f64 / DEPTH_INTERVALS as f64);
    air.depth(|density| simpson(DEPTH_INTERVALS, length, |k| density.at(at(k))))
}
