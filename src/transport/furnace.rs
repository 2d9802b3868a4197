//! White furnace: the operator under light from all of space instead of the sun.

use super::azimuth::{Pairs, SunAxis, midpoint_azimuths};
use super::column::Shells;
use super::krylov::converge;
use super::levels::{LevelCounts, Levels};
use super::moments::Basis;
use super::operator::{Geometry, Operator};
use super::optics::Optics;
use super::rays::Attenuation;
use super::state::State;
use super::sunlight::{SunColumns, Sunlight};
use crate::machine::lanes::Lanes;
use crate::math::quadrature::gauss_legendre;
use crate::medium::{Constituent, DensityProfile, Medium, PhaseFunction, Role};
use std::f64::consts::PI;

/// Air and dust that only scatter, over ground of albedo 1.
fn lossless(height: f64, gas: f64, dust: f64) -> Medium {
    let constituent = |role, phase, scale_height, scattering| Constituent {
        name: "x".into(),
        role,
        density: DensityProfile::Exponential { scale_height },
        scattering: vec![scattering],
        absorption: vec![0.0],
        similarity_g: vec![0.0],
        phase: vec![phase],
    };
    Medium {
        ground_radius: 1_000e3,
        top_radius: 1_000e3 + height,
        wavelengths_nm: vec![550.0],
        ground_albedo: vec![1.0],
        constituents: vec![
            constituent(Role::Gas, PhaseFunction::Rayleigh { king_factor: 1.0 }, 9e3, gas),
            constituent(Role::Aerosol, PhaseFunction::HenyeyGreenstein { g: 0.6 }, 3e3, dust),
        ],
    }
}

/// Moments of radiance 1 from space that nothing has scattered yet: 1 − (1 − e^−τ) along rays that meet space.
fn from_space(operator: &Operator, azimuths: usize) -> State {
    let geometry = operator.geometry;
    let pairs = Pairs::new(&geometry.axis.mu_s, &midpoint_azimuths(azimuths));
    let mut state = operator.gather(&pairs, |level, j, (): &mut (), out| {
        let (d, path) = &geometry.gathers[level].directions[j];
        if !d.hits_ground {
            out.fill(Attenuation::new(path, &operator.optics.extinction).transmittance);
        }
    });
    // The sun's light never comes down diffusely at the top, so no directions above the horizontal are kept there.
    let top = (state.moments.len() / state.terms - state.suns) * state.terms;
    for (mu, weight) in gauss_legendre(8) {
        let polynomials = operator.basis.polynomials(mu);
        for node in state.moments[top..].chunks_exact_mut(state.terms) {
            for (t, moment) in node.iter_mut().enumerate().filter(|(t, _)| operator.basis.orders[*t] == 0) {
                *moment += Lanes::splat((2.0 * PI * weight * polynomials[t]) as f32);
            }
        }
    }
    state
}

/// Largest deviations from the furnace's answer: of M0 / 4π, of the other moments, of ground irradiance / π.
fn deviations(medium: &Medium, refinement: usize) -> [f64; 3] {
    const AZIMUTHS: usize = 5;
    let levels = Levels::new(medium, LevelCounts { coarse: 16, refinement, cuts: 2 });
    let shells = Shells::new(medium, &levels);
    let columns = SunColumns::new(&shells, &levels, 16, &[]);
    // The axis reaches to the nadir: this light does not end with the sun's.
    let axis = SunAxis::new(12, -1.0);
    let basis = Basis::new(&[0, 1, 2, 3, 4]);
    let geometry = Geometry::new(levels, shells, axis, 12, basis.len());
    let optics = Optics::new(medium, 4, 5, None);
    let sunlight = Sunlight::new(&columns, &geometry.levels, &optics.extinction);
    let operator = Operator::new(&geometry, &optics, &sunlight, &basis, AZIMUTHS);
    let (state, _) = converge(&operator, from_space(&operator, AZIMUTHS), 1e-6);
    let mut out = [0.0f64; 3];
    for node in state.moments.chunks_exact(basis.len()) {
        out[0] = out[0].max((f64::from(node[0][0]) / (4.0 * PI) - 1.0).abs());
        for moment in &node[1..] {
            out[1] = out[1].max(f64::from(moment[0]).abs() / (4.0 * PI));
        }
    }
    for flux in &state.ground {
        out[2] = out[2].max((f64::from(flux[0]) / PI - 1.0).abs());
    }
    out
}

/// Radiance 1 from all of space on a planet that absorbs nothing is radiance 1 everywhere, in every direction: mean
/// light 4π, no moment beside it, and irradiance π of the ground, whatever the optical depth. Weights along a ray
/// sum to 1 − T and those of directions to 4π, so only single precision (6e-8 an operation, a thousand terms a moment)
/// and the last step of the iteration are left. With more levels of the field than of the state, rays take their
/// samples in bundles.
#[test]
fn white_furnace_is_white() {
    for (gas, dust, refinement) in [(1e-5, 1e-5, 1), (8e-5, 1e-4, 1), (8e-5, 1e-4, 3)] {
        let [mean, others, flux] = deviations(&lossless(80e3, gas, dust), refinement);
        assert!(mean < 1e-5 && others < 1e-5 && flux < 1e-5, "{mean:.1e} {others:.1e} {flux:.1e}");
    }
}
