//! Mappings of a part of their axes.

use super::Elek2010;
use crate::mapping::sun_curve::SunCurve;
use crate::mapping::warp::Warp;
use crate::mapping::window::{Span, Views, Window};

impl Elek2010 {
    /// A mapping of part of a shell, with a sun axis and bent axes of its own. Here the axes of altitude, sun and azimuth
    /// may have one texel, and the view axis, where it holds the sky alone, any number from 2. None where a size, the
    /// shell or the window is out of range.
    pub fn windowed(
        [ground_radius, top_radius]: [f64; 2],
        size: [usize; 4],
        curve: SunCurve,
        bends: Warp,
        window: &Window,
    ) -> Option<Self> {
        let mut out = Elek2010::whole(ground_radius, top_radius, size)?;
        out.altitudes = window.altitudes_in(out.height);
        if let Some(suns) = window.suns_in(ground_radius, top_radius) {
            out.suns = suns.map(|mu_s| mu_s.clamp(out.mu_s_min, 1.0));
        }
        let curve = curve.with_texel_at_horizon(out.suns, size[2]);
        let out = out.with_curves(curve, bends);
        let altitude = out.altitudes.map(|a| out.altitude_coordinate(a));
        let sun = out.suns.map(|mu_s| out.sun_coordinate(mu_s).unwrap_or(0.0));
        // The ends of whole axes are 0 and 1 whatever rounding says.
        let ends = |window: Option<[f64; 2]>, [low, high]: [f64; 2]| match window {
            None => Some(Span::WHOLE),
            Some(_) => Span::new(low.clamp(0.0, 1.0), high.clamp(0.0, 1.0)),
        };
        let spans = [ends(window.altitudes, altitude)?, ends(window.suns, sun)?];
        out.with_spans(spans, window.views)
    }

    /// The same mapping for parts of the altitude and sun axes, in coordinates, and of the view axis; conditions as for
    /// [`Self::windowed`].
    pub(super) fn with_spans(self, spans: [Span; 2], views: Views) -> Option<Self> {
        let [altitudes, rays, suns, azimuths] = self.size;
        let halves = if views == Views::All { 2 } else { 1 };
        if altitudes == 0 || suns == 0 || azimuths == 0 || rays < 2 || !rays.is_multiple_of(halves) {
            return None;
        }
        let altitude = |x: f64| if x == 1.0 { self.height } else { self.altitude_at(x) };
        let sun = |x: f64| if x == 1.0 { 1.0 } else { self.mu_s_at(x) };
        Some(Elek2010 {
            altitudes: [spans[0].low, spans[0].high].map(altitude),
            suns: [spans[1].low, spans[1].high].map(sun),
            spans,
            views,
            ..self
        })
    }

    /// The mapping of a table of stated parts; conditions as for [`Self::windowed`].
    pub fn of_spans(
        [ground_radius, top_radius]: [f64; 2],
        size: [usize; 4],
        curve: SunCurve,
        bends: Warp,
        spans: [Span; 2],
        views: Views,
    ) -> Option<Self> {
        Elek2010::whole(ground_radius, top_radius, size)?.with_curves(curve, bends).with_spans(spans, views)
    }

    /// The same shell and curves for a table of other size that holds all of the axes.
    pub fn unwindowed(&self, size: [usize; 4]) -> Option<Self> {
        Elek2010 { size, ..self.clone() }.with_spans([Span::WHOLE; 2], Views::All)
    }
}
