//! Finished tables to files: atlases as EXR, the manifest, a bake folder that replaces the old one whole,
//! pictures. No physics here.

pub mod atlas;
pub mod bounded_read;
pub mod changes;
pub mod claim;
pub mod container;
pub mod exr;
mod font;
pub mod foreign;
mod in_place;
pub mod interrupt;
pub mod manifest;
mod mark;
pub mod picture;
pub mod points;
pub mod replace;
mod seal;
pub mod sheet;
#[cfg(feature = "cli")]
pub mod signals;
pub mod staging;
mod sweep;
pub mod whole;

pub use atlas::{Atlas, Attribute, Channel, Samples};
