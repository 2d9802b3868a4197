//! Linear RGB colour spaces, as matrices from CIE XYZ derived from their primaries and white.

use serde::{Deserialize, Serialize};

/// A linear RGB colour space. Its white is its own: nothing is adapted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "lowercase")]
#[cfg_attr(feature = "cli", value(rename_all = "lowercase"))]
pub enum ColourSpace {
    /// IEC 61966-2-1, primaries of ITU-R BT.709, white D65.
    Srgb,
    /// ITU-R BT.2020, white D65.
    Rec2020,
    /// ACES2065-1: the AP0 primaries and white of S-2008-001 (about D60), which hold every colour there is.
    #[serde(rename = "aces2065-1")]
    #[cfg_attr(feature = "cli", value(name = "aces2065-1"))]
    Aces20651,
    /// ACEScg: the AP1 primaries and white of S-2014-004 (about D60).
    Acescg,
}

/// XYZ of a chromaticity at Y = 1.
pub fn white_of(xy: [f64; 2]) -> [f64; 3] {
    [xy[0] / xy[1], 1.0, (1.0 - xy[0] - xy[1]) / xy[1]]
}

impl ColourSpace {
    /// Every colour space, in the order of the command line.
    pub const ALL: [ColourSpace; 4] =
        [ColourSpace::Srgb, ColourSpace::Rec2020, ColourSpace::Acescg, ColourSpace::Aces20651];

    /// Name as on the command line and in manifests.
    pub fn name(self) -> &'static str {
        match self {
            ColourSpace::Srgb => "srgb",
            ColourSpace::Rec2020 => "rec2020",
            ColourSpace::Acescg => "acescg",
            ColourSpace::Aces20651 => "aces2065-1",
        }
    }

    /// Chromaticities of red, green, blue and white, from the standards.
    pub fn chromaticities(self) -> [[f64; 2]; 4] {
        match self {
            ColourSpace::Srgb => [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]],
            ColourSpace::Rec2020 => [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046], [0.3127, 0.3290]],
            ColourSpace::Acescg => [[0.713, 0.293], [0.165, 0.830], [0.128, 0.044], [0.32168, 0.33767]],
            ColourSpace::Aces20651 => [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.0770], [0.32168, 0.33767]],
        }
    }

    /// XYZ of the white, Y = 1.
    pub fn white(self) -> [f64; 3] {
        white_of(self.chromaticities()[3])
    }

    /// Linear RGB to XYZ, rows X, Y, Z; RGB (1, 1, 1) is the white at Y = 1 (SMPTE RP 177).
    pub fn to_xyz(self) -> [[f64; 3]; 3] {
        let [r, g, b, white] = self.chromaticities();
        let primaries = transpose([white_of(r), white_of(g), white_of(b)]);
        let scale = multiply(&invert(&primaries), white_of(white));
        primaries.map(|row| std::array::from_fn(|c| row[c] * scale[c]))
    }

    /// XYZ to linear RGB. For sRGB this is the matrix derived from the primaries (3.24096994 …), exact to
    /// rounding; the four-decimal one printed in IEC 61966-2-1 (3.2406 …) differs in the fifth digit.
    pub fn from_xyz(self) -> [[f64; 3]; 3] {
        invert(&self.to_xyz())
    }
}

fn transpose(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|r| std::array::from_fn(|c| m[c][r]))
}

/// Matrix times vector.
pub fn multiply(m: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

/// Inverse of a regular 3 × 3 matrix by cofactors.
pub fn invert(m: &[[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |r: usize, c: usize| {
        let (r1, r2, c1, c2) = ((r + 1) % 3, (r + 2) % 3, (c + 1) % 3, (c + 2) % 3);
        m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]
    };
    let determinant: f64 = (0..3).map(|c| m[0][c] * cofactor(0, c)).sum();
    std::array::from_fn(|r| std::array::from_fn(|c| cofactor(c, r) / determinant))
}

/// The sRGB transfer function (IEC 61966-2-1): linear 0..1 to the encoded value of a picture.
pub fn srgb_encode(linear: f64) -> f64 {
    let v = linear.clamp(0.0, 1.0);
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * libm::pow(v, 1.0 / 2.4) - 0.055 }
}

/// Inverse of [`srgb_encode`].
pub fn srgb_decode(encoded: f64) -> f64 {
    let v = encoded.clamp(0.0, 1.0);
    if v <= 0.040_45 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The derived sRGB matrix, known to nine digits, and the published BT.2020, ACEScg and ACES2065-1 ones.
    #[test]
    fn matrices_are_the_published_ones() {
        let known = [
            (ColourSpace::Srgb, [3.240_969_942, -1.537_383_178, -0.498_610_760], 1e-9),
            (ColourSpace::Rec2020, [1.716_651_188, -0.355_670_784, -0.253_366_281], 1e-9),
            (ColourSpace::Acescg, [1.641_023_379_7, -0.324_803_294_2, -0.236_424_695_2], 1e-9),
            (ColourSpace::Aces20651, [1.049_811_017_5, 0.0, -0.000_097_484_5], 1e-9),
        ];
        for (space, row, tolerance) in known {
            for c in 0..3 {
                assert!(
                    (space.from_xyz()[0][c] - row[c]).abs() < tolerance,
                    "{space:?} {:?}",
                    space.from_xyz()
                );
            }
        }
    }

    /// White is (1, 1, 1) in its own space, and there and back is the identity.
    #[test]
    fn white_is_one_and_inverses_cancel() {
        for space in ColourSpace::ALL {
            let rgb = multiply(&space.from_xyz(), space.white());
            assert!(rgb.iter().all(|v| (v - 1.0).abs() < 1e-14), "{rgb:?}");
            let v = [0.2, 0.5, 0.9];
            let back = multiply(&space.to_xyz(), multiply(&space.from_xyz(), v));
            assert!((0..3).all(|c| (back[c] - v[c]).abs() < 1e-14));
        }
    }

    /// Encoding is the inverse of decoding; 0.18 encodes to 0.4613561 (IEC 61966-2-1).
    #[test]
    fn transfer_function_round_trips() {
        assert!((srgb_encode(0.18) - 0.461_356_1).abs() < 1e-6);
        for k in 0..=255 {
            let v = f64::from(k) / 255.0;
            assert!((srgb_encode(srgb_decode(v)) - v).abs() < 1e-7);
        }
    }
}
