//! The solver: from a medium to the multiply scattered light field, order by order or converged.

use super::azimuth::SunAxis;
use super::column::Shells;
use super::forward::unscattered;
use super::krylov::converge;
pub use super::levels::LevelCounts;
use super::levels::{Levels, THIN};
use super::moments::{Basis, MOST_DEGREE};
use super::operator::{Geometry, Operator};
use super::optics::Optics;
use super::state::State;
use super::sunlight::{SunColumns, Sunlight};
use crate::machine::lanes::{Lanes, WIDTH};
use crate::medium::{Constituent, Medium};

/// Which orders of scattering are summed. A reflection by the ground counts as one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Orders {
    /// All, until no moment changes by more than this fraction.
    Converged { tolerance: f64 },
    /// The first N, as in Elek & Kmoch's Algorithm 1.
    First(usize),
}

/// Numbers of nodes of the solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resolution {
    /// Levels in thin air; in thick air fields are looked up on more.
    pub levels: LevelCounts,
    /// Zenith directions above the horizontal; somewhat more than as many again lie below it.
    pub zeniths: usize,
    /// Azimuths over half a turn, for the first order and for the rest.
    pub first_azimuths: usize,
    pub azimuths: usize,
    pub sun_nodes: usize,
    /// Nodes per level of the table of transmittance to the sun.
    pub sunlight_nodes: usize,
    /// Largest degree of the angular moments; lower where the phase functions need less.
    pub degree: usize,
}

impl Resolution {
    /// For tables: errors well below those of their interpolation.
    pub const TABLES: Resolution = Resolution {
        levels: LevelCounts { coarse: 32, refinement: 1, cuts: 5 },
        zeniths: 14,
        first_azimuths: 12,
        azimuths: 6,
        sun_nodes: 48,
        sunlight_nodes: 192,
        degree: 8,
    };
    /// For tables of the paper's medium, whose phase functions end at degree 2 and whose layout interpolates
    /// more coarsely than this solves.
    pub const PAPER: Resolution = Resolution {
        levels: LevelCounts { coarse: 20, refinement: 1, cuts: 3 },
        zeniths: 10,
        first_azimuths: 6,
        azimuths: 4,
        sun_nodes: 32,
        sunlight_nodes: 96,
        degree: 2,
    };
    /// For answers that tables are measured against. The degree is that of the glow of twilight and of the bright
    /// horizon, which haze scatters with its peak.
    pub const EXACT: Resolution = Resolution {
        levels: LevelCounts { coarse: 44, refinement: 1, cuts: 6 },
        zeniths: 14,
        first_azimuths: 16,
        azimuths: 12,
        sun_nodes: 64,
        sunlight_nodes: 512,
        degree: 12,
    };

    /// Degree of a phase function whose product with any moment the first order's azimuths integrate exactly.
    fn visible_degree(&self) -> usize {
        (2 * self.first_azimuths - 1).saturating_sub(self.degree).max(self.degree)
    }

    /// In thick air the field is looked up on more levels than hold the state: it bends over a unit of optical
    /// depth. Rules found by the energy balance: within 0.12 % for `earth` at 10, 30 and 100 times its density.
    pub fn levels_in(&self, medium: &Medium) -> LevelCounts {
        let depth = medium.vertical_optical_depth().into_iter().fold(0.0, f64::max);
        let refinement = ((depth / THIN).sqrt().ceil().clamp(1.0, 8.0) as usize).max(self.levels.refinement);
        let cuts = (self.levels.cuts / refinement).max(1);
        let more = 1.0 + ((depth - THIN) / 60.0).clamp(0.0, 1.0);
        LevelCounts { coarse: (self.levels.coarse as f64 * more) as usize, refinement, cuts }
    }
}

impl Resolution {
    /// Thick air takes fewer azimuths of the first order: what its phase functions have beyond the degree of the
    /// moments is gone after a few of very many scatterings.
    fn in_air_of(&self, levels: &Levels) -> Resolution {
        let first_azimuths =
            if levels.is_refined() { self.degree.max(THICK_AZIMUTHS) } else { self.first_azimuths };
        Resolution { first_azimuths: first_azimuths.min(self.first_azimuths), ..*self }
    }
}

impl Orders {
    /// How many are summed; none for all.
    pub fn limit(&self) -> Option<usize> {
        match self {
            Orders::Converged { .. } => None,
            Orders::First(n) => Some(*n),
        }
    }
}

/// The light field of up to sixteen wavelengths.
pub struct Batch {
    /// Number of the first of its wavelengths.
    pub first: usize,
    pub optics: Optics,
    pub sunlight: Sunlight,
    /// Sum of the orders that scatter on: all that is needed for one more.
    pub state: State,
}

/// How the sum of orders ended.
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Times that the operator was applied, or the number of orders asked for.
    pub applications: usize,
    /// Per wavelength, the largest relative change that one more order would make to the mean radiance.
    pub residual: Vec<f64>,
}

/// Azimuths of the first order in thick air, or as many as the moments have degrees.
const THICK_AZIMUTHS: usize = 8;

/// A solved medium.
pub struct Solution {
    pub geometry: Geometry,
    /// Columns towards the sun, from which more tables of sunlight can be made.
    pub columns: SunColumns,
    pub basis: Basis,
    pub batches: Vec<Batch>,
    pub orders: Orders,
    pub report: Report,
}

/// The sun axis reaches below the paper's −0.2857 where the shell is so thick that its top is lit still.
pub fn lowest_sun(medium: &Medium) -> f64 {
    const MARGIN: f64 = 0.01;
    let ratio = medium.ground_radius / medium.top_radius;
    (-0.2857_f64).min(-(1.0 - ratio * ratio).sqrt() - MARGIN).max(-1.0)
}

impl Solution {
    /// Solves a medium at all its wavelengths.
    pub fn new(medium: &Medium, resolution: &Resolution, orders: Orders) -> Self {
        let levels = Levels::new(medium, resolution.levels_in(medium));
        let resolution = &resolution.in_air_of(&levels);
        let shells = Shells::new(medium, &levels);
        let least = least_extinction(medium, resolution.degree, orders);
        let columns = SunColumns::new(&shells, &levels, resolution.sunlight_nodes, &least);
        let axis = SunAxis::new(resolution.sun_nodes, lowest_sun(medium));
        let basis = Basis::new(&needed_degrees(medium, resolution.degree, orders));
        let geometry = Geometry::new(levels, shells, axis, resolution.zeniths, basis.len());
        let count = medium.wavelengths_nm.len();
        let mut batches = Vec::new();
        let mut report = Report { applications: 0, residual: Vec::new() };
        for first in (0..count).step_by(WIDTH) {
            let which: Vec<usize> = (first..count.min(first + WIDTH)).collect();
            let visible = resolution.visible_degree();
            let optics =
                Optics::new(&medium.at_wavelengths(&which), resolution.degree, visible, orders.limit());
            let sunlight = Sunlight::new(&columns, &geometry.levels, &optics.extinction);
            let operator = Operator::new(&geometry, &optics, &sunlight, &basis, resolution.azimuths);
            let (state, one) = sum_orders(&operator, resolution.first_azimuths, orders);
            report.applications = report.applications.max(one.applications);
            report.residual.extend(one.residual);
            batches.push(Batch { first, optics, sunlight, state });
        }
        Solution { geometry, columns, basis, batches, orders, report }
    }
}

/// Of each constituent, the smallest extinction coefficient at any wavelength, 1/m, without what counts as
/// unscattered.
fn least_extinction(medium: &Medium, largest: usize, orders: Orders) -> Vec<f64> {
    let least = |c: &Constituent| {
        let passed = unscattered(&c.phase, largest, orders.limit());
        let left = passed.iter().enumerate().map(|(w, f)| c.extinction(w) - f * c.scattering[w]);
        left.fold(f64::INFINITY, f64::min)
    };
    medium.constituents.iter().map(least).collect()
}

/// Degrees at which any scatterer's phase function has something, up to `largest`; always degree 0. What counts as
/// unscattered is missing at every degree.
pub fn needed_degrees(medium: &Medium, largest: usize, orders: Orders) -> Vec<usize> {
    let largest = largest.min(MOST_DEGREE);
    let mut needed = vec![false; largest + 1];
    needed[0] = true;
    for c in medium.constituents.iter().filter(|c| c.scatters()) {
        let passed = unscattered(&c.phase, largest, orders.limit());
        for (phase, f) in c.phase.iter().zip(passed) {
            for (n, chi) in needed.iter_mut().zip(phase.legendre(largest)) {
                *n |= (chi - f).abs() > 1e-6;
            }
        }
    }
    (0..=largest).filter(|&l| needed[l]).collect()
}

fn sum_orders(operator: &Operator, first_azimuths: usize, orders: Orders) -> (State, Report) {
    match orders {
        Orders::Converged { tolerance } => {
            converge(operator, operator.first_order(first_azimuths), tolerance)
        }
        Orders::First(n) => first_orders(operator, first_azimuths, n),
    }
}

/// The orders 1 … n − 1, whose light the last order scatters.
fn first_orders(operator: &Operator, first_azimuths: usize, n: usize) -> (State, Report) {
    let mut term = operator.first_order(first_azimuths);
    let mut sum = term.clone();
    sum.scale(0.0);
    for _ in 1..n {
        sum.add(&term);
        term = operator.apply(&term);
    }
    sum.add(&term);
    let residual = largest_change(&term, &sum, operator.optics.count);
    term.scale(-1.0);
    sum.add(&term);
    (sum, Report { applications: n, residual })
}

/// The largest of a list; infinite where one is no number.
pub fn worst(residual: &[f64]) -> f64 {
    residual.iter().fold(0.0, |a, &r| if r.is_nan() { f64::INFINITY } else { a.max(r) })
}

/// Mean radiance of a level, as a share of its largest under any sun, below which it counts as dark.
pub const DARK: f32 = 1e-4;

/// Per wavelength, the largest change of the mean radiance anywhere, relative to its value there, or to that of
/// darkness.
pub fn largest_change(change: &State, state: &State, count: usize) -> Vec<f64> {
    let mut out = vec![0.0f64; count];
    let stride = state.suns * state.terms;
    for (change, state_level) in change.moments.chunks_exact(stride).zip(state.moments.chunks_exact(stride)) {
        let dark = largest_mean(state_level, state.terms) * DARK;
        let means = change.iter().zip(state_level).step_by(state.terms);
        for (c, m) in means {
            for (w, out) in out.iter_mut().enumerate() {
                let scale = m[w].abs() + dark[w];
                if scale > 0.0 {
                    let ratio = f64::from(c[w].abs() / scale);
                    *out = if ratio > *out || ratio.is_nan() { ratio } else { *out };
                }
            }
        }
    }
    out
}

/// The largest mean radiance of a level.
pub fn largest_mean(level: &[Lanes], terms: usize) -> Lanes {
    let mut largest = Lanes::ZERO;
    for m in level.iter().step_by(terms) {
        for w in 0..WIDTH {
            largest[w] = if m[w] > largest[w] { m[w] } else { largest[w] };
        }
    }
    largest
}
