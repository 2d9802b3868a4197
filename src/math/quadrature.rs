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
}
