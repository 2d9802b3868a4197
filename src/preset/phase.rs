//! Phase functions against wavelength.

use super::rayleigh::air_king_factor;
use crate::error::Result;
use crate::medium::PhaseFunction;
use crate::spectrum::Spectrum;
use serde::{Deserialize, Serialize};

/// Angles of a tabulated phase function at most: one every hundredth of a degree, and some.
pub(super) const MOST_ANGLES: usize = 20_000;

/// Which asymmetry a preset states for a Cornette–Shanks function, whose parameter is not its mean cosine.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AsymmetryParameter {
    G,
    MeanCosine,
}

/// King factor against wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum KingFactor {
    Table {
        spectrum: Spectrum,
    },
    /// [`air_king_factor`].
    Bodhaine1999 {
        co2_ppm: f64,
    },
}

/// A phase function at every wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum PhaseLaw {
    Isotropic,
    Rayleigh {
        king_factor: KingFactor,
    },
    /// The mean cosine is g.
    HenyeyGreenstein {
        g: Spectrum,
    },
    CornetteShanks {
        stated: AsymmetryParameter,
        asymmetry: Spectrum,
    },
    DoubleHenyeyGreenstein {
        g1: Spectrum,
        g2: Spectrum,
        weight: Spectrum,
    },
    /// A row of relative values over `cosines` (from −1 to 1) for each wavelength, each normalised to 1 over
    /// the sphere; linear between wavelengths, the end rows held.
    Tabulated {
        cosines: Vec<f64>,
        wavelengths_nm: Vec<f64>,
        rows: Vec<Vec<f64>>,
    },
}

impl PhaseLaw {
    /// The phase function at a wavelength (nm).
    pub fn at(&self, wavelength_nm: f64) -> PhaseFunction {
        match self {
            PhaseLaw::Isotropic => PhaseFunction::Isotropic,
            PhaseLaw::Rayleigh { king_factor } => {
                let king_factor = match king_factor {
                    KingFactor::Table { spectrum } => spectrum.at(wavelength_nm),
                    KingFactor::Bodhaine1999 { co2_ppm } => air_king_factor(wavelength_nm, *co2_ppm),
                };
                PhaseFunction::Rayleigh { king_factor }
            }
            PhaseLaw::HenyeyGreenstein { g } => PhaseFunction::HenyeyGreenstein { g: g.at(wavelength_nm) },
            PhaseLaw::CornetteShanks { stated, asymmetry } => {
                let value = asymmetry.at(wavelength_nm);
                match stated {
                    AsymmetryParameter::G => PhaseFunction::CornetteShanks { g: value },
                    AsymmetryParameter::MeanCosine => PhaseFunction::cornette_shanks_of_mean_cosine(value),
                }
            }
            PhaseLaw::DoubleHenyeyGreenstein { g1, g2, weight } => PhaseFunction::DoubleHenyeyGreenstein {
                g1: g1.at(wavelength_nm),
                g2: g2.at(wavelength_nm),
                weight: weight.at(wavelength_nm),
            },
            PhaseLaw::Tabulated { cosines, wavelengths_nm, rows } => {
                let values = blend(wavelengths_nm, rows, wavelength_nm);
                PhaseFunction::tabulated(cosines.iter().copied().zip(values).collect())
            }
        }
    }

    /// The g of the similarity rule (Elek & Kmoch Eq. 16) at a wavelength (nm): the parameter or the mean
    /// cosine, whichever the preset states; the mean cosine of the other functions.
    pub fn similarity_g(&self, wavelength_nm: f64) -> f64 {
        match self {
            PhaseLaw::HenyeyGreenstein { g: asymmetry } | PhaseLaw::CornetteShanks { asymmetry, .. } => {
                asymmetry.at(wavelength_nm)
            }
            other => other.at(wavelength_nm).mean_cosine(),
        }
    }

    /// Whether a table is one: a row for each wavelength, a value for each cosine, both rising.
    pub fn check(&self) -> Result<()> {
        let PhaseLaw::Tabulated { cosines, wavelengths_nm, rows } = self else { return Ok(()) };
        if cosines.len() > MOST_ANGLES {
            return Err(format!("{} cosines: {MOST_ANGLES} are the most", cosines.len()).into());
        }
        let rising = |list: &[f64]| list.windows(2).all(|p| p[0] < p[1]);
        if cosines.len() < 2 || cosines[0] != -1.0 || cosines[cosines.len() - 1] != 1.0 || !rising(cosines) {
            return Err("cosines must rise from -1 to 1".into());
        }
        if rows.is_empty() || rows.len() != wavelengths_nm.len() || !rising(wavelengths_nm) {
            return Err("wavelengths_nm must rise, with a row for each".into());
        }
        match rows.iter().position(|row| row.len() != cosines.len()) {
            Some(k) => {
                Err(format!("row {k} has {} values for {} cosines", rows[k].len(), cosines.len()).into())
            }
            None => Ok(()),
        }
    }

    /// Tables in the law, with their key, whose end values may have to be held.
    pub fn spectra(&self) -> Vec<&Spectrum> {
        match self {
            PhaseLaw::Rayleigh { king_factor: KingFactor::Table { spectrum } } => vec![spectrum],
            PhaseLaw::HenyeyGreenstein { g } => vec![g],
            PhaseLaw::CornetteShanks { asymmetry, .. } => vec![asymmetry],
            PhaseLaw::DoubleHenyeyGreenstein { g1, g2, weight } => vec![g1, g2, weight],
            _ => Vec::new(),
        }
    }
}

fn blend(wavelengths_nm: &[f64], rows: &[Vec<f64>], wavelength_nm: f64) -> Vec<f64> {
    let after = wavelengths_nm.partition_point(|&w| w <= wavelength_nm);
    if after == 0 || after == rows.len() {
        return rows[after.max(1) - 1].clone();
    }
    let (w0, w1) = (wavelengths_nm[after - 1], wavelengths_nm[after]);
    let t = (wavelength_nm - w0) / (w1 - w0);
    rows[after - 1].iter().zip(&rows[after]).map(|(a, b)| a + (b - a) * t).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the preset states is what the similarity rule gets; the function follows by its own definition:
    /// g = 0.76 has the mean cosine 0.80982, and a mean cosine of 0.80982 belongs to g = 0.76.
    #[test]
    fn stated_asymmetry_is_kept() {
        let law = |stated, v| PhaseLaw::CornetteShanks { stated, asymmetry: Spectrum::constant(v) };
        let (by_g, by_mean) =
            (law(AsymmetryParameter::G, 0.76), law(AsymmetryParameter::MeanCosine, 0.809_818_4));
        assert_eq!(by_g.similarity_g(500.0), 0.76);
        assert_eq!(by_mean.similarity_g(500.0), 0.809_818_4);
        assert!((by_g.at(500.0).mean_cosine() - 0.809_82).abs() < 1e-5);
        assert!((by_mean.at(500.0).value(1.0) / by_g.at(500.0).value(1.0) - 1.0).abs() < 1e-4);
    }

    /// Halfway between a forward and a backward table lies their mean, which has no mean cosine.
    #[test]
    fn tabulated_rows_are_blended() {
        let law = PhaseLaw::Tabulated {
            cosines: vec![-1.0, 1.0],
            wavelengths_nm: vec![400.0, 600.0],
            rows: vec![vec![0.0, 1.0], vec![1.0, 0.0]],
        };
        assert!(law.similarity_g(500.0).abs() < 1e-9);
        assert!((law.similarity_g(300.0) - 1.0 / 3.0).abs() < 1e-4);
        assert!((law.similarity_g(700.0) + 1.0 / 3.0).abs() < 1e-4);
    }
}
