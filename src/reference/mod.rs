//! The Monte Carlo reference: what the solver is held against.
//!
//! Paths run backwards from the observer through the spherical shell; at every event (a scattering or a
//! bounce off the Lambertian ground) the sun's light is added with its exact transmittance. Places along a
//! ray and directions are drawn where a coarse picture of the light says that it comes from, with exact
//! weights, so the answer is unbiased whatever the picture. It shares the medium and the points of view with
//! the solver, and no line of geometry or integration.
//!
//! Orders: an event counts as one, be it in the air or at the ground; order 1 is light scattered once or
//! reflected once. Scalar, no refraction, the sun's disc not seen directly.

mod angles;
mod estimate;
mod guide;
mod path;
mod random;
mod ray;
mod scene;
mod shells;
pub mod water;

pub use estimate::{Estimate, Settings};
pub use path::ORDERS;

use crate::geometry::Point;
use crate::medium::Medium;
use glam::DVec3;
use path::{Scratch, follow};
use random::Numbers;
use rayon::prelude::*;
use scene::{Scene, Segment};

/// A planet at one wavelength, ready to be traced.
pub struct Tracer {
    scene: Scene,
}

/// Paths in each bin of directions when the light is learnt.
const LESSONS: u64 = 3;
/// Events of such a path at most.
const LESSON_ORDERS: usize = 6;

impl Tracer {
    /// Fits the air at wavelength number `wavelength` of the medium and learns coarsely where its light is.
    pub fn new(medium: &Medium, wavelength: usize) -> Self {
        let mut scene = Scene::new(medium, wavelength);
        for round in 0..2 {
            let places = scene.guide.radii.len() * guide::ANGLES;
            let radiance: Vec<_> = (0..places).into_par_iter().map(|n| lesson(&scene, n, round)).collect();
            scene.guide.learn(&radiance);
        }
        Tracer { scene }
    }

    /// Optical depth from a point along its view, to space or to the ground; 0 for a miss.
    pub fn optical_depth(&self, point: &Point) -> f64 {
        self.camera(point).map_or(0.0, |(segment, _)| segment.ray.depth)
    }

    /// The camera ray inside the atmosphere and the direction to the sun; None where it misses.
    fn camera(&self, point: &Point) -> Option<(Segment, DVec3)> {
        let sine = |c: f64| (1.0 - c * c).max(0.0).sqrt();
        let (s, c) = libm::sincos(point.azimuth_deg.to_radians());
        let view = DVec3::new(sine(point.mu) * c, sine(point.mu) * s, point.mu).normalize();
        let sun = DVec3::new(sine(point.mu_s), 0.0, point.mu_s).normalize();
        let radius = self.scene.ground_radius + point.altitude;
        let x = radius * view.z;
        let b2 = radius * radius * (1.0 - view.z * view.z);
        let mut origin = DVec3::new(0.0, 0.0, radius);
        let top2 = self.scene.shells.top2();
        if radius * radius >= top2 {
            if x >= 0.0 || b2 >= top2 {
                return None;
            }
            // Down the view ray to the top; the sun stays where it is in space.
            origin += view * (-(top2 - b2).sqrt() - x);
        }
        let mut segment = Segment::default();
        segment.aim_finely(&self.scene, origin, view, sun);
        Some((segment, sun))
    }
}

/// Radiance at a place of the guide's grid, per bin of directions.
fn lesson(scene: &Scene, number: usize, round: u64) -> [f64; guide::BINS] {
    let radius = scene.guide.radii[number / guide::ANGLES];
    let mu_s = guide::sun_angle(number % guide::ANGLES);
    let sun = DVec3::new((1.0 - mu_s * mu_s).max(0.0).sqrt(), 0.0, mu_s);
    let (mut camera, mut scratch) = (Segment::default(), Scratch::default());
    std::array::from_fn(|bin| {
        let mut sum = 0.0;
        for n in 0..LESSONS {
            let path = (number * guide::BINS + bin) as u64 * LESSONS + n;
            let mut numbers = Numbers::new(round, u64::MAX, path);
            let (u, v) = (numbers.1.uniform(), numbers.1.uniform());
            let direction = guide::direction_in(bin, DVec3::Z, sun, u, v);
            let origin = DVec3::new(0.0, 0.0, radius);
            camera.aim(scene, origin, scene.shells.find(radius * radius), direction, sun);
            let light = follow(scene, &camera, sun, LESSON_ORDERS, numbers, &mut scratch);
            sum += light.total + light.left;
        }
        sum / LESSONS as f64
    })
}
