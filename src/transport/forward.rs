//! Forward peaks: what is not scattered at all of them, and what the low-degree field misses of the rest.
//!
//! The field of light is known by its moments up to a degree L, and a peak has more. Its share f = max χ_l over
//! l > L is taken to pass unscattered (δ-M scaling, Wiscombe 1977): the extinction falls by f times the
//! scattering σ, and the coefficients of what does scatter are χ_l − f. So the sunbeam carries the peak along, and
//! reaches as deep as light does that turns by little, and the moments end without a step, whose ripples would make
//! light negative.
//!
//! What scatters last is summed from moments up to L. Beyond, there is what the peak has made of sunlight on its
//! way: on a straight line, below a scattering optical depth τ of the same constituent towards the sun, the light
//! of degree l is e^(τ (χ_l − f)) as strong as the beam (Goudsmit & Saunderson 1940). What the last scattering
//! makes of it, less what the lowered extinction leaves in too much, is in units of σ times the beam
//!   Σ_l (2l+1)/4π s_l P_l(ν),   s_l = χ_l − f for l ≤ L and (χ_l − f) e^(τ (χ_l − f)) for l > L.
//! Far down the degrees this is −f e^(−τ f) δ(ν − 1), the beam's own. Without it, and beside the phase function of
//! light that is scattered once (as by Nakajima & Tanaka 1988, whose second order this continues to all):
//!   p(ν) → p(ν) + Σ_l (2l+1)/4π D_l(τ) P_l(ν),
//!   D_l = f (e^(−τ f) − 1) for l ≤ L,   D_l = f (e^(−τ f) − 1) − a_l (e^(−τ a_l) − 1) with a_l = f − χ_l for l > L.
//! Nothing of it grows with τ. Small turns after a sharp one, on the way to the eye, need no such term: light that
//! has turned sharply is smooth in direction, and the moments hold it. Where all turns are small, the way to the
//! sun stands for the whole: on a straight line both count the same pairs of places.
//!
//! e^(−τ a) is interpolated over a between few rates a_j, so that Σ_l D_l P_l is a sum over j of functions of ν times
//! functions of τ, and these are tabulated. Its error is 1e-3 where τ f is 4.
//!
//! A small share is scattered like all the rest ([`LEAST_SHARE`]), and so is any where orders of scattering are
//! counted one by one. f is 0 then, and e^(τ χ_l) is cut off after τ², the third order:
//!   D_l = 0 for l ≤ L,   D_l = τ χ_l² + ½ τ² χ_l³ for l > L.

use crate::machine::lanes::{Lanes, WIDTH};
use crate::medium::PhaseFunction;
use std::f64::consts::PI;

/// What one constituent's peak adds to its phase function, see above.
#[derive(Clone, Debug)]
pub struct ForwardPeak {
    /// The smallest rate a_j beside 0, the others being its multiples; 0 where f is 0.
    rate: Lanes,
    /// `[node over √((1 − ν)/2)][part]`: what is multiplied by e^(−τ a_j) − 1, or by τ and ½ τ².
    values: Vec<[Lanes; PARTS]>,
}

/// Smallest share that counts as unscattered. What has sharp edges by itself, the horizon above all, is let through
/// with the peak, an error in proportion to f; that of a peak left out goes like its square. In Cornette & Shanks'
/// function for g = 0.76, f is 0.03 beyond degree 12 and 0.10 beyond degree 8, and both are best left in.
pub(super) const LEAST_SHARE: f64 = 0.125;
const NODES: usize = 512;
/// Rates that e^(−τ a) is interpolated between, beside 0.
const PARTS: usize = 5;
/// Coefficients below this no longer matter; at most this many are summed.
const SMALLEST: f64 = 1e-7;
const MOST_TERMS: usize = 2000;

/// Per wavelength, the share f of a constituent's scattering that counts as none where the field ends at `degree`.
/// `orders`: how many of them are summed, none for all.
pub(super) fn unscattered(phases: &[PhaseFunction], degree: usize, orders: Option<usize>) -> Vec<f64> {
    let mut out: Vec<f64> = Vec::new();
    for (w, phase) in phases.iter().enumerate() {
        let same = w > 0 && *phase == phases[w - 1];
        out.push(if same { out[w - 1] } else { share(&expansion(phase), degree, orders) });
    }
    out
}

fn share(chi: &[f64], degree: usize, orders: Option<usize>) -> f64 {
    let f = chi.iter().skip(degree + 1).fold(0.0f64, |a, &c| a.max(c));
    if orders.is_none() && f >= LEAST_SHARE { f } else { 0.0 }
}

impl ForwardPeak {
    /// For a field that ends at `degree`; none where it holds all of the phase functions (one per wavelength).
    pub fn new(phases: &[PhaseFunction], degree: usize, orders: Option<usize>) -> Option<Self> {
        let mut peak = ForwardPeak { rate: Lanes::ZERO, values: vec![[Lanes::ZERO; PARTS]; NODES] };
        let mut any = false;
        for (w, phase) in phases.iter().enumerate().take(WIDTH) {
            if w > 0 && *phase == phases[w - 1] {
                peak.rate[w] = peak.rate[w - 1];
                peak.values.iter_mut().flatten().for_each(|v| v[w] = v[w - 1]);
                continue;
            }
            let chi = expansion(phase);
            any |= chi.len() > degree + 1;
            let (rate, factors) = match share(&chi, degree, orders) {
                f if f > 0.0 => decay(&chi, degree, f),
                _ => (0.0, powers(&chi, degree, orders.unwrap_or(usize::MAX))),
            };
            peak.rate[w] = rate as f32;
            for (k, values) in peak.values.iter_mut().enumerate() {
                let x = k as f64 / (NODES - 1) as f64;
                for (v, sum) in values.iter_mut().zip(legendre_sums(&factors, 1.0 - 2.0 * x * x)) {
                    v[w] = sum as f32;
                }
            }
        }
        any.then_some(peak)
    }

    /// What is added to the phase function at the cosine of a scattering angle, where the scattering optical depth
    /// to the sun is `depth`.
    #[inline(always)]
    pub fn at(&self, nu: f32, depth: Lanes) -> Lanes {
        let step = (depth * self.rate * -1.0).exp();
        let mut weights = [Lanes::ZERO; PARTS];
        let mut power = step;
        for weight in &mut weights {
            *weight = power - Lanes::splat(1.0);
            power = power * step;
        }
        self.sum(nu, depth, depth * depth * 0.5, weights)
    }

    /// The mean of the same over places spread evenly in depth between 0 and twice `depth`.
    #[inline(always)]
    pub fn mean(&self, nu: f32, depth: Lanes) -> Lanes {
        let spread = depth * self.rate * 2.0;
        let step = (spread * -1.0).exp();
        let mut weights = [Lanes::ZERO; PARTS];
        let mut power = step;
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
        self.sum(nu, depth, depth * depth * (2.0 / 3.0), weights)
    }

    #[inline(always)]
    fn sum(&self, nu: f32, first: Lanes, second: Lanes, mut weights: [Lanes; PARTS]) -> Lanes {
        for w in 0..WIDTH {
            if self.rate[w] == 0.0 {
                weights[0][w] = first[w];
                weights[1][w] = second[w];
            }
        }
        let half = 0.5 * (1.0 - nu);
        let x = (if half > 0.0 { half } else { 0.0 }).sqrt() * (NODES - 1) as f32;
        let (node, t) = super::azimuth::node_and_place(x, NODES);
        let [low, high] = [&self.values[node as usize], &self.values[node as usize + 1]];
        let mut sum = Lanes::ZERO;
        for (j, weight) in weights.iter().enumerate() {
            sum += (low[j] * (1.0 - t) + high[j] * t) * *weight;
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

/// By degree, χ_l² and χ_l³ beyond that of the field, for the orders that are asked for.
fn powers(chi: &[f64], degree: usize, orders: usize) -> Vec<[f64; PARTS]> {
    let counted = |order: usize, v: f64| if orders >= order { v } else { 0.0 };
    let row = |(l, &c): (usize, &f64)| {
        let mut row = [0.0; PARTS];
        if l > degree {
            (row[0], row[1]) = (counted(2, c * c), counted(3, c * c * c));
        }
        row
    };
    chi.iter().enumerate().map(row).collect()
}

/// The smallest rate, and by degree what each e^(−τ a_j) − 1 is multiplied by in D_l.
fn decay(chi: &[f64], degree: usize, f: f64) -> (f64, Vec<[f64; PARTS]>) {
    let least = chi.iter().skip(degree + 1).fold(0.0f64, |a, &c| a.min(c));
    let rate = (f - least) / PARTS as f64;
    let whole = between(f / rate).map(|weight| weight * f);
    let row = |(l, &c): (usize, &f64)| {
        let a = f - c;
        let own = between(a / rate);
        std::array::from_fn(|j| if l > degree { whole[j] - a * own[j] } else { whole[j] })
    };
    (rate, chi.iter().enumerate().map(row).collect())
}

/// Weights at `x` of Lagrange's polynomial through 0, 1, … [`PARTS`], without that of 0.
fn between(x: f64) -> [f64; PARTS] {
    let nodes = || (0..=PARTS).map(|k| k as f64);
    let weight = |j: f64| nodes().filter(|&k| k != j).fold(1.0, |w, k| w * (x - k) / (j - k));
    std::array::from_fn(|j| weight((j + 1) as f64))
}

/// Σ_l (2l+1)/4π factors_l P_l(ν), part by part.
fn legendre_sums(factors: &[[f64; PARTS]], nu: f64) -> [f64; PARTS] {
    let (mut before, mut now) = (1.0, nu);
    let mut sums = [0.0; PARTS];
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

    /// Light that turns by little all the way: below a depth τ of a pure scatterer, the n-th order of the peak is
    /// e^−τ τⁿ/n! times Henyey–Greenstein of gⁿ, and to the light of one more scattering the peak's terms and those
    /// of a field that knows degrees up to L add up to Σ_n e^−τ τⁿ/n! p_(n+1), less f times the light that has been
    /// scattered already. The phase functions are closed forms and their sum over n needs no coefficient.
    #[test]
    fn all_orders_of_small_turns_are_there() {
        let (g, degree) = (0.9f64, 8);
        let f = libm::pow(g, degree as f64 + 1.0);
        let phase = PhaseFunction::HenyeyGreenstein { g };
        let peak = ForwardPeak::new(std::slice::from_ref(&phase), degree, None).expect("a peak");
        for depth in [0.5f64, 2.0, 6.0, 10.0] {
            for nu in [0.995, 0.9, 0.5, 0.0, -0.8] {
                // In units of the beam, which is e^(−τ (1 − f)).
                let (mut poisson, mut truth, mut convolved) = (libm::exp(-f * depth), 0.0, 1.0);
                for n in 0..80 {
                    let light =
                        if n > 0 { PhaseFunction::HenyeyGreenstein { g: convolved }.value(nu) } else { 0.0 };
                    convolved *= g;
                    truth +=
                        poisson * (PhaseFunction::HenyeyGreenstein { g: convolved }.value(nu) - f * light);
                    poisson *= depth / (n + 1) as f64;
                }
                let (mut before, mut now, mut field) = (1.0, nu, 0.0);
                for l in 0..=degree {
                    let a = f - libm::pow(g, l as f64);
                    field += (2 * l + 1) as f64 / (4.0 * PI) * before * -a * libm::expm1(-a * depth);
                    let next = ((2 * l + 3) as f64 * nu * now - (l + 1) as f64 * before) / (l + 2) as f64;
                    (before, now) = (now, next);
                }
                let found =
                    phase.value(nu) + f64::from(peak.at(nu as f32, Lanes::splat(depth as f32))[0]) + field;
                assert!((found - truth).abs() < 4e-3 * (truth.abs() + 0.1), "{depth} {nu}: {found} {truth}");
            }
        }
    }

    /// The mean over depths is that of the values at them, with and without a share unscattered.
    #[test]
    fn the_mean_is_that_of_the_values() {
        for g in [0.7, 0.95] {
            let peak = ForwardPeak::new(&[PhaseFunction::HenyeyGreenstein { g }], 8, None).expect("a peak");
            for (nu, depth) in [(0.99f32, 0.02f32), (0.99, 1.5), (0.3, 6.0)] {
                let at = |k: usize| peak.at(nu, Lanes::splat(2.0 * depth * (k as f32 + 0.5) / 1000.0))[0];
                let sum: f64 = (0..1000).map(|k| f64::from(at(k)) / 1000.0).sum();
                let mean = f64::from(peak.mean(nu, Lanes::splat(depth))[0]);
                assert!((mean - sum).abs() < 1e-4 * (1.0 + sum.abs()), "{g} {nu} {depth}: {mean} {sum}");
            }
        }
    }
}
