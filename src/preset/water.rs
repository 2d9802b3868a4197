//! A body of water as the rest of the program sees it: validated, in SI.

use super::read_planet::check_name;
use super::{Coefficient, PhaseLaw};
use crate::error::{Error, Result};
use crate::medium::{WaterMedium, WaterScatterer};
use crate::spectrum::Spectrum;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// A coefficient of water against wavelength, 1/m.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "snake_case", deny_unknown_fields)]
pub enum WaterLaw {
    /// As in air, times a factor (a concentration).
    Plain { coefficient: Coefficient, factor: f64 },
    /// per_m · exp(−slope (λ − at)): dissolved matter and detritus.
    Exponential { per_m: f64, at_nm: f64, slope_per_nm: f64 },
}

impl WaterLaw {
    /// The coefficient of what does not absorb, or not scatter.
    pub fn zero() -> Self {
        WaterLaw::Plain { coefficient: Coefficient::zero(), factor: 1.0 }
    }

    /// Coefficient at a wavelength (nm), 1/m.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        match self {
            WaterLaw::Plain { coefficient, factor } => coefficient.at(wavelength_nm) * factor,
            WaterLaw::Exponential { per_m, at_nm, slope_per_nm } => {
                per_m * libm::exp(-slope_per_nm * (wavelength_nm - at_nm))
            }
        }
    }
}

/// Something in the water, or the water itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WaterSubstance {
    pub name: String,
    pub scattering: WaterLaw,
    pub absorption: WaterLaw,
    pub phase: PhaseLaw,
}

/// A type of water over its bed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Lower-case letters, digits and dashes: also the name of its tables.
    pub name: String,
    pub description: String,
    /// Against air.
    pub refractive_index: Spectrum,
    /// Depth at which tables end, m.
    #[serde(rename = "largest_depth_m")]
    pub largest_depth: f64,
    /// The water itself, then what is in it.
    pub substances: Vec<WaterSubstance>,
    /// Albedo of the Lambertian bed.
    pub seabed_albedo: Spectrum,
    pub warnings: Vec<String>,
}

impl Water {
    /// The water at a list of wavelengths (nm): point samples, formulas evaluated there.
    pub fn medium(&self, wavelengths_nm: &[f64]) -> WaterMedium {
        let all = |f: &dyn Fn(f64) -> f64| wavelengths_nm.iter().map(|&w| f(w)).collect::<Vec<f64>>();
        let scatterer = |s: &WaterSubstance| WaterScatterer {
            name: s.name.clone(),
            scattering: all(&|w| s.scattering.at(w)),
            phase: wavelengths_nm.iter().map(|&w| s.phase.at(w)).collect(),
        };
        WaterMedium {
            wavelengths_nm: wavelengths_nm.to_vec(),
            refractive_index: self.refractive_index.at_all(wavelengths_nm),
            absorption: all(&|w| self.substances.iter().map(|s| s.absorption.at(w)).sum()),
            scatterers: self.substances.iter().map(scatterer).collect(),
            seabed_albedo: self.seabed_albedo.at_all(wavelengths_nm),
        }
    }

    /// Everything about the water in SI, keys in a fixed order; [`Water::from_resolved`] takes it back.
    pub fn resolved(&self) -> Value {
        serde_json::to_value(self).expect("strings as keys and finite numbers only")
    }

    /// The water that [`Water::resolved`] wrote. Refuses what is not one.
    pub fn from_resolved(value: &Value) -> Result<Water> {
        let refuse = |reason: Error| Error::Argument(format!("resolved water: {reason}"));
        let water = Water::deserialize(value).map_err(|e| refuse(e.to_string().into()))?;
        check_name(&water.name).map_err(|reason| refuse(format!("name: {reason}").into()))?;
        for s in &water.substances {
            s.phase
                .check()
                .map_err(|reason| refuse(format!("substances.{}.phase: {reason}", s.name).into()))?;
        }
        water.check().map_err(refuse)?;
        Ok(water)
    }

    /// Hash of the resolved water (BLAKE3, hexadecimal).
    pub fn hash(&self) -> String {
        blake3::hash(self.resolved().to_string().as_bytes()).to_hex().to_string()
    }

    /// Whether its numbers together make a water that can be solved.
    pub fn check(&self) -> Result<()> {
        let medium = self.medium(&crate::spectrum::grid(9));
        if !(self.largest_depth > 0.0 && self.largest_depth <= MOST_DEPTH) {
            return Err(format!(
                "largest depth {} m: must be over 0 and at most {MOST_DEPTH}",
                self.largest_depth
            )
            .into());
        }
        if medium.refractive_index.iter().any(|n| !(1.0..=2.5).contains(n)) {
            return Err("its refractive index must lie between 1 and 2.5".into());
        }
        if medium.seabed_albedo.iter().any(|a| !(0.0..=1.0).contains(a)) {
            return Err("the albedo of its bed must lie between 0 and 1".into());
        }
        for w in 0..medium.wavelengths_nm.len() {
            let parts = medium.scatterers.iter().map(|s| s.scattering[w]).chain([medium.absorption[w]]);
            let mut sum = 0.0;
            for part in parts {
                if !(0.0..=MOST_EXTINCTION).contains(&part) {
                    let nm = medium.wavelengths_nm[w];
                    return Err(format!(
                        "a coefficient of {part} 1/m at {nm} nm: must be 0 to {MOST_EXTINCTION}"
                    )
                    .into());
                }
                sum += part;
            }
            if !f64::is_finite(sum) {
                return Err("its coefficients are beyond all numbers".into());
            }
        }
        Ok(())
    }
}

/// Deepest water that tables may reach, m: the deepest sea.
const MOST_DEPTH: f64 = 11_000.0;
/// Largest coefficient, 1/m: far more than the thickest mud.
const MOST_EXTINCTION: f64 = 1e5;
