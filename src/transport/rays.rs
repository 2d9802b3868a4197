//! Samples of rays, and what each weighs at each wavelength.

use super::levels::{Levels, locate};
use super::path::{Path, Stop};
use crate::machine::lanes::{Lanes, WIDTH};

/// A sampling point of a ray, as the kernels see it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// Level below (of fields or of sunlight, as the ray was built) and place between it and the next.
    pub level: u32,
    pub place: f32,
    pub cos_turn: f32,
    pub sin_turn: f32,
    pub mu: f32,
}

/// Where a ray meets the ground.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    pub cos_turn: f32,
    pub sin_turn: f32,
    pub transmittance: Lanes,
}

/// A path with its weights at the wavelengths of a batch.
#[derive(Clone, Debug)]
pub(super) struct Ray {
    pub samples: Vec<Sample>,
    /// What a source function of 1 (per unit extinction) at each sample adds to the radiance at the start.
    pub weights: Vec<Lanes>,
    pub hit: Option<Hit>,
}

impl Ray {
    /// Samples where fields are looked up, between which the source function is linear in optical depth.
    #[inline(always)]
    pub(super) fn new(path: &Path, levels: &Levels, extinction: &[Lanes]) -> Self {
        let mut samples: Vec<Sample> = Vec::with_capacity(path.stops.len());
        let mut weights: Vec<Lanes> = Vec::with_capacity(path.stops.len());
        let (mut transmittance, mut depth) = (Lanes::splat(1.0), Lanes::ZERO);
        for (k, stop) in path.stops.iter().enumerate() {
            if k > 0 {
                depth += sum(path.segment(k - 1), extinction);
            }
            if !path.samples_field(k) {
                continue;
            }
            let (near, far, through) = segment_weights(depth);
            if let Some(before) = weights.last_mut() {
                *before += transmittance * near;
            }
            weights.push(transmittance * far);
            transmittance = transmittance * through;
            depth = Lanes::ZERO;
            samples.push(Sample::at(path, levels, stop, true));
        }
        Ray { samples, weights, hit: path.hits_ground.then(|| Hit::at(path, transmittance)) }
    }
}

impl Hit {
    /// The last stop of a path; `transmittance` from there to the start.
    pub(super) fn at(path: &Path, transmittance: Lanes) -> Self {
        let (cos, sin) = path.turn(path.stops.last().expect("a path has a stop"));
        Hit { cos_turn: cos as f32, sin_turn: sin as f32, transmittance }
    }
}

impl Sample {
    fn at(path: &Path, levels: &Levels, stop: &Stop, field: bool) -> Self {
        let (cos, sin) = path.turn(stop);
        let (level, place) = if field { locate(&levels.field, stop.r) } else { stop.fine };
        Sample {
            level: level as u32,
            place: place as f32,
            cos_turn: cos as f32,
            sin_turn: sin as f32,
            mu: path.local_mu(stop) as f32,
        }
    }

    /// A path's samples: all of its stops on fine levels, or those where fields are looked up on theirs.
    pub(super) fn all(path: &Path, levels: &Levels, field: bool) -> Vec<Self> {
        let used = (0..path.stops.len()).filter(|&k| !field || path.samples_field(k));
        used.map(|k| Sample::at(path, levels, &path.stops[k], field)).collect()
    }
}

/// What light that is scattered towards the start loses on its way, between every two stops of a path.
pub(super) struct Attenuation {
    /// What a unit of scattering depth in a segment adds to the radiance at the start, for a source of 1 at its
    /// near end falling to 0 at its far end, and the other way round; 0 in a vacuum.
    near: Vec<Lanes>,
    far: Vec<Lanes>,
    /// Of the whole path.
    pub transmittance: Lanes,
}

impl Attenuation {
    #[inline(always)]
    pub(super) fn new(path: &Path, extinction: &[Lanes]) -> Self {
        let segments = path.stops.len() - 1;
        let (mut near, mut far) = (Vec::with_capacity(segments), Vec::with_capacity(segments));
        let mut transmittance = Lanes::splat(1.0);
        for k in 0..segments {
            let depth = sum(path.segment(k), extinction);
            let (n, f, through) = segment_weights(depth);
            let scale = transmittance * inverse(depth);
            near.push(n * scale);
            far.push(f * scale);
            transmittance = transmittance * through;
        }
        Attenuation { near, far, transmittance }
    }

    /// What a source of 1 at each stop adds to the radiance at the start, scattered by constituents of
    /// coefficients `scattering` (1/m, where the density is 1): the weights of single scattering.
    #[inline(always)]
    pub(super) fn weights(&self, path: &Path, scattering: &[Lanes]) -> Vec<Lanes> {
        let mut weights = vec![Lanes::ZERO; path.stops.len()];
        for k in 0..self.near.len() {
            let scattered = sum(path.segment(k), scattering);
            weights[k] += self.near[k] * scattered;
            weights[k + 1] = self.far[k] * scattered;
        }
        weights
    }

    /// The same where a field is looked up, which is linear in radius between these stops. What is
    /// scattered between two fine stops is exact, however fast its share in the extinction changes there.
    #[inline(always)]
    pub(super) fn field_weights(&self, path: &Path, scattering: &[Lanes]) -> Vec<Lanes> {
        let places = path.field_places();
        let mut weights = vec![Lanes::ZERO; places.last().map_or(1, |p| p.from + 2)];
        for (k, place) in places.into_iter().enumerate() {
            let scattered = sum(path.segment(k), scattering);
            let (near, far) = (self.near[k] * scattered, self.far[k] * scattered);
            weights[place.from] += near * (1.0 - place.near) + far * (1.0 - place.far);
            weights[place.from + 1] += near * place.near + far * place.far;
        }
        weights
    }
}

#[inline(always)]
fn sum(columns: &[f64], coefficients: &[Lanes]) -> Lanes {
    let mut sum = Lanes::ZERO;
    for (column, c) in columns.iter().zip(coefficients) {
        sum += *c * *column as f32;
    }
    sum
}

/// 1 / v, and 0 where v is nothing.
#[inline(always)]
fn inverse(v: Lanes) -> Lanes {
    let mut out = Lanes::ZERO;
    for w in 0..WIDTH {
        out[w] = if v[w] > 1e-30 { 1.0 / v[w] } else { 0.0 };
    }
    out
}

/// Weights of the near and far end of a segment of optical depth Δ in which the source function is linear in
/// optical depth, and its transmittance: near 1 − e^−Δ − far, far [1 − (1 + Δ) e^−Δ]/Δ, by series below 0.3
/// where these cancel (six terms: relative error 3e-7).
#[inline(always)]
pub(super) fn segment_weights(depth: Lanes) -> (Lanes, Lanes, Lanes) {
    let through = (depth * -1.0).exp();
    let (mut near, mut far) = (Lanes::ZERO, Lanes::ZERO);
    for i in 0..crate::machine::lanes::WIDTH {
        let (d, e) = (depth[i], through[i]);
        let small_far = d
            * (1.0 / 2.0
                + d * (-1.0 / 3.0 + d * (1.0 / 8.0 + d * (-1.0 / 30.0 + d * (1.0 / 144.0 - d / 840.0)))));
        let small_near = d
            * (1.0 / 2.0
                + d * (-1.0 / 6.0 + d * (1.0 / 24.0 + d * (-1.0 / 120.0 + d * (1.0 / 720.0 - d / 5040.0)))));
        let large = if d > 0.3 { d } else { 0.3 };
        let large_far = (1.0 - (1.0 + d) * e) / large;
        far[i] = if d < 0.3 { small_far } else { large_far };
        near[i] = if d < 0.3 { small_near } else { 1.0 - e - large_far };
    }
    (near, far, through)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the formulas in double precision, on both sides of the switch to the series; the two weights
    /// and the transmittance share out exactly 1.
    #[test]
    fn segment_weights_are_the_closed_form() {
        for d in [1e-6_f64, 1e-3, 0.1, 0.29, 0.31, 1.0, 5.0, 40.0] {
            let (near, far, through) = segment_weights(Lanes::splat(d as f32));
            let e = libm::exp(-d);
            let exact_far = (-libm::expm1(-d) - d * e) / d;
            assert!((f64::from(far[0]) / exact_far - 1.0).abs() < 2e-3 * (1e-3 / d).min(1.0) + 2e-6, "{d}");
            let sum = f64::from(near[0]) + f64::from(far[0]) + f64::from(through[0]);
            assert!((sum - 1.0).abs() < 3e-7, "{d}: {sum}");
        }
    }
}
