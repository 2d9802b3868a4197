//! No seam where axes end, halves meet or formulas change: walks in small steps across each.

use super::run::*;

const STEPS: usize = 200;

/// The largest change of a step over the brightest light of the walk, and the change from end to end.
fn steps(bake: &str, layout: &str, view: impl Fn(f64) -> [f64; 4]) -> (f64, f64) {
    let views: Vec<[f64; 4]> = (0..=STEPS).map(|k| view(2.0 * k as f64 / STEPS as f64 - 1.0)).collect();
    let light = shader(bake, layout, &views, &[]);
    let brightest = light.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
    assert!(brightest > 0.0 && light.iter().flatten().all(|v| v.is_finite() && *v >= 0.0));
    let change = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs() / brightest).fold(0.0, f64::max);
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
        let walks: [(&str, &dyn Fn(f64) -> [f64; 4]); 4] = [
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
