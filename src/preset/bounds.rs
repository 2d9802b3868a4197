//! What a number of a preset may be: held against by the reader and stated by the JSON Schema.

/// An interval, and how it is called after "must be".
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub low: f64,
    pub high: f64,
    /// Whether the ends themselves are out.
    pub open: [bool; 2],
    pub text: &'static str,
}

pub(super) const POSITIVE: Bounds = Bounds::above(0.0, "greater than 0");
pub(super) const NOT_NEGATIVE: Bounds =
    Bounds { low: 0.0, high: f64::INFINITY, open: [false; 2], text: "0 or more" };
pub(super) const SHARE: Bounds = Bounds::within(0.0, 1.0, "between 0 and 1");

impl Bounds {
    /// Greater than a number.
    pub(super) const fn above(low: f64, text: &'static str) -> Self {
        Bounds { low, high: f64::INFINITY, open: [true, false], text }
    }

    /// Between two numbers or one of them.
    pub(super) const fn within(low: f64, high: f64, text: &'static str) -> Self {
        Bounds { low, high, open: [false; 2], text }
    }

    /// Greater than a number, and another one at the most.
    pub(super) const fn up_to(low: f64, high: f64, text: &'static str) -> Self {
        Bounds { low, high, open: [true, false], text }
    }

    /// 1 or whatever else is low, and less than a number.
    pub(super) const fn below(low: f64, high: f64, text: &'static str) -> Self {
        Bounds { low, high, open: [false, true], text }
    }

    /// Strictly between two numbers.
    pub(super) const fn between(low: f64, high: f64, text: &'static str) -> Self {
        Bounds { low, high, open: [true, true], text }
    }

    /// Whether a finite number lies inside.
    pub(super) fn hold(&self, v: f64) -> bool {
        let above = if self.open[0] { v > self.low } else { v >= self.low };
        let below = if self.open[1] { v < self.high } else { v <= self.high };
        above && below
    }
}
