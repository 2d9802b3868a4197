//! Shipped waters against what is published of natural ones.

use super::media::*;
use tyndall::internals::medium::WaterMedium;
use tyndall::internals::preset::load_water;
use tyndall::internals::transport::slab::Layer;

/// A shipped water at one wavelength.
fn at(name: &str, nm: f64) -> WaterMedium {
    load_water(name, &[]).unwrap().medium(&[nm])
}

/// Irradiance downwards at a depth over that just below the surface, sun at `mu_s` in the air, deep water below.
fn left_after(name: &str, nm: f64, metres: f64, mu_s: f64) -> f64 {
    let slab = slab(&at(name, nm));
    let layer = Layer::new(&slab, metres + 10.0 / slab.extinction);
    let field = layer.sun(&slab.beam(slab.surface.cosine_in_water(mu_s)));
    let down = |t: f64| layer.irradiance(&field, t).1;
    down(slab.extinction * metres) / down(0.0)
}

/// What is left after 100 m. Elek & Kmoch 2010 (§4.1) say 0.6e-20 % to 1.5 % by wavelength; the data they take
/// (Buiteveld et al. 1994) let 31.5 % of 398 nm through, e^(−100 a) of absorption alone, and so does ours: of pure
/// seawater 17 to 45 % by 450 to 480 nm, next to nothing at 650 nm. In clear ocean irradiance at those blue
/// wavelengths is a few percent, Kd of 0.02 to 0.03 1/m, as measured in the clearest seas (Smith & Baker 1981:
/// 0.0168 at 450, 0.0194 at 480 nm).
#[test]
fn light_left_after_100_metres() {
    for nm in [450.0, 460.0, 470.0, 480.0] {
        let water = at("clear-ocean", nm);
        let pure = load_water("clear-ocean", &[]).unwrap().substances[0].absorption.at(nm);
        let absorbed = libm::exp(-100.0 * pure);
        assert!((0.15..0.5).contains(&absorbed), "{nm} nm, absorption of pure seawater: {absorbed}");
        let left = left_after("clear-ocean", nm, 100.0, 1.0);
        assert!((0.04..0.14).contains(&left), "{nm} nm: {left}");
        let kd = -libm::log(left) / 100.0;
        assert!(kd > water.absorption[0] && (0.0168..0.034).contains(&kd), "{nm} nm: Kd {kd}");
    }
    let red = left_after("clear-ocean", 650.0, 100.0, 1.0);
    assert!((1e-17..1e-13).contains(&red), "650 nm: {red}");
}

/// Irradiance reflectance just below the surface of deep clear ocean under the sun alone,
/// R = f b_b / a with f = 0.6279 − 0.2227 η − 0.0513 η² + (−0.3119 + 0.2465 η) mu_s, η the molecules' share of b_b
/// (Morel & Gentili 1991, Eq. 14, by Monte Carlo, for suns up to 60°), which for η near 1 and a high sun is the
/// R = 0.33 b_b / a of Morel & Prieur 1977 within a tenth. Each formula is good to about 10 %.
#[test]
fn reflectance_of_clear_ocean() {
    for name in ["clear-ocean", "tropical"] {
        for nm in [412.0, 443.0, 490.0, 510.0, 555.0] {
            for mu_s in [1.0, 0.8, 0.6] {
                let medium = at(name, nm);
                let slab = slab(&medium);
                let layer = Layer::new(&slab, 200.0 / slab.extinction);
                let field = layer.sun(&slab.beam(slab.surface.cosine_in_water(mu_s)));
                let (up, down) = layer.irradiance(&field, 0.0);
                let back = |phase: &dyn Fn(f64) -> f64| -> f64 {
                    let one = |k: usize| phase(-(k as f64 + 0.5) / 4000.0);
                    2.0 * std::f64::consts::PI * (0..4000).map(one).sum::<f64>() / 4000.0
                };
                let backward = medium.scattering(0) * back(&|nu| medium.phase(0, nu));
                let molecules = &medium.scatterers[0];
                let eta = molecules.scattering[0] * back(&|nu| molecules.phase[0].value(nu)) / backward;
                let f = 0.6279 - 0.2227 * eta - 0.0513 * eta * eta + (-0.3119 + 0.2465 * eta) * mu_s;
                let expected = f * backward / medium.absorption[0];
                let found = up / down;
                println!(
                    "{name} {nm} nm mu_s {mu_s}: R {found:.5}, {expected:.5}, ratio {:.3}",
                    found / expected
                );
                assert!(
                    (found / expected - 1.0).abs() < 0.13,
                    "{name} {nm} {mu_s}: {found} is not {expected}"
                );
                if mu_s == 1.0 {
                    let prieur = 0.33 * backward / medium.absorption[0];
                    assert!((found / prieur - 1.0).abs() < 0.2, "{name} {nm}: {found} is not {prieur}");
                }
            }
        }
    }
}

/// Jerlov's types are defined by how irradiance fades over the first 10 m; his Kd of 1976 (1/m) at 450, 500, 550
/// and 650 nm. Absorption and scattering of the presets are others', measured (IB to 5C) or derived from Jerlov's (I,
/// IA, 7C, 9C). The worst is IB in the blue, where what was measured absorbs 0.041 1/m by itself, over Jerlov's Kd.
#[test]
fn jerlov_waters_fade_as_jerlov_measured() {
    let published = [
        ("jerlov-i", [0.019, 0.027, 0.063, 0.36]),
        ("jerlov-ia", [0.026, 0.032, 0.067, 0.37]),
        ("jerlov-ib", [0.036, 0.042, 0.072, 0.375]),
        ("jerlov-ii", [0.068, 0.07, 0.089, 0.4]),
        ("jerlov-iii", [0.135, 0.115, 0.12, 0.445]),
        ("jerlov-1c", [0.25, 0.14, 0.12, 0.45]),
        ("jerlov-3c", [0.39, 0.22, 0.19, 0.46]),
        ("jerlov-5c", [0.56, 0.36, 0.3, 0.54]),
        ("jerlov-7c", [0.89, 0.58, 0.46, 0.63]),
        ("jerlov-9c", [1.6, 0.99, 0.63, 0.76]),
    ];
    let mut off = Vec::new();
    for (name, expected) in published {
        for (nm, expected) in [450.0, 500.0, 550.0, 650.0].into_iter().zip(expected) {
            let found = -libm::log(left_after(name, nm, 10.0, 0.7)) / 10.0;
            let ratio = found / expected;
            println!("{name} {nm} nm: {found:.4} of {expected}, {ratio:.3}");
            assert!((0.7..1.7).contains(&ratio), "{name} {nm} nm: Kd {found} is not {expected}");
            off.push((ratio - 1.0).abs());
        }
    }
    off.sort_by(f64::total_cmp);
    assert!(off[off.len() / 2] < 0.15, "median {}", off[off.len() / 2]);
}
