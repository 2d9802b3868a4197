//! What methods are held against.

use super::Effort;
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::geometry::view::View;
use crate::preset::Planet;
use crate::quality::{REGIONS, views};
use crate::reference::{Settings, Tracer};
use crate::spectrum::Reconstruction;
use crate::transport::solve::{Orders, Resolution, Solution};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// One batch of the solver's lanes; none but 380, 550 and 780 nm is one that bakes sample by default.
const WAVELENGTHS_NM: [f64; 16] = [
    380.0, 405.0, 430.0, 455.0, 480.0, 505.0, 528.0, 550.0, 575.0, 600.0, 625.0, 650.0, 680.0, 710.0, 745.0,
    780.0,
];
/// Of these, the one that Monte Carlo looks at.
const CHECKED: usize = 7;
/// Relative change that the truth may still make.
const TOLERANCE: f64 = 2e-5;
/// Radiance over irradiance, 1/sr, below which a view is dark and errors mean nothing: a hundredth of starlight by day.
pub(super) const DARK: f64 = 1e-11;
/// Standard error at which Monte Carlo may stop.
const STDERR: f64 = 3e-3;
/// Apart from the views of bakes' own reports.
const SEED: u64 = 7;

/// A view with its light.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Scene {
    /// Number in [`REGIONS`].
    pub region: usize,
    /// Altitude (m), cosines of view and sun, azimuth (degrees).
    view: [f64; 4],
    /// XYZ over the star's illuminance, 1/sr.
    pub xyz: [f64; 3],
    /// Radiance over irradiance at 550 nm, 1/sr.
    radiance: f64,
}

impl Scene {
    pub fn point(&self) -> Point {
        let [altitude, mu, mu_s, azimuth_deg] = self.view;
        Point { altitude, mu, mu_s, azimuth_deg }
    }

    pub fn is_lit(&self) -> bool {
        self.xyz[1] > DARK
    }

    /// A view of no planet.
    #[cfg(test)]
    pub fn made_up(region: usize, xyz: [f64; 3]) -> Scene {
        Scene { region, view: [2.0, 0.5, 0.5, 0.0], xyz, radiance: xyz[1] }
    }
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Truth {
    pub scenes: Vec<Scene>,
}

/// A view of the truth beside Monte Carlo's, radiance over irradiance at 550 nm, 1/sr.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Check {
    pub region: usize,
    pub view: [f64; 4],
    pub truth: f64,
    pub monte_carlo: f64,
    pub stderr: f64,
}

impl Truth {
    /// Solves a planet and integrates `count` views of every region. Errors: a medium without meaning.
    pub fn solve(planet: &Planet, count: usize) -> Result<Truth> {
        let medium = planet.medium(&WAVELENGTHS_NM);
        medium.check().map_err(|reason| Error::Argument(format!("{}: {reason}", planet.name)))?;
        let solution = Solution::new(&medium, &Resolution::EXACT, Orders::Converged { tolerance: TOLERANCE });
        let reconstruction = Reconstruction::new(&WAVELENGTHS_NM, &planet.star.irradiance);
        let illuminance = reconstruction.sum(|_| 1.0)[1];
        let last: Vec<usize> = (0..medium.constituents.len()).collect();
        let scene = |region: usize, p: &Point| {
            let light = View::enter(p, medium.ground_radius, medium.top_radius).map(|view| {
                let r = solution.radiance(&view, &last);
                r.scattering.iter().zip(&r.ground).map(|(s, g)| s + g).collect::<Vec<f64>>()
            });
            let light = light.unwrap_or_else(|| vec![0.0; WAVELENGTHS_NM.len()]);
            let xyz = reconstruction.xyz(&light).map(|v| v / illuminance);
            Scene { region, view: [p.altitude, p.mu, p.mu_s, p.azimuth_deg], xyz, radiance: light[CHECKED] }
        };
        let all = REGIONS.iter().enumerate().flat_map(|(n, region)| {
            let points = views(region, count, SEED, medium.ground_radius, medium.top_radius);
            points.into_iter().map(move |p| (n, p))
        });
        let all: Vec<(usize, Point)> = all.collect();
        Ok(Truth { scenes: all.par_iter().map(|(n, p)| scene(*n, p)).collect() })
    }

    /// The first lit views of each region by Monte Carlo, at 550 nm.
    pub fn check(&self, planet: &Planet, effort: Effort) -> Result<Vec<Check>> {
        if effort.checked == 0 {
            return Ok(Vec::new());
        }
        let tracer = Tracer::new(&planet.medium(&WAVELENGTHS_NM[CHECKED..=CHECKED]), 0);
        let settings = Settings { paths: effort.paths, stderr: Some(STDERR), ..Settings::default() };
        let chosen = (0..REGIONS.len()).flat_map(|region| {
            let of = self.scenes.iter().filter(move |s| s.region == region && s.is_lit());
            of.take(effort.checked)
        });
        let check = |scene: &Scene| {
            let found = tracer.estimate(&scene.point(), &settings);
            Check {
                region: scene.region,
                view: scene.view,
                truth: scene.radiance,
                monte_carlo: found.radiance,
                stderr: found.stderr,
            }
        };
        Ok(chosen.map(check).collect())
    }
}
