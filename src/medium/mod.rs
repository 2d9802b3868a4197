//! What the air is made of: constituents with a density profile, coefficients and a phase function, at the
//! wavelengths of a run. Shared by the solver, the Monte Carlo reference and the older methods.

mod check;
mod density;
mod losses;
mod phase;
mod sheets;
mod water;

pub use check::{MOST_NODES, check_shell};
pub use density::DensityProfile;
pub use losses::Cut;
pub use phase::PhaseFunction;
pub use sheets::Sheet;
pub use water::{WaterMedium, WaterScatterer};

/// What a constituent's scattered light counts as in tables that keep gas and aerosol apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    Gas,
    Aerosol,
}

/// One constituent of the atmosphere at the run's wavelengths.
#[derive(Clone, Debug)]
pub struct Constituent {
    pub name: String,
    pub role: Role,
    /// Relative density against altitude.
    pub density: DensityProfile,
    /// Scattering coefficient where the density is 1, per wavelength, 1/m.
    pub scattering: Vec<f64>,
    /// Absorption coefficient where the density is 1, per wavelength, 1/m.
    pub absorption: Vec<f64>,
    /// Phase function, per wavelength.
    pub phase: Vec<PhaseFunction>,
    /// The g of the similarity rule (Elek & Kmoch Eq. 16), per wavelength: what the preset states, be it the
    /// phase function's parameter or its mean cosine.
    pub similarity_g: Vec<f64>,
}

impl Constituent {
    /// Extinction coefficient where the density is 1, at wavelength number `w`, 1/m.
    pub fn extinction(&self, w: usize) -> f64 {
        self.scattering[w] + self.absorption[w]
    }

    /// True where the constituent scatters at any wavelength.
    pub fn scatters(&self) -> bool {
        self.scattering.iter().any(|&s| s > 0.0)
    }
}

/// A planet's air and ground at a list of wavelengths.
#[derive(Clone, Debug)]
pub struct Medium {
    /// Radius of the ground, m.
    pub ground_radius: f64,
    /// Radius of the top of the atmosphere, m; above it there is nothing.
    pub top_radius: f64,
    pub wavelengths_nm: Vec<f64>,
    /// Albedo of the Lambertian ground, per wavelength.
    pub ground_albedo: Vec<f64>,
    pub constituents: Vec<Constituent>,
}

impl Medium {
    /// Height of the atmosphere, m.
    pub fn height(&self) -> f64 {
        self.top_radius - self.ground_radius
    }

    /// The paper's medium: aerosols scatter isotropically with (1 − g) of their coefficient (Elek & Kmoch
    /// Eq. 16), their absorption is kept.
    pub fn similarity(&self) -> Medium {
        let mut medium = self.clone();
        for c in medium.constituents.iter_mut().filter(|c| c.role == Role::Aerosol) {
            for (w, s) in c.scattering.iter_mut().enumerate() {
                *s *= 1.0 - c.similarity_g[w];
                c.phase[w] = PhaseFunction::Isotropic;
            }
            c.similarity_g.fill(0.0);
        }
        medium
    }

    /// The same medium at some of its wavelengths, given by number.
    pub fn at_wavelengths(&self, which: &[usize]) -> Medium {
        let pick = |v: &Vec<f64>| which.iter().map(|&w| v[w]).collect::<Vec<_>>();
        let mut medium = self.clone();
        medium.wavelengths_nm = pick(&self.wavelengths_nm);
        medium.ground_albedo = pick(&self.ground_albedo);
        for (c, from) in medium.constituents.iter_mut().zip(&self.constituents) {
            c.scattering = pick(&from.scattering);
            c.absorption = pick(&from.absorption);
            c.similarity_g = pick(&from.similarity_g);
            c.phase = which.iter().map(|&w| from.phase[w].clone()).collect();
        }
        medium
    }

    /// Vertical optical depth of the whole shell, per wavelength (composite Simpson between the profile's
    /// kinks; relative error below 1e-6 for scale heights above a hundredth of a layer).
    pub fn vertical_optical_depth(&self) -> Vec<f64> {
        let mut depth = vec![0.0; self.wavelengths_nm.len()];
        for c in &self.constituents {
            let column = c.density.column(0.0, self.height());
            for (w, d) in depth.iter_mut().enumerate() {
                *d += column * c.extinction(w);
            }
        }
        depth
    }
}
