//! The slab solver, surface and bed included, against Monte Carlo: two codes without a common line of transport.

use super::media::*;
use tyndall::internals::medium::PhaseFunction::{self, DoubleHenyeyGreenstein, HenyeyGreenstein, Isotropic};
use tyndall::internals::reference::water::{Look, Source, WaterTracer};

/// Largest difference that is neither noise (three standard errors) nor expected.
const WORST: f64 = 0.01;

fn agrees(found: f64, (mean, stderr): (f64, f64), whole: f64, what: &str) {
    let off = (found - mean).abs();
    assert!(off < WORST * whole + 3.5 * stderr, "{what}: {found} is not {mean} ± {stderr}");
    assert!(stderr < 0.05 * whole, "{what}: the reference is too noisy to judge: {mean} ± {stderr}");
}

fn check(medium: &tyndall::internals::medium::WaterMedium, depth: f64, paths: u64) {
    let tracer = WaterTracer::new(medium, 0, depth);
    for (view, sun) in [(1.0, 0.8), (0.5, 0.3), (0.15, 0.95)] {
        let what = format!("depth {depth} view {view} sun {sun}");
        let found = leaving(medium, depth, view, sun);
        let look = Look { mu: view, azimuth: None };
        let truth = tracer.leaving(look, Source::Sun(sun), paths, 1);
        let whole = truth.water.0 + truth.seabed.0;
        agrees(found[0], truth.water, whole, &format!("{what} water"));
        agrees(found[1], truth.seabed, whole, &format!("{what} seabed"));
    }
    let found = leaving_of_sky(medium, depth, 0.7);
    let truth = tracer.leaving(Look { mu: 0.7, azimuth: None }, Source::Sky, paths, 2);
    let whole = truth.water.0 + truth.seabed.0;
    agrees(found[0], truth.water, whole, &format!("depth {depth} sky water"));
    agrees(found[1], truth.seabed, whole, &format!("depth {depth} sky seabed"));
}

/// Thin and thick, even and peaked scattering, dark and bright beds, several refractive indices.
#[test]
fn slab_against_monte_carlo() {
    let double = DoubleHenyeyGreenstein { g1: 0.95, g2: -0.3, weight: 0.97 };
    let cases: [(f64, f64, PhaseFunction, f64, f64, f64); 4] = [
        (0.02, 0.03, Isotropic, 1.34, 0.5, 5.0),
        (0.1, 1.0, HenyeyGreenstein { g: 0.9 }, 1.34, 0.3, 3.0),
        (0.3, 2.0, double, 1.5, 0.8, 1.0),
        (0.05, 1.0, HenyeyGreenstein { g: 0.5 }, 1.2, 0.1, 10.0),
    ];
    for (a, b, phase, n, bed, depth) in cases {
        check(&water(a, b, phase, n, bed), depth, 30_000);
    }
}
