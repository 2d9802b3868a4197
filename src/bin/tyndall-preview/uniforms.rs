//! What the look-up shaders need of `bake.json`, in the form that `shell.wgsl` declares, written into them as constants:
//! compilers then drop what a bake does not have, and a pixel loads nothing of it.

use bytemuck::{Pod, Zeroable};
use tyndall::export::manifest::{EncodingKind, Manifest, Table};

/// As many groups of single scattering as `shell.wgsl` has room for.
pub const MOST_GROUPS: usize = 6;

/// `Table` of `shell.wgsl`; a part of the uniform of a water, which changes by a key.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TableUniform {
    pub size: [f32; 4],
    pub radii: [f32; 4],
    pub bends: [f32; 4],
    pub sun: [f32; 4],
    pub window: [f32; 4],
    pub layer: [f32; 4],
    pub scale: [f32; 4],
    pub offset: [f32; 4],
    pub floor: [f32; 4],
    pub log: [f32; 4],
}

/// `Tables` of `shell.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TablesUniform {
    pub volume: TableUniform,
    pub single: TableUniform,
    pub depth: TableUniform,
    pub scatterers: TableUniform,
    pub irradiance: TableUniform,
    pub phase: TableUniform,
    pub group_scale: [[f32; 4]; MOST_GROUPS],
    pub group_offset: [[f32; 4]; MOST_GROUPS],
    pub ground_albedo: [f32; 4],
    pub rgb: [[f32; 4]; 3],
    pub counts: [f32; 4],
}

impl TableUniform {
    pub fn new(table: &Table, [ground, top]: [f64; 2]) -> Self {
        let mut out = TableUniform { size: [1.0; 4], ..Default::default() };
        for (slot, n) in out.size.iter_mut().zip(&table.shape) {
            *slot = *n as f32;
        }
        // A constant of any axis; names differ between axes that differ.
        let constant = |name: &str| table.axes.iter().find_map(|a| a.constants.get(name)).copied();
        let number = |name: &str, without: f64| constant(name).unwrap_or(without) as f32;
        let over_length = table.channels.iter().any(|c| c.unit == "1/m");
        out.radii = [ground as f32, top as f32, number("mu_s_min", 0.0), f32::from(u8::from(over_length))];
        let kind = match (constant("shift"), constant("centre")) {
            (Some(_), _) => 1.0,
            (_, Some(_)) => 2.0,
            _ => 0.0,
        };
        let power = |name: &str| number(name, 1.0);
        out.bends = [number("altitude_bend", 0.0), power("view_power"), power("horizon_power"), kind];
        let middle = constant("shift").or(constant("centre")).unwrap_or(0.0) as f32;
        let halves = f32::from(u8::from(constant("halves") == Some(1.0)));
        out.sun = [middle, number("width", 1.0), halves, 0.0];
        let [[altitude, rise], [sun, climb]] = ["altitude", "sun"].map(|axis| window(table, axis));
        out.window = [altitude, rise, sun, climb];
        out.layer = [
            number("layer_share", 0.0),
            number("layer_altitude", 0.0),
            number("layer_width", 1.0),
            number("altitude_power", 1.0),
        ];
        out.set_decoding(table);
        out
    }

    fn wgsl(&self) -> String {
        let axes = [self.size, self.radii, self.bends, self.sun, self.window, self.layer];
        let decoding = [self.scale, self.offset, self.floor, self.log];
        format!("Table({}, {})", vectors(&axes), vectors(&decoding))
    }

    fn set_decoding(&mut self, table: &Table) {
        for (k, channel) in table.channels.iter().enumerate().take(4) {
            let encoding = channel.encoding.as_ref().unwrap_or(&table.encoding);
            self.scale[k] = encoding.scale as f32;
            self.offset[k] = encoding.offset as f32;
            self.log[k] = f32::from(u8::from(encoding.kind == EncodingKind::Log));
            self.floor[k] = encoding.floor.unwrap_or(f64::from(f32::MIN)) as f32;
        }
    }

    /// Whether a texture of this can be stacked on one of `other`: the same but for scale and offset.
    pub fn stacks_with(&self, other: &TableUniform) -> bool {
        let bare = |t: &TableUniform| TableUniform { scale: [0.0; 4], offset: [0.0; 4], ..*t };
        bare(self) == bare(other)
    }
}

impl TablesUniform {
    /// The declaration of the constant `tables`.
    pub fn wgsl(&self) -> String {
        let tables = [self.volume, self.single, self.depth, self.scatterers, self.irradiance, self.phase];
        format!(
            "const tables = Tables({}, array({}), array({}), {}, array({}), {});",
            tables.map(|t| t.wgsl()).join(", "),
            vectors(&self.group_scale),
            vectors(&self.group_offset),
            vectors(&[self.ground_albedo]),
            vectors(&self.rgb),
            vectors(&[self.counts]),
        )
    }
}

/// Each with all its digits. WGSL has no word for what is not finite, which no sound bake holds.
fn vectors(rows: &[[f32; 4]]) -> String {
    let number = |v: f32| format!("{:e}", if v.is_finite() { v } else { f32::MAX });
    rows.iter().map(|row| format!("vec4f({})", row.map(number).join(", "))).collect::<Vec<_>>().join(", ")
}

/// Start of what a table holds of an axis, and 1 over its extent, 0 where it has none.
fn window(table: &Table, axis: &str) -> [f32; 2] {
    let axis = table.axes.iter().find(|a| a.name == axis);
    let end = |name: &str| axis.and_then(|a| a.constants.get(name)).copied();
    let (Some(low), Some(high)) = (end("window_low"), end("window_high")) else { return [0.0, 1.0] };
    [low as f32, if high > low { (1.0 / (high - low)) as f32 } else { 0.0 }]
}

/// Up to four numbers as a vector, the rest 0.
pub fn four(values: &[f64]) -> [f32; 4] {
    let mut out = [0.0; 4];
    out.iter_mut().zip(values).for_each(|(o, v)| *o = *v as f32);
    out
}

/// The rows of a matrix of the manifest, over the star's illuminance.
pub fn rgb_rows(manifest: &Manifest, matrix: &str, illuminance: f64) -> [[f32; 4]; 3] {
    let mut out = [[0.0; 4]; 3];
    if let Some(rows) = manifest.colour.matrices.get(matrix) {
        for (slot, row) in out.iter_mut().zip(rows) {
            *slot = four(&row.iter().map(|v| v / illuminance).collect::<Vec<_>>());
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers keep their digits, whatever their size, and a word that WGSL does not know is never written.
    #[test]
    fn constants_keep_their_digits() {
        let row = [0.1, -3.4028235e38, 1e-45, f32::NAN];
        let text = vectors(&[row]);
        let inner = text.strip_prefix("vec4f(").unwrap().strip_suffix(')').unwrap();
        let back: Vec<f32> = inner.split(", ").map(|v| v.parse().unwrap()).collect();
        assert_eq!(back, [row[0], row[1], row[2], f32::MAX], "{text}");
        assert!(TablesUniform::default().wgsl().matches("vec4f(").count() == 6 * 10 + 6 + 6 + 1 + 3 + 1);
    }
}
