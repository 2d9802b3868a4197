//! Times of a frame by tables, by the march of Nishita 1993, and by that march with a 2D table.

use crate::bake::Bake;
use crate::frame::{FrameUniform, View};
use crate::gpu::Gpu;
use crate::headless::pixels;
use crate::held;
use crate::options::Options;
use crate::painter::{Look, Painter};
use crate::resources::Method;
use crate::stopwatch::{Stopwatch, Times};
use crate::target::{MEASURED, SHOWN, Target};
use tyndall::internals::machine::output::print;
use tyndall::{Error, Result};

/// Steps that are taken for converged, along the view and towards the sun. Their product stays below 65535, where
/// Mesa's software renderer ends loops.
const CONVERGED: [u32; 2] = [384, 128];
/// What a march with few steps may be off, over the light of the converged one, at 19 of 20 pixels.
const TOLERANCE: f64 = 0.01;
/// The picture that steps are judged by.
const SMALL: [u32; 2] = [96, 54];
/// Steps that are tried.
const STEPS: [u32; 22] =
    [2, 3, 4, 5, 6, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64, 80, 96, 128, 192, 256];

/// Prints the times of all methods that the layout has, or of the one that is asked for, their ratios, and the memory
/// that each takes on the GPU.
pub fn run(gpu: &Gpu, bake: &Bake, options: &Options) -> Result<()> {
    let view = options.view(bake)?;
    held::warn_of(bake, &view);
    let bench = Bench { gpu, bake, options, view, stopwatch: Stopwatch::new(gpu) };
    let [width, height] = bench.view.size;
    let (layout, frames, clock) = (bake.layout.name(), options.frames, bench.stopwatch.about());
    line(&format!("{}, {layout}, {width}x{height}, {frames} frames, {clock}", gpu.name()))?;
    line(&format!(
        "{:<22} {:>9} {:>9} {:>9} ms a frame {:>9} MB",
        "method", "min", "median", "max", "memory"
    ))?;
    if options.method.is_some() {
        bench.timed(options.method(bake)?)?;
        return bench.say_textures();
    }
    let table = bench.timed(Method::Table)?;
    if bake.constants.counts[0] < 0.5 {
        line("no march: it needs layout compact")?;
        return bench.say_textures();
    }
    let with_table = fewest_view_steps(gpu, bake, &bench.view, 0)?;
    let sun = fewest_sun_steps(gpu, bake, &bench.view)?;
    let plain = fewest_view_steps(gpu, bake, &bench.view, sun)?;
    let march = bench.timed(Method::March { view: plain, sun })?;
    let march_2d = bench.timed(Method::March { view: with_table, sun: 0 })?;
    let [t, m, d] = [table.median, march.median, march_2d.median];
    line(&format!("table : march : march with 2D table = 1 : {:.2} : {:.2}", m / t, d / t))?;
    line(&format!("march over march with 2D table: {:.1} (published: 10)", m / d))?;
    line(&format!("march over table: {:.1} (published, vertices: 4 to 5.3)", m / t))?;
    line("The table's frames hold all orders of scattering, the marches' the first.")?;
    bench.say_textures()
}

fn line(text: &str) -> Result<()> {
    print(&format!("{text}\n"))
}

/// What all methods are timed with.
struct Bench<'a> {
    gpu: &'a Gpu,
    bake: &'a Bake,
    options: &'a Options,
    view: View,
    stopwatch: Stopwatch,
}

impl Bench<'_> {
    /// Times of a method, which it prints.
    fn timed(&self, method: Method) -> Result<Times> {
        let Bench { gpu, bake, options, view, stopwatch } = self;
        let look = Look { method, ..options.look(bake, SHOWN)? };
        let painter = Painter::new(gpu, bake, &look)?;
        let target = Target::new(gpu, view.size, look.format)?;
        let frame = FrameUniform::new(bake, view);
        let draw = |encoder: &mut _| painter.draw(gpu, bake, encoder, &target.view, &frame);
        let times = stopwatch.times(gpu, options.frames, draw)?;
        let name = match method {
            Method::Table => "table".to_string(),
            Method::March { view, sun: 0 } => format!("march {view}, 2D table"),
            Method::March { view, sun } => format!("march {view}x{sun}"),
        };
        let Times { min, median, max } = times;
        line(&format!(
            "{name:<22} {min:>9.3} {median:>9.3} {max:>9.3}            {:>9}",
            megabytes(gpu.memory())
        ))?;
        Ok(times)
    }

    fn say_textures(&self) -> Result<()> {
        let bytes = megabytes(Some(self.bake.texture_bytes() as u64));
        line(&format!(
            "memory: all that the GPU holds, the picture with it; the bake's textures are {bytes} MB of it"
        ))?;
        Ok(())
    }
}

fn megabytes(bytes: Option<u64>) -> String {
    bytes.map_or_else(|| "unknown".into(), |n| format!("{:.1}", n as f64 * 1e-6))
}

/// Light of each pixel of a small picture.
fn light(gpu: &Gpu, bake: &Bake, view: &View, method: Method) -> Result<Vec<[f32; 4]>> {
    let look = Look { method, hand_filtered: false, format: MEASURED, relief: None };
    let small = View { size: SMALL, ..*view };
    Ok(bytemuck::pod_collect_to_vec(&pixels(gpu, bake, &small, &look)?))
}

/// The value below which `share` of them lie; 0 of none.
fn percentile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let last = values.len().saturating_sub(1) as f64;
    values.get((share * last) as usize).copied().unwrap_or(0.0)
}

/// The 95th percentile of the difference of lit pixels over the brightest channel of the converged one. Far less than
/// the median is no light: the night side of a planet, on which the last photons decide.
fn difference(a: &[[f32; 4]], converged: &[[f32; 4]]) -> f64 {
    let brightest = |p: &[f32; 4]| f64::from(p[0].max(p[1]).max(p[2]));
    let lit: Vec<f64> = converged.iter().map(brightest).filter(|v| *v > 0.0).collect();
    let least = 1e-3 * percentile(lit, 0.5);
    let pairs = a.iter().zip(converged).filter(|(_, c)| brightest(c) > least);
    let off = |a: &[f32; 4], c: &[f32; 4]| (0..3).map(|k| (a[k] - c[k]).abs()).fold(0.0, f32::max);
    percentile(pairs.map(|(a, c)| f64::from(off(a, c)) / brightest(c)).collect(), 0.95)
}

fn fewest(steps: &[u32], tolerance: f64, error: impl Fn(u32) -> Result<f64>) -> Result<u32> {
    for &n in steps {
        if error(n)? <= tolerance {
            return Ok(n);
        }
    }
    Err(Error::Check(format!("no march of {:?} steps comes within {tolerance}", steps.last())))
}

/// The fewest steps along the view, given those towards the sun, within the tolerance of the converged march.
fn fewest_view_steps(gpu: &Gpu, bake: &Bake, view: &View, sun: u32) -> Result<u32> {
    let finest = if sun == 0 { 0 } else { CONVERGED[1] };
    let converged = light(gpu, bake, view, Method::March { view: CONVERGED[0], sun: finest })?;
    fewest(&STEPS, TOLERANCE, |n| {
        Ok(difference(&light(gpu, bake, view, Method::March { view: n, sun })?, &converged))
    })
}

/// The fewest steps towards the sun that spend half of the tolerance.
fn fewest_sun_steps(gpu: &Gpu, bake: &Bake, view: &View) -> Result<u32> {
    let along = 64;
    let converged = light(gpu, bake, view, Method::March { view: along, sun: CONVERGED[1] })?;
    fewest(&STEPS, 0.5 * TOLERANCE, |n| {
        Ok(difference(&light(gpu, bake, view, Method::March { view: along, sun: n })?, &converged))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a hundred pixels one is far off, six by 3 %, the rest by 1 %: 95 of them are off by 3 % at most; a star's
    /// disc among them and black ones change nothing.
    #[test]
    fn the_worst_twentieth_is_left_out() {
        let sky = [1.0, 0.5, 0.25, 1.0];
        let mut converged = vec![sky; 100];
        let mut a = vec![[1.01, 0.5, 0.25, 1.0]; 100];
        a[..6].fill([1.03, 0.5, 0.25, 1.0]);
        a[6] = [9.0; 4];
        assert!((difference(&a, &converged) - 0.03).abs() < 1e-6);
        converged[7] = [1e6; 4];
        a[7] = [1e6; 4];
        converged.extend([[0.0; 4]; 50]);
        a.extend([[0.1; 4]; 50]);
        assert!((difference(&a, &converged) - 0.03).abs() < 1e-6);
    }
}
