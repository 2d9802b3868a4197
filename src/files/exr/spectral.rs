//! Names and attributes of spectral EXR files after Fichet, Pacanowski & Wilkie 2021, "An OpenEXR Layout for
//! Spectral Images", JCGT 10(3): a channel a wavelength, its name with a decimal comma.

use crate::files::atlas::Attribute;
use std::collections::BTreeMap;

/// Which quantity a spectral channel holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spectral {
    /// `S0`: emitted radiance, the first Stokes component.
    Radiance,
    /// `T`: a ratio (reflectance, transmittance).
    Ratio,
}

/// The channel name of a wavelength in nm, e.g. `S0.550,000000nm`. Three digits before the comma for 100 to
/// 999 nm, so that the alphabetical order of channels is that of wavelengths.
pub fn spectral_channel(quantity: Spectral, wavelength_nm: f64) -> String {
    let prefix = match quantity {
        Spectral::Radiance => "S0",
        Spectral::Ratio => "T",
    };
    format!("{prefix}.{}nm", format!("{wavelength_nm:.6}").replace('.', ","))
}

/// The attributes that mark a file as spectral; radiance in W/(m² sr nm) is stored as W/(m² sr) a nanometre.
pub fn spectral_attributes() -> BTreeMap<String, Attribute> {
    let text = |value: &str| Attribute::Text(value.to_string());
    BTreeMap::from([
        ("spectralLayoutVersion".to_string(), text("1.0")),
        ("emissiveUnits".to_string(), text("W.m^-2.sr^-1")),
    ])
}

/// The quantity and wavelength in nm that a spectral channel's name tells; `None` for any other name.
pub fn wavelength_of_channel(name: &str) -> Option<(Spectral, f64)> {
    let (prefix, rest) = name.split_once('.')?;
    let quantity = match prefix {
        "S0" => Spectral::Radiance,
        "T" => Spectral::Ratio,
        _ => return None,
    };
    let wavelength: f64 = rest.strip_suffix("nm")?.replace(',', ".").parse().ok()?;
    (wavelength.is_finite() && wavelength > 0.0).then_some((quantity, wavelength))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The form printed in section 3 of Fichet et al.: a comma where the number has its point.
    #[test]
    fn names_of_spectral_channels_are_those_of_the_layout() {
        assert_eq!(spectral_channel(Spectral::Radiance, 550.0), "S0.550,000000nm");
        assert_eq!(spectral_channel(Spectral::Ratio, 412.5), "T.412,500000nm");
        assert_eq!(wavelength_of_channel("S0.412,500000nm"), Some((Spectral::Radiance, 412.5)));
        assert_eq!(wavelength_of_channel("T.550,0nm"), Some((Spectral::Ratio, 550.0)));
        for other in ["R", "S0.nm", "S1.550,0nm", "S0.550,0", "T.-1,0nm"] {
            assert_eq!(wavelength_of_channel(other), None, "{other}");
        }
    }
}
