//! The literal Algorithm 1 against direct integration, and what must hold of it whatever its resolution.

#[path = "common/constituents.rs"]
mod constituents;
mod direct;

use constituents::{RAYLEIGH, constituent, exponential};
use direct::Planet;
use std::f64::consts::PI;
use tyndall::internals::algorithm1::{Gather, Literal, Settings, bake, work};
use tyndall::internals::machine::isa::Isa;
use tyndall::internals::machine::lanes::Lanes;
use tyndall::internals::medium::{Medium, PhaseFunction, Role};

/// A small world with a thick shell at two wavelengths: vertical optical depths 0.45 and 0.23.
fn small_world() -> Medium {
    Medium {
        ground_radius: 400e3,
        top_radius: 460e3,
        wavelengths_nm: vec![450.0, 650.0],
        ground_albedo: vec![0.3, 0.6],
        constituents: vec![
            constituent(Role::Gas, RAYLEIGH, exponential(12e3), &[3e-5, 1e-5], &[0.0, 2e-6]),
            constituent(
                Role::Aerosol,
                PhaseFunction::Isotropic,
                exponential(6e3),
                &[1e-5, 1.2e-5],
                &[2e-6, 1e-6],
            ),
        ],
    }
}

fn settings(size: [usize; 4], orders: usize, samples: usize) -> Settings {
    Settings { size, orders, samples, extinction_size: [64, 128], ..Settings::default() }
}

fn run(medium: &Medium, settings: &Settings) -> Literal {
    bake(medium, settings, &|_, _| {}).unwrap()
}

fn sum(lanes: [Lanes; 2], w: usize) -> f64 {
    f64::from(lanes[0][w] + lanes[1][w])
}

/// A texel of order 1 is the single-scattering integral along its own ray, no interpolation of radiance in it:
/// with 500 samples it is within 0.2 % of a direct integration that shares no code (own geometry, own columns).
#[test]
fn first_order_is_the_single_scattering_integral() {
    let medium = small_world();
    let literal = run(&medium, &settings([5, 10, 6, 3], 1, 500));
    for w in 0..2 {
        let planet = Planet::new(&medium, w);
        for [i, j, k, l] in [[1, 6, 4, 0], [0, 8, 5, 2], [2, 3, 3, 1], [4, 2, 5, 1], [3, 9, 2, 2]] {
            let (altitude, mu_s) = (literal.map.altitude(i), literal.map.mu_s(k));
            let (mu, hits_ground) = literal.map.mu(altitude, j);
            let (position, view, sun) = planet.place(altitude, mu, mu_s, literal.map.cos_azimuth(l));
            let (expected, ground) = planet.single(position, view, sun, 4000);
            let texel = literal.scattering.get([i, j, k, l]);
            for species in 0..2 {
                let error = (f64::from(texel[species][w]) / expected[species] - 1.0).abs();
                assert!(error < 2e-3, "texel {i} {j} {k} {l}, λ {w}, species {species}: {error:.4}");
            }
            let found = f64::from(literal.ground_light.get([i, j, k, l])[w]);
            assert_eq!(hits_ground, j < 5);
            assert!((found - ground).abs() <= 2e-3 * ground, "R {found} {ground}");
        }
    }
}

/// Order 2 at places between texels tends to a nested direct integration, at first order at least in all steps
/// (an unsplit horizon, a shadow edge): each halving takes off nearly half of the error or more, to 3 % a species in
/// the end. It includes light off the ground that the air then scatters, and light of either species scattered by
/// the other.
#[test]
fn second_order_converges_to_the_nested_integral() {
    let medium = small_world();
    let planet = Planet::new(&medium, 0);
    let views = [(3e3, 0.6, 0.5, 0.3), (20e3, -0.9, 0.8, -0.5)];
    let truth = views.map(|(altitude, mu, mu_s, cos_azimuth)| {
        let (position, view, sun) = planet.place(altitude, mu, mu_s, cos_azimuth);
        planet.second(position, view, sun)
    });
    let errors = [([5, 14, 8, 4], 7), ([8, 26, 13, 6], 13), ([13, 48, 25, 11], 24)].map(|(size, samples)| {
        let [one, two] = [1, 2].map(|orders| run(&medium, &settings(size, orders, samples)));
        let mut worst: f64 = 0.0;
        for ((altitude, mu, mu_s, cos_azimuth), expected) in views.into_iter().zip(truth) {
            let [one, two] = [&one, &two].map(|l| l.at(altitude, mu, mu_s, cos_azimuth));
            for species in 0..2 {
                let order_2 = f64::from(two[species][0]) - f64::from(one[species][0]);
                worst = worst.max((order_2 / expected[species] - 1.0).abs());
            }
        }
        worst
    });
    assert!(errors[1] < 0.6 * errors[0] && errors[2] < 0.6 * errors[1] && errors[2] < 0.03, "{errors:?}");
}

/// The ambient light of order 1 is the irradiance of a sky of single scattering, integrated directly, with the
/// sun on a node of its axis: 2 % for 28 samples.
#[test]
fn ambient_light_is_the_irradiance_of_the_sky() {
    let medium = small_world();
    let literal = run(&medium, &settings([9, 48, 12, 13], 2, 28));
    for k in [5, 10] {
        let expected = Planet::new(&medium, 0).sky_irradiance(literal.map.mu_s(k));
        let found = f64::from(literal.ambient[k][0]);
        assert!((found / expected - 1.0).abs() < 0.02, "{found} {expected}");
    }
}

/// Energy: air without absorption over a black ground only passes sunlight on, so what leaves at the top, what
/// reaches the ground and what passes the limb are the beam that enters, π r_top². 2 % for 30 samples.
#[test]
fn sunlight_that_enters_leaves_or_lands() {
    let mut medium = small_world();
    medium.ground_albedo = vec![0.0; 2];
    medium.constituents.iter_mut().for_each(|c| c.absorption.fill(0.0));
    let literal = run(&medium, &settings([10, 40, 20, 5], 7, 30));
    for w in 0..2 {
        let planet = Planet::new(&medium, w);
        const N: usize = 200;
        let mut sum_of_all = planet.beam_past_the_limb();
        for n in 0..N {
            let mu_s = -1.0 + 2.0 * (n as f64 + 0.5) / N as f64;
            let out = flux_out(&literal, medium.height(), mu_s, w);
            let landed = planet.direct_irradiance(mu_s) + at_sun(&literal, mu_s, w);
            let areas = [medium.top_radius, medium.ground_radius].map(|r| 2.0 * PI * r * r * 2.0 / N as f64);
            sum_of_all += areas[0] * out + areas[1] * landed;
        }
        let entered = PI * medium.top_radius * medium.top_radius;
        assert!((sum_of_all / entered - 1.0).abs() < 0.02, "λ {w}: {}", sum_of_all / entered);
    }
}

/// ∫ I |mu| dω over the directions that look down at the top.
fn flux_out(literal: &Literal, top: f64, mu_s: f64, w: usize) -> f64 {
    const N: usize = 24;
    let mut flux = 0.0;
    for a in 0..2 * N {
        let mu = -(a as f64 + 0.5) / (2 * N) as f64;
        for b in 0..N {
            let azimuth = PI * (b as f64 + 0.5) / N as f64;
            let weight = 2.0 * PI / N as f64 / (2 * N) as f64;
            flux -= mu * weight * sum(literal.at(top, mu, mu_s, libm::cos(azimuth)), w);
        }
    }
    flux
}

fn at_sun(literal: &Literal, mu_s: f64, w: usize) -> f64 {
    let Some(coordinate) = literal.map.sun_coordinate(mu_s) else { return 0.0 };
    let x = coordinate * (literal.ambient.len() - 1) as f64;
    let k = (x as usize).min(literal.ambient.len() - 2);
    let [a, b] = [k, k + 1].map(|k| f64::from(literal.ambient[k][w]));
    a + (b - a) * (x - k as f64)
}

/// Every order adds light and, in thin absorbing air, less of it than the one before; only the subtraction of
/// the ground's light may leave values below 0, and those by rounding alone.
#[test]
fn orders_are_positive_and_fade() {
    let literal = run(&small_world(), &settings([6, 24, 10, 4], 5, 16));
    for w in 0..2 {
        let totals: Vec<f64> = literal.order_totals.iter().map(|t| t[w]).collect();
        assert_eq!(totals.len(), 5);
        assert!(totals.windows(2).all(|t| t[1] > 0.0 && t[1] < t[0]), "{totals:?}");
    }
    for (texel, ground) in literal.scattering.values().iter().zip(literal.ground_light.values()) {
        for w in 0..2 {
            assert!(texel[1][w] >= 0.0 && ground[w] >= 0.0);
            assert!(texel[0][w] >= -2e-6 * ground[w], "{} {}", texel[0][w], ground[w]);
        }
    }
    assert!(literal.negative_fraction < 0.05);
    // Unused lanes hold no light.
    assert!(literal.scattering.values().iter().all(|t| t[0][2] == 0.0 && t[1][15] == 0.0));
}

/// Without aerosol, nothing was last scattered by it; the gas has all the light.
#[test]
fn no_aerosol_no_aerosol_light() {
    let mut medium = small_world();
    medium.constituents.pop();
    let literal = run(&medium, &settings([4, 12, 8, 3], 3, 12));
    assert!(literal.scattering.values().iter().all(|t| t[1] == Lanes::ZERO));
    assert!(sum(literal.at(5e3, 0.5, 0.5, 0.0), 0) > 0.01);
}

/// In air that is nearly not there the ground is seen as it is, albedo / π · mu_s under an overhead sun, and
/// none of it is left in the scattering table.
#[test]
fn vanishing_air_leaves_ground_light_only() {
    let mut medium = small_world();
    for c in &mut medium.constituents {
        c.scattering.iter_mut().chain(&mut c.absorption).for_each(|s| *s *= 1e-5);
    }
    let literal = run(&medium, &settings([4, 12, 8, 3], 4, 12));
    let nadir_overhead = [2, 0, 7, 0];
    for (w, albedo) in [0.3, 0.6].into_iter().enumerate() {
        let ground = f64::from(literal.ground_light.get(nadir_overhead)[w]);
        assert!((ground / (albedo / PI) - 1.0).abs() < 1e-4, "{ground}");
        assert!(sum(*literal.scattering.get(nadir_overhead), w).abs() < 1e-5 * ground);
    }
    let most = literal.scattering.values().iter().map(|t| sum(*t, 0).abs()).fold(0.0, f64::max);
    assert!(most < 1e-4, "{most}");
}

/// Same input, same bits: over threads, instruction sets and the two ways to run Eq. 9.
#[test]
fn bits_do_not_depend_on_the_machine() {
    let medium = small_world();
    let base = settings([4, 12, 6, 3], 3, 10);
    let with = |threads: usize, settings: &Settings| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let literal = pool.install(|| run(&medium, settings));
        (literal.scattering, literal.ground_light, literal.ambient, literal.order_totals)
    };
    let expected = with(1, &base);
    assert!(with(2, &base) == expected);
    assert!(with(2, &Settings { gather: Gather::PerTexel, ..base.clone() }) == expected);
    for isa in [Isa::Baseline, Isa::Avx2, Isa::Avx512].into_iter().filter(|i| i.choose()) {
        assert!(with(1, &base) == expected, "{isa:?}");
    }
    Isa::detect().choose();
}

/// Below the sun axis it is dark, in the table and behind it.
#[test]
fn deep_night_is_dark() {
    let literal = run(&small_world(), &settings([4, 12, 8, 3], 2, 12));
    assert_eq!(literal.at(10e3, 0.3, literal.map.mu_s_min() - 1e-6, 1.0), [Lanes::ZERO; 2]);
    assert!(sum(literal.at(59e3, -0.45, -0.4, 1.0), 0) > 0.0);
}

/// A medium that the paper's method cannot hold is refused, with the reason.
#[test]
fn foreign_media_are_refused() {
    let refused =
        |medium: &Medium, settings: &Settings| bake(medium, settings, &|_, _| {}).err().unwrap().to_string();
    let small = settings([4, 8, 4, 2], 1, 4);
    let mut peaked = small_world();
    peaked.constituents[1].phase[1] = PhaseFunction::HenyeyGreenstein { g: 0.5 };
    assert!(refused(&peaked, &small).contains("HenyeyGreenstein"));
    let wide = small_world().at_wavelengths(&[0; 17]);
    assert!(refused(&wide, &small).contains("16 wavelengths"));
    assert!(refused(&small_world(), &settings([4, 7, 4, 2], 1, 4)).contains("[4, 7, 4, 2]"));
    assert!(refused(&small_world(), &settings([4, 8, 4, 2], 0, 4)).contains("order"));
}

/// The paper's run: 2²⁰ texels, 30 samples a ray, 900 directions a texel, five orders after the first.
#[test]
fn work_counts_the_samples() {
    let texels = 1_048_576.0;
    let per_texel = Settings { gather: Gather::PerTexel, ..Settings::default() };
    let ambient = 32.0 * 900.0;
    assert_eq!(work(&per_texel), texels * 30.0 + 5.0 * (texels * (1800.0 + 30.0) + ambient));
    assert!(work(&Settings::default()) < 0.52 * work(&per_texel));
}

/// Without a table each sample gathers afresh what a 4D table interpolates: the same order 2, up to that interpolation.
/// With a 2D table the phase function is lost, for light that has been scattered once a matter of some per cent.
#[test]
fn other_tables_gather_nearly_the_same_light() {
    let medium = small_world();
    let base = settings([9, 24, 12, 5], 2, 12);
    let [table, mean, none] = [Gather::PerPoint, Gather::Mean, Gather::AtSample]
        .map(|gather| run(&medium, &Settings { gather, ..base.clone() }));
    let first = run(&medium, &Settings { orders: 1, ..base });
    for (altitude, mu, mu_s, cos_azimuth) in
        [(3e3, 0.6, 0.5, 0.3), (20e3, 0.2, 0.8, -0.5), (8e3, -0.9, 0.9, 0.9)]
    {
        let second = |l: &Literal| {
            sum(l.at(altitude, mu, mu_s, cos_azimuth), 0) - sum(first.at(altitude, mu, mu_s, cos_azimuth), 0)
        };
        let expected = second(&none);
        let [by_table, by_mean] = [second(&table) / expected, second(&mean) / expected];
        assert!((by_table - 1.0).abs() < 0.03, "4D at {altitude} {mu}: {by_table}");
        assert!((by_mean - 1.0).abs() < 0.12 && by_mean != by_table, "2D at {altitude} {mu}: {by_mean}");
    }
}
