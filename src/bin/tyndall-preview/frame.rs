//! One frame: uniforms, pipeline, drawing into a texture.

use crate::bake::Bake;
use crate::camera::{Camera, Kind};
use crate::exposure::display_matrix;
use crate::gpu::Gpu;
use crate::resources::{Method, Resources, look_ups, march_resources, overrides, uniform_entry};
use crate::target::MEASURED;
use bytemuck::{Pod, Zeroable};
use glam::{DMat3, DVec3};
use tyndall::Result;

/// From light to what the display shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ToneMapping {
    /// 1 − exp(−x) (O'Neil 2005), the paper's
    Paper,
    /// Khronos PBR neutral
    Neutral,
}

/// All that a frame depends on besides the bake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    pub camera: Camera,
    pub size: [u32; 2],
    /// What 1 cd/m² becomes.
    pub exposure: f64,
    pub tone_mapping: ToneMapping,
    /// Of the aerosol's phase function in `elek2010`; none: that of the table.
    pub g: Option<f64>,
}

/// `Frame` of `frame.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct FrameUniform {
    right: [f32; 4],
    up: [f32; 4],
    forward: [f32; 4],
    sun: [f32; 4],
    observer: [f32; 4],
    picture: [f32; 4],
    display: [[f32; 4]; 3],
}

fn with(v: DVec3, w: f64) -> [f32; 4] {
    [v.x, v.y, v.z, w].map(|x| x as f32)
}

impl FrameUniform {
    pub fn new(bake: &Bake, view: &View) -> Self {
        let camera = &view.camera;
        let [right, up, forward] = camera.axes();
        let [width, height] = view.size;
        let fisheye = f64::from(u8::from(camera.kind == Kind::Fisheye));
        let star = &bake.manifest.preset.resolved["star"];
        let radius = bake.constant("star_angular_radius_rad").unwrap_or(0.0);
        let limb = star["limb_darkening"].as_f64().unwrap_or(0.6);
        let tone = f64::from(u8::from(view.tone_mapping == ToneMapping::Neutral));
        let display: DMat3 = display_matrix(bake);
        FrameUniform {
            right: with(right, fisheye),
            up: with(up, libm::tan(0.5 * camera.field.to_radians())),
            forward: with(forward, view.g.unwrap_or(-2.0)),
            sun: with(camera.sun(), radius),
            observer: [camera.altitude, view.exposure, tone, limb].map(|v| v as f32),
            picture: [width.into(), height.into(), camera.pixel_angle(width, height), 0.0].map(|v: f64| v as f32),
            display: [0, 1, 2].map(|k| with(display.row(k), 0.0)),
        }
    }
}

/// What a painter draws and by what.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    pub method: Method,
    pub hand_filtered: bool,
    /// Of the texture: `SHOWN`, `MEASURED`, or a window's.
    pub format: wgpu::TextureFormat,
}

/// Draws frames of one layout into textures of one format.
pub struct Painter {
    resources: Resources,
    march: Option<wgpu::BindGroup>,
    pipeline: wgpu::RenderPipeline,
    uniform: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl Painter {
    /// # Errors
    /// `Argument` or `File` for a bake that this GPU or this method cannot draw.
    pub fn new(gpu: &Gpu, bake: &Bake, look: &Look) -> Result<Painter> {
        let resources = Resources::new(gpu, bake)?;
        let frame = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
            entries: &[uniform_entry(0)],
        });
        let march = match look.method {
            Method::Table => None,
            Method::March { .. } => Some(march_resources(gpu, bake, look.method)?),
        };
        let mut layouts = vec![&resources.layout, &frame];
        layouts.extend(march.as_ref().map(|m| &m.layout));
        let pipeline = pipeline(gpu, bake, look, &layouts);
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer(&vec![0; size_of::<FrameUniform>()], usage);
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &frame,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }],
        });
        Ok(Painter { resources, march: march.map(|m| m.group), pipeline, uniform, group })
    }

    /// Records a frame into a texture.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        frame: &FrameUniform,
        timestamps: Option<wgpu::RenderPassTimestampWrites<'_>>,
    ) {
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(frame));
        let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
        let colour =
            wgpu::RenderPassColorAttachment { view: target, depth_slice: None, resolve_target: None, ops };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(colour)],
            timestamp_writes: timestamps,
            ..Default::default()
        });
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.resources.group, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        if let Some(march) = &self.march {
            pass.set_bind_group(2, march, &[]);
        }
        pass.draw(0..3, 0..1);
    }
}

fn pipeline(
    gpu: &Gpu,
    bake: &Bake,
    look: &Look,
    layouts: &[&wgpu::BindGroupLayout],
) -> wgpu::RenderPipeline {
    let source = look_ups(bake.layout, look.method) + include_str!("wgsl/frame.wgsl");
    let module = gpu.shader("frame", &source);
    let layouts: Vec<_> = layouts.iter().copied().map(Some).collect();
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &layouts,
        immediate_size: 0,
    });
    let constants = overrides(look.hand_filtered);
    let options = || wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() };
    let entry = if look.format == MEASURED { "measure" } else { "draw" };
    gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("frame"),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some("corner"),
            compilation_options: options(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry),
            compilation_options: options(),
            targets: &[Some(look.format.into())],
        }),
        multiview_mask: None,
        cache: None,
    })
}
