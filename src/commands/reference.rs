//! `tyndall reference`: the Monte Carlo path tracer on the command line, radiances as CSV with standard errors.

use super::machine::{in_range, with_threads};
use super::text::{say, stream, watched};
use crate::error::{Error, Result};
use crate::files::points::{Answer, read_points, write_answers};
use crate::geometry::Point;
use crate::machine::memory;
use crate::medium::Medium;
use crate::reference::{Estimate, ORDERS, Settings, Tracer};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::Write;
use std::path::PathBuf;

/// Radiance at points of view by Monte Carlo path tracing, with standard errors
#[derive(clap::Args, Debug)]
#[command(
    before_help = "Example: tyndall reference earth --points views.csv --wavelengths 440,550,680 --stderr 0.1%"
)]
pub struct Args {
    /// A preset by name or path
    preset: String,
    /// CSV with the columns altitude_m,mu_view,mu_sun,azimuth_deg
    #[arg(long, value_name = "CSV")]
    points: PathBuf,
    /// Wavelengths in nm, comma-separated
    #[arg(long, value_delimiter = ',', default_value = "440,550,680", value_name = "LIST")]
    pub(super) wavelengths: Vec<f64>,
    /// Paths at most for each point and wavelength [default: 1048576, or 268435456 with --stderr]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) paths: Option<u64>,
    /// Stop where the standard error is below this part of the radiance
    #[arg(long, value_name = "PERCENT", value_parser = ratio)]
    stderr: Option<f64>,
    /// Count only light of 1 to N events (scatterings and ground bounces)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    orders: Option<u64>,
    /// Seed of the random numbers: the same seed gives the same bytes
    #[arg(long, default_value_t = 0)]
    pub(super) seed: u64,
    /// Add a column with the radiances of orders 1, 2, … (1/sr), separated by semicolons
    #[arg(long)]
    per_order: bool,
    /// Replace a value of the preset, path.to.key=value; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Threads [default: all]; the answer does not depend on them
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,
    /// The light out of a water under this planet's air (a name, or a path), seen from above it, not the air's
    #[arg(long, value_name = "WATER", requires = "depth", conflicts_with_all = ["orders", "stderr", "per_order"])]
    water: Option<String>,
    /// With --water: depth of the water, m
    #[arg(long, value_name = "M", requires = "water")]
    pub(super) depth: Option<f64>,
    /// With --water: the mean over azimuth, which tables of water hold
    #[arg(long, requires = "water")]
    pub(super) azimuth_mean: bool,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
}

/// A share as `0.1%` or `0.001`.
fn ratio(text: &str) -> Result<f64> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(n) => (n, 0.01),
        None => (text, 1.0),
    };
    match number.trim().parse::<f64>() {
        Ok(v) if v.is_finite() && v > 0.0 => Ok(v * unit),
        _ => Err("expected a positive share such as 0.1% or 0.001".into()),
    }
}

/// Traces all points at all wavelengths and writes the answers to stdout.
pub fn run(args: &Args) -> Result<()> {
    let points = read_points(&args.points)?;
    in_range(&args.wavelengths).map_err(|reason| Error::Argument(format!("--wavelengths: {reason}")))?;
    let medium = medium(args)?;
    if let Some(name) = &args.water {
        return super::reference_water::run(args, name, &medium, &points);
    }
    fits(args, points.len())?;
    let estimates = with_threads(args.threads, || trace(args, &medium, &points))?;
    complain(args, &estimates);
    stream(|out| write(out, args, &medium, &points, &estimates))
}

/// Whether the answers fit into memory, each with its orders.
fn fits(args: &Args, points: usize) -> Result<()> {
    let answers = points * args.wavelengths.len();
    memory::check((answers * (size_of::<Estimate>() + ORDERS * size_of::<(f64, f64)>())) as u64)
        .map_err(|reason| Error::file(&args.points, format!("the answer {reason}: split it")))
}

fn medium(args: &Args) -> Result<Medium> {
    let medium = crate::preset::load(&args.preset, &args.set)?.medium(&args.wavelengths);
    medium.check().map_err(|reason| Error::Argument(format!("{}: {reason}", args.preset)))?;
    Ok(medium)
}

/// Estimates by wavelength, then point.
fn trace(args: &Args, medium: &Medium, points: &[Point]) -> Vec<Vec<Estimate>> {
    let default = if args.stderr.is_some() { 1 << 28 } else { 1 << 20 };
    let settings = Settings {
        paths: args.paths.unwrap_or(default),
        stderr: args.stderr,
        orders: args.orders.map(|n| n as usize),
        seed: args.seed,
        ..Settings::default()
    };
    let bar = progress(args, (points.len() * args.wavelengths.len()) as u64);
    let mut all = Vec::new();
    for (w, nm) in args.wavelengths.iter().enumerate() {
        bar.set_message(format!("{nm} nm"));
        let tracer = Tracer::new(medium, w);
        let one = |p: &Point| {
            let estimate = tracer.estimate(p, &settings);
            bar.inc(1);
            estimate
        };
        all.push(points.iter().map(one).collect());
        if !args.quiet && !watched() {
            say(&format!("{nm} nm: {} points", points.len()));
        }
    }
    bar.finish_and_clear();
    all
}

fn progress(args: &Args, steps: u64) -> ProgressBar {
    if args.quiet || !watched() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} {eta}");
    ProgressBar::new(steps).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Says on stderr where the wanted standard error was not reached.
fn complain(args: &Args, estimates: &[Vec<Estimate>]) {
    let Some(target) = args.stderr else { return };
    let missed = estimates.iter().flatten().filter(|e| e.stderr > target * e.radiance.abs()).count();
    if missed > 0 {
        let percent = 100.0 * target;
        say(&format!("{missed} values did not reach a standard error of {percent}% within --paths"));
    }
}

fn write(
    out: &mut dyn Write,
    args: &Args,
    medium: &Medium,
    points: &[Point],
    estimates: &[Vec<Estimate>],
) -> std::io::Result<()> {
    let ordered = || (0..points.len()).flat_map(|p| (0..estimates.len()).map(move |w| (p, w)));
    let rows = ordered().map(|(p, w)| {
        let e = &estimates[w][p];
        let wavelength_nm = medium.wavelengths_nm[w];
        (points[p], Answer { wavelength_nm, radiance: e.radiance, stderr: Some(e.stderr) })
    });
    if !args.per_order {
        return write_answers(out, rows);
    }
    let mut plain = Vec::new();
    write_answers(&mut plain, rows)?;
    let mut extra = std::iter::once("orders_per_sr".to_string())
        .chain(ordered().map(|(p, w)| orders(&estimates[w][p], args.orders)));
    for line in String::from_utf8_lossy(&plain).lines() {
        writeln!(out, "{line},{}", extra.next().unwrap_or_default())?;
    }
    Ok(())
}

fn orders(estimate: &Estimate, most: Option<u64>) -> String {
    let shown = most.map_or(estimate.per_order.len(), |n| estimate.per_order.len().min(n as usize));
    let values: Vec<String> = estimate.per_order[..shown].iter().map(|(v, _)| format!("{v:.8e}")).collect();
    values.join(";")
}
