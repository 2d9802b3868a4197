//! From a planet to the bytes of every file: solve, choose colours, fill every layout, encode, report.

mod coarse;
pub(crate) mod describe;
pub(crate) mod files;
mod golden_vectors;
pub mod memory;
pub(crate) mod pictures;
mod pipeline;
mod product;
pub mod provenance;
pub mod recolour;
pub mod report;
mod solution_cache;
pub mod versions;
mod warnings;

pub use pipeline::{bake, bake_in, check_folded};
pub(crate) use product::IN_MEMORY;
pub use product::Product;
pub use solution_cache::SolutionCache;
