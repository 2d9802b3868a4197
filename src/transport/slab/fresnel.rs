//! What a flat surface of water does to unpolarised light: Fresnel's reflectance and Snell's law.

/// Cosine of the angle on the other side, by Snell's law, going from index 1 into `n` (n < 1: out of the water
/// into air); none beyond the critical angle.
pub fn refract(mu: f64, n: f64) -> Option<f64> {
    let cosine2 = 1.0 - (1.0 - mu * mu) / (n * n);
    (cosine2 >= 0.0).then(|| cosine2.sqrt())
}

/// Share of unpolarised light that a surface reflects, the mean of the two polarisations (Born & Wolf 1999,
/// §1.5.3): `mu` is the cosine of incidence, `n` the index of the far side over that of the near side. 1 beyond
/// the critical angle.
pub fn fresnel(mu: f64, n: f64) -> f64 {
    if n == 1.0 {
        return 0.0;
    }
    let Some(inner) = refract(mu, n) else { return 1.0 };
    if mu <= 0.0 {
        return 1.0;
    }
    let across = (mu - n * inner) / (mu + n * inner);
    let along = (n * mu - inner) / (n * mu + inner);
    0.5 * (across * across + along * along)
}

/// The approximation of Lazányi & Szirmay-Kalos 2005 that the paper takes, from air into a medium of index `n`:
/// [(n − 1)² + 4n (1 − mu)⁵ + k²] / [(n + 1)² + k²] with k = 0 for water, where it is Schlick's.
pub fn lazanyi_szirmay_kalos(mu: f64, n: f64) -> f64 {
    let x = 1.0 - mu;
    let (below, above) = (n - 1.0, n + 1.0);
    (below * below + 4.0 * n * x * x * x * x * x) / (above * above)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Closed forms: ((n − 1)/(n + 1))² at normal incidence from either side, at Brewster's angle only the
    /// polarisation across is reflected, ((n² − 1)/(n² + 1))² / 2, and reciprocity along a refracted ray.
    #[test]
    fn reflectance_in_closed_form() {
        let n: f64 = 1.5;
        assert!((fresnel(1.0, n) - 0.04).abs() < 1e-15 && (fresnel(1.0, 1.0 / n) - 0.04).abs() < 1e-15);
        let brewster = 1.0 / (1.0 + n * n).sqrt();
        assert!((fresnel(brewster, n) - 0.5 * (1.25f64 / 3.25) * (1.25 / 3.25)).abs() < 1e-15);
        for mu in [0.05, 0.3, 0.8] {
            let inner = refract(mu, n).unwrap();
            assert!((fresnel(mu, n) - fresnel(inner, 1.0 / n)).abs() < 1e-12);
            assert!((refract(inner, 1.0 / n).unwrap() - mu).abs() < 1e-12);
        }
        assert_eq!(fresnel(0.7, 1.0 / n), 1.0);
        assert_eq!([fresnel(0.0, n), fresnel(0.3, 1.0)], [1.0, 0.0]);
    }

    /// The approximation is exact at both ends and off by at most 0.06, towards the horizon.
    #[test]
    fn the_papers_approximation() {
        let n = 1.34;
        assert!((lazanyi_szirmay_kalos(1.0, n) - fresnel(1.0, n)).abs() < 1e-15);
        assert!((lazanyi_szirmay_kalos(0.0, n) - 1.0).abs() < 1e-15);
        let off = |k: usize| (lazanyi_szirmay_kalos(k as f64 / 1e3, n) - fresnel(k as f64 / 1e3, n)).abs();
        let worst = (0..=1000).map(off).fold(0.0, f64::max);
        assert!(worst > 0.04 && worst < 0.06, "{worst}");
    }
}
