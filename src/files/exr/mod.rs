//! OpenEXR files of atlases: single-part, single-level, tiled, ZIP; one tile is one slice of the table.
//!
//! The `exr` crate writes and reads them, tile by tile ([`exr::block`]): tiles are compressed on the thread pool
//! of the caller, and a header is checked before anything of the size that it claims is allocated. One thing
//! is added: the crate keeps custom attributes in a hash map, whose order changes from run to run, so a
//! written header's attributes are put in the order of their names.

mod header;
mod order;
mod read;
mod spectral;
mod write;

pub use read::from_exr_bytes;
pub use spectral::{Spectral, spectral_attributes, spectral_channel, wavelength_of_channel};
pub use write::to_exr_bytes;
