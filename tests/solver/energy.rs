//! Energy: what enters a planet's shell leaves it, is absorbed by the air or by the ground.

use super::worlds::{CONVERGED, RAYLEIGH, constituent, exponential, planet, small_world};
use tyndall::internals::medium::{Medium, PhaseFunction, Role};
use tyndall::internals::transport::balance::{Balance, balance};
use tyndall::internals::transport::solve::{Resolution, Solution};

/// Thin air with phase functions that the moments hold.
const EASY: f64 = 1e-3;
/// Optical depths of tens, or peaks that they do not hold: 0.42 and 0.36 % were found.
const HARD: f64 = 5e-3;

fn balanced(medium: &Medium, what: &str, bound: f64) -> Vec<Balance> {
    let solution = Solution::new(medium, &Resolution::TABLES, CONVERGED);
    let balances = balance(&solution, medium);
    assert_eq!(balances.len(), medium.wavelengths_nm.len());
    for (w, b) in balances.iter().enumerate() {
        println!("{what}, λ {w}: {:+.5} {:?} {b:?}", b.error(), solution.report);
        assert!(b.error().abs() < bound, "{what}, λ {w}: {:+.5} in {b:?}", b.error());
    }
    balances
}

/// Nothing absorbs: the air only scatters and the ground reflects everything, so all light of the beam passes
/// the limb or is scattered out. 0.1 % is what four quadratures leave at this resolution.
#[test]
fn conservative_air_over_white_ground_loses_nothing() {
    let gas = constituent(Role::Gas, RAYLEIGH, exponential(9e3), &[5e-5, 1.5e-5], &[0.0; 2]);
    for b in balanced(&planet(3_000e3, 70e3, 1.0, vec![gas]), "white ground", EASY) {
        assert_eq!((b.absorbed_by_air, b.absorbed_by_ground), (0.0, 0.0));
        assert!((b.spherical_albedo() - 1.0).abs() < EASY, "{b:?}");
    }
}

/// Without air a sphere that scatters evenly sends back its albedo's share of all that it meets, and a disc of
/// its radius meets (ground / top)² of the beam.
#[test]
fn bare_ground_sends_back_its_albedo() {
    for b in balanced(&planet(3_000e3, 70e3, 0.3, vec![]), "bare ground", EASY) {
        assert!((b.spherical_albedo() - 0.3).abs() < 0.3 * EASY, "{b:?}");
        let disc = (3_000.0 / 3_070.0) * (3_000.0 / 3_070.0);
        assert!((1.0 - b.passed - disc).abs() < EASY, "{b:?}");
    }
}

/// Aerosol that absorbs and scatters forwards, over grey ground: all four shares are there and sum to 1.
#[test]
fn absorbing_aerosol_keeps_its_books() {
    let gas = constituent(Role::Gas, RAYLEIGH, exponential(7e3), &[3e-5, 1e-5], &[0.0; 2]);
    let phase = PhaseFunction::CornetteShanks { g: 0.7 };
    let haze = constituent(Role::Aerosol, phase, exponential(2e3), &[5e-5, 6e-5], &[2e-5, 1e-5]);
    for b in balanced(&planet(5_000e3, 60e3, 0.3, vec![gas, haze]), "absorbing aerosol", EASY) {
        let shares = [b.passed, b.scattered_out, b.absorbed_by_air, b.absorbed_by_ground];
        assert!(shares.iter().all(|&s| s > 1e-3), "{b:?}");
    }
}

/// A planet of 400 km with a shell of 60 km, where a flat approximation would be off by tens of per cent.
#[test]
fn tiny_planet_keeps_its_books() {
    balanced(&small_world(), "tiny planet", EASY);
}

/// Optical depths of 10 and 30 without loss: here fields are looked up between the levels that hold the state.
/// On these levels alone 3.4 % of the light would be missing.
#[test]
fn thick_air_keeps_its_books() {
    let gas = constituent(Role::Gas, RAYLEIGH, exponential(8e3), &[3.75e-3, 1.25e-3], &[0.0; 2]);
    balanced(&planet(6_000e3, 80e3, 0.5, vec![gas]), "thick air", HARD);
}

/// Half of the dust's light goes into a peak narrower than the directions that gather it: cut off where they
/// cannot see it, it is not lost. Whole it would take 12.6 % of the light with it.
#[test]
fn a_narrow_peak_keeps_its_books() {
    let phase = PhaseFunction::DoubleHenyeyGreenstein { g1: 0.97, g2: 0.3, weight: 0.5 };
    let dust = constituent(Role::Aerosol, phase, exponential(11e3), &[3e-5, 1e-5], &[2e-6, 1e-6]);
    balanced(&planet(3_400e3, 90e3, 0.25, vec![dust]), "narrow peak", HARD);
}
