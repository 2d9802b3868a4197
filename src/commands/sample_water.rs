//! `tyndall sample --water`: the light out of a baked water, and the slab solver's own beside it.

use super::machine::{MOST_WATER_ORDERS, with_threads};
use super::sample::{Args, baked_orders, exact_wavelengths, fits, spectral};
use super::text::stream;
use crate::error::{Error, Result};
use crate::files::manifest::Manifest;
use crate::geometry::Point;
use crate::layout::sky::Component;
use crate::layout::water::lookup::{WaterSky, WaterView};
use crate::layout::water::{FINE, Skylight, Split};
use crate::preset::{Planet, Water};
use crate::transport::slab::{Layer, Light, Slab, Streams, Surface, WaterOrders, leaving, within};
use crate::transport::solve::{Resolution, Solution};
use rayon::prelude::*;

/// Answers all points as CSV on standard output: radiance that leaves the water where the view meets it (not
/// weakened by the air between), or that an observer in the water sees.
pub(super) fn run(
    args: &Args,
    name: &str,
    manifest: &Manifest,
    planet: &Planet,
    points: &[Point],
) -> Result<()> {
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
        if !sky.has_underwater() && !args.exact {
            let reason = "--observer-depth: needs a bake with --underwater, or --exact";
            return Err(Error::Argument(reason.into()));
        }
    }
    let meet = |p: &Point| match args.observer_depth {
        Some(_) => Ok(WaterView { depth, mu: p.mu, mu_s: p.mu_s }),
        None => WaterView::meet(planet.ground_radius, depth, p).map(|(view, _)| view),
    };
    let views = points.iter().map(meet).collect::<Result<Vec<_>>>()?;
    let (nm, light) = if args.exact {
        let nm = exact_wavelengths(args, manifest)?;
        fits(args, points.len(), nm.len())?;
        let light = with_threads(args.threads, || exact(args, name, manifest, planet, &nm, &views))??;
        (nm, light)
    } else {
        let ask = |v: &WaterView| match args.observer_depth {
            Some(d) => sky.within(v, d, args.component).unwrap_or_default(),
            None => sky.leaving(v, args.component),
        };
        (sky.wavelengths_nm.clone(), views.iter().map(ask).collect())
    };
    stream(|out| spectral(out, args, planet, points, &nm, &light))
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
    let refuse = |reason: Error| Error::file(&args.bake, format!("bake.json: {reason}"));
    let preset = manifest.waters.iter().find(|w| w.name == name);
    let preset = preset.ok_or_else(|| refuse(format!("waters: {name} is missing").into()))?;
    let water = Water::from_resolved(&preset.resolved).map_err(refuse)?;
    let orders = match manifest.settings["water_orders"]["first"].as_u64() {
        None => WaterOrders::All,
        Some(n) if (1..=MOST_WATER_ORDERS as u64).contains(&n) => WaterOrders::First(n as usize),
        Some(n) => return Err(refuse(format!("settings.water_orders.first = {n}: out of range").into())),
    };
    let (air, media) = (planet.medium(nm), water.medium(nm));
    air.check().map_err(refuse)?;
    let baked = baked_orders(manifest).map_err(refuse)?;
    let solution = Solution::new(&air, &Resolution::EXACT, args.orders.unwrap_or(baked));
    let slabs: Vec<Slab> = (0..nm.len())
        .into_par_iter()
        .map(|w| Slab::new(&media, w, Surface { n: media.refractive_index[w] }, Streams::TABLES))
        .collect();
    let split = args.observer_depth.map(|_| Split::new(&air, &solution));
    let one = |v: &WaterView| -> Vec<f64> {
        let direct = solution.sun_transmittance(planet.ground_radius, v.mu_s);
        let sky = solution.ground_irradiance(v.mu_s);
        // From above the whole sky, ring by ring; within, where its own light is seen too, its two parts.
        let rings = split.is_none().then(|| Skylight::new(&air, &solution, v.mu_s, FINE));
        let at = |w: usize| {
            let layer = Layer::new(&slabs[w], v.depth);
            let sun = Light::sun(v.mu_s, direct[w] * v.mu_s.max(0.0));
            let [own, bed] = match (&split, args.observer_depth) {
                (Some(split), Some(d)) => {
                    let light = Light { sky: split.parts(v.mu_s, w, sky[w]), ..sun };
                    let observer = if v.depth > 0.0 { d / v.depth } else { 0.0 };
                    within(&media, w, &layer, (v.mu, observer), light, orders)
                }
                _ => {
                    let beams = rings.as_ref().map(|r| r.beams(w, sky[w])).unwrap_or_default();
                    leaving(&media, w, &layer, v.mu, Light { beams: &beams, ..sun }, orders)
                }
            };
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
