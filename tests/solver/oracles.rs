//! The solver against radiances of another maker's Monte Carlo (see `common`).

use super::worlds::total;
use crate::common::{OracleRow, chi_square, oracle_medium, oracle_rows};
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

/// Mean of ours / theirs − 1 with weights of their errors, and its own error.
fn mean_difference(rows: &[OracleRow], answers: &[(f64, f64)]) -> (f64, f64) {
    let (mut sum, mut weights) = (0.0, 0.0);
    for (r, a) in rows.iter().zip(answers).filter(|(r, _)| r.radiance > 0.0) {
        // No row may count for more than one of half a per cent, or a handful would be the mean.
        let relative = (r.stderr / r.radiance).max(5e-3);
        let weight = 1.0 / (relative * relative);
        sum += weight * (a.0 / r.radiance - 1.0);
        weights += weight;
    }
    (sum / weights, 1.0 / weights.sqrt())
}

fn agrees(name: &str) {
    let medium = oracle_medium(name);
    let solution = Solution::new(&medium, &Resolution::EXACT, Orders::Converged { tolerance: 1e-3 });
    let mut rows = oracle_rows(name);
    assert_eq!(rows.len(), 198);
    rows.sort_by(|a, b| b.point.mu_s.total_cmp(&a.point.mu_s));
    let mut failures = Vec::new();
    let mut all = 0.0;
    for group in rows.chunk_by(|a, b| a.point.mu_s == b.point.mu_s) {
        let sun = libm::asin(group[0].point.mu_s).to_degrees();
        let answers: Vec<(f64, f64)> =
            group.iter().map(|r| (total(&solution, &medium, &r.point)[r.wavelength], 0.0)).collect();
        let chi_square = chi_square(group, &answers);
        let (mean, error) = mean_difference(group, &answers);
        println!(
            "{name}, sun {sun:5.1}°: χ² {chi_square:.2}, mean {:+.3} ± {:.3} %",
            100.0 * mean,
            100.0 * error
        );
        all += chi_square * group.len() as f64;
        if chi_square > 1.5 {
            failures.push(format!("sun {sun:.1}°: χ² {chi_square:.2} per value"));
        }
        if mean.abs() > (3.0 * error).max(5e-3) {
            failures.push(format!("sun {sun:.1}°: mean difference {mean:+.4} ± {error:.4}"));
        }
        for (r, a) in group.iter().zip(&answers).filter(|_| sun > -0.01) {
            let difference = (a.0 - r.radiance).abs();
            if difference > (0.01 * r.radiance).max(5.0 * r.stderr) {
                failures.push(format!("sun {sun:.1}°: {} for {r:?}", a.0));
            }
        }
    }
    assert!(all / 198.0 <= 1.3, "{name}: χ² {} per value", all / 198.0);
    assert!(failures.is_empty(), "{name}:\n{}", failures.join("\n"));
}

/// Clear air, ozone and Cornette–Shanks haze of the Earth. Where ours is right, χ² per value is 1 ± √(2/198) = 0.1
/// for all and ± √(2/33) = 0.25 for each height of the sun; 1.3 and 1.5 are three and two of those. The mean
/// difference is noise: 0.5 %, or three errors of the mean where they are more. No point with the sun up may be off
/// by more than both 1 % and 5 σ.
#[test]
fn clear_earth_agrees_with_mitsuba() {
    agrees("earth_clear");
}

/// The same for thin dusty air of Mars, where ground light dominates.
#[test]
fn thin_mars_agrees_with_mitsuba() {
    agrees("mars_thin");
}
