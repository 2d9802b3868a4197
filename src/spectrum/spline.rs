//! A cubic spline through the logarithm of positive samples.

/// Smallest share of the largest sample that is told from zero; far below what any sky holds.
const FLOOR: f64 = 1e-60;

/// ln 2: by how much a curve may rise over both neighbours between two samples.
const OVERSHOOT: f64 = std::f64::consts::LN_2;

/// Interpolates a smooth positive function from samples at fixed wavelengths: cubic spline of the
/// logarithm against wavelength, with limits that real skies never touch and that keep spiky or partly black
/// samples from ringing. One sample gives a constant, two an exponential; outside the samples the logarithm
/// goes on linearly, by one more step at the most.
pub struct LogSpline {
    wavelengths_nm: Vec<f64>,
    /// Second derivatives are linear in the samples: this is that (n × n) map, row by row.
    curvature: Vec<Vec<f64>>,
}

/// Logarithms of the samples, ready to be evaluated.
pub struct Fitted<'a> {
    spline: &'a LogSpline,
    logs: Vec<f64>,
    curvatures: Vec<f64>,
}

impl LogSpline {
    /// A spline over rising wavelengths (at least one), nm.
    pub fn new(wavelengths_nm: &[f64]) -> Self {
        let n = wavelengths_nm.len();
        assert!(n > 0 && wavelengths_nm.windows(2).all(|w| w[1] > w[0]), "wavelengths must rise");
        let mut curvature = vec![vec![0.0; n]; n];
        for k in 0..n {
            let mut unit = vec![0.0; n];
            unit[k] = 1.0;
            for (row, c) in curvature.iter_mut().zip(curvatures(wavelengths_nm, &unit)) {
                row[k] = c;
            }
        }
        LogSpline { wavelengths_nm: wavelengths_nm.to_vec(), curvature }
    }

    /// The wavelengths of the samples, nm.
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// Takes samples, one a wavelength; None where none is positive. Zeros, negatives and values below 1e-60
    /// of the largest count as that floor.
    pub fn fit(&self, samples: &[f64]) -> Option<Fitted<'_>> {
        assert_eq!(samples.len(), self.wavelengths_nm.len());
        let largest = samples.iter().fold(0.0_f64, |m, &v| m.max(v));
        if largest <= 0.0 {
            return None;
        }
        let logs: Vec<f64> = samples.iter().map(|&v| libm::log(v.max(largest * FLOOR))).collect();
        let dot = |row: &Vec<f64>| row.iter().zip(&logs).map(|(a, b)| a * b).sum();
        let curvatures = self.curvature.iter().map(dot).collect();
        Some(Fitted { spline: self, logs, curvatures })
    }
}

impl Fitted<'_> {
    /// Value at a wavelength (nm), in the unit of the samples.
    pub fn at(&self, wavelength_nm: f64) -> f64 {
        libm::exp(self.log_at(wavelength_nm))
    }

    fn log_at(&self, wavelength: f64) -> f64 {
        let (w, n) = (&self.spline.wavelengths_nm, self.logs.len());
        if n == 1 {
            return self.logs[0];
        }
        if wavelength < w[0] {
            return self.beyond(0, 1, wavelength);
        }
        if wavelength > w[n - 1] {
            return self.beyond(n - 1, n - 2, wavelength);
        }
        let right = w.partition_point(|&x| x <= wavelength).clamp(1, n - 1);
        self.between(right - 1, wavelength)
    }

    /// Cubic of segment i, kept near the samples at both of its ends.
    fn between(&self, i: usize, wavelength: f64) -> f64 {
        let (w, y, m) = (&self.spline.wavelengths_nm, &self.logs, &self.curvatures);
        let width = w[i + 1] - w[i];
        let (a, b) = ((w[i + 1] - wavelength) / width, (wavelength - w[i]) / width);
        let bend = width * width / 6.0 * ((a * a * a - a) * m[i] + (b * b * b - b) * m[i + 1]);
        let margin = self.margin(i);
        let (low, high) = (y[i].min(y[i + 1]) - margin, y[i].max(y[i + 1]) + margin);
        (a * y[i] + b * y[i + 1] + bend).clamp(low, high)
    }

    /// How far a curve may leave the range of a segment's ends. A parabola with its top inside leaves it by an
    /// eighth of its second difference, and each neighbouring segment then steps by half of that or more.
    fn margin(&self, i: usize) -> f64 {
        let step = |k: usize| (self.logs[k + 1] - self.logs[k]).abs();
        let left = if i > 0 { step(i - 1) } else { f64::INFINITY };
        let right = if i + 2 < self.logs.len() { step(i + 1) } else { f64::INFINITY };
        (0.5 * left.min(right)).min(OVERSHOOT)
    }

    /// Straight on from an end sample with the spline's slope there, by one segment's step at most.
    fn beyond(&self, end: usize, inner: usize, wavelength: f64) -> f64 {
        let (w, y, m) = (&self.spline.wavelengths_nm, &self.logs, &self.curvatures);
        let width = w[inner] - w[end];
        let slope = (y[inner] - y[end]) / width - width / 6.0 * (2.0 * m[end] + m[inner]);
        let most = (y[inner] - y[end]).abs();
        y[end] + (slope * (wavelength - w[end])).clamp(-most, most)
    }
}

/// Second derivatives at the nodes of the cubic spline through (x, y): the tridiagonal system solved by
/// elimination (Press et al., Numerical Recipes, Eq. 3.3.7). The third derivative is continuous at the second
/// and the last but one node ("not a knot"); three nodes give a parabola, two a line. A natural spline, without
/// curvature at its ends, would straighten the λ⁻⁴ of the violet end: five times the colour error on clear skies.
fn curvatures(x: &[f64], y: &[f64]) -> Vec<f64> {
    let n = x.len();
    let step = |i: usize| x[i + 1] - x[i];
    let bend = |i: usize| (y[i + 1] - y[i]) / step(i) - (y[i] - y[i - 1]) / step(i - 1);
    let mut m = vec![0.0; n];
    if n == 3 {
        m.fill(2.0 * bend(1) / (x[2] - x[0]));
    }
    if n < 4 {
        return m;
    }
    let mut ratio = vec![0.0; n];
    for i in 1..n - 1 {
        let (h0, h1) = (step(i - 1), step(i));
        let (mut below, mut diagonal, mut above) = (h0 / 6.0, (h0 + h1) / 3.0, h1 / 6.0);
        if i == 1 {
            // m₀ = m₁ + (m₁ − m₂) h₀/h₁
            diagonal += below * (1.0 + h0 / h1);
            above -= below * h0 / h1;
            below = 0.0;
        }
        if i == n - 2 {
            diagonal += h1 / 6.0 * (1.0 + h1 / h0);
            below -= h1 / 6.0 * h1 / h0;
            above = 0.0;
        }
        let pivot = diagonal - below * ratio[i - 1];
        ratio[i] = above / pivot;
        m[i] = (bend(i) - below * m[i - 1]) / pivot;
    }
    for i in (1..n - 2).rev() {
        m[i] -= ratio[i] * m[i + 1];
    }
    m[0] = m[1] + (m[1] - m[2]) * step(0) / step(1);
    m[n - 1] = m[n - 2] + (m[n - 2] - m[n - 3]) * step(n - 2) / step(n - 3);
    m
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A straight line in the logarithm is its own spline, for any number of samples, inside and outside.
    #[test]
    fn exponentials_are_exact() {
        let f = |w: f64| libm::exp(0.01 * (w - 500.0));
        for nodes in [vec![410.0, 700.0], vec![400.0, 433.0, 720.0], vec![390.0, 500.0, 510.0, 640.0, 770.0]]
        {
            let spline = LogSpline::new(&nodes);
            let samples: Vec<f64> = nodes.iter().map(|&w| f(w)).collect();
            let fitted = spline.fit(&samples).unwrap();
            for w in [380.0, 410.0, 455.5, 600.0, 780.0] {
                assert!((fitted.at(w) / f(w) - 1.0).abs() < 1e-12, "{nodes:?} {w}");
            }
        }
    }

    /// A cubic in the logarithm is its own spline, whatever the steps: nothing is bent at the ends.
    #[test]
    fn cubics_are_exact() {
        let f = |w: f64| {
            let t = (w - 560.0) / 200.0;
            libm::exp(0.3 + t * (1.0 + t * (0.4 - 0.7 * t)))
        };
        let nodes = [380.0, 420.0, 500.0, 540.0, 700.0, 780.0];
        let spline = LogSpline::new(&nodes);
        let fitted = spline.fit(&nodes.map(f)).unwrap();
        for w in 380..=780 {
            let w = f64::from(w);
            assert!((fitted.at(w) / f(w) - 1.0).abs() < 1e-12, "{w}");
        }
    }

    /// Samples are met exactly and one sample is a constant; no light at all is no curve.
    #[test]
    fn samples_are_kept() {
        let nodes = [400.0, 450.0, 520.0, 700.0];
        let samples = [3.0, 0.2, 5.0, 1e-9];
        let spline = LogSpline::new(&nodes);
        let fitted = spline.fit(&samples).unwrap();
        for (w, v) in nodes.iter().zip(samples) {
            assert!((fitted.at(*w) / v - 1.0).abs() < 1e-12);
        }
        assert_eq!(LogSpline::new(&[550.0]).fit(&[7.0]).unwrap().at(400.0), libm::exp(libm::log(7.0)));
        assert!(spline.fit(&[0.0; 4]).is_none());
    }

    /// A smooth bump narrower than the grid's third is followed to 2e-4 of its height: limits must not cut its top off.
    #[test]
    fn smooth_bumps_keep_their_tops() {
        let f = |w: f64| libm::exp(-((w - 563.0) / 90.0) * ((w - 563.0) / 90.0));
        let nodes: Vec<f64> = (0..15).map(|k| 380.0 + 400.0 * f64::from(k) / 14.0).collect();
        let spline = LogSpline::new(&nodes);
        let fitted = spline.fit(&nodes.iter().map(|&w| f(w)).collect::<Vec<_>>()).unwrap();
        for w in 420..740 {
            let w = f64::from(w);
            assert!((fitted.at(w) - f(w)).abs() < 2e-4, "{w}: {} {}", fitted.at(w), f(w));
        }
    }

    /// A black sample must not ring: next to it nothing exceeds twice the samples around.
    #[test]
    fn black_samples_do_not_ring() {
        let nodes: Vec<f64> = (0..9).map(|k| 380.0 + 50.0 * f64::from(k)).collect();
        let mut samples = vec![1.0; 9];
        samples[4] = 0.0;
        let spline = LogSpline::new(&nodes);
        let fitted = spline.fit(&samples).unwrap();
        for w in 380..=780 {
            let v = fitted.at(f64::from(w));
            assert!(v.is_finite() && (0.0..=2.0).contains(&v), "{w}: {v}");
        }
        assert!(fitted.at(580.0) < 1e-50);
    }
}
