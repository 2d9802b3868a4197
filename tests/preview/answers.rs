//! The shaders that engines copy against the same look-ups in double precision.

use super::run::*;
use sobol_burley::sample as sobol;

/// Views as single precision holds them: on the ground, in the air (half of them low), and outside the shell, all
/// directions, the sun from the zenith to below the tables' end.
fn views(count: u32, height: f64) -> Vec<[f64; 4]> {
    let view = |k: u32| {
        let u = |dimension: u32| f64::from(sobol(k, dimension, 7));
        let altitude = match k % 8 {
            0 => 0.0,
            1..=3 => height * libm::pow(u(0), 4.0),
            4..=6 => height * u(0),
            _ => height * (1.0 + 40.0 * u(0)),
        };
        // Outside, most directions miss the planet: half of them are led to it.
        let mu = if k % 16 == 7 { -1.0 + 0.3 * u(1) } else { 2.0 * u(1) - 1.0 };
        let rounded = [altitude, mu, -0.4 + 1.4 * u(2), 0.0].map(|v| f64::from(v as f32));
        [rounded[0], rounded[1], rounded[2], 360.0 * u(3)]
    };
    (0..count).map(view).collect()
}

/// The largest difference over the view's brightest channel, and the view.
pub fn worst(a: &[Vec<f64>], b: &[Vec<f64>]) -> (f64, usize) {
    let brightest = b.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
    let of_view = |(a, b): (&Vec<f64>, &Vec<f64>)| {
        // Less than the night glows by itself (2e-8 of the day) is no light; there logarithms fall by twenty a texel.
        let scale = b.iter().fold(1e-8 * brightest, |m: f64, v| m.max(v.abs()));
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).abs() / scale)
            .fold(0.0, |m, e| if e > m || e.is_nan() { e } else { m })
    };
    let errors: Vec<f64> = a.iter().zip(b).map(of_view).collect();
    let k = (0..errors.len()).max_by(|i, j| errors[*i].total_cmp(&errors[*j])).unwrap();
    (errors[k], k)
}

/// Texture units weigh texels in steps of their own, 1/256 on most GPUs and finer in software; beyond that both
/// read the same halves, so that only the rounding of single precision is left: 0.2 % is many times that.
#[test]
fn shaders_answer_what_sample_answers() {
    if !gpu() {
        return;
    }
    for (bake, height) in [(earth(), 66e3), (mars(), 100e3), (thick(), 65e3)] {
        let views = views(1500, height);
        for layout in ["compact", "elek2010"] {
            let wanted = sample(bake, layout, &views);
            assert!(wanted.iter().filter(|v| v[1] > 0.0).count() > 1000, "most views see light");
            for more in [&[][..], &["--hand-filtered"]] {
                let (error, k) = worst(&shader(bake, layout, &views, more), &wanted);
                println!("{bake} {layout} {more:?}: worst {error:.2e} at {:?}", views[k]);
                assert!(error < 2e-3, "{bake} {layout} {more:?}: {error} at {:?}: {:?}", views[k], wanted[k]);
            }
        }
    }
}
