//! Forward peaks: what is not scattered at all of them, and what the low-degree field misses of the rest.
//!
//! The field of light is known by its moments up to a degree L, and a peak has more. Its share f = max χ_l over
//! l > L is taken to pass unscattered (δ-M scaling, Wiscombe 1977): the extinction falls by f times the
//! scattering σ, and the coefficients of what does scatter are χ_l − f, so that the sunbeam carries the peak along
//! and reaches, as it should, deeper than extinction alone lets it.
//!
//! What scatters last is summed from moments up to L. Beyond, there is what the peak has made of sunlight on its
//! way: on a straight line, below a scattering optical depth τ of the same constituent towards the sun, the light
//! of degree l is e^(τ (χ_l − f)) as strong as the beam (Goudsmit & Saunderson 1940). The last scattering and what
//! the lower extinction leaves in too much make of it, in units of σ times the beam,
//!   Σ_l (2l+1)/4π s_l P_l(ν),   s_l = χ_l for l ≤ L and (χ_l − f) e^(τ (χ_l − f)) for l > L,
//! away from ν = 1, where the degrees of −f σ δ(ν − 1) may be added that are the beam's own. With the exact phase
//! function p for the light scattered once (Nakajima & Tanaka 1988, whose second order this continues to all):
//!   p(ν) → p(ν) + Σ_l (2l+1)/4π D_l(τ) P_l(ν),
//!   D_l = f (e^(−τ f) − 1) for l ≤ L,   D_l = f (e^(−τ f) − 1) − a_l (e^(−τ a_l) − 1) with a_l = f − χ_l for l > L.
//! Nothing of it grows with τ. Small turns after a sharp one, on the way to the eye, need no such term: light that
//! has turned sharply is smooth in direction, and the moments hold it. Where all turns are small, the way to the
//! sun stands for the whole: on a straight line both count the same pairs of places.
//!
//! e^(−τ a) is interpolated over a between few rates a_j, so that Σ_l D_l P_l is a sum over j of functions of ν times
//! functions of τ, and these are tabulated. The error is 1e-3 where τ f is 4.
//!
//! Where orders of scattering are counted one by one, nothing may pass for unscattered: f is 0 then, and e^(τ χ_l) is
//! cut off at the order, the third at most.

use crate::lanes::{Lanes, WIDTH};
use crate::medium::PhaseFunction;
use std::f64::consts::PI;

/// What one constituent's peak adds to its phase function, see above.
#[derive(Clone, Debug)]
pub struct ForwardPeak {
    law: Law,
    /// `[node over √((1 − ν)/2)][part]`
    values: Vec<Lanes>,
    parts: usize,
}

/// How the parts depend on optical depth.
#[derive(Clone, Debug)]
enum Law {
    /// e^(−j τ rate) − 1 for j = 1, 2, …
    Decay { rate: Lanes },
    /// τ and ½ τ².
    Orders,
}

const NODES: usize = 512;
/// Rates that e^(−τ a) is interpolated between, beside 0.
const RATES: usize = 5;
/// Coefficients below this no longer matter; at most this many are summed.
const SMALLEST: f64 = 1e-7;
const MOST_TERMS: usize = 2000;

/// Per wavelength, the share of a constituent's scattering that counts as none where the field ends at `degree`.
pub fn unscattered(phases: &[PhaseFunction], degree: usize) -> Vec<f64> {
    let mut out: Vec<f64> = Vec::new();
    for (w, phase) in phases.iter().enumerate() {
        let same = w > 0 && *phase == phases[w - 1];
        out.push(if same { out[w - 1] } else { largest_beyond(&expansion(phase), degree) });
    }
    out
}

fn largest_beyond(chi: &[f64], degree: usize) -> f64 {
    chi.iter().skip(degree + 1).fold(0.0, |a, &c| a.max(c))
}

impl ForwardPeak {
    /// For a field that ends at `degree`; none where it holds all of the phase functions (one per wavelength).
    /// `orders`: how many are summed, none for all.
    pub fn new(phases: &[PhaseFunction], degree: usize, orders: Option<usize>) -> Option<Self> {
        let parts = if orders.is_some() { 2 } else { RATES };
        let mut values = vec![Lanes::ZERO; NODES * parts];
        let mut rates = Lanes::ZERO;
        let mut any = false;
        for (w, phase) in phases.iter().enumerate().take(WIDTH) {
            if w > 0 && *phase == phases[w - 1] {
                values.iter_mut().for_each(|v| v[w] = v[w - 1]);
                rates[w] = rates[w - 1];
                continue;
            }
            let chi = expansion(phase);
            any |= chi.len() > degree + 1;
            let (rate, factors) = match orders {
                Some(n) => (0.0, series(&chi, degree, n)),
                None => decay(&chi, degree),
            };
            rates[w] = rate as f32;
            for (k, values) in values.chunks_exact_mut(parts).enumerate() {
                let x = k as f64 / (NODES - 1) as f64;
                for (v, sum) in values.iter_mut().zip(legendre_sums(&factors, 1.0 - 2.0 * x * x)) {
                    v[w] = sum as f32;
                }
            }
        }
        let law = if orders.is_some() { Law::Orders } else { Law::Decay { rate: rates } };
        any.then_some(ForwardPeak { law, values, parts })
    }

    /// What is added to the phase function at the cosine of a scattering angle, where the scattering optical depth
    /// to the sun is `depth`.
    #[inline(always)]
    pub fn at(&self, nu: f32, depth: Lanes) -> Lanes {
        match &self.law {
            Law::Decay { rate } => {
                let step = (depth * *rate * -1.0).exp();
                let mut power = step;
                let mut weights = [Lanes::ZERO; RATES];
                for weight in &mut weights {
                    *weight = power - Lanes::splat(1.0);
                    power = power * step;
                }
                self.sum(nu, &weights)
            }
            Law::Orders => self.sum(nu, &[depth, depth * depth * 0.5]),
        }
    }

    /// The mean of the same over places spread evenly in depth between 0 and twice `depth`.
    #[inline(always)]
    pub fn mean(&self, nu: f32, depth: Lanes) -> Lanes {
        match &self.law {
            Law::Decay { rate } => {
                let spread = depth * *rate * 2.0;
                let step = (spread * -1.0).exp();
                let mut power = step;
                let mut weights = [Lanes::ZERO; RATES];
                for (j, weight) in weights.iter_mut().enumerate() {
                    for w in 0..WIDTH {
                        let x = spread[w] * (j + 1) as f32;
                        // (1 − e^−x)/x − 1, by series where it cancels.
                        let small = x * (-0.5 + x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0)));
                        let large = (1.0 - power[w]) / (if x > 0.1 { x } else { 0.1 }) - 1.0;
                        weight[w] = if x < 0.1 { small } else { large };
                    }
                    power = power * step;
                }
                self.sum(nu, &weights)
            }
            Law::Orders => self.sum(nu, &[depth, depth * depth * (2.0 / 3.0)]),
        }
    }

    #[inline(always)]
    fn sum(&self, nu: f32, weights: &[Lanes]) -> Lanes {
        let half = 0.5 * (1.0 - nu);
        let x = (if half > 0.0 { half } else { 0.0 }).sqrt() * (NODES - 1) as f32;
        let (node, t) = super::azimuth::node_and_place(x, NODES);
        let low = &self.values[node as usize * self.parts..][..2 * self.parts];
        let mut sum = Lanes::ZERO;
        for (j, weight) in weights.iter().enumerate() {
            sum += (low[j] * (1.0 - t) + low[self.parts + j] * t) * *weight;
        }
        sum
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

/// χ_l² and χ_l³ beyond the degree, for the orders that are asked for.
fn series(chi: &[f64], degree: usize, orders: usize) -> Vec<Vec<f64>> {
    let counted = |order: usize| if orders >= order { 1.0 } else { 0.0 };
    let beyond = |l: usize, v: f64| if l > degree { v } else { 0.0 };
    let row = |(l, &c): (usize, &f64)| vec![beyond(l, c * c * counted(2)), beyond(l, c * c * c * counted(3))];
    chi.iter().enumerate().map(row).collect()
}

/// The smallest rate but 0, and by degree what each of e^(−j τ rate) − 1 contributes to D_l.
fn decay(chi: &[f64], degree: usize) -> (f64, Vec<Vec<f64>>) {
    let f = largest_beyond(chi, degree);
    let least = chi.iter().skip(degree + 1).fold(0.0f64, |a, &c| a.min(c));
    let rate = (f - least) / RATES as f64;
    if rate <= 0.0 {
        return (0.0, vec![vec![0.0; RATES]; chi.len()]);
    }
    let whole: Vec<f64> = between(f / rate).into_iter().map(|w| w * f).collect();
    let row = |(l, &c): (usize, &f64)| {
        let a = f - c;
        if l <= degree {
            return whole.clone();
        }
        between(a / rate).iter().zip(&whole).map(|(w, whole)| whole - a * w).collect()
    };
    (rate, chi.iter().enumerate().map(row).collect())
}

/// Weights of Lagrange's polynomial through 0, 1, … [`RATES`] at `x`, without that of 0.
fn between(x: f64) -> Vec<f64> {
    let nodes = || (0..=RATES).map(|k| k as f64);
    let weight = |j: f64| nodes().filter(|&k| k != j).fold(1.0, |w, k| w * (x - k) / (j - k));
    nodes().skip(1).map(weight).collect()
}

/// Σ_l (2l+1)/4π factors_l P_l(ν), part by part.
fn legendre_sums(factors: &[Vec<f64>], nu: f64) -> Vec<f64> {
    let (mut before, mut now) = (1.0, nu);
    let mut sums = vec![0.0; factors.first().map_or(0, Vec::len)];
    for (l, factors) in factors.iter().enumerate() {
        let polynomial = (2 * l + 1) as f64 / (4.0 * PI) * before;
        for (sum, factor) in sums.iter_mut().zip(factors) {
            *sum += polynomial * factor;
        }
        let next = ((2 * l + 3) as f64 * nu * now - (l + 1) as f64 * before) / (l + 2) as f64;
        (before, now) = (now, next);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Henyey–Greenstein convolved with itself is Henyey–Greenstein of g²: with a field of degree 0, which keeps
    /// χ₀ alone, the second order is that less 1/4π.
    #[test]
    fn a_peak_scattered_twice_is_the_convolved_peak() {
        let peak =
            ForwardPeak::new(&[PhaseFunction::HenyeyGreenstein { g: 0.7 }], 0, Some(2)).expect("a peak");
        for nu in [-0.9, 0.1, 0.8, 0.99] {
            let twice = PhaseFunction::HenyeyGreenstein { g: 0.49 }.value(nu) - 1.0 / (4.0 * PI);
            let found = f64::from(peak.at(nu as f32, Lanes::splat(1.0))[0]);
            assert!((found - twice).abs() < 2e-4 * (1.0 + twice), "{nu}");
        }
        assert!(ForwardPeak::new(&[PhaseFunction::Rayleigh { king_factor: 1.05 }], 6, None).is_none());
    }
}
