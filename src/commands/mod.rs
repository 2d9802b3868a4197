//! One file a command: arguments in, results on standard output, talk on standard error.

pub mod bake;
#[cfg(feature = "chart")]
pub mod chart;
pub mod colour;
pub mod colour_input;
pub mod colour_views;
pub mod diff;
mod machine;
pub mod plan;
pub mod presets;
mod presets_colour;
mod presets_show;
mod presets_water;
pub mod recolour;
pub mod reference;
mod reference_water;
pub mod sample;
mod sample_water;
mod text;
pub mod verify;

pub use machine::share_threads;
