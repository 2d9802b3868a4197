//! From spectra to colour for one planet: weights for all its wavelengths, and for the four that the compact
//! layout keeps.

use super::samples::Skies;
use crate::error::Result;
use crate::quality::digits;
use crate::spectrum::{
    DEFAULT_RIDGE, Reconstruction, Rgb, RgbMatrix, Spectrum, StandardObserver, delta_e_2000_scaled,
    fit_weights, fit_weights_by, hat_weights_seen_by, multiply, weighted,
};
use serde_json::{Value, json};

/// Share with which twilight counts in the choice of four wavelengths and their weights. Four cannot hold day
/// and dusk alike: equal shares cost the day a percent of its light for what nobody sees in the dark.
const TWILIGHT_SHARE: f64 = 0.05;
/// Cosine of the sun's zenith angle (17 degrees up) from which it is day.
const DAY: f64 = 0.3;

/// Colour weights of a bake, and what they cost.
pub struct ColourWeights {
    pub wavelengths_nm: Vec<f64>,
    /// `[wavelength]`: XYZ in cd/m² (683 lm/W) per radiance over solar irradiance of 1/sr.
    pub weights: Vec<[f64; 3]>,
    /// Numbers of the (up to) four wavelengths of the compact layout.
    pub four: Vec<usize>,
    /// Weights of those four.
    pub four_weights: Vec<[f64; 3]>,
    /// To linear RGB.
    pub rgb: RgbMatrix,
    pub beholder: StandardObserver,
    /// ΔE2000 of the weights against the reconstructed spectrum on skies held out of the fit.
    pub error: ColourError,
    pub four_error: ColourError,
    /// Illuminance of the star on a plane normal to its light, in XYZ (Y in lux).
    pub star_xyz: [f64; 3],
}

/// Distribution of ΔE2000; not a number where there was no sky to judge by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourError {
    pub median: f64,
    pub p95: f64,
    pub worst: f64,
}

impl ColourError {
    /// For the manifest; null where there is no sky to judge by.
    pub fn json(&self) -> Value {
        let of = |v: f64| if v.is_nan() { Value::Null } else { json!(digits(v)) };
        json!({ "median": of(self.median), "p95": of(self.p95), "max": of(self.worst) })
    }
}

impl ColourWeights {
    /// Fits on one sample of skies and judges on another. The reference is the log-spline reconstruction of
    /// each spectrum times the star's irradiance at 1 nm. All wavelengths are fitted as CIELAB sees errors; the
    /// four are chosen and fitted for the least error of RGB relative to the sky's own, by day above all.
    pub fn fit(
        wavelengths_nm: &[f64],
        irradiance: &Spectrum,
        rgb: &Rgb,
        [training, held_out]: &[Skies; 2],
    ) -> Result<Self> {
        ColourWeights::of(
            wavelengths_nm,
            irradiance,
            rgb,
            StandardObserver::default(),
            [training, held_out],
            None,
        )
    }

    /// The same for any observer, with the four wavelengths that `four` numbers where it is given.
    pub fn of(
        wavelengths_nm: &[f64],
        irradiance: &Spectrum,
        rgb: &Rgb,
        beholder: StandardObserver,
        [training, held_out]: [&Skies; 2],
        four: Option<Vec<usize>>,
    ) -> Result<Self> {
        let observer = beholder.observer();
        let reconstruction = Reconstruction::seen_by(observer, wavelengths_nm, irradiance);
        let star_xyz = reconstruction.sum(|_| 1.0);
        let rgb = rgb.under(star_xyz);
        let colours =
            |skies: &Skies| skies.transfers.iter().map(|t| reconstruction.xyz(t)).collect::<Vec<_>>();
        let (targets, judges) = (colours(training), colours(held_out));
        let prior = hat_weights_seen_by(observer, wavelengths_nm, irradiance);
        let weights = fit_weights(&training.transfers, &targets, &prior, DEFAULT_RIDGE)?;
        let factors = factors(&rgb, &targets, &training.mu_s);
        let four = four.unwrap_or_else(|| {
            Sums::new(&rgb, &training.transfers, &targets, &factors).best(wavelengths_nm.len())
        });
        let few: Vec<f64> = four.iter().map(|&w| wavelengths_nm[w]).collect();
        let four_weights = fit_weights_by(
            &training.at(&four),
            &targets,
            &factors.iter().map(|&f| [f; 3]).collect::<Vec<_>>(),
            &hat_weights_seen_by(observer, &few, irradiance),
            DEFAULT_RIDGE,
        )?;
        Ok(ColourWeights {
            error: judge(&weights, &held_out.transfers, &judges),
            four_error: judge(&four_weights, &held_out.at(&four), &judges),
            wavelengths_nm: wavelengths_nm.to_vec(),
            weights,
            four,
            four_weights,
            rgb,
            beholder,
            star_xyz,
        })
    }

    /// XYZ of a spectrum at all wavelengths of the bake (radiance over solar irradiance), cd/m² for 1/sr.
    pub fn xyz(&self, light: &[f64]) -> [f64; 3] {
        weighted(&self.weights, light)
    }

    /// What the four wavelengths alone make of the same spectrum.
    pub fn xyz_of_four(&self, light: &[f64]) -> [f64; 3] {
        let four: Vec<f64> = self.four.iter().map(|&w| light[w]).collect();
        weighted(&self.four_weights, &four)
    }

    /// Linear RGB per radiance over solar irradiance, a row a wavelength, cd/m² sr.
    pub fn rgb_weights(&self) -> Vec<[f64; 3]> {
        self.weights.iter().map(|w| multiply(&self.rgb.from_xyz, *w)).collect()
    }

    /// The same for the four wavelengths of the compact layout.
    pub fn four_rgb_weights(&self) -> Vec<[f64; 3]> {
        self.four_weights.iter().map(|w| multiply(&self.rgb.from_xyz, *w)).collect()
    }

    /// Wavelengths of the compact layout, nm.
    pub fn four_nm(&self) -> Vec<f64> {
        self.four.iter().map(|&w| self.wavelengths_nm[w]).collect()
    }
}

/// ΔE2000 of weights on transfers at their wavelengths, against XYZ; not a number where none of those is lit.
pub fn judge(weights: &[[f64; 3]], transfers: &[Vec<f64>], references: &[[f64; 3]]) -> ColourError {
    let mut errors: Vec<f64> = transfers
        .iter()
        .zip(references)
        .filter(|(_, r)| r[1] > 0.0)
        .map(|(t, r)| delta_e_2000_scaled(*r, weighted(weights, t)))
        .collect();
    errors.sort_by(f64::total_cmp);
    let at =
        |share: f64| errors.get(((errors.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(f64::NAN);
    ColourError { median: at(0.5), p95: at(0.95), worst: at(1.0) }
}

/// By how much the error of each sky counts: relative to the length of its RGB, times its share in the fit, which
/// falls from 1 by day to that of twilight as the sun sets.
fn factors(rgb: &RgbMatrix, xyz: &[[f64; 3]], mu_s: &[f64]) -> Vec<f64> {
    let matrix = rgb.from_xyz;
    let factor = |(xyz, mu_s): (&[f64; 3], &f64)| {
        let length = multiply(&matrix, *xyz).iter().map(|v| v * v).sum::<f64>().sqrt();
        if xyz[1] > 0.0 && length > 0.0 { (mu_s / DAY).clamp(TWILIGHT_SHARE, 1.0) / length } else { 0.0 }
    };
    xyz.iter().zip(mu_s).map(factor).collect()
}

/// Normal equations of RGB from all wavelengths, from which those of any four are picked.
struct Sums {
    gram: Vec<Vec<f64>>,
    right: Vec<[f64; 3]>,
    squares: [f64; 3],
}

impl Sums {
    fn new(rgb: &RgbMatrix, transfers: &[Vec<f64>], xyz: &[[f64; 3]], factors: &[f64]) -> Self {
        let matrix = rgb.from_xyz;
        let count = transfers.first().map_or(0, Vec::len);
        let mut s =
            Sums { gram: vec![vec![0.0; count]; count], right: vec![[0.0; 3]; count], squares: [0.0; 3] };
        for ((t, xyz), factor) in transfers.iter().zip(xyz).zip(factors) {
            let rgb = multiply(&matrix, *xyz);
            let square = factor * factor;
            for i in 0..count {
                for j in 0..count {
                    s.gram[i][j] += t[i] * t[j] * square;
                }
                for c in 0..3 {
                    s.right[i][c] += t[i] * rgb[c] * square;
                }
            }
            for c in 0..3 {
                s.squares[c] += rgb[c] * rgb[c] * square;
            }
        }
        s
    }

    /// The four of `count` wavelengths whose best weights leave the smallest sum of squared errors; all of them
    /// where there are no more than four, four evenly spread where there is no sky to choose by.
    fn best(&self, count: usize) -> Vec<usize> {
        if count <= 4 {
            return (0..count).collect();
        }
        let mut best = (f64::INFINITY, (1..8).step_by(2).map(|eighth| eighth * count / 8).collect());
        if self.gram.is_empty() {
            return best.1;
        }
        for a in 0..count {
            for b in a + 1..count {
                for c in b + 1..count {
                    for d in c + 1..count {
                        let left = self.residual(&[a, b, c, d]);
                        if left < best.0 {
                            best = (left, vec![a, b, c, d]);
                        }
                    }
                }
            }
        }
        best.1
    }

    /// What the best weights of four wavelengths leave, summed over R, G and B.
    fn residual(&self, which: &[usize; 4]) -> f64 {
        let mut a = [[0.0; 7]; 4];
        for (i, row) in a.iter_mut().enumerate() {
            for j in 0..4 {
                row[j] = self.gram[which[i]][which[j]] * if i == j { 1.0 + 1e-9 } else { 1.0 };
            }
            row[4..].copy_from_slice(&self.right[which[i]]);
        }
        for k in 0..4 {
            for i in k + 1..4 {
                let factor = a[i][k] / a[k][k];
                for j in k..7 {
                    a[i][j] -= factor * a[k][j];
                }
            }
        }
        // With the matrix in triangular form U and right side y, the fitted part is Σ y_k² / U_kk.
        (0..3)
            .map(|c| self.squares[c] - (0..4).map(|k| a[k][4 + c] * a[k][4 + c] / a[k][k]).sum::<f64>())
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sums(transfers: &[Vec<f64>]) -> Sums {
        let rgb = Rgb { space: crate::spectrum::ColourSpace::Srgb, white: None }.under([95.0, 100.0, 109.0]);
        let xyz = vec![[1.0, 1.0, 1.0]; transfers.len()];
        Sums::new(&rgb, transfers, &xyz, &vec![1.0; transfers.len()])
    }

    /// Without a sky to choose by, and with black ones, the four wavelengths are spread over all.
    #[test]
    fn four_wavelengths_are_spread_where_no_sky_tells() {
        assert_eq!(sums(&[]).best(15), [1, 5, 9, 13]);
        assert_eq!(sums(&[vec![0.0; 15]]).best(15), [1, 5, 9, 13]);
        assert_eq!(sums(&[]).best(5), [0, 1, 3, 4]);
        assert_eq!(sums(&[]).best(4), [0, 1, 2, 3]);
    }

    /// What nothing was judged by has no error, not one of 0.
    #[test]
    fn no_sky_is_no_error_of_zero() {
        let none = judge(&[[1.0; 3]], &[], &[]);
        assert!([none.median, none.p95, none.worst].iter().all(|v| v.is_nan()));
    }
}
