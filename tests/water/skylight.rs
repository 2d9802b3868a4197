//! The sky's light on water: parts, rings, and a planet's own sky against Monte Carlo from the eye to the sun.

use super::media::*;
use tyndall::internals::layout::water::{FINE, Skylight, Split};
use tyndall::internals::medium::PhaseFunction::HenyeyGreenstein;
use tyndall::internals::reference::Tracer;
use tyndall::internals::reference::water::{Air, Look, WaterTracer};
use tyndall::internals::transport::slab::{Dome, Layer, Light, WaterOrders, gauss_legendre, leaving};
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

/// A sky is as good as the beams that it consists of: both parts, each of unit irradiance, and rings of their
/// radiance give the same light, of water and bed.
#[test]
fn a_sky_is_the_sum_of_its_beams() {
    let medium = water(0.2, 0.8, HenyeyGreenstein { g: 0.8 }, 1.34, 0.5);
    let slab = slab(&medium);
    let layer = Layer::new(&slab, 2.0);
    for (k, dome) in Dome::PARTS.into_iter().enumerate() {
        let mut sky = [0.0; 2];
        sky[k] = 1.0;
        let none = Light::sun(0.5, 0.0);
        let beams: Vec<(f64, f64)> = gauss_legendre(40)
            .into_iter()
            .map(|(mu, w)| (mu, 2.0 * std::f64::consts::PI * mu * w * dome.radiance(mu)))
            .collect();
        for view in [0.2, 0.9] {
            let whole = leaving(&medium, 0, &layer, view, Light { sky, ..none }, WaterOrders::All);
            let rings = leaving(&medium, 0, &layer, view, Light { beams: &beams, ..none }, WaterOrders::All);
            for (whole, rings) in whole.iter().zip(rings) {
                assert!((whole / rings - 1.0).abs() < 3e-3, "{dome:?} {view}: {whole} is not {rings}");
            }
        }
    }
}

/// The whole way, air and water together: sun and sky of a planet, through the surface, the water, off the bed and
/// back. Monte Carlo follows each path from the water into the air; the solvers meet at the surface by way of rings.
/// They agree within 1 % and the noise; two parts in place of the rings within 2 %.
#[test]
fn air_and_water_against_monte_carlo() {
    let planet = tyndall::internals::preset::load("earth-paper", &[]).unwrap();
    let air = planet.medium(&[460.0]);
    let solution = Solution::new(&air, &Resolution::TABLES, Orders::Converged { tolerance: 1e-4 });
    let split = Split::new(&air, &solution);
    let tracer = Tracer::new(&air, 0);
    let medium = water(0.05, 0.2, HenyeyGreenstein { g: 0.6 }, 1.34, 0.3);
    let slab = slab(&medium);
    let depth = 4.0;
    let layer = Layer::new(&slab, depth);
    for (view, mu_s) in [(0.8, 0.7), (0.4, 0.12)] {
        let direct = solution.sun_transmittance(air.ground_radius, mu_s)[0] * mu_s;
        let sky = solution.ground_irradiance(mu_s)[0];
        let beams = Skylight::new(&air, &solution, mu_s, FINE).beams(0, sky);
        let sum =
            |light: Light| leaving(&medium, 0, &layer, view, light, WaterOrders::All).iter().sum::<f64>();
        let rings = sum(Light { beams: &beams, ..Light::sun(mu_s, direct) });
        let parts = sum(Light { sky: split.parts(mu_s, 0, sky), ..Light::sun(mu_s, direct) });
        let look = Look { mu: view, azimuth: None };
        let (mean, noise) = WaterTracer::new(&medium, 0, depth)
            .leaving_under(&Air::new(&tracer, mu_s), look, 40_000, 9)
            .total;
        println!("{view} {mu_s}: {rings:e} parts {parts:e}, Monte Carlo {mean:e} ± {noise:e}");
        assert!(noise < 0.01 * mean, "too noisy: {mean} ± {noise}");
        assert!((rings - mean).abs() < 0.01 * mean + 3.5 * noise, "{rings} is not {mean} ± {noise}");
        assert!((parts / rings - 1.0).abs() < 0.01, "{parts} is not {rings}");
    }
}
