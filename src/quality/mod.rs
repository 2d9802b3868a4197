//! How far tables are from the truth: views drawn as a camera would meet them, and distributions of errors.

mod scope;
mod views;

pub use scope::Scope;
pub use views::{REGIONS, Region, views};

use serde_json::{Value, json};

/// Radiance over solar irradiance below which relative errors mean nothing, 1/sr: far below starlight.
pub const DARK: f64 = 1e-12;

/// Median, 95th percentile and largest of a list of errors.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distribution {
    pub count: usize,
    pub median: f64,
    pub p95: f64,
    pub max: f64,
}

impl Distribution {
    /// Of any list; values that are not numbers count as infinite.
    pub fn of(mut errors: Vec<f64>) -> Self {
        for e in &mut errors {
            if e.is_nan() {
                *e = f64::INFINITY;
            }
        }
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| {
            errors.get(((errors.len() as f64 - 1.0) * share).round() as usize).copied().unwrap_or(0.0)
        };
        Distribution { count: errors.len(), median: at(0.5), p95: at(0.95), max: at(1.0) }
    }

    /// For the manifest, rounded to what is meaningful: four significant digits.
    pub fn json(&self) -> Value {
        json!({ "count": self.count, "median": digits(self.median), "p95": digits(self.p95), "max": digits(self.max) })
    }
}

/// Four significant digits; what is not finite becomes a large number, which JSON can hold.
pub fn digits(v: f64) -> f64 {
    if !v.is_finite() {
        return 1e300;
    }
    format!("{v:.3e}").parse().unwrap_or(v)
}

/// |found / truth − 1| for every pair whose truth is above `floor`.
pub fn relative_errors(found: &[f64], truth: &[f64], floor: f64) -> Vec<f64> {
    found.iter().zip(truth).filter(|(_, t)| **t > floor).map(|(f, t)| (f / t - 1.0).abs()).collect()
}

/// Length of the difference of two colours over the length of the second.
pub fn colour_error(found: [f64; 3], truth: [f64; 3]) -> f64 {
    let length = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let difference = std::array::from_fn(|c| found[c] - truth[c]);
    length(difference) / length(truth)
}
