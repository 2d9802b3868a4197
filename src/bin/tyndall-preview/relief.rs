//! Terrain: a height field drawn into a depth buffer, from which the frame finds positions again.

use crate::bake::Bake;
use crate::gpu::Gpu;
use crate::resources::{Baked, Method, look_ups, overrides};

/// Vertices along a side, as in `relief_mesh.wgsl`.
const SIDE: u32 = 384;

pub struct Relief {
    pub layout: wgpu::BindGroupLayout,
    /// The depth buffer, to be read.
    pub depths: wgpu::BindGroup,
    view: wgpu::TextureView,
    pipeline: wgpu::RenderPipeline,
    triangles: wgpu::Buffer,
}

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;

/// Two triangles for each cell of the grid.
fn triangles() -> Vec<u32> {
    let cells = (0..SIDE - 1).flat_map(|y| (0..SIDE - 1).map(move |x| y * SIDE + x));
    cells.flat_map(|k| [k, k + 1, k + SIDE, k + 1, k + SIDE + 1, k + SIDE]).collect()
}

impl Relief {
    pub fn new(
        gpu: &Gpu,
        bake: &Bake,
        baked: &Baked,
        frame: &wgpu::BindGroupLayout,
        size: [u32; 2],
    ) -> Relief {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("depth"),
            size: wgpu::Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: FORMAT,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        let ty = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let visibility = wgpu::ShaderStages::FRAGMENT;
        let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("depth"),
            entries: &[wgpu::BindGroupLayoutEntry { binding: 0, visibility, ty, count: None }],
        });
        let resource = wgpu::BindingResource::TextureView(&view);
        let depths = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("depth"),
            layout: &layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
        });
        let pipeline = pipeline(gpu, bake, [&baked.layout, frame]);
        let triangles = gpu.buffer(bytemuck::cast_slice(&triangles()), wgpu::BufferUsages::INDEX);
        Relief { layout, depths, view, pipeline, triangles }
    }

    /// Records the depth of the terrain; `baked` and `frame` are its groups 0 and 1.
    pub fn draw(&self, encoder: &mut wgpu::CommandEncoder, baked: &wgpu::BindGroup, frame: &wgpu::BindGroup) {
        // 0 is infinitely far.
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store };
        let depth = wgpu::RenderPassDepthStencilAttachment {
            view: &self.view,
            depth_ops: Some(ops),
            stencil_ops: None,
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(depth),
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, baked, &[]);
        pass.set_bind_group(1, frame, &[]);
        pass.set_index_buffer(self.triangles.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..6 * (SIDE - 1) * (SIDE - 1), 0, 0..1);
    }
}

fn pipeline(gpu: &Gpu, bake: &Bake, groups: [&wgpu::BindGroupLayout; 2]) -> wgpu::RenderPipeline {
    let frame =
        [include_str!("wgsl/frame.wgsl"), include_str!("wgsl/land.wgsl"), include_str!("wgsl/bare.wgsl")]
            .concat();
    let relief = [include_str!("wgsl/relief.wgsl"), include_str!("wgsl/relief_mesh.wgsl")].concat();
    let module = gpu.shader("relief", &(look_ups(bake, Method::Table) + &frame + &relief));
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups.map(Some),
        immediate_size: 0,
    });
    let constants = overrides(false, false);
    let options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("relief"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("raise"),
            compilation_options: options(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: FORMAT,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::Greater),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some("nothing"),
            compilation_options: options(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}
