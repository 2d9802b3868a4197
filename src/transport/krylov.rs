//! The sum of all orders as the solution of a linear system.
//!
//! (I − A) x = b is solved by generalised conjugate residuals (Eisenstat, Elman & Schultz 1983) with a column
//! preconditioner, for sixteen wavelengths at once, each with its own coefficients. In thin air the preconditioner
//! alone is nearly the inverse; in thick, loss-free air light is scattered thousands of times, and where the sun's
//! height is interpolated fine waves along it fade that the preconditioner takes for lasting: there the directions
//! that the method keeps do the work.

use super::operator::Operator;
use super::precondition::Preconditioner;
use super::solve::{DARK, Report, largest_change, largest_mean, worst};
use super::state::State;
use crate::machine::lanes::{Lanes, WIDTH};
use rayon::prelude::*;

/// Applications after which a solution that has not converged is left as it is; the residual tells.
const MOST_APPLICATIONS: usize = 120;
/// Relative change of the residual below which it stands still.
const STILL: f64 = 0.01;
/// Directions that are kept: each costs two states.
const MOST_KEPT: usize = 16;
/// Applications after which the residual is no longer trusted to its recurrence in single precision.
const TRUSTED: usize = 8;

/// A direction p of the search and q = (I − A) p, of norm 1.
struct Direction {
    p: State,
    q: State,
}

/// The sum of all orders that follow from `first`, until one more would change no mean radiance by more than
/// `tolerance`.
pub(super) fn converge(operator: &Operator, first: State, tolerance: f64) -> (State, Report) {
    let preconditioner = Preconditioner::new(operator);
    let mut x = first.clone();
    preconditioner.solve(&mut x);
    let mut rest = next_change(operator, &first, &x);
    let mut kept: Vec<Direction> = Vec::new();
    let mut best = (f64::INFINITY, x.clone());
    let mut weights = Weights::new(&x);
    let (mut applications, mut before) = (1, f64::INFINITY);
    loop {
        let mut residual = largest_change(&rest, &x, operator.optics.count);
        if worst(&residual) < tolerance && !kept.is_empty() && applications > TRUSTED {
            rest = next_change(operator, &first, &x);
            applications += 1;
            kept.clear();
            weights = Weights::new(&x);
            residual = largest_change(&rest, &x, operator.optics.count);
        }
        let largest = worst(&residual);
        let mut p = rest.clone();
        if largest < tolerance {
            preconditioner.solve(&mut p);
            x.add(&p);
            return (x, Report { applications, residual });
        }
        // Where the preconditioner leads to what was left already, the next step goes without it. In lower shells it
        // may stand still for a while too, but goes on by itself.
        if !operator.geometry.is_tall() || (largest / before - 1.0).abs() > STILL {
            preconditioner.solve(&mut p);
        }
        before = largest;
        if largest < best.0 {
            best = (largest, x.clone());
        }
        if applications >= MOST_APPLICATIONS {
            let residual = largest_change(&next_change(operator, &first, &best.1), &best.1, residual.len());
            return (best.1, Report { applications: applications + 1, residual });
        }
        let direction = new_direction(operator, p, &kept, &weights);
        let step = weights.product(&rest, &direction.q);
        x.add_times(&direction.p, step);
        rest.add_times(&direction.q, step * -1.0);
        applications += 1;
        if kept.len() == MOST_KEPT {
            kept.remove(0);
        }
        kept.push(direction);
    }
}

/// The direction p made orthogonal to those kept.
fn new_direction(operator: &Operator, mut p: State, kept: &[Direction], weights: &Weights) -> Direction {
    let mut q = p.clone();
    q.add_times(&operator.apply(&p), Lanes::splat(-1.0));
    for old in kept {
        let share = weights.product(&q, &old.q) * -1.0;
        q.add_times(&old.q, share);
        p.add_times(&old.p, share);
    }
    let square = weights.product(&q, &q);
    let inverse = square.map(|s| if s > 0.0 { 1.0 / s.sqrt() } else { 0.0 });
    q.scale_by(inverse);
    p.scale_by(inverse);
    Direction { p, q }
}

/// b + A x − x
fn next_change(operator: &Operator, first: &State, x: &State) -> State {
    let mut change = operator.apply(x);
    change.add(first);
    change.add_times(x, Lanes::splat(-1.0));
    change
}

/// 1 / (|v| + dark), and 0 where both are nothing.
fn inverse(v: &Lanes, dark: Lanes) -> Lanes {
    let mut out = Lanes::ZERO;
    for w in 0..WIDTH {
        let scale = v[w].abs() + dark[w];
        out[w] = if scale > 0.0 { 1.0 / scale } else { 0.0 };
    }
    out
}

/// What a deviation counts for: relative to the mean radiance of its place.
struct Weights {
    /// `[level][sun node]`
    nodes: Vec<Lanes>,
    ground: Vec<Lanes>,
}

impl Weights {
    fn new(x: &State) -> Self {
        let stride = x.suns * x.terms;
        let nodes = x.moments.chunks_exact(stride).flat_map(|level| {
            let dark = largest_mean(level, x.terms) * DARK;
            level.iter().step_by(x.terms).map(move |m| inverse(m, dark))
        });
        let ground = largest_mean(&x.ground, 1) * DARK;
        Weights { nodes: nodes.collect(), ground: x.ground.iter().map(|g| inverse(g, ground)).collect() }
    }

    /// Weighted scalar product, wavelength by wavelength; summed level by level in a fixed order.
    fn product(&self, a: &State, b: &State) -> Lanes {
        let stride = a.suns * a.terms;
        let levels = a.moments.par_chunks_exact(stride).zip(b.moments.par_chunks_exact(stride));
        let parts: Vec<Lanes> = levels
            .zip(self.nodes.par_chunks_exact(a.suns))
            .map(|((a_level, b_level), weights)| {
                let nodes = a_level.chunks_exact(a.terms).zip(b_level.chunks_exact(a.terms));
                let mut sum = Lanes::ZERO;
                for ((a, b), weight) in nodes.zip(weights) {
                    for (a, b) in a.iter().zip(b) {
                        sum += *a * *weight * (*b * *weight);
                    }
                }
                sum
            })
            .collect();
        let ground = a.ground.iter().zip(&b.ground).zip(&self.ground);
        let mut sum = parts.into_iter().fold(Lanes::ZERO, |s, v| s + v);
        for ((a, b), weight) in ground {
            sum += *a * *weight * (*b * *weight);
        }
        sum
    }
}
