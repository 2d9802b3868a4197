//! An atlas as the bytes of an EXR file.

use super::{LONG_NAMES, MAGIC, VERSION, header, zip};
use crate::error::Result;
use crate::export::atlas::{Atlas, Channel, Samples};
use rayon::prelude::*;

/// Tile x and y, level x and y, size of the data: five 32-bit numbers before every tile.
const TILE_HEADER: usize = 20;

/// The bytes of an EXR file that holds `atlas`: the same on every run and for any number of threads.
///
/// # Errors
/// `Argument` if the samples do not fit the sizes or names cannot be stored; `NotFinite` if a sample is
/// infinite or not a number.
pub fn to_exr_bytes(atlas: &Atlas) -> Result<Vec<u8>> {
    atlas.check()?;
    let channels = atlas.sorted_channels();
    // A tiled file must hold every tile, so the empty places of the last row are tiles of zeros.
    let tiles: Vec<Vec<u8>> = (0..atlas.columns * atlas.rows())
        .into_par_iter()
        .map(|slice| zip::pack(raw_tile(atlas, &channels, slice)))
        .collect();
    let mut file = header_bytes(atlas);
    file.reserve(tiles.iter().map(|t| t.len() + TILE_HEADER + 8).sum());
    let mut offset = file.len() + 8 * tiles.len();
    for tile in &tiles {
        file.extend_from_slice(&(offset as u64).to_le_bytes());
        offset += TILE_HEADER + tile.len();
    }
    for (index, tile) in tiles.iter().enumerate() {
        for number in [index % atlas.columns, index / atlas.columns, 0, 0, tile.len()] {
            file.extend_from_slice(&(number as i32).to_le_bytes());
        }
        file.extend_from_slice(tile);
    }
    Ok(file)
}

fn header_bytes(atlas: &Atlas) -> Vec<u8> {
    let attributes = header::attributes(atlas);
    let long = attributes.keys().chain(atlas.channels.iter().map(|c| &c.name)).any(|name| name.len() > 31);
    let version = VERSION | if long { LONG_NAMES } else { 0 };
    let mut bytes = [MAGIC, version.to_le_bytes()].concat();
    for (name, (kind, value)) in attributes {
        bytes.extend_from_slice(name.as_bytes());
        bytes.push(0);
        bytes.extend_from_slice(kind.as_bytes());
        bytes.push(0);
        bytes.extend_from_slice(&(value.len() as i32).to_le_bytes());
        bytes.extend_from_slice(&value);
    }
    bytes.push(0);
    bytes
}

/// A slice in EXR's order: line by line, in a line channel by channel; zeros past the last slice.
fn raw_tile(atlas: &Atlas, channels: &[&Channel], slice: usize) -> Vec<u8> {
    let line_bytes: usize = channels.iter().map(|c| c.samples.bytes() * atlas.width).sum();
    let mut raw = Vec::with_capacity(line_bytes * atlas.height);
    if slice >= atlas.slices {
        raw.resize(line_bytes * atlas.height, 0);
        return raw;
    }
    for y in 0..atlas.height {
        let start = slice * atlas.slice_len() + y * atlas.width;
        let line = start..start + atlas.width;
        for channel in channels {
            match &channel.samples {
                Samples::Half(v) => raw.extend(v[line.clone()].iter().flat_map(|x| x.to_le_bytes())),
                Samples::Float(v) => raw.extend(v[line.clone()].iter().flat_map(|x| x.to_le_bytes())),
            }
        }
    }
    raw
}
