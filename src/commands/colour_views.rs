//! Views as `tyndall sample` and `reference` answer them, as spectra for `tyndall colour`: a row a view and wavelength,
//! radiance over the star's irradiance.

use super::colour_input::{Named, number, one_spectrum};
use super::text::say;
use crate::error::{Error, Result};
use crate::files::points::COLUMNS;
use crate::preset::read_spectrum;
use crate::spectrum::{Observer, Spectrum, at_nanometres};
use std::f64::consts::PI;
use std::path::{Path, PathBuf};

/// Column of the values.
const RADIANCE: &str = "radiance_per_sr";

/// What makes radiance of the values of views.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Illuminant {
    /// Sunlight at 1 au, as the shipped presets have it.
    Sun,
    /// 1 W/(m² nm) at every wavelength.
    EqualEnergy,
    /// The values are radiance already.
    None,
    /// A CSV file of spectral irradiance.
    File(PathBuf),
}

/// `sun`, `e`, `none`, or the path of a CSV file.
pub fn illuminant(text: &str) -> Result<Illuminant> {
    match text {
        "sun" => Ok(Illuminant::Sun),
        "e" => Ok(Illuminant::EqualEnergy),
        "none" => Ok(Illuminant::None),
        path if path.ends_with(".csv") => Ok(Illuminant::File(path.into())),
        _ => Err("expected sun, e, none, or the path of a .csv file".into()),
    }
}

/// The light that the values of views are over, at whole nanometres.
pub struct Light {
    pub irradiance: Vec<f64>,
    /// As it is told.
    pub name: String,
}

impl Light {
    /// The light of what was read; none for spectra that are no views, and for views of radiance.
    ///
    /// # Errors
    /// `Argument` for a light given to spectra, `File` for a file that holds no spectrum, or more than one.
    pub fn of(are_views: bool, given: Option<&Illuminant>) -> Result<Option<Light>> {
        match (are_views, given) {
            (true, given) => Light::new(given.unwrap_or(&Illuminant::Sun)),
            (false, None) => Ok(None),
            (false, Some(_)) => {
                let reason = "--illuminant: is of views, which have the columns of `tyndall sample`";
                Err(Error::Argument(reason.into()))
            }
        }
    }

    fn new(illuminant: &Illuminant) -> Result<Option<Light>> {
        let (spectrum, name) = match illuminant {
            Illuminant::None => return Ok(None),
            Illuminant::EqualEnergy => (Spectrum::constant(1.0), "equal energy, 1 W/(m² nm)".to_string()),
            Illuminant::Sun => {
                let file = "presets/spectra/sun-tsis1-hsrs.csv";
                let text = include_str!("../../presets/spectra/sun-tsis1-hsrs.csv");
                (
                    read_spectrum(file, text, "irradiance_w_m2_nm")?,
                    "sunlight at 1 au (TSIS-1 HSRS)".to_string(),
                )
            }
            Illuminant::File(path) => (one_spectrum(path)?, path.display().to_string()),
        };
        let irradiance = at_nanometres(&spectrum);
        if !irradiance.iter().all(|&v| v >= 0.0) || irradiance.iter().sum::<f64>() <= 0.0 {
            return Err(Error::Argument(format!("--illuminant {name}: no light, or less than none")));
        }
        Ok(Some(Light { irradiance, name }))
    }

    /// What makes Y = 100 of a white surface that this light meets squarely: its radiance is 1/π of the irradiance.
    pub fn k(&self, observer: &Observer) -> f64 {
        100.0 * PI / observer.xyz(|w| self.irradiance[w as usize - crate::spectrum::OBSERVER_RANGE.0])[1]
    }
}

/// Says what the values of views are taken for, and how many wavelengths stand behind their colours.
pub fn tell_of_views(views: &[Named], light: Option<&Light>) {
    let taken = match light {
        Some(light) => format!("radiance_per_sr times {}; --illuminant takes another light", light.name),
        None => "radiance_per_sr taken for radiance, W/(m² sr nm)".into(),
    };
    say(&format!("note: {taken}"));
    let nm: Vec<f64> = views[0].spectrum.nodes().map(|n| n.0).collect();
    let (first, last) = (nm[0], nm[nm.len() - 1]);
    say(&format!(
        "note: {} wavelengths, {first}–{last} nm: straight lines between, end values held",
        nm.len()
    ));
}

/// Whether a table is one of views.
pub fn are_views(header: &csv::StringRecord) -> bool {
    COLUMNS.iter().chain(&[RADIANCE]).all(|name| header.iter().any(|h| h == *name))
}

/// A spectrum for each view: rows of the same four columns whose wavelengths rise. Columns besides are left unread.
///
/// # Errors
/// `File` or `Value` with file, line and column.
pub fn views(file: &Path, mut reader: csv::Reader<&[u8]>) -> Result<Vec<Named>> {
    let header = reader.headers().map_err(|e| Error::file(file, e))?.clone();
    let place = |name: &str| header.iter().position(|h| h == name).unwrap_or(usize::MAX);
    let (wavelength, radiance) = (place("wavelength_nm"), place(RADIANCE));
    let keys = COLUMNS.map(place);
    let mut all: Vec<View> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|e| Error::file(file, e))?;
        let line = record.position().map_or(0, |p| p.line());
        let value = |k: usize| number(file, line, header.get(k).unwrap_or(""), record.get(k).unwrap_or(""));
        let (nm, light) = (value(wavelength)?, value(radiance)?);
        let key = keys.map(|k| record.get(k).unwrap_or("").to_string());
        let goes_on = |view: &&mut View| view.key == key && view.nm.last().is_some_and(|&last| last < nm);
        match all.last_mut().filter(goes_on) {
            Some(view) => {
                view.nm.push(nm);
                view.light.push(light);
            }
            None => all.push(View { key, nm: vec![nm], light: vec![light] }),
        }
    }
    if all.is_empty() {
        return Err(Error::file(file, "no views"));
    }
    all.into_iter().map(|view| view.named(file)).collect()
}

/// A view as its four columns say it, and what was read of it.
struct View {
    key: [String; 4],
    nm: Vec<f64>,
    light: Vec<f64>,
}

impl View {
    fn named(self, file: &Path) -> Result<Named> {
        let pairs: Vec<String> = COLUMNS.iter().zip(&self.key).map(|(c, v)| format!("{c}={v}")).collect();
        let spectrum = Spectrum::new(self.nm, self.light).map_err(|e| Error::file(file, e))?;
        Ok(Named { name: pairs.join(" "), spectrum })
    }
}

#[cfg(test)]
mod tests {
    use super::super::colour_input::parse;
    use super::*;

    /// Rows belong together while the view is the same and wavelengths rise: a view asked for twice is two.
    #[test]
    fn rows_become_spectra() {
        let text = "altitude_m,mu_view,mu_sun,azimuth_deg,wavelength_nm,radiance_per_sr,stderr_per_sr\n\
                    2,1,0.5,0,440,0.1,\n2,1,0.5,0,550,0.2,\n2,1,0.5,0,440,0.3,1e-3\n2,0.5,0.5,0,440,0.4,\n";
        let input = parse(Path::new("v.csv"), text).unwrap();
        assert!(input.are_views);
        let counts: Vec<usize> = input.spectra.iter().map(|s| s.spectrum.nodes().count()).collect();
        assert_eq!(counts, [2, 1, 1]);
        assert_eq!(input.spectra[0].name, "altitude_m=2 mu_view=1 mu_sun=0.5 azimuth_deg=0");
        assert_eq!(input.spectra[0].spectrum.at(495.0), 0.15000000000000002);
    }

    /// A white surface under any light has Y = 100.
    #[test]
    fn white_is_one_hundred() {
        for illuminant in [Illuminant::Sun, Illuminant::EqualEnergy] {
            let light = Light::new(&illuminant).unwrap().unwrap();
            let observer = Observer::cie1931();
            let y = observer.xyz(|w| light.irradiance[w as usize - 360] / PI)[1] * light.k(observer);
            assert!((y - 100.0).abs() < 1e-10, "{y}");
        }
    }
}
