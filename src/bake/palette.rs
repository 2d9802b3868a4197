//! From spectra to colour for one planet: weights for all its wavelengths, and for the four that the compact
//! layout keeps.

use super::skies::Transfers;
use crate::error::Result;
use crate::spectrum::{
    ColourSpace, DEFAULT_RIDGE, Reconstruction, Spectrum, delta_e_2000_scaled, fit_weights, hat_weights,
    multiply, weighted,
};

/// Colour weights of a bake, and what they cost.
pub struct Palette {
    pub wavelengths_nm: Vec<f64>,
    /// `[wavelength]`: XYZ in cd/m² (683 lm/W) per radiance over solar irradiance of 1/sr.
    pub weights: Vec<[f64; 3]>,
    /// Numbers of the (up to) four wavelengths of the compact layout.
    pub four: Vec<usize>,
    /// Weights of those four.
    pub four_weights: Vec<[f64; 3]>,
    pub space: ColourSpace,
    /// ΔE2000 of the weights against the reconstructed spectrum on skies held out of the fit.
    pub error: ColourError,
    pub four_error: ColourError,
    /// Illuminance of the star on a plane normal to its light, in XYZ (Y in lux).
    pub star_xyz: [f64; 3],
}

/// Distribution of ΔE2000.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourError {
    pub median: f64,
    pub p95: f64,
    pub worst: f64,
}

impl Palette {
    /// Fits on one sample of skies and judges on another. The reference is the log-spline reconstruction of
    /// each spectrum times the star's irradiance at 1 nm.
    pub fn fit(
        wavelengths_nm: &[f64],
        irradiance: &Spectrum,
        space: ColourSpace,
        training: &Transfers,
        held_out: &Transfers,
    ) -> Result<Self> {
        let reconstruction = Reconstruction::new(wavelengths_nm, irradiance);
        let colours = |skies: &Transfers| skies.iter().map(|t| reconstruction.xyz(t)).collect::<Vec<_>>();
        let (targets, judges) = (colours(training), colours(held_out));
        let prior = hat_weights(wavelengths_nm, irradiance);
        let weights = fit_weights(training, &targets, &prior, DEFAULT_RIDGE)?;
        let four = choose(wavelengths_nm.len(), training, &targets);
        let pick = |skies: &Transfers| -> Transfers {
            skies.iter().map(|t| four.iter().map(|&w| t[w]).collect()).collect()
        };
        let few: Vec<f64> = four.iter().map(|&w| wavelengths_nm[w]).collect();
        let four_prior = hat_weights(&few, irradiance);
        let four_weights = fit_weights(&pick(training), &targets, &four_prior, DEFAULT_RIDGE)?;
        Ok(Palette {
            error: judge(&weights, held_out, &judges),
            four_error: judge(&four_weights, &pick(held_out), &judges),
            wavelengths_nm: wavelengths_nm.to_vec(),
            weights,
            four,
            four_weights,
            space,
            star_xyz: reconstruction.sum(|_| 1.0),
        })
    }

    /// Linear RGB per radiance over solar irradiance, a row a wavelength, cd/m² sr.
    pub fn rgb_weights(&self) -> Vec<[f64; 3]> {
        self.weights.iter().map(|w| multiply(&self.space.from_xyz(), *w)).collect()
    }

    /// The same for the four wavelengths of the compact layout.
    pub fn four_rgb_weights(&self) -> Vec<[f64; 3]> {
        self.four_weights.iter().map(|w| multiply(&self.space.from_xyz(), *w)).collect()
    }

    /// Wavelengths of the compact layout, nm.
    pub fn four_nm(&self) -> Vec<f64> {
        self.four.iter().map(|&w| self.wavelengths_nm[w]).collect()
    }
}

fn judge(weights: &[[f64; 3]], skies: &Transfers, references: &[[f64; 3]]) -> ColourError {
    let mut errors: Vec<f64> = skies
        .iter()
        .zip(references)
        .filter(|(_, r)| r[1] > 0.0)
        .map(|(t, r)| delta_e_2000_scaled(*r, weighted(weights, t)))
        .collect();
    errors.sort_by(f64::total_cmp);
    let at = |share: f64| errors.get(((errors.len() as f64 - 1.0) * share) as usize).copied().unwrap_or(0.0);
    ColourError { median: at(0.5), p95: at(0.95), worst: at(1.0) }
}

/// The four wavelengths whose best weights leave the smallest sum of squared relative errors of XYZ.
fn choose(count: usize, skies: &Transfers, targets: &[[f64; 3]]) -> Vec<usize> {
    if count <= 4 {
        return (0..count).collect();
    }
    let sums = Sums::new(count, skies, targets);
    let mut best = (f64::INFINITY, vec![0, 1, 2, 3]);
    for a in 0..count {
        for b in a + 1..count {
            for c in b + 1..count {
                for d in c + 1..count {
                    let left = sums.residual(&[a, b, c, d]);
                    if left < best.0 {
                        best = (left, vec![a, b, c, d]);
                    }
                }
            }
        }
    }
    best.1
}

/// Normal equations of all wavelengths, from which those of any four are picked.
struct Sums {
    gram: Vec<Vec<f64>>,
    right: Vec<[f64; 3]>,
    squares: [f64; 3],
}

impl Sums {
    fn new(count: usize, skies: &Transfers, targets: &[[f64; 3]]) -> Self {
        let mut s =
            Sums { gram: vec![vec![0.0; count]; count], right: vec![[0.0; 3]; count], squares: [0.0; 3] };
        for (t, xyz) in skies.iter().zip(targets).filter(|(_, xyz)| xyz[1] > 0.0) {
            let scale = 1.0 / xyz[1];
            for i in 0..count {
                for j in 0..count {
                    s.gram[i][j] += t[i] * t[j] * scale * scale;
                }
                for c in 0..3 {
                    s.right[i][c] += t[i] * xyz[c] * scale * scale;
                }
            }
            for c in 0..3 {
                s.squares[c] += xyz[c] * xyz[c] * scale * scale;
            }
        }
        s
    }

    /// What the best weights of four wavelengths leave, summed over X, Y and Z.
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
