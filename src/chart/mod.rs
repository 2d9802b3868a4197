//! The chart of accuracy against cost: every method of the catalogue on the same views of one planet.
//!
//! The truth is the solver, converged and integrated directly along each view at sixteen wavelengths, as `sample --exact`
//! does; Monte Carlo checks it at stated points. Finished parts are kept in a work folder, so that a run that was
//! stopped goes on where it was.

pub mod draw;
mod front;
mod measure;
mod row;
pub mod stability;
mod truth;
mod work;

pub use front::{Cost, Measure, Quantity, Statistic, exceptions, front, mark};
pub use measure::{Errors, Measured};
pub use row::{Row, checks_csv, parse_csv, read_csv, rows, to_csv};
pub use truth::{Check, Scene, Truth};
pub use work::forget as forget_work;

use crate::error::Result;
use crate::methods::Method;
use crate::preset::Planet;
use std::path::Path;
use work::Work;

/// What a chart is made of.
pub struct Chart {
    pub planet: String,
    pub truth: Truth,
    pub methods: Vec<Measured>,
    pub checks: Vec<Check>,
}

/// How much is done.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Views of each region.
    pub views: usize,
    /// Views of each region that Monte Carlo checks.
    pub checked: usize,
    /// Paths of each of these at most.
    pub paths: u64,
}

impl Default for Effort {
    fn default() -> Self {
        Effort { views: 40, checked: 2, paths: 1 << 13 }
    }
}

/// Measures all methods. `tell` hears of each part before it begins, with its number and how many there are. Parts that
/// a stopped run left in `work_folder` are taken from there. Errors: a medium without meaning, a folder that cannot be
/// written.
pub fn measure(
    planet: &Planet,
    methods: &[Box<dyn Method>],
    effort: Effort,
    work_folder: &Path,
    tell: &dyn Fn(&str, usize, usize),
) -> Result<Chart> {
    let work = Work::begin(work_folder, planet, effort)?;
    let parts = methods.len() + 2;
    tell("truth", 0, parts);
    let truth = work.part("truth", || Truth::solve(planet, effort.views))?;
    tell("Monte Carlo", 1, parts);
    let checks = work.part("checks", || truth.check(planet, effort))?;
    let mut out = Vec::new();
    for (n, method) in methods.iter().enumerate() {
        let name = format!("{}: {}", method.family().title(), method.setting());
        tell(&name, n + 2, parts);
        out.push(work.part(&name, || Ok(Measured::of(method.as_ref(), planet, &truth)))?);
    }
    Ok(Chart { planet: planet.name.clone(), truth, methods: out, checks })
}
