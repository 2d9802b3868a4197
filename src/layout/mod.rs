//! Ways to store light: a folder a layout, with its tables, how they are filled, looked up and held against the solver.

pub mod compact;
pub mod elek2010;
pub mod extinction;
pub mod settings;
pub mod shader;
pub mod sky;
pub mod table_data;
pub mod three_atmosphere;
pub mod water;
