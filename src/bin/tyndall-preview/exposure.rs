//! How bright a picture is shown.

use crate::bake::Bake;
use crate::camera::Camera;
use glam::{DMat3, DVec3};
use tyndall::internals::geometry::Point;
use tyndall::internals::layout::sky::Component;
use tyndall::internals::layout::water::lookup::WaterView;
use tyndall::{Error, Result};

/// Either found from the picture or an exposure value at ISO 100.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// From the light in the picture, this many stops brighter.
    Auto(f64),
    /// EV100: what 1.2 · 2^EV cd/m² becomes is 1, the brightest a sensor holds (ISO 12232, as in Lagarde & de
    /// Rousiers 2014, section 5.1).
    Ev100(f64),
}

/// Luminance of 1 on the display at EV 0, cd/m².
const SATURATION: f64 = 1.2;
/// Of the geometric mean of all that is lit.
const MIDDLE: f64 = 0.3;

impl std::str::FromStr for Exposure {
    type Err = Error;

    /// `auto`, `auto+1.5`, `auto-2` or a number.
    fn from_str(text: &str) -> Result<Self> {
        let number = |text: &str| {
            let value: f64 =
                text.parse().map_err(|_| Error::from("not auto, auto+STOPS or a number (EV100)"))?;
            if value.abs() <= 60.0 { Ok(value) } else { Err("must be between -60 and 60".into()) }
        };
        match text.strip_prefix("auto") {
            Some("") => Ok(Exposure::Auto(0.0)),
            Some(stops) => number(stops).map(Exposure::Auto),
            None => number(text).map(Exposure::Ev100),
        }
    }
}

/// What 1 cd/m² becomes on the display, 1 being white.
pub fn factor(exposure: Exposure, bake: &Bake, camera: &Camera, aspect: f64, depth: f64) -> f64 {
    match exposure {
        Exposure::Ev100(ev) => libm::exp2(-ev) / SATURATION,
        Exposure::Auto(stops) => libm::exp2(stops) * MIDDLE / mean_luminance(bake, camera, aspect, depth),
    }
}

/// The EV100 of a factor.
pub fn ev100(factor: f64) -> f64 {
    -libm::log2(factor * SATURATION)
}

/// Geometric mean of the luminance of all that is lit, cd/m², of 32 × 18 places of the picture.
fn mean_luminance(bake: &Bake, camera: &Camera, aspect: f64, depth: f64) -> f64 {
    let illuminance = bake.constant("star_illuminance_lx").unwrap_or(1.0);
    let display = display_matrix(bake);
    let places = (0..32).flat_map(|i| (0..18).map(move |j| [i as f64 / 15.5 - 1.0, j as f64 / 8.5 - 1.0]));
    let light: Vec<f64> = places
        .filter_map(|[x, y]| camera.direction(x, y, aspect))
        .map(|d| {
            let rgb = light_from(bake, &camera.point(d), depth);
            (display * rgb).max(DVec3::ZERO).dot(DVec3::new(0.2126, 0.7152, 0.0722)) * illuminance
        })
        .collect();
    let brightest = light.iter().fold(0.0, |a: f64, b| a.max(*b));
    // What lies in shadow says nothing of how bright the rest should be.
    let lit: Vec<f64> = light.into_iter().filter(|l| *l > 1e-4 * brightest && *l > 0.0).collect();
    match lit.len() {
        0 => 1.0,
        n => libm::exp(lit.iter().map(|l| libm::log(*l)).sum::<f64>() / n as f64),
    }
}

/// Linear RGB of a view, over the star's illuminance; of water, where the bake has one, of this depth.
fn light_from(bake: &Bake, point: &Point, depth: f64) -> DVec3 {
    let sky = |p: &Point, part| DVec3::from(bake.sky.rgb(p, part));
    let met =
        bake.water.as_ref().and_then(|w| Some((w, WaterView::meet(bake.radii()[0], depth, point).ok()?)));
    let Some((water, (view, azimuth))) = met else { return sky(point, Component::Total) };
    let below = Point { altitude: 0.0, mu: -1.0, mu_s: view.mu_s, azimuth_deg: 0.0 };
    let up = Point { mu: view.mu, azimuth_deg: azimuth.to_degrees(), ..below };
    // What is left of the ground's light on its way is left of the water's.
    let (left, whole) = (sky(point, Component::Ground), sky(&below, Component::Ground));
    let through = DVec3::from_array([0, 1, 2].map(|c| if whole[c] > 0.0 { left[c] / whole[c] } else { 1.0 }));
    let leaving = DVec3::from(water.sky.rgb(&water.sky.leaving(&view, Component::Total)));
    let mirrored = water.sky.mirrored(view.mu).first().copied().unwrap_or(0.0);
    sky(point, Component::Scattering) + through * (leaving + mirrored * sky(&up, Component::Total))
}

/// From the bake's linear RGB to linear sRGB (IEC 61966-2-1), without adaptation of the white.
pub fn display_matrix(bake: &Bake) -> DMat3 {
    let rows = |m: &[Vec<f64>]| -> Option<DMat3> {
        let row = |k: usize| Some(DVec3::new(*m.get(k)?.first()?, *m.get(k)?.get(1)?, *m.get(k)?.get(2)?));
        Some(DMat3::from_cols(row(0)?, row(1)?, row(2)?).transpose())
    };
    let srgb = DMat3::from_cols(
        DVec3::new(3.2404542, -0.9692660, 0.0556434),
        DVec3::new(-1.5371385, 1.8760108, -0.2040259),
        DVec3::new(-0.4985314, 0.0415560, 1.0572252),
    );
    let xyz_to_rgb = bake.manifest.colour.matrices.get("xyz_to_rgb").and_then(|m| rows(m));
    match xyz_to_rgb {
        Some(m) if bake.manifest.colour.space != "srgb" && m.determinant().abs() > 1e-9 => srgb * m.inverse(),
        _ => DMat3::IDENTITY,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A number is an EV100, `auto` may be shifted, and nothing else is taken.
    #[test]
    fn exposures_in_words() {
        assert_eq!("14.5".parse::<Exposure>().unwrap(), Exposure::Ev100(14.5));
        assert_eq!("auto".parse::<Exposure>().unwrap(), Exposure::Auto(0.0));
        assert_eq!("auto-2".parse::<Exposure>().unwrap(), Exposure::Auto(-2.0));
        for wrong in ["", "bright", "auto2x", "nan", "1e9"] {
            assert!(wrong.parse::<Exposure>().is_err(), "{wrong}");
        }
    }
}
