//! An atlas as the bytes of an EXR file.

use super::{header, order};
use crate::error::{Error, Result};
use crate::files::atlas::{Atlas, Channel, Samples};
use exr::block::UncompressedBlock;
use exr::block::chunk::Chunk;
use exr::block::writer::ChunksWriter;
use exr::meta::MetaData;
use rayon::prelude::*;
use std::io::Cursor;

/// The bytes of an EXR file that holds `atlas`: the same on every run and for any number of threads.
///
/// # Errors
/// `Argument` if the samples do not fit the sizes or names cannot be stored (OpenEXR's own attributes are not
/// to be set); `NotFinite` if a sample is infinite or not a number.
pub fn to_exr_bytes(atlas: &Atlas) -> Result<Vec<u8>> {
    atlas.check()?;
    let mut file = Cursor::new(Vec::new());
    let headers = [header::header(atlas)].into_iter().collect();
    exr::block::write(&mut file, headers, true, |meta, writer| {
        for (slice, tile) in compressed_tiles(atlas, &meta)?.into_iter().enumerate() {
            writer.write_chunk(slice, tile)?;
        }
        Ok(())
    })
    .map_err(|e| Error::Argument(format!("{}: {e}", atlas.name)))?;
    Ok(order::by_name(file.into_inner()))
}

/// Every tile in the order of the file, compressed on the current thread pool; the crate's own parallel writer
/// would start another pool, with a thread for each core.
fn compressed_tiles(atlas: &Atlas, meta: &MetaData) -> exr::error::Result<Vec<Chunk>> {
    let channels = atlas.sorted_channels();
    let places: Vec<_> = meta.enumerate_ordered_header_block_indices().collect();
    places
        .into_par_iter()
        .map(|(slice, index)| {
            let data = raw_tile(atlas, &channels, slice);
            UncompressedBlock { index, data }.compress_to_chunk(&meta.headers)
        })
        .collect()
}

/// The tile at a place of the grid in EXR's order: line by line, in a line channel by channel. A tiled file must hold
/// every tile, so the empty places after the last slice are tiles of zeros.
fn raw_tile(atlas: &Atlas, channels: &[&Channel], place: usize) -> Vec<u8> {
    let slice = atlas.slice_at(place);
    let line_bytes: usize = channels.iter().map(|c| c.samples.bytes() * atlas.width).sum();
    let mut raw = Vec::with_capacity(line_bytes * atlas.height);
    if slice >= atlas.slices {
        raw.resize(line_bytes * atlas.height, 0);
        return raw;
    }
    for line in 0..atlas.height {
        let start = slice * atlas.slice_len() + atlas.y_of_line(line) * atlas.width;
        let line = start..start + atlas.width;
        for channel in channels {
            match &channel.samples {
                // The crate takes the machine's byte order, and stores little-endian.
                Samples::Half(v) => raw.extend(v[line.clone()].iter().flat_map(|x| x.to_ne_bytes())),
                Samples::Float(v) => raw.extend(v[line.clone()].iter().flat_map(|x| x.to_ne_bytes())),
            }
        }
    }
    raw
}
