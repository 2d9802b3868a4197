//! Tables that both layouts share: optical depth of rays and phase functions, at the four wavelengths.
//!
//! Optical depth per wavelength rather than per RGB or per constituent: four exponentials give sunlight of any
//! colour through any number of constituents, and nothing leaves the gamut, as RGB of T does at sunset.

use super::elek2010::power_of_two;
use super::table_data::{Channel, TableData, axis};
use crate::colour::weights::ColourWeights;
use crate::files::manifest::{Axis, Encoding};
use crate::mapping::{Elek2010, Views};
use crate::medium::Medium;
use crate::transport::fill::RayIntegrator;
use crate::transport::solve::Solution;
use half::f16;
use rayon::prelude::*;

/// Logarithms below this stand for an optical depth of 0.
const FLOOR: f64 = -20.0;
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// How a table holds optical depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthEncoding {
    /// As it is, like the paper's extinction texture.
    Plain,
    /// The logarithm of the ray's mean extinction, τ over its length: it varies little, also where both
    /// vanish, so that 1 − e^−τ keeps its digits in halves.
    LogOfMean,
}

/// Whose optical depth a table holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matter {
    All,
    /// All but the constituents that only absorb.
    Scatterers,
}

/// Optical depth to the ground or to the top against altitude and view, on the mapping's first two axes at
/// another size.
pub fn table(
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    layout: &str,
    mapping: &Elek2010,
    size: [usize; 2],
    held: DepthEncoding,
    matter: Matter,
) -> TableData {
    let [altitudes, views] = size;
    let mapping = mapping.resized([altitudes, views, 1, 1]).expect("a valid size");
    let mut depths = vec![[0.0f32; 4]; altitudes * views];
    depths
        .par_chunks_mut(views)
        .enumerate()
        .for_each(|(i, out)| row(solution, palette, &mapping, (held, matter), i, out));
    let offset = if held == DepthEncoding::Plain { 0.0 } else { typical(medium, palette) };
    let scale = if held == DepthEncoding::Plain { plain_scale(&depths) } else { 1.0 };
    let encode = |v: f32| match held {
        DepthEncoding::Plain => v * scale as f32,
        DepthEncoding::LogOfMean if v > 0.0 => (libm::log(f64::from(v)) - offset).max(FLOOR) as f32,
        DepthEncoding::LogOfMean => FLOOR as f32,
    };
    // x is altitude, y the view.
    let texels =
        (0..altitudes * views).map(|n| depths[(n % altitudes) * views + n / altitudes].map(encode)).collect();
    let (quantity, unit, encoding) = match held {
        DepthEncoding::Plain => {
            ("optical depth of the ray to the ground or to the top", "1", Encoding::linear(1.0 / scale))
        }
        DepthEncoding::LogOfMean => (
            "optical depth of the ray to the ground or to the top over its length d (of the view axis)",
            "1/m",
            Encoding::log(1.0, offset, FLOOR),
        ),
    };
    TableData {
        layout: layout.into(),
        name: if matter == Matter::All { "transmittance".into() } else { "scatterers".into() },
        axes: mapping.axes()[..2].iter().map(axis).collect(),
        channels: channels(palette, quantity, unit),
        encoding,
        texels,
    }
}

/// By what depths are multiplied before they are stored: 1, as in the paper, or, where halves cannot hold them so, the
/// power of two that makes them fit.
fn plain_scale(depths: &[[f32; 4]]) -> f64 {
    let largest = f64::from(depths.iter().flatten().fold(0.0f32, |a, &b| a.max(b)));
    if largest > f16::MAX.to_f64() { power_of_two(largest) } else { 1.0 }
}

fn row(
    solution: &Solution,
    palette: &ColourWeights,
    mapping: &Elek2010,
    (held, matter): (DepthEncoding, Matter),
    i: usize,
    out: &mut [[f32; 4]],
) {
    let (half, halves) = match mapping.views() {
        Views::All => (out.len() / 2, &[true, false][..]),
        Views::Sky => (out.len(), &[false][..]),
    };
    let altitude = if held == DepthEncoding::Plain { mapping.altitude(i) } else { mapping.inner_altitude(i) };
    let r = mapping.radii()[0] + altitude;
    for (start, &to_ground) in (0..).step_by(half).zip(halves) {
        let mus: Vec<f64> = (start..start + half).map(|j| mapping.mu(altitude, j).0).collect();
        for batch in &solution.batches {
            let painter = RayIntegrator::new(solution, batch, &[]);
            let depths = painter.depths(r, &mus, to_ground, matter == Matter::Scatterers);
            for ((texel, depth), mu) in out[start..].iter_mut().zip(depths).zip(&mus) {
                let length = match held {
                    DepthEncoding::Plain => 1.0,
                    DepthEncoding::LogOfMean => mapping.distance(altitude, *mu, to_ground) as f32,
                };
                for (k, &w) in palette.four.iter().enumerate() {
                    if w >= batch.first && w < batch.first + batch.optics.count {
                        texel[k] = depth[w - batch.first] / length;
                    }
                }
            }
        }
    }
}

/// Logarithm of the mean vertical extinction: the middle of what a table holds.
fn typical(medium: &Medium, palette: &ColourWeights) -> f64 {
    let depth = medium.vertical_optical_depth();
    let mean = palette.four.iter().map(|&w| depth[w]).sum::<f64>() / palette.four.len() as f64;
    if mean > 0.0 { libm::log(mean / medium.height()) } else { 0.0 }
}

/// Up to four channels, one a wavelength.
pub fn channels(palette: &ColourWeights, quantity: &str, unit: &str) -> Vec<Channel> {
    let nm = palette.four_nm();
    nm.iter().zip(CHANNELS).map(|(nm, c)| Channel::new(c, format!("{quantity}, at {nm} nm"), unit)).collect()
}

/// Texels of a phase function over √((1 − ν)/2), dense in the forward direction.
pub const PHASE_SIZE: usize = 512;

/// Phase functions at the four wavelengths as natural logarithms, a row for each group of constituents.
pub fn phase(medium: &Medium, palette: &ColourWeights, layout: &str, groups: &[Vec<usize>]) -> TableData {
    let mut texels = Vec::new();
    for group in groups {
        for k in 0..PHASE_SIZE {
            let x = k as f64 / (PHASE_SIZE - 1) as f64;
            let nu = 1.0 - 2.0 * x * x;
            let mut texel = [0.0f32; 4];
            for (t, &w) in texel.iter_mut().zip(&palette.four) {
                let value = medium.constituents[group[0]].phase[w].value(nu);
                *t = (if value > 0.0 { libm::log(value) } else { FLOOR }).max(FLOOR) as f32;
            }
            texels.push(texel);
        }
    }
    let angle = Axis {
        name: "angle".into(),
        size: PHASE_SIZE,
        formula: "x = sqrt((1 - nu) / 2), nu the cosine of the scattering angle (1 straight on)".into(),
        constants: Default::default(),
        unit: "1".into(),
    };
    let names: Vec<&str> = groups.iter().map(|g| medium.constituents[g[0]].name.as_str()).collect();
    let row = Axis {
        name: "group".into(),
        size: groups.len(),
        formula: format!("one row each, not filtered: {}", names.join(", ")),
        constants: Default::default(),
        unit: "1".into(),
    };
    TableData {
        layout: layout.into(),
        name: "phase".into(),
        axes: vec![angle, row],
        channels: channels(palette, "phase function, integrates to 1 over the sphere", "1/sr"),
        encoding: Encoding::log(1.0, 0.0, FLOOR),
        texels,
    }
}
