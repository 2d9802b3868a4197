//! An approximate inverse of I − A: the same operator with the sun's height taken as constant along every ray,
//! so that each sun node is a column of its own, over the azimuthal mean alone.

use super::operator::Operator;
use super::state::{State, source_factors};
use crate::machine::lanes::{Lanes, WIDTH};
use std::f64::consts::{FRAC_1_PI, PI};

/// The lowest degrees of the azimuthal mean that take part; the rest is left to the iteration.
const DEGREES: usize = 3;
/// The same in thick air, where many more applications are saved.
const THICK_DEGREES: usize = 5;

/// LU factors of I − A of one column, sixteen wavelengths at once; the same for all sun nodes.
pub(super) struct Preconditioner {
    size: usize,
    levels: usize,
    /// Numbers of the terms that take part.
    terms: Vec<usize>,
    factors: Vec<Lanes>,
}

impl Preconditioner {
    pub(super) fn new(operator: &Operator) -> Self {
        let basis = operator.basis;
        let thick = operator.geometry.levels.is_refined();
        let terms: Vec<usize> = basis.of_order(0).take(if thick { THICK_DEGREES } else { DEGREES }).collect();
        let levels = operator.geometry.levels.coarse.len();
        let size = levels * terms.len() + 1;
        let mut p = Preconditioner { size, levels, terms, factors: vec![Lanes::ZERO; size * size] };
        p.assemble(operator);
        p.factorise();
        p
    }

    /// I − A, row by row: what the sources at every level and the ground send to one level's moments.
    fn assemble(&mut self, operator: &Operator) {
        let (size, count) = (self.size, self.terms.len());
        let levels = &operator.geometry.levels;
        let sources: Vec<Vec<Lanes>> = (0..levels.field.len())
            .map(|n| {
                source_factors(operator.basis, operator.optics, &operator.shares, &operator.scatterers, n)
            })
            .collect();
        for k in 0..size {
            self.factors[k * size + k] = Lanes::splat(1.0);
        }
        let mut row = vec![Lanes::ZERO; size];
        let turned = turned(operator);
        for (level, gather) in operator.geometry.gathers.iter().enumerate() {
            for ((d, _), ray) in gather.directions.iter().zip(&operator.rays[level]) {
                row.fill(Lanes::ZERO);
                for (s, weight) in ray.samples.iter().zip(&ray.weights) {
                    let weight = *weight * turned(s.cos_turn);
                    let p = operator.basis.polynomials(f64::from(s.mu));
                    for (n, share) in [(s.level as usize, 1.0 - s.place), (s.level as usize + 1, s.place)] {
                        if share > 0.0 {
                            let (first, between) = &levels.between[n];
                            for (level, part) in (*first..).zip(between) {
                                for (k, &t) in self.terms.iter().enumerate() {
                                    row[level * count + k] +=
                                        weight * sources[n][t] * (share * part * p[t] as f32);
                                }
                            }
                        }
                    }
                }
                if let Some(hit) = &ray.hit {
                    row[size - 1] =
                        hit.transmittance * turned(hit.cos_turn) * operator.optics.albedo * FRAC_1_PI as f32;
                }
                let p = operator.basis.polynomials(d.mu);
                let ring = 2.0 * PI * d.weight;
                for (k, &t) in self.terms.iter().enumerate() {
                    subtract(&mut self.factors[(level * count + k) * size..], &row, (ring * p[t]) as f32);
                }
                if level == 0 && d.mu > 0.0 {
                    subtract(&mut self.factors[(size - 1) * size..], &row, (ring * d.mu) as f32);
                }
            }
        }
    }

    /// Gaussian elimination without pivoting: light that is scattered comes back smaller, so the matrix is
    /// close enough to diagonally dominant, and the result only has to be a good guess.
    fn factorise(&mut self) {
        let size = self.size;
        for k in 0..size {
            let (upper, lower) = self.factors.split_at_mut((k + 1) * size);
            let pivot_row = &mut upper[k * size..];
            let inverse = reciprocal(pivot_row[k]);
            pivot_row[k] = inverse;
            for row in lower.chunks_exact_mut(size) {
                if row[k] == Lanes::ZERO {
                    continue;
                }
                let factor = row[k] * inverse;
                row[k] = factor;
                crate::machine::isa::run(
                    #[inline(always)]
                    || {
                        for (r, p) in row[k + 1..].iter_mut().zip(&pivot_row[k + 1..]) {
                            *r = *r - factor * *p;
                        }
                    },
                );
            }
        }
    }

    /// Replaces the residual by the correction that it calls for.
    pub(super) fn solve(&self, residual: &mut State) {
        let (size, count) = (self.size, self.terms.len());
        let stride = residual.suns * residual.terms;
        let mut x = vec![Lanes::ZERO; size];
        for sun in 0..residual.suns {
            for level in 0..self.levels {
                for (k, &t) in self.terms.iter().enumerate() {
                    x[level * count + k] = residual.moments[level * stride + sun * residual.terms + t];
                }
            }
            x[size - 1] = residual.ground[sun];
            crate::machine::isa::run(
                #[inline(always)]
                || self.substitute(&mut x),
            );
            for level in 0..self.levels {
                for (k, &t) in self.terms.iter().enumerate() {
                    residual.moments[level * stride + sun * residual.terms + t] = x[level * count + k];
                }
            }
            residual.ground[sun] = x[size - 1];
        }
    }

    #[inline(always)]
    fn substitute(&self, x: &mut [Lanes]) {
        let size = self.size;
        for row in 1..size {
            let mut sum = x[row];
            for (f, v) in self.factors[row * size..row * size + row].iter().zip(x.iter()) {
                sum = sum - *f * *v;
            }
            x[row] = sum;
        }
        for row in (0..size).rev() {
            let mut sum = x[row];
            for col in row + 1..size {
                sum = sum - self.factors[row * size + col] * x[col];
            }
            x[row] = sum * self.factors[row * size + row];
        }
    }
}

/// What light counts for a column after a turn about the planet's centre. A dependence on the sun by the Legendre
/// polynomial of degree n counts P_n(cos turn). Degree 0, which is 1, is right where rays turn little; in a tall shell
/// the column would take light of the day side for its own by night. There degree 2 does best: thick, nearly loss-free
/// air as tall as 3.6 radii converges with 56 applications of the operator, with degree 0 not at all.
fn turned(operator: &Operator) -> impl Fn(f32) -> f32 + use<> {
    let is_tall = operator.geometry.is_tall();
    move |cos| if is_tall { 1.5 * cos * cos - 0.5 } else { 1.0 }
}

fn subtract(from: &mut [Lanes], row: &[Lanes], factor: f32) {
    for (out, value) in from.iter_mut().zip(row) {
        *out = *out - *value * factor;
    }
}

fn reciprocal(v: Lanes) -> Lanes {
    let mut out = v;
    for w in 0..WIDTH {
        out[w] = if v[w] != 0.0 { 1.0 / v[w] } else { 0.0 };
    }
    out
}
