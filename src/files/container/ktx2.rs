//! KTX 2.0 (Khronos KTX File Format Specification, version 2.0, section 3): header, index of one level, data format
//! descriptor, key/value data, texels.

use super::Volume;
use crate::error::{Error, Result};
use ktx2::dfd::{Basic, Block};
use ktx2::{Format, Header, Index, LevelIndex};

/// Texels begin at a multiple of their size (section 3.9.4).
const ALIGNMENT: usize = 8;

/// The bytes of the file; `name` is for messages.
pub(super) fn file(volume: &Volume, name: &str) -> Result<Vec<u8>> {
    let format = Format::R16G16B16A16_SFLOAT;
    let refuse = |e: ktx2::dfd::BuildError| Error::Argument(format!("{name}: KTX2: {e:?}"));
    let (mut basic, type_size) = Basic::from_format(format).map_err(refuse)?;
    // Numbers, not colours: a reader is to leave them as they are.
    basic.color_primaries = None;
    let block = Block::Basic(basic).to_vec();
    let descriptor = [&(4 + block.len() as u32).to_le_bytes()[..], &block].concat();
    let pairs = writer();
    let at_descriptor = Header::LENGTH + LevelIndex::LENGTH;
    let at_pairs = at_descriptor + descriptor.len();
    let at_texels = (at_pairs + pairs.len()).next_multiple_of(ALIGNMENT);
    let header = Header {
        format: Some(format),
        type_size,
        pixel_width: volume.width,
        pixel_height: volume.height,
        pixel_depth: volume.depth.unwrap_or(0),
        layer_count: 0,
        face_count: 1,
        level_count: 1,
        supercompression_scheme: None,
        index: Index {
            dfd_byte_offset: at_descriptor as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: at_pairs as u32,
            kvd_byte_length: pairs.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let length = volume.bytes.len() as u64;
    let level =
        LevelIndex { byte_offset: at_texels as u64, byte_length: length, uncompressed_byte_length: length };
    let mut out = Vec::with_capacity(at_texels + volume.bytes.len());
    out.extend(header.as_bytes());
    out.extend(level.as_bytes());
    out.extend(descriptor);
    out.extend(pairs);
    out.resize(at_texels, 0);
    out.extend(&volume.bytes);
    Ok(out)
}

/// The one entry of the key/value data: who wrote the file (section 5.2), padded to four bytes.
fn writer() -> Vec<u8> {
    let pair = concat!("KTXwriter\0tyndall ", env!("CARGO_PKG_VERSION"), "\0").as_bytes();
    let mut out = (pair.len() as u32).to_le_bytes().to_vec();
    out.extend(pair);
    out.resize(out.len().next_multiple_of(4), 0);
    out
}
