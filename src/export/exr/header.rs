//! The attributes of an EXR header, as bytes and back. Strings end in 0, numbers are little-endian.

use crate::export::atlas::{Atlas, Attribute};
use std::collections::BTreeMap;

/// Sample types of a channel list.
pub const HALF: i32 = 1;
pub const FLOAT: i32 = 2;
/// The compression written; for tiles the same as ZIPS (2).
pub const ZIP: u8 = 3;

/// Name, type and value of every attribute of `atlas`, ordered by name: those that EXR requires, the packing
/// of the slices, then the caller's (which cannot replace one of the others).
pub fn attributes(atlas: &Atlas) -> BTreeMap<String, (&'static str, Vec<u8>)> {
    let mut all: BTreeMap<String, (&'static str, Vec<u8>)> =
        atlas.attributes.iter().map(|(name, value)| (name.clone(), encode(value))).collect();
    let columns = [atlas.width * atlas.columns, atlas.height * atlas.rows()];
    let window: Vec<u8> = [0, 0, columns[0] - 1, columns[1] - 1].iter().flat_map(|&v| int(v)).collect();
    // One level only: mode 0; the tile is a slice.
    let tiles = [int(atlas.width).to_vec(), int(atlas.height).to_vec(), vec![0]].concat();
    let required = [
        ("channels", "chlist", channel_list(atlas)),
        ("compression", "compression", vec![ZIP]),
        ("dataWindow", "box2i", window.clone()),
        ("displayWindow", "box2i", window),
        ("lineOrder", "lineOrder", vec![0]),
        ("pixelAspectRatio", "float", 1f32.to_le_bytes().to_vec()),
        ("screenWindowCenter", "v2f", vec![0; 8]),
        ("screenWindowWidth", "float", 1f32.to_le_bytes().to_vec()),
        ("tiles", "tiledesc", tiles),
    ];
    let packing = PACKING.into_iter().zip(packing(atlas)).map(|(name, n)| (name, "int", int(n).to_vec()));
    for (name, kind, value) in required.into_iter().chain(packing) {
        all.insert(name.to_string(), (kind, value));
    }
    all
}

/// The attributes that tell how slices lie in the picture, in the order of [`packing`].
pub const PACKING: [&str; 5] = ["sliceWidth", "sliceHeight", "slices", "columns", "rows"];

fn packing(atlas: &Atlas) -> [usize; 5] {
    [atlas.width, atlas.height, atlas.slices, atlas.columns, atlas.rows()]
}

fn int(value: usize) -> [u8; 4] {
    (value as i32).to_le_bytes()
}

fn encode(value: &Attribute) -> (&'static str, Vec<u8>) {
    match value {
        Attribute::Text(text) => ("string", text.as_bytes().to_vec()),
        Attribute::Int(v) => ("int", v.to_le_bytes().to_vec()),
        Attribute::Float(v) => ("float", v.to_le_bytes().to_vec()),
    }
}

/// The attribute that `bytes` of type `kind` hold; `None` for a type that atlases do not use, or damage.
pub fn decode(kind: &str, bytes: &[u8]) -> Option<Attribute> {
    match kind {
        "string" => String::from_utf8(bytes.to_vec()).ok().map(Attribute::Text),
        "int" => Some(Attribute::Int(i32::from_le_bytes(bytes.try_into().ok()?))),
        "float" => Some(Attribute::Float(f32::from_le_bytes(bytes.try_into().ok()?))),
        _ => None,
    }
}

fn channel_list(atlas: &Atlas) -> Vec<u8> {
    let mut list = Vec::new();
    for channel in atlas.sorted_channels() {
        list.extend_from_slice(channel.name.as_bytes());
        list.push(0);
        list.extend_from_slice(&if channel.samples.bytes() == 2 { HALF } else { FLOAT }.to_le_bytes());
        // "Perceptually linear" off, three unused bytes; every pixel is sampled, across and down.
        list.extend_from_slice(&[0; 4]);
        list.extend_from_slice(&[1, 0, 0, 0, 1, 0, 0, 0]);
    }
    list.push(0);
    list
}
