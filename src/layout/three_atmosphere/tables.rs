//! The light as tables.

use super::Bruneton;
use super::light::{IRRADIANCE_SIZE, Light, irradiance_mu_s};
use super::{LAYOUT, LUMINANCE_UNIT, cornette_shanks, rayleigh};
use crate::colour::weights::ColourWeights;
use crate::files::manifest::{Axis, Encoding};
use crate::layout::elek2010::power_of_two;
use crate::layout::table_data::{Channel, TableData, axis};
use crate::transport::solve::Solution;
use rayon::prelude::*;

/// Texels of the transmittance table (its reader's): view, altitude.
pub(super) const TRANSMITTANCE_SIZE: [usize; 2] = [256, 64];
/// The least transmittance that is stored, the smallest half: shaders divide two of them.
const LEAST: f64 = 5.960464477539063e-8;
/// No component is stored below this share of the largest. Through much air red alone is left, and green and blue are
/// outside the gamut; as quotients of nothing they would let the ground at the horizon shine through.
const LEAST_SHARE: f64 = 1e-3;

/// Phase functions at a texel of ν as it is possible there.
fn phases(mapping: &Bruneton, g: f64, n: usize) -> (f64, f64) {
    let [_, views, suns, angles] = mapping.size();
    let (sun, angle, ray) = (n % suns, n / suns % angles, n / (suns * angles));
    let (mu, _) = mapping.mu(mapping.shell().altitude(ray / views), ray % views);
    let (nu, _) = Bruneton::possible(mu, mapping.mu_s(sun), mapping.nu(angle));
    (rayleigh(nu), cornette_shanks(g, nu))
}

/// RGB of the three files that texel `n` makes, cd/m² sr: all but light scattered once by aerosols, that light, and
/// light scattered more than once.
fn texel(light: &Light, (gas, aerosol): (f64, f64)) -> [[f64; 3]; 3] {
    let over = |v: f32, phase: f64| f64::from(v) / phase;
    [
        std::array::from_fn(|c| over(light.gas[c] + light.multiple[c], gas)),
        std::array::from_fn(|c| over(light.aerosol[c], aerosol)),
        std::array::from_fn(|c| over(light.multiple[c], gas)),
    ]
}

/// What values in cd/m² are multiplied with to be stored: over the package's unit, times the power of two that brings
/// the brightest below the largest half.
pub(super) fn scale(light: &[Light], sky: &[[f64; 3]], mapping: &Bruneton, g: f64) -> f64 {
    let brightest = light
        .par_iter()
        .enumerate()
        .map(|(n, l)| texel(l, phases(mapping, g, n)).into_iter().flatten().fold(0.0, f64::max))
        .reduce(|| 0.0, f64::max);
    let brightest = sky.iter().flatten().fold(brightest, |a, &b| a.max(b));
    power_of_two(brightest / LUMINANCE_UNIT) / LUMINANCE_UNIT
}

/// All tables, and the number of their colours that were outside the gamut.
pub(super) fn all(
    solution: &Solution,
    palette: &ColourWeights,
    mapping: &Bruneton,
    g: f64,
    scale: f64,
    light: &[Light],
    sky: Vec<[f64; 3]>,
) -> (Vec<TableData>, usize) {
    let texels: Vec<[[f64; 3]; 3]> =
        light.par_iter().enumerate().map(|(n, l)| texel(l, phases(mapping, g, n))).collect();
    let negative = texels.iter().flatten().flatten().filter(|v| **v < 0.0).count();
    let store = |v: f64| (v.max(0.0) * scale) as f32;
    let volume = |name: &str, quantity: &str, which: usize| {
        let rgb = |t: &[[f64; 3]; 3]| t[which].map(store);
        let alpha = |t: &[[f64; 3]; 3]| if which == 0 { store(t[1][0]) } else { 1.0 };
        let texels = texels.iter().map(|t| with_alpha(rgb(t), alpha(t))).collect();
        let axes = mapping.axes();
        // x: ν and sun, the sun fastest; y: view; slices: altitude.
        let axes = [2, 3, 1, 0].map(|k| axis(&axes[k])).to_vec();
        table(name, quantity, "cd/m^2 sr", axes, Encoding::linear(1.0 / scale), texels)
    };
    let mut scattering = volume(
        "scattering",
        "light but that scattered once by aerosols, over the Rayleigh phase function",
        0,
    );
    scattering.channels[3].quantity = "R of single_mie_scattering".into();
    scattering.channels[3].unit = "cd/m^2 sr".into();
    scattering.channels[3].encoding = None;
    let single = volume(
        "single_mie_scattering",
        "light scattered once by aerosols, over the phase function of Cornette & Shanks",
        1,
    );
    let higher = volume(
        "higher_order_scattering",
        "light scattered more than once, over the Rayleigh phase function",
        2,
    );
    let sky =
        irradiance(&sky.iter().map(|v| with_alpha(v.map(store), 1.0)).collect::<Vec<_>>(), mapping, scale);
    (vec![scattering, single, higher, transmittance(solution, palette, mapping), sky], negative)
}

fn with_alpha([r, g, b]: [f32; 3], alpha: f32) -> [f32; 4] {
    [r, g, b, alpha]
}

fn table(
    name: &str,
    quantity: &str,
    unit: &str,
    axes: Vec<Axis>,
    encoding: Encoding,
    texels: Vec<[f32; 4]>,
) -> TableData {
    let channel = |c: &str| Channel::new(c, format!("{quantity}, linear"), unit);
    let mut alpha = Channel::new("A", "nothing: 1", "1");
    alpha.encoding = Some(Encoding::linear(1.0));
    let channels = vec![channel("R"), channel("G"), channel("B"), alpha];
    TableData { layout: LAYOUT.into(), name: name.into(), axes, channels, encoding, texels }
}

/// Transmittance to the top of rays that leave through it, of the star's light as RGB.
fn transmittance(solution: &Solution, palette: &ColourWeights, mapping: &Bruneton) -> TableData {
    let [views, altitudes] = TRANSMITTANCE_SIZE;
    let fine = mapping.shell().resized([altitudes, 2 * views, 2, 2]).expect("a valid size");
    let weights = palette.rgb_weights();
    let white = crate::spectrum::weighted(&weights, &vec![1.0; weights.len()]);
    let texels: Vec<[f32; 4]> = (0..views * altitudes)
        .into_par_iter()
        .map(|n| {
            let altitude = fine.altitude(n / views);
            let (mu, _) = fine.mu(altitude, views + n % views);
            // The horizon's own ray leaves, if only by rounding.
            let mu = mu.max(fine.horizon_mu(altitude));
            let through = solution.sun_transmittance(fine.radii()[0] + altitude, mu);
            let rgb = crate::spectrum::weighted(&weights, &through);
            let through: [f64; 3] = std::array::from_fn(|c| rgb[c] / white[c]);
            let least = through.iter().fold(LEAST, |a, v| a.max(LEAST_SHARE * v));
            with_alpha(through.map(|t| t.clamp(least, 1.0) as f32), 1.0)
        })
        .collect();
    let mut axes = fine.axes();
    axes[0].size = altitudes;
    axes[1].size = views;
    axes[1].coordinate = "(d - d_min) / (d_max - d_min), d = -r mu + sqrt(r^2 mu^2 - Z1^2 + Z2^2), d_min = r_top - r, \
        d_max = Z1 + Z2";
    axes[1].inverse = "d = d_min + x (d_max - d_min), mu = (Z2^2 - Z1^2 - d^2) / (2 r d)";
    let axes = [1, 0].map(|k| axis(&axes[k])).to_vec();
    table(
        "transmittance",
        "transmittance of the star's light to the top of the air",
        "1",
        axes,
        Encoding::linear(1.0),
        texels,
    )
}

fn irradiance(texels: &[[f32; 4]], mapping: &Bruneton, scale: f64) -> TableData {
    let [suns, altitudes] = IRRADIANCE_SIZE;
    let [ground, top] = mapping.shell().radii();
    let named = |name: &str, size: usize, formula: &str, constants: &[(&str, f64)], unit: &str| Axis {
        name: name.into(),
        size,
        formula: formula.into(),
        constants: constants.iter().map(|(k, v)| (k.to_string(), *v)).collect(),
        unit: unit.into(),
    };
    let sun = named(
        "sun",
        suns,
        "(1 + mu_s) / 2. Inverse: mu_s = 2 x - 1",
        &[("mu_s_min", irradiance_mu_s(0))],
        "1",
    );
    let altitude = named(
        "altitude",
        altitudes,
        "(r - r_ground) / (r_top - r_ground). Inverse: r = r_ground + x (r_top - r_ground)",
        &[("r_ground", ground), ("r_top", top)],
        "m",
    );
    let quantity = "irradiance of a level surface by the sky, without the star";
    table("irradiance", quantity, "lx", vec![sun, altitude], Encoding::linear(1.0 / scale), texels.to_vec())
}
