//! DDS with the DX10 header (Microsoft, "Programming Guide for DDS").

use super::Volume;
use crate::error::{Error, Result};
use ddsfile::{AlphaMode, Caps2, D3D10ResourceDimension, Dds, DxgiFormat, NewDxgiParams};

/// The bytes of the file; `name` is for messages.
pub(super) fn file(volume: &Volume, name: &str) -> Result<Vec<u8>> {
    let refuse = |e: ddsfile::Error| Error::Argument(format!("{name}: DDS: {e}"));
    let Volume { width, height, depth, .. } = *volume;
    let flat = depth.is_none();
    let parameters = NewDxgiParams {
        height,
        width,
        depth,
        format: DxgiFormat::R16G16B16A16_Float,
        mipmap_levels: None,
        array_layers: None,
        caps2: (!flat).then_some(Caps2::VOLUME),
        is_cubemap: false,
        resource_dimension: if flat {
            D3D10ResourceDimension::Texture2D
        } else {
            D3D10ResourceDimension::Texture3D
        },
        // The fourth channel is data as the others are.
        alpha_mode: AlphaMode::Custom,
    };
    let mut dds = Dds::new_dxgi(parameters).map_err(refuse)?;
    dds.data.clone_from(&volume.bytes);
    let mut out = Vec::new();
    dds.write(&mut out).map_err(refuse)?;
    Ok(out)
}
