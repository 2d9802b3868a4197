//! Columns (path integrals of relative density) of every constituent along rays, in f64.

use super::levels::Levels;
use crate::medium::{DensityProfile, Medium};

/// Gauss–Legendre nodes and weights on (0, 1), three points: the error over a shell of a quarter scale
/// height is below 1e-7.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// Relative densities as a cubic polynomial of height in each shell between fine levels.
#[derive(Clone, Debug)]
pub struct Shells {
    pub edges: Vec<f64>,
    pub constituents: usize,
    /// `[shell][constituent]`: coefficients against (r − lower edge) / thickness.
    cubic: Vec<[f64; 4]>,
}

impl Shells {
    pub fn new(medium: &Medium, levels: &Levels) -> Self {
        let mut cubic = Vec::new();
        for pair in levels.fine.windows(2) {
            for c in &medium.constituents {
                cubic.push(fit(&c.density, pair[0] - medium.ground_radius, pair[1] - medium.ground_radius));
            }
        }
        Shells { edges: levels.fine.clone(), constituents: medium.constituents.len(), cubic }
    }

    /// Number of shells.
    pub fn len(&self) -> usize {
        self.edges.len() - 1
    }

    /// The shell that holds radius `r`.
    pub fn find(&self, r: f64) -> usize {
        self.edges.partition_point(|&e| e <= r).clamp(1, self.len()) - 1
    }

    /// Relative density of constituent `c` at radius `r` inside `shell`.
    #[inline(always)]
    pub fn density(&self, shell: usize, c: usize, r: f64) -> f64 {
        let x = (r - self.edges[shell]) / (self.edges[shell + 1] - self.edges[shell]);
        polynomial(&self.cubic[shell * self.constituents + c], x).max(0.0)
    }

    /// Adds to `columns` (one a constituent, m) the path inside one shell from `t0` to `t1`, lengths along
    /// the ray from its point nearest the centre, whose squared distance from the centre is `b2`.
    #[inline(always)]
    pub fn add_path(&self, shell: usize, b2: f64, t0: f64, t1: f64, columns: &mut [f64]) {
        let low = self.edges[shell];
        let scale = 1.0 / (self.edges[shell + 1] - low);
        let cubics = &self.cubic[shell * self.constituents..][..self.constituents];
        for (place, weight) in GAUSS {
            let t = t0 + (t1 - t0) * place;
            let x = ((b2 + t * t).sqrt() - low) * scale;
            let step = weight * (t1 - t0).abs();
            for (column, cubic) in columns.iter_mut().zip(cubics) {
                *column += step * polynomial(cubic, x);
            }
        }
    }

    /// Adds, for one constituent and many rays at once, the way between two radii inside one shell, counted
    /// `passes` times. `b2`: squared distances of the rays' lines from the centre.
    #[inline(always)]
    fn add_between(
        &self,
        shell: usize,
        c: usize,
        radii: [f64; 2],
        passes: f64,
        b2: &[f64],
        sums: &mut [f64],
    ) {
        let low = self.edges[shell];
        let scale = 1.0 / (self.edges[shell + 1] - low);
        let cubic = self.cubic[shell * self.constituents + c];
        let [inner, outer] = radii.map(|r| r * r);
        for (b2, sum) in b2.iter().zip(sums.iter_mut()) {
            let t0 = (inner - b2).max(0.0).sqrt();
            let length = (outer - b2).max(0.0).sqrt() - t0;
            let mut inside = 0.0;
            for (place, weight) in GAUSS {
                let t = t0 + length * place;
                inside += weight * polynomial(&cubic, ((b2 + t * t).sqrt() - low) * scale);
            }
            *sum += passes * length * inside;
        }
    }

    /// Columns of many rays from radius `r` to the top, `[constituent][ray]`. The first `upward` rays start
    /// upwards, the others downwards; none meets the ground.
    #[inline(always)]
    pub fn columns_to_top(&self, r: f64, b2: &[f64], upward: usize) -> Vec<f64> {
        let count = b2.len();
        let mut sums = vec![0.0; count * self.constituents];
        let start = self.find(r);
        for shell in 0..self.len() {
            let (low, high) = (self.edges[shell], self.edges[shell + 1]);
            for c in 0..self.constituents {
                let sums = &mut sums[c * count..][..count];
                if shell <= start {
                    let below = [low, high.min(r)];
                    self.add_between(shell, c, below, 2.0, &b2[upward..], &mut sums[upward..]);
                }
                if shell >= start {
                    self.add_between(shell, c, [low.max(r), high], 1.0, b2, sums);
                }
            }
        }
        sums
    }

    /// Columns of many rays from radius `r` down to the ground, `[constituent][ray]`.
    #[inline(always)]
    pub fn columns_to_ground(&self, r: f64, b2: &[f64]) -> Vec<f64> {
        let count = b2.len();
        let mut sums = vec![0.0; count * self.constituents];
        for shell in 0..=self.find(r) {
            let part = [self.edges[shell], self.edges[shell + 1].min(r)];
            for c in 0..self.constituents {
                self.add_between(shell, c, part, 1.0, b2, &mut sums[c * count..][..count]);
            }
        }
        sums
    }

    /// Columns from radius `r` to the top of the atmosphere along a direction of zenith cosine `mu` that does
    /// not meet the ground, added to `columns`.
    pub fn add_to_top(&self, r: f64, mu: f64, columns: &mut [f64]) {
        let b2 = r * r * (1.0 - mu * mu);
        let along = |radius: f64| (radius * radius - b2).max(0.0).sqrt();
        let start = self.find(r);
        if mu < 0.0 {
            // Down to the point nearest the centre and up again to `r`: the same path twice.
            let nearest = self.find(b2.sqrt());
            for shell in nearest..=start {
                let low = if shell == nearest { 0.0 } else { along(self.edges[shell]) };
                let high = if shell == start { along(r) } else { along(self.edges[shell + 1]) };
                self.add_path(shell, b2, low, high, columns);
                self.add_path(shell, b2, low, high, columns);
            }
        }
        for shell in start..self.len() {
            let low = if shell == start { along(r) } else { along(self.edges[shell]) };
            self.add_path(shell, b2, low, along(self.edges[shell + 1]), columns);
        }
    }
}

#[inline(always)]
fn polynomial(c: &[f64; 4], x: f64) -> f64 {
    c[0] + x * (c[1] + x * (c[2] + x * c[3]))
}

/// The cubic through the density at four Chebyshev points of a shell, so that jumps at its edges do not
/// leak in.
fn fit(density: &DensityProfile, low: f64, high: f64) -> [f64; 4] {
    const X: [f64; 4] =
        [0.038_060_233_744_356_6, 0.308_658_283_817_455_1, 0.691_341_716_182_544_9, 0.961_939_766_255_643_4];
    let y = X.map(|x| density.at(low + (high - low) * x));
    // Newton's divided differences, then expanded into powers.
    let d01 = (y[1] - y[0]) / (X[1] - X[0]);
    let d12 = (y[2] - y[1]) / (X[2] - X[1]);
    let d23 = (y[3] - y[2]) / (X[3] - X[2]);
    let d012 = (d12 - d01) / (X[2] - X[0]);
    let d123 = (d23 - d12) / (X[3] - X[1]);
    let d = (d123 - d012) / (X[3] - X[0]);
    let c3 = d;
    let c2 = d012 - d * (X[0] + X[1] + X[2]);
    let c1 = d01 - d012 * (X[0] + X[1]) + d * (X[0] * X[1] + X[0] * X[2] + X[1] * X[2]);
    let c0 = y[0] - d01 * X[0] + d012 * X[0] * X[1] - d * X[0] * X[1] * X[2];
    [c0, c1, c2, c3]
}
