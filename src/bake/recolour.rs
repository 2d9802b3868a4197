//! A bake of the compact layout under another star, for another observer or in another colour space: its tables hold
//! ratios of radiance and irradiance, which know neither, so that only numbers of the manifest change.

use super::files::{Content, entry};
use super::{describe, pictures, report, versions, warnings};
use crate::colour::samples as skies;
use crate::colour::samples::Skies;
use crate::colour::weights::ColourWeights;
use crate::error::{Error, Result};
use crate::files::Atlas;
use crate::files::manifest::{Manifest, Preset, Tool};
use crate::layout::compact;
use crate::layout::shader;
use crate::layout::sky;
use crate::preset::Planet;
use crate::spectrum::{OBSERVER_RANGE, Rgb, Spectrum, StandardObserver, planck_law};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

/// What is to be another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wanted {
    /// Temperature of a star of the same size and at the same distance, a black body, K.
    pub star_k: Option<f64>,
    pub beholder: StandardObserver,
    pub rgb: Rgb,
}

/// A bake to be recoloured, read.
pub struct Source<'a> {
    pub folder: &'a Path,
    pub manifest: &'a Manifest,
    /// Tables of the compact layout by name, and the bytes of [`skies::FILE`].
    pub tables: &'a BTreeMap<String, Atlas>,
    pub skies: &'a [u8],
}

/// The manifest of the recoloured bake, and path and content of the files that are not the source's: look-ups, which
/// hold its matrices, and `preview.png`. The matrices are those of a bake, fitted on the same skies, but for the
/// choice of the four wavelengths, which stays.
///
/// # Errors
/// `File` for a source that is damaged or not of this tool.
pub fn recolour(source: &Source, wanted: &Wanted) -> Result<(Manifest, Vec<Content>)> {
    let refuse = |reason: String| Error::file(source.folder, format!("bake.json: {reason}"));
    let old = source.manifest;
    if !old.settings.is_object() {
        return Err(refuse("settings: must be an object".into()));
    }
    let mut planet = Planet::from_resolved(&old.preset.resolved).map_err(|e| refuse(e.to_string()))?;
    if let Some(kelvin) = wanted.star_k {
        planet.star.irradiance = black_body(kelvin, planet.star.angular_radius)?;
    }
    let samples = skies::from_file(&source.folder.join(skies::FILE), source.skies, &old.wavelengths.nm)?;
    let palette = palette(old, &planet, &samples, wanted).map_err(|e| refuse(e.to_string()))?;
    let mut new = old.clone();
    // Its tables are the source's.
    new.tool = Tool::this(old.tool.algorithms.clone());
    new.tool.algorithms.retain(|name, _| [versions::SOLVER, compact::LAYOUT].contains(&name.as_str()));
    new.tables.retain(|t| t.layout == compact::LAYOUT);
    new.waters = Vec::new();
    new.preset = Preset { name: planet.name.clone(), hash: planet.hash(), resolved: planet.resolved() };
    new.colour = describe::colour(&palette);
    new.constants.retain(|name, _| !name.starts_with("water_"));
    new.constants.extend(describe::star(&planet, &palette));
    new.settings = settings(old, wanted);
    new.quality = Value::Object(quality(old, &palette));
    new.warnings = planet.warnings.clone();
    new.warnings.extend(warnings::colours(&palette));
    let mut made = shader::files(source.folder, &new, compact::LAYOUT)?;
    let sky = sky::of_pictures(source.folder, &new, compact::LAYOUT, source.tables)?;
    let (picture, errors) =
        pictures::preview(sky.as_ref(), &planet, &crate::layout::settings::window(&old.settings), &[])?;
    if errors > 0 {
        new.warnings.push(format!("preview.png: {errors} pixels that no display can show (in magenta)"));
    }
    let about = "skies at several sun heights and the planet from space";
    made.push((pictures::FILE.into(), about.into(), picture));
    // The light at the four wavelengths stays what it was, and so do its golden vectors.
    let own = format!("{}/", compact::LAYOUT);
    new.files.retain(|f| f.file.starts_with(&own) && made.iter().all(|m| m.0 != f.file));
    new.files.extend(made.iter().map(entry));
    new.seal()?;
    Ok((new, made.into_iter().map(|(file, _, bytes)| (file, bytes)).collect()))
}

/// Irradiance at the planet, π B sin² α, W/(m² nm), as presets have it.
fn black_body(kelvin: f64, angular_radius: f64) -> Result<Spectrum> {
    let sine = libm::sin(angular_radius);
    let grid = (OBSERVER_RANGE.0..=OBSERVER_RANGE.1).map(|w| w as f64).collect();
    let star = Spectrum::sampled(grid, |w| PI * sine * sine * 1e-9 * planck_law(w, kelvin));
    star.map_err(|reason| Error::Argument(format!("--star {kelvin}: {reason}")))
}

fn palette(old: &Manifest, planet: &Planet, samples: &[Skies; 2], wanted: &Wanted) -> Result<ColourWeights> {
    let nm = &old.wavelengths.nm;
    let four = old.constants.get("four_wavelengths_nm");
    let place = |w: &f64| nm.iter().position(|other| other == w);
    let four: Option<Vec<usize>> = four.and_then(|four| four.iter().map(place).collect());
    let reason = || Error::Argument("constants.four_wavelengths_nm are not among wavelengths.nm".into());
    let four = Some(four.ok_or_else(reason)?);
    let [training, held_out] = samples;
    let star = &planet.star.irradiance;
    ColourWeights::of(nm, star, &wanted.rgb, wanted.beholder, [training, held_out], four)
}

/// Those of the source, with what was wanted of it.
fn settings(old: &Manifest, wanted: &Wanted) -> Value {
    let mut settings = old.settings.clone();
    settings["layouts"] = json!([compact::LAYOUT]);
    settings["waters"] = json!([]);
    settings["white"] = crate::layout::settings::white(&wanted.rgb);
    settings["shipped_preset"] = json!(false);
    settings["recoloured"] = json!({ "star_k": wanted.star_k, "observer": wanted.beholder.name() });
    settings
}

/// What the source says of its solver and of radiance holds; of colours, what is found now.
fn quality(old: &Manifest, palette: &ColourWeights) -> Map<String, Value> {
    let mut out = Map::new();
    out.insert("colour".into(), report::colours(palette, None));
    for key in ["solver", "compact_against_direct_integration"] {
        let Some(found) = old.quality.get(key) else { continue };
        let mut found = found.clone();
        for region in found.as_object_mut().into_iter().flat_map(|m| m.values_mut()) {
            if let Some(region) = region.as_object_mut() {
                region.remove("rgb");
            }
        }
        out.insert(key.into(), found);
    }
    out
}
