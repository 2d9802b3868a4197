//! The layout of Elek & Kmoch 2010: one 4D table of colour, for the paper's medium.
//!
//! RGB holds light last scattered by gas. A holds light last scattered by aerosol, without phase function, as
//! 4π times its luminance over that of the direct sunlight at the ray's entry: a shader multiplies it by the
//! phase function and by the colour of that sunlight. Where the sun is behind the planet A is 0.

pub mod literal;
pub mod lookup;
pub mod spectral;

use super::compact;
use super::extinction;
use super::extinction::{DepthEncoding, Matter, table};
use super::judge::{Truth, in_rgb};
use super::settings::{Settings, Solver};
use super::sky::{AerosolPhase, Sky, Source};
use super::table_data::{Channel, TableData, axes_of, axis, file_order};
use super::{Filled, Ingredients, Layout, MediumKind};
use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::files::manifest::{Axis, Encoding};
use crate::machine::lanes::Lanes;
use crate::mapping::{Elek2010, SunCurve, Views, Warp, Window};
use crate::medium::{Medium, Role};
use crate::transport::Phase;
use crate::transport::fill::{RayIntegrator, RayLight, SunPairs, Wanted};
use crate::transport::solve::{Batch, Solution};
use rayon::prelude::*;
use serde_json::{Value, json};
use std::f64::consts::PI;

/// Name of the layout and of its folder.
pub const LAYOUT: &str = "elek2010";
/// Raised when the bytes of this layout change (see [`crate::bake::versions`]).
pub const ALGORITHM_VERSION: u32 = 1;
/// Texels of the extinction texture (altitude, view) and of the ambient one (Elek & Kmoch §6).
const EXTINCTION_SIZE: [usize; 2] = [256, 512];
const AMBIENT_SIZE: usize = 256;
/// The largest half that a scaled table may reach.
const BRIGHTEST: f64 = 32768.0;

/// Counts of values that halves or the encoding cannot hold as they are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Oddities {
    /// Colours outside the gamut: negative components, set to 0.
    pub negative: usize,
    /// Share of the aerosol's luminance that is lost where the sun is behind the planet.
    pub aerosol_lost: f64,
}

/// The tables of the layout. `solution` must be of `medium`, which must be [`Medium::similarity`]'s.
pub fn tables(
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    size: [usize; 4],
    window: &Window,
) -> (Vec<TableData>, Oddities) {
    let mapping = mapping(medium, size, window).expect("sizes are checked with the arguments");
    let texels = fill(medium, solution, palette, &mapping);
    let ambient = ambient(solution, palette, &mapping);
    finish(medium, solution, palette, (&mapping, window), texels, ambient)
}

/// Encodes texels (in ray order: gas as RGB and aerosol as luminance, cd/m²) and ambient light (RGB, lx, on an
/// even sun axis), and adds what depends on the medium alone.
pub fn finish(
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    (mapping, window): (&Elek2010, &Window),
    texels: Vec<[f32; 4]>,
    ambient: Vec<[f64; 3]>,
) -> (Vec<TableData>, Oddities) {
    let (scattering, oddities) = scattering(texels, solution, palette, mapping);
    let (deep, size) = of_depth(medium, window);
    let extinction = table(medium, solution, palette, LAYOUT, &deep, size, DepthEncoding::Plain, Matter::All);
    (vec![scattering, extinction, irradiance(ambient, mapping)], oddities)
}

/// The mapping for a medium; none where a size or the window is out of range.
pub fn mapping(medium: &Medium, size: [usize; 4], window: &Window) -> Option<Elek2010> {
    let radii = [medium.ground_radius, medium.top_radius];
    Elek2010::windowed(radii, size, SunCurve::Paper, Warp::PAPER, window)
}

/// Mapping and size of the extinction texture, as close in a window as without.
fn of_depth(medium: &Medium, window: &Window) -> (Elek2010, [usize; 2]) {
    let [altitudes, views] = EXTINCTION_SIZE;
    let views = if window.views == Views::All { views } else { views / 2 };
    let mapping = mapping(medium, [1, views, 1, 1], &window.of_depth()).expect("a valid size");
    let altitudes = mapping.spans()[0].texels(altitudes);
    (mapping, [altitudes, views])
}

/// Per texel, in ray order: gas in RGB (cd/m²) and aerosol luminance (cd/m²).
fn fill(medium: &Medium, solution: &Solution, palette: &ColourWeights, mapping: &Elek2010) -> Vec<[f32; 4]> {
    let [altitudes, views, suns, azimuths] = mapping.size();
    let mu_s: Vec<f64> = (0..suns).map(|k| mapping.mu_s(k)).collect();
    let cosines = mapping.cos_azimuths();
    let pairs = SunPairs::new(&mu_s, &cosines);
    // Texels that one pair each is found for, or, where the azimuth is averaged out, several.
    let (each, kept) = (cosines.len() / azimuths, suns * azimuths);
    let scatterers: Vec<usize> =
        (0..medium.constituents.len()).filter(|&c| medium.constituents[c].scatters()).collect();
    let groups: Vec<Vec<usize>> = scatterers.iter().map(|&c| vec![c]).collect();
    let mut texels = vec![[0.0f32; 4]; altitudes * views * kept];
    for batch in &solution.batches {
        let painter = RayIntegrator::new(solution, batch, &groups);
        let weights = BatchWeights::new(palette, batch);
        let last = scatterers.iter().map(|&c| (medium.constituents[c].role, &batch.optics.phase[c]));
        let last: Vec<(Role, &Phase)> = last.collect();
        texels.par_chunks_mut(kept).enumerate().for_each_init(
            || (RayLight::default(), vec![[0.0f32; 4]; pairs.len()]),
            |(light, of_pairs), (ray, out)| {
                let altitude = mapping.altitude(ray / views);
                let (mu, hits_ground) = mapping.mu(altitude, ray % views);
                let r = mapping.radius(ray / views);
                painter.ray(r, mu, hits_ground, &pairs, Wanted::Both, light);
                if each > 1 {
                    of_pairs.fill([0.0; 4]);
                    weights.add(light, &last, mu as f32, &pairs, of_pairs);
                    for (texel, values) in out.iter_mut().zip(of_pairs.chunks_exact(each)) {
                        let mean = |c: usize| values.iter().map(|v| v[c]).sum::<f32>() / each as f32;
                        (0..4).for_each(|c| texel[c] += mean(c));
                    }
                    return;
                }
                crate::machine::isa::run(
                    #[inline(always)]
                    || weights.add(light, &last, mu as f32, &pairs, out),
                );
            },
        );
    }
    texels
}

/// Colour weights of a batch's wavelengths, one vector a component: R, G, B, luminance.
struct BatchWeights([Lanes; 4]);

impl BatchWeights {
    fn new(palette: &ColourWeights, batch: &Batch) -> Self {
        let range = batch.first..batch.first + batch.optics.count;
        let rgb = palette.rgb_weights();
        let lanes = |f: &dyn Fn(usize) -> f64| Lanes::from_f64(&range.clone().map(f).collect::<Vec<_>>());
        BatchWeights([
            lanes(&|w| rgb[w][0]),
            lanes(&|w| rgb[w][1]),
            lanes(&|w| rgb[w][2]),
            lanes(&|w| palette.weights[w][1]),
        ])
    }

    /// Adds a ray's light to its texels; `last`: role and phase function of each group of `light`.
    #[inline(always)]
    fn add(
        &self,
        light: &RayLight,
        last: &[(Role, &Phase)],
        mu: f32,
        pairs: &SunPairs,
        out: &mut [[f32; 4]],
    ) {
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        for (p, texel) in out.iter_mut().enumerate() {
            let nu = pairs.mu_s[p] * mu + pairs.across[p] * sine;
            let (mut gas, mut aerosol) = (Lanes::ZERO, Lanes::ZERO);
            for (g, (role, phase)) in last.iter().enumerate() {
                let at = g * pairs.len() + p;
                let radiance = light.single[at] * phase.value(nu) + light.multiple[at];
                match role {
                    Role::Gas => gas += radiance,
                    Role::Aerosol => aerosol += radiance,
                }
            }
            let [r, g, b, luminance] = self.0;
            let sums = sums([r * gas, g * gas, b * gas, luminance * aerosol]);
            for (t, v) in texel.iter_mut().zip(sums) {
                *t += v;
            }
        }
    }
}

/// Sums of the lanes of four vectors, in a fixed order that vectorises: quarters are folded onto each other.
#[inline(always)]
pub(super) fn sums(v: [Lanes; 4]) -> [f32; 4] {
    let mut quarter = [0.0f32; 16];
    for c in 0..4 {
        for k in 0..4 {
            quarter[c * 4 + k] = (v[c][k] + v[c][4 + k]) + (v[c][8 + k] + v[c][12 + k]);
        }
    }
    let mut out = [0.0f32; 4];
    for c in 0..4 {
        out[c] = (quarter[c * 4] + quarter[c * 4 + 1]) + (quarter[c * 4 + 2] + quarter[c * 4 + 3]);
    }
    out
}

/// Luminance of the direct sunlight (cd/m² sr) at each altitude and sun node.
fn direct_luminance(solution: &Solution, palette: &ColourWeights, mapping: &Elek2010) -> Vec<f64> {
    let [altitudes, _, suns, _] = mapping.size();
    let mut out = vec![0.0; altitudes * suns];
    for i in 0..altitudes {
        for k in 0..suns {
            let through = solution.sun_transmittance(mapping.radius(i), mapping.mu_s(k));
            out[i * suns + k] = through.iter().zip(&palette.weights).map(|(t, w)| t * w[1]).sum();
        }
    }
    out
}

fn scattering(
    mut texels: Vec<[f32; 4]>,
    solution: &Solution,
    palette: &ColourWeights,
    mapping: &Elek2010,
) -> (TableData, Oddities) {
    let [_, views, suns, azimuths] = mapping.size();
    let direct = direct_luminance(solution, palette, mapping);
    let mut oddities = Oddities::default();
    let brightest = texels.iter().flat_map(|t| &t[..3]).fold(0.0f32, |a, &b| a.max(b));
    let scale = power_of_two(f64::from(brightest));
    let (mut lost, mut all) = (0.0f64, 0.0f64);
    for (n, t) in texels.iter_mut().enumerate() {
        for v in &mut t[..3] {
            oddities.negative += usize::from(*v < 0.0);
            *v = v.max(0.0) * scale as f32;
        }
        let light = direct[n / (views * suns * azimuths) * suns + n / azimuths % suns];
        all += f64::from(t[3]);
        if light > 0.0 {
            t[3] = (4.0 * PI * f64::from(t[3]) / light).clamp(0.0, 65504.0) as f32;
        } else {
            lost += f64::from(t[3]);
            t[3] = 0.0;
        }
    }
    oddities.aerosol_lost = if all > 0.0 { lost / all } else { 0.0 };
    let colour = |c: &str| Channel::new(c, "light last scattered by gas, linear", "cd/m^2");
    let mut aerosol = Channel::new(
        "A",
        "light last scattered by aerosol without phase function: 4 pi times its luminance over that of the \
         direct sunlight at the ray's entry",
        "1",
    );
    aerosol.encoding = Some(Encoding::linear(1.0));
    let baked = TableData {
        layout: LAYOUT.into(),
        name: "scattering".into(),
        axes: axes_of(mapping),
        channels: vec![colour("R"), colour("G"), colour("B"), aerosol],
        encoding: Encoding::linear(1.0 / scale),
        texels: file_order(texels, mapping.size()),
    };
    (baked, oddities)
}

/// The power of two that brings the brightest value close below what halves hold comfortably.
pub(super) fn power_of_two(brightest: f64) -> f64 {
    if brightest <= 0.0 {
        return 1.0;
    }
    let mut scale = 1.0;
    while brightest * scale * 2.0 <= BRIGHTEST {
        scale *= 2.0;
    }
    while brightest * scale > BRIGHTEST {
        scale *= 0.5;
    }
    scale
}

/// Diffuse irradiance of the ground against the sun's height, RGB in lx: TA of Algorithm 1.
fn ambient(solution: &Solution, palette: &ColourWeights, mapping: &Elek2010) -> Vec<[f64; 3]> {
    let long = mapping.unwindowed([1, 2, AMBIENT_SIZE, 1]).expect("a valid size");
    let rgb = palette.rgb_weights();
    (0..AMBIENT_SIZE)
        .map(|k| {
            let light = solution.ground_irradiance(long.mu_s(k));
            std::array::from_fn(|c| light.iter().zip(&rgb).map(|(l, w)| l * w[c]).sum())
        })
        .collect()
}

fn irradiance(values: Vec<[f64; 3]>, mapping: &Elek2010) -> TableData {
    let axis_of = mapping.unwindowed([1, 2, values.len(), 1]).expect("a valid size");
    let scale = power_of_two(values.iter().flatten().fold(0.0, |a: f64, &b| a.max(b)));
    let sun: Axis = axis(&axis_of.axes()[2]);
    let channel = |c: &str| Channel::new(c, "diffuse irradiance of the ground, linear", "lx");
    let store = |v: f64| (v.max(0.0) * scale) as f32;
    TableData {
        layout: LAYOUT.into(),
        name: "irradiance".into(),
        axes: vec![sun],
        channels: vec![channel("R"), channel("G"), channel("B")],
        encoding: Encoding::linear(1.0 / scale),
        texels: values.iter().map(|v| [store(v[0]), store(v[1]), store(v[2]), 0.0]).collect(),
    }
}

/// The paper's layout: one table of colour over four axes.
pub struct Elek2010Layout;

impl Layout for Elek2010Layout {
    fn name(&self) -> &'static str {
        LAYOUT
    }

    fn version(&self) -> u32 {
        ALGORITHM_VERSION
    }

    fn medium(&self) -> MediumKind {
        MediumKind::Paper
    }

    fn mappings(&self, medium: &Medium, settings: &Settings) -> Vec<Elek2010> {
        mapping(medium, settings.elek2010_size, &settings.window).into_iter().collect()
    }

    fn texels(&self, _: &Medium, settings: &Settings) -> usize {
        settings.elek2010_size.iter().product()
    }

    fn fill(&self, from: &Ingredients) -> Result<Filled> {
        let Ingredients { paper, solution, palette, settings, .. } = *from;
        let (mut tables, oddities) = match settings.solver {
            Solver::Moments => tables(paper, solution, palette, settings.elek2010_size, &settings.window),
            Solver::Literal { .. } => literal::tables(paper, solution, palette, settings)?,
        };
        let (groups, _) = compact::groups_to_fold(from.full, &settings.compact.folded);
        if !groups.is_empty() {
            tables.push(extinction::phase(from.full, palette, LAYOUT, &groups));
        }
        let mut filled = Filled { tables, ..Filled::default() };
        let mut count = |what: &str, value: Value| filled.counts.insert(what.into(), value);
        count("elek2010 colours outside the gamut, set to 0", json!(oddities.negative));
        let lost = crate::quality::digits(oddities.aerosol_lost);
        count("elek2010 aerosol light lost where the sun is behind the planet, share", json!(lost));
        Ok(filled)
    }

    fn open(&self, source: &Source) -> Result<Box<dyn Sky>> {
        Ok(Box::new(lookup::Elek2010Sky::new(source)?))
    }

    fn report_key(&self) -> &'static str {
        "elek2010_against_its_own_medium"
    }

    fn judge(&self, sky: &dyn Sky, palette: &ColourWeights, truths: &[Truth]) -> Value {
        in_rgb(sky, palette, truths, AerosolPhase::Isotropic)
    }

    fn remedy(&self) -> &'static str {
        "--size takes larger tables, and layout compact errs less"
    }
}
