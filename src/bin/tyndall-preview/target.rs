//! A picture that can be drawn into and read back.

use crate::gpu::Gpu;
use tyndall::{Error, Result};

pub struct Target {
    pub texture: wgpu::Texture,
    pub view: wgpu::TextureView,
    size: [u32; 2],
}

/// What a display shows, 8 bits a channel.
pub const SHOWN: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;
/// Light, in single precision.
pub const MEASURED: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

impl Target {
    /// # Errors
    /// `Argument` for a size of zero or beyond what this GPU can draw.
    pub fn new(gpu: &Gpu, size: [u32; 2], format: wgpu::TextureFormat) -> Result<Target> {
        let most = gpu.device.limits().max_texture_dimension_2d;
        let [width, height] = size;
        if size.iter().any(|n| !(1..=most).contains(n)) {
            let reason = format!("this GPU draws pictures of 1 to {most} pixels a side");
            return Err(Error::Argument(format!("--size {width}x{height}: {reason}")));
        }
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some("picture"),
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format,
            usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
            view_formats: &[],
        });
        let view = texture.create_view(&Default::default());
        Ok(Target { texture, view, size })
    }

    /// The texels' bytes, row by row from the upper left.
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<u8>> {
        let [width, height] = self.size;
        let texel = self.texture.format().block_copy_size(None).unwrap_or(4);
        let stride = (texel * width).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = gpu.readable(u64::from(stride) * u64::from(height));
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let layout =
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(stride), rows_per_image: None };
        let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(self.texture.as_image_copy(), destination, self.texture.size());
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.read(&buffer)?;
        let row = |y: u32| &bytes[(y * stride) as usize..][..(texel * width) as usize];
        Ok((0..height).flat_map(row).copied().collect())
    }
}
