//! Chromatic adaptation: the colours that an eye used to one white takes for those seen under another.

use super::colour_space::{ColourSpace, invert, multiply, white_of};
use super::{D65, chromaticity};
use crate::error::Result;
use serde::{Deserialize, Serialize};

/// The cone responses in which a white is scaled to the other (von Kries).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", value(rename_all = "lowercase"))]
pub enum Adaptation {
    /// Lam 1985, as ICC profiles have it.
    Bradford,
    /// CIECAM02 (CIE 159:2004).
    Cat02,
}

impl Adaptation {
    /// XYZ to cone responses.
    fn cones(self) -> [[f64; 3]; 3] {
        match self {
            Adaptation::Bradford => {
                [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
            }
            Adaptation::Cat02 => {
                [[0.7328, 0.4296, -0.1624], [-0.7036, 1.6975, 0.0061], [0.0030, 0.0136, 0.9834]]
            }
        }
    }

    /// XYZ under the white `from` to XYZ under the white `to` (both at Y = 1): `from` becomes `to`.
    pub fn matrix(self, from: [f64; 3], to: [f64; 3]) -> [[f64; 3]; 3] {
        let cones = self.cones();
        let (a, b) = (multiply(&cones, from), multiply(&cones, to));
        let scaled = std::array::from_fn(|r| cones[r].map(|v| v * b[r] / a[r]));
        product(&invert(&cones), &scaled)
    }
}

fn product(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    a.map(|row| std::array::from_fn(|c| (0..3).map(|k| row[k] * b[k][c]).sum()))
}

/// A white that is to become that of the colour space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum White {
    /// Of this chromaticity.
    Xy([f64; 2]),
    /// The light of the planet's star, above the air.
    Star,
}

impl White {
    /// By the name of an illuminant, `star`, or a chromaticity `x,y`.
    pub fn parse(text: &str) -> Result<White> {
        if text == "star" {
            return Ok(White::Star);
        }
        if let Some((_, xy)) = ILLUMINANTS.iter().find(|i| i.0.eq_ignore_ascii_case(text)) {
            return Ok(White::Xy(*xy));
        }
        let numbers: Option<Vec<f64>> = text.split(',').map(|t| t.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y]) if x > 0.0 && y > 0.01 && x + y < 1.0 => Ok(White::Xy([x, y])),
            _ => {
                let names: Vec<&str> = ILLUMINANTS.iter().map(|i| i.0).collect();
                Err(format!("expected star, {} or a chromaticity such as 0.3127,0.329", names.join(", "))
                    .into())
            }
        }
    }
}

/// Chromaticities for the 2° observer: CIE 15:2004, Table T.3, those of D65 and of ACES as their RGB spaces have them.
pub const ILLUMINANTS: [(&str, [f64; 2]); 6] = [
    ("a", [0.44758, 0.40745]),
    ("d50", [0.34567, 0.35851]),
    ("d55", [0.33243, 0.34744]),
    ("d65", [0.3127, 0.3290]),
    ("aces", [0.32168, 0.33767]),
    ("e", [1.0 / 3.0, 1.0 / 3.0]),
];

/// Linear RGB as it is asked for: a space, and the white that is adapted to the space's own, if any.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rgb {
    pub space: ColourSpace,
    pub white: Option<(White, Adaptation)>,
}

/// The same for one star: a matrix.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbMatrix {
    pub space: ColourSpace,
    /// Chromaticity that becomes the space's white, and how.
    pub adapted: Option<([f64; 2], Adaptation)>,
    /// XYZ to linear RGB, adaptation included.
    pub from_xyz: [[f64; 3]; 3],
}

impl Rgb {
    /// RGB for a star of that XYZ; of a star that gives no light, D65 is taken for its white.
    pub fn under(&self, star_xyz: [f64; 3]) -> RgbMatrix {
        let star = if star_xyz[1] > 0.0 { star_xyz } else { D65 };
        let adapted = self.white.map(|(white, by)| match white {
            White::Xy(xy) => (xy, by),
            White::Star => (chromaticity(star), by),
        });
        let plain = self.space.from_xyz();
        let from_xyz = match adapted {
            None => plain,
            Some((xy, by)) => product(&plain, &by.matrix(white_of(xy), self.space.white())),
        };
        RgbMatrix { space: self.space, adapted, from_xyz }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bradford from D65 to D50 as Lindbloom prints it: 1.0478112, 0.0228866, -0.0501270 in the first row, for whites
    /// that differ from ours in the fourth digit.
    #[test]
    fn the_published_matrix() {
        let to = [0.964_22, 1.0, 0.825_21];
        let found = Adaptation::Bradford.matrix([0.950_47, 1.0, 1.088_83], to);
        for (a, b) in found[0].iter().zip([1.047_811_2, 0.022_886_6, -0.050_127_0]) {
            assert!((a - b).abs() < 1e-6, "{found:?}");
        }
    }

    /// White becomes white, in each way and for any pair; adaptation to the own white is none.
    #[test]
    fn white_becomes_white() {
        let (from, to) = (white_of([0.45, 0.41]), white_of([0.31, 0.33]));
        for by in [Adaptation::Bradford, Adaptation::Cat02] {
            let found = multiply(&by.matrix(from, to), from);
            assert!((0..3).all(|c| (found[c] - to[c]).abs() < 1e-14), "{found:?}");
            let same = by.matrix(to, to);
            assert!((0..3).all(|r| (0..3).all(|c| (same[r][c] - f64::from(u8::from(r == c))).abs() < 1e-14)));
            let star = multiply(&to_matrix(), [3.0, 2.0, 1.0]);
            let rgb = Rgb { space: ColourSpace::Srgb, white: Some((White::Star, by)) }.under(star);
            let white = multiply(&rgb.from_xyz, star.map(|v| v / star[1]));
            assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-13), "{white:?}");
        }
    }

    fn to_matrix() -> [[f64; 3]; 3] {
        ColourSpace::Srgb.to_xyz()
    }

    /// Names in any case, chromaticities, and what is neither.
    #[test]
    fn whites_are_read() {
        assert_eq!(White::parse("D50").unwrap(), White::Xy([0.34567, 0.35851]));
        assert_eq!(White::parse("0.3, 0.31").unwrap(), White::Xy([0.3, 0.31]));
        assert_eq!(White::parse("star").unwrap(), White::Star);
        for bad in ["d66", "0.3", "0,0.3", "0.7,0.4", "0.3,0.3,0.4", "nan,0.3"] {
            assert!(White::parse(bad).is_err(), "{bad}");
        }
    }
}
