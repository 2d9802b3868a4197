//! Radiative transfer in a spherical shell: from a [`crate::medium::Medium`] to radiance at any view.
//!
//! The light scattered more than once is found from a few angular moments of the radiance at each altitude
//! and sun angle, which are all that smooth phase functions can see (solver in [`solve`]); light scattered
//! once is integrated apart with its exact phase function, because its shadow edges and peaks are sharp.
//! Knows no preset, file or colour. All radiances are per unit solar irradiance normal to the beam, 1/sr.

pub(crate) mod azimuth;
pub mod balance;
mod bundles;

mod column;

pub mod exact;
pub mod extent;
pub mod fill;
mod forward;
#[cfg(test)]
mod furnace;
mod kernels;
mod krylov;
mod levels;
mod moments;
mod operator;
mod optics;
mod path;
mod precondition;
mod rays;
mod refined;
pub mod slab;
pub mod solve;
mod state;
mod sunlight;

pub use optics::PhaseLanes as Phase;

/// Raised when the bytes of what every bake shares change: solver, spectra, colours, report, pictures (see
/// [`crate::bake::versions`]).
pub const ALGORITHM_VERSION: u32 = 1;
