//! How long a frame takes, all its passes: by the GPU's own clock where it has one, else from submission to the end of the wait.

use crate::gpu::Gpu;
use std::time::Instant;
use tyndall::Result;

/// Of many frames, ms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    pub min: f64,
    pub median: f64,
    pub max: f64,
}

impl Times {
    /// None of nothing.
    fn of(mut ms: Vec<f64>) -> Times {
        ms.sort_by(f64::total_cmp);
        let at = |k: usize| ms.get(k).copied().unwrap_or(0.0);
        Times { min: at(0), median: at(ms.len() / 2), max: at(ms.len().saturating_sub(1)) }
    }
}

/// Two time stamps and where they are read.
struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    readable: wgpu::Buffer,
}

pub struct Stopwatch {
    clock: Option<Clock>,
}

impl Stopwatch {
    pub fn new(gpu: &Gpu) -> Self {
        let stamps = wgpu::Features::TIMESTAMP_QUERY | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS;
        let has = gpu.device.features().contains(stamps);
        let clock = has.then(|| Clock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: None,
                ty: wgpu::QueryType::Timestamp,
                count: 2,
            }),
            resolved: gpu.buffer(&[0; 16], wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC),
            readable: gpu.readable(16),
        });
        Stopwatch { clock }
    }

    pub fn about(&self) -> &'static str {
        if self.clock.is_some() { "times by the GPU's clock" } else { "times from submission to completion" }
    }

    /// Times of what `draw` records, after three frames that warm up.
    pub fn times(&self, gpu: &Gpu, frames: u32, draw: impl Fn(&mut wgpu::CommandEncoder)) -> Result<Times> {
        let mut ms = Vec::new();
        for k in 0..frames + 3 {
            let once = self.once(gpu, &draw)?;
            if k >= 3 {
                ms.push(once);
            }
        }
        Ok(Times::of(ms))
    }

    fn once(&self, gpu: &Gpu, draw: &impl Fn(&mut wgpu::CommandEncoder)) -> Result<f64> {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let start = Instant::now();
        let Some(clock) = &self.clock else {
            draw(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
            gpu.wait()?;
            return Ok(1e3 * start.elapsed().as_secs_f64());
        };
        encoder.write_timestamp(&clock.queries, 0);
        draw(&mut encoder);
        encoder.write_timestamp(&clock.queries, 1);
        encoder.resolve_query_set(&clock.queries, 0..2, &clock.resolved, 0);
        encoder.copy_buffer_to_buffer(&clock.resolved, 0, &clock.readable, 0, 16);
        gpu.queue.submit([encoder.finish()]);
        let ticks: Vec<u64> = bytemuck::pod_collect_to_vec(&gpu.read(&clock.readable)?);
        Ok(1e-6 * f64::from(gpu.queue.get_timestamp_period()) * ticks[1].saturating_sub(ticks[0]) as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of three times in any order the middle one is the median.
    #[test]
    fn times_are_sorted() {
        assert_eq!(Times::of(vec![3.0, 1.0, 2.0]), Times { min: 1.0, median: 2.0, max: 3.0 });
    }
}
