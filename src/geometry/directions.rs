//! View directions that an integral over the sphere is taken by.

use super::horizon_cosine;
use crate::math::quadrature::gauss_legendre;

/// A view direction of a quadrature over the sphere's zenith angles.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    pub mu: f64,
    /// Weight in ∫ dmu.
    pub weight: f64,
    pub hits_ground: bool,
}

/// Directions at radius `r`: Gauss–Legendre apart for the ground, for the sky below the horizontal and for
/// the sky above, each denser towards the horizon by mu = u². `n` is the number above the horizontal.
pub fn directions(r: f64, ground: f64, top: f64, n: usize) -> Vec<Direction> {
    let horizon = horizon_cosine(r, ground);
    let mut out = Vec::new();
    for (u, w) in gauss_legendre(n * 3 / 4) {
        let span = 1.0 + horizon;
        out.push(Direction { mu: horizon - span * u * u, weight: 2.0 * span * u * w, hits_ground: true });
    }
    if horizon < 0.0 {
        for (u, w) in gauss_legendre(n / 2) {
            // Denser at both ends: at the ground's edge and at the horizontal.
            let mu = horizon * (1.0 - u * u * (3.0 - 2.0 * u));
            out.push(Direction { mu, weight: -horizon * 6.0 * u * (1.0 - u) * w, hits_ground: false });
        }
    }
    if r < top {
        for (u, w) in gauss_legendre(n) {
            out.push(Direction { mu: u * u, weight: 2.0 * u * w, hits_ground: false });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The three parts together cover the sphere: ∫ dmu = 2 and ∫ mu² dmu = 2/3.
    #[test]
    fn directions_cover_the_sphere() {
        for r in [100.0, 103.0, 119.0] {
            let d = directions(r, 100.0, 120.0, 16);
            let total: f64 = d.iter().map(|d| d.weight).sum();
            let second: f64 = d.iter().map(|d| d.weight * d.mu * d.mu).sum();
            assert!(
                (total - 2.0).abs() < 1e-12 && (second - 2.0 / 3.0).abs() < 1e-12,
                "{r}: {total} {second}"
            );
        }
    }
}
