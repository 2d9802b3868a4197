//! Particles in water: the phase function of Fournier & Forand as a table, from a backscatter fraction.

use super::PhaseLaw;
use std::f64::consts::PI;

/// Range of backscatter fractions that the line of Mobley et al. reaches with room to spare.
pub(super) const BACKSCATTER: (f64, f64) = (0.001, 0.05);

/// The law of a backscatter fraction. Relative refractive index n and Junge slope lie on the line
/// n = 1.01 + 0.1542 (slope − 3) of Mobley, Sundman & Boss 2002; n is found so that the table itself, cut flat
/// inside 0.01°, sends that fraction backwards.
pub(super) fn fournier_forand(backscatter_fraction: f64) -> PhaseLaw {
    let (mut low, mut high) = (1.012, 1.4);
    for _ in 0..60 {
        let n = 0.5 * (low + high);
        if backscatter(&rows(n)) < backscatter_fraction {
            low = n;
        } else {
            high = n;
        }
    }
    let (cosines, values): (Vec<f64>, Vec<f64>) = rows(0.5 * (low + high)).into_iter().unzip();
    PhaseLaw::Tabulated { cosines, wavelengths_nm: vec![550.0], rows: vec![values] }
}

/// Scattering angles, degrees: even in their logarithm to 10°, then every 2°.
fn angles() -> Vec<f64> {
    let small = (0..=60).map(|k| libm::pow(10.0, -2.0 + 0.05 * f64::from(k)));
    std::iter::once(0.0).chain(small).chain((6..=90).map(|k| 2.0 * f64::from(k))).collect()
}

/// (cosine, value), cosines rising from −1 to 1, of integral 1 over the sphere.
fn rows(n: f64) -> Vec<(f64, f64)> {
    let slope = 3.0 + (n - 1.01) / 0.1542;
    let angles = angles();
    let least = angles[1];
    let mut rows: Vec<(f64, f64)> = angles
        .iter()
        .rev()
        .map(|&a| (libm::cos(a.to_radians()), value(n, slope, a.max(least).to_radians())))
        .collect();
    let last = rows.len() - 1;
    (rows[0].0, rows[last].0) = (-1.0, 1.0);
    let total: f64 = rows.windows(2).map(|p| PI * (p[1].0 - p[0].0) * (p[0].1 + p[1].1)).sum();
    rows.iter_mut().for_each(|r| r.1 /= total);
    rows
}

/// Fournier & Jonasz 1999, in the form of Mobley, Sundman & Boss 2002, Eq. 7.
fn value(n: f64, slope: f64, angle: f64) -> f64 {
    let half = libm::sin(0.5 * angle);
    let sine2 = half * half;
    let v = 0.5 * (3.0 - slope);
    let scale = 4.0 / (3.0 * (n - 1.0) * (n - 1.0));
    // 1 is a removable singularity.
    let delta = if (scale * sine2 - 1.0).abs() < 1e-4 { 1.0 + 1e-4 } else { scale * sine2 };
    let (dv, back) = (libm::pow(delta, v), libm::pow(scale, v));
    let braces = v * (1.0 - delta) - (1.0 - dv) + (delta * (1.0 - dv) - v * (1.0 - delta)) / sine2;
    let cosine = libm::cos(angle);
    braces / (4.0 * PI * (1.0 - delta) * (1.0 - delta) * dv)
        + (1.0 - back) / (16.0 * PI * (scale - 1.0) * back) * (3.0 * cosine * cosine - 1.0)
}

fn backscatter(rows: &[(f64, f64)]) -> f64 {
    let backwards = rows.windows(2).filter(|p| p[1].0 <= 1e-9);
    backwards.map(|p| PI * (p[1].0 - p[0].0) * (p[0].1 + p[1].1)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mobley et al. 2002: n = 1.10 and slope 3.5835 give Petzold's 0.0183; the closed form of the backscatter
    /// fraction is theirs, Eq. 14; cut inside 0.01° the table sends a little more backwards.
    #[test]
    fn petzolds_backscatter() {
        let (n, slope): (f64, f64) = (1.10, 3.5835);
        let v = 0.5 * (3.0 - slope);
        let delta = 2.0 / (3.0 * (n - 1.0) * (n - 1.0));
        let dv = libm::pow(delta, v);
        let closed = 1.0 - (1.0 - dv * delta - 0.5 * (1.0 - dv)) / ((1.0 - delta) * dv);
        assert!((closed - 0.0183).abs() < 1e-4, "{closed}");
        let table = backscatter(&rows(1.10));
        assert!((table / closed - 1.0).abs() < 0.02, "{table} {closed}");
    }

    /// The table has the fraction asked for, rises from back to front but for the bend near 180°, and is never
    /// negative; its mean cosine is that of sea water (Petzold: 0.92 to 0.95).
    #[test]
    fn a_fraction_is_met() {
        for fraction in [0.005, 0.01, 0.0183, 0.03] {
            let PhaseLaw::Tabulated { cosines, rows, .. } = fournier_forand(fraction) else { panic!() };
            let pairs: Vec<(f64, f64)> = cosines.iter().copied().zip(rows[0].iter().copied()).collect();
            assert!((backscatter(&pairs) / fraction - 1.0).abs() < 1e-9);
            assert!(rows[0].iter().all(|v| *v > 0.0));
        }
        let g = fournier_forand(0.0183).at(550.0).mean_cosine();
        assert!((0.90..0.96).contains(&g), "{g}");
    }
}
