//! An atlas from the bytes of an EXR file that [`super::to_exr_bytes`] made. No size in the header is trusted:
//! what is allocated is bounded by what the file's own size can unpack to.

use super::header;
use crate::error::{Error, Result};
use crate::files::atlas::{Atlas, Attribute, Channel, Samples};
use crate::files::manifest::Origin;
use crate::machine::memory;
use exr::block::UncompressedBlock;
use exr::block::chunk::{Chunk, CompressedBlock, TileCoordinates};
use exr::block::reader::{ChunksReader, Reader};
use exr::meta::attribute::{LevelMode, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, MetaData, magic_number};
use exr::prelude::{Compression, Vec2};
use half::f16;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

/// Why a file cannot be read; [`from_exr_bytes`] adds the file's name.
type Read<T> = Result<T>;

/// The atlas in the bytes of an EXR file, its channels in alphabetical order; `path` is for messages only.
///
/// # Errors
/// `File`, with a reason of one line, for bytes that are truncated, damaged, or not such an atlas.
pub fn from_exr_bytes(path: &Path, bytes: &[u8]) -> Result<Atlas> {
    let name = path.display().to_string();
    parse(name, bytes).map_err(|reason| Error::file(path, reason))
}

fn parse(name: String, bytes: &[u8]) -> Read<Atlas> {
    if !bytes.starts_with(&magic_number::BYTES) {
        return Err("not an EXR file".into());
    }
    let reader = exr::block::read(Cursor::new(bytes), true).map_err(reason)?;
    let header = tiled_header(reader.headers())?;
    let mut atlas = empty_atlas(name, header)?;
    let types = channel_types(header)?;
    check_size(header, &types, bytes.len())?;
    let (meta, stored) = stored_tiles(reader, atlas.columns)?;
    let mut stored: Vec<(usize, Chunk)> =
        stored.into_iter().enumerate().map(|(place, tile)| (atlas.slice_at(place), tile)).collect();
    stored.retain(|(slice, _)| *slice < atlas.slices);
    stored.sort_by_key(|(slice, _)| *slice);
    let tiles: Vec<Vec<u8>> = stored
        .into_par_iter()
        .map(|(_, tile)| UncompressedBlock::decompress_chunk(tile, &meta, true).map(|block| block.data))
        .collect::<exr::error::Result<_>>()
        .map_err(reason)?;
    atlas.channels = unravel(&atlas, &types, &tiles);
    Ok(atlas)
}

/// The crate's error on one line; the names that it quotes may hold line breaks.
fn reason(error: exr::error::Error) -> String {
    let text = match error {
        exr::error::Error::NotSupported(what) => format!("an EXR file of another kind: {what}"),
        exr::error::Error::Invalid(what) => format!("truncated or damaged: {what}"),
        other => format!("truncated or damaged: {other}"),
    };
    text.replace(char::is_control, " ")
}

fn tiled_header(headers: &[Header]) -> Read<&Header> {
    match headers {
        [header] if header.blocks.has_tiles() => Ok(header),
        _ => Err("an EXR file of another kind: wanted is a single part in tiles".into()),
    }
}

/// Sizes and attributes, checked against each other; no channels yet.
fn empty_atlas(name: String, header: &Header) -> Read<Atlas> {
    let other = header.own_attributes.other.iter();
    let mut attributes: BTreeMap<String, Attribute> = other
        .filter_map(|(name, value)| Some((header::decode_text(name)?, header::decode(value)?)))
        .collect();
    let mut packing = [0usize; 5];
    for (slot, key) in packing.iter_mut().zip(header::PACKING) {
        let Some(Attribute::Int(v)) = attributes.remove(key) else {
            return Err(format!("the header has no {key} of type int: not a file of this tool").into());
        };
        *slot = usize::try_from(v).ok().filter(|&v| v > 0).ok_or(format!("damaged header: {key} = {v}"))?;
    }
    let [width, height, slices, columns, rows] = packing;
    let origin = match attributes.remove(header::ORIGIN.0) {
        None => Origin::TopLeft,
        Some(Attribute::Text(text)) if text == header::ORIGIN.1 => Origin::BottomLeft,
        Some(other) => return Err(format!("damaged header: {} = {other:?}", header::ORIGIN.0).into()),
    };
    let atlas = Atlas { name, width, height, slices, columns, origin, channels: Vec::new(), attributes };
    let position = header.own_attributes.layer_position;
    // Each factor comes from 31 bits.
    let picture = Vec2(width * columns, height * rows);
    if columns > slices || atlas.rows() != rows || (position, header.layer_size) != (Vec2(0, 0), picture) {
        return Err("the picture's size and its packing of slices disagree".into());
    }
    match header.blocks {
        BlockDescription::Tiles(tiles)
            if (tiles.tile_size, tiles.level_mode) == (Vec2(width, height), LevelMode::Singular) => {}
        _ => return Err("a tile is not a slice".into()),
    }
    match header.compression {
        // Tiles know no difference between the two.
        Compression::ZIP1 | Compression::ZIP16 => Ok(atlas),
        other => Err(format!("its compression is not ZIP but {other}").into()),
    }
}

/// Name and bytes a sample of each channel.
fn channel_types(header: &Header) -> Read<Vec<(String, usize)>> {
    let channel_type = |channel: &exr::meta::attribute::ChannelDescription| {
        let name = header::decode_text(&channel.name).ok_or("damaged header: a name is no text")?;
        match channel.sample_type {
            SampleType::F16 => Ok((name, 2)),
            SampleType::F32 => Ok((name, 4)),
            SampleType::U32 => {
                Err(Error::Reason(format!("channel {name:?} has whole numbers; wanted is half or float")))
            }
        }
    };
    header.channels.list.iter().map(channel_type).collect()
}

/// The largest raw size that a deflate stream of `compressed` bytes can have (zlib's documentation: 1032:1).
fn largest_inflated(compressed: usize) -> usize {
    compressed.saturating_mul(1032)
}

/// What a tile takes at least: its place in the table of offsets, coordinates, size, and a byte of data.
const LEAST_TILE: usize = 8 + 16 + 4 + 1;

/// Refuses a header whose picture a file of `length` bytes cannot hold, before anything of its size is made.
fn check_size(header: &Header, types: &[(String, usize)], length: usize) -> Read<()> {
    let Vec2(width, height) = header.layer_size;
    let texel: usize = types.iter().map(|(_, bytes)| bytes).sum();
    let raw = width.checked_mul(height).and_then(|n| n.checked_mul(texel));
    if header.chunk_count > length / LEAST_TILE || raw.is_none_or(|raw| raw > largest_inflated(length)) {
        let picture = format!("{width}x{height} texels of {texel} bytes");
        return Err(format!("truncated or damaged: {picture} cannot be in a file of {length} bytes").into());
    }
    // Unpacked tiles, their channels put together, and the table that a caller makes of them as single precision.
    memory::check(raw.unwrap_or(0).saturating_mul(5) as u64)
}

/// Every tile, still compressed, by rows and then columns; each is there once.
fn stored_tiles(reader: Reader<Cursor<&[u8]>>, columns: usize) -> Read<(MetaData, Vec<Chunk>)> {
    let chunks = reader.filter_chunks(true, |_, _, _| true).map_err(reason)?;
    let meta = chunks.meta_data().clone();
    let mut tiles = chunks.collect::<exr::error::Result<Vec<Chunk>>>().map_err(reason)?;
    let place = |tile: &Chunk| match &tile.compressed_block {
        CompressedBlock::Tile(tile) => Some(tile.coordinates),
        _ => None,
    };
    tiles.sort_by_key(|tile| place(tile).map(|at| (at.tile_index.y(), at.tile_index.x())));
    for (slice, tile) in tiles.iter().enumerate() {
        let tile_index = Vec2(slice % columns, slice / columns);
        if place(tile) != Some(TileCoordinates { tile_index, level_index: Vec2(0, 0) }) {
            return Err(format!("truncated or damaged: slice {slice} is not at its place").into());
        }
    }
    Ok((meta, tiles))
}

/// The lines of tiles, each channel's put together in the order `[slice][y][x]`.
fn unravel(atlas: &Atlas, types: &[(String, usize)], tiles: &[Vec<u8>]) -> Vec<Channel> {
    let line_bytes: usize = types.iter().map(|(_, bytes)| bytes * atlas.width).sum();
    let before = |k: usize| types[..k].iter().map(|(_, bytes)| bytes * atlas.width).sum::<usize>();
    let line = |n: usize| {
        let (slice, y) = (n / atlas.height, n % atlas.height);
        &tiles[slice][atlas.y_of_line(y) * line_bytes..][..line_bytes]
    };
    let channel = |(k, (name, bytes)): (usize, &(String, usize))| {
        let place = before(k)..before(k) + bytes * atlas.width;
        let mut stream = Vec::with_capacity(atlas.slices * atlas.slice_len() * bytes);
        for line in (0..tiles.len() * atlas.height).map(line) {
            stream.extend_from_slice(&line[place.clone()]);
        }
        // The crate gives samples in the machine's byte order.
        let samples = if *bytes == 2 {
            Samples::Half(stream.chunks_exact(2).map(|b| f16::from_ne_bytes([b[0], b[1]])).collect())
        } else {
            let fours = stream.chunks_exact(4);
            Samples::Float(fours.map(|b| f32::from_ne_bytes([b[0], b[1], b[2], b[3]])).collect())
        };
        Channel { name: name.clone(), samples }
    };
    types.par_iter().enumerate().map(channel).collect()
}
