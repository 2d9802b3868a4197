//! One layout of a bake, read from its files and checked, in the form that textures take.

use crate::sea::Water;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tyndall::internals::files::manifest::{Manifest, Table};
use tyndall::internals::files::{Atlas, Samples};
use tyndall::internals::layout::shader;
use tyndall::internals::layout::sky::{self, Sky};
use tyndall::{Error, Result};

/// The layouts that there are shaders for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Layout {
    Compact,
    Elek2010,
}

impl Layout {
    pub fn name(self) -> &'static str {
        match self {
            Layout::Compact => "compact",
            Layout::Elek2010 => "elek2010",
        }
    }

    pub fn other(self) -> Layout {
        match self {
            Layout::Compact => Layout::Elek2010,
            Layout::Elek2010 => Layout::Compact,
        }
    }
}

/// Half-float RGBA texels, x fastest, as bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    pub size: [usize; 3],
    pub bits: Vec<[u16; 4]>,
}

impl Texels {
    /// What stands where a layout has no such texture: one texel of zeros.
    fn none() -> Self {
        Texels { size: [1, 1, 1], bits: vec![[0; 4]] }
    }

    pub fn new(table: &Table, atlas: &Atlas) -> Texels {
        let mut bits = vec![[0u16; 4]; atlas.slice_len() * atlas.slices];
        for (k, info) in table.channels.iter().enumerate().take(4) {
            let Some(channel) = atlas.channel(&info.name) else { continue };
            for (n, texel) in bits.iter_mut().enumerate() {
                texel[k] = match &channel.samples {
                    Samples::Half(v) => v[n].to_bits(),
                    Samples::Float(v) => half::f16::from_f32(v[n]).to_bits(),
                };
            }
        }
        Texels { size: [atlas.width, atlas.height, atlas.slices], bits }
    }

    /// The same texels as many along each axis as a table of up to three says.
    pub fn shaped(mut self, table: &Table) -> Texels {
        self.size = [0, 1, 2].map(|axis| table.shape.get(axis).copied().unwrap_or(1));
        self
    }

    /// One slice.
    pub fn slice(&self, z: usize) -> Texels {
        let [width, height, _] = self.size;
        let bits = self.bits.iter().skip(z * width * height).take(width * height).copied().collect();
        Texels { size: [width, height, 1], bits }
    }
}

/// A layout ready to become textures.
pub struct Bake {
    pub folder: PathBuf,
    pub manifest: Manifest,
    pub layout: Layout,
    pub constants: shader::Constants,
    pub volume: Texels,
    pub single: Texels,
    pub depth: Texels,
    pub scatterers: Texels,
    pub irradiance: Texels,
    pub phase: Texels,
    /// The same look-ups in double precision, for exposure.
    pub sky: Box<dyn Sky>,
    /// What is drawn where the ground is; none: land.
    pub water: Option<Water>,
}

impl Bake {
    /// Reads one layout, `compact` where none is named and the bake has it.
    ///
    /// # Errors
    /// `File` or `Argument` for files that are missing, damaged, newer than this tool or not what they say.
    pub fn open(folder: &Path, layout: Option<Layout>) -> Result<Bake> {
        let manifest = Manifest::read(folder)?;
        let has = |layout: Layout| manifest.tables.iter().any(|t| t.layout == layout.name());
        let layout = match layout {
            Some(layout) if has(layout) => layout,
            Some(layout) => {
                return Err(Error::Argument(format!("--layout {}: not in this bake", layout.name())));
            }
            None if has(Layout::Compact) => Layout::Compact,
            None if has(Layout::Elek2010) => Layout::Elek2010,
            None => return Err(Error::file(folder, "no layout in this bake that the preview can draw")),
        };
        let pictures = sky::pictures(folder, &manifest, layout.name())?;
        let sky = sky::of_pictures(folder, &manifest, layout.name(), &pictures)?;
        Reader { folder, manifest: &manifest, layout, pictures: &pictures }.bake(sky)
    }

    /// Names of the waters that were baked with the planet.
    pub fn waters(&self) -> impl Iterator<Item = &str> {
        self.manifest.waters.iter().map(|w| w.name.as_str())
    }

    /// The same with the water of a name, or with land.
    ///
    /// # Errors
    /// Those of [`Water::open`].
    pub fn with_water(mut self, name: Option<&str>) -> Result<Bake> {
        self.water = name.map(|name| Water::open(&self, name)).transpose()?;
        Ok(self)
    }

    /// Bytes of texels that the textures take.
    pub fn texture_bytes(&self) -> usize {
        let all = [&self.volume, &self.single, &self.depth, &self.scatterers, &self.irradiance, &self.phase];
        let water = self.water.iter().flat_map(Water::textures);
        all.into_iter().chain(water).map(|t| 8 * t.bits.len()).sum()
    }

    /// Radius of the ground and of the top, m.
    pub fn radii(&self) -> [f64; 2] {
        ["ground_radius_m", "top_radius_m"].map(|name| self.constant(name).unwrap_or(1.0))
    }

    /// The first of a list of the manifest's constants.
    pub fn constant(&self, name: &str) -> Option<f64> {
        self.manifest.constants.get(name)?.first().copied()
    }
}

/// The parts of a layout that has been found sound.
struct Reader<'a> {
    folder: &'a Path,
    manifest: &'a Manifest,
    layout: Layout,
    pictures: &'a BTreeMap<String, Atlas>,
}

impl Reader<'_> {
    fn bake(&self, sky: Box<dyn Sky>) -> Result<Bake> {
        let constants = shader::Constants::new(self.manifest, self.layout.name());
        let constants = constants.map_err(|reason| Error::file(self.folder, reason))?;
        Ok(Bake {
            folder: self.folder.to_path_buf(),
            manifest: self.manifest.clone(),
            layout: self.layout,
            constants,
            volume: self.texels(shader::main(self.layout.name())),
            single: self.stacked(),
            depth: self.texels("transmittance"),
            scatterers: self.texels("scatterers"),
            irradiance: self.texels("irradiance"),
            phase: self.texels("phase"),
            sky,
            water: None,
        })
    }

    fn table(&self, name: &str) -> Option<(&Table, &Atlas)> {
        let table = self.manifest.tables.iter().find(|t| t.layout == self.layout.name() && t.name == name)?;
        Some((table, self.pictures.get(name)?))
    }

    fn texels(&self, name: &str) -> Texels {
        self.table(name).map_or_else(Texels::none, |(table, atlas)| Texels::new(table, atlas))
    }

    /// The tables of single scattering one behind the other, in the order of the rows of the phase table: all are of one
    /// shape, or there would be no constants.
    fn stacked(&self) -> Texels {
        let singles = shader::singles(self.manifest, self.layout.name());
        let mut all = singles.iter().map(|table| self.texels(&table.name));
        let Some(mut stack) = all.next() else { return Texels::none() };
        for texels in all {
            stack.size[2] += texels.size[2];
            stack.bits.extend(texels.bits);
        }
        stack
    }
}
