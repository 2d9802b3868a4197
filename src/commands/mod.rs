//! One file a command: arguments in, results on standard output, talk on standard error.

pub mod colour;
mod colour_input;
pub mod presets;
mod presets_show;
mod text;
