//! Planets, resolutions and short ways to ask the solver, for the tests beside.

pub use crate::constituents::{RAYLEIGH, constituent, exponential};
use tyndall::internals::geometry::Point;
use tyndall::internals::geometry::view::View;
use tyndall::internals::medium::{Constituent, Medium, PhaseFunction, Role};
use tyndall::internals::transport::exact::Radiance;
use tyndall::internals::transport::solve::{LevelCounts, Orders, Resolution, Solution};

pub const CONVERGED: Orders = Orders::Converged { tolerance: 1e-4 };

/// Enough for a per mille by day, and a fifth of the work of the tables' resolution.
pub const COARSE: Resolution = Resolution {
    levels: LevelCounts { coarse: 20, refinement: 1, cuts: 2 },
    zeniths: 12,
    first_azimuths: 8,
    azimuths: 6,
    sun_nodes: 32,
    sunlight_nodes: 128,
    degree: 8,
};

/// A planet of one albedo; a wavelength for each coefficient of its constituents (one without any).
pub fn planet(ground_radius: f64, height: f64, albedo: f64, constituents: Vec<Constituent>) -> Medium {
    let count = constituents.first().map_or(1, |c| c.scattering.len());
    Medium {
        ground_radius,
        top_radius: ground_radius + height,
        wavelengths_nm: (0..count).map(|w| 450.0 + 100.0 * w as f64).collect(),
        ground_albedo: vec![albedo; count],
        constituents,
    }
}

/// A small world with a thick shell at two wavelengths: vertical optical depths 0.44 and 0.23.
pub fn small_world() -> Medium {
    let gas = constituent(Role::Gas, RAYLEIGH, exponential(12e3), &[3e-5, 1e-5], &[0.0, 2e-6]);
    let isotropic = PhaseFunction::Isotropic;
    let dust = constituent(Role::Aerosol, isotropic, exponential(6e3), &[1e-5, 1.2e-5], &[2e-6, 1e-6]);
    planet(400e3, 60e3, 0.4, vec![gas, dust])
}

/// A point of view, the sun by its elevation in degrees.
pub fn point(altitude: f64, mu: f64, sun_degrees: f64, azimuth_deg: f64) -> Point {
    Point { altitude, mu, mu_s: libm::sin(sun_degrees.to_radians()), azimuth_deg }
}

/// Light of all constituents; None where the view misses the planet and its air.
pub fn light(solution: &Solution, medium: &Medium, point: &Point) -> Option<Radiance> {
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    let view = View::enter(point, medium.ground_radius, medium.top_radius)?;
    Some(solution.radiance(&view, &all))
}

/// Scattered light and the ground's, per wavelength; 0 for a miss.
pub fn total(solution: &Solution, medium: &Medium, point: &Point) -> Vec<f64> {
    match light(solution, medium, point) {
        Some(light) => light.scattering.iter().zip(&light.ground).map(|(s, g)| s + g).collect(),
        None => vec![0.0; medium.wavelengths_nm.len()],
    }
}
