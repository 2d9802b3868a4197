//! The compact layout: spectral radiance at four wavelengths, single scattering apart for each phase function.
//!
//! Every table holds ln S̄ − c of S̄ = I / (1 − e^−τ), a mean source, which varies far less than the light itself
//! and has no gamut to leave. τ is the optical depth of the ray without the constituents that absorb only: those
//! come and go with altitude and would leave their edges in S̄. A look-up is
//!   I = (1 − e^−τ) (Σ_g p_g(ν) S̄_g + S̄_multiple),   1 − e^−τ = −expm1(−τ).
//! Constituents may be folded into S̄_multiple, and τ may be that of the whole ray: less to store and to look up.

mod edges;
mod fill;
mod layer;
pub mod lookup;

use super::extinction::{DepthEncoding, Matter, channels, phase, table};
use super::judge::{Truth, in_spectra};
use super::settings::Settings;
use super::sky::{Sky, Source};
use super::table_data::{TableData, axes_of, axis, file_order};
use super::{Filled, Ingredients, Layout, MediumKind};
use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::files::manifest::Encoding;
use crate::mapping::{Elek2010, Layer, SunCurve, Warp, Window};
use crate::medium::Medium;
use crate::transport::fill::Wanted;
use crate::transport::solve::Solution;
use fill::{Over, fill};
use rayon::prelude::*;
use serde_json::{Value, json};

/// Name of the layout and of its folder.
pub const LAYOUT: &str = "compact";
/// Raised when the bytes of this layout change (see [`crate::bake::versions`]).
pub const ALGORITHM_VERSION: u32 = 1;
/// Texels of each single-scattering table: altitude, view, sun, azimuth.
pub const SINGLE_SIZE: [usize; 4] = [24, 44, 40, 8];
/// Texels of the multiple-scattering table.
pub const MULTIPLE_SIZE: [usize; 4] = [16, 44, 40, 10];
const DEPTH_SIZE: [usize; 2] = [48, 128];
pub const IRRADIANCE_SIZE: usize = 128;
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
const SINGLE_BENDS: Warp =
    Warp { altitude_bend: 1.5, altitude_power: 1.0, view_power: 1.5, horizon_power: 2.4, layer: Layer::NONE };
const MULTIPLE_BENDS: Warp =
    Warp { altitude_bend: 1.5, altitude_power: 1.0, view_power: 1.5, horizon_power: 1.5, layer: Layer::NONE };
const DEPTH_BENDS: Warp =
    Warp { altitude_bend: 1.0, altitude_power: 1.0, view_power: 1.5, horizon_power: 1.5, layer: Layer::NONE };

/// A kind of table over altitude and view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Single,
    Multiple,
    /// Transmittance, and that without what only absorbs.
    Depth,
}

/// The mapping of a kind of table; none where a size or the window is out of range.
pub fn mapping(medium: &Medium, kind: Kind, size: [usize; 4], window: &Window) -> Option<Elek2010> {
    let radii = [medium.ground_radius, medium.top_radius];
    let (sun, bends) = match kind {
        Kind::Single => (SINGLE_SUN, SINGLE_BENDS),
        Kind::Multiple => (MULTIPLE_SUN, MULTIPLE_BENDS),
        Kind::Depth => (MULTIPLE_SUN, DEPTH_BENDS),
    };
    let window = if kind == Kind::Depth { window.of_depth() } else { *window };
    let bends = layer::with_texel_at_edge(layer::bent(bends, medium), medium, size[0], &window);
    Elek2010::windowed(radii, size, sun, bends, &window)
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

/// The same, with the groups of folded constituents (by name) last; the number of the others comes with them.
pub fn groups_to_fold(medium: &Medium, folded: &[String]) -> (Vec<Vec<usize>>, usize) {
    let is_folded = |g: &Vec<usize>| g.iter().any(|&c| folded.contains(&medium.constituents[c].name));
    let (last, mut all): (Vec<_>, Vec<_>) = groups(medium).into_iter().partition(is_folded);
    let kept = all.len();
    all.extend(last);
    (all, kept)
}

/// Texels of the tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    pub single: [usize; 4],
    pub multiple: [usize; 4],
    /// Of optical depth: altitude, view.
    pub depth: [usize; 2],
}

impl From<Sizes> for CompactSettings {
    /// Everything, in these sizes.
    fn from(sizes: Sizes) -> Self {
        CompactSettings { sizes, ..CompactSettings::default() }
    }
}

impl Default for Sizes {
    fn default() -> Self {
        Sizes { single: SINGLE_SIZE, multiple: MULTIPLE_SIZE, depth: DEPTH_SIZE }
    }
}

/// What decides the tables of the layout beside the planet and its light.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CompactSettings {
    pub sizes: Sizes,
    /// Constituents whose light scattered once has no table of its own but is in that of the rest, phase function and
    /// all.
    pub folded: Vec<String>,
    /// No table of optical depth without what only absorbs: what absorbs is taken for a part of what scatters.
    pub without_scatterers: bool,
}

/// A planet and its light, from which the tables of a design are made one by one.
#[derive(Clone, Copy)]
pub struct CompactBuilder<'a> {
    pub medium: &'a Medium,
    pub solution: &'a Solution,
    pub palette: &'a ColourWeights,
    pub design: &'a CompactSettings,
    pub window: &'a Window,
}

/// The tables of the layout. Returns them and the number of multiple-scattering values that were not positive
/// where there is light.
pub fn tables(maker: &CompactBuilder) -> (Vec<TableData>, usize) {
    let mut out = maker.singles();
    let (multiple, negative) = maker.multiple();
    out.push(multiple);
    out.extend(maker.depths());
    out.push(maker.irradiance());
    out.extend(maker.phase());
    (out, negative)
}

impl CompactBuilder<'_> {
    fn mapping(&self, kind: Kind, size: [usize; 4]) -> Elek2010 {
        mapping(self.medium, kind, size, self.window).expect("sizes are checked with the arguments")
    }

    /// What a mean source is divided by.
    fn over(&self) -> Over {
        let none_absorbs = self.medium.constituents.iter().all(|c| c.scatters());
        if self.design.without_scatterers || none_absorbs { Over::All } else { Over::Scatterers }
    }

    /// A table for each group that has one.
    pub fn singles(&self) -> Vec<TableData> {
        let (groups, kept) = groups_to_fold(self.medium, &self.design.folded);
        let mapping = self.mapping(Kind::Single, self.design.sizes.single);
        let groups = &groups[..kept];
        let texels = fill(self.solution, self.palette, &mapping, groups, Wanted::Single, (self.over(), 0));
        let named = groups.iter().zip(texels).map(|(group, texels)| {
            let name = format!("single_{}", self.medium.constituents[group[0]].name);
            encode(
                name,
                "single scattering without phase function over 1 - T",
                texels,
                &mapping,
                self.palette,
            )
        });
        named.collect()
    }

    /// The rest, and the number of its values that were not positive where there is light.
    pub fn multiple(&self) -> (TableData, usize) {
        let (groups, kept) = groups_to_fold(self.medium, &self.design.folded);
        let mapping = self.mapping(Kind::Multiple, self.design.sizes.multiple);
        let folded = groups.len() - kept;
        let wanted = if folded > 0 { Wanted::Both } else { Wanted::Multiple };
        let over = (self.over(), folded);
        let mut rest = fill(self.solution, self.palette, &mapping, &groups, wanted, over).into_iter();
        let first = rest.next().unwrap_or_else(|| vec![[0.0; 4]; mapping.size().iter().product()]);
        let sum = rest.fold(first, |mut sum, more| {
            sum.iter_mut().zip(more).for_each(|(s, m)| (0..4).for_each(|k| s[k] += m[k]));
            sum
        });
        let negative = sum.iter().flatten().filter(|v| **v < 0.0).count();
        let quantity = "light scattered more than once over 1 - T";
        let folded: Vec<&str> =
            groups[kept..].iter().map(|g| self.medium.constituents[g[0]].name.as_str()).collect();
        let quantity = match folded[..] {
            [] => quantity.to_string(),
            _ => format!("light scattered more than once, or once by {}, over 1 - T", folded.join(", ")),
        };
        (encode("multiple".into(), &quantity, sum, &mapping, self.palette), negative)
    }

    /// Optical depth of all and, where some constituents only absorb, of what scatters.
    pub fn depths(&self) -> Vec<TableData> {
        let CompactBuilder { medium, solution, palette, design, .. } = *self;
        let [altitudes, views] = design.sizes.depth;
        let mapping = self.mapping(Kind::Depth, [altitudes, views, 1, 1]);
        let depth = |which| {
            table(
                medium,
                solution,
                palette,
                LAYOUT,
                &mapping,
                design.sizes.depth,
                DepthEncoding::LogOfMean,
                which,
            )
        };
        let mut out = vec![depth(Matter::All)];
        if self.over() == Over::Scatterers {
            out.push(depth(Matter::Scatterers));
        }
        out
    }

    /// Diffuse irradiance of the ground, under all suns: the ground that an observer sees has suns of its own.
    pub fn irradiance(&self) -> TableData {
        irradiance(self.solution, self.palette, &self.mapping(Kind::Multiple, self.design.sizes.multiple))
    }

    /// None where nothing scatters.
    pub fn phase(&self) -> Option<TableData> {
        let (groups, _) = groups_to_fold(self.medium, &self.design.folded);
        (!groups.is_empty()).then(|| phase(self.medium, self.palette, LAYOUT, &groups))
    }
}

/// ln S̄ − c, with c the mean logarithm of the brighter half of the table, by day: there halves are finest.
fn encode(
    name: String,
    quantity: &str,
    texels: Vec<[f32; 4]>,
    mapping: &Elek2010,
    palette: &ColourWeights,
) -> TableData {
    let mut logs: Vec<[f64; 4]> = texels
        .par_iter()
        .map(|t| t.map(|v| if v > 0.0 { libm::log(f64::from(v)) } else { f64::NEG_INFINITY }))
        .collect();
    let night = mapping.mu_s(mapping.size()[2] - 1) <= 0.1;
    let by_day = |n: usize| night || mapping.mu_s(n / mapping.size()[3] % mapping.size()[2]) > 0.1;
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
    TableData {
        layout: LAYOUT.into(),
        name,
        axes: axes_of(mapping),
        channels: channels(palette, quantity, "1/sr"),
        encoding: Encoding::log(1.0, offset, FLOOR),
        texels: file_order(logs.iter().map(|l| l.map(|v| v as f32)).collect(), mapping.size()),
    }
}

/// Diffuse irradiance of the ground over solar irradiance, as a logarithm.
fn irradiance(solution: &Solution, palette: &ColourWeights, mapping: &Elek2010) -> TableData {
    let long = mapping.unwindowed([1, 2, IRRADIANCE_SIZE, 1]).expect("a valid size");
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
    TableData {
        layout: LAYOUT.into(),
        name: "irradiance".into(),
        axes: vec![axis(&long.axes()[2])],
        channels: channels(palette, "diffuse irradiance of the ground over solar irradiance", "1"),
        encoding: Encoding::log(1.0, 0.0, FLOOR),
        texels,
    }
}

/// Spectral radiance at four wavelengths.
pub struct CompactLayout;

impl Layout for CompactLayout {
    fn name(&self) -> &'static str {
        LAYOUT
    }

    fn version(&self) -> u32 {
        ALGORITHM_VERSION
    }

    fn medium(&self) -> MediumKind {
        MediumKind::Full
    }

    fn mappings(&self, medium: &Medium, settings: &Settings) -> Vec<Elek2010> {
        let sizes = settings.compact.sizes;
        let tables = [(Kind::Single, sizes.single), (Kind::Multiple, sizes.multiple)];
        tables.iter().filter_map(|&(kind, size)| mapping(medium, kind, size, &settings.window)).collect()
    }

    fn texels(&self, medium: &Medium, settings: &Settings) -> usize {
        let sizes = settings.compact.sizes;
        let [multiple, single] = [sizes.multiple, sizes.single].map(|size| size.iter().product::<usize>());
        multiple + single * groups(medium).len()
    }

    fn fill(&self, from: &Ingredients) -> Result<Filled> {
        let maker = CompactBuilder {
            medium: from.full,
            solution: from.solution,
            palette: from.palette,
            design: &from.settings.compact,
            window: &from.settings.window,
        };
        let (tables, negative) = tables(&maker);
        let mut filled = Filled { tables, ..Filled::default() };
        filled.counts.insert("compact multiple scattering below 0, set to dark".into(), json!(negative));
        Ok(filled)
    }

    fn open(&self, source: &Source) -> Result<Box<dyn Sky>> {
        Ok(Box::new(lookup::Compact::new(source)?))
    }

    fn report_key(&self) -> &'static str {
        "compact_against_direct_integration"
    }

    fn judge(&self, sky: &dyn Sky, palette: &ColourWeights, truths: &[Truth]) -> Value {
        in_spectra(sky, palette, truths)
    }

    fn remedy(&self) -> &'static str {
        "--size takes larger tables"
    }
}
