//! The exponentials of depth that light in homogeneous water is made of, at one wavelength.

use super::matrix::Matrix;
use super::streams::{legendre, streams};
use super::{Streams, Surface};
use crate::medium::WaterMedium;
use std::f64::consts::PI;

/// Largest single-scattering albedo that is solved as it is: closer to 1 the smallest eigenvalue drowns in
/// rounding. An optical depth of 30 then loses 1e-4 of its light at the most; no water is as clear.
const MOST_ALBEDO: f64 = 1.0 - 1e-7;

/// One wavelength of a water, ready for any depth.
pub struct Slab {
    pub surface: Surface,
    /// Extinction with the forward peak taken out, 1/m.
    pub extinction: f64,
    /// ω / (1 − ω f), with which the exact phase function scatters once per scaled optical depth.
    pub once: f64,
    /// Fourier mode in azimuth: light is Σ (2 − δ_m0) I_m cos(m azimuth).
    pub(super) mode: usize,
    /// ω (1 − f) / (1 − ω f) / 2 · (2l + 1) χ'_l, for l from the mode on.
    pub(super) kernel: Vec<f64>,
    /// Cosines and weights of the streams.
    pub(super) nodes: Vec<(f64, f64)>,
    /// Reflectance of the underside for each stream.
    pub(super) reflects: Vec<f64>,
    /// Rates of decay over scaled optical depth.
    pub(super) rates: Vec<f64>,
    /// Light up and down along the streams (rows) in each decaying mode (columns); swapped in a growing one.
    pub(super) up: Matrix,
    pub(super) down: Matrix,
    /// Moments Σ w P_l(mu) I of each decaying mode: `[mode][l]`.
    pub(super) moments: Vec<Vec<f64>>,
    triangle: Matrix,
    vectors: Matrix,
    polynomials: Vec<Vec<f64>>,
}

impl Slab {
    /// Solves the eigenvalue problem of wavelength number `w`; `surface` with n = 1 is none.
    ///
    /// Sum S and difference D of the light up and down obey mu D' = (1 − F W) S and mu S' = (1 − E W) D with
    /// F and E the even and odd part of the phase expansion and W the weights. With y = √(mu w) S and
    /// z = √(mu w) D these are z' = Q y, y' = P z of symmetric positive definite P and Q, and P = L Lᵀ makes
    /// Lᵀ Q L the symmetric matrix whose eigenvalues are the squared rates.
    pub fn new(medium: &WaterMedium, w: usize, surface: Surface, resolution: Streams) -> Slab {
        Slab::of_mode(medium, w, surface, resolution, 0)
    }

    /// The same for a Fourier mode in azimuth: polynomials become associated ones, whose parity goes by l − m.
    pub fn of_mode(
        medium: &WaterMedium,
        w: usize,
        surface: Surface,
        resolution: Streams,
        mode: usize,
    ) -> Slab {
        let nodes = streams(surface.critical(), resolution.per_panel);
        // Panels of p nodes integrate degree 2p − 1 exactly, which keeps the phase function normalised.
        let degree = 2 * resolution.per_panel - 1;
        let chi = medium.legendre(w, degree + 1);
        let peak = chi[degree + 1].clamp(0.0, 0.999);
        let extinction = medium.extinction(w);
        let scattering = medium.scattering(w);
        let albedo = if extinction > 0.0 { (scattering / extinction).min(MOST_ALBEDO) } else { 0.0 };
        let scaled = albedo * (1.0 - peak) / (1.0 - albedo * peak);
        let kernel: Vec<f64> = (mode..=degree)
            .map(|l| 0.5 * scaled * (2 * l + 1) as f64 * (chi[l] - peak) / (1.0 - peak))
            .collect();
        let polynomials: Vec<Vec<f64>> = nodes.iter().map(|&(mu, _)| legendre(mu, mode, degree)).collect();
        let part = |odd: usize| {
            Matrix::of(nodes.len(), nodes.len(), |i, j| {
                let ((mi, wi), (mj, wj)) = (nodes[i], nodes[j]);
                let sum: f64 = (odd..kernel.len())
                    .step_by(2)
                    .map(|l| 2.0 * kernel[l] * polynomials[i][l] * polynomials[j][l])
                    .sum();
                let one = if i == j { 1.0 } else { 0.0 };
                (one - (wi * wj).sqrt() * sum) / (mi * mj).sqrt()
            })
        };
        let (p, q) = (part(1), part(0));
        let triangle = p.cholesky().expect("1 − E W is positive definite where ω χ_l < 1");
        let (squares, vectors) = triangle.transposed().times(&q).times(&triangle).symmetric_eigen();
        let rates: Vec<f64> = squares.iter().map(|k2| k2.max(1e-14).sqrt()).collect();
        let mut slab = Slab {
            reflects: nodes.iter().map(|&(mu, _)| surface.reflects_down(mu)).collect(),
            surface,
            mode,
            extinction: extinction * (1.0 - albedo * peak),
            once: albedo / (1.0 - albedo * peak),
            kernel,
            up: Matrix::zero(0, 0),
            down: Matrix::zero(0, 0),
            moments: Vec::new(),
            nodes,
            rates,
            triangle,
            vectors,
            polynomials,
        };
        slab.set_modes();
        slab
    }

    /// The rate at which light fades far from surface and bed, over scaled optical depth.
    pub fn slowest(&self) -> f64 {
        self.rates.iter().fold(f64::INFINITY, |a: f64, &b| a.min(b))
    }

    fn set_modes(&mut self) {
        let n = self.nodes.len();
        let y = self.triangle.times(&self.vectors);
        let column = |j: usize| (0..n).map(|i| self.vectors.at(i, j)).collect::<Vec<f64>>();
        let z: Vec<Vec<f64>> = (0..n).map(|j| self.triangle.backward(&column(j))).collect();
        let root = |i: usize| (self.nodes[i].0 * self.nodes[i].1).sqrt();
        let half = |sign: f64| {
            Matrix::of(n, n, |i, j| 0.5 * (y.at(i, j) - sign * self.rates[j] * z[j][i]) / root(i))
        };
        let (up, down) = (half(1.0), half(-1.0));
        self.moments = (0..n)
            .map(|j| {
                let light = |i: usize| (up.at(i, j), down.at(i, j));
                self.moments_of(light)
            })
            .collect();
        (self.up, self.down) = (up, down);
    }

    /// Σ w P_l(mu) I over all streams, where `light` gives those up and down.
    pub(super) fn moments_of(&self, light: impl Fn(usize) -> (f64, f64)) -> Vec<f64> {
        let mut m = vec![0.0; self.kernel.len()];
        for (i, &(_, w)) in self.nodes.iter().enumerate() {
            let (up, down) = light(i);
            for (l, m) in m.iter_mut().enumerate() {
                let sign = if l % 2 == 0 { 1.0 } else { -1.0 };
                *m += w * self.polynomials[i][l] * (up + sign * down);
            }
        }
        m
    }

    /// The mode's polynomials at a cosine.
    pub(super) fn polynomials_at(&self, mu: f64) -> Vec<f64> {
        legendre(mu, self.mode, self.mode + self.kernel.len() - 1)
    }

    /// Scattered light per scaled optical depth from moments, upwards and downwards along every stream.
    pub(super) fn sources(&self, moments: &[f64]) -> Vec<[f64; 2]> {
        let along = |p: &Vec<f64>| {
            let (mut even, mut odd) = (0.0, 0.0);
            for (l, m) in moments.iter().enumerate() {
                let part = self.kernel[l] * p[l] * m;
                if l % 2 == 0 { even += part } else { odd += part }
            }
            [even + odd, even - odd]
        };
        self.polynomials.iter().map(along).collect()
    }

    /// Scattered light per scaled optical depth from moments, into the direction of given polynomials.
    pub(super) fn scattered(&self, polynomials: &[f64], moments: &[f64]) -> f64 {
        self.kernel.iter().zip(polynomials).zip(moments).map(|((k, p), m)| k * p * m).sum()
    }

    /// The light along the streams that follows a beam of unit irradiance, cosine `mu`, as e^{−τ/mu}: up and
    /// down. `mu` must not be that of a mode.
    pub(super) fn particular(&self, mu: f64) -> (Vec<f64>, Vec<f64>) {
        let n = self.nodes.len();
        let a = 1.0 / mu;
        let beam = self.polynomials_at(-mu);
        let source = |i: usize, parity: usize| -> f64 {
            let sum: f64 = (parity..self.kernel.len())
                .step_by(2)
                .map(|l| self.kernel[l] * self.polynomials[i][l] * beam[l])
                .sum();
            // Up and down: even degrees add in the sum, odd ones in the difference.
            2.0 * sum / (2.0 * PI) * (self.nodes[i].1 / self.nodes[i].0).sqrt()
        };
        let h_sum: Vec<f64> = (0..n).map(|i| source(i, 0)).collect();
        let h_difference: Vec<f64> = (0..n).map(|i| source(i, 1)).collect();
        let solved = self.triangle.forward(&h_difference);
        let right: Vec<f64> = (0..n)
            .map(|i| (i..n).map(|k| self.triangle.at(k, i) * h_sum[k]).sum::<f64>() - a * solved[i])
            .collect();
        let c: Vec<f64> = (0..n)
            .map(|j| {
                let dot: f64 = (0..n).map(|i| self.vectors.at(i, j) * right[i]).sum();
                dot / (self.rates[j] * self.rates[j] - a * a)
            })
            .collect();
        let rotated: Vec<f64> = (0..n).map(|i| (0..n).map(|j| self.vectors.at(i, j) * c[j]).sum()).collect();
        let y: Vec<f64> =
            (0..n).map(|i| (0..=i).map(|k| self.triangle.at(i, k) * rotated[k]).sum()).collect();
        let rest: Vec<f64> = (0..n).map(|i| solved[i] - a * rotated[i]).collect();
        let z = self.triangle.backward(&rest);
        let root = |i: usize| (self.nodes[i].0 * self.nodes[i].1).sqrt();
        let up = (0..n).map(|i| 0.5 * (y[i] + z[i]) / root(i)).collect();
        let down = (0..n).map(|i| 0.5 * (y[i] - z[i]) / root(i)).collect();
        (up, down)
    }
}
