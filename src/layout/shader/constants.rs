//! What the look-ups need of `bake.json`, in the form that `shell.wgsl` declares, as constants of the shader: compilers
//! then drop what a bake does not have, and a pixel loads nothing of it.

use crate::error::Result;
use crate::files::manifest::{EncodingKind, Manifest, Table};

/// `Table` of `shell.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TableConstants {
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
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Constants {
    pub volume: TableConstants,
    pub single: TableConstants,
    pub depth: TableConstants,
    pub scatterers: TableConstants,
    pub irradiance: TableConstants,
    pub phase: TableConstants,
    /// Scale and offset of each group, in the order of the phase table's rows.
    pub groups: Vec<[[f32; 4]; 2]>,
    pub ground_albedo: [f32; 4],
    pub rgb: [[f32; 4]; 3],
    pub counts: [f32; 4],
}

impl TableConstants {
    pub fn new(table: &Table, [ground, top]: [f64; 2]) -> Self {
        let mut out = TableConstants { size: [1.0; 4], ..Default::default() };
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
        let layer = ["layer_share", "layer_altitude"].map(|name| number(name, 0.0));
        out.layer = [layer[0], layer[1], number("layer_width", 1.0), power("altitude_power")];
        out.set_decoding(table);
        out
    }

    /// All members, in their order.
    pub fn rows(&self) -> [[f32; 4]; 10] {
        let TableConstants { size, radii, bends, sun, window, layer, scale, offset, floor, log } = *self;
        [size, radii, bends, sun, window, layer, scale, offset, floor, log]
    }

    fn wgsl(&self) -> String {
        format!("    Table(\n        {},\n    )", vectors(&self.rows(), ",\n        "))
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

    /// Whether the coordinates in a table of `other` are those in one of this: the same but for scale and offset.
    fn stacks_with(&self, other: &TableConstants) -> bool {
        let bare = |t: &TableConstants| TableConstants { scale: [0.0; 4], offset: [0.0; 4], ..*t };
        bare(self) == bare(other)
    }
}

impl Constants {
    /// Those of a layout, `compact` or `elek2010`. Errors: what of `bake.json` no look-up can be made of.
    pub fn new(manifest: &Manifest, layout: &str) -> Result<Self> {
        let number = |name: &str| {
            let found = manifest.constants.get(name).and_then(|v| v.first()).copied();
            found.ok_or_else(|| format!("bake.json: constants.{name} is missing"))
        };
        let radii = [number("ground_radius_m")?, number("top_radius_m")?];
        let table = |name: &str| manifest.tables.iter().find(|t| t.layout == layout && t.name == name);
        let of = |name: &str| table(name).map_or_else(Default::default, |t| TableConstants::new(t, radii));
        let illuminance = number("star_illuminance_lx")?;
        let mut out = Constants {
            volume: of(main(layout)),
            depth: of("transmittance"),
            scatterers: of("scatterers"),
            irradiance: of("irradiance"),
            phase: of("phase"),
            rgb: rgb_rows(manifest, "rgb_from_four", illuminance),
            ..Default::default()
        };
        if let Some(albedo) = manifest.constants.get("ground_albedo_at_four") {
            out.ground_albedo = four(albedo);
        }
        out.add_groups(&singles(manifest, layout), radii)?;
        let row =
            if table("phase").is_some() { number("elek2010_aerosol_phase_row").unwrap_or(0.0) } else { -1.0 };
        let scatterers = f64::from(u8::from(table("scatterers").is_some()));
        out.counts = four(&[out.groups.len() as f64, scatterers, row, illuminance]);
        Ok(out)
    }

    fn add_groups(&mut self, tables: &[&Table], radii: [f64; 2]) -> Result<()> {
        for table in tables {
            let constants = TableConstants::new(table, radii);
            if self.groups.is_empty() {
                self.single = constants;
            } else if !self.single.stacks_with(&constants) {
                return Err(format!("tables.{}: of another shape than {}", table.name, tables[0].name).into());
            }
            self.groups.push([constants.scale, constants.offset]);
        }
        if !tables.is_empty() && (self.phase.log[0] != 1.0 || self.single.log[0] != 1.0) {
            return Err("bake.json: tables.phase and tables.single_*: must be stored as logarithms".into());
        }
        Ok(())
    }

    /// The constant that `shell.wgsl` wants to know before it is read.
    pub fn groups_wgsl(&self) -> String {
        format!("const GROUPS: i32 = {};\n", self.groups.len().max(1))
    }

    /// The declaration of the constant `tables`.
    pub fn wgsl(&self) -> String {
        let tables =
            [&self.volume, &self.single, &self.depth, &self.scatterers, &self.irradiance, &self.phase];
        let mut groups = self.groups.clone();
        groups.resize(groups.len().max(1), [[0.0; 4]; 2]);
        let of_groups = |k: usize| vectors(&groups.iter().map(|g| g[k]).collect::<Vec<_>>(), ",\n        ");
        let array = |length: &str, rows: &str| format!("    array<vec4f, {length}>(\n        {rows},\n    )");
        let parts = tables.map(TableConstants::wgsl).into_iter().chain([
            array("GROUPS", &of_groups(0)),
            array("GROUPS", &of_groups(1)),
            "    ".to_string() + &vectors(&[self.ground_albedo], ""),
            array("3", &vectors(&self.rgb, ",\n        ")),
            "    ".to_string() + &vectors(&[self.counts], ""),
        ]);
        let parts: Vec<String> = parts.collect();
        format!("const tables: Tables = Tables(\n{},\n);\n", parts.join(",\n"))
    }
}

/// Name of a layout's table of the light that its groups share.
pub fn main(layout: &str) -> &'static str {
    if layout == "compact" { "multiple" } else { "scattering" }
}

/// Tables of light scattered once, in the order of the rows of the phase table.
pub fn singles<'a>(manifest: &'a Manifest, layout: &str) -> Vec<&'a Table> {
    let of_layout = manifest.tables.iter().filter(|t| t.layout == layout);
    of_layout.filter(|t| t.name.starts_with("single_")).collect()
}

/// Each with all its digits. Shaders have no word for what is not finite, which no sound bake holds.
fn vectors(rows: &[[f32; 4]], between: &str) -> String {
    let number = |v: f32| format!("{:e}", if v.is_finite() { v } else { f32::MAX });
    let rows = rows.iter().map(|row| format!("vec4f({})", row.map(number).join(", ")));
    rows.collect::<Vec<_>>().join(between)
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

    /// Numbers keep their digits, whatever their size, and a word that shaders do not know is never written.
    #[test]
    fn constants_keep_their_digits() {
        let row = [0.1, -3.4028235e38, 1e-45, f32::NAN];
        let text = vectors(&[row], "");
        let inner = text.strip_prefix("vec4f(").unwrap().strip_suffix(')').unwrap();
        let back: Vec<f32> = inner.split(", ").map(|v| v.parse().unwrap()).collect();
        assert_eq!(back, [row[0], row[1], row[2], f32::MAX], "{text}");
        assert!(Constants::default().wgsl().matches("vec4f(").count() == 6 * 10 + 1 + 1 + 1 + 3 + 1);
    }

    /// A water's uniform copies these rows: they stand in the order of the members.
    #[test]
    fn rows_are_in_the_order_of_the_members() {
        let names = ["size", "radii", "bends", "sun", "window", "layer", "scale", "offset", "floor", "log"];
        let shell = crate::layout::shader::SHELL;
        let members = &shell[shell.find("struct Table {").unwrap()..];
        let found: Vec<usize> =
            names.iter().map(|n| members.find(&format!("\n    {n}: vec4f")).unwrap()).collect();
        assert!(found.is_sorted(), "{found:?}");
        let v = |k: f32| [k; 4];
        let table = TableConstants {
            size: v(0.0),
            radii: v(1.0),
            bends: v(2.0),
            sun: v(3.0),
            window: v(4.0),
            layer: v(5.0),
            scale: v(6.0),
            offset: v(7.0),
            floor: v(8.0),
            log: v(9.0),
        };
        assert_eq!(table.rows(), std::array::from_fn(|k| v(k as f32)));
    }
}
