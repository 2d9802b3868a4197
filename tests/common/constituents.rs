//! Constituents of test planets in few words.

use tyndall::internals::medium::{Constituent, DensityProfile, PhaseFunction, Role};

pub const RAYLEIGH: PhaseFunction = PhaseFunction::Rayleigh { king_factor: 1.0 };

/// A constituent at `scattering.len()` wavelengths.
pub fn constituent(
    role: Role,
    phase: PhaseFunction,
    density: DensityProfile,
    scattering: &[f64],
    absorption: &[f64],
) -> Constituent {
    Constituent {
        name: format!("{role:?}"),
        role,
        density,
        scattering: scattering.to_vec(),
        absorption: absorption.to_vec(),
        similarity_g: vec![phase.mean_cosine(); scattering.len()],
        phase: vec![phase; scattering.len()],
    }
}

pub fn exponential(scale_height: f64) -> DensityProfile {
    DensityProfile::Exponential { scale_height }
}
