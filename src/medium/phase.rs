//! Phase functions: the angular distribution of scattered light, 1/sr, integrating to 1 over the sphere.

use std::f64::consts::PI;
use std::sync::Arc;

/// A phase function of the cosine `nu` of the scattering angle (+1: straight on).
#[derive(Clone, Debug, PartialEq)]
pub enum PhaseFunction {
    Isotropic,
    /// Molecular scattering with depolarisation: 3/(16π(1+2γ)) [(1+3γ) + (1−γ) ν²], where γ follows from the
    /// King factor F = (6+3δ)/(6−7δ), γ = δ/(2−δ) (Bucholtz 1995, Eq. 12). F = 1 is Elek & Kmoch Eq. 4.
    Rayleigh {
        king_factor: f64,
    },
    /// Henyey & Greenstein 1941; its mean cosine is g.
    HenyeyGreenstein {
        g: f64,
    },
    /// Cornette & Shanks 1992, Elek & Kmoch Eq. 5; its mean cosine is 3g(4+g²)/(5(2+g²)).
    CornetteShanks {
        g: f64,
    },
    /// weight·HG(g1) + (1−weight)·HG(g2).
    DoubleHenyeyGreenstein {
        g1: f64,
        g2: f64,
        weight: f64,
    },
    /// Tabulated in ν (rising from −1 to 1), linear between nodes, normalised.
    Tabulated {
        nodes: Arc<Vec<(f64, f64)>>,
    },
}

impl PhaseFunction {
    /// A tabulated function from (ν, relative value) nodes that rise from −1 to 1, normalised to 1.
    pub fn tabulated(mut nodes: Vec<(f64, f64)>) -> Self {
        let integral: f64 = nodes.windows(2).map(|n| (n[1].0 - n[0].0) * (n[0].1 + n[1].1) * PI).sum();
        for n in &mut nodes {
            n.1 /= integral;
        }
        PhaseFunction::Tabulated { nodes: Arc::new(nodes) }
    }

    /// The Cornette–Shanks function of a given mean cosine (−1 < m < 1): its parameter by bisection.
    pub fn cornette_shanks_of_mean_cosine(mean_cosine: f64) -> Self {
        let (mut low, mut high) = (-1.0, 1.0);
        for _ in 0..100 {
            let g = 0.5 * (low + high);
            if (PhaseFunction::CornetteShanks { g }).mean_cosine() < mean_cosine {
                low = g;
            } else {
                high = g;
            }
        }
        PhaseFunction::CornetteShanks { g: 0.5 * (low + high) }
    }

    /// Value at the cosine of the scattering angle, 1/sr.
    #[inline]
    pub fn value(&self, nu: f64) -> f64 {
        match self {
            PhaseFunction::Isotropic => 1.0 / (4.0 * PI),
            PhaseFunction::Rayleigh { king_factor } => {
                let gamma = rayleigh_gamma(*king_factor);
                3.0 / (16.0 * PI * (1.0 + 2.0 * gamma)) * (1.0 + 3.0 * gamma + (1.0 - gamma) * nu * nu)
            }
            PhaseFunction::HenyeyGreenstein { g } => henyey_greenstein(*g, nu),
            PhaseFunction::CornetteShanks { g } => {
                henyey_greenstein(*g, nu) * 1.5 * (1.0 + nu * nu) / (2.0 + g * g)
            }
            PhaseFunction::DoubleHenyeyGreenstein { g1, g2, weight } => {
                weight * henyey_greenstein(*g1, nu) + (1.0 - weight) * henyey_greenstein(*g2, nu)
            }
            PhaseFunction::Tabulated { nodes } => {
                let after = nodes.partition_point(|n| n.0 <= nu).clamp(1, nodes.len() - 1);
                let (a, b) = (nodes[after - 1], nodes[after]);
                a.1 + (b.1 - a.1) * ((nu - a.0) / (b.0 - a.0)).clamp(0.0, 1.0)
            }
        }
    }

    /// Mean cosine of the scattering angle, the Legendre coefficient χ₁.
    pub fn mean_cosine(&self) -> f64 {
        match self {
            PhaseFunction::Isotropic | PhaseFunction::Rayleigh { .. } => 0.0,
            PhaseFunction::HenyeyGreenstein { g } => *g,
            PhaseFunction::CornetteShanks { g } => 3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g)),
            PhaseFunction::DoubleHenyeyGreenstein { g1, g2, weight } => weight * g1 + (1.0 - weight) * g2,
            PhaseFunction::Tabulated { .. } => self.legendre(1)[1],
        }
    }

    /// Legendre coefficients χ_0 … χ_degree, with p(ν) = 1/4π Σ (2l+1) χ_l P_l(ν), χ_0 = 1.
    pub fn legendre(&self, degree: usize) -> Vec<f64> {
        let powers = |g: f64| {
            let mut chi = vec![1.0; degree + 1];
            for l in 1..=degree {
                chi[l] = chi[l - 1] * g;
            }
            chi
        };
        match self {
            PhaseFunction::Isotropic => powers(0.0),
            PhaseFunction::Rayleigh { king_factor } => {
                let gamma = rayleigh_gamma(*king_factor);
                let mut chi = powers(0.0);
                if degree >= 2 {
                    chi[2] = 0.1 * (1.0 - gamma) / (1.0 + 2.0 * gamma);
                }
                chi
            }
            PhaseFunction::HenyeyGreenstein { g } => powers(*g),
            PhaseFunction::DoubleHenyeyGreenstein { g1, g2, weight } => {
                powers(*g1).iter().zip(powers(*g2)).map(|(a, b)| weight * a + (1.0 - weight) * b).collect()
            }
            PhaseFunction::CornetteShanks { g } => cornette_shanks_legendre(*g, degree),
            PhaseFunction::Tabulated { nodes } => tabulated_legendre(nodes, degree),
        }
    }
}

fn rayleigh_gamma(king_factor: f64) -> f64 {
    let delta = 6.0 * (king_factor - 1.0) / (3.0 + 7.0 * king_factor);
    delta / (2.0 - delta)
}

#[inline]
fn henyey_greenstein(g: f64, nu: f64) -> f64 {
    let d = 1.0 + g * g - 2.0 * g * nu;
    (1.0 - g * g) / (4.0 * PI * d * d.sqrt())
}

/// (1 + ν²) times an expansion in Legendre polynomials is one again: ν P_l = [(l+1) P_{l+1} + l P_{l−1}] /
/// (2l+1), applied twice to Henyey–Greenstein's coefficients gˡ.
fn cornette_shanks_legendre(g: f64, degree: usize) -> Vec<f64> {
    let n = degree + 3;
    let mut a = vec![1.0; n + 2];
    for l in 1..n + 2 {
        a[l] = a[l - 1] * g;
    }
    let times_nu = |a: &[f64]| -> Vec<f64> {
        // With f = Σ (2l+1) a_l P_l, the coefficient of ν f is [l a_{l−1} + (l+1) a_{l+1}] / (2l+1).
        (0..a.len() - 1)
            .map(|l| {
                let below = if l > 0 { l as f64 * a[l - 1] } else { 0.0 };
                (below + (l + 1) as f64 * a[l + 1]) / (2 * l + 1) as f64
            })
            .collect()
    };
    let twice = times_nu(&times_nu(&a));
    (0..=degree).map(|l| 1.5 / (2.0 + g * g) * (a[l] + twice[l])).collect()
}

/// Integrals of linear pieces a + bν, by ∫ P_l = (P_{l+1} − P_{l−1})/(2l+1) and, for ν P_l, the recurrence. In pieces
/// too narrow for P_l to bend, where differences of antiderivatives would drown in rounding (sharp peaks have pieces
/// of 1e-9 and steep slopes), by Gauss–Legendre with five nodes.
fn tabulated_legendre(nodes: &[(f64, f64)], degree: usize) -> Vec<f64> {
    let mut chi = vec![0.0; degree + 1];
    let bend = ((degree + 1) * (degree + 1)) as f64;
    for piece in nodes.windows(2) {
        let ((from, low), (to, high)) = (piece[0], piece[1]);
        let slope = (high - low) / (to - from);
        if (to - from) * bend < 1.0 {
            for (x, weight) in FIVE_NODES {
                let (nu, value) = (from + (to - from) * x, low + (high - low) * x);
                add_legendre(&mut chi, nu, (to - from) * weight * value);
            }
            continue;
        }
        let start = low - slope * from;
        let (before, after) = (antiderivatives(from, degree), antiderivatives(to, degree));
        for ((c, a), b) in chi.iter_mut().zip(&after).zip(&before) {
            *c += start * (a[0] - b[0]) + slope * (a[1] - b[1]);
        }
    }
    let norm = chi[0];
    chi.iter().map(|c| c / norm).collect()
}

/// Gauss–Legendre on (0, 1).
const FIVE_NODES: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// Adds weight · P_l(ν) for every degree.
fn add_legendre(sums: &mut [f64], nu: f64, weight: f64) {
    let (mut before, mut now) = (0.0, 1.0);
    for (l, sum) in sums.iter_mut().enumerate() {
        *sum += weight * now;
        let next = ((2 * l + 1) as f64 * nu * now - l as f64 * before) / (l + 1) as f64;
        (before, now) = (now, next);
    }
}

/// Antiderivatives of P_l and of ν P_l at ν, for every degree.
fn antiderivatives(nu: f64, degree: usize) -> Vec<[f64; 2]> {
    let mut p = vec![1.0, nu];
    for l in 1..=degree + 1 {
        p.push(((2 * l + 1) as f64 * nu * p[l] - l as f64 * p[l - 1]) / (l + 1) as f64);
    }
    let below = |l: usize, k: usize| if l >= k { p[l - k] } else { 0.0 };
    // Of P_n; P_{−1} counts as nothing.
    let of = |n: usize| (p[n + 1] - below(n, 1)) / (2 * n + 1) as f64;
    (0..=degree)
        .map(|l| {
            let lower = if l > 0 { l as f64 * of(l - 1) } else { 0.0 };
            [of(l), ((l + 1) as f64 * of(l + 1) + lower) / (2 * l + 1) as f64]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<PhaseFunction> {
        vec![
            PhaseFunction::Isotropic,
            PhaseFunction::Rayleigh { king_factor: 1.0 },
            PhaseFunction::Rayleigh { king_factor: 1.06 },
            PhaseFunction::HenyeyGreenstein { g: -0.3 },
            PhaseFunction::CornetteShanks { g: 0.76 },
            PhaseFunction::DoubleHenyeyGreenstein { g1: 0.9, g2: -0.2, weight: 0.7 },
            PhaseFunction::tabulated(vec![(-1.0, 0.5), (0.2, 1.0), (1.0, 7.0)]),
        ]
    }

    /// A phase function shares out light: its integral is 1, and its expansion is its own moments.
    #[test]
    fn expansions_are_the_moments_of_the_values() {
        const N: usize = 400_000;
        for phase in all() {
            let chi = phase.legendre(3);
            let mut sums = [0.0; 4];
            for k in 0..N {
                let nu = -1.0 + 2.0 * (k as f64 + 0.5) / N as f64;
                let v = 2.0 * PI * phase.value(nu) * 2.0 / N as f64;
                let p3 = 0.5 * nu * (5.0 * nu * nu - 3.0);
                for (s, p) in sums.iter_mut().zip([1.0, nu, 0.5 * (3.0 * nu * nu - 1.0), p3]) {
                    *s += v * p;
                }
            }
            for l in 0..4 {
                assert!((chi[l] - sums[l]).abs() < 1e-7, "{phase:?} l={l}: {} {}", chi[l], sums[l]);
            }
            assert!((phase.mean_cosine() - chi[1]).abs() < 1e-12);
        }
    }

    /// The parameter of Cornette–Shanks is found from the mean cosine; 0.76 has the mean cosine 0.80957.
    #[test]
    fn cornette_shanks_by_mean_cosine() {
        let g: f64 = 0.76;
        let mean = 3.0 * g * (4.0 + g * g) / (5.0 * (2.0 + g * g));
        match PhaseFunction::cornette_shanks_of_mean_cosine(mean) {
            PhaseFunction::CornetteShanks { g: found } => assert!((found - g).abs() < 1e-12),
            other => panic!("{other:?}"),
        }
    }

    /// A peak 1e-9 wide on an even ground, a third of all: the peak has every moment 1, the ground none but the first.
    #[test]
    fn moments_of_a_narrow_peak() {
        let chi = tabulated_legendre(&[(-1.0, 0.5), (1.0 - 1e-9, 0.5), (1.0, 1e9)], 24);
        for c in &chi[1..] {
            assert!((c - 1.0 / 3.0).abs() < 1e-6, "{chi:?}");
        }
    }
}
