//! The older methods of the field, for the chart of accuracy against cost.

pub mod literal;
