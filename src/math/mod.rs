//! Mathematics without physics: quadrature.

pub mod quadrature;
