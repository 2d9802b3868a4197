//! The 4D parameterisation of Elek & Kmoch 2010 §4.1 (after Bruneton & Neyret 2008), repaired.
//!
//! Repairs. The formulas take a radius where the text says altitude. V is split into two halves of texels,
//! rays that hit the ground and rays that leave through the top, each with its ends on texel centres; in the
//! paper nadir and zenith meet at V = ½ and blend. The sun axis reaches down to the last light at the top of
//! a thick shell, and what lies beyond is dark, not clamped. All sizes have texel centres at both ends.
//!
//! Altitudes, not radii, come in and go out: at 1 mm over the ground of a large planet a radius in f64 has
//! few digits of altitude left. Every difference below is written as a product or quotient, so that
//! horizon and distances keep their digits.

mod axes;
mod part;
mod view;

use super::array::{Texel, texel};
use super::layer::Layer;
use super::sun_curve::SunCurve;
use super::warp::Warp;
use super::window::{Span, Views};

pub use axes::{AxisFormula, HALVES, WINDOW};

/// The exponent of the sun axis over its whole length: 2.8 cos δ + 0.8 at cos δ = 1. A longer axis stretches
/// the paper's nodes evenly; with 2.8 kept, the last step below the zenith would widen to half the day.
const SUN_EXPONENT: f64 = 3.6;
/// 1 − e^−3.6, what W is divided by.
const SUN_RANGE: f64 = 0.972_676_277_552_707_1;
/// Lower end of the paper's sun axis: W = 0 where 2.8 cos δ + 0.8 = 0.
const PAPER_MU_S_MIN: f64 = -0.8 / 2.8;
/// How far the axis reaches below the last light at the top: half a degree at the horizon, so that the dark
/// edge lies inside the table for any shell.
const MU_S_MARGIN: f64 = 0.01;

/// The mapping between (altitude, mu, mu_s, azimuth) and texels.
#[derive(Clone, Debug, PartialEq)]
pub struct Elek2010 {
    ground_radius: f64,
    /// Height of the shell, m.
    height: f64,
    mu_s_min: f64,
    /// Steepness of the sun axis: 2.8 (the paper's) where the axis has the paper's length.
    sun_steepness: f64,
    curve: SunCurve,
    bends: Warp,
    size: [usize; 4],
    /// The parts of the axes that the texels hold, and the altitudes (m) and sun cosines at their ends.
    spans: [Span; 2],
    altitudes: [f64; 2],
    suns: [f64; 2],
    views: Views,
}

impl Elek2010 {
    /// The paper's size: altitude, view, sun, azimuth.
    pub const PAPER_SIZE: [usize; 4] = [32, 128, 32, 8];

    /// A mapping of the whole of a shell between two radii (m). Sizes are at least 2, that of the view axis, which has
    /// two halves, even. None where a size or the shell is out of that range.
    pub fn new(ground_radius: f64, top_radius: f64, size: [usize; 4]) -> Option<Self> {
        let valid_size = size.iter().all(|&n| n >= 2) && size[1].is_multiple_of(2);
        if valid_size { Elek2010::whole(ground_radius, top_radius, size) } else { None }
    }

    /// The same without conditions on the sizes.
    fn whole(ground_radius: f64, top_radius: f64, size: [usize; 4]) -> Option<Self> {
        let valid_shell = ground_radius > 0.0 && top_radius > ground_radius && top_radius.is_finite();
        if !valid_shell {
            return None;
        }
        let height = top_radius - ground_radius;
        let last_light = -(height * (top_radius + ground_radius)).sqrt() / top_radius;
        let mu_s_min = PAPER_MU_S_MIN.min(last_light - MU_S_MARGIN).max(-1.0);
        let sun_steepness = SUN_EXPONENT / (1.0 - mu_s_min);
        Some(Elek2010 {
            ground_radius,
            height,
            mu_s_min,
            sun_steepness,
            curve: SunCurve::Paper,
            bends: Warp::PAPER,
            size,
            spans: [Span::WHOLE; 2],
            altitudes: [0.0, height],
            suns: [mu_s_min, 1.0],
            views: Views::All,
        })
    }

    /// The same mapping with another sun axis and bent altitude and view axes.
    pub fn with_curves(mut self, curve: SunCurve, bends: Warp) -> Self {
        self.curve = curve;
        self.bends = bends;
        self
    }

    /// The same shell, curves and window for a table of other size; conditions as for [`Self::windowed`].
    pub fn resized(&self, size: [usize; 4]) -> Option<Self> {
        Elek2010 { size, ..self.clone() }.with_spans(self.spans, self.views)
    }

    /// Altitudes (m) at the ends of what the table holds.
    pub fn altitudes(&self) -> [f64; 2] {
        self.altitudes
    }

    /// Cosines of the lowest and highest sun that the table holds.
    pub fn suns(&self) -> [f64; 2] {
        self.suns
    }

    /// The parts of the altitude and sun axes that the table holds, in coordinates.
    pub fn spans(&self) -> [Span; 2] {
        self.spans
    }

    /// Which rays the table holds.
    pub fn views(&self) -> Views {
        self.views
    }

    /// Radius of the ground and of the top, m.
    pub fn radii(&self) -> [f64; 2] {
        [self.ground_radius, self.ground_radius + self.height]
    }

    pub fn size(&self) -> [usize; 4] {
        self.size
    }

    /// Lowest cosine of the sun's zenith angle in the table; below it there is no light anywhere.
    pub fn mu_s_min(&self) -> f64 {
        self.mu_s_min
    }

    // ---- altitude: U = Z1 / Z2 -------------------------------------------------------------------------

    /// Z1: distance from a point to its horizon, m.
    #[inline]
    pub fn horizon_distance(&self, altitude: f64) -> f64 {
        (altitude * (2.0 * self.ground_radius + altitude)).sqrt()
    }

    /// U(altitude) in 0..1.
    pub fn altitude_coordinate(&self, altitude: f64) -> f64 {
        let u = self.horizon_distance(altitude) / self.horizon_distance(self.height);
        self.bends.layer.coordinate(altitude, self.height, self.bends.altitude_coordinate(u))
    }

    /// Altitude of texel `i`, m: that of the window's ends, without one 0 and the shell's height, for first and last.
    pub fn altitude(&self, i: usize) -> f64 {
        let [low, high] = self.altitudes;
        if low == high || (self.size[0] > 1 && i + 1 == self.size[0]) {
            return high;
        }
        self.altitude_at(self.spans[0].coordinate(i, self.size[0]))
    }

    /// Altitude at a share, in the axis' coordinate, of the way from texel `i` to the next, m.
    pub fn altitude_between(&self, i: usize, share: f64) -> f64 {
        let [low, high] = [i, i + 1].map(|k| self.spans[0].coordinate(k, self.size[0]));
        self.altitude_at(low + share * (high - low))
    }

    /// Altitude of a coordinate, m.
    fn altitude_at(&self, x: f64) -> f64 {
        // 0 and 1 are the ends, to the bit.
        if self.bends.layer == Layer::NONE || x <= 0.0 || x >= 1.0 {
            return self.altitude_of_share(self.bends.altitude(x));
        }
        // The coordinate rises with the altitude; halving a share of 1 sixty times leaves no digit.
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            match self.altitude_coordinate(self.altitude_of_share(middle)) < x {
                true => low = middle,
                false => high = middle,
            }
        }
        self.altitude_of_share(0.5 * (low + high))
    }

    /// Altitude whose U is a share of the top's, m.
    fn altitude_of_share(&self, share: f64) -> f64 {
        let z1 = self.horizon_distance(self.height) * share;
        let ground = self.ground_radius;
        z1 * z1 / (ground + (ground * ground + z1 * z1).sqrt())
    }

    /// As [`Self::altitude`], but the first and last lie a millionth of the height inside the shell: there all
    /// rays have a length, and means over them a value.
    pub fn inner_altitude(&self, i: usize) -> f64 {
        self.altitude(i).clamp(1e-6 * self.height, (1.0 - 1e-6) * self.height)
    }

    /// Radius of texel `i`, m.
    pub fn radius(&self, i: usize) -> f64 {
        self.ground_radius + self.altitude(i)
    }

    // ---- sun: W = (1 − e^(−a (mu_s − mu_s_min))) / (1 − e^−3.6), a = 3.6 / (1 − mu_s_min) -----------------

    /// W(mu_s) in 0..1; none below the axis, where it is dark. With the paper's mu_s_min = −0.8/2.8 this is
    /// its (1 − e^(−2.8 mu_s − 0.8)) / (1 − e^−3.6).
    #[inline]
    pub fn sun_coordinate(&self, mu_s: f64) -> Option<f64> {
        if mu_s < self.mu_s_min {
            return None;
        }
        let x = |mu: f64| self.curve.quotient(mu);
        if let (Some(at), Some(low), Some(high)) = (x(mu_s), x(self.mu_s_min), x(1.0)) {
            return Some((at - low) / (high - low));
        }
        let above = self.sun_steepness * (mu_s - self.mu_s_min);
        Some((1.0 - libm::exp(-above)) / SUN_RANGE)
    }

    /// Cosine of the sun's zenith angle of texel `k`: that of the window's ends, without one mu_s_min and 1, for first
    /// and last.
    pub fn mu_s(&self, k: usize) -> f64 {
        let [low, high] = self.suns;
        if low == high || (self.size[2] > 1 && k + 1 == self.size[2]) {
            return high;
        }
        self.mu_s_at(self.spans[1].coordinate(k, self.size[2]))
    }

    /// Cosine of the sun's zenith angle of a coordinate.
    fn mu_s_at(&self, w: f64) -> f64 {
        let x = |mu: f64| self.curve.quotient(mu);
        if let (Some(low), Some(high)) = (x(self.mu_s_min), x(1.0)) {
            return self.curve.mu_s(low + w * (high - low)).expect("a quotient has an inverse");
        }
        self.mu_s_min - libm::log(1.0 - w * SUN_RANGE) / self.sun_steepness
    }

    // ---- azimuth: R = (1 + cos φ) / 2 --------------------------------------------------------------------

    /// R(cos φ) in 0..1; 1 looks towards the sun.
    pub fn azimuth_coordinate(&self, cos_azimuth: f64) -> f64 {
        0.5 * (1.0 + cos_azimuth)
    }

    /// Cosine of the view–sun azimuth of texel `l`: −1 for the first, 1 for the last.
    pub fn cos_azimuth(&self, l: usize) -> f64 {
        2.0 * l as f64 / (self.size[3] - 1) as f64 - 1.0
    }

    /// Cosines of the azimuths at which each texel of the azimuth axis is found, the same number for all: one texel
    /// alone is the mean over all azimuths, by the rule that takes cos mφ for m up to 7 exactly.
    pub fn cos_azimuths(&self) -> Vec<f64> {
        match self.size[3] {
            1 => (0..4).map(|j| libm::cos((2 * j + 1) as f64 * std::f64::consts::PI / 8.0)).collect(),
            n => (0..n).map(|l| self.cos_azimuth(l)).collect(),
        }
    }

    // ---- all four ----------------------------------------------------------------------------------------

    /// Texels around (altitude in m, cosines), for [`super::Array::interpolate`] on an array of [`Self::size`];
    /// none where the sun is below the axis: the answer there is 0. `hits_ground` says which half of the view
    /// axis is read; [`Self::hits_ground`] decides it for a ray that starts here, a point further along a ray
    /// keeps the ray's own.
    #[inline]
    pub fn locate(
        &self,
        altitude: f64,
        mu: f64,
        mu_s: f64,
        cos_azimuth: f64,
        hits_ground: bool,
    ) -> Option<[Texel; 4]> {
        debug_assert!(altitude <= self.height * (1.0 + 1e-6), "{altitude} m is no altitude in this shell");
        let [sun, azimuth] = self.sun_texels(mu_s, cos_azimuth)?;
        Some([self.altitude_texel(altitude), self.view_texel(altitude, mu, hits_ground), sun, azimuth])
    }

    /// Texels around an altitude; beyond a window its end.
    #[inline]
    pub fn altitude_texel(&self, altitude: f64) -> Texel {
        texel(self.spans[0].place(self.altitude_coordinate(altitude)), self.size[0])
    }

    /// Texels around a sun zenith angle and azimuth, beyond a window its end; none where the sun is below the axis.
    #[inline]
    pub fn sun_texels(&self, mu_s: f64, cos_azimuth: f64) -> Option<[Texel; 2]> {
        let sun = texel(self.spans[1].place(self.sun_coordinate(mu_s)?), self.size[2]);
        Some([sun, texel(self.azimuth_coordinate(cos_azimuth), self.size[3])])
    }
}
