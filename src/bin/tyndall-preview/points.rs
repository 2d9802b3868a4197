//! What the shaders answer to views given as CSV, in the form of `tyndall sample`.

use crate::bake::Bake;
use crate::gpu::Gpu;
use crate::held;
use crate::resources::{Baked, Method, look_ups, overrides, water_look_ups};
use crate::sea::Sea;
use std::io::Write;
use std::path::Path;
use tyndall::Result;
use tyndall::internals::files::points::{Answer, read_points, write_answers};
use tyndall::internals::geometry::Point;
use tyndall::internals::layout::sky::Channels;
use tyndall::internals::layout::water::lookup::WaterView;
use tyndall::internals::machine::output::stream;

/// Reads views, asks the GPU, writes the answers.
///
/// # Errors
/// `File` for views that cannot be read, `Argument` for one that never meets the water that is asked for.
pub fn run(gpu: &Gpu, bake: &Bake, points: &Path, hand_filtered: bool, depth: f64) -> Result<()> {
    let points = read_points(points)?;
    if bake.water.is_some() {
        points.iter().try_for_each(|p| WaterView::meet(bake.radii()[0], depth, p).map(|_| ()))?;
    }
    if bake.water.is_none()
        && let Some(text) = held::beyond_points(bake, &points)
    {
        held::warn(&text);
    }
    let answers = answers(gpu, bake, &points, hand_filtered, depth)?;
    let channels = match &bake.water {
        Some(water) => Channels::Wavelengths(water.sky.wavelengths_nm.clone()),
        None => bake.sky.channels(),
    };
    match channels {
        Channels::Wavelengths(nm) => {
            let rows = points.iter().zip(&answers).flat_map(|(p, v)| {
                nm.iter().zip(v).map(move |(&wavelength_nm, &v)| {
                    (*p, Answer { wavelength_nm, radiance: f64::from(v), stderr: None })
                })
            });
            stream(|out| write_answers(out, rows))
        }
        Channels::Rgb => stream(|out| colours(out, &points, &answers)),
    }
}

fn colours(out: &mut dyn Write, points: &[Point], answers: &[[f32; 4]]) -> std::io::Result<()> {
    writeln!(out, "altitude_m,mu_view,mu_sun,azimuth_deg,red_per_sr,green_per_sr,blue_per_sr")?;
    for (p, [r, g, b, _]) in points.iter().zip(answers) {
        writeln!(out, "{},{},{},{},{r:.8e},{g:.8e},{b:.8e}", p.altitude, p.mu, p.mu_s, p.azimuth_deg)?;
    }
    Ok(())
}

/// Four channels for each view.
fn answers(
    gpu: &Gpu,
    bake: &Bake,
    points: &[Point],
    hand_filtered: bool,
    depth: f64,
) -> Result<Vec<[f32; 4]>> {
    if points.is_empty() {
        return Ok(Vec::new());
    }
    let baked = Baked::new(gpu, bake)?;
    let sea = bake.water.as_ref().map(|water| Sea::new(gpu, water)).transpose()?;
    let asked = match sea {
        None => include_str!("wgsl/points_sky.wgsl").to_string(),
        Some(_) => water_look_ups() + include_str!("wgsl/points_sea.wgsl"),
    };
    let source = look_ups(bake, Method::Table) + include_str!("wgsl/points.wgsl") + &asked;
    let sea = sea.map(|sea| bound(gpu, &sea));
    let water = sea.as_ref().map(|(layout, _)| (layout, depth));
    let pipeline = pipeline(gpu, &baked, water, &source, hand_filtered);
    let views: Vec<[f32; 4]> = points.iter().map(in_single_precision).collect();
    let storage = wgpu::BufferUsages::STORAGE;
    let views = gpu.buffer(bytemuck::cast_slice(&views), storage);
    let results = gpu.buffer(&vec![0; views.size() as usize], storage | wgpu::BufferUsages::COPY_SRC);
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(2),
        entries: &[
            wgpu::BindGroupEntry { binding: 0, resource: views.as_entire_binding() },
            wgpu::BindGroupEntry { binding: 1, resource: results.as_entire_binding() },
        ],
    });
    let readable = gpu.readable(results.size());
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &baked.bare, &[]);
        if let Some((_, water)) = &sea {
            pass.set_bind_group(1, water, &[]);
        }
        pass.set_bind_group(2, &group, &[]);
        pass.dispatch_workgroups((points.len() as u32).div_ceil(64), 1, 1);
    }
    encoder.copy_buffer_to_buffer(&results, 0, &readable, 0, results.size());
    gpu.queue.submit([encoder.finish()]);
    Ok(bytemuck::pod_collect_to_vec(&gpu.read(&readable)?))
}

/// A water's group and its layout.
fn bound(gpu: &Gpu, sea: &Sea) -> (wgpu::BindGroupLayout, wgpu::BindGroup) {
    let label = Some("water");
    let entries = &Sea::layout();
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label, entries });
    let entries = &sea.entries();
    let descriptor = wgpu::BindGroupDescriptor { label, layout: &layout, entries };
    let group = gpu.device.create_bind_group(&descriptor);
    (layout, group)
}

/// Altitude, mu, mu_s and nu, the last of the rounded ones.
fn in_single_precision(p: &Point) -> [f32; 4] {
    let rounded = |v: f64| f64::from(v as f32);
    let nu = Point { mu: rounded(p.mu), mu_s: rounded(p.mu_s), ..*p }.nu();
    [p.altitude, p.mu, p.mu_s, nu].map(|v| v as f32)
}

/// `water`: the layout of its group, and its depth.
fn pipeline(
    gpu: &Gpu,
    baked: &Baked,
    water: Option<(&wgpu::BindGroupLayout, f64)>,
    source: &str,
    hand_filtered: bool,
) -> wgpu::ComputePipeline {
    let storage = |binding, read_only| {
        let ty = wgpu::BufferBindingType::Storage { read_only };
        let ty = wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None };
        wgpu::BindGroupLayoutEntry { binding, visibility: wgpu::ShaderStages::COMPUTE, ty, count: None }
    };
    let views = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("views"),
        entries: &[storage(0, true), storage(1, false)],
    });
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(&baked.layout), water.map(|(layout, _)| layout), Some(&views)],
        immediate_size: 0,
    });
    let mut constants = overrides(hand_filtered, false).to_vec();
    constants.extend(water.map(|(_, depth)| ("DEPTH", depth)));
    gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some("points"),
        layout: Some(&layout),
        module: &gpu.shader("points", source),
        entry_point: Some("answer_views"),
        compilation_options: wgpu::PipelineCompilationOptions { constants: &constants, ..Default::default() },
        cache: None,
    })
}
