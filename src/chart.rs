//! Accuracy against cost.
