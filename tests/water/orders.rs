//! Light by the number of its scatterings, and what depends on azimuth: against Monte Carlo.

use super::media::*;
use tyndall::internals::medium::PhaseFunction::{HenyeyGreenstein, Isotropic, Rayleigh};
use tyndall::internals::medium::WaterMedium;
use tyndall::internals::reference::water::{Look, Source, WaterTracer};
use tyndall::internals::transport::slab::{
    Azimuths, Layer, Light, Surface, WaterOrders, azimuth_half_spread, leaving, leaving_at,
};

fn first(medium: &WaterMedium, depth: f64, view: f64, sun: f64, orders: WaterOrders) -> [f64; 2] {
    let slab = slab(medium);
    leaving(medium, 0, &Layer::new(&slab, depth), view, Light::sun(sun, sun), orders)
}

/// The first one, two, three and six orders over a black bed, with the light that the underside of the surface
/// throws back, are what Monte Carlo finds when it ends paths after as many scatterings. None of these phase
/// functions has a peak that the solver scales away, so that both count alike.
#[test]
fn each_order_is_what_monte_carlo_counts() {
    let cases: [(WaterMedium, f64); 3] = [
        (water(0.1, 1.0, HenyeyGreenstein { g: 0.5 }, 1.34, 0.0), 4.0),
        (water(0.02, 0.5, Isotropic, 1.5, 0.0), 1.0),
        (water(0.3, 2.0, Rayleigh { king_factor: 1.05 }, 1.2, 0.0), 9.0),
    ];
    for (medium, depth) in cases {
        for (n, (view, sun)) in [(1, (0.9, 0.4)), (2, (0.5, 0.8)), (3, (1.0, 0.6)), (6, (0.3, 0.95))] {
            let found = first(&medium, depth, view, sun, WaterOrders::First(n))[0];
            let tracer = WaterTracer::new(&medium, 0, depth).first(n);
            let (mean, noise) =
                tracer.leaving(Look { mu: view, azimuth: None }, Source::Sun(sun), 60_000, 5).water;
            assert!(noise < 0.01 * mean, "{n} orders: too noisy, {mean} ± {noise}");
            let off = (found - mean).abs();
            assert!(
                off < 0.003 * mean + 3.5 * noise,
                "{n} orders to {depth} m: {found} is not {mean} ± {noise}"
            );
        }
    }
}

/// Order after order the sum tends to the closed form for all of them, from below, peaked particles and bed
/// included: 60 orders of an albedo of 0.9 leave 0.9^60 = 0.2 % at the most.
#[test]
fn orders_add_up_to_the_whole() {
    let medium = water(0.1, 0.9, HenyeyGreenstein { g: 0.92 }, 1.34, 0.4);
    for depth in [0.05, 1.0, 12.0] {
        for (view, sun) in [(1.0, 0.9), (0.3, 0.2)] {
            let all = first(&medium, depth, view, sun, WaterOrders::All);
            let mut before = [0.0; 2];
            for n in [1, 2, 4, 8, 60] {
                let some = first(&medium, depth, view, sun, WaterOrders::First(n));
                assert!(some[0] > before[0] && some[1] >= before[1], "{n} orders add nothing: {some:?}");
                before = some;
            }
            for (some, all) in before.iter().zip(all) {
                assert!((some / all - 1.0).abs() < 0.005, "{depth} m, {view} {sun}: {before:?} is not {all}");
            }
        }
    }
}

/// What a table without azimuth drops, as `bake.json` states it: sunlight that leaves towards the sun, away from it
/// and across by Fourier modes is what Monte Carlo finds there, and half its range is what is stated. The phase
/// function has a peak that is scaled away (g^24 = 0.0018).
#[test]
fn light_over_azimuth() {
    for (g, n) in [(0.5, 1.34), (0.77, 1.5)] {
        let medium = water(0.3, 0.6, HenyeyGreenstein { g }, n, 0.0);
        let (depth, view, sun) = (4.0, 0.3, 0.35);
        let azimuths = Azimuths::new(&medium, 0, Surface { n });
        let layers = azimuths.layers(depth);
        let degrees = [0.0, 90.0, 180.0].map(f64::to_radians);
        let found = leaving_at(&medium, 0, &layers, view, (sun, sun), &degrees);
        let tracer = WaterTracer::new(&medium, 0, depth);
        for (found, azimuth) in found.iter().zip(degrees) {
            let look = Look { mu: view, azimuth: Some(azimuth) };
            let (mean, noise) = tracer.leaving(look, Source::Sun(sun), 60_000, 7).water;
            assert!(noise < 0.02 * mean, "too noisy: {mean} ± {noise}");
            let off = (found - mean).abs();
            assert!(off < 0.005 * mean + 3.5 * noise, "azimuth {azimuth}: {found} is not {mean} ± {noise}");
        }
        // Scattering by the smallest angle is brightest, looking towards the sun: the light's range is its ends'.
        let stated = azimuth_half_spread(&medium, 0, &layers, view, (sun, sun));
        assert!((stated - 0.5 * (found[0] - found[2])).abs() < 1e-9, "{stated} {found:?}");
    }
}

/// The mean over azimuth of all modes is mode 0, which tables hold.
#[test]
fn azimuths_have_the_mean_of_tables() {
    let medium = water(0.3, 0.6, HenyeyGreenstein { g: 0.7 }, 1.34, 0.0);
    let azimuths = Azimuths::new(&medium, 0, Surface { n: 1.34 });
    let around: Vec<f64> = (0..32).map(|k| (k as f64 + 0.5) * std::f64::consts::PI / 32.0).collect();
    let light = leaving_at(&medium, 0, &azimuths.layers(5.0), 0.4, (0.5, 0.5), &around);
    let mean = light.iter().sum::<f64>() / 32.0;
    let expected = first(&medium, 5.0, 0.4, 0.5, WaterOrders::All)[0];
    assert!((mean / expected - 1.0).abs() < 1e-3, "{mean} is not {expected}");
}
