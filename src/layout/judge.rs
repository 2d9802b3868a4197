//! Tables against direct integration, on the views of the quality report.

use super::sky::{AerosolPhase, Component, Sky};
use crate::colour::weights::ColourWeights;
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::mapping::Window;
use crate::medium::Medium;
use crate::quality::{DARK, Distribution, REGIONS, Scope, colour_error, relative_errors, views};
use crate::spectrum::multiply;
use crate::transport::solve::Solution;
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

/// Errors of a layout of spectra, by region: relative radiance per wavelength, and as RGB.
pub fn in_spectra(sky: &dyn Sky, palette: &ColourWeights, truths: &[Truth]) -> Value {
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
pub fn in_rgb(sky: &dyn Sky, palette: &ColourWeights, truths: &[Truth], phase: AerosolPhase) -> Value {
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

/// Linear RGB over the star's illuminance, of a spectrum.
fn rgb(palette: &ColourWeights, light: &[f64]) -> [f64; 3] {
    rgb_of(palette, palette.xyz(light))
}

/// Linear RGB over the star's illuminance, of XYZ.
pub fn rgb_of(palette: &ColourWeights, xyz: [f64; 3]) -> [f64; 3] {
    multiply(&palette.rgb.from_xyz, xyz.map(|v| v / palette.star_xyz[1]))
}
