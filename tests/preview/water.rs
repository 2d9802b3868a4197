//! Water where the ground is: its shader against the same look-ups in double precision, and what a pixel shows of it.

use super::answers::worst;
use super::pictures::{coded, picture};
use super::run::*;
use sobol_burley::sample as sobol;

/// Views as single precision holds them that meet the water: from the surface, from within the air and from far away,
/// the sun from the zenith to below the tables' end. Angles to the surface are all that single precision tells apart:
/// the square of their cosine comes from a difference of squares of lengths, so that three digits of it are left down to
/// a cosine of 0.003 from within the air and of 0.01 from beyond it.
fn views(count: u32, ground: f64, height: f64) -> Vec<[f64; 4]> {
    let view = |k: u32| {
        let u = |dimension: u32| f64::from(sobol(k, dimension, 11));
        let altitude = match k % 8 {
            0 => 0.0,
            1..=3 => height * libm::pow(u(0), 4.0),
            4..=6 => height * u(0),
            _ => height * (1.0 + 40.0 * u(0)),
        };
        // The cosine at the surface is spread evenly; that at the observer follows from the law of sines.
        let flattest = [0.0, 0.003, 0.01][usize::from(altitude > 0.0) + usize::from(altitude > height)];
        let at_surface = 1.0 - (1.0 - flattest) * u(1);
        let share = ground / (ground + altitude);
        let mu = -(1.0 - share * share * (1.0 - at_surface * at_surface)).sqrt();
        let rounded = [altitude, mu, -0.4 + 1.4 * u(2), 0.0].map(|v| f64::from(v as f32));
        [rounded[0], rounded[1], rounded[2], 360.0 * u(3)]
    };
    (0..count).map(view).collect()
}

/// As for the sky's answers: only what single precision and the steps of texture units leave. Both layouts find the same,
/// since a water's tables are its own.
#[test]
fn shaders_answer_what_sample_answers_of_water() {
    if !gpu() {
        return;
    }
    let bake = wet();
    let ground = constant(bake, "ground_radius_m");
    let views = views(1200, ground, constant(bake, "top_radius_m") - ground);
    for water in ["clear-ocean", "muddy"] {
        for depth in ["0", "0.3", "12", "100"] {
            let wanted = sample_water(bake, water, depth, &views);
            assert!(wanted.iter().filter(|v| v[1] > 0.0).count() > 800, "most views see light");
            for (layout, hand) in
                [("compact", None), ("compact", Some("--hand-filtered")), ("elek2010", None)]
            {
                let mut more = vec!["--water", water, "--depth", depth];
                more.extend(hand);
                let (error, k) = worst(&shader(bake, layout, &views, &more), &wanted);
                println!("{water} {depth} m {layout} {hand:?}: worst {error:.2e} at {:?}", views[k]);
                assert!(error < 2e-3, "{water} {depth} m: {error} at {:?}: {:?}", views[k], wanted[k]);
            }
        }
    }
}

/// Across the nadir, the shell's top and the sun's rise over the water in 200 steps: smooth light changes by some
/// hundredths of its brightest in a step at most, by less than a thousandth where nothing but the view turns.
#[test]
fn water_has_no_seams() {
    if !gpu() {
        return;
    }
    let bake = wet();
    let height = constant(bake, "top_radius_m") - constant(bake, "ground_radius_m");
    let nadir = |t: f64| [3e3, -libm::cos(0.01 * t), 0.4, if t < 0.0 { 180.0 } else { 0.0 }];
    let top = |t: f64| [height + 5.0 * t, -0.5, 0.4, 60.0];
    let rise = |t: f64| [0.0, -0.4, 0.05 * t, 60.0];
    for (name, bound, walk) in
        [("nadir", 1e-3, &nadir as &dyn Fn(f64) -> [f64; 4]), ("top", 1e-3, &top), ("rise", 0.03, &rise)]
    {
        let views: Vec<[f64; 4]> = (0..=200).map(|k| walk(f64::from(k) / 100.0 - 1.0)).collect();
        let light = shader(bake, "compact", &views, &["--water", "clear-ocean", "--depth", "5"]);
        let brightest = light.iter().flatten().fold(0.0, |m: f64, v| m.max(*v));
        let change = |w: &[Vec<f64>]| w[0].iter().zip(&w[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let step = light.windows(2).map(change).fold(0.0, f64::max) / brightest;
        println!("{name}: step {step:.1e}");
        assert!(brightest > 0.0 && step < bound, "{name}: a step of {step}");
    }
}

/// A view that never meets the water has no answer: one line, as of `sample`.
#[test]
fn a_view_that_misses_the_water_is_named() {
    if !gpu() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let path = write_points(dir.path(), &[[0.0, -0.5, 0.5, 0.0], [0.0, 0.1, 0.5, 0.0]]);
    let done = preview(&[wet(), "--points", &path, "--water", "muddy"]);
    assert_eq!(done.code, Some(2), "{}", done.err);
    assert!(done.err.contains("mu_view 0.1") && done.err.trim_end().lines().count() == 1, "{}", done.err);
}

/// Fresnel's reflectance of unpolarised light.
fn fresnel(mu: f64, n: f64) -> f64 {
    let inside = (1.0 - (1.0 - mu * mu) / (n * n)).sqrt();
    let (s, p) = ((mu - n * inside) / (mu + n * inside), (n * mu - inside) / (n * mu + inside));
    0.5 * (s * s + p * p)
}

fn matrix(bake: &str, name: &str) -> Vec<Vec<f64>> {
    serde_json::from_value(manifest(bake)["colour"]["matrices"][name].clone()).unwrap()
}

fn times(rows: &[Vec<f64>], light: &[f64]) -> Vec<f64> {
    rows.iter().map(|row| row.iter().zip(light).map(|(a, b)| a * b).sum()).collect()
}

/// With no air between, a pixel shows what `sample --water` says leaves the water and, of what `sample` says of the
/// mirrored view, the share that Fresnel's equations give: steep and flat, towards the sun and away.
#[test]
fn a_pixel_of_water_shows_what_leaves_it_and_what_it_mirrors() {
    if !gpu() {
        return;
    }
    let (bake, ev) = (wet(), 12.0);
    let exposure = libm::exp2(-ev) / 1.2;
    let n = constant(bake, "water_clear-ocean_refractive_index_at_four");
    for (pitch, azimuth, sun) in [(-60.0, 40.0, 30.0), (-12.0, 150.0, 20.0), (-3.0, 90.0, 50.0)] {
        let sine = |degrees: f64| libm::sin(f64::to_radians(degrees));
        let down = [[0.0, sine(pitch), sine(sun), azimuth]];
        let up = [[0.0, -sine(pitch), sine(sun), azimuth]];
        let leaving = &sample_water(bake, "clear-ocean", "4", &down)[0];
        let leaving = times(&matrix(bake, "water_clear-ocean_rgb_from_four"), leaving);
        let sky = times(&matrix(bake, "rgb_from_four"), &sample(bake, "compact", &up)[0]);
        let line = format!(
            "--water clear-ocean --depth 4 --size 1x1 --field 0.01 --tone-mapping paper --exposure {ev} --altitude 0 \
             --pitch {pitch} --azimuth {azimuth} --sun {sun}"
        );
        let (_, _, bytes) = picture(bake, &line);
        for c in 0..3 {
            let light = leaving[c] + fresnel(-sine(pitch), n) * sky[c];
            let wanted = coded(-libm::expm1(-light.max(0.0) * exposure));
            println!("{line}: {bytes:?}, {wanted:.1} in {c}");
            // The dither's step, rounding, and the half digits of Fresnel's table.
            assert!((f64::from(bytes[c]) - wanted).abs() < 1.8, "{line}: {bytes:?}, not {wanted} in {c}");
        }
    }
}

/// The star's image lies as far below the horizon as the star above it, as large as the star and upside down; nothing
/// else there is as bright. From afar, where a pixel spans many suns, its image is still there, spread.
#[test]
fn the_star_is_mirrored_where_it_should_be() {
    if !gpu() {
        return;
    }
    let radius = constant(wet(), "star_angular_radius_rad").to_degrees();
    let field = 8.0 * radius;
    let line = format!(
        "--water muddy --size 65x65 --sun 25 --pitch -25 --field {field} --exposure 25 --tone-mapping paper"
    );
    let (_, _, bytes) = picture(wet(), &line);
    let bright = bytes.chunks(3).filter(|p| p[1] > 60).count() as f64;
    let counted = (bright / std::f64::consts::PI).sqrt();
    // As the star itself: the radius is counted to within three quarters of a pixel.
    assert!((counted - 65.0 / 8.0).abs() < 0.75, "{bright} pixels, radius {counted}");

    let brightest = |water: &str| {
        let line = format!("--camera orbit --sun 60 --size 64x64 --exposure 15 {water}");
        picture(wet(), &line).2.into_iter().max().unwrap()
    };
    assert!(brightest("--water muddy") > 200 && brightest("") < 200, "{}", brightest(""));
}

/// Where relief is level there is sea, and mountains stay what they are: the picture differs from that of land below the
/// horizon only, and there not everywhere.
#[test]
fn relief_rises_from_the_sea() {
    if !gpu() {
        return;
    }
    let line = "--relief --altitude 1500 --sun 30 --azimuth 70 --pitch 0 --size 64x36 --exposure 13";
    let land = picture(wet(), line).2;
    let sea = picture(wet(), &format!("{line} --water clear-ocean")).2;
    let differs: Vec<bool> = land.chunks(3).zip(sea.chunks(3)).map(|(a, b)| a != b).collect();
    assert!(differs[..64 * 12].iter().all(|d| !d), "the sky is the same");
    let below = &differs[64 * 20..];
    let share = below.iter().filter(|d| **d).count() as f64 / below.len() as f64;
    assert!((0.05..0.98).contains(&share), "{share} of what lies below the horizon");
}
