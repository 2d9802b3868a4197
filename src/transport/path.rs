//! The geometry of rays through the shell: where they are sampled, and the columns between.

use super::column::Shells;
use super::levels::{Levels, locate};
use crate::machine::lanes::Lanes;

/// Longest arc between two samples of a ray, rad, so that the sun's height changes little between them.
pub(super) const LONGEST_ARC: f64 = 0.013;

/// One sampling point of a ray.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Length along the ray from its point nearest the centre, m.
    along: f64,
    pub r: f64,
    /// Fine level below and place between it and the next.
    pub fine: (usize, f64),
    /// True where fields are looked up: at their levels, ends, turning points and arc cuts.
    field: bool,
}

/// Where a segment lies: after which stop of the field, and the places of its ends between that and the next one.
#[derive(Clone, Copy, Debug)]
pub struct FieldPlace {
    pub from: usize,
    pub near: f32,
    pub far: f32,
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

    fn push_stop(&mut self, r: f64, along: f64, shells: &Shells, levels: &Levels, field: bool) {
        let fine = locate(&shells.edges, r);
        let on_field = (fine.1 == 0.0 && levels.field_index.binary_search(&fine.0).is_ok())
            || (fine.1 == 1.0 && levels.field_index.binary_search(&(fine.0 + 1)).is_ok());
        self.stops.push(Stop { along, r, fine, field: field || on_field });
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
        field: bool,
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
            self.push_stop(radius, next, shells, levels, field || k < parts);
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

    /// True where fields are looked up.
    #[inline(always)]
    pub fn samples_field(&self, k: usize) -> bool {
        self.stops[k].field || k + 1 == self.stops.len()
    }

    /// Where each segment lies between the stops where fields are looked up.
    pub fn field_places(&self) -> Vec<FieldPlace> {
        let stops: Vec<usize> = (0..self.stops.len()).filter(|&k| self.samples_field(k)).collect();
        let mut places = Vec::with_capacity(self.stops.len());
        for (from, ends) in stops.windows(2).enumerate() {
            let mut near = 0.0;
            for k in ends[0]..ends[1] {
                let far = self.place_between(k + 1, ends[0], ends[1]);
                places.push(FieldPlace { from, near, far });
                near = far;
            }
        }
        places
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
