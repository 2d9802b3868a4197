//! The GPU: found, or one line that says what is missing; shaders and readback.

use std::io;
use std::sync::{Arc, Mutex};
use tyndall::{Error, Result};

/// A device to draw with.
pub struct Gpu {
    pub adapter: wgpu::Adapter,
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    /// The first failure that no call reported: a device lost, out of memory.
    failure: Arc<Mutex<Option<String>>>,
}

const NO_ADAPTER: &str = "no GPU was found: install a Vulkan driver (software that needs no GPU: Debian and Ubuntu \
                          mesa-vulkan-drivers with libvulkan1, Fedora mesa-vulkan-drivers, Arch vulkan-swrast)";

/// The machine's fault, in one line.
pub fn failed(what: impl ToString) -> Error {
    Error::machine("GPU", io::Error::other(line(what)))
}

/// A reason in one line, without the place in another's source text that winit puts before it.
pub fn line(what: impl ToString) -> String {
    let line = what.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    let Some((before, rest)) = line.split_once("os error at ") else { return line };
    match rest.split_once(": ") {
        Some((_, reason)) => format!("{before}{reason}"),
        None => line,
    }
}

impl Gpu {
    /// A device of the adapter that `surface` can be shown by, the fastest where there are several.
    ///
    /// # Errors
    /// `Machine` where there is none or it cannot be opened.
    pub fn new(instance: wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Gpu> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            ..Default::default()
        };
        let adapter =
            pollster::block_on(instance.request_adapter(&options)).map_err(|_| failed(NO_ADAPTER))?;
        let wanted = wgpu::Features::TIMESTAMP_QUERY
            | wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS
            | wgpu::Features::FLOAT32_FILTERABLE;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: adapter.features() & wanted,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor)).map_err(failed)?;
        let failure = Arc::new(Mutex::new(None));
        let kept: Arc<Mutex<Option<String>>> = failure.clone();
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| {
            if let Ok(mut slot) = kept.lock() {
                slot.get_or_insert(error.to_string());
            }
        }));
        // A loss explains whatever failed before it was told.
        let kept = failure.clone();
        device.set_device_lost_callback(move |_, text| {
            if let Ok(mut slot) = kept.lock() {
                *slot = Some(format!("the device was lost {text}"));
            }
        });
        Ok(Gpu { adapter, device, queue, failure })
    }

    /// Without a window.
    pub fn headless() -> Result<Gpu> {
        Gpu::new(wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle()), None)
    }

    /// Card, driver and interface in a few words.
    pub fn name(&self) -> String {
        let info = self.adapter.get_info();
        format!("{} ({:?}, {} {})", info.name, info.backend, info.driver, info.driver_info)
    }

    /// # Errors
    /// `Machine` with what went wrong since the device was opened.
    pub fn check(&self) -> Result<()> {
        // What was lost is told in a poll; a poll that fails is told by what was lost.
        let _ = self.device.poll(wgpu::PollType::Poll);
        match self.failure.lock() {
            Ok(slot) => slot.as_ref().map_or(Ok(()), |what| Err(failed(what))),
            Err(_) => Err(failed("a callback panicked")),
        }
    }

    /// Waits until all that was submitted is done.
    pub fn wait(&self) -> Result<()> {
        self.device.poll(wgpu::PollType::wait_indefinitely()).map_err(failed)?;
        self.check()
    }

    /// Bytes that textures and buffers take on the device, where the driver's interface lets them be counted.
    pub fn memory(&self) -> Option<u64> {
        self.device.generate_allocator_report().map(|report| report.total_allocated_bytes)
    }

    pub fn shader(&self, label: &str, source: &str) -> wgpu::ShaderModule {
        self.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(label),
            source: wgpu::ShaderSource::Wgsl(source.into()),
        })
    }

    /// A buffer of these bytes, a multiple of four of them.
    pub fn buffer(&self, bytes: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
        let (size, usage) = (bytes.len() as u64, usage | wgpu::BufferUsages::COPY_DST);
        let descriptor = wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false };
        let buffer = self.device.create_buffer(&descriptor);
        // Not create_buffer_init, which panics where the device is lost.
        self.queue.write_buffer(&buffer, 0, bytes);
        buffer
    }

    /// A buffer that a copy can be made into and read back from.
    pub fn readable(&self, size: u64) -> wgpu::Buffer {
        let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ;
        let mapped_at_creation = false;
        self.device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation })
    }

    /// The bytes of a buffer of [`Gpu::readable`], once all that was submitted is done.
    pub fn read(&self, buffer: &wgpu::Buffer) -> Result<Vec<u8>> {
        buffer.map_async(wgpu::MapMode::Read, .., |_| {});
        self.wait()?;
        let bytes = buffer.get_mapped_range(..).map_err(failed)?.to_vec();
        buffer.unmap();
        Ok(bytes)
    }
}
