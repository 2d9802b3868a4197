//! The shipped planets against what is published about them: optical depths, albedos, mean cosines, tops.

use tyndall::internals::medium::{Constituent, PhaseFunction};
use tyndall::internals::preset::{self, Planet};

const NEW: [&str; 7] =
    ["earth-blog", "earth-sparse10", "earth-dense10", "mars", "venus", "venus-cloudtop", "titan"];

fn planet(name: &str) -> Planet {
    preset::load(name, &[]).unwrap()
}

fn close(a: f64, b: f64, relative: f64) {
    assert!((a / b - 1.0).abs() < relative, "{a} is not {b} within {relative}");
}

fn near(a: f64, b: f64, absolute: f64) {
    assert!((a - b).abs() < absolute, "{a} is not {b} within {absolute}");
}

/// Constituents whose names begin so, at a wavelength.
fn some(planet: &Planet, prefix: &str, nm: f64) -> Vec<Constituent> {
    let medium = planet.medium(&[nm]);
    let found: Vec<_> = medium.constituents.into_iter().filter(|c| c.name.starts_with(prefix)).collect();
    assert!(!found.is_empty(), "{prefix}");
    found
}

/// Optical depth between two altitudes (km) of the constituents whose names begin so.
fn depth_between(planet: &Planet, prefix: &str, nm: f64, km: (f64, f64)) -> f64 {
    let part = |c: &Constituent| c.density.column(km.0 * 1e3, km.1 * 1e3) * c.extinction(0);
    some(planet, prefix, nm).iter().map(part).sum()
}

fn depth(planet: &Planet, prefix: &str, nm: f64) -> f64 {
    depth_between(planet, prefix, nm, (0.0, planet.height() / 1e3))
}

/// Single-scattering albedo at an altitude (km).
fn albedo(planet: &Planet, prefix: &str, nm: f64, km: f64) -> f64 {
    let list = some(planet, prefix, nm);
    let sum =
        |f: &dyn Fn(&Constituent) -> f64| -> f64 { list.iter().map(|c| c.density.at(km * 1e3) * f(c)).sum() };
    sum(&|c| c.scattering[0]) / sum(&|c| c.extinction(0))
}

/// Mean cosine of all light that the constituents scatter out of a vertical beam.
fn mean_cosine(planet: &Planet, prefix: &str, nm: f64) -> f64 {
    let list = some(planet, prefix, nm);
    let weight = |c: &Constituent| c.density.column(0.0, planet.height()) * c.scattering[0];
    list.iter().map(|c| weight(c) * c.phase[0].mean_cosine()).sum::<f64>()
        / list.iter().map(weight).sum::<f64>()
}

/// Elek & Kmoch 2010, Fig. 4: ten times sparser and denser is a tenth and ten times of every coefficient, on the
/// same planet under the same star.
#[test]
fn densities_differ_tenfold() {
    let paper = planet("earth-paper");
    for (name, factor, top_km) in [("earth-sparse10", 0.1, 47.0), ("earth-dense10", 10.0, 86.0)] {
        let other = planet(name);
        assert_eq!((other.ground_radius, &other.star), (paper.ground_radius, &paper.star));
        assert_eq!(other.ground_albedo, paper.ground_albedo);
        assert_eq!(other.height(), top_km * 1e3);
        let waves = [400.0, 550.0, 700.0];
        let (a, b) = (other.medium(&waves), paper.medium(&waves));
        assert_eq!(a.constituents.len(), b.constituents.len());
        for (a, b) in a.constituents.iter().zip(&b.constituents) {
            for w in 0..waves.len() {
                close(a.scattering[w], factor * b.scattering[w], 1e-14);
                assert_eq!((a.absorption[w], &a.phase[w]), (0.0, &b.phase[w]));
            }
        }
    }
    // The optical depth of molecules that n = 1.0003 and N = 2.55e25 give at 550 nm over 8 km: 0.1021.
    close(depth(&planet("earth-dense10"), "air", 550.0), 1.0208, 1e-3);
}

/// Coefficients of the 2022 article's Appendix B, 8π³(n²−1)²/(3Nλ⁴), worked by hand at its three wavelengths, and
/// the solar constants of the demo it names.
#[test]
fn the_blog_has_three_wavelengths() {
    let blog = planet("earth-blog");
    for (nm, coefficient, sun) in
        [(680.0, 5.461e-6, 1.474), (550.0, 1.2760e-5, 1.8504), (440.0, 3.1153e-5, 1.91198)]
    {
        close(some(&blog, "air", nm)[0].scattering[0], coefficient, 1e-3);
        assert_eq!(some(&blog, "aerosol", nm)[0].scattering[0], 2e-5);
        close(blog.star.irradiance.at(nm), sun, 1e-9);
    }
    assert_eq!((blog.ground_radius, blog.height()), (6.371e6, 8e4));
}

/// The rule by which tops are chosen: less than 1e-4 of optical depth at 440 nm lies above (the density's slope at
/// the top continued), more than that lies in the uppermost fifth, so that the top is not wastefully high either.
#[test]
fn tops_leave_little_above_them() {
    for name in ["earth-sparse10", "earth-dense10", "mars", "venus", "venus-cloudtop", "titan"] {
        let planet = planet(name);
        let (height, step) = (planet.height(), 0.02 * planet.height());
        let above = |c: &Constituent| {
            let (below, top) = (c.density.at(height - step), c.density.at(height * (1.0 - 1e-12)));
            if top == 0.0 { 0.0 } else { c.extinction(0) * top * step / libm::log(below / top) }
        };
        let tail: f64 = planet.medium(&[440.0]).constituents.iter().map(above).sum();
        assert!((0.0..1e-4).contains(&tail), "{name}: {tail:e}");
        let last_fifth = depth_between(&planet, "", 440.0, (0.8e-3 * height, 1e-3 * height));
        assert!(last_fifth > 1e-4, "{name}: {last_fifth:e}");
    }
}

/// Phase functions share light out: over the sphere they come to 1 (midpoint rule in the angle), and what tables
/// say straight on is far above what they say sideways.
#[test]
fn phase_functions_are_normalised() {
    const N: usize = 20_000;
    let integral = |p: &PhaseFunction| -> f64 {
        let step = std::f64::consts::PI / N as f64;
        let at = |k: usize| {
            let (sine, cosine) = libm::sincos((k as f64 + 0.5) * step);
            2.0 * std::f64::consts::PI * sine * p.value(cosine) * step
        };
        (0..N).map(at).sum()
    };
    for name in NEW {
        for c in planet(name).medium(&[380.0, 515.0, 780.0]).constituents {
            for p in &c.phase {
                near(integral(p), 1.0, 2e-4);
                if let PhaseFunction::Tabulated { .. } = p {
                    assert!(p.value(1.0) > 30.0 * p.value(0.0), "{name} {}", c.name);
                }
            }
        }
    }
}

/// Gas: 636 Pa of CO2 with some N2 and Ar (Sneep & Ubachs 2005) has 0.01002, 0.00268, 0.00076 at 400, 550, 750 nm.
/// Dust: Wolff et al. 2009 indices, spheres of 1.5 µm: extinction 0.968 and 1.048 of that at 550 nm, which is
/// 0.38; albedo 0.748, 0.948, 0.975. The tabulated extinction is smoothed over 30 nm: 1 %.
#[test]
fn mars_has_its_measured_optics() {
    let mars = planet("mars");
    for (nm, gas, dust) in [(400.0, 0.01002, 0.968), (550.0, 0.00268, 1.0), (750.0, 0.00076, 1.048)] {
        close(depth(&mars, "air", nm), gas, 5e-3);
        close(depth(&mars, "dust", nm), 0.38 * dust, 1e-2);
    }
    for (nm, expected) in [(400.0, 0.7476), (600.0, 0.9482), (750.0, 0.9751)] {
        near(albedo(&mars, "dust", nm, 5.0), expected, 1e-3);
    }
    // Measured at 650 nm: 0.685 over Gale crater (Chen-Chen et al. 2019), 0.691 of T-matrix grains.
    near(mean_cosine(&mars, "dust", 650.0), 0.688, 0.015);
    // Bond albedo 0.25 (NASA), geometric albedo 0.170 in V (Mallama et al. 2017), both within what one factor allows.
    near(mars.ground_albedo.at(550.0), 0.174, 0.002);
    close(mars.star.irradiance.at(550.0) / planet("earth").star.irradiance.at(550.0), 0.4307, 1e-3);
}

/// Why a sunset on Mars is blue: the diffraction peak of grains larger than the wavelength grows as λ⁻², so straight
/// on 440 nm is (680/440)² = 2.39 times 680 nm, times 0.944 in extinction and 0.810 in albedo: 1.83, within what a
/// wide range of sizes does to that law. It is narrower too; away from it only the albedo is left, which is red.
#[test]
fn martian_dust_throws_blue_forward() {
    let mars = planet("mars");
    let scattered = |nm: f64, degrees: f64| {
        let dust = some(&mars, "dust", nm).remove(0);
        dust.scattering[0] * dust.phase[0].value(libm::cos(degrees.to_radians()))
    };
    let blueness = |degrees: f64| scattered(440.0, degrees) / scattered(680.0, degrees);
    close(blueness(0.0), 1.83, 0.25);
    for (inner, outer) in [(0.0, 2.0), (2.0, 4.0), (4.0, 6.0), (6.0, 8.0), (8.0, 12.0)] {
        assert!(blueness(inner) > blueness(outer), "{inner}° {outer}°");
    }
    for sideways in [12.0, 30.0, 60.0, 90.0] {
        assert!(blueness(sideways) < 0.7, "{sideways}°: {}", blueness(sideways));
    }
}

/// Gas after VIRA (Seiff et al. 1985): 61.6, 41, 16.5, 6.9, 4.7 at 400, 440, 550, 680, 750 nm, to the digits given,
/// and mean scale heights of 16.1, 9.9, 5.3, 4.1 km in four parts, which no single exponential has.
#[test]
fn venus_has_the_gas_of_vira() {
    let venus = planet("venus");
    for (nm, expected, digits) in
        [(400.0, 61.6, 0.1), (440.0, 41.0, 0.5), (550.0, 16.5, 0.1), (680.0, 6.9, 0.1), (750.0, 4.7, 0.1)]
    {
        near(depth(&venus, "air", nm), expected, digits);
    }
    let air = some(&venus, "air", 550.0).remove(0);
    for (from, to, expected) in [(0.0, 30.0, 16.1), (30.0, 60.0, 9.9), (60.0, 80.0, 5.3), (80.0, 100.0, 4.1)]
    {
        let ratio = air.density.at(from * 1e3) / air.density.at(to * 1e3);
        close((to - from) / libm::log(ratio), expected, 0.02);
    }
    // VIRA's 34.28 hPa at 70 km over the weight of a molecule there (43.4 u, 8.68 m/s²), times 1.139e-30 m².
    close(depth_between(&venus, "air", 550.0, (70.0, 110.0)), 0.00624, 0.04);
}

/// Clouds after Crisp 1986: 22.06 at 630 nm, layer by layer, without absorption; Mie theory for 75 %
/// acid has 20.6 and 22.0 at 400 and 750 nm, mean cosines 0.783, 0.777, 0.747.
#[test]
fn venus_has_its_cloud_layers() {
    let venus = planet("venus");
    close(depth(&venus, "cloud", 630.0), 22.06, 1e-4);
    for (nm, expected, cosine) in [(400.0, 20.59, 0.7835), (550.0, 21.80, 0.7767), (750.0, 21.97, 0.7473)] {
        close(depth(&venus, "cloud", nm), expected, 5e-3);
        near(mean_cosine(&venus, "cloud", nm), cosine, 3e-3);
        assert_eq!(albedo(&venus, "cloud", nm, 60.0), 1.0);
    }
    let layers = [
        (30.32, 47.79, 0.25),
        (47.79, 50.42, 5.84),
        (50.42, 54.11, 5.48),
        (54.11, 57.14, 3.08),
        (57.14, 59.50, 1.40),
        (59.50, 61.97, 1.84),
        (61.97, 64.48, 1.50),
        (64.48, 71.01, 1.67),
        (71.01, 79.29, 0.80),
        (79.29, 90.87, 0.20),
    ];
    let rate = |k: usize| layers.get(k).map_or(0.0, |(bottom, top, depth)| depth / (top - bottom));
    for (k, &(bottom, top, expected)) in layers.iter().enumerate() {
        // A ramp of 0.2 km centred on an edge moves an eighth of its width times the jump across that edge.
        let moved = 0.2 / 8.0 * (rate(k.wrapping_sub(1)) + rate(k + 1) - 2.0 * rate(k));
        near(depth_between(&venus, "cloud", 630.0, (bottom, top)), expected + moved, 2e-3);
    }
    assert_eq!(depth_between(&venus, "cloud", 630.0, (0.0, 30.0)), 0.0);
    assert!(depth_between(&venus, "cloud", 630.0, (48.0, 70.0)) > 0.9 * 22.06);
}

/// The absorber of the ultraviolet after Haus et al. 2015: 0.180, 0.059, 0.026, 0.013 at 400, 450, 550, 700 nm, all
/// of it inside the clouds, none near the ground.
#[test]
fn venus_has_an_absorber_in_its_clouds() {
    let venus = planet("venus");
    for (nm, expected) in [(400.0, 0.17992), (450.0, 0.05853), (550.0, 0.02602), (700.0, 0.01346)] {
        close(depth(&venus, "uv absorber", nm), expected, 2e-3);
    }
    let inside = depth_between(&venus, "uv absorber", 400.0, (54.0, 69.0));
    assert!(inside > 0.98 * 0.17992, "{inside}");
    assert_eq!(albedo(&venus, "uv absorber", 400.0, 60.0), 0.0);
    assert_eq!(venus.ground_albedo.at(550.0), 0.1);
    close(venus.star.irradiance.at(550.0) / planet("earth").star.irradiance.at(550.0), 1.911, 1e-3);
}

/// Over the clouds: gas of 50 hPa at 233 K (0.0333, 0.0089 at 400, 550 nm), droplets of Hansen & Hovenier 1974 (mean
/// cosines 0.756, 0.718, 0.673 with a slightly larger index), deck albedo 0.653, 0.930, 0.852.
#[test]
fn venus_cloudtop_stands_on_its_deck() {
    let deck = planet("venus-cloudtop");
    let cases = [
        (400.0, 0.033305, 0.98896, 0.756, 0.6529),
        (550.0, 0.0089065, 0.99897, 0.718, 0.9298),
        (750.0, 0.002517, 0.99933, 0.673, 0.8517),
    ];
    for (nm, gas, single, cosine, ground) in cases {
        close(depth(&deck, "air", nm), gas, 2e-3);
        close(depth(&deck, "haze", nm), 1.0, 1e-9);
        near(albedo(&deck, "haze", nm, 3.0), single, 1e-4);
        near(mean_cosine(&deck, "haze", nm), cosine, 0.01);
        near(deck.ground_albedo.at(nm), ground, 2e-3);
    }
}

/// Haze of Tomasko et al. 2008: the three power laws give 12.98, 8.11, 4.73 at 425, 550, 750 nm, half of the middle one
/// above 80 km, with a scale height of 65 km there.
#[test]
fn titan_has_the_haze_of_huygens() {
    let titan = planet("titan");
    for (nm, expected) in [(425.0, 12.980), (550.0, 8.1055), (750.0, 4.7272)] {
        close(depth(&titan, "haze", nm), expected, 2e-3);
    }
    for (from, to, expected) in [(0.0, 30.0, 1.3724), (30.0, 80.0, 2.7933), (80.0, 805.0, 3.9398)] {
        close(depth_between(&titan, "haze", 550.0, (from, to)), expected, 3e-3);
    }
    let above = |km| depth_between(&titan, "haze", 550.0, (km, 805.0));
    close(100.0 / libm::log(above(150.0) / above(250.0)), 65.0, 0.02);
    // Tomasko et al. 2008, Table 2: at 430 and 600 nm; midway between 80 and 144 km it is midway.
    for (nm, high, low) in [(430.0, 0.82, 0.925), (600.0, 0.9195, 0.9813)] {
        near(albedo(&titan, "haze", nm, 250.0), high, 1e-6);
        near(albedo(&titan, "haze", nm, 112.0), 0.5 * (high + low), 2e-3);
        near(albedo(&titan, "haze", nm, 81.0), low, 2e-3);
    }
    // Mean cosines of Table 1, integrated along a smooth curve (straight lines would give 4 % more).
    for (nm, expected) in [(430.0, 0.758), (599.9, 0.783)] {
        near(mean_cosine(&titan, "haze", nm), expected, 2e-3);
    }
    close(titan.star.irradiance.at(550.0) / planet("earth").star.irradiance.at(550.0), 0.0109, 3e-3);
}

/// Nitrogen of Moreno et al. 2012: ∫ p/(kT) dz = 2.480e30 molecules per m², times 4.636e-31 m² at 550 nm. Pressure over
/// weight at the ground, with gravity kept, has 3 % less: 1.1126.
#[test]
fn titan_has_its_nitrogen() {
    let titan = planet("titan");
    close(depth(&titan, "nitrogen", 550.0), 1.1497, 2e-3);
    for (nm, by_weight) in [(400.0, 4.1128), (550.0, 1.1126), (750.0, 0.31632)] {
        close(depth(&titan, "nitrogen", nm), by_weight, 0.04);
    }
    // An ideal gas of 1.512 bar and 93.66 K at the ground, and of the table's rows at 150 and 504 km.
    let air = some(&titan, "nitrogen", 550.0).remove(0);
    let sigma = 4.636e-31;
    close(air.scattering[0] / sigma, 1.1695e26, 3e-3);
    let at = |km: f64| air.scattering[0] / sigma * air.density.at(km * 1e3);
    close(at(149.94), 2.5662e-3 * 1e5 / (1.380649e-23 * 158.02), 0.05);
    close(at(503.52), 1.8247e-6 * 1e5 / (1.380649e-23 * 164.16), 0.05);
}
