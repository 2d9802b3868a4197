//! The older methods are what they are said to be: run finely they meet the solver where their physics does, and they
//! fail where their tables must.

use tyndall::internals::geometry::Point;
use tyndall::internals::geometry::view::View;
use tyndall::internals::methods::{Elek2009, Method, Nishita, OneilMarch, PreparedSky, Schafhitzel};
use tyndall::internals::preset::{self, Planet};
use tyndall::internals::spectrum::ColourSpace;
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

/// Red, green and blue of the older methods.
const NM: [f64; 3] = [680.0, 550.0, 440.0];

/// The planet of the 2022 article, whose numbers the march was published with.
fn blog() -> Planet {
    preset::load("earth-blog", &[]).unwrap()
}

fn prepared(method: &dyn Method) -> Box<dyn PreparedSky> {
    method.prepare(&blog()).unwrap().sky
}

/// Radiance at the three wavelengths by the solver, as red, green and blue of the star's three constants.
fn solved(planet: &Planet, orders: Orders, points: &[Point]) -> Vec<[f64; 3]> {
    let medium = planet.medium(&NM);
    let solution = Solution::new(&medium, &Resolution::TABLES, orders);
    let constants = NM.map(|nm| planet.star.irradiance.at(nm));
    let luminance = ColourSpace::Srgb.to_xyz()[1];
    let sum: f64 = (0..3).map(|c| luminance[c] * constants[c]).sum();
    let colour = |p: &Point| {
        let view = View::enter(p, medium.ground_radius, medium.top_radius).unwrap();
        let light = solution.radiance(&view, &[0, 1]);
        std::array::from_fn(|c| (light.scattering[c] + light.ground[c]) * constants[c] / sum)
    };
    points.iter().map(colour).collect()
}

/// Up, level, down, from space; sun high and low; towards it, across and away.
fn points() -> Vec<Point> {
    let of = |altitude, mu, mu_s, azimuth_deg| Point { altitude, mu, mu_s, azimuth_deg };
    vec![
        of(2.0, 0.9, 0.8, 30.0),
        of(2.0, 0.2, 0.5, 0.0),
        of(2.0, 0.1, 0.3, 180.0),
        of(9000.0, -0.6, 0.7, 90.0),
        of(30_000.0, 0.05, 0.2, 45.0),
        of(400_000.0, -0.8, 0.5, 120.0),
    ]
}

fn largest_difference(sky: &dyn PreparedSky, expected: &[[f64; 3]], points: &[Point]) -> f64 {
    let mut largest: f64 = 0.0;
    for (p, expected) in points.iter().zip(expected) {
        let found = sky.radiance(p);
        for c in 0..3 {
            let difference = (found[c] / expected[c] - 1.0).abs();
            assert!(difference.is_finite(), "{p:?}: {found:?}");
            largest = largest.max(difference);
        }
    }
    largest
}

/// The march is the solver's first order, ground light by direct sun included: an integral by even steps against one by
/// Gauss's, with other geometry and other columns. Forty steps are some per cent off, a thousand half a per cent.
#[test]
fn fine_march_is_the_first_order() {
    let points = points();
    let expected = solved(&blog(), Orders::First(1), &points);
    let error = |steps, sun_steps| {
        largest_difference(prepared(&Nishita { steps, sun_steps }).as_ref(), &expected, &points)
    };
    let (coarse, fine) = (error(40, 20), error(1000, 400));
    println!("march: {coarse:.4} {fine:.4}");
    assert!(fine < 0.005 && coarse > 2.0 * fine && coarse < 0.2, "{coarse} {fine}");
}

/// A fine table of depth changes the march by little where the sun is not at the horizon, and costs a read a step.
#[test]
fn march_with_a_fine_table_is_the_march() {
    let points = points();
    let march = prepared(&Nishita { steps: 80, sun_steps: 200 });
    let expected: Vec<[f64; 3]> = points.iter().map(|p| march.radiance(p)).collect();
    let table = prepared(&OneilMarch { steps: 80, size: [1024, 1024] });
    let error = largest_difference(table.as_ref(), &expected, &points);
    println!("table: {error:.4}");
    assert!(error < 0.02, "{error}");
    assert_eq!((march.bytes(), march.fetches(&points[0])), (0, 0));
    assert_eq!(table.fetches(&points[0]), 80, "two constituents fill one texture");
    assert_eq!(table.bytes(), 1024 * 1024 * 2 * 2 * 4);
}

/// Towards the sun, where its plane is filled, the 3D table is the march up to its texels; elsewhere it answers the same,
/// for it has no azimuth.
#[test]
fn table_of_schafhitzel_has_one_azimuth() {
    let towards: Vec<Point> = [(2.0, 0.9, 0.8), (2000.0, 0.5, 0.5), (20_000.0, 0.3, 0.4)]
        .map(|(altitude, mu, mu_s)| Point { altitude, mu, mu_s, azimuth_deg: 0.0 })
        .into();
    let march = prepared(&Nishita { steps: 400, sun_steps: 200 });
    let expected: Vec<[f64; 3]> = towards.iter().map(|p| march.radiance(p)).collect();
    let table = prepared(&Schafhitzel { size: [64, 64, 64] });
    let error = largest_difference(table.as_ref(), &expected, &towards);
    println!("3D table: {error:.4}");
    assert!(error < 0.1, "{error}");
    for p in &towards {
        assert_eq!(table.radiance(p), table.radiance(&Point { azimuth_deg: 180.0, ..*p }));
    }
}

/// With the sun in the zenith every azimuth is alike, and for a view at 55° from it, where Rayleigh's phase function has
/// its mean (ν² = 1/3), phase functions put on all light change only what aerosols scatter more than once: within some
/// per cent of all orders, where the first alone is a fifth too dark in the blue.
#[test]
fn table_of_elek_2009_holds_all_orders() {
    let points = [Point { altitude: 2.0, mu: (1.0f64 / 3.0).sqrt(), mu_s: 1.0, azimuth_deg: 0.0 }];
    let expected = solved(&blog(), Orders::Converged { tolerance: 1e-4 }, &points);
    let error = largest_difference(prepared(&Elek2009 { size: [16, 64, 32] }).as_ref(), &expected, &points);
    let once = prepared(&Nishita { steps: 400, sun_steps: 200 }).radiance(&points[0]);
    println!("3D table of all orders: {error:.4}; blue of the first {:.3}", once[2] / expected[0][2]);
    assert!(error < 0.1, "{error}");
    assert!(once[2] / expected[0][2] < 0.85);
}
