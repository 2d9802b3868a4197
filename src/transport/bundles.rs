//! Rays through thick air, whose many samples are looked up together.
//!
//! In thick air a ray crosses many levels before it has turned by an angle about the planet's centre that matters
//! to anything but height. What its samples add is taken as linear in that turn between a few fixed ones: for each
//! of these the samples' weights are summed by level of the state and degree, once for all orders, and what is left
//! to do in an order is one product of weights and state, and one look at sun positions for each turn instead of
//! one for each sample. Products of all rays of a level are formed together, level by level of the state, so that
//! the state is read from the processor's caches.

use super::azimuth::{Pairs, SunAxis};
use super::kernels::{self, NEGLIGIBLE};
use super::levels::Levels;
use super::moments::{Basis, MOST_TERMS};
use super::rays::{Ray, Sample};
use super::refined::RefinedAxis;
use super::state::State;
use crate::lanes::Lanes;

/// Turns between which samples are interpolated: doubling from the first one to steps of the last, rad. The sun's
/// height is interpolated over steps of some thousandths of a cosine too.
const FIRST_TURN: f64 = 1e-3;
const LONGEST_STEP: f64 = 6.5e-3;

/// Samples of a ray as seen after one turn.
pub struct Bundle {
    /// Turn and zenith cosine of the ray there; its levels are not used.
    at: Sample,
    /// First level of the state.
    first: usize,
    /// `[level][degree]`: what a moment 1 adds to the radiance at the start, before the polynomial.
    weights: Vec<Lanes>,
    /// P̄_lm at the ray's zenith cosine, per term.
    polynomials: [f32; MOST_TERMS],
}

impl Bundle {
    fn levels(&self, degrees: usize) -> std::ops::Range<usize> {
        self.first..self.first + self.weights.len() / degrees
    }
}

/// The degrees of a basis, and for each of its terms the place of its degree among them.
pub struct Degrees {
    pub all: Vec<usize>,
    of_term: Vec<usize>,
}

impl Degrees {
    pub fn new(basis: &Basis) -> Self {
        let all: Vec<usize> = basis.terms.iter().filter(|t| t.1 == 0).map(|t| t.0).collect();
        let place = |l: usize| all.iter().position(|&d| d == l).expect("a degree has an order 0");
        let of_term = basis.terms.iter().map(|t| place(t.0)).collect();
        Degrees { all, of_term }
    }
}

/// The fixed turns, up to half a circle.
pub fn turns() -> Vec<f64> {
    let mut turns = vec![0.0, FIRST_TURN];
    while turns[turns.len() - 1] < std::f64::consts::PI {
        let last = turns[turns.len() - 1];
        turns.push(last + last.min(LONGEST_STEP));
    }
    turns
}

/// The bundles of a ray that starts with zenith cosine `mu`. `sources[level of the field][degree]`: source of a
/// moment 1.
pub fn bundle(
    ray: &Ray,
    mu: f64,
    levels: &Levels,
    basis: &Basis,
    turns: &[f64],
    sources: &[Vec<Lanes>],
) -> Vec<Bundle> {
    let least = NEGLIGIBLE * ray.weights.iter().map(|w| kernels::largest(*w)).fold(0.0, f32::max);
    let used = (0..ray.samples.len()).filter(|&k| kernels::largest(ray.weights[k]) > least);
    let places: Vec<(usize, usize, f32)> = used
        .map(|k| {
            let s = &ray.samples[k];
            let turn = libm::atan2(f64::from(s.sin_turn), f64::from(s.cos_turn)).max(0.0);
            let n = turns.partition_point(|&t| t <= turn).clamp(1, turns.len() - 1) - 1;
            (k, n, ((turn - turns[n]) / (turns[n + 1] - turns[n])) as f32)
        })
        .collect();
    let last = places.iter().map(|p| p.1 + 1).max().unwrap_or(0);
    let mut out = Vec::new();
    let mut on_field = vec![Lanes::ZERO; levels.field.len()];
    for (node, &turn) in turns.iter().enumerate().take(last + 1) {
        let (mut low, mut high) = (levels.field.len(), 0);
        for &(k, n, t) in &places {
            let part = if n == node { 1.0 - t } else if n + 1 == node { t } else { 0.0 };
            if part > 0.0 {
                let s = &ray.samples[k];
                let level = s.level as usize;
                on_field[level] += ray.weights[k] * ((1.0 - s.place) * part);
                on_field[level + 1] += ray.weights[k] * (s.place * part);
                (low, high) = (low.min(level), high.max(level + 1));
            }
        }
        if low <= high {
            let (first, weights) = on_state(&on_field[low..=high], low, levels, sources);
            on_field[low..=high].fill(Lanes::ZERO);
            out.push(Bundle { at: after(turn, mu), first, weights, polynomials: polynomials(basis, turn, mu) });
        }
    }
    out
}

/// Weights on levels of the field from number `low` on, brought to the state's levels, by degree.
fn on_state(weights: &[Lanes], low: usize, levels: &Levels, sources: &[Vec<Lanes>]) -> (usize, Vec<Lanes>) {
    let range = low..low + weights.len();
    let between = &levels.between[range.clone()];
    let first = between.iter().map(|b| b.0).min().unwrap_or(0);
    let end = between.iter().map(|b| b.0 + b.1.len()).max().unwrap_or(0);
    let degrees = sources[0].len();
    let mut out = vec![Lanes::ZERO; (end - first) * degrees];
    for ((weight, (from, parts)), source) in weights.iter().zip(between).zip(&sources[range]) {
        for (level, part) in (from - first..).zip(parts) {
            for (out, source) in out[level * degrees..].iter_mut().zip(source) {
                *out += *weight * *source * *part;
            }
        }
    }
    (first, out)
}

/// A ray of zenith cosine `mu` seen after a turn: its zenith angle is smaller by that turn.
fn after(turn: f64, mu: f64) -> Sample {
    let (sin, cos) = libm::sincos(turn);
    let there = mu * cos + (1.0 - mu * mu).max(0.0).sqrt() * sin;
    let (cos_turn, sin_turn) = (cos as f32, sin as f32);
    Sample { level: 0, place: 0.0, cos_turn, sin_turn, mu: there.clamp(-1.0, 1.0) as f32 }
}

fn polynomials(basis: &Basis, turn: f64, mu: f64) -> [f32; MOST_TERMS] {
    let mut out = [0.0; MOST_TERMS];
    basis.fill(f64::from(after(turn, mu).mu), &mut out);
    out
}

/// A state's moments as `[level][term][sun node]`.
pub fn by_term(state: &State) -> Vec<Lanes> {
    let (suns, terms) = (state.suns, state.terms);
    let mut out = vec![Lanes::ZERO; state.moments.len()];
    for (from, to) in state.moments.chunks_exact(suns * terms).zip(out.chunks_exact_mut(suns * terms)) {
        for (t, row) in to.chunks_exact_mut(suns).enumerate() {
            row.iter_mut().zip(from[t..].iter().step_by(terms)).for_each(|(o, m)| *o = *m);
        }
    }
    out
}

/// Sums over levels and degrees for all bundles of one level's rays, `[bundle][order][sun node]`.
#[inline(always)]
pub fn products(
    rays: &[Vec<Bundle>],
    state: &[Lanes],
    suns: usize,
    basis: &Basis,
    degrees: &Degrees,
    out: &mut Vec<Lanes>,
) {
    let bundles: Vec<&Bundle> = rays.iter().flatten().collect();
    let (modes, stride, count) = (basis.modes, suns * basis.len(), degrees.all.len());
    out.clear();
    out.resize(bundles.len() * modes * suns, Lanes::ZERO);
    for m in 0..modes {
        let terms = basis.of_order(m);
        for (level, moments) in state.chunks_exact(stride).enumerate() {
            for (b, bundle) in bundles.iter().enumerate() {
                if !bundle.levels(count).contains(&level) {
                    continue;
                }
                let weights = &bundle.weights[(level - bundle.first) * count..][..count];
                let out = &mut out[(b * modes + m) * suns..][..suns];
                let mut t = terms.start;
                while t < terms.end {
                    let n = (terms.end - t).min(5);
                    let factor = |k: usize| weights[degrees.of_term[t + k]] * bundle.polynomials[t + k];
                    let rows = &moments[t * suns..][..n * suns];
                    match n {
                        1 => add_rows::<1>(rows, factor, suns, out),
                        2 => add_rows::<2>(rows, factor, suns, out),
                        3 => add_rows::<3>(rows, factor, suns, out),
                        4 => add_rows::<4>(rows, factor, suns, out),
                        _ => add_rows::<5>(rows, factor, suns, out),
                    }
                    t += n;
                }
            }
        }
    }
}

#[inline(always)]
fn add_rows<const N: usize>(rows: &[Lanes], factor: impl Fn(usize) -> Lanes, suns: usize, out: &mut [Lanes]) {
    let factors: [Lanes; N] = std::array::from_fn(factor);
    let rows: [&[Lanes]; N] = std::array::from_fn(|k| &rows[k * suns..][..suns]);
    for (sun, out) in out.iter_mut().enumerate() {
        let mut sum = *out;
        for k in 0..N {
            sum += rows[k][sun] * factors[k];
        }
        *out = sum;
    }
}

/// Room for [`add`], kept from ray to ray.
#[derive(Default)]
pub struct Room {
    coarse: Vec<Lanes>,
    fine: Vec<Lanes>,
}

/// Adds to `out` (one value a pair) the light that arrives along a ray with these bundles and their products.
#[inline(always)]
pub fn add(
    bundles: &[Bundle],
    products: &[Lanes],
    mu: f32,
    basis: &Basis,
    axis: &RefinedAxis,
    suns: &SunAxis,
    pairs: &Pairs,
    room: &mut Room,
    out: &mut [Lanes],
) {
    let (suns, modes) = (suns.len(), basis.modes);
    let stride = kernels::compiled_modes(basis);
    room.coarse.resize(suns * stride, Lanes::ZERO);
    room.fine.resize(axis.fine.len() * stride, Lanes::ZERO);
    for (bundle, product) in bundles.iter().zip(products.chunks_exact(modes * suns)) {
        for (m, row) in product.chunks_exact(suns).enumerate() {
            room.coarse[m..].iter_mut().step_by(stride).zip(row).for_each(|(c, v)| *c = *v);
        }
        axis.refine(&room.coarse, stride, &mut room.fine);
        kernels::add_sample(&bundle.at, mu, stride, &room.fine, &axis.fine, pairs, out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Turns rise from none past half a circle, by steps that at most double and stay short.
    #[test]
    fn turns_rise_by_short_steps() {
        let turns = turns();
        assert!(turns[0] == 0.0 && turns[turns.len() - 1] >= std::f64::consts::PI);
        for t in turns[1..].windows(2) {
            assert!(t[1] > t[0] && t[1] <= 2.0 * t[0] && t[1] - t[0] <= LONGEST_STEP * 1.000_001);
        }
    }

    /// A ray that starts level looks upwards after a turn, by as much: its zenith angle falls from 90 to 89 degrees.
    #[test]
    fn a_turn_takes_from_the_zenith_angle() {
        let turn = 1f64.to_radians();
        assert!((f64::from(after(turn, 0.0).mu) - libm::sin(turn)).abs() < 1e-7);
    }
}
