//! The quality report of a bake: its tables against direct integration, and what the solver says of itself.

use crate::colour::weights::Palette;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::layout::sky::{AerosolPhase, Component, Sky};
use crate::mapping::Window;
use crate::medium::Medium;
use crate::quality::{DARK, Distribution, REGIONS, Scope, colour_error, digits, relative_errors, views};
use crate::spectrum::{delta_e_2000_scaled, multiply};
use crate::transport::balance::balance;
use crate::transport::solve::{Orders, Solution, worst};
use rayon::prelude::*;
use serde_json::{Map, Value, json};

/// Views a region: enough for a 95th percentile, few enough to take a small share of the bake.
const VIEWS: usize = 40;

/// A region's views with their true radiance, per wavelength, 1/sr.
pub struct Truth {
    pub region: &'static str,
    pub views: Vec<(Point, Vec<f64>)>,
}

/// The truth of a solution at the report's views (total light): by region or, for tables of a window, there.
pub fn truths(medium: &Medium, solution: &Solution, window: &Window) -> Vec<Truth> {
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    let radiance = |p: &Point| match View::enter(p, medium.ground_radius, medium.top_radius) {
        Some(view) => {
            let r = solution.radiance(&view, &all);
            r.scattering.iter().zip(&r.ground).map(|(s, g)| s + g).collect()
        }
        None => vec![0.0; medium.wavelengths_nm.len()],
    };
    let [ground, top] = [medium.ground_radius, medium.top_radius];
    let truth = |region: &'static str, points: Vec<Point>| Truth {
        region,
        views: points.par_iter().map(|p| (*p, radiance(p))).collect(),
    };
    if *window != Window::WHOLE {
        let scope = Scope::of_window(window, ground, top);
        return vec![truth("window", scope.views(REGIONS.len() * VIEWS, 1, ground, top))];
    }
    REGIONS.iter().map(|region| truth(region.name, views(region, VIEWS, 1, ground, top))).collect()
}

/// Errors of the compact layout, by region: relative radiance per wavelength, and as RGB.
pub fn compact(sky: &Sky, palette: &Palette, truths: &[Truth]) -> Value {
    let mut out = Map::new();
    for truth in truths {
        let (mut spectral, mut colour) = (Vec::new(), Vec::new());
        for (point, light) in &truth.views {
            let found = sky.radiance(point, Component::Total, AerosolPhase::Preset);
            let four: Vec<f64> = palette.four.iter().map(|&w| light[w]).collect();
            spectral.extend(relative_errors(&found, &four, DARK));
            if light.iter().any(|&v| v > DARK) {
                colour.push(colour_error(sky.rgb(point, Component::Total), rgb(palette, light)));
            }
        }
        let pair = json!({ "per_wavelength": Distribution::of(spectral).json(), "rgb": Distribution::of(colour).json() });
        out.insert(truth.region.to_string(), pair);
    }
    Value::Object(out)
}

/// Errors of a layout in RGB, by region, against a medium's truth.
pub fn in_rgb(sky: &Sky, palette: &Palette, truths: &[Truth], phase: AerosolPhase) -> Value {
    let mut out = Map::new();
    for truth in truths {
        let lit = truth.views.iter().filter(|(_, light)| light.iter().any(|&v| v > DARK));
        let errors = lit.map(|(point, light)| {
            let found = sky.radiance(point, Component::Total, phase);
            colour_error([found[0], found[1], found[2]], rgb(palette, light))
        });
        out.insert(truth.region.to_string(), Distribution::of(errors.collect()).json());
    }
    Value::Object(out)
}

/// Linear RGB over the star's illuminance.
fn rgb(palette: &Palette, light: &[f64]) -> [f64; 3] {
    rgb_of(palette, palette.xyz(light))
}

fn rgb_of(palette: &Palette, xyz: [f64; 3]) -> [f64; 3] {
    multiply(&palette.rgb.from_xyz, xyz.map(|v| v / palette.star_xyz[1]))
}

/// What the solver says of one medium: orders, residual, energy balance, and the spherical albedo per wavelength.
pub fn solver(medium: &Medium, solution: &Solution) -> Value {
    let residual = worst(&solution.report.residual);
    let mut out = Map::new();
    match solution.orders {
        Orders::Converged { .. } => {
            out.insert("orders".into(), json!("converged"));
            out.insert("applications".into(), json!(solution.report.applications));
            let balances = balance(solution, medium);
            let errors = balances.iter().map(|b| b.error());
            let worst = errors.fold(0.0, |a: f64, e| if e.abs() > a.abs() { e } else { a });
            out.insert("energy_balance_error".into(), json!(digits(worst)));
            let albedo: Vec<f64> = balances.iter().map(|b| digits(b.spherical_albedo())).collect();
            out.insert("spherical_albedo".into(), json!(albedo));
        }
        Orders::First(n) => {
            out.insert("orders".into(), json!(n));
        }
    }
    out.insert("residual".into(), json!(digits(residual)));
    Value::Object(out)
}

/// Colours of the weights: ΔE2000 on skies held out of their fits, and, where there is a truth to look at, what
/// four wavelengths lose in each region.
pub fn colours(palette: &Palette, truths: Option<&[Truth]>) -> Value {
    let mut out = json!({
        "all_wavelengths_delta_e_2000": palette.error.json(),
        "four_wavelengths_delta_e_2000": palette.four_error.json(),
    });
    if let Some(truths) = truths {
        out["four_wavelengths_by_region"] = four_wavelengths(palette, truths);
    }
    out
}

/// What colour loses to the choice of four wavelengths, tables apart, by region of a medium's truth: relative
/// RGB and ΔE2000, against all wavelengths of the bake.
fn four_wavelengths(palette: &Palette, truths: &[Truth]) -> Value {
    let mut out = Map::new();
    for truth in truths {
        let (mut relative, mut felt) = (Vec::new(), Vec::new());
        for (_, light) in truth.views.iter().filter(|(_, light)| light.iter().any(|&v| v > DARK)) {
            let (found, wanted) = (palette.xyz_of_four(light), palette.xyz(light));
            relative.push(colour_error(rgb_of(palette, found), rgb_of(palette, wanted)));
            felt.push(delta_e_2000_scaled(wanted, found));
        }
        let pair = json!({
            "rgb": Distribution::of(relative).json(),
            "delta_e_2000": Distribution::of(felt).json(),
        });
        out.insert(truth.region.to_string(), pair);
    }
    Value::Object(out)
}
