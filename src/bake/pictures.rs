//! `preview.png`: skies from the ground as the sun goes down, and the planet from space.

use crate::error::Result;
use crate::export::picture::{Exposure, fisheye, from_space};
use crate::export::sheet::{Panel, contact_sheet};
use crate::points::Point;
use crate::preset::Planet;
use crate::sky::{Component, Sky};

const SIZE: usize = 144;
const COLUMNS: usize = 4;
/// Sun elevations of the skies, degrees.
const SUNS: [f64; 6] = [60.0, 20.0, 5.0, 0.0, -4.0, -8.0];
/// Sun elevations at the point below the observer in space.
const SPACE_SUNS: [f64; 2] = [45.0, -15.0];

/// The picture, and the number of pixels that no display can show.
pub fn preview(sky: &Sky, planet: &Planet) -> Result<(Vec<u8>, usize)> {
    let mut panels: Vec<Panel> = Vec::new();
    for sun in SUNS {
        let look = |v: [f64; 3]| Some(colour(sky, &point(2.0, v, sun)));
        panels.push(fisheye(SIZE, &format!("SUN {sun:.0}"), Exposure::Auto, look));
    }
    let distance = 2.2 * planet.ground_radius;
    for sun in SPACE_SUNS {
        let look = |v: [f64; 3]| Some(colour(sky, &point(distance, v, sun)));
        let radii = [planet.ground_radius + distance, planet.top_radius];
        panels.push(from_space(SIZE, &format!("SPACE {sun:.0}"), Exposure::Auto, radii, look));
    }
    let errors = panels.iter().map(|p| p.errors).sum();
    Ok((contact_sheet(&panels, COLUMNS)?, errors))
}

/// A look in direction `v` (z up, x towards the sun) with the sun at an elevation in degrees.
fn point(altitude: f64, v: [f64; 3], sun: f64) -> Point {
    let azimuth_deg = libm::atan2(v[1].abs(), v[0]).to_degrees();
    Point { altitude, mu: v[2].clamp(-1.0, 1.0), mu_s: libm::sin(sun.to_radians()), azimuth_deg }
}

/// Colours outside the gamut are brought to its edge: a display can do no other. What is not a number stays.
fn colour(sky: &Sky, point: &Point) -> [f64; 3] {
    sky.rgb(point, Component::Total).map(|c| if c < 0.0 { 0.0 } else { c })
}
