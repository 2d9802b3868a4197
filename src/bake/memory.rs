//! How much memory a bake will take, from its sizes, before it starts.
//!
//! The large things are counted: states and rays while the solver works, fields and texels while tables are
//! filled. It is meant to be a little too much rather than too little.

use crate::layout::MediumKind;
use crate::layout::settings::Settings;
use crate::medium::{Constituent, Medium};
use crate::preset::Planet;
use crate::transport::extent::Extent;
use crate::transport::solve::{Orders, Resolution, needed_degrees};

/// What every bake takes, bytes: picture, report, look-up of colours.
const BASE: f64 = 20e6;
/// Bytes for each texel of a table over four axes (or of a water) from when it is filled to when it is a file.
const TEXEL: f64 = 56.0;
/// More for each container besides EXR: the file, and once more while it is put together.
const CONTAINER: f64 = 16.0;
/// Bytes for each texel and wavelength of spectral files: gas and aerosol, as halves and encoded.
const SPECTRAL: f64 = 14.0;
/// Bytes of a number of the solver: single precision for the sixteen wavelengths of a batch.
const LANES: f64 = 64.0;
const BATCH: usize = 16;
/// Bytes of a stop of a ray without its columns, of a sample without its weight, and of a bundle of samples likewise.
const STOP: f64 = 56.0;
const SAMPLE: f64 = 20.0;
const BUNDLE: f64 = 440.0;
/// Directions of its search that the solver keeps at most, two states each, and states at work beside them.
const MOST_KEPT: f64 = 16.0;
const AT_WORK: f64 = 7.0;
/// For what is not counted. `scripts/study-memory` holds the estimate against what bakes take.
const MARGIN: f64 = 1.1;

/// Estimate of the most memory that a bake takes, bytes.
pub fn estimate(planet: &Planet, settings: &Settings) -> u64 {
    let medium = planet.medium(&settings.wavelengths_nm);
    let [full, paper] =
        [MediumKind::Full, MediumKind::Paper].map(|kind| settings.layouts_of(kind).next().is_some());
    let solve = |medium: &Medium, resolution, wanted| match wanted {
        true => Solve::of(medium, resolution, settings.orders),
        false => Solve::default(),
    };
    let full_light = solve(&medium, &Resolution::TABLES, full);
    let similar = solve(&medium.similarity(), &Resolution::PAPER, paper || !full);
    let texels = texels(&medium, settings);
    let texel = TEXEL + CONTAINER * settings.storage.containers.len() as f64;
    let solving = full_light.working.max(similar.working);
    let filling = full_light.fields.max(similar.fields) + texel * texels.air + SPECTRAL * texels.spectral;
    let counted = BASE + full_light.solution + similar.solution + solving.max(filling + texel * texels.water);
    (MARGIN * counted) as u64
}

/// Memory of one medium's light, bytes.
#[derive(Default)]
struct Solve {
    /// While it is solved.
    working: f64,
    /// Afterwards, for as long as the bake lasts.
    solution: f64,
    /// While tables are filled from it.
    fields: f64,
}

impl Solve {
    fn of(medium: &Medium, resolution: &Resolution, orders: Orders) -> Self {
        let levels = resolution.levels_in(medium);
        let (state_levels, field_levels) = (levels.coarse as f64, (levels.coarse * levels.refinement) as f64);
        let degrees = needed_degrees(medium, resolution.degree, orders);
        let terms = degrees.iter().map(|l| l + 1).sum::<usize>() as f64;
        let at_suns = resolution.sun_nodes as f64 * terms * LANES;
        // Where profiles have more kinks than that, a shell ends at each.
        let kinks: usize = medium.constituents.iter().map(|c| c.density.kinks().len()).sum();
        let shells = (field_levels * levels.cuts as f64).max(kinks as f64);
        let batches = medium.wavelengths_nm.len().div_ceil(BATCH) as f64;
        // Thin air needs three directions, loss-free air of an optical depth of seven all that are kept.
        let kept = (3.0 + 5.0 * reach(medium)).min(MOST_KEPT);
        let rays = Extent::of(medium, resolution);
        let constituents = medium.constituents.len() as f64;
        let scatterers = medium.constituents.iter().filter(|c| c.scatters()).count();
        let sunlight = shells * resolution.sunlight_nodes as f64;
        Solve {
            working: state_levels * at_suns * (2.0 * kept + AT_WORK)
                + field_levels * at_suns
                + rays.stops * (LANES + SAMPLE)
                + rays.bundles * BUNDLE
                + rays.touched * degrees.len() as f64 * LANES,
            solution: batches * (state_levels * at_suns + sunlight * LANES)
                + rays.stops * (8.0 * constituents + STOP)
                + sunlight * 8.0 * constituents,
            fields: field_levels * at_suns * scatterers as f64,
        }
    }
}

/// How often light is scattered before it leaves or is lost, to the power of one half: by air of optical depth τ about τ
/// times, where a share ω of what is met is scattered 1 / (1 − ω) times at most. The largest of all wavelengths.
fn reach(medium: &Medium) -> f64 {
    let columns: Vec<f64> =
        medium.constituents.iter().map(|c| c.density.column(0.0, medium.height())).collect();
    let at = |w: usize| {
        let sum = |of: &dyn Fn(&Constituent) -> f64| -> f64 {
            medium.constituents.iter().zip(&columns).map(|(c, column)| column * of(c)).sum()
        };
        let (depth, absorbed) = (sum(&|c| c.extinction(w)), sum(&|c| c.absorption[w]));
        if absorbed > 0.0 { depth.min(depth / absorbed) } else { depth }
    };
    (0..medium.wavelengths_nm.len()).map(at).fold(0.0, f64::max).sqrt()
}

/// Numbers of texels, and of texels times wavelengths.
struct Texels {
    air: f64,
    spectral: f64,
    water: f64,
}

fn texels(medium: &Medium, settings: &Settings) -> Texels {
    let of = |size: &[usize]| size.iter().map(|&n| n as f64).product::<f64>();
    let air: usize = settings.layouts.iter().map(|layout| layout.texels(medium, settings)).sum();
    let wavelengths = medium.wavelengths_nm.len() as f64;
    let spectral = if settings.spectral { of(&settings.elek2010_size) * wavelengths } else { 0.0 };
    let waters = &settings.waters;
    let each = of(&waters.size) * if waters.underwater { 3.0 } else { 1.0 };
    Texels { air: air as f64, spectral, water: each * waters.list.len() as f64 }
}
