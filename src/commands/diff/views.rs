//! What two bakes answer at the same views, drawn by regions as those of the quality report.

use super::{Bake, ViewDifference};
use crate::error::{Error, Result};
use crate::geometry::Point;
use crate::layout;
use crate::layout::sky::{self, AerosolPhase, Channels, Component, Sky};
use crate::quality::DARK;
use crate::quality::{Distribution, REGIONS, Region, views};
use crate::spectrum::{delta_e_2000_scaled, invert, multiply};
use rayon::prelude::*;

/// Every layout that both bakes have and that this tool can answer from, region by region.
pub(super) fn compare(a: &Bake, b: &Bake, count: usize) -> Result<Vec<ViewDifference>> {
    let mut out = Vec::new();
    for layout in layout::ALL.map(|layout| layout.name()) {
        let has = |bake: &Bake| bake.manifest.tables.iter().any(|t| t.layout == layout);
        if !(has(a) && has(b)) {
            continue;
        }
        let pair = Pair { one: Eye::open(a, layout)?, other: Eye::open(b, layout)? };
        let shell = [a.constant("ground_radius_m")?, a.constant("top_radius_m")?];
        out.extend(REGIONS.iter().map(|region| pair.region(layout, region, count, shell)));
    }
    Ok(out)
}

/// |b − a| over the larger of the two, and over `floor` at least: 0 to 1 for values of one sign.
pub(super) fn difference(a: f64, b: f64, floor: f64) -> f64 {
    let size = a.abs().max(b.abs()).max(floor);
    if a == b || size == 0.0 { 0.0 } else { (b - a).abs() / size }
}

impl Bake {
    fn constant(&self, name: &str) -> Result<f64> {
        let found = self.manifest.constants.get(name).and_then(|v| v.first()).copied();
        found.ok_or_else(|| Error::file(&self.folder, format!("bake.json: constants.{name} is missing")))
    }
}

/// A layout of a bake with what makes its answers absolute.
struct Eye {
    sky: Box<dyn Sky>,
    /// Of the star at the layout's wavelengths, W/(m² nm); its illuminance, lx, for a layout in colour.
    star: Vec<f64>,
    illuminance: f64,
    to_xyz: [[f64; 3]; 3],
}

impl Eye {
    fn open(bake: &Bake, layout: &str) -> Result<Self> {
        let sky = sky::open(&bake.folder, &bake.manifest, layout)?;
        let illuminance = bake.constant("star_illuminance_lx")?;
        let star = match sky.channels() {
            Channels::Rgb => vec![illuminance; 3],
            Channels::Wavelengths(nm) => star_at(bake, &nm)?,
        };
        let refuse = || Error::file(&bake.folder, "bake.json: colour.matrices.xyz_to_rgb is no 3 × 3 matrix");
        let rows = bake.manifest.colour.matrices.get("xyz_to_rgb").ok_or_else(refuse)?;
        let rows: Vec<[f64; 3]> =
            rows.iter().map(|r| r.as_slice().try_into().ok()).collect::<Option<_>>().ok_or_else(refuse)?;
        let to_xyz = invert(&rows.try_into().map_err(|_| refuse())?);
        Ok(Eye { sky, star, illuminance, to_xyz })
    }

    /// W/(m² sr nm) at the layout's wavelengths; the luminance in cd/m² of one in colour.
    fn radiance(&self, point: &Point) -> Vec<f64> {
        match self.sky.channels() {
            Channels::Rgb => vec![self.xyz(point)[1]],
            Channels::Wavelengths(_) => {
                let light = self.sky.radiance(point, Component::Total, AerosolPhase::Preset);
                light.iter().zip(&self.star).map(|(l, s)| l * s).collect()
            }
        }
    }

    /// cd/m².
    fn xyz(&self, point: &Point) -> [f64; 3] {
        let rgb = self.sky.rgb(point, Component::Total);
        multiply(&self.to_xyz, rgb.map(|v| v * self.illuminance))
    }
}

/// The star's irradiance at some of the bake's wavelengths.
fn star_at(bake: &Bake, nm: &[f64]) -> Result<Vec<f64>> {
    let all = bake.manifest.constants.get("star_irradiance_at_wavelengths_w_m2_nm");
    let at = |w: &f64| {
        let place = bake.manifest.wavelengths.nm.iter().position(|other| other == w)?;
        all?.get(place).copied()
    };
    let found: Option<Vec<f64>> = nm.iter().map(at).collect();
    let reason =
        "bake.json: constants.star_irradiance_at_wavelengths_w_m2_nm lacks a wavelength of the layout";
    found.ok_or_else(|| Error::file(&bake.folder, reason))
}

struct Pair {
    one: Eye,
    other: Eye,
}

impl Pair {
    fn region(&self, layout: &str, region: &Region, count: usize, shell: [f64; 2]) -> ViewDifference {
        let spectral = self.one.sky.channels() == self.other.sky.channels();
        let is_colour = self.one.sky.channels() == Channels::Rgb;
        let by_wavelength = spectral && !is_colour;
        let points = views(region, count, 1, shell[0], shell[1]);
        let both: Vec<(Vec<f64>, Option<f64>)> =
            points.par_iter().map(|p| self.view(p, by_wavelength)).collect();
        ViewDifference {
            layout: layout.into(),
            region: region.name,
            quantity: if by_wavelength { "spectral radiance" } else { "luminance" },
            radiance: Distribution::of(both.iter().flat_map(|v| v.0.iter().copied()).collect()),
            delta_e: Distribution::of(both.iter().filter_map(|v| v.1).collect()),
        }
    }

    /// Relative differences of radiance, and ΔE2000; none where both are dark.
    fn view(&self, point: &Point, by_wavelength: bool) -> (Vec<f64>, Option<f64>) {
        let (one, other) = (self.one.xyz(point), self.other.xyz(point));
        let dark = DARK * self.one.illuminance.max(self.other.illuminance);
        if !(one[1] > dark || other[1] > dark) {
            return (Vec::new(), None);
        }
        // Black against light is as different as colours can be; ΔE2000 scales to the reference and has no number.
        let felt = if one[1] > dark {
            delta_e_2000_scaled(one, other)
        } else {
            delta_e_2000_scaled(other, [0.0; 3])
        };
        let radiance = if by_wavelength {
            let (a, b) = (self.one.radiance(point), self.other.radiance(point));
            let floors = self.one.star.iter().zip(&self.other.star).map(|(s, t)| DARK * s.max(*t));
            a.iter().zip(&b).zip(floors).map(|((a, b), floor)| difference(*a, *b, floor)).collect()
        } else {
            vec![difference(one[1], other[1], dark)]
        };
        (radiance, Some(felt))
    }
}
