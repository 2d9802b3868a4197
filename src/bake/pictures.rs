//! `preview.png`: skies from the ground as the sun goes down, and the planet from space.

use crate::error::Result;
use crate::files::picture::{Exposure, fisheye, from_space};
use crate::files::sheet::{Panel, contact_sheet};
use crate::geometry::Point;
use crate::layout::sky::{Component, Sky};
use crate::layout::water::lookup::{WaterSky, WaterView};
use crate::mapping::Window;
use crate::preset::Planet;

const SIZE: usize = 144;
const COLUMNS: usize = 4;
/// Sun elevations of the skies, degrees.
const SUNS: [f64; 6] = [60.0, 20.0, 5.0, 0.0, -4.0, -8.0];
/// Sun elevations at the point below the observer in space.
const SPACE_SUNS: [f64; 2] = [45.0, -15.0];

/// Depths of water, m, and sun elevations over it, as in Elek & Kmoch's Fig. 5.
const WATER_DEPTHS: [f64; 4] = [2.0, 4.0, 10.0, 100.0];
const WATER_SUNS: [f64; 2] = [60.0, 15.0];

/// The picture's file in a bake.
pub(crate) const FILE: &str = "preview.png";

/// The picture, and the number of pixels that no display can show. Of tables for a window it shows what they hold.
pub(crate) fn preview(
    sky: &dyn Sky,
    planet: &Planet,
    window: &Window,
    waters: &[(&str, &WaterSky)],
) -> Result<(Vec<u8>, usize)> {
    let mut panels: Vec<Panel> = Vec::new();
    let height = planet.top_radius - planet.ground_radius;
    let [lowest, highest] = window.altitudes.unwrap_or([0.0, f64::INFINITY]);
    let shown = if lowest < height { suns(window, &SUNS) } else { Vec::new() };
    for sun in shown {
        let look = |v: [f64; 3]| Some(colour(sky, &point(lowest.max(2.0).min(highest), v, sun)));
        panels.push(fisheye(SIZE, &format!("SUN {sun:.0}"), Exposure::Auto, look));
    }
    let distance = (2.2 * planet.ground_radius).min(highest);
    let shown = if distance > height { suns(window, &SPACE_SUNS) } else { Vec::new() };
    for sun in shown {
        let look = |v: [f64; 3]| Some(colour(sky, &point(distance, v, sun)));
        let radii = [planet.ground_radius + distance, planet.top_radius];
        panels.push(from_space(SIZE, &format!("SPACE {sun:.0}"), Exposure::Auto, radii, look));
    }
    for (name, water) in waters {
        for sun in WATER_SUNS {
            // One exposure for all depths, that of the first, so that water darkens as it gets deeper.
            let mut exposure = Exposure::Auto;
            for depth in WATER_DEPTHS {
                let look = |v: [f64; 3]| Some(water_colour(sky, water, v, sun, depth));
                let panel = fisheye(SIZE, &format!("{name} {depth:.0} M SUN {sun:.0}"), exposure, look);
                exposure = Exposure::Fixed(panel.exposure);
                panels.push(panel);
            }
        }
    }
    let errors = panels.iter().map(|p| p.errors).sum();
    Ok((contact_sheet(&panels, COLUMNS)?, errors))
}

/// Sun elevations of a row of pictures: those given or, of a window's suns, as many from the highest to the lowest.
fn suns(window: &Window, given: &[f64]) -> Vec<f64> {
    let Some([low, high]) = window.suns else { return given.to_vec() };
    let steps = given.len() - 1;
    let mut suns: Vec<f64> = (0..=steps).map(|k| high + (low - high) * k as f64 / steps as f64).collect();
    suns.dedup();
    suns
}

/// A look in direction `v` (z up, x towards the sun) with the sun at an elevation in degrees.
fn point(altitude: f64, v: [f64; 3], sun: f64) -> Point {
    let azimuth_deg = libm::atan2(v[1].abs(), v[0]).to_degrees();
    Point { altitude, mu: v[2].clamp(-1.0, 1.0), mu_s: libm::sin(sun.to_radians()), azimuth_deg }
}

/// Flat water below, straight down in the middle of the panel, the horizon on its circle: light out of the water
/// and the sky that it mirrors. `v` is the direction of the mirrored ray, upwards.
fn water_colour(sky: &dyn Sky, water: &WaterSky, v: [f64; 3], sun: f64, depth: f64) -> [f64; 3] {
    let above = point(0.0, v, sun);
    let view =
        WaterView { depth: depth.min(water.largest_depth), mu: v[2].clamp(0.0, 1.0), mu_s: above.mu_s };
    let out = water.rgb(&water.leaving(&view, Component::Total));
    let mirrored = water.mirrored(view.mu);
    let share = mirrored.iter().sum::<f64>() / mirrored.len() as f64;
    let sky = sky.rgb(&above, Component::Scattering);
    std::array::from_fn(|c| (out[c] + share * sky[c]).max(0.0))
}

/// Colours outside the gamut are brought to its edge: a display can do no other. What is not a number stays.
fn colour(sky: &dyn Sky, point: &Point) -> [f64; 3] {
    sky.rgb(point, Component::Total).map(|c| if c < 0.0 { 0.0 } else { c })
}
