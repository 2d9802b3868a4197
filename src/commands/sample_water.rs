//! `tyndall sample --water`: the light out of a baked water, and the slab solver's own beside it.

use super::machine::with_threads;
use super::sample::{Args, baked_orders, exact_wavelengths, spectral};
use super::text::print;
use crate::error::{Error, Result};
use crate::export::manifest::Manifest;
use crate::points::Point;
use crate::preset::{Planet, Water};
use crate::sky::Component;
use crate::sky::water::{WaterSky, WaterView};
use crate::transport::slab::{Layer, Light, Slab, Streams, Surface, WaterOrders, leaving};
use crate::transport::solve::{Resolution, Solution};
use rayon::prelude::*;

/// Answers all points as CSV on standard output: radiance that leaves the water where the view meets it (not
/// weakened by the air between), or that an observer in the water sees.
pub fn run(args: &Args, name: &str, manifest: &Manifest, planet: &Planet, points: &[Point]) -> Result<()> {
    let sky = WaterSky::open(&args.bake, manifest, name)?;
    let depth = args.depth.unwrap_or(0.0);
    if !(0.0..=sky.largest_depth).contains(&depth) {
        let most = sky.largest_depth;
        return Err(Error::Argument(format!("--depth {depth}: the tables of {name} hold 0 to {most} m")));
    }
    if let Some(d) = args.observer_depth {
        if !(0.0..=depth).contains(&d) {
            return Err(Error::Argument(format!("--observer-depth {d}: must be from 0 to --depth {depth}")));
        }
        if !sky.has_underwater() || args.exact {
            let reason = "--observer-depth: reads tables of a bake with --underwater, and has no --exact";
            return Err(Error::Argument(reason.into()));
        }
    }
    let views = points.iter().map(|p| view(args, planet, depth, p)).collect::<Result<Vec<_>>>()?;
    let (nm, light) = if args.exact {
        let nm = exact_wavelengths(args, manifest)?;
        let light = with_threads(args.threads, || exact(args, name, manifest, planet, &nm, &views))??;
        (nm, light)
    } else {
        let ask = |v: &WaterView| match args.observer_depth {
            Some(d) => sky.within(v, d, args.component).unwrap_or_default(),
            None => sky.leaving(v, args.component),
        };
        (sky.wavelengths_nm.clone(), views.iter().map(ask).collect())
    };
    let mut out = Vec::new();
    spectral(&mut out, args, planet, points, &nm, &light).map_err(|e| Error::machine("the answer", e))?;
    print(&String::from_utf8_lossy(&out))
}

/// The view where it meets the water: down the ray from an observer above, angles there.
fn view(args: &Args, planet: &Planet, depth: f64, p: &Point) -> Result<WaterView> {
    if args.observer_depth.is_some() {
        return Ok(WaterView { depth, mu: p.mu, mu_s: p.mu_s });
    }
    let ground = planet.ground_radius;
    let r = ground + p.altitude;
    let across2 = r * r * (1.0 - p.mu * p.mu);
    if p.mu >= 0.0 || across2 > ground * ground {
        let reason = format!("mu_view {} at {} m never meets the water: look down", p.mu, p.altitude);
        return Err(Error::Argument(format!("--water {reason}")));
    }
    let cosine = (1.0 - across2 / (ground * ground)).max(0.0).sqrt();
    let length = p.altitude * (r + ground) / (-r * p.mu + ground * cosine);
    let mu_s = ((r * p.mu_s + length * p.nu()) / ground).clamp(-1.0, 1.0);
    Ok(WaterView { depth, mu: cosine, mu_s: if p.altitude == 0.0 { p.mu_s } else { mu_s } })
}

/// Solved afresh, air and water, `[view][wavelength]`.
fn exact(
    args: &Args,
    name: &str,
    manifest: &Manifest,
    planet: &Planet,
    nm: &[f64],
    views: &[WaterView],
) -> Result<Vec<Vec<f64>>> {
    let refuse = |reason: String| Error::file(&args.bake, format!("bake.json: {reason}"));
    let preset = manifest.waters.iter().find(|w| w.name == name);
    let preset = preset.ok_or_else(|| refuse(format!("waters: {name} is missing")))?;
    let water = Water::from_resolved(&preset.resolved).map_err(|e| refuse(e.to_string()))?;
    let single = manifest.settings["water_orders"]["first"] == 1;
    let orders = if single { WaterOrders::Single } else { WaterOrders::All };
    let (air, media) = (planet.medium(nm), water.medium(nm));
    air.check().map_err(refuse)?;
    let baked = baked_orders(manifest).map_err(refuse)?;
    let solution = Solution::new(&air, &Resolution::EXACT, args.orders.unwrap_or(baked));
    let slabs: Vec<Slab> = (0..nm.len())
        .into_par_iter()
        .map(|w| Slab::new(&media, w, Surface { n: media.refractive_index[w] }, Streams::TABLES))
        .collect();
    let one = |v: &WaterView| -> Vec<f64> {
        let direct = solution.sun_transmittance(planet.ground_radius, v.mu_s);
        let diffuse = solution.ground_irradiance(v.mu_s);
        let at = |w: usize| {
            let direct = direct[w] * v.mu_s.max(0.0);
            let light = Light { mu_s: v.mu_s, direct, diffuse: diffuse[w] };
            let [own, bed] = leaving(&media, w, &Layer::new(&slabs[w], v.depth), v.mu, light, orders);
            match args.component {
                Component::Total => own + bed,
                Component::Scattering => own,
                Component::Ground => bed,
            }
        };
        (0..nm.len()).map(at).collect()
    };
    Ok(views.par_iter().map(one).collect())
}
