//! The comment that a look-up file opens with: what to bind and what to call.

use super::{Bound, Language, is_volume};
use crate::error::Line;
use crate::files::manifest::Manifest;

const WGSL: &str = "
The numbers are bindings of group 0; the last is a sampler, linear along all axes and clamped to the edge.
HAND_FILTERED is a constant of the pipeline.";
const GLSL: &str = "
Stands after `#version 300 es`, `#version 450` or a later one of either. Textures filter linearly along all axes and
clamp to the edge; they are uniforms by their names, and in Vulkan the numbers are bindings of set 0.
HAND_FILTERED is on after `#define HAND_FILTERED true` above this.";
const HLSL: &str = "
For shader model 5 and later. The numbers are registers t; s0 is a sampler, linear along all axes and clamped to the
edge. HAND_FILTERED is on after `#define HAND_FILTERED true` above this.";

const TEXTURES: &str = "
Textures are half-float RGBA without mipmaps, texels as KTX2 and DDS files hold them; slice s of an EXR file lies in
column s mod columns, row s / columns of its picture.";
const CALLS: &str = "
Call, with the observer's height over the ground in m and, at the observer, the cosines of the view's zenith angle (1
looks up), of the sun's, and of the angle between the two,
";
const FILTERS: &str = "
vectors.csv holds what they answer. Texture units weigh texels in steps, on most GPUs of 1/256; with HAND_FILTERED the
shader does it.";

/// All that stands before the code.
pub(super) fn comment(manifest: &Manifest, layout: &str, tables: &[Bound], language: Language) -> String {
    let how = match language {
        Language::Wgsl => WGSL,
        Language::Glsl => GLSL,
        Language::Hlsl => HLSL,
    };
    let planet = &manifest.preset.name;
    let what = format!(
        "Look-ups in the bake of `{planet}`, layout `{layout}`, with all that they need of bake.json.\n"
    );
    let parts = [&what, TEXTURES, how, "\n\n", &listed(tables), CALLS, &called(manifest, layout), FILTERS];
    parts.concat().lines().map(commented).collect()
}

fn commented(line: &str) -> String {
    // A name from a stranger's bake stays in the comment: to some languages more than \n ends a line.
    if line.is_empty() { "//\n".into() } else { format!("// {}\n", Line(line)) }
}

/// A line for each table: number, name, texture, file.
fn listed(tables: &[Bound]) -> String {
    let width = tables.iter().map(|t| t.name.len()).max().unwrap_or(0);
    let line = |(k, bound): (usize, &Bound)| {
        let packing = &bound.table.packing;
        let mut sizes = vec![packing.slice_width, packing.slice_height];
        let kind = if is_volume(bound.table) {
            sizes.push(packing.slices);
            "3D"
        } else {
            "2D"
        };
        let sizes = sizes.iter().map(usize::to_string).collect::<Vec<_>>().join(" x ");
        format!("  {k:2}  {:width$}  {kind}  {sizes:14}  {}\n", bound.name, bound.table.file)
    };
    tables.iter().enumerate().map(line).collect()
}

/// The functions and what they answer.
fn called(manifest: &Manifest, layout: &str) -> String {
    let constant = |name: &str| manifest.constants.get(name).map_or(&[][..], Vec::as_slice);
    let lux = constant("star_illuminance_lx").first().copied().unwrap_or(0.0);
    let space = &manifest.colour.space;
    let mut out = format!(
        "  sky_radiance(altitude, mu, mu_s, nu)  for the light that the air scatters into the view,
  sky_total(altitude, mu, mu_s, nu)     for that and the ground's, where the view meets it:
    linear RGB ({space}), luminance over the star's illuminance, 1/sr; times {lux:.1} lx it is cd/m2.
"
    );
    if layout == "compact" {
        let nm: Vec<String> = constant("four_wavelengths_nm").iter().map(f64::to_string).collect();
        let nm = nm.join(", ");
        out += &format!(
            "  sky_radiance_at_four and sky_total_at_four are radiance over the star's irradiance, 1/sr, at {nm} nm.
"
        );
    }
    out
}
