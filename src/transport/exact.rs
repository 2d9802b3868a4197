//! Radiance along one ray by direct integration of the solved field: the truth that tables are held against.
//!
//! Gauss–Legendre in length along the ray, between every fine level, kink, long arc and the edge of the
//! planet's shadow; transmittance to the sun integrated afresh at every point; cubic interpolation of the
//! field. Slow (about half a millisecond a view) and careful.

use super::kernels::azimuth_factor;
use super::levels::locate;
use super::optics::Optics;
use super::path::LONGEST_ARC;
use super::solve::{Batch, Solution};
use crate::geometry::horizon_cosine;
use crate::geometry::view::View;
use crate::machine::lanes::{Lanes, WIDTH};
use std::f64::consts::{FRAC_1_PI, PI};

/// The light of one ray, by where it was last scattered, per unit solar irradiance, 1/sr.
#[derive(Clone, Debug)]
pub struct Radiance {
    /// `[wavelength]`: scattered by air and everything in it.
    pub scattering: Vec<f64>,
    /// `[wavelength]`: from the ground, attenuated on its way.
    pub ground: Vec<f64>,
    /// `[wavelength]`: transmittance of the whole ray.
    pub transmittance: Vec<f64>,
}

const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_3, 5.0 / 18.0), (0.5, 4.0 / 9.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];
/// Optical depth beyond which nothing is seen: 1e-11 is left.
const OPAQUE: f32 = 25.0;
/// Optical depth along the ray that one Gauss interval may span.
const STEP_DEPTH: f64 = 0.7;

impl Solution {
    /// Radiance that arrives along a view that is inside the atmosphere or at its top. `last` lists the
    /// constituents whose scattered light counts.
    pub fn radiance(&self, view: &View, last: &[usize]) -> Radiance {
        let mut out = Radiance { scattering: vec![], ground: vec![], transmittance: vec![] };
        for batch in &self.batches {
            let (s, g, t) = self.march(batch, view, last);
            let n = batch.optics.count;
            // A field cut off at a finite degree can undershoot where there is next to no light.
            out.scattering.extend(s.0[..n].iter().map(|&v| f64::from(v).max(0.0)));
            out.ground.extend(g.0[..n].iter().map(|&v| f64::from(v)));
            out.transmittance.extend(t.0[..n].iter().map(|&v| f64::from(v)));
        }
        out
    }

    /// Transmittance, per wavelength, from radius `r` to a sun of zenith cosine `mu_s`; 0 behind the planet.
    pub fn sun_transmittance(&self, r: f64, mu_s: f64) -> Vec<f64> {
        let mut columns = vec![0.0; self.geometry.shells.constituents];
        let mut out = Vec::new();
        for batch in &self.batches {
            columns.fill(0.0);
            let through = self.to_sun(r, mu_s, &batch.optics.full_extinction, &mut columns);
            out.extend(through.0[..batch.optics.count].iter().map(|&v| f64::from(v)));
        }
        out
    }

    /// [`Solution::sun_transmittance`] of one batch.
    pub fn sun_transmittance_of(&self, batch: &Batch, r: f64, mu_s: f64) -> Lanes {
        let columns = &mut vec![0.0; self.geometry.shells.constituents];
        self.to_sun(r, mu_s, &batch.optics.full_extinction, columns)
    }

    /// The same with the light that a forward peak sends on, which the solver counts as unscattered.
    pub(super) fn sunbeam(&self, batch: &Batch, r: f64, mu_s: f64) -> Lanes {
        let columns = &mut vec![0.0; self.geometry.shells.constituents];
        self.to_sun(r, mu_s, &batch.optics.extinction, columns)
    }

    /// Light of the ground that arrives at radius `r` along a ray of optical depth `depth` that meets it.
    pub fn ground_light(&self, batch: &Batch, r: f64, mu: f64, mu_s: f64, nu: f64, depth: Lanes) -> Lanes {
        let view = View { r, mu, mu_s, nu, hits_ground: true };
        let track = Track::new(&view);
        (depth * -1.0).exp()
            * self.ground_radiance(batch, track.mu_s(&view, track.end(self.geometry.shells.edges[0])))
    }

    /// Scattered light from all directions (∫ I dω) at a radius and sun height.
    pub(super) fn mean_light(&self, batch: &Batch, r: f64, mu_s: f64) -> Lanes {
        self.moments(batch, r, mu_s)[0]
    }

    /// Absorption coefficient at a radius inside a shell, 1/m.
    pub(super) fn absorption(&self, batch: &Batch, shell: usize, r: f64) -> Lanes {
        let mut sum = Lanes::ZERO;
        for c in 0..self.geometry.shells.constituents {
            let only = batch.optics.full_extinction[c] - batch.optics.scattering[c];
            sum += only * self.geometry.shells.density(shell, c, r) as f32;
        }
        sum
    }

    /// Diffuse irradiance of the ground, per wavelength, over the solar irradiance: the orders that the ground
    /// sends on, direct sunlight left out (TA of Elek & Kmoch's Algorithm 1).
    pub fn ground_irradiance(&self, mu_s: f64) -> Vec<f64> {
        let mut out = Vec::new();
        for batch in &self.batches {
            let ground = self.geometry.shells.edges[0];
            // What a forward peak sends on comes with the beam, but not from the sun itself.
            let peak = self.sunbeam(batch, ground, mu_s) - self.sun_transmittance_of(batch, ground, mu_s);
            let flux = self.diffuse(batch, mu_s) + peak * mu_s.max(0.0) as f32;
            out.extend(flux.0[..batch.optics.count].iter().map(|&v| f64::from(v)));
        }
        out
    }

    /// Ground irradiance, cubic between the nodes of the sun axis.
    pub(super) fn diffuse(&self, batch: &Batch, mu_s: f64) -> Lanes {
        let (node, t) = self.geometry.axis.locate(mu_s as f32);
        let mut sum = Lanes::ZERO;
        if t >= 0.0 {
            let x = f64::from(node) + f64::from(t);
            for (k, weight) in cubic_weights(node as usize, batch.state.suns, |k| k as f64, x) {
                sum += batch.state.ground[k] * weight as f32;
            }
        }
        sum.map(|v| if v > 0.0 { v } else { 0.0 })
    }

    fn march(&self, batch: &Batch, view: &View, last: &[usize]) -> (Lanes, Lanes, Lanes) {
        let shells = &self.geometry.shells;
        let optics = &batch.optics;
        let track = Track::new(view);
        let phases: Vec<Lanes> = last.iter().map(|&c| optics.phase[c].value(view.nu as f32)).collect();
        let mut scattered = Lanes::ZERO;
        let (mut depth, mut full) = (Lanes::ZERO, Lanes::ZERO);
        let mut columns = vec![0.0; shells.constituents];
        for (shell, t0, t1) in self.segments(&track, view, optics) {
            let dark = depth.0[..optics.count].iter().all(|&d| d > OPAQUE);
            for (place, weight) in GAUSS.iter().filter(|_| !dark) {
                let t = t0 + (t1 - t0) * place;
                columns.fill(0.0);
                shells.add_path(shell, track.b2, t0, t, &mut columns);
                let through = (depth + depth_of(&columns, &optics.extinction)) * -1.0;
                let source = self.source(batch, view, &track, (shell, t), last, &phases);
                scattered += through.exp() * source * (weight * (t1 - t0)) as f32;
            }
            columns.fill(0.0);
            shells.add_path(shell, track.b2, t0, t1, &mut columns);
            depth += depth_of(&columns, &optics.extinction);
            full += depth_of(&columns, &optics.full_extinction);
        }
        let transmittance = (full * -1.0).exp();
        if !view.hits_ground {
            return (scattered, Lanes::ZERO, transmittance);
        }
        let ground = self.ground_radiance(batch, track.mu_s(view, track.end(shells.edges[0])));
        let beside = (depth * -1.0).exp() - transmittance;
        scattered += beside * ground * self.share_of_peaks(optics, last);
        (scattered, transmittance * ground, transmittance)
    }

    /// The part of what counts as unscattered that some constituents scatter.
    pub(super) fn share_of_peaks(&self, optics: &Optics, last: &[usize]) -> Lanes {
        let peak = |c: usize| optics.full_extinction[c] - optics.extinction[c];
        let sum = |list: &mut dyn Iterator<Item = usize>| list.fold(Lanes::ZERO, |sum, c| sum + peak(c));
        let (some, all) = (sum(&mut last.iter().copied()), sum(&mut (0..optics.extinction.len())));
        let mut share = Lanes::ZERO;
        for w in 0..WIDTH {
            share[w] = if all[w] > 0.0 { some[w] / all[w] } else { 0.0 };
        }
        share
    }

    /// Radiance of the ground: albedo/π times direct and diffuse irradiance (Elek & Kmoch Eqs. 8, 11).
    fn ground_radiance(&self, batch: &Batch, mu_s: f64) -> Lanes {
        let direct = self.sunbeam(batch, self.geometry.shells.edges[0], mu_s) * mu_s.max(0.0) as f32;
        let diffuse = self.diffuse(batch, mu_s);
        batch.optics.albedo * FRAC_1_PI as f32 * (direct + diffuse)
    }

    /// Transmittance from radius `r` to a sun of zenith cosine `mu_s` for an extinction a constituent; 0 behind the
    /// planet. The columns passed are left in `columns`.
    fn to_sun(&self, r: f64, mu_s: f64, extinction: &[Lanes], columns: &mut [f64]) -> Lanes {
        let shells = &self.geometry.shells;
        if mu_s < horizon_cosine(r, shells.edges[0]) {
            return Lanes::ZERO;
        }
        shells.add_to_top(r, mu_s, columns);
        (depth_of(columns, extinction) * -1.0).exp()
    }

    /// Light sent along the ray per unit length at one point, 1/m/sr.
    fn source(
        &self,
        batch: &Batch,
        view: &View,
        track: &Track,
        (shell, t): (usize, f64),
        last: &[usize],
        phases: &[Lanes],
    ) -> Lanes {
        let r = (track.b2 + t * t).sqrt();
        let mu_s = track.mu_s(view, t);
        let mut sunward = vec![0.0; self.geometry.shells.constituents];
        let sun = self.to_sun(r, mu_s, &batch.optics.extinction, &mut sunward);
        let moments = self.moments(batch, r, mu_s);
        let factors = self.angular_factors(t / r, mu_s, view.nu);
        let mut sum = Lanes::ZERO;
        for (&c, phase) in last.iter().zip(phases) {
            let peak = batch.optics.peaks[c].as_ref();
            let to_sun = batch.optics.scattering[c] * sunward[c] as f32;
            let phase = *phase + peak.map_or(Lanes::ZERO, |peak| peak.at(view.nu as f32, to_sun));
            let scattering = batch.optics.scattering[c] * self.geometry.shells.density(shell, c, r) as f32;
            let mut often = Lanes::ZERO;
            for ((&(l, _), factor), moment) in self.basis.terms.iter().zip(&factors).zip(&moments) {
                let weight = (factor * (2 * l + 1) as f64 / (4.0 * PI)) as f32;
                often += batch.optics.legendre[c][l] * *moment * weight;
            }
            sum += scattering * (sun * phase + often);
        }
        sum
    }

    /// P̄_lm(mu) sin^m θ s^min(m,2) cos mφ for every term.
    fn angular_factors(&self, mu: f64, mu_s: f64, nu: f64) -> Vec<f64> {
        let (sine2, s2) = ((1.0 - mu * mu).max(0.0), (1.0 - mu_s * mu_s).max(0.0));
        let x = (nu - mu * mu_s) as f32;
        let factor = |m| azimuth_factor(m, x, s2 as f32, sine2 as f32);
        let q: Vec<f32> = (0..self.basis.modes).map(factor).collect();
        let p = self.basis.polynomials(mu);
        p.iter().zip(&self.basis.orders).map(|(p, &m)| p * f64::from(q[m])).collect()
    }

    /// Moments at a radius and sun height, cubic in both (zero below the sun axis).
    fn moments(&self, batch: &Batch, r: f64, mu_s: f64) -> Vec<Lanes> {
        let axis = &self.geometry.axis;
        let state = &batch.state;
        let mut out = vec![Lanes::ZERO; state.terms];
        let (node, t) = axis.locate(mu_s as f32);
        if t < 0.0 {
            return out;
        }
        let (level, _) = locate(&self.geometry.levels.coarse, r);
        let suns = cubic_weights(node as usize, state.suns, |k| k as f64, f64::from(node) + f64::from(t));
        let radii = &self.geometry.levels.coarse;
        let rows = cubic_weights(level, radii.len(), |k| radii[k], r);
        for (i, row) in rows {
            for (k, sun) in &suns {
                let at = (i * state.suns + k) * state.terms;
                for (out, m) in out.iter_mut().zip(&state.moments[at..]) {
                    *out += *m * (row * sun) as f32;
                }
            }
        }
        out
    }

    /// Pieces of the ray inside one shell each, short in arc and optical depth, cut at the shadow's edge.
    fn segments(&self, track: &Track, view: &View, optics: &Optics) -> Vec<(usize, f64, f64)> {
        let shells = &self.geometry.shells;
        let mut cuts: Vec<f64> = vec![track.start, track.end(shells.edges[0])];
        if !view.hits_ground {
            cuts[1] = track.crossing(*shells.edges.last().expect("shells have edges"));
        }
        let (first, last) = (cuts[0], cuts[1]);
        for &edge in &shells.edges {
            if edge * edge > track.b2 {
                let t = track.crossing(edge);
                cuts.extend([-t, t]);
            }
        }
        cuts.push(0.0);
        cuts.extend(track.shadow_edges(view, shells.edges[0]));
        cuts.retain(|&t| t >= first && t <= last);
        cuts.sort_by(f64::total_cmp);
        cuts.dedup();
        let mut out = Vec::new();
        for pair in cuts.windows(2) {
            let middle = (track.b2 + 0.25 * (pair[0] + pair[1]) * (pair[0] + pair[1])).sqrt();
            let shell = shells.find(middle);
            let mut columns = vec![0.0; shells.constituents];
            shells.add_path(shell, track.b2, pair[0], pair[1], &mut columns);
            let depth = depth_of(&columns, &optics.extinction)
                .0
                .iter()
                .fold(0.0f32, |a, &b| if b > a { b } else { a });
            let arc = (pair[1] - pair[0]) / middle;
            let parts =
                (f64::from(depth) / STEP_DEPTH).max(arc / LONGEST_ARC).ceil().clamp(1.0, 64.0) as usize;
            let step = (pair[1] - pair[0]) / parts as f64;
            out.extend(
                (0..parts).map(|k| (shell, pair[0] + step * k as f64, pair[0] + step * (k + 1) as f64)),
            );
        }
        out
    }
}

fn depth_of(columns: &[f64], extinction: &[Lanes]) -> Lanes {
    let mut depth = Lanes::ZERO;
    for (column, e) in columns.iter().zip(extinction) {
        for w in 0..WIDTH {
            depth[w] += e[w] * *column as f32;
        }
    }
    depth
}

/// Weights of Lagrange's cubic through the two nodes on either side (fewer at the ends).
fn cubic_weights(below: usize, count: usize, node: impl Fn(usize) -> f64, x: f64) -> Vec<(usize, f64)> {
    let first = below.saturating_sub(1);
    let last = (below + 2).min(count - 1);
    (first..=last)
        .map(|k| {
            let others = (first..=last).filter(|&j| j != k);
            (k, others.fold(1.0, |w, j| w * (x - node(j)) / (node(k) - node(j))))
        })
        .collect()
}

/// The straight line of a ray: lengths t along it count from its point nearest the planet's centre.
struct Track {
    b2: f64,
    start: f64,
}

impl Track {
    fn new(view: &View) -> Self {
        Track { b2: view.r * view.r * (1.0 - view.mu * view.mu), start: view.r * view.mu }
    }

    fn crossing(&self, radius: f64) -> f64 {
        (radius * radius - self.b2).max(0.0).sqrt()
    }

    /// Where the ray meets the ground.
    fn end(&self, ground: f64) -> f64 {
        -self.crossing(ground)
    }

    /// Cosine of the sun's zenith angle at a point of the ray.
    fn mu_s(&self, view: &View, t: f64) -> f64 {
        let r = (self.b2 + t * t).sqrt();
        ((view.r * view.mu_s + (t - self.start) * view.nu) / r).clamp(-1.0, 1.0)
    }

    /// Where the line crosses the cylinder of the planet's shadow.
    fn shadow_edges(&self, view: &View, ground: f64) -> Vec<f64> {
        // A point at distance s from the start lies r_s² − (r_s·L)² from the shadow's axis, squared.
        let along = view.r * view.mu_s;
        let a = 1.0 - view.nu * view.nu;
        let half_b = view.r * view.mu - along * view.nu;
        let c = view.r * view.r - along * along - ground * ground;
        let root = half_b * half_b - a * c;
        if a < 1e-14 || root <= 0.0 {
            return Vec::new();
        }
        let root = root.sqrt();
        let edges = [(-half_b - root) / a, (-half_b + root) / a];
        edges.iter().filter(|&&s| along + s * view.nu < 0.0).map(|s| s + self.start).collect()
    }
}
