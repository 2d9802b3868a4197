//! A picture without a window.

use crate::bake::Bake;
use crate::exposure;
use crate::frame::{FrameUniform, View};
use crate::gpu::Gpu;
use crate::held;
use crate::options::Options;
use crate::painter::{Look, Painter};
use crate::target::{SHOWN, Target};
use std::io::BufWriter;
use std::path::Path;
use tyndall::internals::machine::output::print;
use tyndall::{Error, Result};

/// Draws the frame of the options and writes it as PNG.
pub fn run(gpu: &Gpu, bake: &Bake, options: &Options, out: &Path) -> Result<()> {
    let view = options.view(bake)?;
    held::warn_of(bake, &view);
    let look = options.look(bake, SHOWN)?;
    write_rgba(out, view.size, &pixels(gpu, bake, &view, &look)?)?;
    let [width, height] = view.size;
    let (layout, ev) = (bake.layout.name(), exposure::ev100(view.exposure));
    print(&format!("{}: {width}x{height}, {layout}, EV100 {ev:.2}, on {}\n", out.display(), gpu.name()))
}

/// The texels' bytes of a frame.
pub fn pixels(gpu: &Gpu, bake: &Bake, view: &View, look: &Look) -> Result<Vec<u8>> {
    let target = Target::new(gpu, view.size, look.format)?;
    let painter = Painter::new(gpu, bake, look)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    painter.draw(gpu, bake, &mut encoder, &target.view, &FrameUniform::new(bake, view));
    gpu.queue.submit([encoder.finish()]);
    target.read(gpu)
}

/// Writes a picture of bytes RGBA as PNG without its last channel.
pub fn write_rgba(path: &Path, [width, height]: [u32; 2], rgba: &[u8]) -> Result<()> {
    let rgb: Vec<u8> = rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]).collect();
    let text = |e: png::EncodingError| match e {
        png::EncodingError::IoError(e) => Error::machine(path, e),
        other => Error::machine(path, std::io::Error::other(other.to_string())),
    };
    let file = std::fs::File::create(path).map_err(|e| Error::machine(path, e))?;
    let mut encoder = png::Encoder::new(BufWriter::new(file), width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header().map_err(text)?;
    writer.write_image_data(&rgb).map_err(text)?;
    writer.finish().map_err(text)
}
