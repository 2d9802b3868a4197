//! Pictures of a sky, straight from its radiance: panels, tone-mapped as in the paper, and sheets of them.

use super::sheet::Panel;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Linear RGB in a direction (a unit vector at the observer: z up, x towards the sun's azimuth); `None` where
/// there is nothing to see.
pub trait Radiance: Fn([f64; 3]) -> Option<[f64; 3]> + Sync {}
impl<F: Fn([f64; 3]) -> Option<[f64; 3]> + Sync> Radiance for F {}

/// How much light a panel lets in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    Fixed(f64),
    /// Four fifths of the pixels end below 0.7 (linear); rounded to two digits, so that a label can state it. No more
    /// than `MOST`.
    Auto,
}

/// The most that a panel lets in by itself: light millions of times fainter than a day's is no more than the residual
/// of the solver, and is left black.
const MOST: f64 = 1e7;

/// Pixels that no display can show: not a number, infinite, or negative.
pub const ERROR_COLOUR: [u8; 3] = [255, 0, 255];
/// Outside the panel's circle, and where the radiance is `None`.
const EMPTY_COLOUR: [u8; 3] = [0, 0, 0];

/// The sky above: zenith in the middle, horizon on the circle, equal steps of zenith angle. The sun's azimuth
/// is at the top, +y at the right, as the sky is seen from below.
pub fn fisheye(size: usize, label: &str, exposure: Exposure, radiance: impl Radiance) -> Panel {
    panel(size, label, exposure, |[right, up]| {
        let rho = (right * right + up * up).sqrt();
        let direction = || {
            let scale = if rho > 0.0 { libm::sin(rho * FRAC_PI_2) / rho } else { 0.0 };
            [up * scale, right * scale, libm::cos(rho * FRAC_PI_2)]
        };
        (rho <= 1.0).then(direction).and_then(&radiance)
    })
}

/// The planet below, from an observer outside its atmosphere: perspective, nadir in the middle, the shell of
/// radius `r_top` just inside the panel. The sun's azimuth is at the right.
///
/// `r_observer` must be larger than `r_top`, both in the same unit.
pub fn from_space(
    size: usize,
    label: &str,
    exposure: Exposure,
    [r_observer, r_top]: [f64; 2],
    radiance: impl Radiance,
) -> Panel {
    // The tangent of the angle between nadir and the shell's limb, and a margin.
    let reach = 1.05 * r_top / (r_observer * r_observer - r_top * r_top).sqrt();
    panel(size, label, exposure, |[right, up]| {
        let (x, y) = (right * reach, up * reach);
        let length = (1.0 + x * x + y * y).sqrt();
        radiance([x / length, y / length, -1.0 / length])
    })
}

/// A square panel of `size` pixels; `look` gets a pixel's place, -1 to 1 to the right and up.
fn panel(
    size: usize,
    label: &str,
    exposure: Exposure,
    look: impl Fn([f64; 2]) -> Option<[f64; 3]> + Sync,
) -> Panel {
    let place = |pixel: usize| (2 * pixel + 1) as f64 / size as f64 - 1.0;
    let rows: Vec<Vec<Option<[f64; 3]>>> = (0..size)
        .into_par_iter()
        .map(|row| (0..size).map(|column| look([place(column), -place(row)])).collect())
        .collect();
    let exposure = match exposure {
        Exposure::Fixed(exposure) => exposure,
        Exposure::Auto => automatic(&rows),
    };
    let tone = Tone::new(exposure);
    let pixels: Vec<Vec<u8>> =
        rows.par_iter().map(|row| row.iter().flat_map(|&rgb| tone.pixel(rgb)).collect()).collect();
    let errors = rows.iter().flatten().flatten().filter(|rgb| !displayable(rgb)).count();
    let label = format!("{label} E={exposure:.2e}");
    Panel { label, exposure, size: [size, size], rgb: pixels.concat(), errors }
}

fn displayable(rgb: &[f64; 3]) -> bool {
    rgb.iter().all(|v| v.is_finite() && *v >= 0.0)
}

fn automatic(rows: &[Vec<Option<[f64; 3]>>]) -> f64 {
    let seen = rows.iter().flatten().flatten().filter(|rgb| displayable(rgb));
    let mut largest: Vec<f64> = seen.map(|rgb| rgb[0].max(rgb[1]).max(rgb[2])).filter(|v| *v > 0.0).collect();
    largest.sort_by(f64::total_cmp);
    let Some(&high) = largest.get(largest.len() * 4 / 5) else { return 1.0 };
    // 1 - exp(-1.2) = 0.7.
    format!("{:.1e}", (1.2 / high).min(MOST)).parse().unwrap_or(1.0)
}

/// From radiance to a byte: 1 - exp(-exposure · radiance) (Elek & Kmoch 2010, section 5), then the transfer
/// function of sRGB (IEC 61966-2-1). Both rise, so that a byte is found by bisecting the 255 radiances at which
/// it changes, without a transcendental function a pixel.
struct Tone {
    steps: Vec<f64>,
}

impl Tone {
    fn new(exposure: f64) -> Self {
        let step = |byte: u32| -libm::log1p(-srgb_to_linear((f64::from(byte) - 0.5) / 255.0)) / exposure;
        Tone { steps: (1..=255).map(step).collect() }
    }

    fn pixel(&self, rgb: Option<[f64; 3]>) -> [u8; 3] {
        match rgb {
            None => EMPTY_COLOUR,
            Some(rgb) if !displayable(&rgb) => ERROR_COLOUR,
            Some(rgb) => rgb.map(|v| self.steps.partition_point(|step| *step <= v) as u8),
        }
    }
}

fn srgb_to_linear(value: f64) -> f64 {
    if value <= 0.04045 { value / 12.92 } else { libm::pow((value + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixel(panel: &Panel, column: usize, row: usize) -> [u8; 3] {
        let at = 3 * (row * panel.size[0] + column);
        [panel.rgb[at], panel.rgb[at + 1], panel.rgb[at + 2]]
    }

    /// The bytes are those of the two formulas written out: bisection is only faster.
    #[test]
    fn bytes_follow_the_papers_curve_and_srgb() {
        let tone = Tone::new(0.3);
        for k in 0..20_000 {
            let radiance = f64::from(k) * 1e-3;
            let linear = 1.0 - libm::exp(-0.3 * radiance);
            let curve = 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055;
            let encoded = if linear <= 0.0031308 { 12.92 * linear } else { curve };
            let expected = (255.0 * encoded).round() as u8;
            let [got, _, _] = tone.pixel(Some([radiance; 3]));
            // The two branches of sRGB meet only to five digits, so that a value near a half may go either way.
            let undecided = ((255.0 * encoded).fract() - 0.5).abs() < 1e-3;
            assert!(got == expected || undecided && got.abs_diff(expected) == 1, "{radiance}");
        }
        // Half of full light is byte 188 in sRGB, as every table of it says.
        assert_eq!(tone.pixel(Some([libm::log(2.0) / 0.3; 3])), [188; 3]);
    }

    /// Radiance that is just the direction: the middle sees the zenith, the top the sun's azimuth.
    #[test]
    fn a_fisheye_has_the_zenith_in_the_middle_and_the_sun_on_top() {
        let panel = fisheye(65, "", Exposure::Fixed(9.0), |d| {
            let length = d.iter().map(|v| v * v).sum::<f64>();
            assert!((length - 1.0).abs() < 1e-12 && d[2] >= -1e-12, "{d:?}");
            Some(d.map(|v| v.max(0.0)))
        });
        assert_eq!(pixel(&panel, 32, 32), [0, 0, 255]);
        let [sunward, sideways, up] = pixel(&panel, 32, 0);
        assert!(sunward > 250 && sideways == 0 && up < 140);
        assert!(pixel(&panel, 64, 32)[1] > 250);
        assert_eq!(pixel(&panel, 0, 0), EMPTY_COLOUR);
        assert_eq!(panel.errors, 0);
    }

    /// Seen from three radii, a shell's limb is at sin 1/3 from nadir, 1/1.05 of the way to the edge.
    #[test]
    fn a_planet_from_space_fills_the_panel_to_its_margin() {
        let hits = |d: [f64; 3]| -d[2] >= (1.0f64 - 1.0 / 9.0).sqrt();
        let panel = from_space(201, "", Exposure::Fixed(1.0), [3.0, 1.0], |d| hits(d).then_some([9.0; 3]));
        let lit = (0..201).filter(|&column| pixel(&panel, column, 100) != EMPTY_COLOUR).count();
        assert!(lit.abs_diff(191) <= 1, "{lit} of 201 pixels, expected 201 / 1.05");
    }

    /// What cannot be shown is shown as what it is, and counted: not a number, infinite, or out of gamut.
    #[test]
    fn impossible_pixels_are_magenta_and_counted() {
        for bad in [f64::NAN, f64::INFINITY, -1e-9] {
            let panel = from_space(3, "", Exposure::Auto, [3.0, 1.0], |_| Some([0.5, bad, 0.5]));
            assert_eq!((panel.errors, pixel(&panel, 1, 1)), (9, ERROR_COLOUR), "{bad}");
        }
    }

    /// Brightness of equal amount everywhere is shown as 0.7, whatever its unit, to the two digits of E.
    #[test]
    fn automatic_exposure_follows_the_radiance_and_is_stated() {
        for radiance in [3e-7, 0.1, 4e9] {
            let panel = from_space(8, "x", Exposure::Auto, [3.0, 1.0], |_| Some([radiance; 3]));
            assert!(pixel(&panel, 4, 4)[0].abs_diff(218) <= 3, "0.7 in sRGB is 218");
            let stated: f64 = panel.label.strip_prefix("x E=").unwrap().parse().unwrap();
            assert!((stated * radiance / 1.2 - 1.0).abs() < 0.05, "{}", panel.label);
        }
    }
}
