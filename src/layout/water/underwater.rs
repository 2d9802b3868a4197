//! The paper's 4D table: light seen by an observer under water, over depth, view, sun and the observer's depth.

use super::EvenCosine;
use super::LAYOUT;
use super::fill::{LEAST_COSINE, SUN, axes, plain};
use super::shared::{self, baked, channels_of};
use crate::files::manifest::Axis;
use crate::layout::table_data::TableData;
use crate::medium::WaterMedium;
use crate::preset::Water;
use crate::transport::slab::{Angles, Dome, Layer, Slab, WaterOrders};
use rayon::prelude::*;

/// Texels of depth, view, sun and observer.
pub(super) const SIZE: [usize; 4] = [24, 64, 16, 9];

/// The view axis under water: cosine of the zenith angle of the direction looked into, −1 straight down.
pub(super) const VIEW: EvenCosine = EvenCosine { name: "view", least: -1.0 };

/// `<name>_underwater`, `…_sky` and `…_seabed`: radiance in the water, the sun's disc left out; slices are
/// observer · suns + sun, and observer · parts + part of the sky.
pub(super) fn tables(
    water: &Water,
    media: &WaterMedium,
    slabs: &[Slab],
    orders: WaterOrders,
) -> Vec<TableData> {
    let [depths, views, suns, observers] = SIZE;
    let axes = axes(water, media, slabs);
    let light: Vec<Vec<[Vec<f64>; 3]>> = slabs
        .par_iter()
        .enumerate()
        .map(|(w, slab)| {
            let cosines: Vec<f64> = (0..views).map(|j| VIEW.at(j, views).abs().max(LEAST_COSINE)).collect();
            let sun = |k| slab.surface.cosine_in_water(SUN.at(k, suns)).max(LEAST_COSINE);
            let beams: Vec<f64> = (0..suns).map(sun).collect();
            let angles = Angles::new(media, w, slab, &cosines, &beams, orders, true);
            let column = |i| column(&Layer::new(slab, axes.depth(i, depths)), &angles);
            (0..depths).into_par_iter().map(column).collect()
        })
        .collect();
    let observer = Axis {
        name: "observer".into(),
        size: observers,
        formula: "x = d / D, d: depth of the observer. Inverse: d = D x".into(),
        constants: Default::default(),
        unit: "1".into(),
    };
    let (depth, view) = (plain(&axes.depth_axis(depths)), plain(&VIEW.axis(views)));
    let of = |what: &str, unit: &str| channels_of(&media.wavelengths_nm, what, unit);
    let name = |what: &str| format!("{}_underwater{what}", water.name);
    let at = |w: usize, part: usize, [i, j]: [usize; 2], slice: usize| light[w][i][part][slice * views + j];
    let mut sunlit = baked(
        LAYOUT,
        name(""),
        vec![depth.clone(), view.clone(), Axis { size: suns * observers, ..observer.clone() }],
        of(
            "radiance in water over a black bed, per irradiance that the sun brings in, without the sun",
            "1/sr",
        ),
        |[i, j, slice], w| at(w, 0, [i, j], slice),
    );
    sunlit.axes[2] = plain(&SUN.axis(suns));
    sunlit.axes.push(observer.clone());
    let other = |part: usize, what: &str, last: &Axis, quantity: &str, unit: &str| {
        let axes = vec![depth.clone(), view.clone(), last.clone()];
        baked(LAYOUT, name(what), axes, of(quantity, unit), |[i, j, o], w| at(w, part, [i, j], o))
    };
    let both = Axis { size: 2 * observers, ..observer.clone() };
    let quantity = "radiance in water over a black bed, with the sky, per its irradiance";
    let mut sky = other(1, "_sky", &both, quantity, "1/sr");
    sky.axes[2] = shared::listed("part", 2, super::fill::PARTS.into());
    sky.axes.push(observer.clone());
    let quantity = "radiance in water, with the bed, per radiance of an evenly bright bed";
    vec![sunlit, sky, other(2, "_seabed", &observer, quantity, "1")]
}

/// Light of sun, sky and bed at every observer, `[observer][sun][view]`, `[observer][part][view]` and
/// `[observer][view]`.
fn column(layer: &Layer, angles: &Angles) -> [Vec<f64>; 3] {
    let [_, views, suns, observers] = SIZE;
    let fields: Vec<_> = (0..suns).map(|k| angles.sun(layer, k)).collect();
    let (skies, bed) = (Dome::PARTS.map(|dome| layer.sky(dome)), layer.bed());
    let mut out = [Vec::new(), Vec::new(), Vec::new()];
    for o in 0..observers {
        let t = layer.depth * o as f64 / (observers - 1) as f64;
        let see = |field, j: usize, pair| match VIEW.at(j, views) < 0.0 {
            true => layer.up(field, &angles.views[j], pair, t),
            false => layer.down(field, &angles.views[j], pair, t),
        };
        for (k, field) in fields.iter().enumerate() {
            let entered = 1.0 / angles.beams[k].mu;
            out[0].extend((0..views).map(|j| see(field, j, angles.pair(j, k)) * entered));
        }
        for sky in &skies {
            out[1].extend((0..views).map(|j| see(sky, j, [0.0; 2])));
        }
        out[2].extend((0..views).map(|j| see(&bed, j, [0.0; 2])));
    }
    out
}
