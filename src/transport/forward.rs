//! What the low-degree field misses of a forward peak: light scattered several times by small angles.
//!
//! The last scattering of light is summed from moments of its radiance up to a degree. Beyond it lies what the
//! peak itself has made of sunlight on its way: at a place below the scattering optical depth τ of the same
//! constituent towards the sun, once scattered light is T τ times the phase function around the sun's direction,
//! twice scattered light T τ²/2 times its convolution with itself, and so on, as long as the path hardly turns
//! (Goudsmit & Saunderson 1940). The last scattering multiplies each degree by χ_l once more, so that to the
//! third order the phase function of single scattering becomes
//!   p(ν) → p(ν) + τ c₁(ν) + ½ τ² c₂(ν),   c_n(ν) = Σ_{l > degree} (2l+1)/4π χ_l^(n+1) P_l(ν).
//! Small turns after a sharp one, on the way to the eye, need no such term: light that has turned sharply is
//! smooth in direction, and the moments hold it. Where all turns are small, the way to the sun stands for the
//! whole: on a straight line both count the same pairs of places.

use crate::lanes::{Lanes, WIDTH};
use crate::medium::PhaseFunction;
use std::f64::consts::PI;

/// c₁ and c₂ of one constituent, tabulated against √((1 − ν)/2).
#[derive(Clone, Debug)]
pub struct ForwardPeak {
    first: Vec<Lanes>,
    second: Vec<Lanes>,
}

const NODES: usize = 512;
/// Coefficients below this no longer matter; at most this many are summed.
const SMALLEST: f64 = 1e-7;
const MOST_TERMS: usize = 2000;

impl ForwardPeak {
    /// None where the solver's `degree` holds all of the phase functions (one per wavelength).
    pub fn new(phases: &[PhaseFunction], degree: usize) -> Option<Self> {
        let mut peak = ForwardPeak { first: vec![Lanes::ZERO; NODES], second: vec![Lanes::ZERO; NODES] };
        let mut any = false;
        for (w, phase) in phases.iter().enumerate().take(WIDTH) {
            if w > 0 && *phase == phases[w - 1] {
                for v in peak.first.iter_mut().chain(&mut peak.second) {
                    v[w] = v[w - 1];
                }
                continue;
            }
            let chi = expansion(phase);
            any |= chi.len() > degree + 1;
            for k in 0..NODES {
                let x = k as f64 / (NODES - 1) as f64;
                let [c1, c2] = corrections(&chi, degree, 1.0 - 2.0 * x * x);
                peak.first[k][w] = c1 as f32;
                peak.second[k][w] = c2 as f32;
            }
        }
        any.then_some(peak)
    }

    /// c₁ and c₂ at the cosine of a scattering angle.
    #[inline(always)]
    pub fn at(&self, nu: f32) -> (Lanes, Lanes) {
        let half = 0.5 * (1.0 - nu);
        let x = (if half > 0.0 { half } else { 0.0 }).sqrt() * (NODES - 1) as f32;
        let last = (NODES - 2) as f32;
        let whole = (if x < last { x } else { last }).floor();
        let (n, t) = (whole as i32 as usize, x - whole);
        let blend = |v: &[Lanes]| v[n] * (1.0 - t) + v[n + 1] * t;
        (blend(&self.first), blend(&self.second))
    }
}

/// Legendre coefficients until they are negligible.
fn expansion(phase: &PhaseFunction) -> Vec<f64> {
    let mut degree = 32;
    loop {
        let mut chi = phase.legendre(degree);
        if chi[degree].abs() < SMALLEST || degree >= MOST_TERMS {
            let used = chi.iter().rposition(|c| c.abs() >= SMALLEST).unwrap_or(0);
            chi.truncate(used + 1);
            return chi;
        }
        degree *= 2;
    }
}

fn corrections(chi: &[f64], degree: usize, nu: f64) -> [f64; 2] {
    let (mut before, mut now) = (1.0, nu);
    let mut sums = [0.0; 2];
    for (l, &c) in chi.iter().enumerate() {
        if l > degree {
            let factor = (2 * l + 1) as f64 / (4.0 * PI) * before;
            sums[0] += factor * c * c;
            sums[1] += factor * c * c * c;
        }
        let next = ((2 * l + 3) as f64 * nu * now - (l + 1) as f64 * before) / (l + 2) as f64;
        (before, now) = (now, next);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Henyey–Greenstein convolved with itself is Henyey–Greenstein of g²: with a field of
    /// degree 0, which keeps χ₀ alone, c₁ is that less 1/4π.
    #[test]
    fn a_peak_scattered_twice_is_the_convolved_peak() {
        let peak = ForwardPeak::new(&[PhaseFunction::HenyeyGreenstein { g: 0.7 }], 0).unwrap();
        for nu in [-0.9, 0.1, 0.8, 0.99] {
            let twice = PhaseFunction::HenyeyGreenstein { g: 0.49 }.value(nu) - 1.0 / (4.0 * PI);
            assert!((f64::from(peak.at(nu as f32).0[0]) - twice).abs() < 2e-4 * (1.0 + twice), "{nu}");
        }
        assert!(ForwardPeak::new(&[PhaseFunction::Rayleigh { king_factor: 1.05 }], 6).is_none());
    }
}
