//! An atlas' sizes, channels and attributes as the header of an EXR file.

use crate::files::atlas::{Atlas, Attribute, Channel, Samples};
use crate::files::manifest::Origin;
use exr::math::RoundingMode;
use exr::meta::BlockDescription;
use exr::meta::attribute::{
    AttributeValue, ChannelDescription, LevelMode, LineOrder, SampleType, Text, TileDescription,
};
use exr::meta::header::{Header, LayerAttributes};
use exr::prelude::{Compression, Vec2};

/// The attributes that tell how slices lie in the picture, in the order of [`packing`].
pub(super) const PACKING: [&str; 5] = ["sliceWidth", "sliceHeight", "slices", "columns", "rows"];

/// The attribute of a picture that is upside down, and what it says.
pub(super) const ORIGIN: (&str, &str) = ("origin", "bottom-left");

fn packing(atlas: &Atlas) -> [usize; 5] {
    [atlas.width, atlas.height, atlas.slices, atlas.columns, atlas.rows()]
}

/// The header of the file that holds `atlas`, whose sizes have been checked to fit 30 bits.
pub(super) fn header(atlas: &Atlas) -> Header {
    let channels = atlas.sorted_channels().into_iter().map(description).collect();
    let tiles = TileDescription {
        tile_size: Vec2(atlas.width, atlas.height),
        level_mode: LevelMode::Singular,
        rounding_mode: RoundingMode::Down,
    };
    let custom = atlas.attributes.iter().map(|(name, value)| (text(name), encode(value)));
    // After the caller's, which cannot replace them.
    let packing = PACKING.into_iter().zip(packing(atlas));
    let packing = packing.map(|(name, n)| (text(name), AttributeValue::I32(n as i32)));
    let turned =
        (atlas.origin == Origin::BottomLeft).then(|| (text(ORIGIN.0), AttributeValue::Text(text(ORIGIN.1))));
    let other = custom.chain(packing).chain(turned).collect();
    let attributes = LayerAttributes { other, ..Default::default() };
    Header::new(text(""), (atlas.width * atlas.columns, atlas.height * atlas.rows()), channels)
        .with_encoding(Compression::ZIP16, BlockDescription::Tiles(tiles), LineOrder::Increasing)
        .with_attributes(attributes)
}

/// UTF-8, as OpenEXR has it; the crate's own conversion from `str` is to Latin-1.
fn text(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

fn description(channel: &Channel) -> ChannelDescription {
    let kind = match channel.samples {
        Samples::Half(_) => SampleType::F16,
        Samples::Float(_) => SampleType::F32,
    };
    ChannelDescription::new(text(&channel.name), kind, false)
}

fn encode(value: &Attribute) -> AttributeValue {
    match value {
        Attribute::Text(value) => AttributeValue::Text(text(value)),
        Attribute::Int(v) => AttributeValue::I32(*v),
        Attribute::Float(v) => AttributeValue::F32(*v),
    }
}

/// The attribute that `value` is; `None` for a type that atlases do not use, or text that is not UTF-8.
pub(super) fn decode(value: &AttributeValue) -> Option<Attribute> {
    match value {
        AttributeValue::Text(text) => decode_text(text).map(Attribute::Text),
        AttributeValue::I32(v) => Some(Attribute::Int(*v)),
        AttributeValue::F32(v) => Some(Attribute::Float(*v)),
        _ => None,
    }
}

/// `None` if it is not UTF-8.
pub(super) fn decode_text(text: &Text) -> Option<String> {
    String::from_utf8(text.as_slice().to_vec()).ok()
}
