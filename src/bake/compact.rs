//! The compact layout: spectral radiance at four wavelengths, single scattering apart for each phase function.
//!
//! Every table holds ln S̄ − c of S̄ = I / (1 − e^−τ), a mean source, which varies far less than the light itself
//! and has no gamut to leave. τ is the optical depth of the ray without the constituents that absorb only: those
//! come and go with altitude and would leave their edges in S̄. A look-up is
//!   I = (1 − e^−τ) (Σ_g p_g(ν) S̄_g + S̄_multiple),   1 − e^−τ = −expm1(−τ).

use super::extinction::{Held, Matter, channels, phase, table};
use super::palette::Palette;
use super::tables::{Baked, axes_of, axis, file_order};
use crate::export::manifest::Encoding;
use crate::lanes::Lanes;
use crate::medium::Medium;
use crate::table::{Bends, Elek2010, SunCurve};
use crate::transport::fill::{Painter, RayLight, SunPairs, Wanted};
use crate::transport::solve::Solution;
use rayon::prelude::*;

/// Name of the layout and of its folder.
pub const LAYOUT: &str = "compact";
/// Texels of each single-scattering table: altitude, view, sun, azimuth.
pub const SINGLE_SIZE: [usize; 4] = [24, 44, 40, 8];
/// Texels of the multiple-scattering table.
pub const MULTIPLE_SIZE: [usize; 4] = [16, 44, 40, 10];
const DEPTH_SIZE: [usize; 2] = [48, 128];
const IRRADIANCE_SIZE: usize = 128;
/// Stored logarithms at or below this stand for darkness.
pub const FLOOR: f64 = -24.0;
/// The sun axis of single scattering, closest where the planet's shadow crosses the air, with a texel where it
/// meets the ground. Without its phase function it hardly depends on the azimuth.
const SINGLE_SUN: SunCurve = SunCurve::Rational { shift: 0.05, width: 0.13 };
/// The sun axis of the rest, closest where the sun is a little below the horizon (0.728² is half of 1 + 0.06). Its
/// light depends on the angle to the sun, so that steps near the zenith are steps in s cos φ.
const MULTIPLE_SUN: SunCurve = SunCurve::HalfAngle { centre: 0.728, width: 0.13 };

/// The paper's view axis spends few texels near the zenith, where light varies with azimuth, and few close over the
/// horizon, where, from a height, the rays leave the haze. Haze also wants more altitudes near the ground than the
/// paper has. Light scattered more often varies less with either.
const SINGLE_BENDS: Bends = Bends { altitude_bend: 1.5, view_power: 1.5, horizon_power: 2.4 };
const MULTIPLE_BENDS: Bends = Bends { altitude_bend: 1.5, view_power: 1.5, horizon_power: 1.5 };
const DEPTH_BENDS: Bends = Bends { altitude_bend: 1.0, view_power: 1.5, horizon_power: 1.5 };

fn mapping(medium: &Medium, size: [usize; 4], sun: SunCurve, bends: Bends) -> Elek2010 {
    let mapping = Elek2010::new(medium.ground_radius, medium.top_radius, size);
    let mapping = mapping.expect("sizes are checked with the arguments");
    let sun = sun.with_texel_at_horizon(mapping.mu_s_min(), size[2]);
    mapping.with_curves(sun, bends)
}

/// Lists of constituents that share a phase function at every wavelength.
pub fn groups(medium: &Medium) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (c, constituent) in medium.constituents.iter().enumerate().filter(|(_, c)| c.scatters()) {
        match groups.iter_mut().find(|g| medium.constituents[g[0]].phase == constituent.phase) {
            Some(group) => group.push(c),
            None => groups.push(vec![c]),
        }
    }
    groups
}

/// Sizes of the single and multiple scattering tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    pub single: [usize; 4],
    pub multiple: [usize; 4],
}

impl Default for Sizes {
    fn default() -> Self {
        Sizes { single: SINGLE_SIZE, multiple: MULTIPLE_SIZE }
    }
}

/// The tables of the layout. Returns them and the number of multiple-scattering values that were not positive
/// where there is light.
pub fn tables(medium: &Medium, solution: &Solution, palette: &Palette, sizes: Sizes) -> (Vec<Baked>, usize) {
    let groups = groups(medium);
    let single = mapping(medium, sizes.single, SINGLE_SUN, SINGLE_BENDS);
    let multiple = mapping(medium, sizes.multiple, MULTIPLE_SUN, MULTIPLE_BENDS);
    let of_depth = mapping(medium, sizes.multiple, MULTIPLE_SUN, DEPTH_BENDS);
    let mut out = Vec::new();
    let singles = fill(solution, palette, &single, &groups, Wanted::Single);
    for (group, texels) in groups.iter().zip(singles) {
        let name = format!("single_{}", medium.constituents[group[0]].name);
        out.push(encode(
            name,
            "single scattering without phase function over 1 - T",
            texels,
            &single,
            palette,
        ));
    }
    let mut rest = fill(solution, palette, &multiple, &groups, Wanted::Multiple).into_iter();
    let first = rest.next().unwrap_or_else(|| vec![[0.0; 4]; multiple.size().iter().product()]);
    let sum = rest.fold(first, |mut sum, more| {
        sum.iter_mut().zip(more).for_each(|(s, m)| (0..4).for_each(|k| s[k] += m[k]));
        sum
    });
    let negative = sum.iter().flatten().filter(|v| **v < 0.0).count();
    out.push(encode("multiple".into(), "light scattered more than once over 1 - T", sum, &multiple, palette));
    let depth =
        |which| table(medium, solution, palette, LAYOUT, &of_depth, DEPTH_SIZE, Held::LogOfMean, which);
    out.push(depth(Matter::All));
    if medium.constituents.iter().any(|c| !c.scatters()) {
        out.push(depth(Matter::Scatterers));
    }
    out.push(irradiance(solution, palette, &multiple));
    if !groups.is_empty() {
        out.push(phase(medium, palette, LAYOUT, &groups));
    }
    (out, negative)
}

/// Mean sources at the four wavelengths, `[group][ray order]`.
fn fill(
    solution: &Solution,
    palette: &Palette,
    mapping: &Elek2010,
    groups: &[Vec<usize>],
    wanted: Wanted,
) -> Vec<Vec<[f32; 4]>> {
    let [altitudes, views, suns, azimuths] = mapping.size();
    let mu_s: Vec<f64> = (0..suns).map(|k| mapping.mu_s(k)).collect();
    let cosines: Vec<f64> = (0..azimuths).map(|l| mapping.cos_azimuth(l)).collect();
    let pairs = SunPairs::new(&mu_s, &cosines);
    let count = groups.len();
    // `[ray][group][pair]`, so that a ray's texels lie together.
    let mut texels = vec![[0.0f32; 4]; altitudes * views * count * pairs.len()];
    for batch in &solution.batches {
        let four: Vec<(usize, usize)> = (palette.four.iter().enumerate())
            .filter(|(_, w)| (batch.first..batch.first + batch.optics.count).contains(w))
            .map(|(k, w)| (k, w - batch.first))
            .collect();
        if four.is_empty() || count == 0 {
            continue;
        }
        let painter = Painter::new(solution, batch, groups).together();
        texels.par_chunks_mut(count * pairs.len()).enumerate().for_each_init(
            RayLight::default,
            |light, (ray, out)| {
                let altitude = mapping.inner_altitude(ray / views);
                let (mu, hits_ground) = mapping.mu(altitude, ray % views);
                painter.ray(mapping.radii()[0] + altitude, mu, hits_ground, &pairs, wanted, light);
                let source = if wanted == Wanted::Single { &light.single } else { &light.multiple };
                let inverse = inverse_opacity(light.scatterers_depth);
                for (texel, value) in out.iter_mut().zip(source) {
                    for &(k, w) in &four {
                        texel[k] = value[w] * inverse[w];
                    }
                }
            },
        );
    }
    (0..count)
        .map(|g| {
            let part = |ray: &[[f32; 4]]| ray[g * pairs.len()..][..pairs.len()].to_vec();
            texels.chunks(count * pairs.len()).flat_map(part).collect()
        })
        .collect()
}

/// 1 / (1 − e^−τ), and 0 where there is nothing on the ray.
fn inverse_opacity(depth: Lanes) -> Lanes {
    depth.map(|d| if d > 0.0 { (-1.0 / libm::expm1(-f64::from(d))) as f32 } else { 0.0 })
}

/// ln S̄ − c, with c the mean logarithm of the brighter half of the table, by day: there halves are finest.
fn encode(
    name: String,
    quantity: &str,
    texels: Vec<[f32; 4]>,
    mapping: &Elek2010,
    palette: &Palette,
) -> Baked {
    let mut logs: Vec<[f64; 4]> = texels
        .par_iter()
        .map(|t| t.map(|v| if v > 0.0 { libm::log(f64::from(v)) } else { f64::NEG_INFINITY }))
        .collect();
    let by_day = |n: usize| mapping.mu_s(n / mapping.size()[3] % mapping.size()[2]) > 0.1;
    let bright = |v: &&f64| v.is_finite();
    let used = palette.four.len();
    let (mut sum, mut n) = (0.0, 0usize);
    for (index, log) in logs.iter().enumerate() {
        if by_day(index) {
            for v in log[..used].iter().filter(bright) {
                sum += v;
                n += 1;
            }
        }
    }
    let offset = if n > 0 { sum / n as f64 } else { 0.0 };
    for v in logs.iter_mut().flatten() {
        *v = (*v - offset).max(FLOOR);
    }
    Baked {
        layout: LAYOUT.into(),
        name,
        axes: axes_of(mapping),
        channels: channels(palette, quantity, "1/sr"),
        encoding: Encoding::log(1.0, offset, FLOOR),
        texels: file_order(logs.iter().map(|l| l.map(|v| v as f32)).collect(), mapping.size()),
    }
}

/// Diffuse irradiance of the ground over solar irradiance, as a logarithm.
fn irradiance(solution: &Solution, palette: &Palette, mapping: &Elek2010) -> Baked {
    let [altitudes, views, _, azimuths] = mapping.size();
    let long = mapping.resized([altitudes, views, IRRADIANCE_SIZE, azimuths]).expect("a valid size");
    let texels = (0..IRRADIANCE_SIZE)
        .map(|k| {
            let light = solution.ground_irradiance(long.mu_s(k));
            let mut texel = [FLOOR as f32; 4];
            for (t, &w) in texel.iter_mut().zip(&palette.four) {
                *t = if light[w] > 0.0 { libm::log(light[w]).max(FLOOR) as f32 } else { FLOOR as f32 };
            }
            texel
        })
        .collect();
    Baked {
        layout: LAYOUT.into(),
        name: "irradiance".into(),
        axes: vec![axis(&long.axes()[2])],
        channels: channels(palette, "diffuse irradiance of the ground over solar irradiance", "1"),
        encoding: Encoding::log(1.0, 0.0, FLOOR),
        texels,
    }
}
