//! From a planet to the bytes of every file: solve, choose colours, fill every layout, encode, report.

mod coarse;
pub(crate) mod describe;
mod doubts;
pub(crate) mod files;
pub mod inputs;
mod lights;
pub mod memory;
pub(crate) mod pictures;
mod pipeline;
mod product;
pub mod recolour;
pub mod report;
mod vectors;
pub mod versions;

pub use lights::Lights;
pub use pipeline::{bake, bake_in, check_folded};
pub use product::Product;
