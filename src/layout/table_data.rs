//! A finished table: its samples in file order and what the manifest says of it.

use super::three_atmosphere;
use crate::files::atlas::{Atlas, Samples};
use crate::files::manifest::{Axis, ChannelInfo, Encoding, Packing, Precision, Table};
use crate::mapping::{AxisFormula, Elek2010, HALVES, WINDOW};

/// A table of up to four channels, texels in the order x, y, z, w with x fastest (z and w share the slices).
pub struct TableData {
    pub layout: String,
    pub name: String,
    pub axes: Vec<Axis>,
    pub channels: Vec<Channel>,
    pub encoding: Encoding,
    pub texels: Vec<[f32; 4]>,
}

/// Name in the file, quantity and unit; an encoding where it differs from the table's.
#[derive(Clone)]
pub struct Channel {
    pub name: String,
    pub quantity: String,
    pub unit: String,
    pub encoding: Option<Encoding>,
}

impl Channel {
    pub fn new(name: &str, quantity: impl Into<String>, unit: &str) -> Self {
        Channel { name: name.into(), quantity: quantity.into(), unit: unit.into(), encoding: None }
    }
}

impl TableData {
    /// The picture to store, in half floats: x and y are the first two axes, and slices lie in a grid, but for the
    /// layout three-atmosphere.
    pub fn atlas(&self) -> Atlas {
        let name = format!("{}/{}", self.layout, self.name);
        let across = self.across();
        let sides = [0..across, across..across + 1, across + 1..4].map(|axes| self.texels_of(axes));
        let mut atlas = if self.layout == three_atmosphere::LAYOUT {
            Atlas::new(name, sides).in_a_strip_from_the_bottom()
        } else {
            Atlas::new(name, sides)
        };
        for (k, c) in self.channels.iter().enumerate() {
            atlas = atlas.with(c.name.clone(), Samples::half(self.texels.iter().map(|t| f64::from(t[k]))));
        }
        atlas
    }

    /// Texels along some of the axes together.
    fn texels_of(&self, axes: std::ops::Range<usize>) -> usize {
        axes.map(|k| self.axes.get(k).map_or(1, |a| a.size)).product()
    }

    /// What the manifest says, once the file is written.
    pub fn entry(&self, atlas: &Atlas, blake3: String) -> Table {
        let channels = self
            .channels
            .iter()
            .zip(&atlas.channels)
            .map(|(c, stored)| ChannelInfo {
                name: c.name.clone(),
                quantity: c.quantity.clone(),
                unit: c.unit.clone(),
                sample: Precision::Half,
                range: stored.samples.range(),
                encoding: c.encoding.clone(),
            })
            .collect();
        Table {
            layout: self.layout.clone(),
            name: self.name.clone(),
            file: format!("{}/{}.exr", self.layout, self.name),
            blake3,
            shape: self.axes.iter().map(|a| a.size).collect(),
            axes: self.axes.clone(),
            packing: Packing {
                slice_width: atlas.width,
                slice_height: atlas.height,
                slices: atlas.slices,
                columns: atlas.columns,
                rows: atlas.rows(),
                slice_order: "row-major".into(),
                slice_index: self.slice_index(),
                origin: atlas.origin,
            },
            encoding: self.encoding.clone(),
            channels,
            containers: Vec::new(),
        }
    }

    /// How many axes x is made of: the reader of three-atmosphere wants all but the last two.
    fn across(&self) -> usize {
        if self.layout == three_atmosphere::LAYOUT { self.axes.len().saturating_sub(2).max(1) } else { 1 }
    }

    fn slice_index(&self) -> String {
        match self.axes.get(self.across() + 1..).unwrap_or_default() {
            [] => "0".into(),
            [z] => z.name.clone(),
            [z, w, ..] => format!("{} * {} + {}", w.name, z.size, z.name),
        }
    }
}

/// A manifest's axis from a mapping's.
pub fn axis(formula: &AxisFormula) -> Axis {
    Axis {
        name: formula.name.into(),
        size: formula.size,
        formula: format!("{}. Inverse: {}{}", formula.coordinate, formula.inverse, part(formula)),
        constants: formula.constants.iter().map(|(k, v)| (k.to_string(), *v)).collect(),
        unit: if formula.name == "altitude" { "m".into() } else { "1".into() },
    }
}

/// What of the axis the texels hold, in words, where it is not all.
fn part(formula: &AxisFormula) -> &'static str {
    let has = |name: &str| formula.constants.iter().any(|c| c.0 == name);
    if has(HALVES) {
        return ". The texels hold the second half alone: rays that do not hit the ground";
    }
    match (has(WINDOW[0]), formula.size) {
        (false, _) => "",
        (true, 1) => ". The one texel stands for coordinates from window_low to window_high",
        (true, _) => {
            ". The texels hold a part: texel i of n has the coordinate window_low + (window_high - window_low) i / (n - 1)"
        }
    }
}

/// Axes of a scattering table: altitude, view, sun, azimuth.
pub fn axes_of(mapping: &Elek2010) -> Vec<Axis> {
    mapping.axes().iter().map(axis).collect()
}

/// Moves texels from the order in which rays are integrated, `[altitude][view][sun][azimuth]`, to that of the
/// file, altitude fastest, then view, sun and azimuth.
pub fn file_order(rays: Vec<[f32; 4]>, size: [usize; 4]) -> Vec<[f32; 4]> {
    use rayon::prelude::*;
    let [altitudes, views, suns, azimuths] = size;
    let mut out = vec![[0.0; 4]; rays.len()];
    out.par_chunks_mut(altitudes * views).enumerate().for_each(|(slice, texels)| {
        let (sun, azimuth) = (slice % suns, slice / suns);
        for view in 0..views {
            for altitude in 0..altitudes {
                let from = ((altitude * views + view) * suns + sun) * azimuths + azimuth;
                texels[view * altitudes + altitude] = rays[from];
            }
        }
    });
    out
}
