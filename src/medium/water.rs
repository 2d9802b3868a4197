//! What a body of water is made of, at the wavelengths of a run. Shared by the slab solver and its Monte Carlo.

use super::PhaseFunction;

/// Something that scatters in the water: the molecules themselves, plankton, sediment.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterScatterer {
    pub name: String,
    /// Scattering coefficient, per wavelength, 1/m.
    pub scattering: Vec<f64>,
    /// Phase function, per wavelength.
    pub phase: Vec<PhaseFunction>,
}

/// A homogeneous body of water over a Lambertian bed, at a list of wavelengths.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterMedium {
    pub wavelengths_nm: Vec<f64>,
    /// Refractive index against air, per wavelength.
    pub refractive_index: Vec<f64>,
    /// Absorption coefficient of everything together, per wavelength, 1/m.
    pub absorption: Vec<f64>,
    pub scatterers: Vec<WaterScatterer>,
    /// Albedo of the bed, per wavelength.
    pub seabed_albedo: Vec<f64>,
}

impl WaterMedium {
    /// Scattering coefficient of everything together, 1/m.
    pub fn scattering(&self, w: usize) -> f64 {
        self.scatterers.iter().map(|s| s.scattering[w]).sum()
    }

    /// Extinction coefficient at wavelength number `w`, 1/m.
    pub fn extinction(&self, w: usize) -> f64 {
        self.absorption[w] + self.scattering(w)
    }

    /// Phase function of everything together at the cosine of the scattering angle, 1/sr; isotropic where
    /// nothing scatters.
    pub fn phase(&self, w: usize, nu: f64) -> f64 {
        let total = self.scattering(w);
        if total <= 0.0 {
            return PhaseFunction::Isotropic.value(nu);
        }
        self.scatterers.iter().map(|s| s.scattering[w] / total * s.phase[w].value(nu)).sum()
    }

    /// Legendre coefficients χ_0 … χ_degree of everything together.
    pub fn legendre(&self, w: usize, degree: usize) -> Vec<f64> {
        let total = self.scattering(w);
        let mut chi = vec![0.0; degree + 1];
        chi[0] = 1.0;
        if total <= 0.0 {
            return chi;
        }
        chi[0] = 0.0;
        for s in self.scatterers.iter().filter(|s| s.scattering[w] > 0.0) {
            let share = s.scattering[w] / total;
            for (c, v) in chi.iter_mut().zip(s.phase[w].legendre(degree)) {
                *c += share * v;
            }
        }
        chi
    }
}
