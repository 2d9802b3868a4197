//! From a planet to the bytes of every file: solve, choose colours, fill every layout, encode, report.

mod coarse;
pub mod compact;
pub(crate) mod describe;
mod doubts;
pub mod elek2010;
pub(crate) mod extinction;
pub(crate) mod files;
pub mod inputs;
mod lights;
mod literal;
pub mod memory;
pub mod palette;
pub(crate) mod pictures;
mod pipeline;
pub mod recolour;
pub mod report;
pub mod settings;
pub mod skies;
mod spectral;
pub mod tables;
pub mod three_atmosphere;
mod vectors;
pub mod versions;
pub mod water;

pub use lights::Lights;
pub use pipeline::{Product, bake, bake_in, check_folded};
