//! Slabs whose light is known in closed form or from solvers of others.

use super::media::*;
use std::f64::consts::PI;
use tyndall::internals::medium::PhaseFunction::{HenyeyGreenstein, Isotropic, Rayleigh};
use tyndall::internals::transport::slab::{Dome, Layer, Streams, Surface, fresnel, phase_mean};

fn close(found: f64, expected: f64, relative: f64) {
    assert!((found / expected - 1.0).abs() < relative, "{found} is not {expected}");
}

/// A pure absorber over a Lambertian bed without a surface: bed/π · mu_s e^{−cD (1/mu_s + 1/mu)}, no bounces.
#[test]
fn pure_absorber() {
    let medium = water(0.2, 0.0, Isotropic, 1.0, 0.4);
    for (depth, view, sun) in [(0.5, 0.3, 0.8), (10.0, 1.0, 0.6), (40.0, 0.7, 1.0)] {
        let expected = 0.4 / PI * sun * libm::exp(-0.2 * depth * (1.0 / view + 1.0 / sun));
        let [water, bed] = below(&medium, depth, view, sun);
        assert_eq!(water, 0.0);
        close(bed, expected, 1e-9);
    }
}

/// A clear pool under a real surface: light that the surface throws back meets the bed again. With no water
/// between (depth 0) the bed's radiance is albedo/π · E / (1 − albedo r), r the underside's reflectance of even
/// light, integrated here by itself.
#[test]
fn depth_zero_is_the_seabed() {
    let (n, albedo, view, sun) = (1.34, 0.6, 0.8, 0.5);
    let medium = water(0.1, 0.3, HenyeyGreenstein { g: 0.9 }, n, albedo);
    const STEPS: usize = 400_000;
    let back: f64 = (0..STEPS)
        .map(|k| (k as f64 + 0.5) / STEPS as f64)
        .map(|mu| 2.0 * mu * fresnel(mu, 1.0 / n) / STEPS as f64)
        .sum();
    let entered = sun * (1.0 - fresnel(sun, n));
    let expected = albedo / PI * entered / (1.0 - albedo * back) * (1.0 - fresnel(view, n)) / (n * n);
    let [water, bed] = leaving(&medium, 0.0, view, sun);
    assert!(water.abs() < 1e-15);
    // The streams integrate the kinked reflectance to 2e-4.
    close(bed, expected, 5e-4);
}

/// Next to no scattering: the closed form of light scattered once,
/// ω p mu_s/(mu + mu_s) (1 − e^{−τ(1/mu + 1/mu_s)}), with the exact mean of a forward-peaked phase function.
#[test]
fn light_scattered_once() {
    let phase = HenyeyGreenstein { g: 0.9 };
    let medium = water(1.0, 1e-6, phase.clone(), 1.0, 0.0);
    for (depth, view, sun) in [(0.1, 0.9, 0.4), (2.0, 0.5, 0.95)] {
        let tau = depth * (1.0 + 1e-6);
        let mean = phase_mean(|nu| phase.value(nu), view, -sun);
        let expected = 1e-6 * mean * sun / (view + sun) * -libm::expm1(-tau * (1.0 / view + 1.0 / sun));
        close(below(&medium, depth, view, sun)[0], expected, 1e-5);
    }
}

/// Nothing is lost without absorption: what enters through the surface leaves through it or ends in a black bed.
#[test]
fn energy_is_conserved() {
    let medium = water(0.0, 1.0, HenyeyGreenstein { g: 0.8 }, 1.34, 0.0);
    let slab = slab(&medium);
    for depth in [0.3, 3.0, 30.0] {
        let layer = Layer::new(&slab, depth);
        for field in [layer.sun(&slab.beam(0.85)), layer.sky(Dome::Even)] {
            let (up, down) = layer.irradiance(&field, 0.0);
            let net = down - up;
            close(layer.bed_irradiance(&field), net, 2e-4);
        }
        let bed = layer.bed();
        let (up, down) = layer.irradiance(&bed, 0.0);
        let (from_bed, back) = layer.irradiance(&bed, layer.depth);
        close(from_bed, PI, 1e-6);
        close(from_bed - back, up - down, 2e-4);
    }
}

/// Conservative isotropic slab of optical depth 30 over a bed of albedo 0.45, sun at 0.6: CDISORT's radiances
/// upwards at 0.3, 0.5 and 1, printed to five digits.
#[test]
fn thick_conservative_slab() {
    let medium = water(0.0, 1.0, Isotropic, 1.0, 0.45);
    for (view, expected) in [(0.3, 0.18590), (0.5, 0.18521), (1.0, 0.18102)] {
        let [water, bed] = below(&medium, 30.0, view, 0.6);
        close(water + bed, expected, 3e-4);
    }
}

/// Water of a few metres without a surface, molecules only (no depolarisation), sun at 0.9, bed 0.3, straight up:
/// CDISORT's radiances at 2, 10 and 100 m, printed to four digits.
#[test]
fn clear_water_without_a_surface() {
    for (a, b, expected) in
        [(0.0145, 0.0045, [0.08118, 0.06468, 0.01559]), (0.34, 0.001, [0.02052, 2.147e-4, 1.503e-4])]
    {
        let medium = water(a, b, Rayleigh { king_factor: 1.0 }, 1.0, 0.3);
        for (depth, expected) in [2.0, 10.0, 100.0].into_iter().zip(expected) {
            let [water, bed] = below(&medium, depth, 1.0, 0.9);
            close(water + bed, expected, 1e-3);
        }
    }
}

/// Infinitely deep water has a colour of its own that the bed does not change, and the light of a depth tends to
/// it: 20 and 2000 optical depths agree to rounding.
#[test]
fn depth_without_end_is_the_deep_colour() {
    let medium = water(0.5, 0.5, HenyeyGreenstein { g: 0.9 }, 1.34, 0.9);
    let [deep, none] = leaving(&medium, 2000.0, 0.7, 0.6);
    let [near, bed] = leaving(&medium, 20.0, 0.7, 0.6);
    assert!(none == 0.0 && bed / near < 1e-5, "{bed}");
    close(near, deep, 1e-5);
}

/// Twice the streams change the light of a peaked water by less than 0.3 %, most where view and sun are close to
/// the critical angle.
#[test]
fn streams_are_enough() {
    let medium = water(0.1, 0.9, HenyeyGreenstein { g: 0.92 }, 1.34, 0.2);
    let fine = slab_of(&medium, Streams { per_panel: 24 });
    let coarse = slab(&medium);
    let up = |slab: &tyndall::internals::transport::slab::Slab, view: f64, sun: f64| {
        let layer = Layer::new(slab, 8.0);
        let (beam, view) = (slab.beam(sun), slab.view(view));
        let pair = slab.pair(&beam, &view, means(&medium, view.mu, sun));
        layer.up(&layer.sun(&beam), &view, pair, 0.0)
    };
    for (view, sun) in [(0.7, 0.7), (0.95, 0.8), (1.0, 1.0), (0.8, 0.68)] {
        close(up(&coarse, view, sun), up(&fine, view, sun), 3e-3);
    }
}

/// A beam that falls on the rate of a mode is moved aside unnoticed: its light is that of its neighbours.
#[test]
fn no_beam_meets_a_resonance() {
    let medium = water(1.0, 0.0, Isotropic, 1.0, 0.5);
    // Without scattering the rates are the streams' own 1/mu: 0.5 is one where the number of streams is odd, so
    // every beam of a fine comb is tried instead.
    let mut before = below(&medium, 1.0, 0.5, 0.3)[1];
    for k in 1..=500 {
        let light = below(&medium, 1.0, 0.5, 0.3 + k as f64 * 1e-3)[1];
        assert!(light.is_finite() && light > before, "{k}");
        before = light;
    }
    let s = Surface { n: 1.0 };
    assert!(s.critical() == 0.0 && s.reflects_down(0.2) < 1e-30 && (s.leaves(0.4) - 1.0).abs() < 1e-15);
}
