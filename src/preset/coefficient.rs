//! Scattering, absorption and extinction coefficients as formulas of the wavelength.

use super::rayleigh::air_cross_section;
use crate::spectrum::Spectrum;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// A coefficient where the constituent's density is 1, in SI. Formulas stay formulas, so that any wavelength
/// is exact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Coefficient {
    /// Values in 1/m.
    Table { spectrum_per_m: Spectrum },
    /// per_m · (wavelength / at_nm)^(−angstrom_exponent) (Ångström 1929).
    PowerLaw { per_m: f64, at_nm: f64, angstrom_exponent: f64 },
    /// 8π³(n²−1)²N / (3N_e²λ⁴) · King factor: Elek & Kmoch Eqs. 1–2 (where the King factor is 1), with N the
    /// number density here and N_e the one at which the refractive index n holds.
    RefractiveIndex {
        refractive_index: Spectrum,
        king_factor: Spectrum,
        number_density_per_m3: f64,
        reference_number_density_per_m3: f64,
    },
    /// Dry air: [`air_cross_section`] times number density.
    Bodhaine1999 { number_density_per_m3: f64, co2_ppm: f64 },
    /// Cross-section of a particle (m²) times number density.
    CrossSection { cross_section_m2: Spectrum, number_density_per_m3: f64 },
}

impl Coefficient {
    /// The coefficient of what is not there.
    pub fn zero() -> Self {
        Coefficient::Table { spectrum_per_m: Spectrum::constant(0.0) }
    }

    /// Coefficient at a wavelength (nm), 1/m.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            Coefficient::Table { spectrum_per_m } => spectrum_per_m.at(wavelength_nm),
            Coefficient::PowerLaw { per_m, at_nm, angstrom_exponent } => {
                per_m * libm::pow(wavelength_nm / at_nm, -angstrom_exponent)
            }
            Coefficient::RefractiveIndex {
                refractive_index,
                king_factor,
                number_density_per_m3,
                reference_number_density_per_m3,
            } => {
                let n = refractive_index.at(wavelength_nm);
                let above = (n * n - 1.0) / reference_number_density_per_m3;
                let wavelength = wavelength_nm * 1e-9;
                let ratio = above / (wavelength * wavelength);
                8.0 * PI * PI * PI / 3.0
                    * ratio
                    * ratio
                    * number_density_per_m3
                    * king_factor.at(wavelength_nm)
            }
            Coefficient::Bodhaine1999 { number_density_per_m3, co2_ppm } => {
                number_density_per_m3 * air_cross_section(wavelength_nm, *co2_ppm)
            }
            Coefficient::CrossSection { cross_section_m2, number_density_per_m3 } => {
                number_density_per_m3 * cross_section_m2.at(wavelength_nm)
            }
        }
    }

    /// Tables in the formula, whose end values may have to be held.
    pub fn spectra(&self) -> Vec<&Spectrum> {
        match self {
            Coefficient::Table { spectrum_per_m } => vec![spectrum_per_m],
            Coefficient::RefractiveIndex { refractive_index, king_factor, .. } => {
                vec![refractive_index, king_factor]
            }
            Coefficient::CrossSection { cross_section_m2, .. } => vec![cross_section_m2],
            Coefficient::PowerLaw { .. } | Coefficient::Bodhaine1999 { .. } => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: f64, b: f64, relative: f64) {
        assert!((a / b - 1.0).abs() < relative, "{a} {b}");
    }

    /// Halving the wavelength doubles a coefficient of Ångström exponent 1 and multiplies by 16 one of 4.
    #[test]
    fn power_laws() {
        for (exponent, factor) in [(0.0, 1.0), (1.0, 2.0), (4.0, 16.0)] {
            let c = Coefficient::PowerLaw { per_m: 3e-6, at_nm: 800.0, angstrom_exponent: exponent };
            close(c.at(400.0), 3e-6 * factor, 1e-14);
        }
    }

    /// The classic numbers n = 1.0003, N = 2.55e25 give 1.276e-5 1/m at 550 nm and fall as λ⁻⁴; twice the
    /// molecules of the same kind scatter twice as much (the paper's reason for Eqs. 1–2).
    #[test]
    fn refractive_index_and_number_density() {
        let with = |here: f64| Coefficient::RefractiveIndex {
            refractive_index: Spectrum::constant(1.0003),
            king_factor: Spectrum::constant(1.0),
            number_density_per_m3: here,
            reference_number_density_per_m3: 2.55e25,
        };
        close(with(2.55e25).at(550.0), 1.276e-5, 1e-4);
        close(with(2.55e25).at(400.0) / with(2.55e25).at(800.0), 16.0, 1e-14);
        close(with(5.10e25).at(550.0) / with(2.55e25).at(550.0), 2.0, 1e-14);
    }
}
