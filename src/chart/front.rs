//! Which methods no other beats in both cost and error.

use super::{Chart, Errors, Measured};
use crate::quality::REGIONS;

/// What a method costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cost {
    Preparation,
    Bytes,
    LookUp,
}

impl Cost {
    pub const ALL: [Cost; 3] = [Cost::Preparation, Cost::Bytes, Cost::LookUp];

    pub fn of(self, m: &Measured) -> f64 {
        match self {
            Cost::Preparation => m.preparation,
            Cost::Bytes => m.bytes as f64,
            Cost::LookUp => m.nanoseconds,
        }
    }

    /// For axes.
    pub fn label(self) -> &'static str {
        match self {
            Cost::Preparation => "preparation, CPU s",
            Cost::Bytes => "tables, bytes",
            Cost::LookUp => "look-up, CPU ns",
        }
    }

    pub fn name(self) -> &'static str {
        match self {
            Cost::Preparation => "preparation",
            Cost::Bytes => "bytes",
            Cost::LookUp => "look-up",
        }
    }
}

/// The error that fronts are made of.
pub fn value(errors: &Errors) -> f64 {
    errors.delta_e.p95
}

/// Numbers of the methods on the front of a region, from the cheapest: each is more accurate than all that cost no more.
pub fn front(chart: &Chart, region: usize, cost: Cost) -> Vec<usize> {
    let mut points: Vec<(f64, f64, usize)> = points(chart, region, cost);
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut best = f64::INFINITY;
    let mut out = Vec::new();
    for (_, error, n) in points {
        if error < best {
            best = error;
            out.push(n);
        }
    }
    out
}

/// Cost, error and number of each method that answers.
fn points(chart: &Chart, region: usize, cost: Cost) -> Vec<(f64, f64, usize)> {
    let point = |(n, m): (usize, &Measured)| {
        m.errors(&chart.truth, region).map(|e| (cost.of(m), value(&e), n)).filter(|p| p.1.is_finite())
    };
    chart.methods.iter().enumerate().filter_map(point).collect()
}

/// A method of others that none of ours beats or equals in both.
#[derive(Clone, Debug, PartialEq)]
pub struct Exception {
    pub region: &'static str,
    pub cost: Cost,
    pub method: usize,
}

/// Where our methods do not dominate.
pub fn exceptions(chart: &Chart) -> Vec<Exception> {
    let mut out = Vec::new();
    for (region, named) in REGIONS.iter().enumerate() {
        for cost in Cost::ALL {
            let points = points(chart, region, cost);
            let is_ours = |n: usize| chart.methods[n].family.is_ours();
            for (c, e, n) in points.iter().filter(|p| !is_ours(p.2)) {
                if !points.iter().any(|p| is_ours(p.2) && p.0 <= *c && p.1 <= *e) {
                    out.push(Exception { region: named.name, cost, method: *n });
                }
            }
        }
    }
    out
}
