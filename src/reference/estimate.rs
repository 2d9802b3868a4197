//! Estimates with their standard error, from replicates that know nothing of each other.

use super::Tracer;
use super::path::{Light, ORDERS, Scratch, follow};
use super::random::Numbers;
use super::scene::Segment;
use crate::geometry::Point;
use glam::DVec3;
use rayon::prelude::*;

/// How long to trace, and what.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Paths at most, over all replicates.
    pub paths: u64,
    /// Relative standard error at which to stop before, after a least number of paths.
    pub stderr: Option<f64>,
    /// Light of 1 … this many events; None: all.
    pub orders: Option<usize>,
    pub seed: u64,
    /// Independent replicates, at least 2; their scatter gives the standard error, itself uncertain by
    /// 1 part in √(2 (replicates − 1)).
    pub replicates: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Settings { paths: 1 << 20, stderr: None, orders: None, seed: 0, replicates: 32 }
    }
}

/// A radiance per unit solar irradiance normal to the beam, 1/sr, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    pub radiance: f64,
    pub stderr: f64,
    /// Radiance and standard error of orders 1, 2, …: light of so many events.
    pub per_order: Vec<(f64, f64)>,
    /// Paths traced.
    pub paths: u64,
}

/// Paths of a replicate in the first round; each next round doubles what there is.
const FIRST: u64 = 64;
/// Paths of a replicate at least, before a target may end the sum. Much of the light comes from few paths: until
/// some of them were met, the scatter of the replicates is too small a standard error, and stopping where it is
/// small picks those cases.
const LEAST: u64 = 1024;

impl Tracer {
    /// Radiance at a point of view. The same settings give the same bits, whatever the number of threads.
    pub fn estimate(&self, point: &Point, settings: &Settings) -> Estimate {
        let replicates = settings.replicates.max(2);
        let most = settings.paths.div_ceil(replicates).max(1);
        let Some((camera, sun)) = self.camera(point) else {
            return summary(&vec![Light::default(); replicates as usize], 1);
        };
        let mut sums = vec![Light::default(); replicates as usize];
        let mut done = 0;
        loop {
            let until = match settings.stderr {
                Some(_) => (2 * done).max(FIRST).min(most),
                None => most,
            };
            let more: Vec<Light> = (0..replicates)
                .into_par_iter()
                .map(|r| self.replicate(&camera, sun, settings, r, done..until))
                .collect();
            sums.iter_mut().zip(&more).for_each(|(s, m)| s.accumulate(m));
            done = until;
            let estimate = summary(&sums, done);
            let reached = settings.stderr.is_some_and(|t| estimate.stderr <= t * estimate.radiance.abs());
            if done == most || (reached && done >= LEAST) {
                return estimate;
            }
        }
    }

    fn replicate(
        &self,
        camera: &Segment,
        sun: DVec3,
        settings: &Settings,
        replicate: u64,
        paths: std::ops::Range<u64>,
    ) -> Light {
        let orders = settings.orders.unwrap_or(usize::MAX);
        let mut scratch = Scratch::default();
        let mut sum = Light::default();
        for path in paths {
            let numbers = Numbers::new(settings.seed, replicate, path);
            sum.accumulate(&follow(&self.scene, camera, sun, orders, numbers, &mut scratch));
        }
        sum
    }
}

fn summary(sums: &[Light], paths: u64) -> Estimate {
    let of = |pick: &dyn Fn(&Light) -> f64| {
        let n = sums.len() as f64;
        let mean = sums.iter().map(pick).sum::<f64>() / n;
        let scatter = sums.iter().map(|s| (pick(s) - mean) * (pick(s) - mean)).sum::<f64>() / (n - 1.0);
        (mean / paths as f64, (scatter / n).sqrt() / paths as f64)
    };
    let (radiance, stderr) = of(&|s| s.total);
    let per_order = (0..ORDERS).map(|k| of(&|s| s.orders[k])).collect();
    Estimate { radiance, stderr, per_order, paths: paths * sums.len() as u64 }
}
