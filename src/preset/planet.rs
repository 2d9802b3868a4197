//! A planet as the rest of the program sees it: validated, in SI.

use super::read_planet::check_name;
use super::{Coefficient, PhaseLaw};
use crate::error::{Error, Result};
use crate::medium::{Constituent, DensityProfile, Medium, Role, check_shell};
use crate::spectrum::{Spectrum, grid};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The star of a planet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Star {
    /// Spectral irradiance at the planet on a plane normal to the beam, W/(m² nm).
    #[serde(rename = "irradiance_w_m2_nm")]
    pub irradiance: Spectrum,
    /// Angular radius of the disc seen from the planet, rad.
    #[serde(rename = "angular_radius_rad")]
    pub angular_radius: f64,
    /// Distance of the planet, m.
    #[serde(rename = "distance_m")]
    pub distance: f64,
    /// Coefficient u of the linear limb law, see [`Star::limb`].
    pub limb_darkening: f64,
}

impl Star {
    /// Radiance of the disc over its mean where the outward normal and the line of sight make an angle of
    /// cosine `mu` (1 in the middle, 0 at the limb): (1 − u(1 − μ)) / (1 − u/3), of mean 1 over the disc.
    pub fn limb(&self, mu: f64) -> f64 {
        (1.0 - self.limb_darkening * (1.0 - mu)) / (1.0 - self.limb_darkening / 3.0)
    }
}

/// How a constituent scatters and absorbs where its density is 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "stated_as", rename_all = "snake_case", deny_unknown_fields)]
pub enum Optics {
    ScatteringAndAbsorption { scattering: Coefficient, absorption: Coefficient },
    ExtinctionAndAlbedo { extinction: Coefficient, single_scattering_albedo: Spectrum },
}

impl Optics {
    /// Scattering and absorption coefficients at a wavelength (nm), 1/m.
    pub fn at(&self, wavelength_nm: f64) -> (f64, f64) {
        match self {
            Optics::ScatteringAndAbsorption { scattering, absorption } => {
                (scattering.at(wavelength_nm), absorption.at(wavelength_nm))
            }
            Optics::ExtinctionAndAlbedo { extinction, single_scattering_albedo } => {
                let extinction = extinction.at(wavelength_nm);
                let scattering = extinction * single_scattering_albedo.at(wavelength_nm);
                (scattering, extinction - scattering)
            }
        }
    }
}

/// A constituent at every wavelength.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Substance {
    pub name: String,
    pub role: Role,
    /// Multiplies all coefficients (the paper's sparser and denser atmospheres).
    pub density_factor: f64,
    /// Relative density against altitude, altitudes in m.
    pub profile: DensityProfile,
    pub optics: Optics,
    pub phase: PhaseLaw,
}

impl Substance {
    /// The constituent at a list of wavelengths (nm).
    pub fn at(&self, wavelengths_nm: &[f64]) -> Constituent {
        let [scattering, absorption] = self.coefficients(wavelengths_nm);
        Constituent {
            name: self.name.clone(),
            role: self.role,
            density: self.profile.clone(),
            scattering,
            absorption,
            phase: wavelengths_nm.iter().map(|&w| self.phase.at(w)).collect(),
            similarity_g: wavelengths_nm.iter().map(|&w| self.phase.similarity_g(w)).collect(),
        }
    }

    /// Scattering and absorption where the profile is 1, 1/m, at a list of wavelengths (nm).
    pub fn coefficients(&self, wavelengths_nm: &[f64]) -> [Vec<f64>; 2] {
        let (scattering, absorption): (Vec<f64>, Vec<f64>) =
            wavelengths_nm.iter().map(|&w| self.optics.at(w)).unzip();
        [scattering, absorption].map(|part| part.iter().map(|v| v * self.density_factor).collect())
    }
}

/// A planet: its ground, air and star.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Planet {
    /// Lower-case letters, digits and dashes: also the name of the folder of its bakes.
    pub name: String,
    pub description: String,
    /// Radius of the ground, m.
    #[serde(rename = "ground_radius_m")]
    pub ground_radius: f64,
    /// Radius of the top of the atmosphere, m.
    #[serde(rename = "top_radius_m")]
    pub top_radius: f64,
    /// Albedo of the Lambertian ground.
    pub ground_albedo: Spectrum,
    pub star: Star,
    /// In the order of the file; none is a vacuum.
    pub constituents: Vec<Substance>,
    /// What was assumed where the file says nothing, and what the top loses, one line each.
    pub warnings: Vec<String>,
}

impl Planet {
    /// Air and ground at a list of wavelengths (nm): point samples, formulas evaluated there.
    pub fn medium(&self, wavelengths_nm: &[f64]) -> Medium {
        Medium {
            ground_radius: self.ground_radius,
            top_radius: self.top_radius,
            wavelengths_nm: wavelengths_nm.to_vec(),
            ground_albedo: self.ground_albedo.at_all(wavelengths_nm),
            constituents: self.constituents.iter().map(|c| c.at(wavelengths_nm)).collect(),
        }
    }

    /// Height of the atmosphere, m.
    pub fn height(&self) -> f64 {
        self.top_radius - self.ground_radius
    }

    /// Everything about the planet in SI, keys in a fixed order; [`Planet::from_resolved`] takes it back, with
    /// every bit of every number.
    pub fn resolved(&self) -> Value {
        serde_json::to_value(self).expect("strings as keys and finite numbers only")
    }

    /// The planet that [`Planet::resolved`] wrote. Refuses what is not one.
    pub fn from_resolved(value: &Value) -> Result<Planet> {
        let refuse = |reason: Error| Error::Argument(format!("resolved preset: {reason}"));
        let planet: Planet = Planet::deserialize(value).map_err(|e| refuse(e.to_string().into()))?;
        // It becomes a folder's where the bake is recoloured.
        check_name(&planet.name).map_err(|reason| refuse(format!("name: {reason}").into()))?;
        check_shell(planet.ground_radius, planet.top_radius)
            .map_err(|reason| refuse(format!("ground_radius_m, top_radius_m: {reason}").into()))?;
        for c in &planet.constituents {
            c.phase
                .check()
                .map_err(|reason| refuse(format!("constituents.{}.phase: {reason}", c.name).into()))?;
        }
        planet.medium(&grid(9)).check().map_err(refuse)?;
        Ok(planet)
    }

    /// Hash of the resolved planet: equal for equal physics, whatever file it came from (BLAKE3, hexadecimal).
    pub fn hash(&self) -> String {
        blake3::hash(self.resolved().to_string().as_bytes()).to_hex().to_string()
    }
}
