//! Phase functions that the package's shaders put on, and the g that suits a preset's aerosols best.

use super::Bruneton;
use crate::colour::weights::ColourWeights;
use crate::medium::{Medium, PhaseFunction, Role};
use std::f64::consts::PI;

/// The package's Rayleigh phase function, 1/sr.
pub(super) fn rayleigh(nu: f64) -> f64 {
    PhaseFunction::Rayleigh { king_factor: 1.0 }.value(nu)
}

/// The package's phase function of aerosols, 1/sr (Cornette & Shanks 1992).
pub(super) fn cornette_shanks(g: f64, nu: f64) -> f64 {
    PhaseFunction::CornetteShanks { g }.value(nu)
}

/// Scattering angles at which a g is judged, and steps in which it is looked for.
const ANGLES: usize = 90;
const STEP: f64 = 0.01;

/// The g for which aerosol light, divided by p_M at the nodes of ν, interpolated and multiplied again, is nearest to
/// the aerosols' mean phase function: least squares of its relative error, even over the scattering angle. 0 without
/// aerosols. Where they are of Cornette & Shanks with one g, that g (to 0.01).
pub(super) fn best_g(medium: &Medium, palette: &ColourWeights, mapping: &Bruneton) -> f64 {
    let mean = |nu: f64| mean_phase(medium, palette, nu);
    if mean(0.0) <= 0.0 {
        return 0.0;
    }
    let nodes: Vec<f64> = (0..mapping.size()[3]).map(|l| mapping.nu(l)).collect();
    let stored: Vec<f64> = nodes.iter().map(|&nu| mean(nu)).collect();
    let wanted: Vec<(f64, f64)> = (0..ANGLES)
        .map(|k| libm::cos((k as f64 + 0.5) * PI / ANGLES as f64))
        .map(|nu| (nu, mean(nu)))
        .collect();
    let error = |g: f64| -> f64 {
        let ratio: Vec<f64> = nodes.iter().zip(&stored).map(|(&nu, p)| p / cornette_shanks(g, nu)).collect();
        let relative = |&(nu, p): &(f64, f64)| {
            let (low, fraction) = crate::mapping::texel(0.5 * (1.0 + nu), nodes.len());
            let between = ratio[low] + fraction * (ratio[low + 1] - ratio[low]);
            (between * cornette_shanks(g, nu) / p - 1.0) * (between * cornette_shanks(g, nu) / p - 1.0)
        };
        wanted.iter().map(relative).sum()
    };
    let candidates = (0..98).map(|k| STEP * f64::from(k));
    candidates.min_by(|a, b| error(*a).total_cmp(&error(*b))).unwrap_or(0.0)
}

/// Phase function of all aerosols together, by the light that each scatters in the whole air, as seen by the eye.
fn mean_phase(medium: &Medium, palette: &ColourWeights, nu: f64) -> f64 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for c in medium.constituents.iter().filter(|c| c.role == Role::Aerosol && c.scatters()) {
        let column = c.density.column(0.0, medium.height());
        for (w, colour) in palette.weights.iter().enumerate() {
            let weight = c.scattering[w] * column * colour[1].max(0.0);
            weights += weight;
            sum += weight * c.phase[w].value(nu);
        }
    }
    if weights > 0.0 { sum / weights } else { 0.0 }
}
