//! OpenEXR files of atlases: single-part, single-level, tiled, ZIP; one tile is one slice of the table.
//!
//! Written and read here rather than through a general crate, for three reasons that were measured: the same
//! atlas always gives the same bytes (the `exr` crate keeps attributes in a hash map, whose order changes from
//! run to run), slices are compressed straight from their order in memory, several times faster than through
//! its fixed miniz level, and damaged files end in an error because no step trusts a length. The tests read
//! every kind of file back with that crate, as a second opinion.
//!
//! Layout after the OpenEXR file-layout document: magic, version, attributes, tile offsets, tiles.

mod header;
mod read;
mod spectral;
mod write;
mod zip;

pub use read::{from_exr, from_exr_bytes};
pub use spectral::{Spectral, spectral_attributes, spectral_channel, wavelength_of_channel};
pub use write::to_exr_bytes;

const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];
/// Version 2, bit 9: a single-part tiled file.
const VERSION: u32 = 0x202;
/// Bit 10: names up to 255 bytes instead of 31.
const LONG_NAMES: u32 = 0x400;

/// The largest raw size that a deflate stream of `compressed` bytes can have (zlib's documentation: 1032:1).
fn largest_inflated(compressed: usize) -> usize {
    compressed.saturating_mul(1032)
}
