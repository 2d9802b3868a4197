//! `tyndall reference --water`: light out of a water under a planet's air, by Monte Carlo from the eye to the sun.

use super::machine::with_threads;
use super::reference::Args;
use super::text::stream;
use crate::error::{Error, Result};
use crate::files::points::{Answer, write_answers};
use crate::geometry::Point;
use crate::layout::water::lookup::WaterView;
use crate::medium::Medium;
use crate::preset;
use crate::reference::Tracer;
use crate::reference::water::{Air, Look, WaterTracer};

/// Paths for each point and wavelength unless a number is given.
const PATHS: u64 = 1 << 18;

/// Answers all points: radiance that leaves the water where the view meets it, not weakened by the air between.
pub(super) fn run(args: &Args, name: &str, air: &Medium, points: &[Point]) -> Result<()> {
    let water = preset::load_water(name, &[])?;
    let depth = args.depth.unwrap_or(0.0);
    if !(depth > 0.0 && depth <= water.largest_depth) {
        let most = water.largest_depth;
        return Err(Error::Argument(format!("--depth {depth}: must be over 0 and at most {most} m")));
    }
    let media = water.medium(&args.wavelengths);
    let views =
        points.iter().map(|p| WaterView::meet(air.ground_radius, depth, p)).collect::<Result<Vec<_>>>()?;
    let paths = args.paths.unwrap_or(PATHS);
    let trace = |w: usize| -> Vec<(f64, f64)> {
        let (tracer, water) = (Tracer::new(air, w), WaterTracer::new(&media, w, depth));
        let one = |(v, azimuth): &(WaterView, f64)| {
            let look = Look { mu: v.mu, azimuth: (!args.azimuth_mean).then_some(*azimuth) };
            water.leaving_under(&Air::new(&tracer, v.mu_s), look, paths, args.seed).total
        };
        views.iter().map(one).collect()
    };
    let light: Vec<Vec<(f64, f64)>> =
        with_threads(args.threads, || (0..args.wavelengths.len()).map(trace).collect())?;
    let rows = points.iter().enumerate().flat_map(|(k, p)| {
        args.wavelengths.iter().zip(&light).map(move |(&wavelength_nm, light)| {
            let (radiance, stderr) = light[k];
            (*p, Answer { wavelength_nm, radiance, stderr: Some(stderr) })
        })
    });
    stream(|out| write_answers(out, rows))
}
