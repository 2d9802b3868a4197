//! Finished tables to files: atlases as EXR, the manifest, a bake folder that replaces the old one whole,
//! pictures. No physics here.

pub mod atlas;
pub mod exr;
pub mod interrupt;
pub mod replace;
pub mod staging;

pub use atlas::{Atlas, Attribute, Channel, Samples};
