//! `tyndall` bakes lookup tables for planetary atmospheres and waters.
//!
//! The pipeline, one way: preset → spectrum + medium → optical depth → single scattering → orders →
//! tables → colour → files. A preview, an engine or `tyndall sample` then reads the files alone.
//!
//! In scope: scalar radiative transfer in a spherical shell, any number of constituents, absorbers, a
//! Lambertian ground, one star; plane-parallel water under a flat surface. Out of scope: polarisation,
//! refraction in air, waves, horizontal variation, clouds with edges, thermal emission.
//!
//! Each folder is a room. A room knows only rooms below it; `tests/architecture.rs` lists which, and fails on any other
//! `use`.
//!
//! Conventions. SI units and f64 outside the transport loops, nanometres for wavelengths only. `mu`, `mu_s`
//! and `nu` are cosines of the view zenith, sun zenith and view–sun angles; directions point away from the
//! observer: into the view, towards the sun. `r` is a radius from the planet's centre, `altitude` a height
//! over its ground. Phase functions integrate to 1 over the sphere, so that Elek & Kmoch's divisions of the
//! scattering coefficient by 4π (Eqs. 7, 12) are absent; the factor 1/π of a Lambertian ground, absent from
//! their Eq. 8, is present. Radiances are per unit solar irradiance on a plane normal to the beam (1/sr).

pub mod algorithm1;
pub mod bake;
#[cfg(feature = "chart")]
pub mod chart;
pub mod colour;
#[cfg(feature = "cli")]
pub mod commands;
pub mod error;
pub mod files;
pub mod geometry;
pub mod layout;
pub mod machine;
pub mod mapping;
pub mod math;
pub mod medium;
pub mod methods;
pub mod plan;
pub mod preset;
pub mod quality;
pub mod reference;
pub mod spectrum;
pub mod transport;

pub use error::{Error, Line, Result};
