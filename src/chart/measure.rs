//! What a method costs, and how far it is off.

use super::truth::{Scene, Truth};
use crate::geometry::Point;
use crate::machine::cpu_time::thread_time;
use crate::methods::{Family, Method, PreparedSky};
use crate::preset::Planet;
use crate::quality::{Distribution, colour_error};
use crate::spectrum::{ColourSpace, delta_e_2000_scaled, multiply};
use serde::{Deserialize, Serialize};
use std::time::Duration;

/// A method on the views of a truth.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measured {
    pub family: Family,
    pub setting: String,
    /// Why there are no answers.
    pub failure: Option<String>,
    /// Processor time of the preparation, s.
    pub preparation: f64,
    pub bytes: usize,
    /// Filtered texture reads of a look-up, in the mean over all views.
    pub fetches: f64,
    /// Processor time of a look-up on one thread, in the mean over all views, ns.
    pub nanoseconds: f64,
    /// Linear sRGB over the star's illuminance, 1/sr, a view of the truth each; none where it is no number.
    answers: Vec<[Option<f64>; 3]>,
}

/// Errors in one region.
#[derive(Clone, Debug)]
pub struct Errors {
    pub delta_e: Distribution,
    /// Length of the difference of linear RGB over the length of the true one.
    pub radiance: Distribution,
    pub not_finite: usize,
    /// Of negative luminance.
    pub negative: usize,
}

/// Least time that look-ups are timed for.
const TIMED: Duration = Duration::from_millis(30);

impl Measured {
    /// Prepares a method and asks it all views.
    pub fn of(method: &dyn Method, planet: &Planet, truth: &Truth) -> Measured {
        let mut out = Measured {
            family: method.family(),
            setting: method.setting(),
            failure: None,
            preparation: 0.0,
            bytes: 0,
            fetches: 0.0,
            nanoseconds: 0.0,
            answers: Vec::new(),
        };
        match method.prepare(planet) {
            Err(error) => out.failure = Some(error.to_string()),
            Ok(prepared) => {
                out.preparation = prepared.cpu.as_secs_f64();
                out.ask(prepared.sky.as_ref(), truth);
            }
        }
        out
    }

    fn ask(&mut self, sky: &dyn PreparedSky, truth: &Truth) {
        let views: Vec<Point> = truth.scenes.iter().map(Scene::point).collect();
        let finite = |v: f64| v.is_finite().then_some(v);
        self.answers = views.iter().map(|p| sky.radiance(p).map(finite)).collect();
        self.bytes = sky.bytes();
        self.fetches = views.iter().map(|p| sky.fetches(p) as f64).sum::<f64>() / views.len() as f64;
        let (start, mut least, mut sum) = (thread_time(), Duration::MAX, 0.0);
        // The quickest round: what else the machine does only slows it down.
        while least == Duration::MAX || thread_time().saturating_sub(start) < TIMED {
            let begin = thread_time();
            sum += views.iter().map(|p| sky.radiance(p)[1]).sum::<f64>();
            least = least.min(thread_time().saturating_sub(begin));
        }
        std::hint::black_box(sum);
        self.nanoseconds = least.as_secs_f64() * 1e9 / views.len() as f64;
    }

    /// Errors on the lit views of a region; none without answers.
    pub fn errors(&self, truth: &Truth, region: usize) -> Option<Errors> {
        if self.failure.is_some() {
            return None;
        }
        let space = ColourSpace::Srgb;
        let (mut delta_e, mut radiance) = (Vec::new(), Vec::new());
        let (mut not_finite, mut negative) = (0, 0);
        let lit = truth.scenes.iter().zip(&self.answers).filter(|(s, _)| s.region == region && s.is_lit());
        for (scene, answer) in lit {
            let rgb = answer.map(|v| v.unwrap_or(f64::NAN));
            let xyz = multiply(&space.to_xyz(), rgb);
            let finite = rgb.iter().all(|v| v.is_finite());
            not_finite += usize::from(!finite);
            negative += usize::from(xyz[1] < 0.0);
            // A colour that is no number is as far off as can be; the formula's own maxima would swallow it.
            delta_e.push(if finite { delta_e_2000_scaled(scene.xyz, xyz) } else { f64::INFINITY });
            radiance.push(colour_error(rgb, multiply(&space.from_xyz(), scene.xyz)));
        }
        let (delta_e, radiance) = (Distribution::of(delta_e), Distribution::of(radiance));
        Some(Errors { delta_e, radiance, not_finite, negative })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One view answered rightly and one by no number: the worst error is infinite in both measures, and one view is
    /// counted as not finite.
    #[test]
    fn no_number_is_as_far_off_as_can_be() {
        let lit = Scene::made_up(0, [0.2, 0.3, 0.5]);
        let truth = Truth { scenes: vec![lit.clone(), lit] };
        let rgb = multiply(&ColourSpace::Srgb.from_xyz(), truth.scenes[0].xyz);
        let measured = Measured {
            family: Family::Compact,
            setting: String::new(),
            failure: None,
            preparation: 0.0,
            bytes: 0,
            fetches: 0.0,
            nanoseconds: 0.0,
            answers: vec![rgb.map(Some), [None; 3]],
        };
        let errors = measured.errors(&truth, 0).unwrap();
        assert!(errors.delta_e.max.is_infinite() && errors.radiance.max.is_infinite());
        assert_eq!((errors.delta_e.count, errors.not_finite), (2, 1));
        assert!(errors.delta_e.median.is_infinite() || errors.delta_e.median < 1e-6);
    }
}
