//! The unknown of the solver: angular moments of the radiance at each level and sun node, and the diffuse
//! irradiance of the ground at each sun node.

use super::kernels::Field;
use super::moments::Basis;
use super::optics::Optics;
use crate::lanes::Lanes;
use std::f64::consts::PI;

/// Moments I_lm / s^min(m,2) as `[level][sun node][term]`, and irradiances as `[sun node]`.
#[derive(Clone, Debug)]
pub struct State {
    pub suns: usize,
    pub terms: usize,
    pub moments: Vec<Lanes>,
    pub ground: Vec<Lanes>,
}

impl State {
    pub fn zero(levels: usize, suns: usize, terms: usize) -> Self {
        State {
            suns,
            terms,
            moments: vec![Lanes::ZERO; levels * suns * terms],
            ground: vec![Lanes::ZERO; suns],
        }
    }

    /// Adds another state lane by lane.
    pub fn add(&mut self, other: &State) {
        for (a, b) in self.moments.iter_mut().zip(&other.moments) {
            *a += *b;
        }
        for (a, b) in self.ground.iter_mut().zip(&other.ground) {
            *a += *b;
        }
    }

    /// Multiplies everything by a number.
    pub fn scale(&mut self, factor: f32) {
        for v in self.moments.iter_mut().chain(&mut self.ground) {
            *v = *v * factor;
        }
    }

    /// The field that this state makes the constituents in `group` scatter, on a sun axis `refinement` times
    /// as fine. `shares[constituent][level]`: scattering as a share of extinction at the state's levels.
    pub fn field(
        &self,
        basis: &Basis,
        optics: &Optics,
        shares: &[Vec<Lanes>],
        group: &[usize],
        refinement: &Refinement,
    ) -> Field {
        use rayon::prelude::*;
        let stride = self.suns * self.terms;
        let fine_stride = refinement.suns() * self.terms;
        let mut values = vec![Lanes::ZERO; self.moments.len() / stride * fine_stride];
        values.par_chunks_mut(fine_stride).zip(self.moments.par_chunks(stride)).enumerate().for_each(
            |(level, (out, from))| {
                let factors = source_factors(basis, optics, shares, group, level);
                crate::isa::run(
                    #[inline(always)]
                    || refinement.apply(from, out, &factors),
                );
            },
        );
        Field { terms: self.terms, values }
    }
}

/// Cubic interpolation from the nodes of a sun axis to finer ones, between which a straight line will do:
/// twilight fades by a factor e per degree, too fast for straight lines between the nodes themselves.
pub struct Refinement {
    /// Per fine node: first of the nodes used, and their weights.
    rows: Vec<(usize, Vec<f32>)>,
}

impl Refinement {
    /// From `suns` nodes to `factor` times as many intervals. Straight lines where `cubic` is false.
    pub fn new(suns: usize, factor: usize, cubic: bool) -> Self {
        let reach = if cubic { 1 } else { 0 };
        let rows = (0..=(suns - 1) * factor)
            .map(|fine| {
                let below = (fine / factor).min(suns - 2);
                let first = below.saturating_sub(reach);
                let last = (below + 1 + reach).min(suns - 1);
                let x = fine as f64 / factor as f64;
                (first, lagrange(first, last, x))
            })
            .collect();
        Refinement { rows }
    }

    /// Number of fine nodes.
    pub fn suns(&self) -> usize {
        self.rows.len()
    }

    /// From `[node][term]` to `[term][fine node]`.
    #[inline(always)]
    fn apply(&self, from: &[Lanes], out: &mut [Lanes], factors: &[Lanes]) {
        let terms = factors.len();
        for (t, out) in out.chunks_exact_mut(self.suns()).enumerate() {
            for ((first, weights), out) in self.rows.iter().zip(out) {
                let mut sum = Lanes::ZERO;
                for (k, w) in weights.iter().enumerate() {
                    sum += from[(first + k) * terms + t] * *w;
                }
                *out = sum * factors[t];
            }
        }
    }
}

/// Weights of the nodes `first` … `last` (at whole numbers) of the polynomial through them, at x.
fn lagrange(first: usize, last: usize, x: f64) -> Vec<f32> {
    (first..=last)
        .map(|k| {
            let others = (first..=last).filter(|&j| j != k);
            others.fold(1.0, |w, j| w * (x - j as f64) / (k as f64 - j as f64)) as f32
        })
        .collect()
}

/// (2l+1)/4π Σ f χ_l for every term at one level.
pub fn source_factors(
    basis: &Basis,
    optics: &Optics,
    shares: &[Vec<Lanes>],
    group: &[usize],
    level: usize,
) -> Vec<Lanes> {
    basis
        .terms
        .iter()
        .map(|&(l, _)| {
            let mut sum = Lanes::ZERO;
            for &c in group {
                sum += optics.legendre[c][l] * shares[c][level];
            }
            sum * ((2 * l + 1) as f64 / (4.0 * PI)) as f32
        })
        .collect()
}
