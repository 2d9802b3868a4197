//! The look-ups as shader code: the WGSL of the layouts, the constants of a bake, and both in GLSL and HLSL.

mod constants;
mod head;
mod tokens;
mod translate;

pub use constants::{Constants, TableConstants, four, main, rgb_rows, singles};

use crate::error::{Error, Result};
use crate::files::manifest::{Manifest, Table};
use std::path::Path;

pub const SHELL: &str = include_str!("shell.wgsl");
pub const COMPACT: &str = include_str!("../compact/lookup.wgsl");
pub const ELEK2010: &str = include_str!("../elek2010/lookup.wgsl");
pub const SLICES: &str = include_str!("slices.wgsl");
pub const WATER: &str = include_str!("../water/lookup.wgsl");

const ASK_COMPACT: &str = include_str!("../compact/ask.wgsl");
const ASK_ELEK2010: &str = include_str!("../elek2010/ask.wgsl");

/// The layouts that there are look-ups of.
pub const LAYOUTS: [&str; 2] = ["compact", "elek2010"];

/// A language that look-ups are written in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    Wgsl,
    Glsl,
    Hlsl,
}

impl Language {
    pub const ALL: [Language; 3] = [Language::Wgsl, Language::Glsl, Language::Hlsl];

    pub fn name(self) -> &'static str {
        match self {
            Language::Wgsl => "wgsl",
            Language::Glsl => "glsl",
            Language::Hlsl => "hlsl",
        }
    }
}

/// Path, description and content of a layout's files, one a language; none for a layout without look-ups.
///
/// # Errors
/// `File` for a manifest that no look-up can be made of. `bake` is for messages.
pub fn files(bake: &Path, manifest: &Manifest, layout: &str) -> Result<Vec<(String, String, Vec<u8>)>> {
    if !LAYOUTS.contains(&layout) {
        return Ok(Vec::new());
    }
    let constants = Constants::new(manifest, layout).map_err(|reason| Error::file(bake, reason))?;
    let about =
        |l: Language| format!("look-ups in this layout with the constants of this bake, {}", l.name());
    let file = |l: Language| {
        let text = text(manifest, layout, &constants, l).map_err(|reason| Error::file(bake, reason))?;
        Ok((format!("{layout}/lookup.{}", l.name()), about(l), text.into_bytes()))
    };
    Language::ALL.into_iter().map(file).collect()
}

/// A table as it is bound.
struct Bound<'a> {
    name: String,
    table: &'a Table,
}

/// The tables that look-ups bind, in the order of their bindings.
fn bound<'a>(manifest: &'a Manifest, layout: &str) -> Vec<Bound<'a>> {
    let named = |name: &str| {
        let found = manifest.tables.iter().find(|t| t.layout == layout && t.name == name);
        found.map(|table| Bound { name: format!("table_{name}"), table })
    };
    let singles = singles(manifest, layout).into_iter().enumerate();
    let planes = ["transmittance", "scatterers", "irradiance", "phase"];
    named(main(layout))
        .into_iter()
        .chain(singles.map(|(k, table)| Bound { name: format!("table_single_{k}"), table }))
        .chain(planes.into_iter().filter_map(named))
        .collect()
}

fn text(manifest: &Manifest, layout: &str, constants: &Constants, language: Language) -> Result<String> {
    let tables = bound(manifest, layout);
    let of_layout = if layout == "compact" { COMPACT } else { ELEK2010 };
    let parts = [
        constants.groups_wgsl(),
        SHELL.into(),
        of_layout.into(),
        bindings(&tables),
        constants.wgsl(),
        asked(layout, &tables),
    ];
    let body = translate::translate(&parts.join("\n"), language)?;
    Ok(head::comment(manifest, layout, &tables, language) + "\n" + &body)
}

/// Whether a table takes three coordinates.
fn is_volume(table: &Table) -> bool {
    table.axes.len() > 2
}

fn bindings(tables: &[Bound]) -> String {
    let mut out = String::from("// The tables and, last, what they are filtered by.\n\n");
    for (k, bound) in tables.iter().enumerate() {
        let kind = if is_volume(bound.table) { "texture_3d<f32>" } else { "texture_2d<f32>" };
        out += &format!("@group(0) @binding({k}) var {}: {kind};\n", bound.name);
    }
    out + &format!("@group(0) @binding({}) var table_filtering: sampler;\n", tables.len())
}

/// What a shader calls. A table that a bake has not, and that its constants keep from being read, is another.
fn asked(layout: &str, tables: &[Bound]) -> String {
    let mut out = match layout {
        "compact" => fetched(tables) + ASK_COMPACT,
        _ => ASK_ELEK2010.to_string(),
    };
    for absent in ["table_scatterers", "table_phase"] {
        if !tables.iter().any(|t| t.name == absent) {
            out = out.replace(absent, "table_transmittance");
        }
    }
    out
}

/// The look-ups of `compact` in a texture for each group.
fn fetched(tables: &[Bound]) -> String {
    let singles = tables.iter().filter(|t| t.name.starts_with("table_single_")).count();
    let mut out = String::from(
        "// Light that the air scatters into a view that has entered it, at the four wavelengths.\n\
         fn sky_scattered(p: Place) -> vec4f {\n    var stored: Stored;\n    \
         let at: vec4f = volume_texel(tables.volume, p);\n    \
         stored.volume = fetch_4d(tables.volume, table_multiple, table_filtering, at, 0.0);\n",
    );
    if singles > 0 {
        out += "    let single: vec4f = volume_texel(tables.single, p);\n";
    }
    for k in 0..singles {
        out += &format!(
            "    stored.single[{k}] = fetch_4d(tables.single, table_single_{k}, table_filtering, single, 0.0);\n"
        );
    }
    let textures = "table_transmittance, table_scatterers, table_phase, table_filtering";
    out + &format!("    return compact_scattering(tables, stored, {textures}, p);\n}}\n\n")
}
