//! Texels of one water's tables.

use super::shared::{self, baked, channels_of};
use super::{EvenCosine, WaterAxes};
use super::{LAYOUT, Waters};
use crate::layout::table_data::{Channel, TableData};
use crate::medium::WaterMedium;
use crate::preset::Water;
use crate::transport::slab::{Angles, Dome, Layer, Slab};
use rayon::prelude::*;

/// Texels of depth of tables without a sun axis, which cost little.
pub(super) const DEPTHS: usize = 128;
/// Powers p that the axis D = D_max x^p may have: at 3 and 32 texels to 100 m the second is 3 mm deep and the last
/// step 10 m.
const DEPTH_POWERS: [f64; 5] = [2.0, 3.0, 4.0, 5.0, 6.0];
/// Cosines in the water are kept off 0, where no ray gets anywhere (n = 1 only).
pub(super) const LEAST_COSINE: f64 = 1e-4;

/// The sun axis of water: above the horizon only.
pub(super) const SUN: EvenCosine = EvenCosine { name: "sun", least: 0.0 };

/// The depth and view axes of a water: the smallest power that gives its thickest wavelength room to change.
pub(super) fn axes(water: &Water, media: &WaterMedium, slabs: &[Slab]) -> WaterAxes {
    let n = media.refractive_index.iter().sum::<f64>() / media.refractive_index.len() as f64;
    let thickest = slabs.iter().map(|s| rise(s) * water.largest_depth).fold(1.0, f64::max);
    let enough = |p: &f64| libm::pow(thickest, -1.0 / p) >= ROOM;
    let depth_power = DEPTH_POWERS.into_iter().find(enough).unwrap_or(DEPTH_POWERS[DEPTH_POWERS.len() - 1]);
    WaterAxes { largest_depth: water.largest_depth, depth_power, n }
}

/// Rate at which water's own light rises with depth, 1/m: down and up, at the pace of deep water.
pub(super) fn rise(slab: &Slab) -> f64 {
    2.0 * slab.extinction * slab.slowest()
}

/// Share of the depth axis for the first length over which light rises.
const ROOM: f64 = 0.15;
/// Depth at which the limit of depth 0 is taken, over that length.
const SHALLOW: f64 = 1e-4;

/// Values at one wavelength and depth.
#[derive(Default)]
struct Column {
    /// `[sun][view]`
    water: Vec<f64>,
    /// `[part][view]`
    sky: Vec<f64>,
    /// `[view]`
    seabed: Vec<f64>,
    /// `[sun]`
    seabed_sun: Vec<f64>,
    /// Irradiance of the bed by both parts of the sky, and by itself.
    seabed_depth: [f64; 3],
}

/// W, S, U, W_b, and S_b with r: see the module's formula.
pub(crate) fn tables(water: &Water, media: &WaterMedium, slabs: &[Slab], waters: &Waters) -> Vec<TableData> {
    let [depths, views, suns] = waters.size;
    let axes = axes(water, media, slabs);
    let inside = |slab: &Slab, mu: f64| slab.surface.cosine_in_water(mu).max(LEAST_COSINE);
    let angles: Vec<Angles> = slabs
        .par_iter()
        .enumerate()
        .map(|(w, slab)| {
            let view: Vec<f64> = (0..views).map(|j| inside(slab, axes.mu(j, views))).collect();
            let sun: Vec<f64> = (0..suns).map(|k| inside(slab, SUN.at(k, suns))).collect();
            Angles::new(media, w, slab, &view, &sun, waters.orders, false)
        })
        .collect();
    let columns = |count: usize, whole: bool| -> Vec<Vec<Column>> {
        (0..slabs.len() * count)
            .into_par_iter()
            .map(|k| {
                let (w, depth) = (k / count, axes.depth(k % count, count));
                let kappa = rise(&slabs[w]);
                let depth = if kappa > 0.0 { depth.max(SHALLOW / kappa) } else { depth };
                let risen = if kappa > 0.0 { -libm::expm1(-kappa * depth) } else { 1.0 };
                column(&Layer::new(&slabs[w], depth), &angles[w], whole, risen)
            })
            .collect::<Vec<_>>()
            .into_iter()
            .fold(Vec::new(), |mut rows: Vec<Vec<Column>>, column| {
                match rows.last_mut() {
                    Some(row) if row.len() < count => row.push(column),
                    _ => rows.push(vec![column]),
                }
                rows
            })
    };
    let (coarse, fine) = (columns(depths, true), columns(DEPTHS, false));
    let (depth, view) = (axes.depth_axis(depths), axes.view_axis(views));
    let (deep, sun) = (axes.depth_axis(DEPTHS), SUN.axis(suns));
    let name = |what: &str| format!("{}{what}", water.name);
    let of = |what: &str, unit: &str| -> Vec<Channel> { channels_of(&media.wavelengths_nm, what, unit) };
    let rows = shared::listed(
        "row",
        3,
        format!("by a sky of unit irradiance, {PARTS}; 2: by the bed itself, of unit radiance"),
    );
    let parts = shared::listed("part", 2, PARTS.into());
    vec![
        baked(
            LAYOUT,
            name(""),
            vec![plain(&depth), plain(&view), plain(&sun)],
            of(
                "radiance below the surface over n^2, of water over a black bed, per irradiance that the sun brings in and 1 - exp(-kappa D)",
                "1/sr",
            ),
            |[i, j, k], w| coarse[w][i].water[k * views + j],
        ),
        baked(
            LAYOUT,
            name("_sky"),
            vec![plain(&deep), plain(&view), parts],
            of(
                "radiance below the surface over n^2, of water over a black bed, per irradiance of the surface by a sky and 1 - exp(-kappa D)",
                "1/sr",
            ),
            |[i, j, part], w| fine[w][i].sky[part * views + j],
        ),
        baked(
            LAYOUT,
            name("_seabed"),
            vec![plain(&deep), plain(&view)],
            of("radiance below the surface over n^2, per radiance of an evenly bright bed", "1"),
            |[i, j, _], w| fine[w][i].seabed[j],
        ),
        baked(
            LAYOUT,
            name("_seabed_sun"),
            vec![plain(&deep), plain(&sun)],
            of("irradiance of a black bed, per irradiance that the sun brings in", "1"),
            |[i, k, _], w| fine[w][i].seabed_sun[k],
        ),
        baked(
            LAYOUT,
            name("_seabed_depth"),
            vec![plain(&deep), rows],
            of("irradiance of a black bed", "1"),
            |[i, row, _], w| fine[w][i].seabed_depth[row],
        ),
    ]
}

pub(super) fn plain(formula: &crate::mapping::AxisFormula) -> crate::files::manifest::Axis {
    let mut axis = crate::layout::table_data::axis(formula);
    if formula.name == "depth" {
        axis.unit = "m".into();
    }
    axis
}

/// The parts of a sky, as an axis lists them.
pub(super) const PARTS: &str = "0: of a radiance in proportion to mu; 1: in proportion to (1 - mu)^2";

/// `whole`: the table with a sun and a view axis; `risen`: what water's own light is divided by.
fn column(layer: &Layer, angles: &Angles, whole: bool, risen: f64) -> Column {
    let n2 = layer.slab.surface.n * layer.slab.surface.n;
    let (skies, bed) = (Dome::PARTS.map(|dome| layer.sky(dome)), layer.bed());
    let see = |field, scale: f64| -> Vec<f64> {
        angles.views.iter().map(|v| layer.up(field, v, [0.0; 2], 0.0) * scale).collect()
    };
    let mut out = Column {
        sky: skies.iter().flat_map(|sky| see(sky, 1.0 / (n2 * risen))).collect(),
        seabed: see(&bed, 1.0 / n2),
        seabed_depth: [&skies[0], &skies[1], &bed].map(|field| layer.bed_irradiance(field)),
        ..Column::default()
    };
    for (k, beam) in angles.beams.iter().enumerate() {
        let sunlit = angles.sun(layer, k);
        if !whole {
            out.seabed_sun.push(layer.bed_irradiance(&sunlit) / beam.mu);
            continue;
        }
        let light = |(j, view)| layer.up(&sunlit, view, angles.pair(j, k), 0.0) / (beam.mu * n2 * risen);
        out.water.extend(angles.views.iter().enumerate().map(light));
    }
    out
}
