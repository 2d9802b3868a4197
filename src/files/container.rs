//! Tables in the containers that engines and notebooks load besides EXR. The packing is that of the manifest in all
//! of them: a slice is a picture, slices follow each other, and a container with depth has a slice at each depth.

mod dds;
mod ktx2;
mod npy;

use super::atlas::{Atlas, Samples};
use crate::error::{Error, Result};
use half::f16;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum Container {
    /// OpenEXR, which every bake has.
    Exr,
    /// Khronos KTX 2: `VK_FORMAT_R16G16B16A16_SFLOAT`, 3D where the table has more than two axes.
    Ktx2,
    /// DirectDraw Surface with the DX10 header: `R16G16B16A16_FLOAT`, a volume where the table has more than two axes.
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
            Container::Ktx2 => ktx2::file(&Volume::of(atlas, shape)?, &atlas.name),
            Container::Dds => dds::file(&Volume::of(atlas, shape)?, &atlas.name),
            Container::Npy => npy::file(&halves(atlas)?, shape),
        }
    }

    /// Sizes as a reader of the file finds them.
    pub fn shape(self, atlas: &Atlas, shape: &[usize]) -> Vec<usize> {
        match self {
            Container::Exr => vec![atlas.width * atlas.columns, atlas.height * atlas.rows()],
            Container::Ktx2 | Container::Dds => sides(atlas, shape),
            Container::Npy => shape.iter().rev().copied().chain([atlas.channels.len()]).collect(),
        }
    }

    /// How the file holds the table, in a sentence.
    pub fn about(self) -> &'static str {
        match self {
            Container::Exr => "half RGBA picture, slices packed as the table's packing says",
            Container::Ktx2 => {
                "VK_FORMAT_R16G16B16A16_SFLOAT, width x height x depth; depth = slice; channels in order, missing ones 0; a single column, row or slice is written twice"
            }
            Container::Dds => {
                "DXGI_FORMAT_R16G16B16A16_FLOAT, width x height x depth; depth = slice; channels in order, missing ones 0; a single column, row or slice is written twice"
            }
            Container::Npy => "float16 in C order; the last axis of the table first, channels last",
        }
    }
}

/// Width and height of a table of one or two axes, and the number of slices of one of more: what shaders bind it as
/// follows from its axes. Readers go by sizes instead (Bevy takes a single row or column for 1D, a single slice for
/// 2D), so that those that decide are 2 at least. Look-ups meet the centre of the first of two equal ones alike.
fn sides(atlas: &Atlas, shape: &[usize]) -> Vec<usize> {
    match shape.len() {
        0..=2 => vec![atlas.width.max(2), atlas.height.max(2)],
        _ => vec![atlas.width, atlas.height, atlas.slices.max(2)],
    }
}

/// Texels of four halves, little-endian, x fastest, then y, then the slice.
struct Volume {
    width: u32,
    height: u32,
    /// Slices of a table of more than two axes.
    depth: Option<u32>,
    bytes: Vec<u8>,
}

impl Volume {
    /// The texels of a table; those of a single column, row or slice twice, see [`sides`].
    fn of(atlas: &Atlas, shape: &[usize]) -> Result<Self> {
        let channels = halves(atlas)?;
        let sides = sides(atlas, shape);
        if sides.len() == 2 && atlas.slices > 1 {
            let reason = format!("{} slices are no table of shape {shape:?}", atlas.slices);
            return Err(Error::Argument(format!("{}: {reason}", atlas.name)));
        }
        let depth = sides.get(2).copied();
        let mut bytes = Vec::with_capacity(sides.iter().product::<usize>() * 8);
        for slice in 0..depth.unwrap_or(1) {
            for row in 0..sides[1] {
                for column in 0..sides[0] {
                    let line = slice.min(atlas.slices - 1) * atlas.height + row.min(atlas.height - 1);
                    let texel = line * atlas.width + column.min(atlas.width - 1);
                    for k in 0..4 {
                        let half = channels.get(k).map_or(f16::ZERO, |c| c[texel]);
                        bytes.extend(half.to_le_bytes());
                    }
                }
            }
        }
        // Sizes of atlases fit 30 bits.
        let [width, height] = [0, 1].map(|k| sides[k] as u32);
        Ok(Volume { width, height, depth: depth.map(|n| n as u32), bytes })
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

    /// What a file says of its dimensions: of KTX2 width, height and depth; of DDS these and the resource's dimension.
    fn header(container: Container, file: &[u8]) -> [u32; 4] {
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap());
        match container {
            Container::Ktx2 => [word(20), word(24), word(28), if word(28) > 0 { 3 } else { 2 }],
            // D3D10_RESOURCE_DIMENSION_TEXTURE2D is 3, TEXTURE3D is 4.
            _ => [word(16), word(12), word(24), word(132) - 1],
        }
    }

    /// Engines that go by sizes find 2D where shaders bind 2D and 3D where they bind 3D: a table of one row, column or
    /// slice has two equal ones.
    #[test]
    fn a_single_row_column_or_slice_is_written_twice() {
        let row = Atlas::new("phobos", [3, 1, 1]).with("R", Samples::half([1.0, 2.0, 3.0]));
        let slice = Atlas::new("phobos", [3, 2, 1]).with("R", Samples::half((1..7).map(f64::from)));
        for container in [Container::Ktx2, Container::Dds] {
            let of = |atlas: &Atlas, shape: &[usize], expected: &[u32], sides: &[usize]| {
                let file = container.file(atlas, shape).unwrap();
                let found = header(container, &file);
                assert_eq!([&found[..expected.len() - 1], &found[3..]].concat(), expected, "{container:?}");
                assert_eq!(container.shape(atlas, shape), sides);
                let texels = &file[file.len() - 8 * sides.iter().product::<usize>()..];
                texels.to_vec()
            };
            for (atlas, shape) in [(&row, &[3][..]), (&row, &[3, 1])] {
                let texels = of(atlas, shape, &[3, 2, 2], &[3, 2]);
                assert_eq!(texels[..24], texels[24..]);
            }
            let column = Atlas { width: 1, height: 3, ..row.clone() };
            let texels = of(&column, &[1, 3], &[2, 3, 2], &[2, 3]);
            assert!(texels.chunks(16).all(|line| line[..8] == line[8..]));
            of(&slice, &[3, 2], &[3, 2, 2], &[3, 2]);
            let texels = of(&slice, &[3, 2, 1, 1], &[3, 2, 2, 3], &[3, 2, 2]);
            assert_eq!(texels[..48], texels[48..]);
            assert!(container.file(&table(), &[3, 2]).is_err(), "four slices are no plane");
        }
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
