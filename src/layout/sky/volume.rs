//! Tables in memory: stored samples, interpolated before they are decoded, as a texture unit would.

use crate::error::{Error, Result};
use crate::files::Atlas;
use crate::files::manifest::{Encoding, Table};
use crate::mapping::{Elek2010, HALVES, Layer, Span, SunCurve, Texel, Views, WINDOW, Warp, texel};

/// Stored samples of up to four channels, x fastest, and how each channel is decoded.
pub(in crate::internals::layout) struct Texels {
    values: Vec<[f32; 4]>,
    encodings: Vec<Encoding>,
}

impl Texels {
    pub(in crate::internals::layout) fn new(table: &Table, atlas: &Atlas) -> Result<Self> {
        let expected: usize = table.shape.iter().product();
        // The shape was held against the file when the sky was opened.
        let mut values = vec![[0.0; 4]; expected];
        let mut encodings = Vec::new();
        if table.channels.len() > 4 {
            return Err(format!("{}: more than four channels", table.file).into());
        }
        for (k, info) in table.channels.iter().enumerate() {
            let channel = atlas
                .channel(&info.name)
                .ok_or_else(|| format!("{}: channel {} is missing", table.file, info.name))?;
            if channel.samples.len() != expected {
                return Err(
                    format!("{}: {} samples, not {expected}", table.file, channel.samples.len()).into()
                );
            }
            for (n, v) in values.iter_mut().enumerate() {
                v[k] = channel.samples.get(n);
            }
            encodings.push(info.encoding.clone().unwrap_or_else(|| table.encoding.clone()));
        }
        Ok(Texels { values, encodings })
    }

    pub(in crate::internals::layout) fn decode(&self, stored: [f64; 4]) -> [f64; 4] {
        let mut out = [0.0; 4];
        for (k, e) in self.encodings.iter().enumerate() {
            out[k] = e.decode(stored[k]);
        }
        out
    }

    /// Σ weight · stored sample over the corners around a place; `strides[axis]` in texels.
    pub(in crate::internals::layout) fn interpolate<const D: usize>(
        &self,
        place: &[Texel; D],
        strides: &[usize; D],
    ) -> [f64; 4] {
        let mut sum = [0.0; 4];
        for corner in 0..1usize << D {
            let (mut weight, mut at) = (1.0, 0);
            for axis in 0..D {
                let upper = corner >> axis & 1;
                weight *= if upper == 1 { place[axis].1 } else { 1.0 - place[axis].1 };
                at += (place[axis].0 + upper) * strides[axis];
            }
            if weight != 0.0 {
                for k in 0..4 {
                    sum[k] += weight * f64::from(self.values[at][k]);
                }
            }
        }
        sum
    }
}

/// The mapping that a table's axes describe.
fn mapping(table: &Table, size: [usize; 4]) -> Result<Elek2010> {
    let constant = |axis: usize, name: &str| {
        let axis = table.axes.get(axis).ok_or_else(|| format!("{}: an axis is missing", table.name))?;
        axis.constants
            .get(name)
            .copied()
            .ok_or_else(|| format!("{}: axis {} has no {name}", table.name, axis.name))
    };
    let radii = [constant(0, "r_ground")?, constant(0, "r_top")?];
    let sun = table.axes.iter().position(|a| a.name == "sun");
    let number = |name: &str| sun.and_then(|k| constant(k, name).ok());
    let curve = match (number("shift"), number("centre"), number("width")) {
        (Some(shift), _, Some(width)) => SunCurve::Rational { shift, width },
        (_, Some(centre), Some(width)) => SunCurve::HalfAngle { centre, width },
        _ => SunCurve::Paper,
    };
    let bends = Warp {
        altitude_bend: constant(0, "altitude_bend")?,
        altitude_power: constant(0, "altitude_power").unwrap_or(1.0),
        view_power: constant(1, "view_power")?,
        horizon_power: constant(1, "horizon_power")?,
        layer: layer(|name| constant(0, name).ok()),
    };
    let span = |axis: Option<usize>| -> Result<Span> {
        let end = |name: &str| axis.and_then(|k| constant(k, name).ok());
        let (Some(low), Some(high)) = (end(WINDOW[0]), end(WINDOW[1])) else { return Ok(Span::WHOLE) };
        Span::new(low, high).ok_or_else(|| {
            Error::Reason(format!("{}: {}, {}: must rise between 0 and 1", table.name, WINDOW[0], WINDOW[1]))
        })
    };
    let views = if constant(1, HALVES).is_ok_and(|n| n == 1.0) { Views::Sky } else { Views::All };
    Elek2010::of_spans(radii, size, curve, bends, [span(Some(0))?, span(sun)?], views)
        .ok_or_else(|| Error::Reason(format!("{}: sizes {size:?} or radii are out of range", table.name)))
}

/// The layer of an altitude axis with these constants.
fn layer(constant: impl Fn(&str) -> Option<f64>) -> Layer {
    match [constant("layer_share"), constant("layer_altitude"), constant("layer_width")] {
        [Some(share), Some(altitude), Some(width)] => Layer { share, altitude, width },
        _ => Layer::NONE,
    }
}

/// A table over altitude, view, sun and azimuth.
pub(crate) struct Volume {
    texels: Texels,
    mapping: Elek2010,
}

/// A view inside the shell in the coordinates of the mapping.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub altitude: f64,
    pub mu: f64,
    pub mu_s: f64,
    pub nu: f64,
    pub hits_ground: bool,
}

impl Place {
    pub(crate) fn cos_azimuth(&self) -> f64 {
        let sines = ((1.0 - self.mu * self.mu) * (1.0 - self.mu_s * self.mu_s)).max(0.0).sqrt();
        if sines > 0.0 { ((self.nu - self.mu * self.mu_s) / sines).clamp(-1.0, 1.0) } else { 1.0 }
    }
}

impl Volume {
    pub(crate) fn new(table: &Table, atlas: &Atlas) -> Result<Self> {
        let size: [usize; 4] =
            table.shape.clone().try_into().map_err(|_| format!("{}: not four axes", table.file))?;
        Ok(Volume { texels: Texels::new(table, atlas)?, mapping: mapping(table, size)? })
    }

    pub(crate) fn mapping(&self) -> &Elek2010 {
        &self.mapping
    }

    /// Decoded values at a place; none below the sun axis, where it is dark.
    pub(crate) fn at(&self, p: &Place) -> Option<[f64; 4]> {
        let place = self.mapping.locate(p.altitude, p.mu, p.mu_s, p.cos_azimuth(), p.hits_ground)?;
        let [x, y, z, _] = self.mapping.size();
        Some(self.texels.decode(self.texels.interpolate(&place, &[1, x, x * y, x * y * z])))
    }
}

/// A table over one or two axes.
pub(crate) struct Plane {
    texels: Texels,
    size: [usize; 2],
    mapping: Option<Elek2010>,
    /// Values are means over the length of the ray.
    over_length: bool,
}

impl Plane {
    pub(crate) fn new(table: &Table, atlas: &Atlas) -> Result<Self> {
        let size = [table.shape.first().copied().unwrap_or(1), table.shape.get(1).copied().unwrap_or(1)];
        let names: Vec<&str> = table.axes.iter().map(|a| a.name.as_str()).collect();
        let mapping = match names[..] {
            ["altitude", "view"] => Some(mapping(table, [size[0], size[1], 1, 1])?),
            _ => None,
        };
        let over_length = table.channels.iter().any(|c| c.unit == "1/m");
        Ok(Plane { texels: Texels::new(table, atlas)?, size, mapping, over_length })
    }

    /// Decoded values at a row (taken as it is) and a place 0..1 along x.
    pub(crate) fn at(&self, x: f64, row: usize) -> [f64; 4] {
        let place = [texel(x, self.size[0]), (row.min(self.size[1] - 1), 0.0)];
        self.texels.decode(self.texels.interpolate(&place, &[1, self.size[0]]))
    }

    /// Optical depths of a ray, of a table over altitude and view.
    pub(crate) fn depth(&self, altitude: f64, mu: f64, hits_ground: bool) -> [f64; 4] {
        let Some(mapping) = &self.mapping else { return [0.0; 4] };
        let x = mapping.altitude_texel(altitude);
        let y = mapping.view_texel(altitude, mu, hits_ground);
        let length = if self.over_length { mapping.distance(altitude, mu, hits_ground) } else { 1.0 };
        self.texels.decode(self.texels.interpolate(&[x, y], &[1, self.size[0]])).map(|v| v * length)
    }

    /// Transmittance towards a sun of zenith cosine `mu_s`; 0 behind the planet.
    pub(crate) fn sunlight(&self, altitude: f64, mu_s: f64) -> [f64; 4] {
        match &self.mapping {
            Some(mapping) if mapping.hits_ground(altitude, mu_s) => [0.0; 4],
            _ => self.depth(altitude, mu_s, false).map(|d| libm::exp(-d)),
        }
    }
}

/// The point of view as a place inside the shell of `mapping`; none where the ray misses the atmosphere.
pub(crate) fn enter(point: &crate::geometry::Point, mapping: &Elek2010) -> Option<Place> {
    let [ground, top] = mapping.radii();
    let nu = point.nu().clamp(-1.0, 1.0);
    let height = top - ground;
    if point.altitude <= height {
        let hits_ground = mapping.hits_ground(point.altitude, point.mu);
        return Some(Place { altitude: point.altitude, mu: point.mu, mu_s: point.mu_s, nu, hits_ground });
    }
    let r = ground + point.altitude;
    let across2 = r * r * (1.0 - point.mu * point.mu);
    if point.mu >= 0.0 || across2 >= top * top {
        return None;
    }
    let along = -(top * top - across2).sqrt();
    let mu_s = ((r * point.mu_s + (along - r * point.mu) * nu) / top).clamp(-1.0, 1.0);
    let mu = along / top;
    Some(Place { altitude: height, mu, mu_s, nu, hits_ground: across2 <= ground * ground })
}

/// What of a view is beyond the tables of a window, as key, value and reason; none where nothing is, or where the ray
/// misses the air. Angles and altitudes may be rounded as a CSV file has them.
pub(crate) fn outside(
    point: &crate::geometry::Point,
    mapping: &Elek2010,
) -> Option<(&'static str, f64, String)> {
    const ROUNDED: f64 = 1e-4;
    let place = enter(point, mapping)?;
    let [ground, top] = mapping.radii();
    let ([low, high], [altitudes, suns]) = (mapping.altitudes(), mapping.spans());
    let slack = 1e-6 * (top - ground);
    if altitudes != Span::WHOLE && !(low - slack..=high + slack).contains(&place.altitude) {
        let above = if altitudes.high == 1.0 { " and above" } else { "" };
        let reason = format!("these tables hold altitudes from {low:.1} to {high:.1} m{above}");
        return Some(("altitude_m", point.altitude, reason));
    }
    let [low, high] = mapping.suns();
    if suns != Span::WHOLE && !(low - ROUNDED..=high + ROUNDED).contains(&place.mu_s) {
        let [from, to] = [low, high].map(|mu| libm::asin(mu.clamp(-1.0, 1.0)).to_degrees());
        let entered = if place.altitude == point.altitude { "" } else { " where the ray enters the air" };
        let reason = format!(
            "these tables hold suns from {low:.4} to {high:.4} ({from:.2} to {to:.2} degrees of elevation){entered}"
        );
        return Some(("mu_sun", point.mu_s, reason));
    }
    (mapping.views() == Views::Sky && place.hits_ground).then(|| {
        ("mu_view", point.mu, "this ray meets the ground, and these tables hold the sky alone".to_string())
    })
}

/// Cosine of the sun's zenith angle where a ray meets the ground.
pub(crate) fn sun_at_ground(place: &Place, mapping: &Elek2010) -> f64 {
    let [ground, _] = mapping.radii();
    let r = ground + place.altitude;
    let length = mapping.distance(place.altitude, place.mu, true);
    ((r * place.mu_s + length * place.nu) / ground).clamp(-1.0, 1.0)
}
