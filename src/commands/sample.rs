//! `tyndall sample`: what baked tables answer at any view, and the truth beside it.

use super::machine::{IsaChoice, MOST_ORDERS, in_range, orders, wavelengths, with_threads};
use super::sample_water;
use super::text::{say, stream};
use crate::error::{Error, Result};
use crate::files::manifest::Manifest;
use crate::files::points::{Answer, read_points, write_answers};
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::layout::sky::{self, AerosolPhase, Channels, Component, Sky};
use crate::machine::memory;
use crate::medium::Medium;
use crate::preset::Planet;
use crate::preset::names;
use crate::transport::solve::{Orders, Resolution, Solution};
use rayon::prelude::*;
use std::io::Write;
use std::path::{Path, PathBuf};

/// What baked tables answer at any view, from their files alone; with --exact the solver's own answer
#[derive(clap::Args, Debug)]
#[command(before_help = "Example: tyndall sample out/earth --points views.csv --layout compact")]
pub struct Args {
    /// Folder of a bake
    #[arg(value_name = "BAKE")]
    pub(super) bake: PathBuf,
    /// CSV with the columns altitude_m,mu_view,mu_sun,azimuth_deg
    #[arg(long, value_name = "CSV")]
    points: PathBuf,
    /// Layout to read [default: compact where it was baked]
    #[arg(long)]
    layout: Option<String>,
    /// Part of the light
    #[arg(long, value_enum, default_value = "total")]
    pub(super) component: Component,
    /// Radiance for the preset's star, W/(m² sr nm) or cd/m², instead of over its irradiance or illuminance
    #[arg(long)]
    pub(super) absolute: bool,
    /// Solve afresh with the bake's physics and integrate directly
    #[arg(long)]
    pub(super) exact: bool,
    /// The light out of a water of the bake, seen from above it, instead of the air's
    #[arg(long, value_name = "NAME", requires = "depth", conflicts_with = "layout")]
    pub water: Option<String>,
    /// With --water: depth of the water, m
    #[arg(long, value_name = "M", requires = "water")]
    pub depth: Option<f64>,
    /// With --water: the light seen at this depth under the surface, m (bakes with --underwater)
    #[arg(long, value_name = "M", requires = "water")]
    pub observer_depth: Option<f64>,
    /// With --exact: wavelengths in nm [default: those of the layout, or of the bake]
    #[arg(long, value_name = "LIST", requires = "exact")]
    wavelengths: Option<String>,
    /// With --exact: auto, or the number of orders to sum [default: as baked]
    #[arg(long, requires = "exact", value_parser = |t: &str| orders(t, EXACT_TOLERANCE))]
    pub(super) orders: Option<Orders>,
    /// Threads [default: all]
    #[arg(long, value_name = "N")]
    pub(super) threads: Option<usize>,
    /// Instruction set of the hot loops
    #[arg(long, value_enum, default_value = "auto")]
    isa: IsaChoice,
}

/// Relative change that the truth may still make.
const EXACT_TOLERANCE: f64 = 2e-5;

/// Answers all points as CSV on standard output.
pub fn run(args: &Args) -> Result<()> {
    args.isa.apply()?;
    let manifest = Manifest::read(&args.bake)?;
    let points = read_points(&args.points)?;
    let planet = Planet::from_resolved(&manifest.preset.resolved)
        .map_err(|e| Error::file(&args.bake, format!("bake.json: {e}")))?;
    if let Some(name) = &args.water {
        return sample_water::run(args, name, &manifest, &planet, &points);
    }
    if args.exact {
        let nm = exact_wavelengths(args, &manifest)?;
        let refuse = |reason: Error| Error::file(&args.bake, format!("bake.json: {reason}"));
        let medium = planet.medium(&nm);
        medium.check().map_err(refuse)?;
        let baked = baked_orders(&manifest).map_err(refuse)?;
        fits(args, points.len(), nm.len())?;
        let light = with_threads(args.threads, || exact(args, &medium, baked, &points))?;
        stream(|out| spectral(out, args, &planet, &points, &nm, &light))
    } else {
        let sky = sky::open(&args.bake, &manifest, &layout(args, &manifest)?)?;
        refuse_outside(&args.points, &points, sky.as_ref())?;
        let ask = |p: &Point| sky.radiance(p, args.component, AerosolPhase::Preset);
        let light: Vec<Vec<f64>> = with_threads(args.threads, || points.iter().map(ask).collect())?;
        if light.iter().flatten().any(|v| !v.is_finite()) {
            let reason = "bake.json: an answer is not a finite number; an encoding or matrix is damaged";
            return Err(Error::file(&args.bake, reason));
        }
        match sky.channels() {
            Channels::Wavelengths(nm) => stream(|out| spectral(out, args, &planet, &points, &nm, &light)),
            Channels::Rgb => {
                say(&format!(
                    "this layout holds colour: answers are linear RGB ({}), {}",
                    manifest.colour.space,
                    if args.absolute { "cd/m²" } else { "luminance over the star's illuminance, 1/sr" }
                ));
                stream(|out| colours(out, args, &manifest, &points, &light))
            }
        }
    }
}

/// Whether so many answers fit into memory.
pub(super) fn fits(args: &Args, points: usize, wavelengths: usize) -> Result<()> {
    // A list of numbers for each view.
    let each = size_of::<Vec<f64>>() + wavelengths * size_of::<f64>();
    memory::check((points * each) as u64)
        .map_err(|reason| Error::file(&args.points, format!("the answer {reason}: split it")))
}

/// Views that tables of a window do not hold are refused, not answered by the nearest.
fn refuse_outside(file: &Path, points: &[Point], sky: &dyn Sky) -> Result<()> {
    for (k, point) in points.iter().enumerate() {
        if let Some((key, value, reason)) = sky.outside(point) {
            return Err(Error::Value {
                file: file.display().to_string(),
                key: format!("view {}, {key}", k + 1),
                value: value.to_string(),
                reason,
            });
        }
    }
    Ok(())
}

fn layout(args: &Args, manifest: &Manifest) -> Result<String> {
    let has = |name: &str| manifest.tables.iter().any(|t| t.layout == name);
    match &args.layout {
        Some(name) if has(name) => Ok(name.clone()),
        Some(name) => {
            let mut baked: Vec<&str> = manifest.tables.iter().map(|t| t.layout.as_str()).collect();
            baked.dedup();
            let known = names::known(name, baked);
            Err(Error::Argument(format!("--layout {name}: not in this bake; {known}")))
        }
        None if has("compact") => Ok("compact".into()),
        None => match manifest.tables.first() {
            Some(table) => Ok(table.layout.clone()),
            None => Err(Error::file(&args.bake, "a bake without tables")),
        },
    }
}

pub(super) fn exact_wavelengths(args: &Args, manifest: &Manifest) -> Result<Vec<f64>> {
    if let Some(text) = &args.wavelengths {
        return wavelengths(text)
            .map_err(|reason| Error::Argument(format!("--wavelengths {text}: {reason}")));
    }
    let four = manifest.constants.get("four_wavelengths_nm");
    let layout = if args.water.is_some() { "compact".into() } else { layout(args, manifest)? };
    let (key, nm) = match (layout.as_str(), four) {
        ("compact", Some(four)) => ("constants.four_wavelengths_nm", four),
        _ => ("wavelengths.nm", &manifest.wavelengths.nm),
    };
    in_range(nm).map_err(|reason| Error::file(&args.bake, format!("bake.json: {key}: {reason}")))?;
    Ok(nm.clone())
}

/// The orders that the bake was made of.
pub(super) fn baked_orders(manifest: &Manifest) -> Result<Orders> {
    match manifest.settings["orders"]["first"].as_u64() {
        Some(n) if (1..=MOST_ORDERS as u64).contains(&n) => Ok(Orders::First(n as usize)),
        Some(n) => Err(format!("settings.orders.first = {n}: must be from 1 to {MOST_ORDERS}").into()),
        None => Ok(Orders::Converged { tolerance: EXACT_TOLERANCE }),
    }
}

/// Radiance over solar irradiance, `[point][wavelength]`.
fn exact(args: &Args, medium: &Medium, baked: Orders, points: &[Point]) -> Vec<Vec<f64>> {
    let solution = Solution::new(medium, &Resolution::EXACT, args.orders.unwrap_or(baked));
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    points
        .par_iter()
        .map(|p| match View::enter(p, medium.ground_radius, medium.top_radius) {
            None => vec![0.0; medium.wavelengths_nm.len()],
            Some(view) => {
                let r = solution.radiance(&view, &all);
                let sum = |(s, g): (&f64, &f64)| match args.component {
                    Component::Total => s + g,
                    Component::Scattering => *s,
                    Component::Ground => *g,
                };
                r.scattering.iter().zip(&r.ground).map(sum).collect()
            }
        })
        .collect()
}

pub(super) fn spectral(
    out: &mut dyn Write,
    args: &Args,
    planet: &Planet,
    points: &[Point],
    nm: &[f64],
    light: &[Vec<f64>],
) -> std::io::Result<()> {
    let star: Vec<f64> =
        nm.iter().map(|&w| if args.absolute { planet.star.irradiance.at(w) } else { 1.0 }).collect();
    let star = &star;
    let rows = points.iter().zip(light).flat_map(|(p, values)| {
        nm.iter().zip(values).zip(star).map(move |((&wavelength_nm, v), s)| {
            (*p, Answer { wavelength_nm, radiance: v * s, stderr: None })
        })
    });
    write_answers(out, rows)
}

fn colours(
    out: &mut dyn Write,
    args: &Args,
    manifest: &Manifest,
    points: &[Point],
    light: &[Vec<f64>],
) -> std::io::Result<()> {
    let unit = if args.absolute { "cd_m2" } else { "per_sr" };
    let illuminance =
        manifest.constants.get("star_illuminance_lx").and_then(|v| v.first()).copied().unwrap_or(1.0);
    let scale = if args.absolute { illuminance } else { 1.0 };
    writeln!(out, "altitude_m,mu_view,mu_sun,azimuth_deg,red_{unit},green_{unit},blue_{unit}")?;
    for (p, v) in points.iter().zip(light) {
        let [r, g, b] = [v[0] * scale, v[1] * scale, v[2] * scale];
        writeln!(out, "{},{},{},{},{r:.8e},{g:.8e},{b:.8e}", p.altitude, p.mu, p.mu_s, p.azimuth_deg)?;
    }
    Ok(())
}
