//! The Monte Carlo reference against closed forms, quadrature, conservation laws, published slabs and another
//! maker's Monte Carlo.

mod common;

use std::f64::consts::PI;
use tyndall::internals::geometry::Point;
use tyndall::internals::medium::{Constituent, DensityProfile, Medium, PhaseFunction, Role};
use tyndall::internals::reference::{Estimate, Settings, Tracer};

/// A planet with one constituent at one wavelength.
fn planet(ground: f64, height: f64, albedo: f64, air: Vec<Constituent>) -> Medium {
    Medium {
        ground_radius: ground,
        top_radius: ground + height,
        wavelengths_nm: vec![550.0],
        ground_albedo: vec![albedo],
        constituents: air,
    }
}

fn air(density: DensityProfile, scattering: f64, absorption: f64, phase: PhaseFunction) -> Constituent {
    Constituent {
        name: "air".into(),
        role: Role::Gas,
        density,
        scattering: vec![scattering],
        absorption: vec![absorption],
        similarity_g: vec![phase.mean_cosine()],
        phase: vec![phase],
    }
}

fn view(altitude: f64, mu: f64, mu_s: f64, azimuth_deg: f64) -> Point {
    Point { altitude, mu, mu_s, azimuth_deg }
}

fn paths(paths: u64) -> Settings {
    Settings { paths, ..Settings::default() }
}

/// Four standard errors (1 in 16,000 by chance; the seed is fixed) and what the expected value is uncertain by.
fn assert_near(e: &Estimate, expected: f64, uncertainty: f64, largest: f64, what: &str) {
    let difference = (e.radiance - expected).abs();
    assert!(
        difference <= 4.0 * e.stderr + uncertainty,
        "{what}: {} ± {}, expected {expected}",
        e.radiance,
        e.stderr
    );
    assert!(e.stderr <= largest * e.radiance, "{what}: standard error {} of {}", e.stderr, e.radiance);
}

/// Optical depth by four-point Gauss–Legendre rules along the path from the observer, renewed at every kink
/// and every 400th of the atmosphere's height; written from the definition alone.
fn depth_by_quadrature(medium: &Medium, p: &Point) -> f64 {
    let (ground, top) = (medium.ground_radius, medium.top_radius);
    let r = ground + p.altitude;
    let at = |t: f64| (r * r + t * t + 2.0 * r * p.mu * t).sqrt();
    // Where the path crosses a radius.
    let crossings = |radius: f64| -> Vec<f64> {
        let d = r * r * (p.mu * p.mu - 1.0) + radius * radius;
        if d < 0.0 { vec![] } else { vec![-r * p.mu - d.sqrt(), -r * p.mu + d.sqrt()] }
    };
    let mut end = crossings(top)[1];
    if p.mu < 0.0 {
        end = crossings(ground).first().copied().unwrap_or(end);
    }
    let mut cuts = vec![0.0, end, -r * p.mu];
    for c in &medium.constituents {
        cuts.extend(c.density.kinks().into_iter().flat_map(|k| crossings(ground + k)));
    }
    // Altitudes at which the rule is renewed, dense enough for the thinnest scale height used here.
    for k in 0..400 {
        cuts.extend(crossings(ground + medium.height() * (k as f64 / 400.0)));
    }
    cuts.retain(|t| (0.0..=end).contains(t));
    cuts.sort_by(f64::total_cmp);
    let extinction = |t: f64| -> f64 {
        medium.constituents.iter().map(|c| c.extinction(0) * c.density.at(at(t) - ground)).sum()
    };
    // Gauss-Legendre, four points.
    let (x1, x2) = (0.339_981_043_584_856_3, 0.861_136_311_594_052_6);
    let (w1, w2) = (0.652_145_154_862_546_1, 0.347_854_845_137_453_85);
    let mut sum = 0.0;
    for c in cuts.windows(2) {
        for part in 0..4 {
            let h = (c[1] - c[0]) / 8.0;
            let m = c[0] + h * (2 * part + 1) as f64;
            sum += h * w1 * (extinction(m - h * x1) + extinction(m + h * x1));
            sum += h * w2 * (extinction(m - h * x2) + extinction(m + h * x2));
        }
    }
    sum
}

/// The optical depth is an integral along a line, whatever the planet: grazing rays, thin aerosol, the kinks
/// of a tent, jumps of a layer, a tiny planet. 1e-5 keeps its bias far below every standard error asked for.
#[test]
fn optical_depth_is_the_integral_along_the_ray() {
    let exponential = |h| DensityProfile::Exponential { scale_height: h };
    let grey = |d, s| air(d, s, 0.0, PhaseFunction::Isotropic);
    let earth = vec![
        grey(exponential(8000.0), 3.3e-5),
        grey(exponential(1200.0), 6.4e-5),
        grey(DensityProfile::Tent { bottom: 10e3, centre: 25e3, top: 40e3 }, 1.9e-6),
    ];
    let tiny = vec![
        grey(exponential(9000.0), 2e-5),
        grey(DensityProfile::Layer { bottom: 20e3, top: 21e3 }, 2e-4),
        grey(DensityProfile::LogLinear { nodes: vec![(0.0, 1.0), (15e3, 0.2), (60e3, 1e-4)] }, 1e-5),
    ];
    for medium in [planet(6_371e3, 100e3, 0.3, earth), planet(400e3, 60e3, 0.1, tiny)] {
        let tracer = Tracer::new(&medium, 0);
        let mut worst = 0.0_f64;
        for altitude in [0.0, 37.0, 1500.0, 9_999.0, 20_500.0, 25_000.0, 39_900.0, 55e3] {
            for mu in [1.0, 0.6, 0.1, 0.01, 0.0, -1e-3, -0.01, -0.05, -0.1, -0.15, -0.4, -1.0] {
                let p = view(altitude, mu, 0.5, 0.0);
                if altitude == 0.0 && mu < 0.0 {
                    continue;
                }
                let (found, expected) = (tracer.optical_depth(&p), depth_by_quadrature(&medium, &p));
                let error = (found - expected).abs() / expected.max(1.0);
                worst = worst.max(error);
                assert!(error < 1e-5, "{altitude} m, {mu}: {found} instead of {expected}");
            }
        }
        println!("largest error of an optical depth: {worst:.1e}");
    }
}

/// Through a pure absorber only the ground's light comes: albedo/π · mu_s · e^(−both optical depths), which
/// in a radial line of sight under a zenith sun is twice the vertical one, on a planet of any size; nothing
/// of it is left to chance.
#[test]
fn ground_through_an_absorber_is_a_closed_form() {
    let profile = DensityProfile::Exponential { scale_height: 3000.0 };
    let medium = planet(700e3, 40e3, 0.37, vec![air(profile, 0.0, 1e-4, PhaseFunction::Isotropic)]);
    let depth = 1e-4 * 3000.0 * (1.0 - libm::exp(-40.0 / 3.0));
    let e = Tracer::new(&medium, 0).estimate(&view(1e6, -1.0, 1.0, 0.0), &paths(64));
    assert!((e.radiance / (0.37 / PI * libm::exp(-2.0 * depth)) - 1.0).abs() < 1e-6, "{e:?}");
    assert_eq!(e.radiance, e.per_order[0].0);

    let flat = planet(
        1e9,
        10e3,
        0.37,
        vec![air(DensityProfile::Layer { bottom: 0.0, top: 10e3 }, 0.0, 5e-5, PhaseFunction::Isotropic)],
    );
    let e = Tracer::new(&flat, 0).estimate(&view(10e3, -0.4, 0.7, 77.0), &paths(64));
    let expected = 0.37 / PI * 0.7 * libm::exp(-0.5 * (1.0 / 0.4 + 1.0 / 0.7));
    // The planet's curve changes the angles by 10 km · tan / 1e6 km: 2e-5 of the exponent.
    assert!((e.radiance / expected - 1.0).abs() < 1e-4, "{} {expected}", e.radiance);
}

/// Without air the ground is all there is, and space is black.
#[test]
fn vacuum_shows_the_bare_ground() {
    let medium = planet(3_000e3, 30e3, 0.5, vec![]);
    let tracer = Tracer::new(&medium, 0);
    let down = tracer.estimate(&view(0.0, -0.3, 0.6, 10.0), &paths(64));
    assert!((down.radiance - 0.5 * 0.6 / PI).abs() < 1e-12);
    for p in [
        view(0.0, 0.3, 0.6, 10.0),
        view(1e6, -0.1, 0.6, 0.0),
        view(1e6, 0.5, 0.6, 0.0),
        view(0.0, -0.3, -0.2, 0.0),
    ] {
        assert_eq!(tracer.estimate(&p, &paths(64)).radiance, 0.0, "{p:?}");
    }
}

/// Single scattering in a homogeneous shell is one integral, with both optical depths being distances: on a
/// small planet, from inside and outside, over a day's and a night's sun.
#[test]
fn first_order_of_a_homogeneous_shell_is_one_integral() {
    let (ground, height, sigma) = (500e3, 50e3, 1.2e-5);
    let layer = DensityProfile::Layer { bottom: 0.0, top: height };
    let phase = PhaseFunction::HenyeyGreenstein { g: 0.6 };
    let medium = planet(ground, height, 0.0, vec![air(layer, 0.8 * sigma, 0.2 * sigma, phase.clone())]);
    let tracer = Tracer::new(&medium, 0);
    let top = ground + height;
    for p in [
        view(0.0, 0.4, 0.3, 50.0),
        view(20e3, -0.05, 0.8, 120.0),
        view(20e3, -0.6, -0.1, 0.0),
        view(0.0, 0.1, -0.25, 20.0),
        view(900e3, -0.95, 0.2, 90.0),
    ] {
        let r = ground + p.altitude;
        let far = |mu: f64, radius: f64, r: f64, sign: f64| -> Option<f64> {
            let d = radius * radius - r * r * (1.0 - mu * mu);
            (d >= 0.0).then(|| -r * mu + sign * d.sqrt())
        };
        let start = if r > top { far(p.mu, top, r, -1.0).expect("hits the shell") } else { 0.0 };
        let ground_hit = if p.mu < 0.0 { far(p.mu, ground, r, -1.0) } else { None };
        let end = ground_hit.or(far(p.mu, top, r, 1.0)).expect("ends");
        const N: usize = 200_000;
        let step = (end - start) / N as f64;
        let mut expected = 0.0;
        for k in 0..N {
            let t = start + (k as f64 + 0.5) * step;
            let rt = (r * r + t * t + 2.0 * r * t * p.mu).sqrt();
            let mu_s = (r * p.mu_s + t * p.nu()) / rt;
            if mu_s < 0.0 && rt * rt * (1.0 - mu_s * mu_s) < ground * ground {
                continue;
            }
            let to_sun = far(mu_s, top, rt, 1.0).expect("inside");
            expected += 0.8 * sigma * phase.value(p.nu()) * libm::exp(-sigma * (t - start + to_sun)) * step;
        }
        let settings = Settings { orders: Some(1), ..paths(1 << 14) };
        let e = tracer.estimate(&p, &settings);
        // The midpoint rule is off by up to one step at the edge of the planet's shadow.
        assert_near(&e, expected, 1e-5 * expected, 1e-3, &format!("{p:?}"));
    }
}

/// Nothing is lost without absorption: what leaves a planet of albedo 1 in conservative air, over all places
/// and directions, is what it intercepts, πR², less what crosses its air unscattered. Places and directions
/// are spread evenly; the factor that remains is 1.
#[test]
fn conservative_planet_returns_all_light() {
    let profile = DensityProfile::Exponential { scale_height: 6000.0 };
    for (sigma, phase) in [
        (5e-5, PhaseFunction::Rayleigh { king_factor: 1.05 }),
        (1e-3, PhaseFunction::CornetteShanks { g: 0.7 }),
    ] {
        let medium = planet(300e3, 50e3, 1.0, vec![air(profile.clone(), sigma, 0.0, phase)]);
        let tracer = Tracer::new(&medium, 0);
        let (ground, top) = (medium.ground_radius, medium.top_radius);
        let unscattered: f64 = (0..4000)
            .map(|k| {
                let b = ground + (top - ground) * (k as f64 + 0.5) / 4000.0;
                let mu = -(1.0 - b * b / (top * top)).sqrt();
                2.0 * PI * b * libm::exp(-tracer.optical_depth(&view(top - ground, mu, 0.0, 0.0)))
            })
            .sum::<f64>()
            * (top - ground)
            / 4000.0;
        let intercepted = PI * top * top - unscattered;
        // Places and directions after an Owen-scrambled Sobol sequence, a scramble for each replicate.
        let ratios: Vec<f64> = (0..8)
            .map(|replicate| {
                let sum: f64 = (0..512)
                    .map(|k| {
                        let u = sobol_burley::sample_4d(k, 0, replicate).map(f64::from);
                        let (mu_s, mu2) = (2.0 * u[0] - 1.0, u[1]);
                        let p = view(top - ground, -mu2.sqrt(), mu_s, 360.0 * u[2]);
                        let seed = u64::from(512 * replicate + k);
                        // |mu| dω with mu² even: π of it over the hemisphere.
                        PI * tracer.estimate(&p, &Settings { replicates: 2, seed, ..paths(8) }).radiance
                    })
                    .sum();
                4.0 * PI * top * top * sum / 512.0 / intercepted
            })
            .collect();
        let mean = ratios.iter().sum::<f64>() / 8.0;
        let stderr = (ratios.iter().map(|r| (r - mean) * (r - mean)).sum::<f64>() / 56.0).sqrt();
        assert!((mean - 1.0).abs() < 4.0 * stderr, "{sigma}: {mean} ± {stderr}");
        assert!(stderr < 0.03, "{sigma}: {mean} ± {stderr}");
    }
}

/// Slabs of optical depth 30 on a planet so large that it is flat, against discrete ordinates (CDISORT by way
/// of nanodisort, 64 streams): isotropic and conservative over albedo 0.45; Venus-like.
#[test]
fn thick_slabs_agree_with_discrete_ordinates() {
    let slab = DensityProfile::Layer { bottom: 0.0, top: 1e4 };
    let isotropic = planet(1e10, 1e4, 0.45, vec![air(slab.clone(), 3e-3, 0.0, PhaseFunction::Isotropic)]);
    let peaked = PhaseFunction::HenyeyGreenstein { g: 0.85 };
    let venus = planet(1e10, 1e4, 0.2, vec![air(slab, 3e-3 * 0.9999, 3e-3 * 0.0001, peaked)]);
    for (medium, expected) in [(isotropic, [0.18590, 0.18521, 0.18102]), (venus, [0.26696, 0.22369, 0.14013])]
    {
        let tracer = Tracer::new(&medium, 0);
        for (mu, radiance) in [0.3, 0.5, 1.0].into_iter().zip(expected) {
            let e = tracer.estimate(&view(1e4, -mu, 0.6, 0.0), &paths(4096));
            // The expected values have five digits.
            assert_near(&e, radiance, 2e-5, 0.06, &format!("mu {mu}"));
        }
    }
}

/// An observer in space sees what one at the ray's entry into the air sees: the sun stays where it is.
#[test]
fn space_sees_what_the_entry_point_sees() {
    let medium = common::oracle_medium("mars_thin");
    let tracer = Tracer::new(&medium, 1);
    let far = view(2e6, -0.85, 0.4, 140.0);
    let (r, top) = (medium.ground_radius + far.altitude, medium.top_radius);
    let t = -r * far.mu - (top * top - r * r * (1.0 - far.mu * far.mu)).sqrt();
    let mu = (r * far.mu + t) / top;
    let mu_s = (r * far.mu_s + t * far.nu()) / top;
    let sines = ((1.0 - mu * mu) * (1.0 - mu_s * mu_s)).sqrt();
    let azimuth = libm::acos((far.nu() - mu * mu_s) / sines).to_degrees();
    let near = view(medium.height(), mu, mu_s, azimuth);
    let (a, b) = (tracer.estimate(&far, &paths(1 << 14)), tracer.estimate(&near, &paths(1 << 14)));
    let error = (a.stderr * a.stderr + b.stderr * b.stderr).sqrt();
    assert!((a.radiance - b.radiance).abs() < 4.0 * error, "{a:?} {b:?}");
    assert!(error < 0.01 * a.radiance);
}

/// Light of 1 … N events is the sum of the orders 1 … N: the same paths, stopped.
#[test]
fn orders_add_up() {
    let medium = common::oracle_medium("earth_clear");
    let tracer = Tracer::new(&medium, 0);
    let p = view(500.0, -0.2, 0.5, 45.0);
    let all = tracer.estimate(&p, &paths(4096));
    for n in [1, 2, 5] {
        let some = tracer.estimate(&p, &Settings { orders: Some(n), ..paths(4096) });
        let sum: f64 = all.per_order[..n].iter().map(|o| o.0).sum();
        assert!((some.radiance / sum - 1.0).abs() < 1e-12, "{n}");
        assert_eq!(some.per_order[n - 1].0, all.per_order[n - 1].0);
        assert!(some.per_order[n..].iter().all(|o| o.0 == 0.0));
    }
    let most: f64 = all.per_order.iter().map(|o| o.0).sum();
    assert!(most <= all.radiance * (1.0 + 1e-12) && most > 0.99 * all.radiance);
}

/// The same seed gives the same bits with any number of threads; another seed gives another estimate of the
/// same quantity; a target is reached by the error that is stated.
#[test]
fn bits_do_not_depend_on_threads() {
    let medium = common::oracle_medium("mars_thin");
    let p = view(0.0, 0.3, -0.05, 60.0);
    let run = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let settings = Settings { stderr: Some(0.01), seed, ..paths(1 << 22) };
        pool.install(|| Tracer::new(&medium, 2).estimate(&p, &settings))
    };
    let (one, three, other) = (run(1, 7), run(3, 7), run(2, 8));
    assert_eq!(one, three);
    assert!(one.stderr <= 0.01 * one.radiance && one.paths < 1 << 22);
    assert_ne!(one.radiance, other.radiance);
    assert!((one.radiance - other.radiance).abs() < 5.0 * (one.stderr + other.stderr));
}

/// Sharp and awkward cases stay finite and not negative: night, a sun at the nadir, g near 1, very thick air.
#[test]
fn awkward_cases_stay_finite() {
    let thin = DensityProfile::Exponential { scale_height: 5000.0 };
    let sharp = PhaseFunction::HenyeyGreenstein { g: 0.99 };
    for (sigma, phase) in [(1e-6, sharp.clone()), (0.01, sharp), (1e-9, PhaseFunction::Isotropic)] {
        let medium = planet(2_000e3, 60e3, 1.0, vec![air(thin.clone(), sigma, 0.0, phase)]);
        let tracer = Tracer::new(&medium, 0);
        for (mu, mu_s) in [(1.0, -1.0), (0.0, 0.0), (0.5, -0.3), (-1.0, 1.0), (1.0, 1.0)] {
            let settings = Settings { orders: Some(50), ..paths(128) };
            let e = tracer.estimate(&view(10.0, mu, mu_s, 0.0), &settings);
            assert!(e.radiance.is_finite() && e.radiance >= 0.0 && e.stderr.is_finite(), "{mu} {mu_s} {e:?}");
        }
    }
}

/// Another maker's Monte Carlo has these radiances with these error bars, so χ² per value is 1 within
/// √(2/198) = 0.1; three of those are allowed, and 198 values would show a common bias of a tenth of them.
#[test]
fn agrees_with_mitsuba() {
    for name in ["earth_clear", "mars_thin"] {
        let medium = common::oracle_medium(name);
        let tracers: Vec<Tracer> = (0..3).map(|w| Tracer::new(&medium, w)).collect();
        let rows = common::oracle_rows(name);
        assert_eq!(rows.len(), 198);
        let answer = |r: &common::OracleRow| {
            let e = tracers[r.wavelength].estimate(&r.point, &paths(640));
            (e.radiance, e.stderr)
        };
        let answers: Vec<_> = rows.iter().map(answer).collect();
        let chi_square = common::chi_square(&rows, &answers);
        assert!((0.7..1.3).contains(&chi_square), "{name}: {chi_square}");
        let pull: f64 = rows
            .iter()
            .zip(&answers)
            .map(|(r, a)| (a.0 - r.radiance) / (r.stderr * r.stderr + a.1 * a.1).sqrt())
            .sum::<f64>()
            / (rows.len() as f64).sqrt();
        assert!(pull.abs() < 4.0, "{name}: mean pull {pull}");
    }
}

/// Stopping at a coarse target does not stop before rare bright paths were met: over many seeds, what is stated
/// and what the answers scatter agree. Scatter over 24 seeds is known to 15 %, and 32 replicates give the stated
/// error to 13 %: 1.4 is two of both together. No answer has fewer paths than the least, where 0.1 % is reached.
#[test]
fn error_at_a_coarse_target_is_not_optimistic() {
    let medium =
        tyndall::internals::preset::load("earth-paper", &[]).expect("a shipped preset").medium(&[440.0]);
    let tracer = Tracer::new(&medium, 0);
    for p in [view(0.0, 1.0, 0.5, 0.0), view(30e3, -1.0, 0.5, 0.0)] {
        let fine = tracer.estimate(&p, &Settings { seed: 1000, ..paths(1 << 20) });
        let pull = |seed: u64| {
            let e = tracer.estimate(&p, &Settings { stderr: Some(0.02), seed, ..paths(1 << 22) });
            assert!(e.stderr <= 0.02 * e.radiance && e.paths >= 32 * 1024, "{e:?}");
            let difference = e.radiance - fine.radiance;
            difference * difference / (e.stderr * e.stderr + fine.stderr * fine.stderr)
        };
        let square = (0..24).map(pull).sum::<f64>() / 24.0;
        assert!(square < 1.96, "{p:?}: scatter over stated error {}", square.sqrt());
    }
}
