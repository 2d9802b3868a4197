//! Gauss–Legendre quadrature and the view directions that moments are gathered from.

/// Nodes and weights of the n-point Gauss–Legendre rule on (0, 1), by Newton's method on P_n.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    (0..n)
        .map(|k| {
            let mut x = libm::cos(std::f64::consts::PI * (k as f64 + 0.75) / (n as f64 + 0.5));
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut before, mut now) = (1.0, x);
                for l in 2..=n {
                    let next = ((2 * l - 1) as f64 * x * now - (l - 1) as f64 * before) / l as f64;
                    (before, now) = (now, next);
                }
                slope = n as f64 * (x * now - before) / (x * x - 1.0);
                let step = now / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

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

/// Cosine of the zenith angle of the ground's edge seen from radius `r`; 0 on the ground.
pub fn horizon_cosine(r: f64, ground: f64) -> f64 {
    let (a, b) = (((r - ground) * (r + ground)).max(0.0), r * r);
    -(a / b).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// n points integrate polynomials up to degree 2n − 1 exactly: ∫₀¹ x⁷ dx = 1/8 with four points.
    #[test]
    fn gauss_legendre_integrates_polynomials() {
        let sum: f64 = gauss_legendre(4).iter().map(|(x, w)| w * x * x * x * x * x * x * x).sum();
        assert!((sum - 0.125).abs() < 1e-14);
        let total: f64 = gauss_legendre(48).iter().map(|(_, w)| w).sum();
        assert!((total - 1.0).abs() < 1e-13);
    }

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
