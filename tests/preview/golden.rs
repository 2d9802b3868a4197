//! Pictures against those that a person looked at. The bake that they are drawn from lies beside them, so that they
//! change with the preview alone. To draw them anew, after looking at the new ones:
//! `TYNDALL_UPDATE_GOLDEN=1 cargo test --features preview --test preview golden`, which fails, so that no run that
//! changes them passes.

use super::pictures::{picture, read_png};
use super::run::gpu;
use std::path::{Path, PathBuf};

const WIDTH: usize = 96;
const HEIGHT: usize = 54;

/// A name, and what is drawn.
const PICTURES: [(&str, &str); 6] = [
    ("noon", "--sun 55 --azimuth 120 --exposure 14"),
    ("sunset", "--sun 3 --exposure 12.5"),
    ("twilight", "--sun -4 --exposure 5 --tone-mapping paper"),
    ("height", "--altitude 10000 --pitch -4 --sun 25 --azimuth 50 --exposure 13.5"),
    ("orbit", "--camera orbit --sun 35 --exposure 13.5"),
    (
        "water",
        "--water tropical --depth 3 --altitude 300 --field 80 --pitch -28 --sun 40 --azimuth 25 --exposure 13",
    ),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/preview")
}

fn draw(arguments: &str) -> Vec<u8> {
    let bake = folder().join("bake");
    picture(bake.to_str().unwrap(), &format!("--size {WIDTH}x{HEIGHT} {arguments}")).2
}

fn linear(byte: u8) -> f64 {
    let c = f64::from(byte) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { libm::pow((c + 0.055) / 1.055, 2.4) }
}

/// Mean of the linear values of squares of 6 × 6 pixels, a channel each.
fn blocks(bytes: &[u8]) -> Vec<f64> {
    let mut sums = vec![0.0; (WIDTH / 6) * (HEIGHT / 6) * 3];
    for (k, byte) in bytes.iter().enumerate() {
        let (x, y) = (k / 3 % WIDTH, k / 3 / WIDTH);
        sums[3 * (y / 6 * (WIDTH / 6) + x / 6) + k % 3] += linear(*byte) / 36.0;
    }
    sums
}

/// Root of the mean square over the blocks of the difference over the value, for blocks that are neither black nor
/// white.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    let (a, b) = (blocks(a), blocks(b));
    let pairs: Vec<f64> = a
        .iter()
        .zip(&b)
        .filter(|(_, b)| (0.02..0.9).contains(*b))
        .map(|(a, b)| (a / b - 1.0) * (a / b - 1.0))
        .collect();
    assert!(pairs.len() > 30, "{} blocks are neither black nor white", pairs.len());
    (pairs.iter().sum::<f64>() / pairs.len() as f64).sqrt()
}

/// What two GPUs may differ by: the steps of their filters, 1/256 of the difference of two texels, and rounding.
const TOLERANCE: f64 = 0.006;

#[test]
fn golden_pictures_are_drawn_again() {
    if !gpu() {
        return;
    }
    let update = std::env::var_os("TYNDALL_UPDATE_GOLDEN").is_some();
    for (name, arguments) in PICTURES {
        let golden = folder().join(format!("{name}.png"));
        if update {
            let bake = folder().join("bake");
            let line = format!("--headless --out {} --size {WIDTH}x{HEIGHT} {arguments}", golden.display());
            let mut all = vec![bake.to_str().unwrap()];
            all.extend(line.split_whitespace());
            assert_eq!(super::run::preview(&all).code, Some(0));
            continue;
        }
        let off = difference(&draw(arguments), &read_png(&golden).2);
        assert!(off < TOLERANCE, "{name}: {off}");
    }
    assert!(!update, "golden pictures were drawn anew: look at them, commit them, and run again");
}

/// The tolerance is tight: a picture 2 % brighter is refused, and so are a star one degree higher and water 20 cm deeper.
#[test]
fn a_small_error_is_seen() {
    if !gpu() {
        return;
    }
    for (name, right, wrong) in [
        ("noon", "--exposure 14", "--exposure 13.9714"),
        ("height", "--exposure 13.5", "--exposure 13.4714"),
        ("orbit", "--sun 35", "--sun 36"),
        ("water", "--exposure 13", "--exposure 12.9714"),
        ("water", "--depth 3", "--depth 3.2"),
    ] {
        let arguments = PICTURES.iter().find(|p| p.0 == name).unwrap().1;
        let changed = arguments.replace(right, wrong);
        assert_ne!(changed, arguments);
        let off = difference(&draw(&changed), &read_png(&folder().join(format!("{name}.png"))).2);
        assert!(off > 1.5 * TOLERANCE, "{name} {wrong}: {off}");
    }
}
