//! The shaders on tables for a part of altitudes, suns and views, against the same look-ups in double precision.

use super::run::*;
use sobol_burley::sample as sobol;
use std::path::{Path, PathBuf};

fn bake(name: &str, options: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("preview-window-{name}"));
    let line = format!("bake earth --quiet --wavelengths 5 --orders 3 {options} --out {}", folder.display());
    let done = tyndall(&line.split_whitespace().collect::<Vec<_>>());
    assert_eq!(done.code, Some(0), "{}", done.err);
    folder.join("earth")
}

/// Views inside ranges of altitude, sun and view (cosines), as single precision holds them.
fn views(altitude: [f64; 2], sun: [f64; 2], view: [f64; 2]) -> Vec<[f64; 4]> {
    let between = |[low, high]: [f64; 2], u: f64| f64::from((low + (high - low) * u) as f32);
    let one = |k: u32| {
        let u = |dimension: u32| 0.001 + 0.998 * f64::from(sobol(k, dimension, 11));
        let sine = |degrees: f64| libm::sin(degrees.to_radians());
        [between(altitude, u(0)), between(view, u(1)), between(sun.map(sine), u(2)), 360.0 * u(3)]
    };
    (0..400).map(one).collect()
}

/// Shaders and `tyndall sample` agree on a window, on tables of a single altitude, sun or azimuth, on the sky alone, and
/// with a constituent folded away; beyond the window both hold what is nearest, so that a frame has no hole.
#[test]
fn shaders_read_windows() {
    if !gpu() {
        return;
    }
    let sizes = "--size compact=4x16x7x5 --size compact-single=5x16x8x4 --size elek2010=4x16x7x5";
    let window = bake("part", &format!("{sizes} --altitudes 0..3km --suns -5..50 --fold air"));
    let sizes = "--size compact=1x13x1x5 --size compact-single=1x11x1x1 --size elek2010=1x12x1x4";
    let point = bake("point", &format!("{sizes} --altitudes 2m --suns 35 --views sky --without scatterers"));
    let sizes = "--size compact=1x12x9x1 --size compact-single=1x12x9x3 --size compact-transmittance=2x40";
    let orbit = bake("orbit", &format!("{sizes} --altitudes 400km --layout compact"));
    let both = ["compact", "elek2010"];
    let cases = [
        (&window, &both[..], [[0.0, 3e3], [-5.0, 50.0], [-1.0, 1.0]]),
        (&point, &both[..], [[2.0, 2.0], [35.0, 35.0], [0.001, 1.0]]),
        (&orbit, &both[..1], [[3e5, 9e5], [-10.0, 90.0], [-1.0, -0.3]]),
    ];
    for (bake, layouts, [altitude, sun, view]) in cases {
        let (bake, views) = (bake.to_str().unwrap(), views(altitude, sun, view));
        for layout in layouts {
            let wanted = sample(bake, layout, &views);
            let brightest = wanted.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
            assert!(wanted.iter().filter(|v| v[1] > 1e-6 * brightest).count() > 200, "{bake} {layout}");
            for more in [&[][..], &["--hand-filtered"]] {
                for ((found, wanted), view) in
                    shader(bake, layout, &views, more).iter().zip(&wanted).zip(&views)
                {
                    let scale = wanted.iter().fold(1e-8 * brightest, |m: f64, v| m.max(v.abs()));
                    let off =
                        found.iter().zip(wanted).map(|(f, w)| (f - w).abs() / scale).fold(0.0, f64::max);
                    assert!(off < 2e-3, "{bake} {layout} {more:?} {view:?}: {found:?} for {wanted:?}");
                }
            }
        }
    }
    let beyond = [[9000.0, 0.5, 0.9, 20.0], [0.0, -0.5, 0.1, 0.0]];
    let answers = shader(point.to_str().unwrap(), "compact", &beyond, &[]);
    assert!(answers.iter().flatten().all(|v| v.is_finite() && *v >= 0.0), "{answers:?}");
}
