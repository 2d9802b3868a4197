//! Rays through thick air, whose many samples are looked up together.
//!
//! In thick air a ray crosses many levels before it has turned by an angle about the planet's centre that matters
//! to anything but height. What its samples add is taken as linear in that turn between a few fixed ones: for each
//! of these the samples' weights are summed by level of the state and degree, once for all orders, and what is left
//! to do in an order is one product of weights and state, and one look at sun positions for each turn instead of
//! one for each sample. Products of several rays are formed together, level by level of the state, so that what they
//! share is read from the processor's caches.

use super::azimuth::Pairs;
use super::kernels::{self, NEGLIGIBLE};
use super::levels::Levels;
use super::moments::{Basis, MOST_DEGREE, MOST_TERMS};
use super::rays::Sample;
use super::refined::RefinedAxis;
use crate::machine::lanes::Lanes;

/// Turns between which samples are interpolated: doubling from the first one to steps of the last, rad. The sun's
/// height is interpolated over steps of some thousandths of a cosine too, and rays are sampled every 0.013.
const FIRST_TURN: f64 = 2e-3;
const LONGEST_STEP: f64 = 1e-2;
/// In tall shells, where rays turn far: a step may be this share of the turn before it.
const SHARE_OF_TURN: f64 = 0.025;

/// Samples of a ray as seen after one turn.
pub(super) struct Bundle {
    /// Turn and zenith cosine of the ray there; its levels are not used.
    at: Sample,
    /// First level of the state, and the one after the last.
    first: usize,
    end: usize,
    /// `[level][degree]`: what a moment 1 adds to the radiance at the start, before the polynomial.
    weights: Vec<Lanes>,
    /// P̄_lm at the ray's zenith cosine, per term.
    polynomials: [f32; MOST_TERMS],
}

/// The degrees of a basis, and for each of its terms the place of its degree among them.
pub(super) struct Degrees {
    pub all: Vec<usize>,
    of_term: Vec<usize>,
}

impl Degrees {
    pub(super) fn new(basis: &Basis) -> Self {
        let all: Vec<usize> = basis.terms.iter().filter(|t| t.1 == 0).map(|t| t.0).collect();
        let place = |l: usize| all.iter().position(|&d| d == l).expect("a degree has an order 0");
        let of_term = basis.terms.iter().map(|t| place(t.0)).collect();
        Degrees { all, of_term }
    }
}

/// The fixed turns, up to half a circle.
pub(super) fn turns(is_tall: bool) -> Vec<f64> {
    let share = if is_tall { SHARE_OF_TURN } else { 0.0 };
    let mut turns = vec![0.0, FIRST_TURN];
    while turns[turns.len() - 1] < std::f64::consts::PI {
        let last = turns[turns.len() - 1];
        turns.push(last + last.min(LONGEST_STEP.max(share * last)));
    }
    turns
}

/// What scatters along a ray.
pub(super) struct Part<'a> {
    /// What a source of 1 at each sample adds to the radiance at the start.
    pub weights: &'a [Lanes],
    /// Source of a moment 1, `[level of the field][degree]`; one list where it is the same at all levels.
    pub sources: &'a [Vec<Lanes>],
}

/// How samples count between two turns.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Between {
    /// Linear in the turn.
    Line,
    /// The same, but by the square of the turn before the first one that is not 0: so light that is scattered a
    /// thousand times at short distances spreads around the planet as it should, by squares of these distances.
    Squares,
}

/// The bundles of a ray's samples that starts with zenith cosine `mu`.
pub(super) fn bundle(
    samples: &[Sample],
    mu: f64,
    parts: &[Part],
    levels: &Levels,
    basis: &Basis,
    turns: &[f64],
    between: Between,
) -> Vec<Bundle> {
    let degrees = basis.of_order(0).len();
    let largest = |k: usize| parts.iter().map(|p| kernels::largest(p.weights[k])).fold(0.0, f32::max);
    let least = NEGLIGIBLE * (0..samples.len()).map(largest).fold(0.0, f32::max);
    let places: Vec<(usize, usize, f32)> = (0..samples.len())
        .filter(|&k| largest(k) > least)
        .map(|k| {
            let (node, part) = place(&samples[k], turns, between);
            (k, node, part)
        })
        .collect();
    let last = places.iter().map(|p| p.1 + 1).max().unwrap_or(0);
    let mut out = Vec::new();
    let mut on_field = vec![Lanes::ZERO; levels.field.len()];
    for (node, &turn) in turns.iter().enumerate().take(last + 1) {
        let share = |n: usize, t: f32| if n == node { 1.0 - t } else { t };
        let here: Vec<(&Sample, usize, f32)> = (places.iter())
            .filter(|p| p.1 == node || p.1 + 1 == node)
            .map(|&(k, n, t)| (&samples[k], k, share(n, t)))
            .filter(|h| h.2 > 0.0)
            .collect();
        let (Some(low), Some(high)) =
            (here.iter().map(|h| h.0.level).min(), here.iter().map(|h| h.0.level).max())
        else {
            continue;
        };
        let (low, high) = (low as usize, high as usize + 1);
        let around = &levels.between[low..=high];
        let first = around.iter().map(|b| b.0).min().unwrap_or(0);
        let end = around.iter().map(|b| b.0 + b.1.len()).max().unwrap_or(0);
        let mut weights = vec![Lanes::ZERO; (end - first) * degrees];
        for part in parts {
            on_field[low..=high].fill(Lanes::ZERO);
            for (s, k, share) in &here {
                let level = s.level as usize;
                on_field[level] += part.weights[*k] * ((1.0 - s.place) * share);
                on_field[level + 1] += part.weights[*k] * (s.place * share);
            }
            add_to_state(&on_field[low..=high], around, part.sources, low, first, degrees, &mut weights);
        }
        let polynomials = polynomials(basis, turn, mu);
        out.push(Bundle { at: after(turn, mu), first, end, weights, polynomials });
    }
    out
}

/// The turn before a sample's own and what the one after counts.
fn place(sample: &Sample, turns: &[f64], between: Between) -> (usize, f32) {
    let turn = libm::atan2(f64::from(sample.sin_turn), f64::from(sample.cos_turn)).max(0.0);
    let n = turns.partition_point(|&t| t <= turn).clamp(1, turns.len() - 1) - 1;
    let part = (turn - turns[n]) / (turns[n + 1] - turns[n]);
    (n, if n == 0 && between == Between::Squares { part * part } else { part } as f32)
}

/// Brings weights on levels of the field, from number `low` on, to the state's levels from number `first` on, by
/// degree.
fn add_to_state(
    weights: &[Lanes],
    around: &[(usize, Vec<f32>)],
    sources: &[Vec<Lanes>],
    low: usize,
    first: usize,
    degrees: usize,
    out: &mut [Lanes],
) {
    for (n, (weight, (from, parts))) in weights.iter().zip(around).enumerate() {
        let source = &sources[(low + n).min(sources.len() - 1)];
        for (level, part) in (from - first..).zip(parts) {
            for (out, source) in out[level * degrees..].iter_mut().zip(source) {
                *out += *weight * *source * *part;
            }
        }
    }
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

/// Bundles whose products are formed together: as many as stay in the processor's second cache.
const TOGETHER: usize = 20;

/// Number of rays, the first of a list, whose products are formed together.
pub(super) fn together(rays: &[Vec<Bundle>]) -> usize {
    let mut sum = 0;
    let few = |r: &&Vec<Bundle>| {
        sum += r.len();
        sum <= TOGETHER
    };
    rays.iter().take_while(few).count().clamp(1, rays.len())
}

/// Sums over levels and degrees for all bundles of some rays of a level, `[bundle][order][sun node]`, of a state's
/// moments, `[level][sun node][term]`.
pub(super) fn products(
    rays: &[Vec<Bundle>],
    state: &[Lanes],
    suns: usize,
    basis: &Basis,
    degrees: &Degrees,
    out: &mut Vec<Lanes>,
) {
    // By itself, so that it is small enough for the compiler to work on as a whole.
    crate::machine::isa::run(
        #[inline(always)]
        || sum_products(rays, state, suns, basis, degrees, out),
    )
}

#[inline(always)]
fn sum_products(
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
                if level < bundle.first || level >= bundle.end {
                    continue;
                }
                let weights = &bundle.weights[(level - bundle.first) * count..][..count];
                let mut factors = [Lanes::ZERO; MOST_DEGREE + 1];
                for (f, t) in factors.iter_mut().zip(terms.clone()) {
                    *f = weights[degrees.of_term[t]] * bundle.polynomials[t];
                }
                let out = &mut out[(b * modes + m) * suns..][..suns];
                for (node, out) in moments.chunks_exact(basis.len()).zip(out) {
                    // One value at a time: loops over several nodes at once the compiler turns into shuffles.
                    let mut sum = *out;
                    for (moment, factor) in node[terms.clone()].iter().zip(&factors) {
                        sum += *moment * *factor;
                    }
                    *out = sum;
                }
            }
        }
    }
}

/// Room for [`add`], kept from ray to ray.
#[derive(Default)]
pub(super) struct BundleScratch {
    coarse: Vec<Lanes>,
    fine: Vec<Lanes>,
}

/// Adds to `out` (one value a pair) the light that arrives along a ray with these bundles and their products.
#[inline(always)]
pub(super) fn add(
    bundles: &[Bundle],
    products: &[Lanes],
    mu: f32,
    basis: &Basis,
    axis: &RefinedAxis,
    suns: usize,
    pairs: &Pairs,
    room: &mut BundleScratch,
    out: &mut [Lanes],
) {
    let modes = basis.modes;
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
        for (is_tall, share) in [(false, 0.0), (true, SHARE_OF_TURN)] {
            let turns = turns(is_tall);
            assert!(turns[0] == 0.0 && turns[turns.len() - 1] >= std::f64::consts::PI);
            for t in turns[1..].windows(2) {
                let most = LONGEST_STEP.max(share * t[0]) * 1.000_001;
                assert!(t[1] > t[0] && t[1] <= 2.0 * t[0] && t[1] - t[0] <= most);
            }
        }
    }

    /// A ray that starts level looks upwards after a turn, by as much: its zenith angle falls from 90 to 89 degrees.
    #[test]
    fn a_turn_takes_from_the_zenith_angle() {
        let turn = 1f64.to_radians();
        assert!((f64::from(after(turn, 0.0).mu) - libm::sin(turn)).abs() < 1e-7);
    }
}
