//! Tables in the containers that engines and notebooks load besides EXR. The packing is that of the manifest in all
//! of them: a slice is a picture, slices follow each other, and a container with depth has a slice at each depth.

mod dds;
mod ktx2;
mod npy;

use super::atlas::{Atlas, Samples};
use crate::error::{Error, Result};
use half::f16;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Container {
    /// OpenEXR, which every bake has.
    Exr,
    /// Khronos KTX 2: `VK_FORMAT_R16G16B16A16_SFLOAT`, 3D where there are several slices.
    Ktx2,
    /// DirectDraw Surface with the DX10 header: `R16G16B16A16_FLOAT`, a volume where there are several slices.
    Dds,
    /// NumPy array of float16.
    Npy,
}

impl Container {
    /// Name on the command line, and extension of its files.
    pub fn name(self) -> &'static str {
        match self {
            Container::Exr => "exr",
            Container::Ktx2 => "ktx2",
            Container::Dds => "dds",
            Container::Npy => "npy",
        }
    }

    /// The file of a table whose axes have the sizes `shape`, fastest first; what is in an EXR file, bit for bit.
    ///
    /// # Errors
    /// `Argument` for a table that is no table of halves with one to four channels, or too large for the container.
    pub fn file(self, atlas: &Atlas, shape: &[usize]) -> Result<Vec<u8>> {
        match self {
            Container::Exr => super::exr::to_exr_bytes(atlas),
            Container::Ktx2 => ktx2::file(&Volume::of(atlas)?, &atlas.name),
            Container::Dds => dds::file(&Volume::of(atlas)?, &atlas.name),
            Container::Npy => npy::file(&halves(atlas)?, shape),
        }
    }

    /// Sizes as a reader of the file finds them.
    pub fn shape(self, atlas: &Atlas, shape: &[usize]) -> Vec<usize> {
        match self {
            Container::Exr => vec![atlas.width * atlas.columns, atlas.height * atlas.rows()],
            Container::Ktx2 | Container::Dds if atlas.slices > 1 => {
                vec![atlas.width, atlas.height, atlas.slices]
            }
            Container::Ktx2 | Container::Dds => vec![atlas.width, atlas.height],
            Container::Npy => shape.iter().rev().copied().chain([atlas.channels.len()]).collect(),
        }
    }

    /// How the file holds the table, in a sentence.
    pub fn about(self) -> &'static str {
        match self {
            Container::Exr => "half RGBA picture, slices packed as the table's packing says",
            Container::Ktx2 => {
                "VK_FORMAT_R16G16B16A16_SFLOAT, width x height x depth; depth = slice; channels in order, missing ones 0"
            }
            Container::Dds => {
                "DXGI_FORMAT_R16G16B16A16_FLOAT, width x height x depth; depth = slice; channels in order, missing ones 0"
            }
            Container::Npy => "float16 in C order; the last axis of the table first, channels last",
        }
    }
}

/// Texels of four halves, little-endian, x fastest, then y, then the slice.
struct Volume {
    /// Width, height, slices.
    size: [u32; 3],
    bytes: Vec<u8>,
}

impl Volume {
    fn of(atlas: &Atlas) -> Result<Self> {
        let channels = halves(atlas)?;
        let texels = atlas.slice_len() * atlas.slices;
        let mut bytes = Vec::with_capacity(texels * 8);
        for texel in 0..texels {
            for k in 0..4 {
                let half = channels.get(k).map_or(f16::ZERO, |c| c[texel]);
                bytes.extend(half.to_le_bytes());
            }
        }
        // Sizes of atlases fit 30 bits.
        let size = [atlas.width, atlas.height, atlas.slices].map(|n| n as u32);
        Ok(Volume { size, bytes })
    }

    fn depth(&self) -> Option<u32> {
        Some(self.size[2]).filter(|&slices| slices > 1)
    }
}

/// Samples of the channels, in their order.
fn halves(atlas: &Atlas) -> Result<Vec<&[f16]>> {
    atlas.check()?;
    let half = |c: &'_ super::atlas::Channel| match &c.samples {
        Samples::Half(values) => Some(values.len()),
        Samples::Float(_) => None,
    };
    if atlas.channels.len() > 4 || atlas.channels.iter().any(|c| half(c).is_none()) {
        let reason = "a table of up to four channels of halves is needed for this container";
        return Err(Error::Argument(format!("{}: {reason}", atlas.name)));
    }
    let values = atlas.channels.iter().filter_map(|c| match &c.samples {
        Samples::Half(values) => Some(values.as_slice()),
        Samples::Float(_) => None,
    });
    Ok(values.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 3 × 2 × 4 texels of two channels.
    fn table() -> Atlas {
        let values = |scale: f64| Samples::half((0..24).map(move |k| f64::from(k) * scale));
        Atlas::new("phobos", [3, 2, 4]).with("R", values(0.5)).with("G", values(-1.0))
    }

    /// Texel 23 is the last of the last slice in all of them; what is missing is 0; nothing follows.
    #[test]
    fn the_last_texel_is_the_last() {
        let half = |v: f32| f16::from_f32(v).to_le_bytes();
        for container in [Container::Ktx2, Container::Dds] {
            let file = container.file(&table(), &[3, 2, 4]).unwrap();
            let expected = [half(11.5), half(-23.0), half(0.0), half(0.0)].concat();
            assert_eq!(file[file.len() - 8..], expected, "{container:?}");
        }
        let file = Container::Npy.file(&table(), &[3, 2, 2, 2]).unwrap();
        assert_eq!(file[file.len() - 4..], [half(11.5), half(-23.0)].concat());
        assert_eq!((file.len() - 24 * 4) % 64, 0);
        assert_eq!(Container::Npy.shape(&table(), &[3, 2, 2, 2]), [2, 2, 2, 3, 2]);
        assert_eq!(Container::Dds.shape(&table(), &[3, 2, 2, 2]), [3, 2, 4]);
    }

    /// Five channels, or floats, have no place in four halves.
    #[test]
    fn what_does_not_fit_is_refused() {
        let float = Atlas::new("phobos", [1, 1, 1]).with("R", Samples::float([1.0]));
        let five = "RGBAB".char_indices().fold(Atlas::new("phobos", [1, 1, 1]), |atlas, (k, _)| {
            atlas.with(k.to_string(), Samples::half([1.0]))
        });
        for container in [Container::Ktx2, Container::Dds, Container::Npy] {
            assert!(container.file(&float, &[1]).is_err() && container.file(&five, &[1]).is_err());
        }
    }
}
