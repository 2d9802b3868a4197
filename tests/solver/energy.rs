//! Energy: what enters a planet's shell leaves it, is absorbed by the air or by the ground.

use super::worlds::{CONVERGED, RAYLEIGH, constituent, exponential, planet, small_world};
use tyndall::medium::{Medium, PhaseFunction, Role};
use tyndall::transport::balance::{Balance, balance};
use tyndall::transport::solve::{Resolution, Solution};

fn balanced(medium: &Medium, what: &str) -> Vec<Balance> {
    let solution = Solution::new(medium, &Resolution::TABLES, CONVERGED);
    let balances = balance(&solution, medium);
    assert_eq!(balances.len(), medium.wavelengths_nm.len());
    for (w, b) in balances.iter().enumerate() {
        println!("{what}, λ {w}: {:+.5} {:?} {b:?}", b.error(), solution.report);
        assert!(b.error().abs() < 1e-3, "{what}, λ {w}: {:+.5} in {b:?}", b.error());
    }
    balances
}

/// Nothing absorbs: the air only scatters and the ground reflects everything, so all light of the beam passes
/// the limb or is scattered out. 0.1 % is what four quadratures leave at this resolution.
#[test]
fn conservative_air_over_white_ground_loses_nothing() {
    let gas = constituent(Role::Gas, RAYLEIGH, exponential(9e3), &[5e-5, 1.5e-5], &[0.0; 2]);
    for b in balanced(&planet(3_000e3, 70e3, 1.0, vec![gas]), "white ground") {
        assert_eq!((b.absorbed_by_air, b.absorbed_by_ground), (0.0, 0.0));
    }
}

/// Aerosol that absorbs and scatters forwards, over grey ground: all four shares are there and sum to 1.
#[test]
fn absorbing_aerosol_keeps_its_books() {
    let gas = constituent(Role::Gas, RAYLEIGH, exponential(7e3), &[3e-5, 1e-5], &[0.0; 2]);
    let phase = PhaseFunction::CornetteShanks { g: 0.7 };
    let haze = constituent(Role::Aerosol, phase, exponential(2e3), &[5e-5, 6e-5], &[2e-5, 1e-5]);
    for b in balanced(&planet(5_000e3, 60e3, 0.3, vec![gas, haze]), "absorbing aerosol") {
        let shares = [b.passed, b.scattered_out, b.absorbed_by_air, b.absorbed_by_ground];
        assert!(shares.iter().all(|&s| s > 1e-3), "{b:?}");
    }
}

/// A planet of 400 km with a shell of 60 km, where a flat approximation would be off by tens of per cent.
#[test]
fn tiny_planet_keeps_its_books() {
    balanced(&small_world(), "tiny planet");
}
