//! An atlas from the bytes of an EXR file that [`super::to_exr_bytes`] made. No length in the file is trusted:
//! what is allocated is bounded by what the file's own size can unpack to.

use super::{LONG_NAMES, MAGIC, VERSION, header, largest_inflated, zip};
use crate::error::{Error, Result};
use crate::export::atlas::{Atlas, Attribute, Channel, Samples};
use half::f16;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// Why a file cannot be read; [`from_exr`] adds its name.
type Read<T> = std::result::Result<T, String>;

/// The atlas in the EXR file at `path`, its channels in alphabetical order.
///
/// # Errors
/// `File`, with a reason of one line, for a file that is missing, truncated, damaged, or not such an atlas.
pub fn from_exr(path: &Path) -> Result<Atlas> {
    let bytes = std::fs::read(path).map_err(|e| Error::reading(path, e))?;
    from_exr_bytes(path, &bytes)
}

/// As [`from_exr`], for bytes already in memory; `path` is for messages only.
pub fn from_exr_bytes(path: &Path, bytes: &[u8]) -> Result<Atlas> {
    let name = path.display().to_string();
    parse(name, bytes).map_err(|reason| Error::file(path, reason))
}

fn parse(name: String, bytes: &[u8]) -> Read<Atlas> {
    let mut cursor = Cursor { bytes, at: 0 };
    let raw = read_header(&mut cursor)?;
    let mut atlas = empty_atlas(name, &raw)?;
    let types = channel_types(value(&raw, "channels", "chlist")?)?;
    let tile_bytes = tile_bytes(&atlas, &types)?;
    let stored = stored_tiles(&atlas, &mut cursor, tile_bytes)?;
    let tiles: Vec<Vec<u8>> = stored
        .into_par_iter()
        .enumerate()
        .map(|(k, tile)| zip::unpack(tile, tile_bytes).ok_or_else(|| format!("damaged data in slice {k}")))
        .collect::<Read<_>>()?;
    atlas.channels = unravel(&atlas, &types, &tiles);
    Ok(atlas)
}

struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a> Cursor<'a> {
    fn take(&mut self, length: usize) -> Read<&'a [u8]> {
        let end = self.at.checked_add(length).filter(|&end| end <= self.bytes.len());
        let end = end.ok_or_else(|| format!("truncated: it ends after {} bytes", self.bytes.len()))?;
        let taken = &self.bytes[self.at..end];
        self.at = end;
        Ok(taken)
    }

    fn array<const N: usize>(&mut self) -> Read<[u8; N]> {
        let mut out = [0; N];
        out.copy_from_slice(self.take(N)?);
        Ok(out)
    }

    fn int(&mut self) -> Read<i32> {
        Ok(i32::from_le_bytes(self.array()?))
    }

    fn text(&mut self) -> Read<String> {
        let rest = &self.bytes[self.at..];
        let length = rest.iter().take(256).position(|&b| b == 0).ok_or("truncated or damaged header")?;
        let text = std::str::from_utf8(&rest[..length]).map_err(|_| "damaged header: a name is no text")?;
        self.at += length + 1;
        Ok(text.to_string())
    }
}

type Header<'a> = BTreeMap<String, (String, &'a [u8])>;

fn read_header<'a>(cursor: &mut Cursor<'a>) -> Read<Header<'a>> {
    if cursor.array().ok() != Some(MAGIC) {
        return Err("not an EXR file".into());
    }
    let version = u32::from_le_bytes(cursor.array()?);
    if version & !LONG_NAMES != VERSION {
        return Err("an EXR file of another kind: wanted is a single part in tiles".into());
    }
    let mut header = Header::new();
    loop {
        let name = cursor.text()?;
        if name.is_empty() {
            return Ok(header);
        }
        let kind = cursor.text()?;
        let size = usize::try_from(cursor.int()?).map_err(|_| "damaged header: a negative size")?;
        header.insert(name, (kind, cursor.take(size)?));
    }
}

fn value<'a>(header: &Header<'a>, name: &str, kind: &str) -> Read<&'a [u8]> {
    match header.get(name) {
        Some((found, bytes)) if found == kind => Ok(bytes),
        _ => Err(format!("the header has no {name} of type {kind}: not a file of this tool")),
    }
}

fn ints<const N: usize>(header: &Header, name: &str, kind: &str) -> Read<[i32; N]> {
    let mut cursor = Cursor { bytes: value(header, name, kind)?, at: 0 };
    let mut out = [0; N];
    for slot in &mut out {
        *slot = cursor.int().map_err(|_| format!("damaged header: {name} is too short"))?;
    }
    Ok(out)
}

/// Sizes and attributes, checked against each other; no channels yet.
fn empty_atlas(name: String, header: &Header) -> Read<Atlas> {
    let mut packing = [0usize; 5];
    for (slot, key) in packing.iter_mut().zip(header::PACKING) {
        let [v] = ints(header, key, "int")?;
        *slot = usize::try_from(v).ok().filter(|&v| v > 0).ok_or(format!("damaged header: {key} = {v}"))?;
    }
    let [width, height, slices, columns, rows] = packing;
    let attributes = custom_attributes(header);
    let atlas = Atlas { name, width, height, slices, columns, channels: Vec::new(), attributes };
    let window: [i32; 4] = ints(header, "dataWindow", "box2i")?;
    // Each factor comes from 31 bits.
    let last = |a: usize, b: usize| a as i64 * b as i64 - 1;
    let picture = [0, 0, last(width, columns), last(height, rows)];
    let tile: [i32; 2] = ints(header, "tiles", "tiledesc")?;
    if columns > slices || atlas.rows() != rows || window.map(i64::from) != picture {
        return Err("the picture's size and its packing of slices disagree".into());
    }
    if tile.map(i64::from) != [width as i64, height as i64] {
        return Err("a tile is not a slice".into());
    }
    match value(header, "compression", "compression")? {
        // Tiles know no difference between ZIPS and ZIP.
        [2] | [header::ZIP] => Ok(atlas),
        _ => Err("its compression is not ZIP".into()),
    }
}

/// What the caller of the writer added: all but the attributes that the writer makes itself.
fn custom_attributes(header: &Header) -> BTreeMap<String, Attribute> {
    let own = ["pixelAspectRatio", "screenWindowWidth"];
    let custom = header
        .iter()
        .filter(|(name, _)| !header::PACKING.contains(&name.as_str()) && !own.contains(&name.as_str()));
    custom.filter_map(|(name, (kind, bytes))| Some((name.clone(), header::decode(kind, bytes)?))).collect()
}

/// Name and bytes a sample of each channel.
fn channel_types(list: &[u8]) -> Read<Vec<(String, usize)>> {
    let mut cursor = Cursor { bytes: list, at: 0 };
    let mut channels: Vec<(String, usize)> = Vec::new();
    loop {
        let name = cursor.text()?;
        if name.is_empty() {
            break;
        }
        let bytes = match cursor.int()? {
            header::HALF => 2,
            header::FLOAT => 4,
            other => {
                return Err(format!("channel {name:?} has sample type {other}; wanted is half or float"));
            }
        };
        cursor.take(4)?;
        if [cursor.int()?, cursor.int()?] != [1, 1] {
            return Err(format!("channel {name:?} is subsampled"));
        }
        if channels.last().is_some_and(|(last, _)| *last >= name) {
            return Err("damaged header: channels are not in order".into());
        }
        channels.push((name, bytes));
    }
    if channels.is_empty() { Err("it has no channels".into()) } else { Ok(channels) }
}

fn tile_bytes(atlas: &Atlas, types: &[(String, usize)]) -> Read<usize> {
    let texel: usize = types.iter().map(|(_, bytes)| bytes).sum();
    let bytes = atlas.width.checked_mul(atlas.height).and_then(|n| n.checked_mul(texel));
    bytes.ok_or_else(|| "damaged header: a slice of that size cannot be".into())
}

/// The stored bytes of each slice, in order. Refuses sizes that the bytes present cannot unpack to.
fn stored_tiles<'a>(atlas: &Atlas, cursor: &mut Cursor<'a>, tile_bytes: usize) -> Read<Vec<&'a [u8]>> {
    let count = atlas.columns.checked_mul(atlas.rows()).ok_or("damaged header: too many slices")?;
    let table = cursor.take(count.checked_mul(8).ok_or("damaged header: too many slices")?)?;
    let mut tiles = Vec::with_capacity(count);
    for (index, entry) in table.chunks_exact(8).enumerate() {
        let mut offset = [0; 8];
        offset.copy_from_slice(entry);
        let at = usize::try_from(u64::from_le_bytes(offset)).unwrap_or(usize::MAX).min(cursor.bytes.len());
        let mut tile = Cursor { bytes: cursor.bytes, at };
        let place = [tile.int()?, tile.int()?, tile.int()?, tile.int()?].map(i64::from);
        if place != [(index % atlas.columns) as i64, (index / atlas.columns) as i64, 0, 0] {
            return Err(format!("damaged data: slice {index} is not at its place"));
        }
        let size = usize::try_from(tile.int()?).map_err(|_| format!("damaged data in slice {index}"))?;
        if size > tile_bytes || tile_bytes > largest_inflated(size) {
            return Err(format!("damaged data: slice {index} cannot be of that size"));
        }
        tiles.push(tile.take(size)?);
    }
    tiles.truncate(atlas.slices);
    Ok(tiles)
}

/// The lines of tiles, each channel's put together in the order `[slice][y][x]`.
fn unravel(atlas: &Atlas, types: &[(String, usize)], tiles: &[Vec<u8>]) -> Vec<Channel> {
    let line_bytes: usize = types.iter().map(|(_, bytes)| bytes * atlas.width).sum();
    let before = |k: usize| types[..k].iter().map(|(_, bytes)| bytes * atlas.width).sum::<usize>();
    let channel = |(k, (name, bytes)): (usize, &(String, usize))| {
        let place = before(k)..before(k) + bytes * atlas.width;
        let mut stream = Vec::with_capacity(atlas.slices * atlas.slice_len() * bytes);
        for line in tiles.iter().flat_map(|tile| tile.chunks_exact(line_bytes)) {
            stream.extend_from_slice(&line[place.clone()]);
        }
        let samples = if *bytes == 2 {
            Samples::Half(stream.chunks_exact(2).map(|b| f16::from_le_bytes([b[0], b[1]])).collect())
        } else {
            let fours = stream.chunks_exact(4);
            Samples::Float(fours.map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
        };
        Channel { name: name.clone(), samples }
    };
    types.par_iter().enumerate().map(channel).collect()
}
