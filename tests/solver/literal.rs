//! The solver against the literal Algorithm 1: another method for the same equations.

use super::worlds::{CONVERGED, small_world};
use tyndall::internals::algorithm1::{Literal, Settings, bake};
use tyndall::internals::geometry::view::View;
use tyndall::internals::medium::Medium;
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

fn literal(medium: &Medium, size: [usize; 4], samples: usize, orders: usize) -> Literal {
    let settings = Settings { size, orders, samples, extinction_size: [64, 128], ..Settings::default() };
    bake(medium, &settings, &|_, _| {}).expect("an isotropic medium")
}

/// Largest relative differences: of TS − TC by order 2 and 3 (gas and aerosol apart), and of TA.
struct Differences {
    scattering: [f64; 2],
    ambient: f64,
}

/// Sun up, at places that no refinement of the tables has as a texel.
const PLACES: [(f64, f64, f64, f64); 3] =
    [(3e3, 0.6, 0.5, 0.3), (20e3, -0.9, 0.8, -0.5), (1e3, 0.95, 0.9, 0.9)];

fn differences(medium: &Medium, ours: &[Solution], size: [usize; 4], samples: usize) -> Differences {
    let theirs = [1, 2, 3].map(|k| literal(medium, size, samples, k));
    let mut out = Differences { scattering: [0.0; 2], ambient: 0.0 };
    for (altitude, mu, mu_s, cos_azimuth) in PLACES {
        let sines = ((1.0 - mu * mu) * (1.0_f64 - mu_s * mu_s)).sqrt();
        let (r, nu) = (medium.ground_radius + altitude, mu * mu_s + sines * cos_azimuth);
        let view = View { r, mu, mu_s, nu, hits_ground: theirs[0].map.hits_ground(altitude, mu) };
        for species in 0..2 {
            let light = [0, 1, 2].map(|k| ours[k].radiance(&view, &[species]).scattering);
            let tables = theirs.each_ref().map(|t| t.at(altitude, mu, mu_s, cos_azimuth)[species]);
            for order in 0..2 {
                for w in 0..2 {
                    let expected = light[order + 1][w] - light[order][w];
                    let found = f64::from(tables[order + 1][w]) - f64::from(tables[order][w]);
                    out.scattering[order] = out.scattering[order].max((found / expected - 1.0).abs());
                }
            }
        }
    }
    for order in [1, 2] {
        for (k, found) in theirs[order].ambient.iter().enumerate() {
            let mu_s = theirs[order].map.mu_s(k);
            let expected = ours[order].ground_irradiance(mu_s);
            if mu_s > 0.2 {
                for w in 0..2 {
                    out.ambient = out.ambient.max((f64::from(found[w]) / expected[w] - 1.0).abs());
                }
            }
        }
    }
    out
}

/// Both solve Eqs. 7–15 for the sum of gas and isotropic aerosol, so light of order 2 and of order 3 (TS − TC, which
/// for us never held ground light) and the ground's diffuse irradiance (TA, orders 1 … K − 1) agree up to the
/// literal method's steps. Its errors are of first order in them: halving the steps takes off a good part, down to
/// a few per cent.
#[test]
fn literal_algorithm_converges_to_the_solver() {
    let medium = small_world();
    let ours: Vec<Solution> =
        [1, 2, 3].map(|k| Solution::new(&medium, &Resolution::TABLES, Orders::First(k))).into();
    let steps = [([5, 14, 8, 4], 7), ([8, 26, 13, 6], 13), ([13, 48, 25, 11], 24)];
    let errors = steps.map(|(size, samples)| differences(&medium, &ours, size, samples));
    for e in &errors {
        println!("orders 2, 3: {:.4?}, ambient {:.4}", e.scattering, e.ambient);
    }
    for order in 0..2 {
        let [a, b, c] = errors.each_ref().map(|e| e.scattering[order]);
        assert!(b < 0.7 * a && c < 0.7 * b && c < 0.05, "order {}: {a:.4} {b:.4} {c:.4}", order + 2);
    }
    let [a, b, c] = errors.each_ref().map(|e| e.ambient);
    assert!(b < 0.7 * a && c < 0.7 * b && c < 0.03, "ambient: {a:.4} {b:.4} {c:.4}");
}

/// The order-by-order sum has the converged answer as its limit: twelve orders of a world of optical depth 0.44 over
/// an albedo of 0.4 leave less than a thousandth.
#[test]
fn orders_sum_to_the_converged_answer() {
    let medium = small_world();
    let [many, all] = [Orders::First(12), CONVERGED].map(|o| Solution::new(&medium, &Resolution::TABLES, o));
    for (altitude, mu, mu_s, cos_azimuth) in PLACES {
        let sines = ((1.0 - mu * mu) * (1.0_f64 - mu_s * mu_s)).sqrt();
        let (r, nu) = (medium.ground_radius + altitude, mu * mu_s + sines * cos_azimuth);
        let view = View { r, mu, mu_s, nu, hits_ground: mu < -0.5 };
        let [many, all] = [&many, &all].map(|s| s.radiance(&view, &[0, 1]).scattering);
        for w in 0..2 {
            assert!((many[w] / all[w] - 1.0).abs() < 1e-3, "{altitude} {mu} λ {w}: {} {}", many[w], all[w]);
        }
    }
}
