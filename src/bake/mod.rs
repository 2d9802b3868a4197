//! From a planet to finished tables: solve, choose colours, fill every layout, encode.

pub mod compact;
pub mod elek2010;
pub mod extinction;
pub mod palette;
pub mod skies;
pub mod tables;
