//! A window's surface on the GPU.

use crate::gpu::{Gpu, failed};
use std::sync::Arc;
use tyndall::Result;
use winit::window::Window;

pub struct Screen {
    surface: wgpu::Surface<'static>,
    config: wgpu::SurfaceConfiguration,
}

impl Screen {
    /// The GPU that can show on a window, and the window's surface.
    pub fn new(window: Arc<Window>) -> Result<(Gpu, Screen)> {
        let size = window.inner_size();
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(window).map_err(failed)?;
        let gpu = Gpu::new(instance, Some(&surface))?;
        let config = surface.get_default_config(&gpu.adapter, size.width.max(1), size.height.max(1));
        let mut config = config.ok_or_else(|| failed("the window cannot be drawn on by this GPU"))?;
        // The shader codes sRGB itself, so that it can dither what is shown.
        config.view_formats = vec![config.format.remove_srgb_suffix()];
        let mut screen = Screen { surface, config };
        screen.resize(&gpu, [size.width, size.height]);
        Ok((gpu, screen))
    }

    pub fn format(&self) -> wgpu::TextureFormat {
        self.config.format.remove_srgb_suffix()
    }

    /// Zero where the window has no area.
    pub fn size(&self) -> [u32; 2] {
        [self.config.width, self.config.height]
    }

    pub fn resize(&mut self, gpu: &Gpu, size: [u32; 2]) {
        [self.config.width, self.config.height] = size;
        if !size.contains(&0) {
            self.surface.configure(&gpu.device, &self.config);
        }
    }

    /// Draws and presents a frame, or none where the window is hidden or just changing.
    pub fn show(
        &self,
        gpu: &Gpu,
        draw: impl FnOnce(&mut wgpu::CommandEncoder, &wgpu::TextureView),
    ) -> Result<()> {
        use wgpu::CurrentSurfaceTexture::{
            Lost, Occluded, Outdated, Suboptimal, Success, Timeout, Validation,
        };
        let texture = match self.surface.get_current_texture() {
            Success(texture) | Suboptimal(texture) => texture,
            Timeout | Occluded => return Ok(()),
            Outdated | Lost => {
                self.surface.configure(&gpu.device, &self.config);
                return Ok(());
            }
            Validation => return gpu.check(),
        };
        let view = texture
            .texture
            .create_view(&wgpu::TextureViewDescriptor { format: Some(self.format()), ..Default::default() });
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        draw(&mut encoder, &view);
        gpu.queue.submit([encoder.finish()]);
        gpu.queue.present(texture);
        Ok(())
    }
}
