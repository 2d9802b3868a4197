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
