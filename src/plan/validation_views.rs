//! Views of a scene with their true colours, and how far a sky is from them.

use crate::geometry::Point;
use crate::geometry::view::View;
use crate::layout::sky::{Component, Sky};
use crate::medium::Medium;
use crate::preset::{Metric, Scene, Tolerance};
use crate::quality::{Distribution, Scope, colour_error};
use crate::spectrum::{ColourSpace, Reconstruction, delta_e_2000_scaled, multiply};
use crate::transport::solve::Solution;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Luminance over the star's illuminance, 1/sr, below which views are left out: darker than a moonless night is by
/// itself.
pub(super) const NIGHT: f64 = 1e-9;
/// Azimuths of a view where only their mean matters.
const AZIMUTHS: usize = 4;

/// Of observers in the air one in so many looks at the sun: its light on things is looked up too.
const SUNWARD: usize = 8;

/// What is looked at.
#[derive(Clone, Debug, PartialEq)]
enum Look {
    /// Sky or ground, at a point or at several that differ in azimuth, whose mean light counts.
    Into(Vec<Point>),
    /// Sunlight where a point is.
    Sun(Point),
}

/// Views and the truth about them.
pub(super) struct ValidationViews {
    views: Vec<Look>,
    /// XYZ over the star's illuminance, 1/sr.
    truth: Vec<[f64; 3]>,
    space: ColourSpace,
    tolerance: Tolerance,
}

/// How a model did on some views.
#[derive(Clone, Debug, PartialEq)]
pub struct Errors(Vec<f64>);

impl Errors {
    /// In rising order; what is no number is infinite.
    pub fn new(mut errors: Vec<f64>) -> Self {
        errors.iter_mut().filter(|e| e.is_nan()).for_each(|e| *e = f64::INFINITY);
        errors.sort_by(f64::total_cmp);
        Errors(errors)
    }

    /// The error that a share of the views does not exceed.
    pub fn at(&self, share: f64) -> f64 {
        let needed = (self.0.len() as f64 * share).ceil() as usize;
        self.0.get(needed.clamp(1, self.0.len().max(1)) - 1).copied().unwrap_or(0.0)
    }

    /// Share of the views whose error is at most this.
    pub fn share_within(&self, most: f64) -> f64 {
        self.0.partition_point(|e| *e <= most) as f64 / self.0.len().max(1) as f64
    }

    /// Root of the mean square of errors over a tolerance, each taken for twice the tolerance at most: smooth where the
    /// error of one share of the views jumps.
    pub fn strain(&self, most: f64) -> f64 {
        let square = |e: &f64| (e / most).min(2.0) * (e / most).min(2.0);
        (self.0.iter().map(square).sum::<f64>() / self.0.len().max(1) as f64).sqrt()
    }

    pub fn distribution(&self) -> Distribution {
        Distribution::of(self.0.clone())
    }

    pub fn count(&self) -> usize {
        self.0.len()
    }
}

/// The views that a scene means.
pub(super) fn scope(scene: &Scene) -> Scope {
    let [low, high] = scene.suns;
    Scope {
        altitudes: scene.altitudes,
        suns: [if scene.twilight_matters { low } else { low.max(0.0) }, high],
        elevations: scene.elevations,
        azimuths: scene.azimuths,
        sky_only: scene.elevations[0] >= 0.0,
    }
}

/// What truths come from: a medium, the light in it, and colours of its wavelengths.
pub(super) struct Truth<'a> {
    pub medium: &'a Medium,
    pub solution: &'a Solution,
    pub reconstruction: &'a Reconstruction,
}

impl Truth<'_> {
    /// XYZ over the star's illuminance.
    fn colour(&self, look: &Look, illuminance: f64) -> [f64; 3] {
        let points = match look {
            Look::Into(points) => points,
            Look::Sun(p) => {
                let through = self.solution.sun_transmittance(self.medium.ground_radius + p.altitude, p.mu_s);
                return self.reconstruction.xyz(&through).map(|v| v / illuminance);
            }
        };
        let all: Vec<usize> = (0..self.medium.constituents.len()).collect();
        let mut sum = vec![0.0; self.medium.wavelengths_nm.len()];
        for point in points {
            let view = View::enter(point, self.medium.ground_radius, self.medium.top_radius);
            let Some(view) = view else { continue };
            let light = self.solution.radiance(&view, &all);
            let each = 1.0 / points.len() as f64;
            for (s, (air, ground)) in sum.iter_mut().zip(light.scattering.iter().zip(&light.ground)) {
                *s += each * (air + ground);
            }
        }
        self.reconstruction.xyz(&sum).map(|v| v / illuminance)
    }
}

impl ValidationViews {
    /// Views of a scene under a seed, with their truth.
    pub(super) fn new(scene: &Scene, truth: &Truth, count: usize, seed: u32) -> ValidationViews {
        let [ground, top] = [truth.medium.ground_radius, truth.medium.top_radius];
        let around = |(k, p): (usize, Point)| -> Look {
            if k % SUNWARD == SUNWARD - 1 && p.altitude < top - ground {
                return Look::Sun(p);
            }
            if scene.azimuth_matters {
                return Look::Into(vec![p]);
            }
            // Midpoints of even parts of half a turn: cosines of up to seven times the azimuth average to nothing.
            let turn = |j: usize| (j as f64 + 0.5) * PI / AZIMUTHS as f64;
            Look::Into((0..AZIMUTHS).map(|j| Point { azimuth_deg: turn(j).to_degrees(), ..p }).collect())
        };
        let points: Vec<Look> =
            scope(scene).views(count, seed, ground, top).into_iter().enumerate().map(around).collect();
        let illuminance = truth.reconstruction.sum(|_| 1.0)[1];
        let colours: Vec<[f64; 3]> = points.par_iter().map(|p| truth.colour(p, illuminance)).collect();
        let lit = points.into_iter().zip(colours).filter(|(_, xyz)| xyz[1] > NIGHT);
        let (views, truth) = lit.unzip();
        ValidationViews { views, truth, space: ColourSpace::Srgb, tolerance: scene.tolerance }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.views.is_empty()
    }

    /// Errors of a sky.
    pub(super) fn errors(&self, sky: &dyn Sky) -> Errors {
        let (to_xyz, from_xyz) = (self.space.to_xyz(), self.space.from_xyz());
        let one = |(look, truth): (&Look, &[f64; 3])| {
            let mut rgb = [0.0; 3];
            match look {
                Look::Sun(p) => rgb = sky.sunlight(p.altitude, p.mu_s),
                Look::Into(points) => points.iter().for_each(|point| {
                    let light = sky.rgb(point, Component::Total);
                    (0..3).for_each(|c| rgb[c] += light[c] / points.len() as f64);
                }),
            }
            match self.tolerance.metric {
                Metric::Relative => colour_error(rgb, multiply(&from_xyz, *truth)),
                Metric::DeltaE => delta_e_2000_scaled(*truth, multiply(&to_xyz, rgb)),
            }
        };
        Errors::new(self.views.par_iter().zip(&self.truth).map(one).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of 1 … 20, 95 % are at most 19, and half of them within 10.
    #[test]
    fn shares_and_errors() {
        let errors = Errors::new((1..=20).rev().map(f64::from).collect());
        assert_eq!((errors.at(0.95), errors.at(0.5), errors.at(1.0)), (19.0, 10.0, 20.0));
        assert_eq!((errors.share_within(10.0), errors.share_within(0.5)), (0.5, 0.0));
        let even = Errors::new(vec![0.5; 7]);
        assert_eq!((even.strain(1.0), even.strain(0.1)), (0.5, 2.0));
        assert_eq!(Errors::new(vec![f64::NAN, 1.0]).at(1.0), f64::INFINITY);
    }
}
