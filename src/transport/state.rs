//! The unknown of the solver: angular moments of the radiance at each level and sun node, and the diffuse
//! irradiance of the ground at each sun node.

use super::kernels::Field;
use super::levels::Levels;
use super::moments::Basis;
use super::optics::Optics;
use crate::machine::lanes::Lanes;
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

    /// Adds a multiple of another state, wavelength by wavelength.
    pub fn add_times(&mut self, other: &State, factor: Lanes) {
        use rayon::prelude::*;
        const PART: usize = 4096;
        self.moments.par_chunks_mut(PART).zip(other.moments.par_chunks(PART)).for_each(|(a, b)| {
            for (a, b) in a.iter_mut().zip(b) {
                *a += *b * factor;
            }
        });
        for (a, b) in self.ground.iter_mut().zip(&other.ground) {
            *a += *b * factor;
        }
    }

    /// Multiplies everything by a number for each wavelength.
    pub fn scale_by(&mut self, factor: Lanes) {
        for v in self.moments.iter_mut().chain(&mut self.ground) {
            *v = *v * factor;
        }
    }

    /// Multiplies everything by a number.
    pub fn scale(&mut self, factor: f32) {
        for v in self.moments.iter_mut().chain(&mut self.ground) {
            *v = *v * factor;
        }
    }

    /// The field that this state makes the constituents in `group` scatter, at the levels of fields: cubic between
    /// those of the state. `shares[constituent][level of the field]`: scattering as a share of extinction.
    pub fn field(
        &self,
        basis: &Basis,
        optics: &Optics,
        levels: &Levels,
        shares: &[Vec<Lanes>],
        group: &[usize],
    ) -> Field {
        let stride = self.suns * self.terms;
        let mut values = Vec::with_capacity(levels.field.len() * stride);
        let mut sums = vec![Lanes::ZERO; stride];
        for (level, (first, weights)) in levels.between.iter().enumerate() {
            sums.fill(Lanes::ZERO);
            for (weight, from) in weights.iter().zip(self.moments[first * stride..].chunks_exact(stride)) {
                for (sum, moment) in sums.iter_mut().zip(from) {
                    *sum += *moment * *weight;
                }
            }
            for (t, factor) in source_factors(basis, optics, shares, group, level).into_iter().enumerate() {
                values.extend(sums[t..].iter().step_by(self.terms).map(|m| *m * factor));
            }
        }
        Field { terms: self.terms, suns: self.suns, values }
    }
}

/// (2l+1)/4π Σ f χ_l for every term at one level.
pub(super) fn source_factors(
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
