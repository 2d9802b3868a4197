//! Light scattered once.

use super::{largest, least_weight};
use crate::machine::lanes::Lanes;
use crate::transport::azimuth::{CHUNK, Pairs, Places};
use crate::transport::rays::Sample;
use crate::transport::sunlight::Sunlight;

/// A group of constituents whose single scattering is integrated as one, along one ray.
pub(crate) struct SingleGroup<'a> {
    /// What sunlight at each sample adds to the radiance at the start, see [`crate::transport::rays::Attenuation`].
    pub weights: Vec<Lanes>,
    /// For groups with a forward peak: T τ towards the sun, see [`Sunlight::times_depth`].
    pub deeper: Option<&'a [Lanes]>,
}

/// Adds to `once` (`[group][pair]`) the light of each group scattered once that arrives along the ray, without
/// its phase function; and to `deeper`, for groups with a forward peak, the same light weighted by the
/// scattering depth that it crossed from the sun.
#[inline(always)]
pub(crate) fn single(
    samples: &[Sample],
    sunlight: &Sunlight,
    groups: &[SingleGroup],
    pairs: &Pairs,
    once: &mut [Lanes],
    deeper: &mut [Lanes],
) {
    let count = pairs.len();
    let looks = looks(samples, sunlight, groups);
    let weights = |g: &SingleGroup| looks.iter().map(|l| g.weights[l.sample] * l.share).collect::<Vec<_>>();
    let mut outputs: Vec<Output> = (groups.iter().zip(once.chunks_exact_mut(count)))
        .map(|(group, out)| Output { weights: weights(group), out })
        .collect();
    for outputs in outputs.chunks_mut(4) {
        match outputs {
            [a] => add_light(&looks, sunlight, sunlight.all(), pairs, [a]),
            [a, b] => add_light(&looks, sunlight, sunlight.all(), pairs, [a, b]),
            [a, b, c] => add_light(&looks, sunlight, sunlight.all(), pairs, [a, b, c]),
            [a, b, c, d] => add_light(&looks, sunlight, sunlight.all(), pairs, [a, b, c, d]),
            _ => unreachable!("chunks of four"),
        }
    }
    for (group, out) in groups.iter().zip(deeper.chunks_exact_mut(count)) {
        if let Some(depths) = group.deeper {
            add_light(&looks, sunlight, depths, pairs, [&mut Output { weights: weights(group), out }]);
        }
    }
}

/// One look at the table of sunlight: a sample on one of the two levels that it lies between.
#[derive(Clone, Copy)]
struct Look {
    sample: usize,
    level: usize,
    cos_turn: f32,
    sin_turn: f32,
    /// Weight of this level; 0 where a block was filled up.
    share: f32,
}

/// What is summed along the ray: a weight for each look, and one value a pair.
struct Output<'a> {
    weights: Vec<Lanes>,
    out: &'a mut [Lanes],
}

/// Looks that are summed before anything is stored.
const BLOCK: usize = 4;

/// All looks of a ray that matter, where the sun shines, filled up to whole blocks.
fn looks(samples: &[Sample], sunlight: &Sunlight, groups: &[SingleGroup]) -> Vec<Look> {
    let least = least_weight(groups.iter().map(|g| g.weights.as_slice()));
    let mut looks: Vec<Look> = Vec::with_capacity(samples.len() + BLOCK);
    for (k, s) in samples.iter().enumerate() {
        if groups.iter().any(|g| largest(g.weights[k]) > least) {
            let (cos_turn, sin_turn, level) = (s.cos_turn, s.sin_turn, s.level as usize);
            for (level, share) in [(level, 1.0 - s.place), (level + 1, s.place)] {
                if share > 0.0 && !sunlight.is_dark(level) {
                    looks.push(Look { sample: k, level, cos_turn, sin_turn, share });
                }
            }
        }
    }
    if let Some(&last) = looks.last() {
        looks.resize(looks.len().next_multiple_of(BLOCK), Look { share: 0.0, ..last });
    }
    looks
}

/// Adds to each output the values of a table like that of `sunlight`, weighted and summed over all looks.
#[inline(always)]
fn add_light<const N: usize>(
    looks: &[Look],
    sunlight: &Sunlight,
    table: &[Lanes],
    pairs: &Pairs,
    outputs: [&mut Output; N],
) {
    for (b, looks) in looks.chunks_exact(BLOCK).enumerate() {
        let rows: [&[Lanes]; BLOCK] = std::array::from_fn(|i| sunlight.level_of(table, looks[i].level));
        let weights: [[Lanes; N]; BLOCK] =
            std::array::from_fn(|i| std::array::from_fn(|n| outputs[n].weights[b * BLOCK + i]));
        for (c, chunk) in pairs.chunks.iter().enumerate() {
            let mut places = [Places::NONE; BLOCK];
            for (places, look) in places.iter_mut().zip(looks) {
                sunlight.place(look.level, &chunk.turned(look.cos_turn, look.sin_turn), places);
            }
            if places.iter().all(Places::is_dark) {
                continue;
            }
            let here = c * CHUNK..pairs.len().min((c + 1) * CHUNK);
            for (k, p) in (0..CHUNK).zip(here) {
                let mut sums: [Lanes; N] = std::array::from_fn(|n| outputs[n].out[p]);
                for i in 0..BLOCK {
                    let two = &rows[i][places[i].nodes[k] as usize..][..2];
                    let light = two[0] * places[i].low[k] + two[1] * places[i].high[k];
                    for n in 0..N {
                        sums[n] += light * weights[i][n];
                    }
                }
                for n in 0..N {
                    outputs[n].out[p] = sums[n];
                }
            }
        }
    }
}
