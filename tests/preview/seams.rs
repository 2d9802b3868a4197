//! No seam where axes end, halves meet or formulas change: walks in small steps across each.

use super::run::*;

const STEPS: usize = 200;

/// A view at each place of a walk, -1 to 1.
type Walk<'a> = &'a dyn Fn(f64) -> [f64; 4];

/// The largest change of a step over the brightest light of the walk, and the change from end to end.
fn steps(bake: &str, layout: &str, view: impl Fn(f64) -> [f64; 4]) -> (f64, f64) {
    let views: Vec<[f64; 4]> = (0..=STEPS).map(|k| view(2.0 * k as f64 / STEPS as f64 - 1.0)).collect();
    let light = shader(bake, layout, &views, &[]);
    let brightest = light.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
    assert!(brightest > 0.0 && light.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    let change =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs() / brightest).fold(0.0, f64::max);
    let largest = light.windows(2).map(|w| change(&w[0], &w[1])).fold(0.0, f64::max);
    (largest, change(&light[0], &light[STEPS]))
}

/// A view `angle` degrees from the vertical (`up` 1 or -1), on the sun's side for positive angles.
fn over_the_pole(altitude: f64, up: f64, angle: f64) -> [f64; 4] {
    let azimuth = if angle >= 0.0 { 0.0 } else { 180.0 };
    [altitude, up * libm::cos(angle.to_radians()), 0.4, azimuth]
}

/// Half a degree to either side of zenith, nadir, azimuth 0 and azimuth 180 in 200 steps: light that is smooth
/// changes by less than 0.1 % in a step of 0.005 degrees, far from the sun.
#[test]
fn zenith_nadir_and_azimuths_have_no_seam() {
    if !gpu() {
        return;
    }
    for layout in ["compact", "elek2010"] {
        let walks: [(&str, Walk); 4] = [
            ("zenith", &|t| over_the_pole(3e3, 1.0, 0.5 * t)),
            ("nadir", &|t| over_the_pole(3e4, -1.0, 0.5 * t)),
            ("azimuth 0", &|t| [3e3, 0.1, 0.6, 0.5 * t]),
            ("azimuth 180", &|t| [3e3, 0.1, 0.6, 180.0 + 0.5 * t]),
        ];
        for (name, walk) in walks {
            let (step, all) = steps(earth(), layout, walk);
            println!("{layout} {name}: step {step:.1e} of {all:.1e}");
            assert!(step < 1e-3, "{layout} {name}: a step of {step}");
        }
    }
}

/// From above the shell to inside it nothing happens to a view: 5 m to either side of the top, on planets of two sizes.
#[test]
fn entering_the_shell_is_no_step() {
    if !gpu() {
        return;
    }
    for (bake, height) in
        [(earth(), 66e3), (mars(), constant(mars(), "top_radius_m") - constant(mars(), "ground_radius_m"))]
    {
        for layout in ["compact", "elek2010"] {
            let (step, all) = steps(bake, layout, |t| [height + 5.0 * t, -0.3, 0.4, 60.0]);
            println!("{bake} {layout}: step {step:.1e} of {all:.1e}");
            assert!(step < 1e-3, "{bake} {layout}: a step of {step}");
        }
    }
}

/// Across the horizon seen from 10 km, 350 km away: through that much air neither the ground before it nor the air
/// behind it sends much, so that the halves of the view axis meet within 1 %, though nothing is filtered across them;
/// to either side light is smooth.
#[test]
fn the_horizon_is_no_edge() {
    if !gpu() {
        return;
    }
    let (ground, altitude) = (6.371e6, 1e4);
    let horizon: f64 = -libm::sqrt(altitude * (2.0 * ground + altitude)) / (ground + altitude);
    for layout in ["compact", "elek2010"] {
        for (name, low, high, bound) in
            [("below", -4e-4, -1e-6, 5e-3), ("above", 1e-6, 4e-4, 5e-3), ("across", -2e-5, 2e-5, 0.01)]
        {
            let walk = |t: f64| [altitude, horizon + low + 0.5 * (1.0 + t) * (high - low), 0.5, 70.0];
            let (step, all) = steps(earth(), layout, walk);
            println!("{layout} horizon {name}: step {step:.1e} of {all:.1e}");
            assert!(step < bound, "{layout} {name}: a step of {step}");
        }
    }
}

/// The sun axis ends where nothing is lit: the last light before its end is less than a millionth of the day's, beyond
/// it there is none. At its other end the sun passes the zenith.
#[test]
fn the_ends_of_the_sun_axis_are_no_edges() {
    if !gpu() {
        return;
    }
    for layout in ["compact", "elek2010"] {
        let day = shader(earth(), layout, &[[0.0, 1.0, 0.5, 0.0]], &[]);
        let brightest = |light: &[Vec<f64>]| light.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
        let lowest = -0.2857142857142857;
        let dusk: Vec<[f64; 4]> = (0..20).map(|k| [0.0, 0.3, lowest + 1e-5 * f64::from(k), 0.0]).collect();
        let night: Vec<[f64; 4]> = (1..20).map(|k| [0.0, 0.3, lowest - 1e-5 * f64::from(k), 0.0]).collect();
        assert!(brightest(&shader(earth(), layout, &dusk, &[])) < 1e-6 * brightest(&day), "{layout}");
        assert_eq!(brightest(&shader(earth(), layout, &night, &[])), 0.0, "{layout}");
        let noon = |t: f64| [3e3, 0.2, libm::cos(0.01 * t), if t < 0.0 { 180.0 } else { 0.0 }];
        let (step, all) = steps(earth(), layout, noon);
        println!("{layout} noon: step {step:.1e} of {all:.1e}");
        assert!(step < 2e-3, "{layout}: a step of {step}");
    }
}
