//! One water of a bake: read from its files, checked, and as textures on the GPU, bound as `wgsl/sea_bindings.wgsl` says.

use crate::bake::{Bake, Texels};
use crate::gpu::Gpu;
use crate::resources::{texture, texture_entry, uniform_entry};
use bytemuck::{Pod, Zeroable};
use tyndall::internals::files::manifest::Manifest;
use tyndall::internals::layout::shader::{TableConstants, four, rgb_rows};
use tyndall::internals::layout::sky;
use tyndall::internals::layout::water::lookup as water;
use tyndall::{Error, Result};

/// Tables of a water, in the order of their bindings; `{}` stands for its name.
const TABLES: [&str; 7] =
    ["{}", "{}_sky", "{}_seabed", "{}_seabed_sun", "{}_seabed_depth", "irradiance", "fresnel"];
/// Those with a third axis.
const VOLUMES: usize = 2;
/// Where [`TABLES`] has the two that all waters share.
const IRRADIANCE: usize = 5;
const FRESNEL: usize = 6;
/// Depth of water where none is asked for, m, if its tables go so deep.
pub const USUAL_DEPTH: f64 = 10.0;

/// `Water` of `water.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct WaterUniform {
    /// A `Table` of `shell.wgsl` each.
    tables: [[[f32; 4]; 10]; TABLES.len()],
    axes: [f32; 4],
    bed: [f32; 4],
    kappa: [f32; 4],
    rgb: [[f32; 4]; 3],
}

/// A water that is drawn where the planet's ground is.
pub struct Water {
    pub name: String,
    /// The same look-ups in double precision, for exposure.
    pub sky: water::WaterSky,
    uniform: WaterUniform,
    textures: Vec<Texels>,
}

impl Water {
    /// Reads a water of a bake.
    ///
    /// # Errors
    /// `Argument` where the bake has no such water, `File` for files that are missing, damaged or not what they say.
    pub fn open(bake: &Bake, name: &str) -> Result<Water> {
        let slice = bake.waters().position(|w| w == name).ok_or_else(|| absent(bake, name))?;
        // Of the layout, what this water needs: there may be sixteen, and tables for observers under water.
        let names = TABLES.map(|table| table.replace("{}", name));
        let needed = |t: &&tyndall::internals::files::manifest::Table| {
            t.layout == water::LAYOUT && names.contains(&t.name)
        };
        let tables = bake.manifest.tables.iter().filter(needed).cloned().collect();
        let manifest = Manifest { tables, ..bake.manifest.clone() };
        let pictures = sky::pictures(&bake.folder, &manifest, water::LAYOUT)?;
        let sky = water::WaterSky::new(&bake.folder, &manifest, name, &pictures)?;
        let missing = || Error::file(&bake.folder, format!("bake.json: {name}: a table is missing"));
        let mut found = Vec::new();
        for name in &names {
            let table = manifest.tables.iter().find(|t| t.name == *name).ok_or_else(missing)?;
            found.push((table, pictures.get(name).ok_or_else(missing)?));
        }
        let mut textures: Vec<Texels> =
            found.iter().map(|(t, atlas)| Texels::new(t, atlas).shaped(t)).collect();
        textures[FRESNEL] = textures[FRESNEL].slice(slice);
        let constant = |table: usize, axis: usize, name: &str| {
            let found = found[table].0.axes.get(axis).and_then(|a| a.constants.get(name));
            found.copied().ok_or_else(missing)
        };
        let axes = [
            constant(0, 0, "D_max")?,
            constant(0, 0, "p")?,
            constant(0, 1, "n")?,
            constant(IRRADIANCE, 0, "mu_min")?,
        ];
        let of = |what: &str| format!("water_{name}_{what}");
        let list = |what: &str| bake.manifest.constants.get(&of(what)).map_or([0.0; 4], |v| four(v));
        let illuminance = bake.constant("star_illuminance_lx").unwrap_or(1.0);
        let uniform = WaterUniform {
            tables: std::array::from_fn(|k| TableConstants::new(found[k].0, [1.0; 2]).rows()),
            axes: four(&axes),
            bed: list("seabed_albedo_at_four"),
            kappa: list("kappa_per_m"),
            rgb: rgb_rows(&manifest, &of("rgb_from_four"), illuminance),
        };
        Ok(Water { name: name.into(), sky, uniform, textures })
    }

    pub fn textures(&self) -> &[Texels] {
        &self.textures
    }
}

fn absent(bake: &Bake, name: &str) -> Error {
    let known: Vec<&str> = bake.waters().collect();
    Error::Argument(match known.len() {
        0 => format!("--water {name}: this bake has no waters (tyndall bake PRESET --waters {name})"),
        _ => format!("--water {name}: not in this bake, which has {}", known.join(", ")),
    })
}

/// A water on the GPU.
pub struct Sea {
    uniform: wgpu::Buffer,
    views: Vec<wgpu::TextureView>,
}

impl Sea {
    /// # Errors
    /// `Argument` for a table that is larger than this GPU's textures.
    pub fn new(gpu: &Gpu, water: &Water) -> Result<Sea> {
        use wgpu::TextureDimension::{D2, D3};
        let mut views = Vec::new();
        for (k, texels) in water.textures.iter().enumerate() {
            let dimension = if k < VOLUMES { D3 } else { D2 };
            views.push(texture(gpu, texels, dimension)?.create_view(&Default::default()));
        }
        let uniform = gpu.buffer(bytemuck::bytes_of(&water.uniform), wgpu::BufferUsages::UNIFORM);
        Ok(Sea { uniform, views })
    }

    /// Bindings 1 to 8 of a group.
    pub fn layout() -> Vec<wgpu::BindGroupLayoutEntry> {
        use wgpu::TextureViewDimension::{D2, D3};
        let textures =
            (0..TABLES.len()).map(|k| texture_entry(k as u32 + 2, if k < VOLUMES { D3 } else { D2 }));
        std::iter::once(uniform_entry(1)).chain(textures).collect()
    }

    pub fn entries(&self) -> Vec<wgpu::BindGroupEntry<'_>> {
        let uniform = wgpu::BindGroupEntry { binding: 1, resource: self.uniform.as_entire_binding() };
        let views = self.views.iter().enumerate().map(|(k, view)| wgpu::BindGroupEntry {
            binding: k as u32 + 2,
            resource: wgpu::BindingResource::TextureView(view),
        });
        std::iter::once(uniform).chain(views).collect()
    }
}
