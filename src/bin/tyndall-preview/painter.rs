//! Draws frames of one layout by one method.

use crate::bake::Bake;
use crate::frame::FrameUniform;
use crate::gpu::Gpu;
use crate::relief::Relief;
use crate::resources::{Baked, Method, look_ups, march_resources, overrides, uniform_entry, water_look_ups};
use crate::sea::Sea;
use crate::slicer::Slicer;
use crate::target::MEASURED;
use tyndall::Result;

/// What a painter draws and by what.
#[derive(Clone, Copy, Debug)]
pub struct Look {
    pub method: Method,
    pub hand_filtered: bool,
    /// Of the texture: `SHOWN`, `MEASURED`, or a window's.
    pub format: wgpu::TextureFormat,
    /// Terrain around the observer, in pictures of this size.
    pub relief: Option<[u32; 2]>,
}

pub struct Painter {
    baked: Baked,
    slicer: Option<Slicer>,
    march: Option<wgpu::BindGroup>,
    relief: Option<Relief>,
    /// By the tables themselves, by slices of them, and by slices where no ground is seen.
    pipelines: [wgpu::RenderPipeline; 3],
    uniform: wgpu::Buffer,
    /// The uniform, and the water where there is one.
    group: wgpu::BindGroup,
}

impl Painter {
    /// # Errors
    /// `Argument` or `File` for a bake that this GPU or this method cannot draw.
    pub fn new(gpu: &Gpu, bake: &Bake, look: &Look) -> Result<Painter> {
        let baked = Baked::new(gpu, bake)?;
        let sea = bake.water.as_ref().map(|water| Sea::new(gpu, water)).transpose()?;
        let entries: Vec<_> =
            [uniform_entry(0)].into_iter().chain(sea.iter().flat_map(|_| Sea::layout())).collect();
        let frame = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("frame"),
            entries: &entries,
        });
        let march = match look.method {
            Method::Table => None,
            Method::March { .. } => Some(march_resources(gpu, bake, look.method)?),
        };
        let relief = look.relief.map(|size| Relief::new(gpu, bake, &baked, &frame, size));
        let layouts = [
            Some(&baked.layout),
            Some(&frame),
            march.as_ref().map(|m| &m.layout),
            relief.as_ref().map(|r| &r.layout),
        ];
        let last = layouts.iter().rposition(Option::is_some).map_or(0, |k| k + 1);
        let pipelines = [[false, true], [true, true], [true, false]]
            .map(|parts| pipeline(gpu, bake, look, &layouts[..last], parts));
        let slicer = match look.method {
            Method::Table => Slicer::new(gpu, bake, &baked, look.hand_filtered),
            Method::March { .. } => None,
        };
        let usage = wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST;
        let uniform = gpu.buffer(&vec![0; size_of::<FrameUniform>()], usage);
        let entries: Vec<_> = [wgpu::BindGroupEntry { binding: 0, resource: uniform.as_entire_binding() }]
            .into_iter()
            .chain(sea.iter().flat_map(Sea::entries))
            .collect();
        let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &frame,
            entries: &entries,
        });
        Ok(Painter { baked, slicer, march: march.map(|m| m.group), relief, pipelines, uniform, group })
    }

    /// Records a frame into a texture.
    pub fn draw(
        &self,
        gpu: &Gpu,
        bake: &Bake,
        encoder: &mut wgpu::CommandEncoder,
        target: &wgpu::TextureView,
        frame: &FrameUniform,
    ) {
        gpu.queue.write_buffer(&self.uniform, 0, bytemuck::bytes_of(frame));
        let serves = Slicer::serves(bake, f64::from(frame.altitude()));
        let slicer = self.slicer.as_ref().filter(|_| serves);
        if let Some(slicer) = slicer {
            slicer.fill(gpu, encoder, &self.baked, frame.altitude(), frame.mu_s());
        }
        if let Some(relief) = &self.relief {
            relief.draw(encoder, &self.baked.bare, &self.group);
        }
        let ops =
            wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::BLACK), store: wgpu::StoreOp::Store };
        let colour =
            wgpu::RenderPassColorAttachment { view: target, depth_slice: None, resolve_target: None, ops };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(colour)],
            ..Default::default()
        });
        pass.set_bind_group(0, &self.baked.group, &[]);
        pass.set_bind_group(1, &self.group, &[]);
        if let Some(march) = &self.march {
            pass.set_bind_group(2, march, &[]);
        }
        if let Some(relief) = &self.relief {
            pass.set_bind_group(3, &relief.depths, &[]);
        }
        let [width, height] = frame.size();
        let sky = if slicer.is_some() && self.relief.is_none() { rows_apart(bake, frame) } else { 0 };
        let mut part = |pipeline: usize, top: u32, rows: u32| {
            if rows > 0 {
                pass.set_pipeline(&self.pipelines[pipeline]);
                pass.set_scissor_rect(0, top, width, rows);
                pass.draw(0..3, 0..1);
            }
        };
        part(2, 0, sky);
        part(usize::from(slicer.is_some()), sky, height - sky);
    }
}

/// Rows of sky that are drawn apart, by a pipeline without ground, for processors that draw in software go through all of
/// a shader's branches. Few are not worth a pipeline of their own.
fn rows_apart(bake: &Bake, frame: &FrameUniform) -> u32 {
    let rows = frame.rows_of_sky(bake.radii());
    if rows * frame.size()[0] < 1 << 16 { 0 } else { rows }
}

fn source(bake: &Bake, look: &Look) -> String {
    let look_ups = look_ups(bake, look.method) + include_str!("wgsl/frame.wgsl");
    let surface = match &bake.water {
        None => include_str!("wgsl/land.wgsl").to_string(),
        Some(_) => water_look_ups() + include_str!("wgsl/sea.wgsl"),
    };
    match look.relief {
        None => look_ups + &surface + include_str!("wgsl/bare.wgsl"),
        Some(_) => look_ups + &surface + include_str!("wgsl/relief.wgsl") + include_str!("wgsl/aerial.wgsl"),
    }
}

fn pipeline(
    gpu: &Gpu,
    bake: &Bake,
    look: &Look,
    layouts: &[Option<&wgpu::BindGroupLayout>],
    [sliced, ground]: [bool; 2],
) -> wgpu::RenderPipeline {
    let module = gpu.shader("frame", &source(bake, look));
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: layouts,
        immediate_size: 0,
    });
    let [filtering, slices] = overrides(look.hand_filtered, sliced);
    let constants = [filtering, slices, ("GROUND", f64::from(u8::from(ground)))];
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
