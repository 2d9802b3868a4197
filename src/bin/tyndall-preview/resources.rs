//! The textures and uniforms of a baked layout on the GPU, bound as `wgsl/bindings.wgsl` says.

use crate::air::Air;
use crate::bake::{Bake, Layout, Texels};
use crate::gpu::Gpu;
use tyndall::internals::layout::shader::{COMPACT, ELEK2010, SHELL, SLICES, WATER};
use tyndall::{Error, Result};

const BINDINGS: &str = include_str!("wgsl/bindings.wgsl");
const SKY_COMPACT: &str = include_str!("wgsl/sky_compact.wgsl");
const SKY_MARCH: &str = include_str!("wgsl/sky_march.wgsl");
const SKY_ELEK2010: &str = include_str!("wgsl/sky_elek2010.wgsl");

/// How light is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// From the tables.
    Table,
    /// By the march of Nishita 1993 with these steps along the view and towards the sun, 0 steps towards the sun
    /// meaning a 2D table of optical depth.
    March { view: u32, sun: u32 },
}

/// The constants of a bake.
fn tables(bake: &Bake) -> String {
    bake.constants.groups_wgsl() + &bake.constants.wgsl()
}

/// The look-ups of a layout, the files that engines copy, and the preview's bindings of them.
pub fn look_ups(bake: &Bake, method: Method) -> String {
    let tables = tables(bake);
    let parts = match (bake.layout, method) {
        (_, Method::March { .. }) => vec![SHELL, BINDINGS, &tables, SKY_MARCH],
        (Layout::Compact, _) => vec![SHELL, SLICES, COMPACT, BINDINGS, &tables, SKY_COMPACT],
        (Layout::Elek2010, _) => vec![SHELL, SLICES, ELEK2010, BINDINGS, &tables, SKY_ELEK2010],
    };
    parts.join("\n")
}

/// The look-ups of a water; wants those of a layout.
pub fn water_look_ups() -> String {
    [WATER, include_str!("wgsl/sea_bindings.wgsl")].join("\n")
}

/// The pass that fills a frame's slices.
pub fn slicing(bake: &Bake) -> String {
    [SHELL, SLICES, BINDINGS, &tables(bake), include_str!("wgsl/slice.wgsl")].join("\n")
}

/// Constants that a pipeline of the look-ups takes.
pub fn overrides(hand_filtered: bool, sliced: bool) -> [(&'static str, f64); 2] {
    [("HAND_FILTERED", hand_filtered), ("SLICED", sliced)].map(|(name, on)| (name, f64::from(u8::from(on))))
}

/// Textures and uniforms on the GPU, bound.
pub struct Resources {
    pub layout: wgpu::BindGroupLayout,
    pub group: wgpu::BindGroup,
}

/// A baked layout on the GPU.
pub struct Baked {
    pub layout: wgpu::BindGroupLayout,
    /// With the slices, where there are any.
    pub group: wgpu::BindGroup,
    /// Without them, for the pass that fills them.
    pub bare: wgpu::BindGroup,
    /// None on GPUs that cannot filter them.
    pub slices: Option<wgpu::Texture>,
}

const STAGES: wgpu::ShaderStages = wgpu::ShaderStages::VERTEX_FRAGMENT.union(wgpu::ShaderStages::COMPUTE);

pub fn uniform_entry(binding: u32) -> wgpu::BindGroupLayoutEntry {
    let ty = wgpu::BufferBindingType::Uniform;
    let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
    wgpu::BindGroupLayoutEntry { binding, visibility: STAGES, ty, count: None }
}

pub fn texture_entry(binding: u32, view_dimension: wgpu::TextureViewDimension) -> wgpu::BindGroupLayoutEntry {
    let sample_type = wgpu::TextureSampleType::Float { filterable: true };
    let ty = wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false };
    wgpu::BindGroupLayoutEntry { binding, visibility: STAGES, ty, count: None }
}

fn entries() -> [wgpu::BindGroupLayoutEntry; 8] {
    use wgpu::TextureViewDimension::{D2, D2Array, D3};
    let sampler = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
    [
        wgpu::BindGroupLayoutEntry { binding: 1, visibility: STAGES, ty: sampler, count: None },
        texture_entry(2, D3),
        texture_entry(3, D3),
        texture_entry(4, D2),
        texture_entry(5, D2),
        texture_entry(6, D2),
        texture_entry(7, D2),
        texture_entry(8, D2Array),
    ]
}

impl Baked {
    /// # Errors
    /// `Argument` for a table that is larger than this GPU's textures.
    pub fn new(gpu: &Gpu, bake: &Bake) -> Result<Baked> {
        use wgpu::TextureDimension::{D2, D3};
        let volumes = [&bake.volume, &bake.single].map(|t| texture(gpu, t, D3));
        let planes =
            [&bake.depth, &bake.scatterers, &bake.irradiance, &bake.phase].map(|t| texture(gpu, t, D2));
        let mut views = Vec::new();
        for texture in volumes.into_iter().chain(planes) {
            views.push(texture?.create_view(&Default::default()));
        }
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("baked layout"),
            entries: &entries(),
        });
        let slices = slices(gpu, bake);
        let none = as_array(&texture(gpu, &Texels { size: [1, 1, 1], bits: vec![[0; 4]] }, D2)?);
        let with = slices.as_ref().map_or_else(|| none.clone(), as_array);
        let [group, bare] = [&with, &none].map(|last| bound(gpu, &layout, views.iter().chain([last])));
        Ok(Baked { layout, group, bare, slices })
    }
}

fn as_array(texture: &wgpu::Texture) -> wgpu::TextureView {
    let dimension = Some(wgpu::TextureViewDimension::D2Array);
    texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() })
}

/// Sampler, and the textures in the order of their bindings.
fn bound<'a>(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    views: impl Iterator<Item = &'a wgpu::TextureView>,
) -> wgpu::BindGroup {
    let sampler = gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    });
    let sampler = wgpu::BindingResource::Sampler(&sampler);
    let mut entries = vec![wgpu::BindGroupEntry { binding: 1, resource: sampler }];
    for (k, view) in views.enumerate() {
        let resource = wgpu::BindingResource::TextureView(view);
        entries.push(wgpu::BindGroupEntry { binding: k as u32 + 2, resource });
    }
    let label = Some("baked layout");
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label, layout, entries: &entries })
}

/// Room for a frame's slices: azimuth, view, and a layer for the main table and each group (at least one).
fn slices(gpu: &Gpu, bake: &Bake) -> Option<wgpu::Texture> {
    if !gpu.device.features().contains(wgpu::Features::FLOAT32_FILTERABLE) {
        return None;
    }
    let [volume, single] = [bake.constants.volume.size, bake.constants.single.size];
    Some(gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: Some("slices"),
        size: wgpu::Extent3d {
            width: volume[3].max(single[3]) as u32,
            height: volume[1].max(single[1]) as u32,
            depth_or_array_layers: 1 + (bake.constants.counts[0] as u32).max(1),
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::STORAGE_BINDING,
        view_formats: &[],
    }))
}

/// What a march needs besides the layout.
///
/// # Errors
/// `File` where the manifest does not state the air.
pub fn march_resources(gpu: &Gpu, bake: &Bake, method: Method) -> Result<Resources> {
    let air = Air::new(bake)?;
    let Method::March { view, sun } = method else { return Err(Error::Argument("not a march".into())) };
    let steps = [view as f32, sun as f32, air.groups as f32, 0.0];
    let steps = gpu.buffer(bytemuck::bytes_of(&steps), wgpu::BufferUsages::UNIFORM);
    let texels = Texels { size: air.size, bits: air.bits };
    let texture = texture(gpu, &texels, wgpu::TextureDimension::D2)?.create_view(&Default::default());
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("march"),
        entries: &[uniform_entry(0), texture_entry(1, wgpu::TextureViewDimension::D2)],
    });
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("march"),
        layout: &layout,
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: steps.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&texture) },
        ],
    });
    Ok(Resources { layout, group })
}

pub fn texture(gpu: &Gpu, texels: &Texels, dimension: wgpu::TextureDimension) -> Result<wgpu::Texture> {
    use wgpu::util::DeviceExt;
    let limits = gpu.device.limits();
    let most = match dimension {
        wgpu::TextureDimension::D3 => limits.max_texture_dimension_3d,
        _ => limits.max_texture_dimension_2d,
    };
    let [width, height, slices] = texels.size;
    if texels.size.iter().any(|&n| n > most as usize) {
        let size = format!("{width}x{height}x{slices}");
        return Err(Error::Argument(format!(
            "a table of {size} texels: this GPU takes {most} along an axis"
        )));
    }
    let descriptor = wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d {
            width: width as u32,
            height: height as u32,
            depth_or_array_layers: slices as u32,
        },
        mip_level_count: 1,
        sample_count: 1,
        dimension,
        format: wgpu::TextureFormat::Rgba16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let order = wgpu::util::TextureDataOrder::LayerMajor;
    let bytes = bytemuck::cast_slice(&texels.bits);
    Ok(gpu.device.create_texture_with_data(&gpu.queue, &descriptor, order, bytes))
}
