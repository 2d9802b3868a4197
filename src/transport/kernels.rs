//! The two hot loops: light scattered once and light scattered more often, along one ray, for many sun
//! positions at a time and all wavelengths of a batch.
//!
//! Sun positions come in chunks. Where a sample looks things up is found for a chunk at once (loops over plain
//! arrays, which become vector code); then whole vectors of wavelengths are gathered from there.

mod single;

use super::azimuth::{CHUNK, PairChunk, Pairs, Places, SunAxis};
use super::moments::{Basis, MOST_DEGREE, MOST_TERMS};
use super::rays::Sample;
use super::refined::RefinedAxis;
use crate::machine::lanes::Lanes;

pub(super) use single::{SingleGroup, single};

/// Sources of multiply scattered light, `[level][term][sun node]`: (2l+1)/4π Σ f χ_l I_lm.
#[derive(Clone, Debug, Default)]
pub struct Field {
    pub terms: usize,
    pub suns: usize,
    pub values: Vec<Lanes>,
}

/// Room for the kernels' intermediate values, reused from ray to ray.
#[derive(Default)]
pub(super) struct Scratch {
    /// `[sun node of the field][order]`
    coarse: Vec<Lanes>,
    /// `[group][fine sun node][order]`
    collapsed: Vec<Vec<Lanes>>,
}

/// Constituents that scatter a field by the same phase function.
pub(super) struct FieldGroup<'a> {
    pub field: &'a Field,
    pub basis: &'a Basis,
    /// What a source of 1 at each sample adds to the radiance at the start.
    pub weights: &'a [Lanes],
}

/// Orders that a kernel is compiled for: those of the basis, and some more that stay zero.
pub(super) fn compiled_modes(basis: &Basis) -> usize {
    match basis.modes {
        small @ ..=3 => small,
        4 | 5 => 5,
        6 | 7 => 7,
        8 | 9 => 9,
        10 | 11 => 11,
        _ => MOST_DEGREE + 1,
    }
}

/// Adds to `out` (`[group][pair]`) the light scattered more than once that arrives along the ray.
#[inline(always)]
pub(super) fn multiple(
    samples: &[Sample],
    mu: f32,
    groups: &[FieldGroup],
    axis: &RefinedAxis,
    pairs: &Pairs,
    scratch: &mut Scratch,
    out: &mut [Lanes],
) {
    let count = pairs.len();
    let modes = groups.iter().map(|g| compiled_modes(g.basis)).max().unwrap_or(1);
    let least = least_weight(groups.iter().map(|g| g.weights));
    scratch.collapsed.resize(groups.len(), Vec::new());
    for (k, sample) in samples.iter().enumerate() {
        if groups.iter().all(|g| largest(g.weights[k]) <= least) {
            continue;
        }
        for (group, collapsed) in groups.iter().zip(&mut scratch.collapsed) {
            collapsed.resize(axis.fine.len() * compiled_modes(group.basis), Lanes::ZERO);
            collapse(sample, group, axis, &mut scratch.coarse, collapsed);
        }
        for (c, chunk) in pairs.chunks.iter().enumerate() {
            let sun = chunk.turned(sample.cos_turn, sample.sin_turn);
            let places = axis.fine.places(&sun);
            let azimuth = azimuth_factors(sample, mu, chunk, &sun, modes);
            for (g, (group, collapsed)) in groups.iter().zip(&scratch.collapsed).enumerate() {
                let out = &mut out[g * count..][..count][c * CHUNK..];
                let weight = group.weights[k];
                add_field(compiled_modes(group.basis), collapsed, &places, &azimuth, weight, out);
            }
        }
    }
}

/// Adds one sample's light for all pairs, from values at the fine sun nodes with `modes` orders each.
#[inline(always)]
pub(super) fn add_sample(
    sample: &Sample,
    mu: f32,
    modes: usize,
    collapsed: &[Lanes],
    axis: &SunAxis,
    pairs: &Pairs,
    out: &mut [Lanes],
) {
    let one = Lanes::splat(1.0);
    for (c, chunk) in pairs.chunks.iter().enumerate() {
        let sun = chunk.turned(sample.cos_turn, sample.sin_turn);
        let places = axis.places(&sun);
        let azimuth = azimuth_factors(sample, mu, chunk, &sun, modes);
        let out = &mut out[c * CHUNK..];
        add_field(modes, collapsed, &places, &azimuth, one, out);
    }
}

/// Adds a chunk's light of one sample: linear between sun nodes, summed over the orders, whose number the compiler
/// has to know.
#[inline(always)]
fn add_field(
    modes: usize,
    collapsed: &[Lanes],
    places: &Places,
    azimuth: &AzimuthFactors,
    weight: Lanes,
    out: &mut [Lanes],
) {
    match modes {
        1 => add_orders::<1>(collapsed, places, azimuth, weight, out),
        2 => add_orders::<2>(collapsed, places, azimuth, weight, out),
        3 => add_orders::<3>(collapsed, places, azimuth, weight, out),
        5 => add_orders::<5>(collapsed, places, azimuth, weight, out),
        7 => add_orders::<7>(collapsed, places, azimuth, weight, out),
        9 => add_orders::<9>(collapsed, places, azimuth, weight, out),
        11 => add_orders::<11>(collapsed, places, azimuth, weight, out),
        _ => add_orders::<{ MOST_DEGREE + 1 }>(collapsed, places, azimuth, weight, out),
    }
}

#[inline(always)]
fn add_orders<const MODES: usize>(
    collapsed: &[Lanes],
    places: &Places,
    azimuth: &AzimuthFactors,
    weight: Lanes,
    out: &mut [Lanes],
) {
    let mut low = [[0.0f32; CHUNK]; MODES];
    let mut high = [[0.0f32; CHUNK]; MODES];
    for m in 0..MODES {
        for k in 0..CHUNK {
            low[m][k] = azimuth[m][k] * places.low[k];
            high[m][k] = azimuth[m][k] * places.high[k];
        }
    }
    for (k, out) in (0..CHUNK).zip(out) {
        let two = &collapsed[places.nodes[k] as usize * MODES..][..2 * MODES];
        let mut sum = two[0] * low[0][k] + two[MODES] * high[0][k];
        for m in 1..MODES {
            sum += two[m] * low[m][k] + two[MODES + m] * high[m][k];
        }
        *out += sum * weight;
    }
}

/// Sums the terms over degrees at a sample's own direction and place between levels: one value a fine sun node
/// and order.
#[inline(always)]
fn collapse(
    sample: &Sample,
    group: &FieldGroup,
    axis: &RefinedAxis,
    coarse: &mut Vec<Lanes>,
    out: &mut [Lanes],
) {
    let mut p = [0.0; MOST_TERMS];
    group.basis.fill(f64::from(sample.mu), &mut p);
    let stride = compiled_modes(group.basis);
    let Field { terms, suns, values } = group.field;
    coarse.resize(suns * stride, Lanes::ZERO);
    let sums = if axis.beforehand { &mut *out } else { &mut coarse[..suns * stride] };
    sums.fill(Lanes::ZERO);
    for m in 0..stride {
        // Rows of the field and their factors.
        let mut parts = [(0usize, 0.0f32); 2 * (MOST_DEGREE + 1)];
        let mut count = 0;
        for (level, share) in [(sample.level, 1.0 - sample.place), (sample.level + 1, sample.place)] {
            for t in group.basis.of_order(m).filter(|_| share > 0.0) {
                parts[count] = ((level as usize * terms + t) * suns, share * p[t]);
                count += 1;
            }
        }
        for parts in parts[..count].chunks(4) {
            let sums = sums[m..].iter_mut().step_by(stride);
            match parts.len() {
                1 => add_rows::<1>(values, parts, *suns, sums),
                2 => add_rows::<2>(values, parts, *suns, sums),
                3 => add_rows::<3>(values, parts, *suns, sums),
                _ => add_rows::<4>(values, parts, *suns, sums),
            }
        }
    }
    if !axis.beforehand {
        axis.refine(&coarse[..suns * stride], stride, out);
    }
}

#[inline(always)]
fn add_rows<'a, const N: usize>(
    values: &[Lanes],
    parts: &[(usize, f32)],
    suns: usize,
    out: impl Iterator<Item = &'a mut Lanes>,
) {
    let factors: [f32; N] = std::array::from_fn(|k| parts[k].1);
    let rows: [&[Lanes]; N] = std::array::from_fn(|k| &values[parts[k].0..][..suns]);
    for (node, out) in (0..suns).zip(out) {
        let mut sum = rows[0][node] * factors[0];
        for k in 1..N {
            sum += rows[k][node] * factors[k];
        }
        *out += sum;
    }
}

/// sin^m θ s^min(m,2) cos mφ, `[order m][pair]`.
type AzimuthFactors = [[f32; CHUNK]; MOST_DEGREE + 1];

/// The factors of the first `modes` orders at a sample. From X = nu − mu mu_s = sinθ s cosφ, by cos (m+1)φ =
/// 2 cosφ cos mφ − cos (m−1)φ; cosφ is bounded, and where it is ill-defined the factors in front of it vanish.
#[inline(always)]
fn azimuth_factors(
    sample: &Sample,
    mu: f32,
    chunk: &PairChunk,
    sun: &[f32; CHUNK],
    modes: usize,
) -> AzimuthFactors {
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    let sine2 = (1.0 - sample.mu * sample.mu).max(0.0);
    let mut q = [[0.0f32; CHUNK]; MOST_DEGREE + 1];
    let mut y = [0.0f32; CHUNK];
    for k in 0..CHUNK {
        let s2 = 1.0 - sun[k] * sun[k];
        let x = chunk.mu_s[k] * mu + chunk.across[k] * sine - sample.mu * sun[k];
        y[k] = (if s2 > 0.0 { s2 } else { 0.0 }) * sine2;
        q[0][k] = 1.0;
        q[1][k] = x;
        q[2][k] = 2.0 * x * x - y[k];
    }
    if modes <= 3 {
        return q;
    }
    let local_sine = sine2.sqrt();
    let (mut c, mut now) = ([0.0f32; CHUNK], [0.0f32; CHUNK]);
    for k in 0..CHUNK {
        let length = y[k].sqrt();
        let ratio = q[1][k] / if length > 1e-6 { length } else { 1e-6 };
        let ratio = if ratio > 1.0 { 1.0 } else { ratio };
        c[k] = if ratio < -1.0 { -1.0 } else { ratio };
        now[k] = 2.0 * c[k] * c[k] - 1.0;
    }
    let (mut before, mut power) = (c, y);
    for q in &mut q[3..modes] {
        for k in 0..CHUNK {
            let next = 2.0 * c[k] * now[k] - before[k];
            before[k] = now[k];
            now[k] = next;
            power[k] *= local_sine;
            q[k] = power[k] * next;
        }
    }
    q
}

/// The same factor for one pair: sin^m θ s^min(m,2) cos mφ.
pub(super) fn azimuth_factor(m: usize, x: f32, s2: f32, sine2: f32) -> f32 {
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

/// What a sample may add, as a share of the ray's largest, and still be left out: haze high up.
pub(super) const NEGLIGIBLE: f32 = 1e-7;

fn least_weight<'a>(weights: impl Iterator<Item = &'a [Lanes]>) -> f32 {
    NEGLIGIBLE * weights.flatten().map(|w| largest(*w)).fold(0.0, f32::max)
}

/// The largest lane.
#[inline(always)]
pub(super) fn largest(v: Lanes) -> f32 {
    v.0.iter().fold(0.0, |a, &b| if b > a { b } else { a })
}
