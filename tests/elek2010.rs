//! The paper's parameterisation: round trips, ends, and the places where its formulas lose their digits.

use tyndall::internals::mapping::{Elek2010, Layer, SunCurve, Views, Warp, Window};

/// Tiny, Earth-like, thick (Titan-like) and huge shells, m.
const SHELLS: [(f64, f64); 4] = [(400e3, 460e3), (6371e3, 6436e3), (2575e3, 3175e3), (140e6, 140.3e6)];

fn mapping((ground, top): (f64, f64), size: [usize; 4]) -> Elek2010 {
    Elek2010::new(ground, top, size).unwrap()
}

/// Every texel's own coordinates lead back to that texel, in all four axes and both halves. Near the horizon
/// the distance depends on the square root of mu, so half the digits of f64 are left there.
#[test]
fn every_texel_finds_itself() {
    for shell in SHELLS {
        for size in [[32, 128, 32, 8], [2, 2, 2, 2], [3, 6, 5, 4]] {
            let map = mapping(shell, size);
            for i in 0..size[0] {
                let altitude = map.altitude(i);
                for j in 0..size[1] {
                    let (mu, hits) = map.mu(altitude, j);
                    assert_eq!(hits, j < size[1] / 2);
                    assert!((-1.0..=1.0).contains(&mu));
                    let place =
                        map.locate(altitude, mu, map.mu_s(j % size[2]), map.cos_azimuth(j % size[3]), hits);
                    let found = place.unwrap().map(|(index, fraction)| index as f64 + fraction);
                    let degenerate = i == 0 && hits || i + 1 == size[0] && mu >= 0.0;
                    let expected = [i, j, j % size[2], j % size[3]];
                    for axis in 0..4 {
                        let error = (found[axis] - expected[axis] as f64).abs();
                        assert!(
                            error < 1e-5 || axis == 1 && degenerate,
                            "{shell:?} {size:?} texel {expected:?} found at {found:?}"
                        );
                    }
                }
            }
        }
    }
}

/// The split at the horizon: the last texel of each half looks at the horizon, from either side, and mu rises
/// strictly from nadir to the horizon and falls from zenith to it.
#[test]
fn halves_run_from_the_vertical_to_the_horizon() {
    for shell in SHELLS {
        let map = mapping(shell, [32, 128, 32, 8]);
        for i in 1..31 {
            let altitude = map.altitude(i);
            let mu: Vec<f64> = (0..128).map(|j| map.mu(altitude, j).0).collect();
            assert_eq!((mu[0], mu[64]), (-1.0, 1.0));
            assert_eq!((mu[63], mu[127]), (map.horizon_mu(altitude), map.horizon_mu(altitude)));
            assert!(mu[..64].windows(2).all(|m| m[0] < m[1]), "{shell:?} texel {i}");
            assert!(mu[64..].windows(2).all(|m| m[0] > m[1]), "{shell:?} texel {i}");
        }
    }
}

/// Dip of the horizon one millimetre up: −sqrt(2 h / r) to first order in h / r, which is 1e-11 here. A radius
/// squared minus a radius squared would leave four to seven digits; the product form leaves all.
#[test]
fn the_horizon_keeps_its_digits_at_a_millimetre() {
    for shell in SHELLS {
        let map = mapping(shell, [32, 128, 32, 8]);
        let expected = -(2.0 * 1e-3 / shell.0).sqrt();
        assert!((map.horizon_mu(1e-3) / expected - 1.0).abs() < 1e-8, "{shell:?}");
        assert!(!map.hits_ground(1e-3, 0.999_999 * expected));
        assert!(map.hits_ground(1e-3, 1.000_001 * expected));
        // Straight down it is a millimetre to the ground, along the horizon r times the dip.
        assert!((map.distance(1e-3, -1.0, true) / 1e-3 - 1.0).abs() < 1e-6);
        let far = map.distance(1e-3, expected * (1.0 + 1e-12), true);
        assert!((far / (-expected * shell.0) - 1.0).abs() < 1e-4);
    }
}

/// Distances lead to the spheres they are meant to reach: |p + d v| by the law of cosines.
#[test]
fn distances_end_on_the_spheres() {
    for (ground, top) in SHELLS {
        let map = mapping((ground, top), [32, 128, 32, 8]);
        for fraction in [1e-6, 0.1, 0.5, 0.999] {
            let altitude = fraction * (top - ground);
            for k in 0..=200 {
                let mu = -1.0 + k as f64 / 100.0;
                let hits = map.hits_ground(altitude, mu);
                let (r, d) = (ground + altitude, map.distance(altitude, mu, hits));
                let end = (r * r + 2.0 * r * d * mu + d * d).sqrt();
                let expected = if hits { ground } else { top };
                assert!((end / expected - 1.0).abs() < 1e-12, "({ground}, {top}) {altitude} {mu}: {end}");
            }
        }
    }
}

/// Away from its seam the repaired V is the paper's: its formula, with a radius for h, gives ½ (1 − d / Z1) for
/// the ground and ½ (1 + d / (Z1 + Z2)) for the sky, so both depend on nothing but the distance d.
#[test]
fn the_view_axis_is_the_papers_up_to_the_repair() {
    let (ground, top, r): (f64, f64, f64) = (400e3, 460e3, 430e3);
    let map = mapping((ground, top), [32, 128, 32, 8]);
    let z1 = (r * r - ground * ground).sqrt();
    let z2 = (top * top - ground * ground).sqrt();
    for mu in [-0.99_f64, -0.6, -0.4, -0.2, 0.3, 0.9] {
        let z3 = r * r * mu * mu - z1 * z1;
        let hits = mu < 0.0 && z3 > 0.0;
        assert_eq!(hits, map.hits_ground(r - ground, mu));
        let d = map.distance(r - ground, mu, hits);
        let (paper, ours) = if hits {
            (0.5 + (r * mu + z3.sqrt()) / (2.0 * z1), 0.5 * (1.0 - d / z1))
        } else {
            (0.5 - (r * mu - (z3 + z2 * z2).sqrt()) / (2.0 * z1 + 2.0 * z2), 0.5 * (1.0 + d / (z1 + z2)))
        };
        assert!((paper - ours).abs() < 1e-12);
    }
}

/// On the ground and at the top, where one half is 0/0, every texel and every lookup is still a number, and a
/// lookup at the ground is the limit from above.
#[test]
fn the_degenerate_ends_are_well_defined() {
    for shell in SHELLS {
        let map = mapping(shell, [8, 16, 8, 4]);
        for altitude in [0.0, map.altitude(7)] {
            for j in 0..16 {
                let (mu, hits) = map.mu(altitude, j);
                assert!((-1.0..=1.0).contains(&mu) && map.distance(altitude, mu, hits) >= 0.0);
            }
            for mu in [-1.0, -0.5, -1e-9, -0.0, 0.0, 1e-9, 0.5, 1.0] {
                let (index, fraction) = map.view_texel(altitude, mu, map.hits_ground(altitude, mu));
                assert!(index < 15 && (0.0..=1.0).contains(&fraction));
            }
        }
        for mu in [-1.0, -0.5, -0.01] {
            let limit = map.view_coordinate(1e-9 * shell.0, mu, true);
            assert!((map.view_coordinate(0.0, mu, true) - limit).abs() < 0.01, "{shell:?} {mu} {limit}");
        }
        assert_eq!(map.view_texel(0.0, -0.0, true), (6, 1.0));
    }
}

/// For a thin shell the sun axis is the paper's own formula; for a thick one it reaches past the last light at
/// the top (Titan: 35.8° below the horizontal); below it there is no answer.
#[test]
fn the_sun_axis_reaches_the_last_light() {
    let earth = mapping(SHELLS[1], [32, 128, 32, 8]);
    for mu_s in [-0.28, -0.1, 0.0, 0.4, 1.0] {
        let paper = (1.0 - libm::exp(-2.8 * mu_s - 0.8)) / (1.0 - libm::exp(-3.6));
        assert!((earth.sun_coordinate(mu_s).unwrap() - paper).abs() < 1e-14);
    }
    assert_eq!((earth.mu_s(0), earth.mu_s(31)), (earth.mu_s_min(), 1.0));
    assert!(earth.locate(0.0, 0.5, -0.29, 1.0, false).is_none());
    let titan = mapping(SHELLS[2], [32, 128, 32, 8]);
    let last_light = -libm::sin(35.8_f64.to_radians());
    assert!(titan.mu_s_min() < last_light && titan.mu_s_min() > last_light - 0.02);
}

/// Sizes and shells that have no meaning are refused; any even view size and any other size from 2 are not.
#[test]
fn sizes_are_checked() {
    assert!(Elek2010::new(1e6, 1.1e6, [2, 2, 2, 2]).is_some());
    assert!(Elek2010::new(1e6, 1.1e6, [32, 127, 32, 8]).is_none());
    assert!(Elek2010::new(1e6, 1.1e6, [32, 128, 1, 8]).is_none());
    assert!(Elek2010::new(1e6, 1e6, [32, 128, 32, 8]).is_none());
}

/// The manifest's formulas, read with its constants, give the texel's own sun angle and altitude.
#[test]
fn the_manifest_states_what_is_computed() {
    let map = mapping(SHELLS[2], [32, 128, 32, 8]);
    let axes = map.axes();
    let constant = |axis: usize, name: &str| axes[axis].constants.iter().find(|c| c.0 == name).unwrap().1;
    let (a, low) = (constant(2, "a"), constant(2, "mu_s_min"));
    let w = 7.0 / 31.0;
    let mu_s = low - libm::log(1.0 - w * (1.0 - libm::exp(-3.6))) / a;
    assert!((mu_s - map.mu_s(7)).abs() < 1e-12);
    let (ground, z2) = (constant(0, "r_ground"), constant(0, "Z2"));
    let r = (ground * ground + w * z2 * (w * z2)).sqrt();
    assert!((r / map.radius(7) - 1.0).abs() < 1e-12);
}

/// A mapping of a part of a shell has texel centres at the window's ends, in whose coordinates they are even; the sky
/// alone goes from the zenith to the horizon; one texel of a window stands for it, of a point it is the point.
#[test]
fn windows_are_pieces_of_the_whole() {
    for layer in LAYERS {
        windows_are_pieces(layer);
    }
}

/// Without a layer that the altitude axis is finer in, and with one.
const LAYERS: [Layer; 2] = [Layer::NONE, Layer { share: 0.5, altitude: 40e3, width: 5e3 }];

fn windows_are_pieces(layer: Layer) {
    let shell = [600e3, 800e3];
    let curve = SunCurve::Rational { shift: 0.05, width: 0.13 };
    let bends = Warp { altitude_bend: 1.5, altitude_power: 1.0, view_power: 1.5, horizon_power: 2.4, layer };
    let window = Window { altitudes: Some([5e3, 60e3]), suns: Some([-3.0, 40.0]), views: Views::Sky };
    let map = Elek2010::windowed(shell, [5, 7, 9, 1], curve, bends, &window).unwrap();
    let sine = |degrees: f64| libm::sin(degrees.to_radians());
    let close = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-9;
    assert!(close(map.altitude(0), 5e3) && close(map.altitude(4), 60e3));
    assert!(close(map.mu_s(0), sine(-3.0)) && close(map.mu_s(8), sine(40.0)));
    assert!((0..9).any(|k| map.mu_s(k).abs() < 1e-9), "a texel at the horizon, as in whole tables");
    for k in 0..5 {
        let (at, next) = map.altitude_texel(map.altitude(k));
        assert!((at as f64 + next - k as f64).abs() < 1e-9);
        for j in 0..7 {
            let (mu, hits_ground) = map.mu(map.altitude(k), j);
            let (at, next) = map.view_texel(map.altitude(k), mu, hits_ground);
            assert!(!hits_ground && (at as f64 + next - j as f64).abs() < 1e-4, "{k} {j}: {at} {next}");
        }
    }
    assert_eq!(map.mu(5e3, 0), (1.0, false));
    // Beyond the window its end, and the horizon for rays that meet the ground.
    assert_eq!([map.altitude_texel(1.0), map.altitude_texel(150e3)], [(0, 0.0), (3, 1.0)]);
    assert_eq!(map.view_texel(30e3, -1.0, true), (5, 1.0));
    assert_eq!(map.sun_texels(0.99, 1.0).unwrap(), [(7, 1.0), (0, 0.0)]);
    assert_eq!(map.cos_azimuths().len(), 4);

    let one = Window { altitudes: Some([2.0; 2]), suns: Some([35.0; 2]), views: Views::All };
    let map = Elek2010::windowed(shell, [1, 6, 1, 3], curve, bends, &one).unwrap();
    assert!(close(map.altitude(0), 2.0) && close(map.mu_s(0), sine(35.0)));
    let middle = Elek2010::windowed(shell, [1, 6, 2, 3], curve, bends, &window).unwrap();
    assert!(middle.altitude(0) > 5e3 && middle.altitude(0) < 60e3);
    assert!(Elek2010::windowed(shell, [0, 6, 1, 3], curve, bends, &one).is_none());
    assert!(Elek2010::windowed(shell, [1, 7, 1, 3], curve, bends, &one).is_none());
}

/// The window of the whole is the whole, to the bit.
#[test]
fn a_window_of_all_changes_nothing() {
    for layer in LAYERS {
        all_changes_nothing(layer);
    }
}

fn all_changes_nothing(layer: Layer) {
    let curve = SunCurve::HalfAngle { centre: 0.7, width: 0.2 };
    let bends = Warp { altitude_bend: 1.5, altitude_power: 1.0, view_power: 1.5, horizon_power: 2.4, layer };
    let whole = Elek2010::new(600e3, 800e3, [7, 8, 9, 3]).unwrap().with_curves(curve, bends);
    let map = Elek2010::windowed([600e3, 800e3], [7, 8, 9, 3], curve, bends, &Window::WHOLE).unwrap();
    assert_eq!((whole.axes(), whole.spans()), (map.axes(), map.spans()));
    for k in 0..9 {
        assert_eq!((whole.mu_s(k), whole.altitude(k.min(6))), (map.mu_s(k), map.altitude(k.min(6))));
    }
}
