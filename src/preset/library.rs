//! The presets and spectra that are inside the binary.

use crate::error::{Error, Result};
use crate::files::bounded_read;
use crate::files::bounded_read::MOST_CSV;
use crate::spectrum::Spectrum;
use std::path::{Path, PathBuf};

/// Name and JSON text of every shipped planet, in the order they are listed.
const PLANETS: &[(&str, &str)] = &[
    ("earth", include_str!("../../presets/planets/earth.json")),
    ("earth-paper", include_str!("../../presets/planets/earth-paper.json")),
    ("earth-blog", include_str!("../../presets/planets/earth-blog.json")),
    ("earth-sparse10", include_str!("../../presets/planets/earth-sparse10.json")),
    ("earth-dense10", include_str!("../../presets/planets/earth-dense10.json")),
    ("mars", include_str!("../../presets/planets/mars.json")),
    ("venus", include_str!("../../presets/planets/venus.json")),
    ("venus-cloudtop", include_str!("../../presets/planets/venus-cloudtop.json")),
    ("titan", include_str!("../../presets/planets/titan.json")),
];

/// Name and JSON text of every shipped water, in the order they are listed.
const WATERS: &[(&str, &str)] = &[
    ("clear-ocean", include_str!("../../presets/waters/clear-ocean.json")),
    ("tropical", include_str!("../../presets/waters/tropical.json")),
    ("sandy", include_str!("../../presets/waters/sandy.json")),
    ("muddy", include_str!("../../presets/waters/muddy.json")),
    ("algae", include_str!("../../presets/waters/algae.json")),
    ("phytoplankton", include_str!("../../presets/waters/phytoplankton.json")),
    ("jerlov-i", include_str!("../../presets/waters/jerlov-i.json")),
    ("jerlov-ia", include_str!("../../presets/waters/jerlov-ia.json")),
    ("jerlov-ib", include_str!("../../presets/waters/jerlov-ib.json")),
    ("jerlov-ii", include_str!("../../presets/waters/jerlov-ii.json")),
    ("jerlov-iii", include_str!("../../presets/waters/jerlov-iii.json")),
    ("jerlov-1c", include_str!("../../presets/waters/jerlov-1c.json")),
    ("jerlov-3c", include_str!("../../presets/waters/jerlov-3c.json")),
    ("jerlov-5c", include_str!("../../presets/waters/jerlov-5c.json")),
    ("jerlov-7c", include_str!("../../presets/waters/jerlov-7c.json")),
    ("jerlov-9c", include_str!("../../presets/waters/jerlov-9c.json")),
];

/// Name and JSON text of every shipped scene, in the order they are listed.
const SCENES: &[(&str, &str)] = &[
    ("walk", include_str!("../../presets/scenes/walk.json")),
    ("flight", include_str!("../../presets/scenes/flight.json")),
    ("orbit", include_str!("../../presets/scenes/orbit.json")),
    ("rover", include_str!("../../presets/scenes/rover.json")),
    ("ocean", include_str!("../../presets/scenes/ocean.json")),
];

/// Name and CSV text of every shipped spectrum.
const SPECTRA: &[(&str, &str)] = &[
    ("ozone-serdyuchenko-233k", include_str!("../../presets/spectra/ozone-serdyuchenko-233k.csv")),
    (
        "phytoplankton-bricaud1998-exponent",
        include_str!("../../presets/spectra/phytoplankton-bricaud1998-exponent.csv"),
    ),
    (
        "phytoplankton-bricaud1998-factor",
        include_str!("../../presets/spectra/phytoplankton-bricaud1998-factor.csv"),
    ),
    ("seabed-brown-algae", include_str!("../../presets/spectra/seabed-brown-algae.csv")),
    ("seabed-coral-sand", include_str!("../../presets/spectra/seabed-coral-sand.csv")),
    ("seabed-green-algae", include_str!("../../presets/spectra/seabed-green-algae.csv")),
    ("seabed-mud", include_str!("../../presets/spectra/seabed-mud.csv")),
    ("seabed-sand", include_str!("../../presets/spectra/seabed-sand.csv")),
    ("seawater-absorption-wopp", include_str!("../../presets/spectra/seawater-absorption-wopp.csv")),
    ("seawater-refractive-index", include_str!("../../presets/spectra/seawater-refractive-index.csv")),
    (
        "seawater-scattering-zhang2009",
        include_str!("../../presets/spectra/seawater-scattering-zhang2009.csv"),
    ),
    ("sun-tsis1-hsrs", include_str!("../../presets/spectra/sun-tsis1-hsrs.csv")),
    (
        "water-absorption-buiteveld1994",
        include_str!("../../presets/spectra/water-absorption-buiteveld1994.csv"),
    ),
    ("water-refractive-index", include_str!("../../presets/spectra/water-refractive-index.csv")),
    ("water-scattering-zhang2009", include_str!("../../presets/spectra/water-scattering-zhang2009.csv")),
];

/// Names of the shipped presets.
pub fn shipped_names() -> impl Iterator<Item = &'static str> {
    PLANETS.iter().map(|p| p.0)
}

/// Names of the shipped waters.
pub fn shipped_water_names() -> impl Iterator<Item = &'static str> {
    WATERS.iter().map(|w| w.0)
}

/// Names of the shipped scenes.
pub(super) fn scene_names() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|s| s.0)
}

/// Name and one-line description of every shipped preset.
pub fn shipped() -> Vec<(&'static str, String)> {
    PLANETS.iter().map(describe).collect()
}

/// Name and one-line description of every shipped water.
pub fn shipped_waters() -> Vec<(&'static str, String)> {
    WATERS.iter().map(describe).collect()
}

/// Name and one-line description of every shipped scene.
pub fn shipped_scenes() -> Vec<(&'static str, String)> {
    SCENES.iter().map(describe).collect()
}

/// File name (as in the source tree) and JSON text of a shipped scene.
pub(super) fn scene(name: &str) -> Option<(String, &'static str)> {
    let (_, text) = SCENES.iter().find(|s| s.0 == name)?;
    Some((format!("presets/scenes/{name}.json"), text))
}

fn describe((name, text): &(&'static str, &str)) -> (&'static str, String) {
    let value: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
    (*name, value["description"].as_str().unwrap_or_default().to_string())
}

/// File name (as in the source tree) and JSON text of a shipped water.
pub(super) fn water(name: &str) -> Option<(String, &'static str)> {
    let (_, text) = WATERS.iter().find(|w| w.0 == name)?;
    Some((format!("presets/waters/{name}.json"), text))
}

/// File name (as in the source tree) and JSON text of a shipped preset.
pub(super) fn planet(name: &str) -> Option<(String, &'static str)> {
    let (_, text) = PLANETS.iter().find(|p| p.0 == name)?;
    Some((format!("presets/planets/{name}.json"), text))
}

/// Names of the shipped spectra.
pub(super) fn spectrum_names() -> impl Iterator<Item = &'static str> {
    SPECTRA.iter().map(|s| s.0)
}

/// Names of the shipped spectra of a quantity: those whose header says so.
pub(super) fn spectra_of(quantity: &str) -> Vec<&'static str> {
    let header = format!("wavelength_nm,{quantity}");
    SPECTRA.iter().filter(|s| s.1.lines().any(|line| line.trim() == header)).map(|s| s.0).collect()
}

/// A shipped spectrum by name, or a CSV file by a name that ends in `.csv`, beside the preset or else from the
/// current folder. The file has a
/// line `# source: …`, then a header `wavelength_nm,<quantity>`, which must be `quantity`, then rows.
pub(super) fn spectrum(name: &str, quantity: &str, beside: &str) -> Result<Option<Spectrum>> {
    if let Some((_, text)) = SPECTRA.iter().find(|s| s.0 == name) {
        return parse(&format!("presets/spectra/{name}.csv"), text, quantity).map(Some);
    }
    let Some(path) = spectrum_path(name, beside) else { return Ok(None) };
    let text = bounded_read::named_text(&path, MOST_CSV)?;
    parse(&path.display().to_string(), &text, quantity).map(Some)
}

/// Where the spectrum of a name lies on disk; none for a shipped one, or a name that is not of a CSV file.
pub(super) fn spectrum_path(name: &str, beside: &str) -> Option<PathBuf> {
    if spectrum_names().any(|shipped| shipped == name) || !name.ends_with(".csv") {
        return None;
    }
    let near = Path::new(beside).parent().unwrap_or(Path::new("")).join(name);
    Some(if near.exists() { near } else { Path::new(name).to_path_buf() })
}

/// A spectrum from the text of such a file; `file` is for messages only.
pub fn parse(file: &str, text: &str, quantity: &str) -> Result<Spectrum> {
    let has_source = |l: &str| l.strip_prefix("# source:").is_some_and(|s| !s.trim().is_empty());
    if !text.lines().any(has_source) {
        return Err(Error::file(file, "numbers without a source: a line `# source: …` is missing"));
    }
    let mut lines = text.lines().enumerate().filter(|(_, l)| !l.starts_with('#') && !l.trim().is_empty());
    let header = lines.next().map_or("", |(_, l)| l.trim());
    let expected = format!("wavelength_nm,{quantity}");
    if header != expected {
        return Err(Error::file(file, format!("header is `{header}` but `{expected}` is needed")));
    }
    let (mut wavelengths, mut values) = (Vec::new(), Vec::new());
    for (number, line) in lines {
        let row: Option<Vec<f64>> = line.split(',').map(|t| t.trim().parse().ok()).collect();
        let Some(&[wavelength, value]) = row.as_deref() else {
            return Err(Error::file(file, format!("line {}: `{line}` is not two numbers", number + 1)));
        };
        wavelengths.push(wavelength);
        values.push(value);
    }
    Spectrum::new(wavelengths, values).map_err(|e| Error::file(file, e))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every file under presets/ is inside the binary, or it would be missing from an installed tool.
    #[test]
    fn every_file_is_shipped() {
        let names = |folder: &str| {
            let entries =
                std::fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("presets").join(folder));
            let stem = |e: std::io::Result<std::fs::DirEntry>| {
                e.unwrap().path().file_stem().unwrap().to_string_lossy().into_owned()
            };
            let mut list: Vec<String> = entries.unwrap().map(stem).collect();
            list.sort();
            list
        };
        let mut planets: Vec<&str> = shipped_names().collect();
        planets.sort_unstable();
        assert_eq!(names("planets"), planets);
        let mut waters: Vec<&str> = shipped_water_names().collect();
        waters.sort_unstable();
        assert_eq!(names("waters"), waters);
        let mut spectra: Vec<&str> = spectrum_names().chain(["cie1931-2deg", "cie1964-10deg"]).collect();
        spectra.sort_unstable();
        assert_eq!(names("spectra"), spectra);
    }

    /// A table without a source, with another quantity or with a broken row is refused and says where.
    #[test]
    fn bad_tables_are_refused() {
        let quantity = "cross_section_m2";
        let good = "# source: me 2020\nwavelength_nm,cross_section_m2\n400,1e-28\n500,2e-28\n";
        assert_eq!(parse("a.csv", good, quantity).unwrap().at(450.0), 1.5e-28);
        let refuse = |text: &str| parse("a.csv", text, quantity).unwrap_err().to_string();
        assert!(refuse(&good.replace("# source: me 2020", "# source:")).contains("without a source"));
        assert!(refuse(&good.replace("cross_section_m2", "irradiance")).contains("header"));
        assert!(refuse(&good.replace("2e-28", "x")).contains("line 4"));
        assert!(refuse(&good.replace("2e-28", "x,2e-28")).contains("line 4"));
        assert!(refuse(&good.replace("500", "300")).contains("must rise"));
    }
}
