//! The two hot loops: light scattered once and light scattered more often, along one ray, for many sun
//! positions at a time and all wavelengths of a batch.

use super::azimuth::{Pairs, SunAxis};
use super::moments::{Basis, MOST_TERMS};
use super::rays::Ray;
use super::sunlight::Sunlight;
use crate::lanes::Lanes;

/// Sources of multiply scattered light per unit extinction, `[level][sun node][term]`: (2l+1)/4π Σ f χ_l I_lm.
#[derive(Clone, Debug)]
pub struct Field {
    pub terms: usize,
    pub values: Vec<Lanes>,
}

/// Room for a kernel's intermediate values, reused from ray to ray.
#[derive(Default)]
pub struct Scratch {
    nodes: Vec<u32>,
    weights: Vec<[f32; 2]>,
    sun: Vec<f32>,
    modes: Vec<f32>,
    collapsed: Vec<Lanes>,
}

/// Adds to `out` (one value a pair) the light scattered more than once that arrives along the ray.
#[inline(always)]
pub fn multiple<const MODES: usize>(
    ray: &Ray,
    mu: f32,
    field: &Field,
    axis: &SunAxis,
    basis: &Basis,
    pairs: &Pairs,
    scratch: &mut Scratch,
    out: &mut [Lanes],
) {
    let count = pairs.len();
    let suns = axis.len();
    scratch.nodes.resize(count, 0);
    scratch.modes.resize(count * MODES * 2, 0.0);
    scratch.collapsed.resize(suns * MODES, Lanes::ZERO);
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    for sample in &ray.samples {
        collapse::<MODES>(
            sample.level as usize,
            sample.place,
            sample.mu,
            field,
            suns,
            basis,
            &mut scratch.collapsed,
        );
        place_pairs::<MODES>(sample, mu, sine, axis, pairs, &mut scratch.nodes, &mut scratch.modes);
        let collapsed = &scratch.collapsed[..suns * MODES];
        for ((out, node), modes) in
            out.iter_mut().zip(&scratch.nodes).zip(scratch.modes.chunks_exact(2 * MODES))
        {
            let at = *node as usize * MODES;
            let two = &collapsed[at..at + 2 * MODES];
            let mut sum = two[0] * modes[0];
            for m in 1..2 * MODES {
                sum += two[m] * modes[m];
            }
            *out += sum * sample.weight;
        }
    }
}

/// Sums the terms over degrees at a sample's own direction: one value a sun node and order.
#[inline(always)]
fn collapse<const MODES: usize>(
    level: usize,
    place: f32,
    mu: f32,
    field: &Field,
    suns: usize,
    basis: &Basis,
    out: &mut [Lanes],
) {
    let mut p = [0.0; MOST_TERMS];
    basis.fill(f64::from(mu), &mut p);
    let p = &p[..field.terms];
    let stride = suns * field.terms;
    let below = &field.values[level * stride..][..stride];
    out[..suns * MODES].fill(Lanes::ZERO);
    if place < 1.0 {
        add_terms::<MODES>(below, field.terms, p, &basis.orders, 1.0 - place, out);
    }
    if place > 0.0 {
        let above = &field.values[(level + 1) * stride..][..stride];
        add_terms::<MODES>(above, field.terms, p, &basis.orders, place, out);
    }
}

#[inline(always)]
fn add_terms<const MODES: usize>(
    from: &[Lanes],
    terms: usize,
    p: &[f32],
    orders: &[usize],
    weight: f32,
    out: &mut [Lanes],
) {
    for (node, out) in from.chunks_exact(terms).zip(out.chunks_exact_mut(MODES)) {
        for t in 0..terms {
            out[orders[t]] += node[t] * (weight * p[t]);
        }
    }
}

/// For every pair: the sun node below, and for it and the next one the factor of every order,
/// sin^m θ s^min(m,2) cos mφ at the sample times the interpolation weight.
#[inline(always)]
fn place_pairs<const MODES: usize>(
    sample: &super::rays::Sample,
    mu: f32,
    sine: f32,
    axis: &SunAxis,
    pairs: &Pairs,
    nodes: &mut [u32],
    modes: &mut [f32],
) {
    let sine2 = (1.0 - sample.mu * sample.mu).max(0.0);
    let local_sine = sine2.sqrt();
    for (p, (node, factors)) in nodes.iter_mut().zip(modes.chunks_exact_mut(2 * MODES)).enumerate() {
        let mu_s = pairs.mu_s[p] * sample.cos_turn + pairs.across[p] * sample.sin_turn;
        let nu = pairs.mu_s[p] * mu + pairs.across[p] * sine;
        let (n, t) = axis.locate(mu_s);
        *node = n;
        let s2 = 1.0 - mu_s * mu_s;
        let s2 = if s2 > 0.0 { s2 } else { 0.0 };
        let x = nu - sample.mu * mu_s;
        let lit = if t < 0.0 { 0.0 } else { 1.0 };
        let mut q = [0.0f32; MODES];
        azimuth_factors(x, s2, sine2, local_sine, &mut q);
        for m in 0..MODES {
            factors[m] = q[m] * (1.0 - t) * lit;
            factors[MODES + m] = q[m] * t * lit;
        }
    }
}

/// sin^m θ s^min(m,2) cos mφ from X = nu − mu mu_s = sinθ s cosφ.
#[inline(always)]
pub fn azimuth_factors(x: f32, s2: f32, sine2: f32, sine: f32, q: &mut [f32]) {
    q[0] = 1.0;
    if q.len() > 1 {
        q[1] = x;
    }
    if q.len() > 2 {
        let y = s2 * sine2;
        q[2] = 2.0 * x * x - y;
        if q.len() > 3 {
            // cos φ itself, bounded: where it is ill-defined the factors in front of it vanish.
            let length = y.sqrt();
            let c = x / if length > 1e-6 { length } else { 1e-6 };
            let c = if c > 1.0 { 1.0 } else { c };
            let c = if c < -1.0 { -1.0 } else { c };
            let (mut before, mut now) = (c, 2.0 * c * c - 1.0);
            let mut power = s2 * sine2;
            for slot in q.iter_mut().skip(3) {
                let next = 2.0 * c * now - before;
                (before, now) = (now, next);
                power *= sine;
                *slot = power * next;
            }
        }
    }
}

/// A group of constituents whose single scattering is integrated as one.
pub struct SingleGroup {
    /// Scattering as a share of extinction, per fine level.
    pub shares: Vec<Lanes>,
    /// For groups with a forward peak: T τ towards the sun, see [`Sunlight::times_depth`].
    pub deeper: Option<Vec<Lanes>>,
}

/// Single scattering without its phase function, one value a pair: I, and with a forward peak the integral of
/// the same light weighted by the scattering depths that it crosses to the eye and to the sun.
pub struct SingleLight<'a> {
    pub once: &'a mut [Lanes],
    pub deeper: &'a mut [Lanes],
}

/// Adds the light of one group scattered once that arrives along the ray. `behind`: scattering depth of the
/// group from the start to each sample (not read for groups without a peak).
#[inline(always)]
pub fn single(
    ray: &Ray,
    sunlight: &Sunlight,
    group: &SingleGroup,
    behind: &[Lanes],
    pairs: &Pairs,
    scratch: &mut Scratch,
    out: &mut SingleLight,
) {
    let count = pairs.len();
    scratch.nodes.resize(count, 0);
    scratch.weights.resize(count, [0.0; 2]);
    scratch.sun.resize(count, 0.0);
    for (k, sample) in ray.samples.iter().enumerate() {
        for (p, sun) in scratch.sun.iter_mut().enumerate() {
            *sun = pairs.mu_s[p] * sample.cos_turn + pairs.across[p] * sample.sin_turn;
        }
        for (level, share) in
            [(sample.level as usize, 1.0 - sample.place), (sample.level as usize + 1, sample.place)]
        {
            if share > 0.0 {
                sunlight.locate(level, &scratch.sun, &mut scratch.nodes, &mut scratch.weights);
                let factor = sample.weight * share * group.shares[level];
                let table = sunlight.level(level);
                add_light(table, factor, scratch, out.once);
                if let Some(deeper) = &group.deeper {
                    add_light(table, factor * behind[k], scratch, out.deeper);
                    add_light(sunlight.level_of(deeper, level), factor, scratch, out.deeper);
                }
            }
        }
    }
}

#[inline(always)]
fn add_light(table: &[Lanes], factor: Lanes, scratch: &Scratch, out: &mut [Lanes]) {
    for ((out, node), w) in out.iter_mut().zip(&scratch.nodes).zip(&scratch.weights) {
        let n = *node as usize;
        *out += (table[n] * w[0] + table[n + 1] * w[1]) * factor;
    }
}
