//! Texels of the scattering tables: light of every ray under every sun, as a mean source.

use super::edges::{self, Ray};
use crate::colour::weights::ColourWeights;
use crate::machine::lanes::Lanes;
use crate::mapping::Elek2010;
use crate::transport::Phase;
use crate::transport::fill::{RayIntegrator, RayLight, SunPairs, Wanted};
use crate::transport::solve::Solution;
use rayon::prelude::*;

/// What a mean source is the mean over: the opacity of the ray, or that without what only absorbs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Over {
    All,
    Scatterers,
}

/// Mean sources at the four wavelengths, `[group][ray order]`; light scattered more than once counts for the first
/// group, and so does that which the last `folded` groups scatter once, if both are wanted.
pub(super) fn fill(
    solution: &Solution,
    palette: &ColourWeights,
    mapping: &Elek2010,
    groups: &[Vec<usize>],
    wanted: Wanted,
    (over, folded): (Over, usize),
) -> Vec<Vec<[f32; 4]>> {
    let [altitudes, views, suns, azimuths] = mapping.size();
    let mu_s: Vec<f64> = (0..suns).map(|k| mapping.mu_s(k)).collect();
    let cosines = mapping.cos_azimuths();
    let pairs = SunPairs::new(&mu_s, &cosines);
    // Texels that one pair each is found for, or, where the azimuth is averaged out, several.
    let (each, kept) = (cosines.len() / azimuths, suns * azimuths);
    let count = groups.len();
    // `[ray][group][pair]`, so that a ray's texels lie together.
    let mut texels = vec![[0.0f32; 4]; altitudes * views * count * kept];
    for batch in &solution.batches {
        let four: Vec<(usize, usize)> = (palette.four.iter().enumerate())
            .filter(|(_, w)| (batch.first..batch.first + batch.optics.count).contains(w))
            .map(|(k, w)| (k, w - batch.first))
            .collect();
        if four.is_empty() || count == 0 {
            continue;
        }
        let painter = RayIntegrator::new(solution, batch, groups).together();
        let ray = |(altitude, (mu, hits_ground)): Ray, light: &mut RayLight, out: &mut [[f32; 4]]| {
            painter.ray(mapping.radii()[0] + altitude, mu, hits_ground, &pairs, wanted, light);
            for group in count - folded..count {
                fold(light, &batch.optics.phase[groups[group][0]], group, mu as f32, &pairs);
            }
            let source = if wanted == Wanted::Single { &light.single } else { &light.multiple };
            let depth = if over == Over::All { light.depth } else { light.scatterers_depth };
            let inverse = inverse_opacity(depth);
            for (texel, values) in out.iter_mut().zip(source.chunks_exact(each)) {
                for &(k, w) in &four {
                    let sum: f32 = values.iter().map(|v| v[w]).sum();
                    texel[k] = if each == 1 { sum * inverse[w] } else { sum * inverse[w] / each as f32 };
                }
            }
        };
        texels.par_chunks_mut(count * kept).enumerate().for_each_init(
            RayLight::default,
            |light, (n, out)| {
                let altitude = mapping.inner_altitude(n / views);
                ray((altitude, mapping.mu(altitude, n % views)), light, out);
            },
        );
        if wanted == Wanted::Single {
            edges::bridge(&mut texels, mapping, [count, kept], &four, ray);
        }
    }
    (0..count)
        .map(|g| {
            let part = |ray: &[[f32; 4]]| ray[g * kept..][..kept].to_vec();
            texels.chunks(count * kept).flat_map(part).collect()
        })
        .collect()
}

/// Adds what a group scatters once, with its phase function, to what the first scatters more often.
fn fold(light: &mut RayLight, phase: &Phase, group: usize, mu: f32, pairs: &SunPairs) {
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    for p in 0..pairs.len() {
        let nu = (pairs.mu_s[p] * mu + pairs.across[p] * sine).clamp(-1.0, 1.0);
        light.multiple[p] += light.single[group * pairs.len() + p] * phase.value(nu);
    }
}

/// 1 / (1 − e^−τ), and 0 where there is nothing on the ray.
fn inverse_opacity(depth: Lanes) -> Lanes {
    depth.map(|d| if d > 0.0 { (-1.0 / libm::expm1(-f64::from(d))) as f32 } else { 0.0 })
}
