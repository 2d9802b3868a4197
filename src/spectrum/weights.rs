//! From a few wavelengths to colour by one matrix: what a shader can afford.

use super::{LUMINOUS_EFFICACY, Observer, RANGE, Spectrum};
use crate::error::{Error, Result};

/// Ridge that keeps fits of a few dozen skies from growing large weights of opposite sign.
pub const DEFAULT_RIDGE: f64 = 1e-7;

/// N × 3 matrix: XYZ in cd/m² of transfers (1/sr) at N wavelengths is Σ transfer · row. Each row integrates
/// 683 · irradiance · observer over the hat function of its wavelength (the piecewise-linear interpolant of
/// the transfers, end values held), at 1 nm over 380–780 nm. Exact for transfers linear between samples.
pub fn hat_weights(wavelengths_nm: &[f64], irradiance: &Spectrum) -> Vec<[f64; 3]> {
    hat_weights_seen_by(Observer::cie1931(), wavelengths_nm, irradiance)
}

/// The same for another observer.
pub fn hat_weights_seen_by(
    observer: &Observer,
    wavelengths_nm: &[f64],
    irradiance: &Spectrum,
) -> Vec<[f64; 3]> {
    let n = wavelengths_nm.len();
    let mut weights = vec![[0.0; 3]; n];
    for (w, cmf) in observer.rows(RANGE.0 as usize, RANGE.1 as usize) {
        let after = wavelengths_nm.partition_point(|&x| x <= w);
        let (left, right) = (after.max(1) - 1, after.min(n - 1));
        let t = if left == right {
            0.0
        } else {
            (w - wavelengths_nm[left]) / (wavelengths_nm[right] - wavelengths_nm[left])
        };
        for c in 0..3 {
            let value = LUMINOUS_EFFICACY * irradiance.at(w) * cmf[c];
            weights[left][c] += value * (1.0 - t);
            weights[right][c] += value * t;
        }
    }
    weights
}

/// XYZ of transfers at N wavelengths by an N × 3 matrix.
pub fn weighted(weights: &[[f64; 3]], transfer: &[f64]) -> [f64; 3] {
    let mut xyz = [0.0; 3];
    for (row, t) in weights.iter().zip(transfer) {
        for c in 0..3 {
            xyz[c] += row[c] * t;
        }
    }
    xyz
}

/// N × 3 matrix fitted to K skies: transfers (K × N) and their true XYZ (K × 3). Minimises the squared errors
/// of XYZ over the skies, each relative as CIELAB feels it, plus a ridge that pulls towards `prior`, so that
/// few, equal or black skies are no obstacle. `ridge` is relative to the mean of the normal matrix's diagonal.
///
/// An error δX of a colour moves CIELAB's cube root of X/Y by (X/Y)^⅓ δX/X / 3, so each error is divided
/// by X^⅔ Y^⅓. Skies with Y ≤ 0 count nothing. Errors: lists of unequal length, numbers that are not finite.
pub fn fit_weights(
    transfers: &[Vec<f64>],
    xyz: &[[f64; 3]],
    prior: &[[f64; 3]],
    ridge: f64,
) -> Result<Vec<[f64; 3]>> {
    let factor = |value: f64, y: f64| {
        if value > 0.0 && y > 0.0 {
            1.0 / (libm::cbrt(value) * libm::cbrt(value) * libm::cbrt(y))
        } else {
            0.0
        }
    };
    let factors: Vec<[f64; 3]> = xyz.iter().map(|v| v.map(|c| factor(c, v[1]))).collect();
    fit_weights_by(transfers, xyz, &factors, prior, ridge)
}

/// The same where the error of each sky's X, Y and Z is multiplied by a factor of one's own (K × 3) before it is
/// squared; 0 leaves that value out.
pub fn fit_weights_by(
    transfers: &[Vec<f64>],
    xyz: &[[f64; 3]],
    factors: &[[f64; 3]],
    prior: &[[f64; 3]],
    ridge: f64,
) -> Result<Vec<[f64; 3]>> {
    let n = prior.len();
    let skies = transfers.len();
    if xyz.len() != skies || factors.len() != skies || transfers.iter().any(|t| t.len() != n) {
        return Err(Error::Argument(format!(
            "colour fit: every sky needs {n} transfers, one XYZ and its factors"
        )));
    }
    let colours = xyz.iter().chain(factors).flatten();
    if !transfers.iter().flatten().chain(colours).all(|v| v.is_finite()) {
        return Err(Error::NotFinite { table: "colour fit".into(), place: "a training sky".into() });
    }
    let mut weights = prior.to_vec();
    for channel in 0..3 {
        let correction = fit_channel(transfers, xyz, factors, prior, ridge, channel);
        for (row, c) in weights.iter_mut().zip(correction) {
            row[channel] += c;
        }
    }
    Ok(weights)
}

/// What to add to one column of the prior: ridge regression of what the prior leaves, by normal equations.
fn fit_channel(
    transfers: &[Vec<f64>],
    xyz: &[[f64; 3]],
    factors: &[[f64; 3]],
    prior: &[[f64; 3]],
    ridge: f64,
    channel: usize,
) -> Vec<f64> {
    let n = prior.len();
    let (mut normal, mut right) = (vec![vec![0.0; n]; n], vec![0.0; n]);
    for ((transfer, reference), factors) in transfers.iter().zip(xyz).zip(factors) {
        let factor = factors[channel];
        if factor <= 0.0 {
            continue;
        }
        let left_over = (reference[channel] - weighted(prior, transfer)[channel]) * factor;
        for i in 0..n {
            right[i] += transfer[i] * factor * left_over;
            for j in 0..=i {
                normal[i][j] += transfer[i] * factor * transfer[j] * factor;
            }
        }
    }
    let mean_diagonal = (0..n).map(|i| normal[i][i]).sum::<f64>() / n as f64;
    if mean_diagonal <= 0.0 {
        return vec![0.0; n];
    }
    for (i, row) in normal.iter_mut().enumerate() {
        row[i] += ridge * mean_diagonal;
    }
    solve_cholesky(normal, right)
}

/// Solves A x = b for a symmetric positive definite A, given by its lower triangle. A pivot lost to rounding
/// is held at the smallest that double precision can tell, which leaves that direction to the prior.
fn solve_cholesky(mut a: Vec<Vec<f64>>, mut b: Vec<f64>) -> Vec<f64> {
    let n = b.len();
    let least = a.iter().enumerate().map(|(i, row)| row[i]).fold(0.0, f64::max) * f64::EPSILON;
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| a[i][k] * a[j][k]).sum();
            let rest = a[i][j] - dot;
            a[i][j] = if i == j { rest.max(least).sqrt() } else { rest / a[j][j] };
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| a[i][k] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i][i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| a[k][i] * b[k]).sum();
        b[i] = (b[i] - dot) / a[i][i];
    }
    b
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Reconstruction, delta_e_2000_scaled, planck_law};

    fn star() -> Spectrum {
        Spectrum::sampled((360..=830).map(f64::from).collect(), |w| planck_law(w, 6500.0) * 1e-13).unwrap()
    }

    /// Skies of λ⁻⁴ scatterers with a haze, seen through many path lengths.
    fn sky(air: f64, haze: f64, path: f64) -> impl Fn(f64) -> f64 {
        move |w| {
            let ratio = 550.0 / w;
            let tau = air * ratio * ratio * ratio * ratio;
            let veil = haze * ratio;
            (tau + veil) / (0.1 + tau + veil) * libm::exp(-path * (tau + veil))
        }
    }

    /// A transfer that is linear between the wavelengths is weighed exactly, whatever the star.
    #[test]
    fn hats_are_exact_for_straight_transfers() {
        let nodes = [400.0, 500.0, 650.0, 780.0];
        let line = |w: f64| if w < 400.0 { 0.4 } else { w * 1e-3 };
        let samples: Vec<f64> = nodes.iter().map(|&w| line(w)).collect();
        let xyz = weighted(&hat_weights(&nodes, &star()), &samples);
        let expected = Reconstruction::new(&nodes, &star()).sum(line);
        assert!((0..3).all(|c| (xyz[c] / expected[c] - 1.0).abs() < 1e-12), "{xyz:?} {expected:?}");
    }

    /// Four fitted wavelengths reach held-out skies within ΔE2000 0.5 (1 is just visible), where the plain hats are off by more than 3.
    #[test]
    fn fitted_weights_reach_held_out_skies() {
        let nodes = [440.0, 510.0, 570.0, 635.0];
        let truth = Reconstruction::new(&nodes, &star());
        let skies = |shift: f64| {
            let mut list = Vec::new();
            for air in [0.05, 0.1, 0.3, 0.8] {
                for haze in [0.0, 0.05, 0.2] {
                    for path in [0.0, 1.0, 3.0, 6.0] {
                        list.push(sky(air + shift * 0.03, haze + shift * 0.02, path + shift * 0.5));
                    }
                }
            }
            list
        };
        let sample = |f: &dyn Fn(f64) -> f64| nodes.iter().map(|&w| f(w)).collect::<Vec<_>>();
        let train = skies(0.0);
        let transfers: Vec<_> = train.iter().map(|f| sample(f)).collect();
        let xyz: Vec<_> = train.iter().map(|f| truth.sum(f)).collect();
        let prior = hat_weights(&nodes, &star());
        let fitted = fit_weights(&transfers, &xyz, &prior, DEFAULT_RIDGE).unwrap();
        let worst = |weights: &[[f64; 3]]| {
            let errors = skies(1.0)
                .into_iter()
                .map(|f| delta_e_2000_scaled(truth.sum(&f), weighted(weights, &sample(&f))));
            errors.fold(0.0, f64::max)
        };
        assert!(worst(&fitted) < 0.5, "{}", worst(&fitted));
        assert!(worst(&prior) > 3.0, "{}", worst(&prior));
    }

    /// With fewer skies than wavelengths, or equal ones, the fit stays finite and still meets the sky given.
    #[test]
    fn few_skies_are_enough() {
        let nodes = crate::spectrum::grid(9);
        let truth = Reconstruction::new(&nodes, &star());
        let f = sky(0.2, 0.1, 1.0);
        let transfer: Vec<f64> = nodes.iter().map(|&w| f(w)).collect();
        let prior = hat_weights(&nodes, &star());
        let fitted =
            fit_weights(&vec![transfer.clone(); 2], &[truth.sum(&f); 2], &prior, DEFAULT_RIDGE).unwrap();
        let (got, want) = (weighted(&fitted, &transfer), truth.sum(&f));
        assert!((0..3).all(|c| (got[c] / want[c] - 1.0).abs() < 1e-5), "{got:?} {want:?}");
        assert_eq!(fit_weights(&[], &[], &prior, DEFAULT_RIDGE).unwrap(), prior);
        assert_eq!(fit_weights(&[vec![0.0; 9]], &[[0.0; 3]], &prior, DEFAULT_RIDGE).unwrap(), prior);
        assert!(fit_weights(&[vec![f64::NAN; 9]], &[[1.0; 3]], &prior, DEFAULT_RIDGE).is_err());
    }

    /// Cholesky against a system with a known answer.
    #[test]
    fn cholesky_solves() {
        let a = vec![vec![4.0, 0.0, 0.0], vec![2.0, 5.0, 0.0], vec![1.0, 3.0, 6.0]];
        let x = solve_cholesky(a, vec![4.0 + 4.0 + 3.0, 2.0 + 10.0 + 9.0, 1.0 + 6.0 + 18.0]);
        for (got, want) in x.iter().zip([1.0, 2.0, 3.0]) {
            assert!((got - want).abs() < 1e-14);
        }
    }
}
