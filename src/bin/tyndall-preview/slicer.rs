//! The slices of a frame: all that 4D tables hold for one altitude and one sun.

use crate::bake::Bake;
use crate::gpu::Gpu;
use crate::resources::{Baked, overrides, slicing, uniform_entry};

/// Fills the slices of a baked layout.
pub struct Slicer {
    pipeline: wgpu::ComputePipeline,
    here: wgpu::Buffer,
    group: wgpu::BindGroup,
    /// Workgroups along azimuth, view and layers.
    groups: [u32; 3],
}

fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
    let ty = wgpu::BindingType::StorageTexture {
        access: wgpu::StorageTextureAccess::WriteOnly,
        format: wgpu::TextureFormat::Rgba32Float,
        view_dimension: wgpu::TextureViewDimension::D2Array,
    };
    let visibility = wgpu::ShaderStages::COMPUTE;
    let filled = wgpu::BindGroupLayoutEntry { binding: 1, visibility, ty, count: None };
    let entries = &[uniform_entry(0), filled];
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("slices"), entries })
}

impl Slicer {
    /// None on GPUs that cannot filter slices, and where texels are weighed by hand.
    pub fn new(gpu: &Gpu, bake: &Bake, baked: &Baked, hand_filtered: bool) -> Option<Slicer> {
        let texture = baked.slices.as_ref().filter(|_| !hand_filtered)?;
        let layout = layout(gpu);
        let layouts = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&baked.layout), Some(&layout)],
            immediate_size: 0,
        });
        let constants = overrides(false, false);
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("slices"),
            layout: Some(&layouts),
            module: &gpu.shader("slices", &slicing(bake)),
            entry_point: Some("slice"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                ..Default::default()
            },
            cache: None,
        });
        let here = gpu.buffer(&[0; 16], wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        let dimension = Some(wgpu::TextureViewDimension::D2Array);
        let view = texture.create_view(&wgpu::TextureViewDescriptor { dimension, ..Default::default() });
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("slices"),
            layout: &layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: here.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: wgpu::BindingResource::TextureView(&view) },
            ],
        });
        let size = texture.size();
        let groups = [size.width.div_ceil(8), size.height.div_ceil(8), size.depth_or_array_layers];
        Some(Slicer { pipeline, here, group, groups })
    }

    /// Whether an observer is where slices hold: inside the shell.
    pub fn serves(bake: &Bake, altitude: f64) -> bool {
        let [ground, top] = bake.radii();
        altitude <= top - ground
    }

    /// Records the pass that fills the slices for an altitude and a cosine of the sun's zenith angle.
    pub fn fill(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        baked: &Baked,
        altitude: f32,
        mu_s: f32,
    ) {
        gpu.queue.write_buffer(&self.here, 0, bytemuck::bytes_of(&[altitude, mu_s, 0.0, 0.0]));
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &baked.bare, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        let [x, y, z] = self.groups;
        pass.dispatch_workgroups(x, y, z);
    }
}
