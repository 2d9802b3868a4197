//! Cases whose answer can be written down, or is one plain integral.

use super::worlds::{COARSE, CONVERGED, constituent, exponential, light, planet, point, small_world};
use std::f64::consts::PI;
use tyndall::internals::medium::{DensityProfile, Medium, PhaseFunction, Role};
use tyndall::internals::transport::exact::Radiance;
use tyndall::internals::transport::solve::{Orders, Solution};

fn seen(solution: &Solution, medium: &Medium, altitude: f64, mu: f64, sun: f64, azimuth: f64) -> Radiance {
    light(solution, medium, &point(altitude, mu, sun, azimuth)).expect("a view that meets the air")
}

fn close(found: f64, expected: f64, relative: f64, what: &str) {
    assert!((found - expected).abs() <= relative * expected.abs(), "{what}: {found}, expected {expected}");
}

/// Without air the ground is a Lambertian sphere, albedo/π times the sun's cosine where it is seen: that of the
/// observer at the nadir, and 30° on along the ground where the view meets it there. Nothing else shines.
#[test]
fn without_air_only_the_lit_ground_is_seen() {
    let medium = planet(2_000e3, 100e3, 0.7, vec![]);
    let solution = Solution::new(&medium, &COARSE, CONVERGED);
    for altitude in [1e3, 100e3, 1_000e3] {
        let l = seen(&solution, &medium, altitude, -1.0, 50.0, 0.0);
        close(l.ground[0], 0.7 / PI * libm::sin(50f64.to_radians()), 1e-6, "nadir");
        assert_eq!((l.scattering[0], l.transmittance[0]), (0.0, 1.0));
    }
    // From one radius above the ground a view that meets the ground 30° on: a triangle with two known sides.
    let (r, turn) = (4_000e3, 30f64.to_radians());
    let (across, down) = (2_000e3 * libm::sin(turn), 2_000e3 * libm::cos(turn) - r);
    let mu = down / (across * across + down * down).sqrt();
    let l = seen(&solution, &medium, 2_000e3, mu, 40.0, 0.0);
    close(l.ground[0], 0.7 / PI * libm::sin(70f64.to_radians()), 1e-6, "30° towards the sun");
    let l = seen(&solution, &medium, 2_000e3, mu, 20.0, 180.0);
    assert_eq!(l.ground[0], 0.0, "30° away from a sun at 20°: night");
    let up = seen(&solution, &medium, 0.0, 0.4, 40.0, 0.0);
    assert_eq!((up.scattering[0], up.ground[0], up.transmittance[0]), (0.0, 0.0, 1.0));
    assert_eq!(solution.ground_irradiance(0.5), [0.0]);
}

/// Optical depth of an exponential gas by Simpson's rule along the ray, from its definition alone.
fn depth(medium: &Medium, w: usize, r: f64, mu: f64, length: f64) -> f64 {
    const HALVES: usize = 20_000;
    let step = length / (2 * HALVES) as f64;
    let extinction = |t: f64| {
        let altitude = (r * r + t * t + 2.0 * r * mu * t).sqrt() - medium.ground_radius;
        medium.constituents.iter().map(|c| c.extinction(w) * c.density.at(altitude)).sum::<f64>()
    };
    let weight = |k: usize| if k == 0 || k == 2 * HALVES { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
    (0..=2 * HALVES).map(|k| weight(k) * extinction(k as f64 * step)).sum::<f64>() * step / 3.0
}

fn to_top(medium: &Medium, r: f64, mu: f64) -> f64 {
    let b2 = r * r * (1.0 - mu * mu);
    (medium.top_radius * medium.top_radius - b2).sqrt() - r * mu
}

/// Air that only absorbs sends no light on; the ground shines with albedo/π mu_s T(sun) and is dimmed once more on
/// the way up, both optical depths by Simpson's rule in the test.
#[test]
fn absorber_dims_the_ground_twice_and_sends_nothing_on() {
    let gas = constituent(Role::Gas, PhaseFunction::Isotropic, exponential(11e3), &[0.0; 2], &[4e-5, 1e-5]);
    let medium = planet(1_500e3, 90e3, 0.6, vec![gas]);
    let solution = Solution::new(&medium, &COARSE, CONVERGED);
    for (altitude, sun) in [(90e3, 60.0), (20e3, 15.0), (5e3, 89.0)] {
        let l = seen(&solution, &medium, altitude, -1.0, sun, 0.0);
        let mu_s = libm::sin(f64::to_radians(sun));
        for w in 0..2 {
            let up = depth(&medium, w, medium.ground_radius, 1.0, altitude);
            let down = depth(&medium, w, medium.ground_radius, mu_s, to_top(&medium, 1_500e3, mu_s));
            close(l.ground[w], 0.6 / PI * mu_s * libm::exp(-up - down), 3e-6, "ground");
            close(l.transmittance[w], libm::exp(-up), 3e-6, "transmittance");
            assert_eq!(l.scattering[w], 0.0);
        }
    }
    assert_eq!(solution.ground_irradiance(0.8), [0.0, 0.0]);
}

/// A shell so thin (optical depth 6e-6) that light is scattered once or not at all, of one density throughout:
/// radiance is coefficient · phase function · length of the lit part of the ray, up to the 1e-4 that its longest
/// ray extinguishes.
#[test]
fn vanishing_shell_shines_by_the_length_of_its_rays() {
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.5 };
    let layer = DensityProfile::Layer { bottom: 0.0, top: 60e3 };
    let medium =
        planet(1_000e3, 60e3, 0.0, vec![constituent(Role::Aerosol, phase.clone(), layer, &[1e-10], &[0.0])]);
    for orders in [Orders::First(1), CONVERGED] {
        let solution = Solution::new(&medium, &COARSE, orders);
        for (altitude, mu, sun, azimuth) in [
            (0.0, 1.0, 30.0, 0.0),
            (0.0, 0.2, 70.0, 20.0),
            (30e3, 0.0, 60.0, 170.0),
            (30e3, -0.1, 80.0, 60.0),
        ] {
            let p = point(altitude, mu, sun, azimuth);
            let found = seen(&solution, &medium, altitude, mu, sun, azimuth).scattering[0];
            let expected = 1e-10 * phase.value(p.nu()) * to_top(&medium, 1_000e3 + altitude, mu);
            close(found, expected, 1e-4, &format!("{p:?}"));
        }
        // After sunset the zenith is lit from where the planet's shadow ends.
        let sun = -12.0;
        let lit = 1_060e3 - 1_000e3 / libm::cos(f64::to_radians(sun));
        let found = seen(&solution, &medium, 0.0, 1.0, sun, 0.0).scattering[0];
        let expected = 1e-10 * phase.value(libm::sin(f64::to_radians(sun))) * lit;
        close(found, expected, 1e-4, "zenith in twilight");
    }
}

/// Transmittances multiply, T(a, c) = T(a, b) T(b, c), and are the same both ways: what lies between two points
/// of a ray is found from the rays down to the ground and from the reversed rays up to the top.
#[test]
fn transmittances_multiply_both_ways() {
    let medium = small_world();
    let solution = Solution::new(&medium, &COARSE, Orders::First(1));
    let through =
        |r: f64, mu: f64| seen(&solution, &medium, r - medium.ground_radius, mu, 20.0, 0.0).transmittance;
    // A ray that passes the centre at 380 km, inside the ground: its points are 350 and 250 km from the turn.
    let b2: f64 = 380e3 * 380e3;
    let radius = |along: f64| (b2 + along * along).sqrt();
    let (a, b) = (180e3, 150e3);
    let down = [a, b].map(|t| through(radius(t), -t / radius(t)));
    let up = [a, b].map(|t| through(radius(t), t / radius(t)));
    for w in 0..2 {
        let between = down[0][w] / down[1][w];
        assert!(between < 0.95, "something lies between: {between}");
        close(up[1][w] / up[0][w], between, 1e-5, "reversed");
        let direct = libm::exp(-depth(&medium, w, radius(b), b / radius(b), a - b));
        close(between, direct, 1e-5, "between");
    }
}

/// Transmittance to the sun is exp(−∫ extinction), here by Simpson's rule with 40,000 steps, from overhead to below
/// the horizontal; for the horizontal it is near the closed form of Chapman's function, √(π r / 2H) columns of H,
/// and behind the planet it is 0.
#[test]
fn sunlight_is_dimmed_as_chapman_says() {
    let scale = 8e3;
    let gas =
        constituent(Role::Gas, PhaseFunction::Isotropic, exponential(scale), &[1e-6, 1e-5], &[1e-6, 2e-6]);
    let medium = planet(3_000e3, 150e3, 0.0, vec![gas]);
    let solution = Solution::new(&medium, &COARSE, Orders::First(1));
    for (altitude, mu_s) in
        [(0.0, 1.0), (0.0, 0.3), (0.0, 0.0), (10e3, 0.1), (10e3, -0.06), (40e3, -0.15), (150e3, -0.28)]
    {
        let r = medium.ground_radius + altitude;
        let found = solution.sun_transmittance(r, mu_s);
        for w in 0..2 {
            let expected = libm::exp(-depth(&medium, w, r, mu_s, to_top(&medium, r, mu_s)));
            close(found[w], expected, 1e-5, &format!("{altitude} {mu_s} {w}"));
        }
    }
    // Chapman's function to the second term of its series, 1 + 3H/8r; the third is below 1e-6.
    let r: f64 = medium.ground_radius + 20e3;
    let columns = (PI * r / (2.0 * scale)).sqrt() * (1.0 + 3.0 * scale / (8.0 * r));
    let tau = 2e-6 * scale * libm::exp(-20e3 / scale) * columns;
    close(-libm::log(solution.sun_transmittance(r, 0.0)[0]), tau, 1e-4, "horizontal");
    assert_eq!(solution.sun_transmittance(medium.ground_radius, -0.001), [0.0, 0.0]);
}
