//! Awkward planets and views: the answer is finite and never negative.

use super::worlds::{COARSE, CONVERGED, RAYLEIGH, constituent, exponential, light, planet};
use tyndall::internals::geometry::Point;
use tyndall::internals::medium::{Constituent, Medium, PhaseFunction, Role};
use tyndall::internals::transport::solve::Solution;

/// From the ground to the very top: zenith, nadir, the horizontal and both sides of the horizon (0.1° off), with the
/// sun from −18° to overhead, towards it and away.
fn views(medium: &Medium) -> Vec<Point> {
    let mut out = Vec::new();
    let height = medium.height();
    for altitude in [0.0, 1.0, 0.1 * height, 0.7 * height, height] {
        let r = medium.ground_radius + altitude;
        let horizon = -libm::acos((medium.ground_radius / r).min(1.0)).to_degrees();
        let elevations = [-90.0, horizon - 0.1, horizon + 0.1, 0.0, 35.0, 90.0];
        for elevation in elevations {
            for sun in [-18.0, -12.0, -6.0, -1.0, 0.0, 0.5, 10.0, 50.0, 90.0] {
                for azimuth_deg in [0.0, 90.0, 180.0] {
                    let [mu, mu_s] = [elevation, sun].map(|e: f64| libm::sin(e.to_radians()));
                    out.push(Point { altitude, mu, mu_s, azimuth_deg });
                }
            }
        }
    }
    out
}

/// Scattered light, ground light and transmittance, and the ground's irradiance.
fn failures(medium: &Medium, what: &str) -> Vec<String> {
    let solution = Solution::new(medium, &COARSE, CONVERGED);
    let mut out = Vec::new();
    let fine = |v: &f64| v.is_finite() && *v >= 0.0;
    let mut brightest: f64 = 0.0;
    for p in views(medium) {
        let Some(l) = light(&solution, medium, &p) else { continue };
        brightest = l.scattering.iter().chain(&l.ground).copied().fold(brightest, f64::max);
        if !l.scattering.iter().chain(&l.ground).all(fine) {
            out.push(format!("{what}: {:?} + {:?} at {p:?}", l.scattering, l.ground));
        }
        assert!(l.transmittance.iter().all(|t| fine(t) && *t <= 1.0), "{what}: {l:?} at {p:?}");
    }
    for k in 0..=100 {
        let mu_s = -1.0 + 0.02 * f64::from(k);
        assert!(solution.ground_irradiance(mu_s).iter().all(fine), "{what}: irradiance at {mu_s}");
    }
    println!(
        "{what}: {} applications, residual {:.1?}, brightest {brightest:.3e}, bad views {}",
        solution.report.applications,
        solution.report.residual,
        out.len()
    );
    // Not a maximum, which would pass over what is not a number.
    assert!(solution.report.residual.iter().all(|&r| r < 1e-3), "{what}: {:?}", solution.report.residual);
    assert!(brightest > 0.0, "{what}: no light at all");
    // A peak shows the sun itself at most, spread by its phase function; the rest is far dimmer.
    let largest = medium.constituents.iter().flat_map(|c| &c.phase).map(|p| p.value(1.0)).fold(1.0, f64::max);
    assert!(brightest <= largest, "{what}: radiance {brightest:.3e}, more than {largest:.3e}");
    out
}

fn check(cases: Vec<(&str, Medium)>) {
    let failures: Vec<String> = cases.iter().flat_map(|(what, medium)| failures(medium, what)).collect();
    let shown = failures.len().min(12);
    assert!(failures.is_empty(), "{} bad views:\n{}", failures.len(), failures[..shown].join("\n"));
}

fn gas(scattering: &[f64]) -> Constituent {
    let absorption = vec![0.0; scattering.len()];
    constituent(Role::Gas, RAYLEIGH, exponential(8e3), scattering, &absorption)
}

fn haze(phase: PhaseFunction, scattering: f64, absorption: f64) -> Constituent {
    constituent(Role::Aerosol, phase, exponential(1.5e3), &[scattering; 2], &[absorption; 2])
}

const ISOTROPIC: PhaseFunction = PhaseFunction::Isotropic;

/// Radiance is a sum of products of what is not negative, so it is finite and at least 0 in any medium: here with
/// none, one and only absorbing constituents, and with nothing that absorbs at all.
#[test]
fn sparse_and_lossless_media_are_finite_and_not_negative() {
    let absorber = constituent(Role::Gas, ISOTROPIC, exponential(8e3), &[0.0; 2], &[5e-5, 1e-5]);
    check(vec![
        ("vacuum", planet(2_500e3, 60e3, 0.5, vec![])),
        ("one constituent", planet(2_500e3, 60e3, 0.2, vec![gas(&[4e-5, 6e-6])])),
        ("black ground", planet(2_500e3, 60e3, 0.0, vec![gas(&[4e-5, 6e-6])])),
        ("absorber only", planet(2_500e3, 60e3, 0.5, vec![absorber])),
        ("nothing absorbs", planet(2_500e3, 60e3, 1.0, vec![gas(&[5e-5, 2e-5])])),
    ]);
}

/// The same with forward peaks that reach past the moments, and a backward one.
#[test]
fn peaked_media_are_finite_and_not_negative() {
    check(vec![
        ("g 0.76", hazy(PhaseFunction::CornetteShanks { g: 0.76 })),
        ("g -0.5", hazy(PhaseFunction::HenyeyGreenstein { g: -0.5 })),
    ]);
}

fn hazy(phase: PhaseFunction) -> Medium {
    planet(4_000e3, 60e3, 0.3, vec![gas(&[2e-5, 6e-6]), haze(phase, 1e-4, 1e-5)])
}

/// A forward peak of 20,000 times the mean (Henyey–Greenstein, g 0.99), of which the moments hold next to nothing:
/// what their cut-off field takes away below the horizon's light is set to 0, not left negative.
#[test]
fn sharpest_peak_is_finite_and_not_negative() {
    check(vec![("g 0.99", hazy(PhaseFunction::HenyeyGreenstein { g: 0.99 }))]);
}

/// A planet that its shell makes a sixth as large again, and one half as large again.
#[test]
fn tiny_planets_are_finite_and_not_negative() {
    check(vec![
        ("tiny", planet(400e3, 60e3, 0.4, vec![gas(&[4e-5, 1e-5])])),
        ("tinier", planet(120e3, 60e3, 0.4, vec![gas(&[4e-5, 1e-5])])),
    ]);
}

/// Air that reaches up four radii of the planet, thick and without loss. Within a free path the sun's height changes
/// much there: a coarse operator that knows it needs 52 applications of the fine one, one that does not 71.
#[test]
fn tall_air_is_finite_and_soon_solved() {
    let phase = PhaseFunction::CornetteShanks { g: 0.0 };
    let deep = constituent(Role::Gas, phase, exponential(600e3), &[2.5e-5; 2], &[0.0; 2]);
    let medium = planet(654e3, 2_335e3, 0.0, vec![deep]);
    check(vec![("tall", medium.clone())]);
    let applications = Solution::new(&medium, &COARSE, CONVERGED).report.applications;
    assert!(applications < 60, "{applications} applications");
}

/// A planet of ten Jupiters, where twilight lasts a tenth of a degree of the sun:
/// shorter than the sun axis resolves, so what undershoots there is set to 0.
#[test]
fn huge_planet_is_finite_and_not_negative() {
    check(vec![("huge", planet(700_000e3, 60e3, 0.4, vec![gas(&[4e-5, 1e-5])]))]);
}

/// Thick air: ten times the Earth's, and optical depth 5 of gas, of isotropic cloud and of cloud with a peak.
#[test]
fn thick_air_is_finite_and_not_negative() {
    let cloud = |phase| vec![gas(&[2e-5, 6e-6]), haze(phase, 3.2e-3, 1e-5)];
    let thick = |constituents| planet(6_360e3, 60e3, 0.3, constituents);
    check(vec![
        ("ten times denser", thick(vec![gas(&[4.4e-4, 5.8e-5])])),
        ("optical depth 5 of gas", thick(vec![gas(&[6.25e-4, 3e-4])])),
        ("optical depth 5 of cloud", thick(cloud(ISOTROPIC))),
        ("optical depth 5 of peaked cloud", thick(cloud(PhaseFunction::HenyeyGreenstein { g: 0.8 }))),
    ]);
}
