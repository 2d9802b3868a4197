//! Angular moments of the radiance: real spherical harmonics that are even in the azimuth from the sun.
//!
//! With P̄_lm(mu) = √((2 − δ_m0)(l−m)!/(l+m)!) P_l^m(mu) / sin^m θ, the moments of the radiance I are
//!   I_lm = ∫ I(ω) P̄_lm(mu) sin^m θ cos mφ dω
//! and by the addition theorem a phase function with Legendre coefficients χ_l scatters into direction v
//!   S(v) = Σ_m sin^m θ_v cos mφ_v Σ_l (2l+1)/4π χ_l P̄_lm(mu_v) I_lm.
//! Degrees 0 and 2 alone are exact for Rayleigh scattering. What is stored is I_lm / s^min(m,2) with s the
//! sine of the sun's zenith angle: m-fold azimuth structure vanishes like s^m when the sun stands overhead.

/// The (degree, order) pairs that a medium needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Basis {
    /// Sorted by order, then degree.
    pub terms: Vec<(usize, usize)>,
    /// Largest order + 1.
    pub modes: usize,
    /// Order m of each term.
    pub orders: Vec<usize>,
    /// Where the terms of each order begin, and one more.
    starts: Vec<usize>,
    /// The recurrence over degrees of each order, one after the other.
    steps: Vec<Step>,
}

/// P_l^m / sin^m θ = a mu P_(l−1)^m − b P_(l−2)^m, begun at l = m with b the value itself.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Step {
    begins: bool,
    a: f64,
    b: f64,
    norm: f64,
    /// Number of the term; none for a degree that the basis lacks.
    term: Option<usize>,
}

impl Step {
    fn new(l: usize, m: usize, term: Option<usize>) -> Self {
        let (a, b) = if l == m {
            (0.0, (1..=m).fold(1.0, |p, k| p * (2 * k - 1) as f64))
        } else {
            ((2 * l - 1) as f64 / (l - m) as f64, (l + m - 1) as f64 / (l - m) as f64)
        };
        Step { begins: l == m, a, b, norm: norm(l, m), term }
    }
}

/// Largest degree that a basis may hold, and the number of its terms.
pub(super) const MOST_DEGREE: usize = 12;
pub(super) const MOST_TERMS: usize = (MOST_DEGREE + 1) * (MOST_DEGREE + 2) / 2;

impl Basis {
    /// All orders of the given degrees.
    pub fn new(degrees: &[usize]) -> Self {
        let largest = degrees.iter().copied().max().unwrap_or(0);
        let mut terms = Vec::new();
        for m in 0..=largest {
            terms.extend(degrees.iter().filter(|&&l| l >= m).map(|&l| (l, m)));
        }
        let mut steps = Vec::new();
        for m in 0..=largest {
            steps.extend((m..=largest).map(|l| Step::new(l, m, terms.iter().position(|&t| t == (l, m)))));
        }
        let orders: Vec<usize> = terms.iter().map(|t| t.1).collect();
        let starts = (0..=MOST_DEGREE + 1).map(|m| orders.partition_point(|&o| o < m)).collect();
        Basis { terms, modes: largest + 1, orders, starts, steps }
    }

    pub fn len(&self) -> usize {
        self.terms.len()
    }

    /// Numbers of the terms of an order.
    #[inline(always)]
    pub fn of_order(&self, m: usize) -> std::ops::Range<usize> {
        self.starts[m]..self.starts[m + 1]
    }

    /// P̄_lm(mu) for every term.
    pub fn polynomials(&self, mu: f64) -> Vec<f64> {
        let mut out = [0.0; MOST_TERMS];
        self.fill(mu, &mut out);
        out[..self.len()].iter().map(|&v| f64::from(v)).collect()
    }

    /// P̄_lm(mu) for every term, in single precision.
    #[inline(always)]
    pub fn fill(&self, mu: f64, out: &mut [f32; MOST_TERMS]) {
        let (mut now, mut before) = (0.0, 0.0);
        for step in &self.steps {
            (before, now) =
                if step.begins { (0.0, step.b) } else { (now, step.a * mu * now - step.b * before) };
            if let Some(t) = step.term {
                out[t] = (step.norm * now) as f32;
            }
        }
    }

    /// Number of the term of a degree and order.
    pub fn index(&self, l: usize, m: usize) -> Option<usize> {
        self.terms.iter().position(|&t| t == (l, m))
    }
}

/// √((2 − δ_m0)(l−m)!/(l+m)!)
fn norm(l: usize, m: usize) -> f64 {
    let ratio = (l - m + 1..=l + m).fold(1.0, |r, k| r / k as f64);
    (ratio * if m == 0 { 1.0 } else { 2.0 }).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The addition theorem: Σ_m P̄_lm(a) P̄_lm(b) (sin sin)^m cos mφ = P_l(cos of the angle between).
    #[test]
    fn addition_theorem_holds() {
        let basis = Basis::new(&[0, 1, 2, 3, 4, 5]);
        let (a, b, phi) = (0.3_f64, -0.62_f64, 1.1_f64);
        let sines = ((1.0 - a * a) * (1.0 - b * b)).sqrt();
        let nu = a * b + sines * libm::cos(phi);
        let (pa, pb) = (basis.polynomials(a), basis.polynomials(b));
        for l in 0..=5 {
            let sum: f64 = (0..=l)
                .map(|m| {
                    let i = basis.index(l, m).unwrap();
                    pa[i] * pb[i] * libm::pow(sines, m as f64) * libm::cos(m as f64 * phi)
                })
                .sum();
            let legendre = [
                1.0,
                nu,
                1.5 * nu * nu - 0.5,
                2.5 * nu * nu * nu - 1.5 * nu,
                4.375 * nu * nu * nu * nu - 3.75 * nu * nu + 0.375,
                7.875 * nu * nu * nu * nu * nu - 8.75 * nu * nu * nu + 1.875 * nu,
            ][l];
            assert!((sum - legendre).abs() < 1e-6, "degree {l}: {sum} against {legendre}");
        }
    }
}
