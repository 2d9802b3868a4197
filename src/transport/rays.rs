//! Rays through the shell: where they are sampled, and what each sample weighs at each wavelength.

use super::column::Shells;
use super::levels::{Levels, locate};
use crate::lanes::Lanes;

/// Longest arc between two samples of a ray, rad, so that the sun's height changes little between them.
pub const LONGEST_ARC: f64 = 0.013;

/// One sampling point of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Length along the ray from its point nearest the centre, m.
    along: f64,
    pub r: f64,
    /// Fine level below and place between it and the next.
    pub fine: (usize, f64),
    /// True where the coarse ray has a sample too: at coarse levels, ends, turning points and arc cuts.
    coarse: bool,
}

/// A ray's geometry: its stops and the columns between them.
#[derive(Clone, Debug)]
pub struct Path {
    r: f64,
    b2: f64,
    start: f64,
    pub stops: Vec<Stop>,
    /// `[segment][constituent]`, m.
    columns: Vec<f64>,
    constituents: usize,
    pub hits_ground: bool,
}

impl Path {
    /// The ray from radius `r` along zenith cosine `mu` to the ground or the top.
    pub fn new(shells: &Shells, levels: &Levels, r: f64, mu: f64, hits_ground: bool) -> Self {
        let constituents = shells.constituents;
        let b2 = r * r * (1.0 - mu * mu);
        let mut path =
            Path { r, b2, start: r * mu, stops: vec![], columns: vec![], constituents, hits_ground };
        let shell = shells.find(r);
        path.push_stop(r, r * mu, shells, levels, true);
        if mu < 0.0 {
            path.descend(shells, levels, shell, r);
        }
        if !hits_ground {
            path.ascend(shells, levels);
        }
        path
    }

    fn push_stop(&mut self, r: f64, along: f64, shells: &Shells, levels: &Levels, coarse: bool) {
        let fine = locate(&shells.edges, r);
        let on_coarse = (fine.1 == 0.0 && levels.fine_index.binary_search(&fine.0).is_ok())
            || (fine.1 == 1.0 && levels.fine_index.binary_search(&(fine.0 + 1)).is_ok());
        self.stops.push(Stop { along, r, fine, coarse: coarse || on_coarse });
    }

    /// Down through the shells to the ground or to the point nearest the centre.
    fn descend(&mut self, shells: &Shells, levels: &Levels, shell: usize, r: f64) {
        let b = self.b2.sqrt();
        for k in (0..=shell).rev() {
            let edge = shells.edges[k];
            if edge >= r {
                continue;
            }
            if edge > b || (k == 0 && self.hits_ground) {
                let along = -(edge * edge - self.b2).max(0.0).sqrt();
                self.segment_to(shells, levels, k, edge, along, false);
            } else if !self.hits_ground {
                self.segment_to(shells, levels, k, b, 0.0, true);
                return;
            }
        }
        if !self.hits_ground && self.last().along < 0.0 {
            // The nearest point lies in the lowest shell, a rounding error from the ground.
            self.segment_to(shells, levels, 0, b.max(shells.edges[0]), 0.0, true);
        }
    }

    fn ascend(&mut self, shells: &Shells, levels: &Levels) {
        let from = self.last().r;
        for k in shells.find(from) + 1..shells.edges.len() {
            let edge = shells.edges[k];
            if edge > from {
                let along = (edge * edge - self.b2).max(0.0).sqrt();
                self.segment_to(shells, levels, k - 1, edge, along, false);
            }
        }
    }

    fn last(&self) -> Stop {
        *self.stops.last().expect("a path starts with a stop")
    }

    /// Adds the way to the next stop inside one shell, cut where its arc is long.
    fn segment_to(
        &mut self,
        shells: &Shells,
        levels: &Levels,
        shell: usize,
        r: f64,
        along: f64,
        coarse: bool,
    ) {
        let from = self.last();
        let arc = self.b2.sqrt() * (along - from.along) / (r * from.r);
        let parts = (arc / LONGEST_ARC).ceil().clamp(1.0, 256.0) as usize;
        for k in 1..=parts {
            let next =
                if k == parts { along } else { from.along + (along - from.along) * k as f64 / parts as f64 };
            let radius = if k == parts { r } else { (self.b2 + next * next).sqrt() };
            let at = self.columns.len();
            self.columns.resize(at + self.constituents, 0.0);
            shells.add_path(shell, self.b2, self.last().along, next, &mut self.columns[at..]);
            self.push_stop(radius, next, shells, levels, coarse || k < parts);
        }
    }

    /// Cosine and sine of the angle at the planet's centre between the start and a stop.
    pub fn turn(&self, stop: &Stop) -> (f64, f64) {
        let product = self.r * stop.r;
        let cos = (self.b2 + stop.along * self.start) / product;
        (cos, self.b2.sqrt() * (stop.along - self.start) / product)
    }

    /// Cosine of the zenith angle of the ray at a stop.
    pub fn local_mu(&self, stop: &Stop) -> f64 {
        (stop.along / stop.r).clamp(-1.0, 1.0)
    }

    /// Optical depth from the start to every stop for given coefficients (one a constituent, 1/m).
    pub fn depths(&self, coefficients: &[Lanes]) -> Vec<Lanes> {
        let mut depth = Lanes::ZERO;
        let mut out = vec![depth];
        for k in 0..self.stops.len() - 1 {
            for (column, e) in self.segment(k).iter().zip(coefficients) {
                depth += *e * *column as f32;
            }
            out.push(depth);
        }
        out
    }

    /// Optical depth of segment `k`, and of it the share that is scattered by given coefficients (0 in a vacuum).
    #[inline(always)]
    fn depth_and_share(&self, k: usize, extinction: &[Lanes], scattering: &[Lanes]) -> (Lanes, Lanes) {
        let (mut depth, mut scattered) = (Lanes::ZERO, Lanes::ZERO);
        for ((column, e), s) in self.segment(k).iter().zip(extinction).zip(scattering) {
            depth += *e * *column as f32;
            scattered += *s * *column as f32;
        }
        for w in 0..crate::lanes::WIDTH {
            scattered[w] = if depth[w] > 0.0 { scattered[w] / depth[w] } else { 0.0 };
        }
        (depth, scattered)
    }

    /// What a source of 1 at each stop, in a group's scattering coefficients, adds to the radiance at the start:
    /// the weights of single scattering.
    #[inline(always)]
    pub fn scattering_weights(&self, extinction: &[Lanes], scattering: &[Lanes]) -> Vec<Lanes> {
        let mut weights = vec![Lanes::ZERO; self.stops.len()];
        let mut transmittance = Lanes::splat(1.0);
        for k in 0..self.stops.len() - 1 {
            let (depth, share) = self.depth_and_share(k, extinction, scattering);
            let (near, far, through) = segment_weights(depth);
            weights[k] += transmittance * near * share;
            weights[k + 1] = transmittance * far * share;
            transmittance = transmittance * through;
        }
        weights
    }

    /// Where stop `k` lies between two others: by radius, along the ray where that is the same.
    fn place_between(&self, k: usize, from: usize, to: usize) -> f32 {
        let (a, b, x) = (&self.stops[from], &self.stops[to], &self.stops[k]);
        let by_radius = (b.r - a.r).abs() > 1e-9 * a.r;
        let place =
            if by_radius { (x.r - a.r) / (b.r - a.r) } else { (x.along - a.along) / (b.along - a.along) };
        place.clamp(0.0, 1.0) as f32
    }

    /// The columns of segment number `k`.
    pub fn segment(&self, k: usize) -> &[f64] {
        &self.columns[k * self.constituents..][..self.constituents]
    }
}

/// A sample of a ray at the wavelengths of a batch.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Level below (coarse or fine, as the ray was built) and place between it and the next.
    pub level: u32,
    pub place: f32,
    pub cos_turn: f32,
    pub sin_turn: f32,
    pub mu: f32,
    /// What a source function of 1 (per unit extinction) at this sample adds to the radiance at the start.
    pub weight: Lanes,
}

/// Where a ray meets the ground.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    pub cos_turn: f32,
    pub sin_turn: f32,
    pub transmittance: Lanes,
}

/// A path with its weights at the wavelengths of a batch.
#[derive(Clone, Debug)]
pub struct Ray {
    pub samples: Vec<Sample>,
    pub hit: Option<Hit>,
    /// Optical depth of the whole ray.
    pub depth: Lanes,
}

impl Ray {
    /// Samples at every stop (`coarse` false) or at the coarse ones only.
    #[inline(always)]
    pub fn new(path: &Path, levels: &Levels, extinction: &[Lanes], coarse: bool) -> Self {
        let mut samples: Vec<Sample> = Vec::with_capacity(path.stops.len());
        let mut transmittance = Lanes::splat(1.0);
        let (mut depth, mut total) = (Lanes::ZERO, Lanes::ZERO);
        let last = path.stops.len() - 1;
        for (k, stop) in path.stops.iter().enumerate() {
            if k > 0 {
                for (column, e) in path.segment(k - 1).iter().zip(extinction) {
                    depth += *e * *column as f32;
                }
            }
            if coarse && !stop.coarse && k != last {
                continue;
            }
            let mut sample = Sample::at(path, levels, stop, coarse);
            if let Some(before) = samples.last_mut() {
                let (near, far, through) = segment_weights(depth);
                before.weight += transmittance * near;
                sample.weight = transmittance * far;
                transmittance = transmittance * through;
            }
            total += depth;
            depth = Lanes::ZERO;
            samples.push(sample);
        }
        let hit = path.hits_ground.then(|| {
            let (cos, sin) = path.turn(&path.stops[last]);
            Hit { cos_turn: cos as f32, sin_turn: sin as f32, transmittance }
        });
        Ray { samples, hit, depth: total }
    }
}

impl Ray {
    /// Samples at the coarse stops only, for light that constituents of coefficients `scattering` (1/m, where
    /// the density is 1) scatter out of a field that is linear in radius between them. What they scatter
    /// between two fine stops is exact, however fast their share in the extinction changes there.
    #[inline(always)]
    pub fn weighted(path: &Path, levels: &Levels, extinction: &[Lanes], scattering: &[Lanes]) -> Self {
        let last = path.stops.len() - 1;
        let mut samples = vec![Sample::at(path, levels, &path.stops[0], true)];
        let (mut transmittance, mut total) = (Lanes::splat(1.0), Lanes::ZERO);
        let mut from = 0;
        while from < last {
            let to = (from + 1..=last)
                .find(|&k| path.stops[k].coarse || k == last)
                .expect("the last stop ends it");
            let (mut near_sum, mut far_sum) = (Lanes::ZERO, Lanes::ZERO);
            for k in from..to {
                let (depth, share) = path.depth_and_share(k, extinction, scattering);
                let (near, far, through) = segment_weights(depth);
                let (a, b) = (path.place_between(k, from, to), path.place_between(k + 1, from, to));
                let (near, far) = (transmittance * near * share, transmittance * far * share);
                near_sum += near * (1.0 - a) + far * (1.0 - b);
                far_sum += near * a + far * b;
                transmittance = transmittance * through;
                total += depth;
            }
            samples.last_mut().expect("not empty").weight += near_sum;
            let mut sample = Sample::at(path, levels, &path.stops[to], true);
            sample.weight = far_sum;
            samples.push(sample);
            from = to;
        }
        Ray { samples, hit: None, depth: total }
    }
}

impl Sample {
    fn at(path: &Path, levels: &Levels, stop: &Stop, coarse: bool) -> Self {
        let (cos, sin) = path.turn(stop);
        let (level, place) = if coarse { locate(&levels.coarse, stop.r) } else { stop.fine };
        Sample {
            level: level as u32,
            place: place as f32,
            cos_turn: cos as f32,
            sin_turn: sin as f32,
            mu: path.local_mu(stop) as f32,
            weight: Lanes::ZERO,
        }
    }
}

/// Weights of the near and far end of a segment of optical depth Δ in which the source function is linear in
/// optical depth, and its transmittance: near 1 − e^−Δ − far, far [1 − (1 + Δ) e^−Δ]/Δ, by series below 0.3
/// where these cancel (six terms: relative error 3e-7).
#[inline(always)]
pub fn segment_weights(depth: Lanes) -> (Lanes, Lanes, Lanes) {
    let through = (depth * -1.0).exp();
    let (mut near, mut far) = (Lanes::ZERO, Lanes::ZERO);
    for i in 0..crate::lanes::WIDTH {
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
