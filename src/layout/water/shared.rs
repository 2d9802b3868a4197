//! Tables that all waters of a bake share: light on the surface, and Fresnel's reflectance; and how tables of
//! water are stored.

use super::EvenCosine;
use super::LAYOUT;
use super::skylight::Split;
use crate::colour::weights::ColourWeights;
use crate::files::manifest::{Axis, Encoding};
use crate::layout::table_data::{Channel, TableData};
use crate::medium::Medium;
use crate::preset::Water;
use crate::transport::slab::{Surface, fresnel, lazanyi_szirmay_kalos};
use crate::transport::solve::{Solution, lowest_sun};

/// Texels of the sun axis of the light on the surface, and of the angle of Fresnel's table.
pub(super) const SUNS: usize = 1024;
pub(super) const ANGLES: usize = 256;

/// Rows of `fresnel`.
pub const REFLECTED: usize = 0;
pub const LAZANYI: usize = 1;
pub const UNDERSIDE: usize = 2;
pub const TRANSMITTED: usize = 3;

/// The largest half that a scaled channel may reach.
const BRIGHTEST: f64 = 32768.0;

pub(crate) fn tables(
    waters: &[Water],
    medium: &Medium,
    solution: &Solution,
    palette: &ColourWeights,
    split: &Split,
) -> Vec<TableData> {
    vec![light(medium, solution, palette, split), surfaces(waters, palette)]
}

pub(crate) fn listed(name: &str, size: usize, formula: String) -> Axis {
    Axis { name: name.into(), size, formula, constants: Default::default(), unit: "1".into() }
}

/// Irradiance of a horizontal surface on the ground by the sun and by the sky.
fn light(medium: &Medium, solution: &Solution, palette: &ColourWeights, split: &Split) -> TableData {
    let sun = EvenCosine { name: "sun", least: lowest_sun(medium) };
    let values: Vec<[Vec<f64>; 3]> = (0..SUNS)
        .map(|k| {
            let mu_s = sun.at(k, SUNS);
            let direct = solution.sun_transmittance(medium.ground_radius, mu_s);
            let direct = direct.iter().map(|t| t * mu_s.max(0.0)).collect();
            let sky = solution.ground_irradiance(mu_s);
            let part = |i| sky.iter().enumerate().map(|(w, e)| split.parts(mu_s, w, *e)[i]).collect();
            [direct, part(0), part(1)]
        })
        .collect();
    let rows = "0: by the sun itself; 1: by the part of the sky whose radiance is in proportion to mu, the cosine of \
                the zenith angle; 2: by the part in proportion to (1 - mu)^2 (the sky has the planet's own ground below, \
                not water)";
    baked(
        LAYOUT,
        "irradiance".into(),
        vec![super::fill::plain(&sun.axis(SUNS)), listed("row", 3, rows.into())],
        channels_of(&palette.four_nm(), "irradiance of a horizontal surface over that of the star", "1"),
        |[k, row, _], w| values[k][row][palette.four[w]],
    )
}

/// Fresnel's reflectance, a slice a water.
fn surfaces(waters: &[Water], palette: &ColourWeights) -> TableData {
    let nm = palette.four_nm();
    let indices: Vec<Vec<f64>> = waters.iter().map(|w| w.refractive_index.at_all(&nm)).collect();
    let angle = EvenCosine { name: "angle", least: 0.0 };
    let rows = "0: reflected, from the air; 1: the same after Lazanyi & Szirmay-Kalos 2005; 2: reflected by the \
                underside, over the cosine in the water; 3: 1 - row 0, with more digits near the horizon";
    let names: Vec<String> = waters.iter().enumerate().map(|(k, w)| format!("{k}: {}", w.name)).collect();
    baked(
        LAYOUT,
        "fresnel".into(),
        vec![
            super::fill::plain(&angle.axis(ANGLES)),
            listed("row", 4, rows.into()),
            listed("water", waters.len(), names.join("; ")),
        ],
        channels_of(&nm, "share of unpolarised light", "1"),
        |[k, row, water], w| {
            let (mu, n) = (angle.at(k, ANGLES), indices[water][w]);
            match row {
                REFLECTED => fresnel(mu, n),
                LAZANYI => lazanyi_szirmay_kalos(mu, n),
                UNDERSIDE => Surface { n }.reflects_down(mu),
                _ => 1.0 - fresnel(mu, n),
            }
        },
    )
}

/// R, G, B, A for up to four wavelengths.
pub(crate) fn channels_of(nm: &[f64], quantity: &str, unit: &str) -> Vec<Channel> {
    let channel = |(name, nm): (&str, &f64)| Channel::new(name, format!("{quantity}, at {nm} nm"), unit);
    ["R", "G", "B", "A"].into_iter().zip(nm).map(channel).collect()
}

/// A table of up to three axes; each channel has the power of two of its own that suits halves.
pub(crate) fn baked(
    layout: &str,
    name: String,
    axes: Vec<Axis>,
    mut channels: Vec<Channel>,
    value: impl Fn([usize; 3], usize) -> f64,
) -> TableData {
    let size = |k: usize| axes.get(k).map_or(1, |a: &Axis| a.size);
    let [x, y, z] = [size(0), size(1), size(2)];
    let mut texels = vec![[0.0f32; 4]; x * y * z];
    for (w, channel) in channels.iter_mut().enumerate() {
        let values: Vec<f64> =
            (0..texels.len()).map(|t| value([t % x, t / x % y, t / (x * y)], w).max(0.0)).collect();
        let scale = power_of_two(values.iter().fold(0.0, |a: f64, &b| a.max(b)));
        for (texel, v) in texels.iter_mut().zip(&values) {
            texel[w] = (v * scale) as f32;
        }
        channel.encoding = Some(Encoding::linear(1.0 / scale));
    }
    TableData { layout: layout.into(), name, axes, channels, encoding: Encoding::linear(1.0), texels }
}

/// The power of two that brings the largest value just below what halves hold comfortably.
fn power_of_two(largest: f64) -> f64 {
    if !(largest > 0.0 && largest.is_finite()) {
        return 1.0;
    }
    let (mut scale, least) = (1.0, 1e-30);
    while largest * scale * 2.0 <= BRIGHTEST && scale < 1.0 / least {
        scale *= 2.0;
    }
    while largest * scale > BRIGHTEST {
        scale *= 0.5;
    }
    scale
}
