//! Transmittance towards the sun, tabulated for each fine level against the distance to the top.

use super::azimuth::{CHUNK, Places, node_and_place};
use super::column::Shells;
use super::kernels::largest;
use super::levels::Levels;
use crate::geometry::horizon_cosine;
use crate::machine::lanes::Lanes;

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
    /// Per level, the node from which on there is less than [`DARK`] left.
    dark_from: Vec<u32>,
}

/// Transmittance that counts as none: what it lights is a hundred times fainter than any radiance that is told.
const DARK: f32 = 1e-10;

#[derive(Clone, Copy, Debug)]
struct LevelAxis {
    r: f32,
    depth2: f32,
    shortest: f32,
    scale: f32,
    horizon: f32,
    /// Number of the last node where it is dark beyond.
    last: f32,
}

/// Columns of every constituent to the top, `[level][node][constituent]`, m: geometry only.
pub struct SunColumns {
    pub nodes: usize,
    pub columns: Vec<f64>,
    /// Where each level's nodes end.
    ends: Vec<End>,
}

/// The last node of a level.
#[derive(Clone, Copy, Debug)]
struct End {
    /// Distance to the top, m.
    distance: f64,
    /// True where it lies in the dark before the ground's edge.
    dark: bool,
}

impl SunColumns {
    /// `least`: of each constituent, the smallest extinction coefficient at any wavelength, 1/m. In thick air nodes
    /// reach no lower than the sun shines, so that they lie close enough for straight lines between them.
    pub fn new(shells: &Shells, levels: &Levels, nodes: usize, least: &[f64]) -> Self {
        use rayon::prelude::*;
        let per_level = nodes * shells.constituents;
        let mut columns = vec![0.0; levels.fine.len() * per_level];
        let rows = columns.par_chunks_mut(per_level.max(1)).enumerate();
        let mut ends: Vec<End> = rows
            .map(|(i, out)| {
                crate::machine::isa::run(
                    #[inline(always)]
                    || lit_columns(shells, i, nodes, least, out),
                )
            })
            .collect();
        if per_level == 0 {
            let (ground, top) = (shells.edges[0], shells.edges[shells.len()]);
            let end = |r: &f64| End { distance: distances(*r, ground, top).1, dark: false };
            ends = levels.fine.iter().map(end).collect();
        }
        SunColumns { nodes, columns, ends }
    }
}

/// Optical depth to the sun at which the nodes of a level may end.
const LIT: f64 = 24.0;

/// The columns of a level up to where the sun is dark at all wavelengths, and that place.
#[inline(always)]
fn lit_columns(shells: &Shells, level: usize, nodes: usize, least: &[f64], out: &mut [f64]) -> End {
    let (ground, top) = (shells.edges[0], shells.edges[shells.len()]);
    let (shortest, longest) = distances(shells.edges[level], ground, top);
    let mut end = End { distance: longest, dark: false };
    level_columns(shells, level, nodes, end, out);
    // Each time the end falls on a node of the last one's; the nodes before that soon are many.
    for _ in 0..8 {
        let depth = |row: &[f64]| row.iter().zip(least).map(|(c, e)| c * e).sum::<f64>();
        let lit = out.chunks_exact(shells.constituents).position(|row| depth(row) > LIT);
        match lit {
            Some(n) if n < nodes / 2 => {
                let share = n.max(1) as f64 / (nodes - 1) as f64;
                end = End { distance: shortest + (end.distance - shortest) * share, dark: true };
                level_columns(shells, level, nodes, end, out);
            }
            _ => break,
        }
    }
    end
}

/// All nodes of one level at once: the inner loop runs over nodes, which fill the vector registers.
#[inline(always)]
fn level_columns(shells: &Shells, level: usize, nodes: usize, end: End, out: &mut [f64]) {
    let (r, ground, top) = (shells.edges[level], shells.edges[0], shells.edges[shells.len()]);
    let (shortest, longest) = (top - r, end.distance);
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
        let grazes = n + 1 == nodes && !end.dark;
        *b = if grazes { ground * ground } else { r * r * (1.0 - mu * mu) };
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
        let axis = levels.fine.iter().zip(&columns.ends);
        let axis = axis.map(|(&r, &end)| LevelAxis::new(r, [ground, top], nodes, end)).collect();
        let count = extinction.len();
        let mut values = vec![Lanes::ZERO; levels.fine.len() * nodes];
        values.par_chunks_mut(nodes).enumerate().for_each(|(i, out)| {
            crate::machine::isa::run(
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
        let lit = |row: &[Lanes]| row.iter().rposition(|v| largest(*v) > DARK).map_or(0, |n| n as u32 + 1);
        let dark_from = values.chunks_exact(nodes).map(lit).collect();
        Sunlight { nodes, axis, values, dark_from }
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
        let (a, dark_from) = (self.axis[level], self.dark_from[level]);
        for k in 0..CHUNK {
            let along = a.r * mu_s[k];
            let d = (along * along + a.depth2).sqrt() - along;
            let x = (d - a.shortest) * a.scale;
            let (n, t) = node_and_place(x, self.nodes);
            let lit = if mu_s[k] >= a.horizon && n < dark_from && x <= a.last { 1.0 } else { 0.0 };
            out.nodes[k] = n;
            out.low[k] = (1.0 - t) * lit;
            out.high[k] = t * lit;
        }
    }

    /// True where the sun never shines, however high.
    #[inline(always)]
    pub fn is_dark(&self, level: usize) -> bool {
        self.dark_from[level] == 0
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
    fn new(r: f64, [ground, top]: [f64; 2], nodes: usize, end: End) -> Self {
        let (shortest, longest) = (top - r, end.distance);
        LevelAxis {
            r: (r / top) as f32,
            depth2: ((top - r) * (top + r) / (top * top)) as f32,
            shortest: (shortest / top) as f32,
            scale: ((nodes - 1) as f64 * top / (longest - shortest)) as f32,
            horizon: horizon_cosine(r, ground) as f32,
            last: if end.dark { (nodes - 1) as f32 } else { f32::INFINITY },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::medium::{Constituent, DensityProfile, Medium, PhaseFunction, Role};
    use crate::transport::levels::LevelCounts;

    /// Straight lines between nodes a quarter of a unit of optical depth apart are 0.8 % off at most (a step squared
    /// over 8). Even nodes down to the horizon would lie 0.7 of the air's height apart, at a depth of 21.
    #[test]
    fn sunlight_in_a_thick_layer_is_the_exponential() {
        let layer = Constituent {
            name: "x".into(),
            role: Role::Gas,
            density: DensityProfile::Exponential { scale_height: 1e9 },
            scattering: vec![3e-3],
            absorption: vec![0.0],
            similarity_g: vec![0.0],
            phase: vec![PhaseFunction::Isotropic],
        };
        let medium = Medium {
            ground_radius: 3e6,
            top_radius: 3e6 + 1e4,
            wavelengths_nm: vec![550.0],
            ground_albedo: vec![0.3],
            constituents: vec![layer],
        };
        let levels = Levels::new(&medium, LevelCounts { coarse: 20, refinement: 2, cuts: 1 });
        let shells = Shells::new(&medium, &levels);
        let columns = SunColumns::new(&shells, &levels, 192, &[3e-3]);
        let sunlight = Sunlight::new(&columns, &levels, &[Lanes::splat(3e-3)]);
        let mut lit = 0;
        for (level, &r) in levels.fine.iter().enumerate() {
            for mu_s in [1.0, 0.83, 0.6, 0.31, 0.1] {
                let mut column = [0.0];
                shells.add_to_top(r, mu_s, &mut column);
                let exact = libm::exp(-3e-3 * column[0]);
                let found = f64::from(sunlight.at(level, mu_s as f32)[0]);
                if exact > 1e-6 {
                    assert!((found / exact - 1.0).abs() < 0.01, "{level} {mu_s}: {found} {exact}");
                    lit += 1;
                } else {
                    assert!(found < 2e-6, "{level} {mu_s}: {found} {exact}");
                }
            }
        }
        assert!(lit > 50, "{lit}");
    }
}
