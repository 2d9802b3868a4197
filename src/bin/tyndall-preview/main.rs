//! `tyndall-preview`: shows a bake from its files alone, in a window or as a picture.
//!
//! Of the library it uses what reads and checks files, and nothing that computes light.

mod air;
mod bake;
mod bench;
mod camera;
mod controls;
mod exposure;
mod frame;
mod gpu;
mod headless;
mod held;
mod options;
mod painter;
mod points;
mod relief;
mod resources;
mod screen;
mod sea;
mod slicer;
mod stopwatch;
mod target;
mod window;

use bake::Bake;
use clap::Parser;
use gpu::Gpu;
use options::Options;
use tyndall::Error;
use tyndall::internals::machine::output;

fn main() -> std::process::ExitCode {
    hush();
    let result = match Options::try_parse() {
        Ok(options) => run(&options).and_then(|()| output::heard()),
        Err(error) => output::refused(&error),
    };
    match result {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            output::say(&format!("error: {error}"));
            error.exit_code().into()
        }
    }
}

/// Mesa's layer that chooses among GPUs asks for a Wayland display and says on stderr where there can be none: then it
/// is left out.
fn hush() {
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: no other thread runs yet that could read the environment.
        unsafe { std::env::set_var("NODEVICE_SELECT", "1") };
    }
}

fn run(options: &Options) -> tyndall::Result<()> {
    let bake = Bake::open(&options.bake, options.layout)?.with_water(options.water.as_deref())?;
    if !(options.headless || options.bench || options.points.is_some()) {
        return window::run(options, bake);
    }
    let gpu = Gpu::headless()?;
    if options.lose_device {
        gpu.device.destroy();
    }
    if let Some(csv) = &options.points {
        let depth = options.depth(&bake)?;
        return points::run(&gpu, &bake, csv, options.hand_filtered, depth);
    }
    if options.bench {
        return bench::run(&gpu, &bake, options);
    }
    match &options.out {
        Some(out) => headless::run(&gpu, &bake, options, out),
        None => Err(Error::Argument("--headless: wants --out PNG".into())),
    }
}
