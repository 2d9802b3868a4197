//! Pictures against numbers: what a pixel shows is what `tyndall sample` answers, exposed and tone-mapped.

use super::run::*;
use std::path::Path;

/// Width, height and RGB bytes of a picture by these arguments.
pub fn picture(bake: &str, arguments: &str) -> (usize, usize, Vec<u8>) {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("x.png");
    let mut all = vec![bake, "--headless", "--out", out.to_str().unwrap()];
    all.extend(arguments.split_whitespace());
    let done = preview(&all);
    assert_eq!(done.code, Some(0), "{arguments}: {}", done.err);
    read_png(&out)
}

pub fn read_png(path: &Path) -> (usize, usize, Vec<u8>) {
    let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    (info.width as usize, info.height as usize, bytes)
}

/// Byte of a linear value, IEC 61966-2-1.
pub fn coded(x: f64) -> f64 {
    let c = if x <= 0.0031308 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 };
    255.0 * c.clamp(0.0, 1.0)
}

/// One pixel, small so that the star is not in it, looks exactly where the camera does. Its bytes are 1 − exp(−E·L) of the answer of `sample`, coded, give
/// or take the dither's one step and rounding.
#[test]
fn a_pixel_shows_what_sample_answers() {
    if !gpu() {
        return;
    }
    let lux = constant(mars(), "star_illuminance_lx");
    let ev = 13.0;
    let exposure = libm::exp2(-ev) / 1.2;
    for (altitude, pitch, azimuth, sun) in
        [(2.0, 25.0, 40.0, 30.0), (2.0, 5.0, 150.0, 4.0), (9e3, -20.0, 90.0, 50.0), (5e6, -90.0, 0.0, 20.0)]
    {
        let radians = |degrees: f64| f64::to_radians(degrees);
        let views = [[altitude, libm::sin(radians(pitch)), libm::sin(radians(sun)), azimuth]];
        let light = sample(mars(), "elek2010", &views);
        let line = format!(
            "--layout elek2010 --size 1x1 --field 0.01 --tone-mapping paper --exposure {ev} --altitude {altitude} \
             --pitch {pitch} --azimuth {azimuth} --sun {sun}"
        );
        let (_, _, bytes) = picture(mars(), &line);
        for c in 0..3 {
            let wanted = coded(-libm::expm1(-light[0][c].max(0.0) * lux * exposure));
            assert!((f64::from(bytes[c]) - wanted).abs() < 1.6, "{line}: {bytes:?}, not {wanted} in {c}");
        }
    }
}

/// In pictures of some size rows that show sky alone are drawn by a pipeline of their own, and by slices; texels weighed
/// by hand are looked up in one piece in the tables themselves. Both show the same but for a step of 255: the camera looks
/// along the horizon, down across it, and at the ground alone. (Where the horizon's row is missed by a row, that row is
/// off by tens.)
#[test]
fn sky_and_ground_join() {
    if !gpu() {
        return;
    }
    for view in
        ["--altitude 2 --pitch 5", "--altitude 30000 --pitch -14 --azimuth 100", "--altitude 5 --pitch -50"]
    {
        let of = |how: &str| picture(mars(), &format!("{view} --size 400x300 --exposure 13 {how}")).2;
        let (a, b) = (of(""), of("--hand-filtered"));
        let off: Vec<u8> = a.iter().zip(&b).map(|(a, b)| a.abs_diff(*b)).collect();
        let many = off.iter().filter(|v| **v > 0).count() as f64 / off.len() as f64;
        assert!(off.iter().all(|v| *v <= 2) && many < 0.2, "{view}: {:?}, {many}", off.iter().max());
    }
}

/// Linear RGB over the star's illuminance of what `sample` answers in a layout.
fn colour(bake: &str, layout: &str, light: &[f64]) -> Vec<f64> {
    if layout == "elek2010" {
        return light.to_vec();
    }
    let text = std::fs::read_to_string(Path::new(bake).join("bake.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    let lux = constant(bake, "star_illuminance_lx");
    let rows = manifest["colour"]["matrices"]["rgb_from_four"].as_array().unwrap();
    let dot = |row: &serde_json::Value| (0..4).map(|k| row[k].as_f64().unwrap() * light[k]).sum::<f64>();
    rows.iter().map(|row| dot(row) / lux).collect()
}

/// Light that a mean byte shows, undoing the display's code and 1 − exp(−x).
fn exposed(byte: f64) -> f64 {
    let x = byte / 255.0;
    let linear = if x <= 0.04045 { x / 12.92 } else { libm::pow((x + 0.055) / 1.055, 2.4) };
    -libm::log1p(-linear)
}

/// A frame finds its light in other ways than `--points` does: inside the air by slices that are weighed once a frame. Its
/// 64 x 64 pixels look within a hundredth of a degree, and their dither averages out, so that it can be held against
/// `sample` to 0.2 % of the brightest channel, as `--points` is; both see the sky and the ground, high and low, from
/// inside and from space, by day and in twilight.
#[test]
fn frames_answer_what_sample_answers() {
    if !gpu() {
        return;
    }
    for (bake, layout) in
        [(earth(), "compact"), (earth(), "elek2010"), (mars(), "compact"), (mars(), "elek2010")]
    {
        let lux = constant(bake, "star_illuminance_lx");
        for (altitude, pitch, azimuth, sun) in [
            (2.0, 25.0, 40.0, 30.0),
            (2.0, 1.5, 160.0, 4.0),
            (2.0, 8.0, 20.0, -3.0),
            (9e3, -20.0, 90.0, 50.0),
            (3e4, -3.0, 75.0, 12.0),
            (5e6, -88.0, 10.0, 20.0),
        ] {
            let sine = |degrees: f64| libm::sin(f64::to_radians(degrees));
            let light = sample(bake, layout, &[[altitude, sine(pitch), sine(sun), azimuth]]);
            let wanted: Vec<f64> = colour(bake, layout, &light[0]).iter().map(|v| v * lux).collect();
            let brightest = wanted.iter().fold(0.0, |m: f64, v| m.max(*v));
            let exposure = 0.7 / brightest;
            let ev = -libm::log2(1.2 * exposure);
            let line = format!(
                "--layout {layout} --size 64x64 --field 0.01 --tone-mapping paper --exposure {ev:.12} --altitude \
                 {altitude} --pitch {pitch} --azimuth {azimuth} --sun {sun}"
            );
            let (_, _, bytes) = picture(bake, &line);
            for c in 0..3 {
                let sum: f64 = bytes.iter().skip(c).step_by(3).map(|&v| f64::from(v)).sum();
                let found = exposed(sum / 4096.0) / exposure;
                let off = (found - wanted[c].max(0.0)) / brightest;
                println!("{bake} {line}: channel {c} off by {off:.1e}");
                assert!(off.abs() < 2e-3, "{bake} {line}: {found}, not {} in {c}", wanted[c]);
            }
        }
    }
}

/// The dither is the same in every run, and the layouts show the same sky: their means differ by a few of 255 at most
/// (coarse tables, and the paper's layout has another medium).
#[test]
fn pictures_are_reproducible_and_layouts_alike() {
    if !gpu() {
        return;
    }
    let line = "--size 64x36 --sun 40 --azimuth 100 --exposure 14";
    let a = picture(earth(), line);
    assert_eq!(a, picture(earth(), line));
    let b = picture(earth(), &format!("{line} --layout elek2010"));
    let mean = |p: &[u8]| p.iter().map(|&v| f64::from(v)).sum::<f64>() / p.len() as f64;
    assert!(mean(&a.2) > 40.0 && (mean(&a.2) - mean(&b.2)).abs() < 12.0, "{} {}", mean(&a.2), mean(&b.2));
}

/// The disc covers π r² pixels, r its angular radius over the angle of a pixel, and is the brightest thing there is.
#[test]
fn the_disc_has_its_size() {
    if !gpu() {
        return;
    }
    let radius = constant(earth(), "star_angular_radius_rad").to_degrees();
    let field = 8.0 * radius;
    let line =
        format!("--size 65x65 --sun 50 --pitch 50 --field {field} --exposure 30.5 --tone-mapping paper");
    let (_, _, bytes) = picture(earth(), &line);
    // Pixels on the edge are covered in part: the radius is counted to within three quarters of one.
    let bright = bytes.chunks(3).filter(|p| p[1] > 60).count() as f64;
    let counted = (bright / std::f64::consts::PI).sqrt();
    assert!((counted - 65.0 / 8.0).abs() < 0.75, "{bright} pixels, radius {counted}");
    // The limb's law: the edge is darker than the middle.
    let green = |x: usize| bytes[3 * (32 * 65 + x) + 1];
    assert!(green(32) > green(26) && green(26) > green(25).min(200), "{} {}", green(32), green(26));
}

/// A fisheye has nothing in its corners; the planet from orbit is lit in the middle, with space around it.
#[test]
fn what_lies_outside_is_black() {
    if !gpu() {
        return;
    }
    for camera in ["fisheye", "orbit"] {
        let (width, height, bytes) = picture(earth(), &format!("--camera {camera} --size 48x48 --sun 60"));
        let at = |x: usize, y: usize| bytes[3 * (y * width + x)..][..3].iter().copied().max().unwrap();
        assert!(at(width / 2, height / 2) > 30, "{camera}");
        assert!([at(0, 0), at(47, 0), at(0, 47), at(47, 47)].iter().all(|v| *v <= 1), "{camera}");
    }
}

/// The marches find from the preset's numbers what a bake of one order holds: sky, haze and lit ground. What is left, in
/// the mean over a picture, is that of coarse tables: half a step of 255 where it was measured. Both marches agree better.
#[test]
fn marches_find_the_light_scattered_once() {
    if !gpu() {
        return;
    }
    for view in [
        "--sun 35 --azimuth 90",
        "--altitude 8000 --pitch -20 --sun 50 --azimuth 120",
        "--camera orbit --sun 50",
    ] {
        let of =
            |method: &str| picture(earth_once(), &format!("{view} --size 24x14 --exposure 14 {method}")).2;
        let (table, march, march_2d) =
            (of(""), of("--method march --steps 200x60"), of("--method march2d --steps 200x1"));
        let apart = |a: &[u8], b: &[u8]| {
            let off: Vec<f64> = a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).collect();
            off.iter().sum::<f64>() / off.len() as f64
        };
        println!("{view}: march {:.2}, 2D table {:.2}", apart(&march, &table), apart(&march_2d, &march));
        assert!(table.iter().any(|v| *v > 60));
        assert!(apart(&march_2d, &march) < 0.5, "{view}: {}", apart(&march_2d, &march));
        assert!(apart(&march, &table) < 1.5, "{view}: {}", apart(&march, &table));
    }
}
