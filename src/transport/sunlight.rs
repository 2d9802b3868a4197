//! Transmittance towards the sun, tabulated for each fine level against the distance to the top.

use super::azimuth::{CHUNK, Places, node_and_place};
use super::column::Shells;
use super::levels::Levels;
use super::quadrature::horizon_cosine;
use crate::lanes::Lanes;

/// Transmittance from each fine level to the top of the atmosphere, per wavelength, against
/// d(mu) = −r mu + √(r² mu² + r_top² − r²), even in d between straight up and the ground's edge (the distance
/// to the top varies fastest where transmittance does; Bruneton & Neyret 2008). 0 behind the planet.
#[derive(Clone, Debug)]
pub struct Sunlight {
    nodes: usize,
    /// Per level, lengths in units of the top radius: r, r_top² − r², shortest d, nodes per unit of d.
    axis: Vec<LevelAxis>,
    /// `[level][node]`
    values: Vec<Lanes>,
}

#[derive(Clone, Copy, Debug)]
struct LevelAxis {
    r: f32,
    depth2: f32,
    shortest: f32,
    scale: f32,
    horizon: f32,
}

/// Columns of every constituent to the top, `[level][node][constituent]`, m: geometry only.
pub struct SunColumns {
    pub nodes: usize,
    pub columns: Vec<f64>,
}

impl SunColumns {
    pub fn new(shells: &Shells, levels: &Levels, nodes: usize) -> Self {
        use rayon::prelude::*;
        let per_level = nodes * shells.constituents;
        let mut columns = vec![0.0; levels.fine.len() * per_level];
        columns.par_chunks_mut(per_level.max(1)).enumerate().for_each(|(i, out)| {
            crate::isa::run(
                #[inline(always)]
                || level_columns(shells, i, nodes, out),
            )
        });
        SunColumns { nodes, columns }
    }
}

/// All nodes of one level at once: the inner loop runs over nodes, which fill the vector registers.
#[inline(always)]
fn level_columns(shells: &Shells, level: usize, nodes: usize, out: &mut [f64]) {
    let (r, ground, top) = (shells.edges[level], shells.edges[0], shells.edges[shells.len()]);
    let (shortest, longest) = distances(r, ground, top);
    let mut b2 = vec![0.0; nodes];
    let mut upward = nodes;
    for (n, b) in b2.iter_mut().enumerate() {
        let d = shortest + (longest - shortest) * n as f64 / (nodes - 1) as f64;
        let mu = if d > 0.0 { ((top - r) * (top + r) - d * d) / (2.0 * r * d) } else { 0.0 };
        let mu = mu.clamp(horizon_cosine(r, ground), 1.0);
        if mu < 0.0 && upward == nodes {
            upward = n;
        }
        // At the last node the ray grazes the ground, to the bit.
        *b = if n + 1 == nodes { ground * ground } else { r * r * (1.0 - mu * mu) };
    }
    let sums = shells.columns_to_top(r, &b2, upward);
    for n in 0..nodes {
        for c in 0..shells.constituents {
            out[n * shells.constituents + c] = sums[c * nodes + n];
        }
    }
}

/// Shortest (straight up) and longest (past the ground's edge) distance to the top from radius `r`.
fn distances(r: f64, ground: f64, top: f64) -> (f64, f64) {
    let to_edge = ((r - ground) * (r + ground)).max(0.0).sqrt();
    (top - r, to_edge + ((top - ground) * (top + ground)).sqrt())
}

impl Sunlight {
    /// `extinction[constituent]`: coefficient where the density is 1, per wavelength, 1/m.
    pub fn new(columns: &SunColumns, levels: &Levels, extinction: &[Lanes]) -> Self {
        use rayon::prelude::*;
        let (ground, top) = (levels.fine[0], *levels.fine.last().expect("levels are never empty"));
        let nodes = columns.nodes;
        let axis = levels.fine.iter().map(|&r| LevelAxis::new(r, ground, top, nodes)).collect();
        let count = extinction.len();
        let mut values = vec![Lanes::ZERO; levels.fine.len() * nodes];
        values.par_chunks_mut(nodes).enumerate().for_each(|(i, out)| {
            crate::isa::run(
                #[inline(always)]
                || {
                    for (n, value) in out.iter_mut().enumerate() {
                        let mut depth = Lanes::ZERO;
                        for c in 0..count {
                            depth += extinction[c] * -(columns.columns[(i * nodes + n) * count + c] as f32);
                        }
                        *value = depth.exp();
                    }
                },
            )
        });
        Sunlight { nodes, axis, values }
    }

    /// A table like this one of T τ, with τ the scattering optical depth towards the sun of the constituents
    /// whose `scattering` is not zero.
    pub fn times_depth(&self, columns: &SunColumns, scattering: &[Lanes]) -> Vec<Lanes> {
        use rayon::prelude::*;
        let count = scattering.len();
        let depth = |n: usize| {
            let mut sum = Lanes::ZERO;
            for (s, column) in scattering.iter().zip(&columns.columns[n * count..]) {
                sum += *s * *column as f32;
            }
            sum
        };
        self.values.par_iter().enumerate().map(|(n, t)| *t * depth(n)).collect()
    }

    /// Places of a chunk of sun cosines in the table of one level; both weights are 0 behind the planet.
    #[inline(always)]
    pub fn place(&self, level: usize, mu_s: &[f32; CHUNK], out: &mut Places) {
        let a = self.axis[level];
        for k in 0..CHUNK {
            let along = a.r * mu_s[k];
            let d = (along * along + a.depth2).sqrt() - along;
            let (n, t) = node_and_place((d - a.shortest) * a.scale, self.nodes);
            let lit = if mu_s[k] >= a.horizon { 1.0 } else { 0.0 };
            out.nodes[k] = n;
            out.low[k] = (1.0 - t) * lit;
            out.high[k] = t * lit;
        }
    }

    /// The table of transmittance, `[level][node]`.
    pub fn all(&self) -> &[Lanes] {
        &self.values
    }

    /// The table of one level, one value a node.
    #[inline(always)]
    pub fn level(&self, level: usize) -> &[Lanes] {
        self.level_of(&self.values, level)
    }

    /// One level of a table of the same shape.
    #[inline(always)]
    pub fn level_of<'a>(&self, table: &'a [Lanes], level: usize) -> &'a [Lanes] {
        &table[level * self.nodes..][..self.nodes]
    }

    /// Transmittance from a level to a sun of zenith cosine `mu_s`.
    #[inline(always)]
    pub fn at(&self, level: usize, mu_s: f32) -> Lanes {
        let mut places = Places::NONE;
        self.place(level, &[mu_s; CHUNK], &mut places);
        let two = &self.level(level)[places.nodes[0] as usize..][..2];
        two[0] * places.low[0] + two[1] * places.high[0]
    }
}

impl LevelAxis {
    fn new(r: f64, ground: f64, top: f64, nodes: usize) -> Self {
        let (shortest, longest) = distances(r, ground, top);
        LevelAxis {
            r: (r / top) as f32,
            depth2: ((top - r) * (top + r) / (top * top)) as f32,
            shortest: (shortest / top) as f32,
            scale: ((nodes - 1) as f64 * top / (longest - shortest)) as f32,
            horizon: horizon_cosine(r, ground) as f32,
        }
    }
}
