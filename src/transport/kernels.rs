//! The two hot loops: light scattered once and light scattered more often, along one ray, for many sun
//! positions at a time and all wavelengths of a batch.
//!
//! Both first find, for all sun positions at once, where a sample looks things up (loops over plain arrays,
//! which become vector code), then gather whole vectors of wavelengths from there.

use super::azimuth::{Pairs, SunAxis};
use super::moments::{Basis, MOST_TERMS};
use super::rays::{Ray, Sample};
use super::sunlight::Sunlight;
use crate::lanes::Lanes;

/// Sources of multiply scattered light, `[level][sun node][term]`: (2l+1)/4π Σ f χ_l I_lm.
#[derive(Clone, Debug)]
pub struct Field {
    pub terms: usize,
    pub values: Vec<Lanes>,
}

/// Room for a kernel's intermediate values, reused from ray to ray.
#[derive(Default)]
pub struct Scratch {
    sun: Vec<f32>,
    nodes: Vec<u32>,
    low: Vec<f32>,
    high: Vec<f32>,
    /// `[factor][pair]`
    factors: Vec<f32>,
    collapsed: Vec<Lanes>,
}

impl Scratch {
    #[inline(always)]
    fn resize(&mut self, count: usize) {
        self.sun.resize(count, 0.0);
        self.nodes.resize(count, 0);
        self.low.resize(count, 0.0);
        self.high.resize(count, 0.0);
    }

    /// The sun's zenith cosine at a sample, for all pairs.
    #[inline(always)]
    fn turn_sun(&mut self, sample: &Sample, pairs: &Pairs) {
        for ((sun, mu_s), across) in self.sun.iter_mut().zip(&pairs.mu_s).zip(&pairs.across) {
            *sun = mu_s * sample.cos_turn + across * sample.sin_turn;
        }
    }
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
    scratch.resize(count);
    scratch.factors.resize(count * MODES * 2, 0.0);
    scratch.collapsed.resize(suns * MODES, Lanes::ZERO);
    let least = NEGLIGIBLE * ray.samples.iter().map(|s| largest(s.weight)).fold(0.0, f32::max);
    for sample in ray.samples.iter().filter(|s| largest(s.weight) > least) {
        collapse::<MODES>(sample, field, suns, basis, &mut scratch.collapsed);
        scratch.turn_sun(sample, pairs);
        axis.locate_all(&scratch.sun, &mut scratch.nodes, &mut scratch.low, &mut scratch.high);
        place_pairs::<MODES>(sample, mu, pairs, scratch);
        let collapsed = &scratch.collapsed[..suns * MODES];
        let factors: [&[f32]; 2] = {
            let (low, high) = scratch.factors.split_at(count * MODES);
            [low, &high[..count * MODES]]
        };
        for (p, (out, node)) in out.iter_mut().zip(&scratch.nodes).enumerate() {
            let at = *node as usize * MODES;
            let two = &collapsed[at..at + 2 * MODES];
            let mut sum = two[0] * factors[0][p] + two[MODES] * factors[1][p];
            for m in 1..MODES {
                sum += two[m] * factors[0][m * count + p] + two[MODES + m] * factors[1][m * count + p];
            }
            *out += sum * sample.weight;
        }
    }
}

/// Sums the terms over degrees at a sample's own direction: one value a sun node and order.
#[inline(always)]
fn collapse<const MODES: usize>(
    sample: &Sample,
    field: &Field,
    suns: usize,
    basis: &Basis,
    out: &mut [Lanes],
) {
    let mut p = [0.0; MOST_TERMS];
    basis.fill(f64::from(sample.mu), &mut p);
    let terms = field.terms;
    let stride = suns * terms;
    let level = sample.level as usize;
    let below = &field.values[level * stride..][..stride];
    if sample.place == 0.0 {
        sum_terms::<MODES>(below, terms, &p, basis, out);
        return;
    }
    let above = &field.values[(level + 1) * stride..][..stride];
    if sample.place == 1.0 {
        sum_terms::<MODES>(above, terms, &p, basis, out);
        return;
    }
    for (node, out) in out.chunks_exact_mut(MODES).enumerate() {
        let (below, above) = (&below[node * terms..][..terms], &above[node * terms..][..terms]);
        for (m, out) in out.iter_mut().enumerate() {
            let mut sum = Lanes::ZERO;
            for t in basis.of_order(m) {
                sum += (below[t] * (1.0 - sample.place) + above[t] * sample.place) * p[t];
            }
            *out = sum;
        }
    }
}

#[inline(always)]
fn sum_terms<const MODES: usize>(
    from: &[Lanes],
    terms: usize,
    p: &[f32; MOST_TERMS],
    basis: &Basis,
    out: &mut [Lanes],
) {
    for (node, out) in from.chunks_exact(terms).zip(out.chunks_exact_mut(MODES)) {
        for (m, out) in out.iter_mut().enumerate() {
            let mut sum = Lanes::ZERO;
            for t in basis.of_order(m) {
                sum += node[t] * p[t];
            }
            *out = sum;
        }
    }
}

/// For every pair and order m the factor sin^m θ s^min(m,2) cos mφ at the sample, times the weight of the sun
/// node below and of the next one. From X = nu − mu mu_s = sinθ s cosφ, by cos (m+1)φ = 2 cosφ cos mφ −
/// cos (m−1)φ; cosφ is bounded, and where it is ill-defined the factors in front of it vanish.
#[inline(always)]
fn place_pairs<const MODES: usize>(sample: &Sample, mu: f32, pairs: &Pairs, scratch: &mut Scratch) {
    const CHUNK: usize = 16;
    let count = pairs.len();
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    let sine2 = (1.0 - sample.mu * sample.mu).max(0.0);
    let local_sine = sine2.sqrt();
    let (low, high) = scratch.factors.split_at_mut(count * MODES);
    for from in (0..count).step_by(CHUNK) {
        let n = CHUNK.min(count - from);
        // The last chunk is filled up with copies of its first pair.
        let pair = |k: usize| from + if k < n { k } else { 0 };
        let (mut x, mut y, mut c) = ([0.0f32; CHUNK], [0.0f32; CHUNK], [0.0f32; CHUNK]);
        for k in 0..CHUNK {
            let p = pair(k);
            let sun = scratch.sun[p];
            let s2 = 1.0 - sun * sun;
            x[k] = pairs.mu_s[p] * mu + pairs.across[p] * sine - sample.mu * sun;
            y[k] = (if s2 > 0.0 { s2 } else { 0.0 }) * sine2;
        }
        for k in 0..CHUNK {
            let length = y[k].sqrt();
            let ratio = x[k] / if length > 1e-6 { length } else { 1e-6 };
            let ratio = if ratio > 1.0 { 1.0 } else { ratio };
            c[k] = if ratio < -1.0 { -1.0 } else { ratio };
        }
        let mut q = [[0.0f32; CHUNK]; MODES];
        let (mut before, mut now, mut power) = (c, [0.0f32; CHUNK], y);
        for k in 0..CHUNK {
            now[k] = 2.0 * c[k] * c[k] - 1.0;
            q[0][k] = 1.0;
            if MODES > 1 {
                q[1][k] = x[k];
            }
            if MODES > 2 {
                q[2][k] = 2.0 * x[k] * x[k] - y[k];
            }
        }
        for q in q.iter_mut().skip(3) {
            for k in 0..CHUNK {
                let next = 2.0 * c[k] * now[k] - before[k];
                before[k] = now[k];
                now[k] = next;
                power[k] *= local_sine;
                q[k] = power[k] * next;
            }
        }
        for (m, q) in q.iter().enumerate() {
            let at = m * count + from;
            let weights = scratch.low[from..from + n].iter().zip(&scratch.high[from..from + n]);
            let out = low[at..at + n].iter_mut().zip(&mut high[at..at + n]);
            for (((low, high), (w0, w1)), q) in out.zip(weights).zip(q) {
                *low = q * w0;
                *high = q * w1;
            }
        }
    }
}

/// The same factor for one pair: sin^m θ s^min(m,2) cos mφ.
pub fn azimuth_factor(m: usize, x: f32, s2: f32, sine2: f32) -> f32 {
    let y = s2 * sine2;
    match m {
        0 => 1.0,
        1 => x,
        2 => 2.0 * x * x - y,
        _ => {
            let c = (x / y.sqrt().max(1e-6)).clamp(-1.0, 1.0);
            let (mut before, mut now) = (c, 2.0 * c * c - 1.0);
            let mut power = y;
            for _ in 2..m {
                (before, now) = (now, 2.0 * c * now - before);
                power *= sine2.sqrt();
            }
            power * now
        }
    }
}

/// A group of constituents whose single scattering is integrated as one, along one ray.
pub struct SingleGroup<'a> {
    /// What sunlight at each sample adds to the radiance at the start, see [`super::rays::Path`].
    pub weights: Vec<Lanes>,
    /// For groups with a forward peak: T τ towards the sun, see [`Sunlight::times_depth`].
    pub deeper: Option<&'a [Lanes]>,
}

/// Adds to `once` (`[group][pair]`) the light of each group scattered once that arrives along the ray, without
/// its phase function; and to `deeper`, for groups with a forward peak, the same light weighted by the
/// scattering depth that it crossed from the sun.
#[inline(always)]
pub fn single(
    ray: &Ray,
    sunlight: &Sunlight,
    groups: &[SingleGroup],
    pairs: &Pairs,
    scratch: &mut Scratch,
    once: &mut [Lanes],
    deeper: &mut [Lanes],
) {
    let count = pairs.len();
    scratch.resize(count);
    let brightest = |g: &SingleGroup| g.weights.iter().map(|w| largest(*w)).fold(0.0, f32::max);
    let least = NEGLIGIBLE * groups.iter().map(brightest).fold(0.0, f32::max);
    for (k, sample) in ray.samples.iter().enumerate() {
        let counts = |g: &SingleGroup| largest(g.weights[k]) > least;
        if !groups.iter().any(counts) {
            continue;
        }
        scratch.turn_sun(sample, pairs);
        let level = sample.level as usize;
        for (level, share) in [(level, 1.0 - sample.place), (level + 1, sample.place)] {
            if share <= 0.0 {
                continue;
            }
            sunlight.locate(level, &scratch.sun, &mut scratch.nodes, &mut scratch.low, &mut scratch.high);
            let table = sunlight.level(level);
            if let [a, b] = groups
                && counts(a)
                && counts(b)
            {
                let (first, second) = once.split_at_mut(count);
                add_light(
                    table,
                    [a.weights[k] * share, b.weights[k] * share],
                    scratch,
                    [first, &mut second[..count]],
                );
            } else {
                for (group, once) in
                    groups.iter().zip(once.chunks_exact_mut(count)).filter(|(g, _)| counts(g))
                {
                    add_light(table, [group.weights[k] * share], scratch, [once]);
                }
            }
            for (g, group) in groups.iter().enumerate().filter(|(_, g)| counts(g)) {
                if let Some(depths) = group.deeper {
                    let depths = sunlight.level_of(depths, level);
                    let out = &mut deeper[g * count..][..count];
                    add_light(depths, [group.weights[k] * share], scratch, [out]);
                }
            }
        }
    }
}

/// What a sample may add, as a share of the ray's largest, and still be left out: haze high up.
pub const NEGLIGIBLE: f32 = 1e-7;

/// The largest lane.
#[inline(always)]
pub fn largest(v: Lanes) -> f32 {
    v.0.iter().fold(0.0, |a, &b| if b > a { b } else { a })
}

#[inline(always)]
fn add_light<const N: usize>(
    table: &[Lanes],
    factors: [Lanes; N],
    scratch: &Scratch,
    out: [&mut [Lanes]; N],
) {
    let places = scratch.nodes.iter().zip(&scratch.low).zip(&scratch.high);
    for (p, ((node, low), high)) in places.enumerate() {
        let two = &table[*node as usize..][..2];
        let light = two[0] * *low + two[1] * *high;
        for g in 0..N {
            out[g][p] += light * factors[g];
        }
    }
}
