//! `tyndall` bakes lookup tables for planetary atmospheres and waters.
//!
//! The pipeline, one way: preset → spectrum + medium → optical depth → single scattering → orders →
//! tables → colour → files. A preview, an engine or `tyndall sample` then reads the files alone.
//!
//! In scope: scalar radiative transfer in a spherical shell, any number of constituents, absorbers, a
//! Lambertian ground, one star; plane-parallel water under a flat surface. Out of scope: polarisation,
//! refraction in air, waves, horizontal variation, clouds with edges, thermal emission.
//!
//! A bake in memory, and a look-up in it:
//!
//! ```
//! use tyndall::{CompactSizes, Component, Point, Settings, bake, layout_named, load_planet};
//!
//! let planet = load_planet("mars", &[])?;
//! let sizes = CompactSizes { single: [8, 32, 16, 4], multiple: [8, 16, 16, 4], ..Default::default() };
//! let layouts = vec![layout_named("compact").expect("a layout of this library")];
//! let settings = Settings { layouts, compact: sizes.into(), ..Settings::default() };
//! let baked = bake(&planet, &settings, &mut |_stage| ())?;
//!
//! // From two metres up, straight into the sky, the sun 30 degrees high: linear RGB per star illuminance, 1/sr.
//! let zenith = Point { altitude: 2.0, mu: 1.0, mu_s: 0.5, azimuth_deg: 0.0 };
//! let [red, _, blue] = baked.sky("compact")?.rgb(&zenith, Component::Total);
//! assert!(red > 1.5 * blue, "the dusty sky of Mars is brown by day: {red} {blue}");
//! # Ok::<(), tyndall::Error>(())
//! ```
//!
//! [`Product::write`] puts the same files on disk; [`open_sky`] reads them back.
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

#![warn(missing_docs, unreachable_pub)]

/// What the two programs and the tests of this package use beside the public face below. It changes without notice.
#[doc(hidden)]
#[path = "."]
pub mod internals {
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
}
use internals::*;

pub use bake::{Product, bake};
pub use error::{Error, Result};
pub use files::container::Container;
pub use files::manifest::Manifest;
pub use geometry::Point;
pub use layout::compact::{CompactSettings, Sizes as CompactSizes};
pub use layout::settings::{Settings, Solver, Storage};
pub use layout::sky::{AerosolPhase, Channels, Component, Sky, open as open_sky};
pub use layout::water::Waters;
pub use layout::{ALL as LAYOUTS, Layout, named as layout_named};
pub use mapping::{Views, Window};
pub use medium::{Constituent, DensityProfile, Medium, PhaseFunction, Role};
pub use preset::{Planet, Water, load as load_planet, load_water, read as read_planet, read_water};
pub use preset::{shipped_names as shipped_planets, shipped_water_names as shipped_waters};
pub use reference::Tracer;
pub use spectrum::{Adaptation, ColourSpace, Observer, Rgb, Spectrum, White};
pub use spectrum::{Lab, delta_e_2000, fine_grid, grid, lab_of_xyz, planck_law};
pub use transport::solve::{Orders, Resolution, Solution};
