//! Look-ups in the compact layout.

use crate::error::Result;
use crate::geometry::Point;
use crate::layout::sky::volume::{Place, Plane, Volume, enter, outside, sun_at_ground};
use crate::layout::sky::{AerosolPhase, Channels, Component, Sky, Source, multiply};
use crate::mapping::Elek2010;
use std::f64::consts::FRAC_1_PI;

/// The compact layout in memory.
pub struct Compact {
    wavelengths_nm: Vec<f64>,
    singles: Vec<Volume>,
    multiple: Volume,
    depth: Plane,
    /// Optical depth without what only absorbs, where there is such.
    scatterers: Option<Plane>,
    irradiance: Plane,
    phase: Option<Plane>,
    ground_albedo: Vec<f64>,
    /// Rows R, G, B: luminance over the star's illuminance.
    rgb: Vec<Vec<f64>>,
}

impl Compact {
    pub(in crate::internals::layout) fn new(source: &Source) -> Result<Self> {
        // In the order of the phase table's rows, which is that of the manifest.
        let names: Vec<String> = source
            .manifest
            .tables
            .iter()
            .filter(|t| t.layout == source.layout && t.name.starts_with("single_"))
            .map(|t| t.name.clone())
            .collect();
        let illuminance = source.number("star_illuminance_lx")?;
        let rgb = source.matrix("rgb_from_four")?;
        Ok(Compact {
            wavelengths_nm: source.constant("four_wavelengths_nm")?,
            singles: names.iter().map(|n| source.volume(n)).collect::<Result<_>>()?,
            multiple: source.volume("multiple")?,
            depth: source.plane("transmittance")?,
            scatterers: if source.has("scatterers") { Some(source.plane("scatterers")?) } else { None },
            irradiance: source.plane("irradiance")?,
            phase: if names.is_empty() { None } else { Some(source.plane("phase")?) },
            ground_albedo: source.constant("ground_albedo_at_four")?,
            rgb: rgb.iter().map(|row| row.iter().map(|v| v / illuminance).collect()).collect(),
        })
    }

    fn mapping(&self) -> &Elek2010 {
        self.multiple.mapping()
    }

    /// Radiance over solar irradiance at the four wavelengths.
    fn spectrum(&self, point: &Point, component: Component) -> Vec<f64> {
        let count = self.wavelengths_nm.len();
        let Some(place) = enter(point, self.mapping()) else { return vec![0.0; count] };
        let depth = self.depth.depth(place.altitude, place.mu, place.hits_ground);
        let mut out = vec![0.0; count];
        if component != Component::Ground {
            let source = self.mean_source(&place);
            let scatterers = match &self.scatterers {
                Some(plane) => plane.depth(place.altitude, place.mu, place.hits_ground),
                None => depth,
            };
            for k in 0..count {
                out[k] -= libm::expm1(-scatterers[k]) * source[k];
            }
        }
        if component != Component::Scattering && place.hits_ground {
            let ground = self.ground(sun_at_ground(&place, self.mapping()));
            for k in 0..count {
                out[k] += libm::exp(-depth[k]) * ground[k];
            }
        }
        out
    }

    /// Σ p S̄ of single scattering and S̄ of the rest.
    fn mean_source(&self, place: &Place) -> [f64; 4] {
        let mut sum = self.multiple.at(place).unwrap_or([0.0; 4]);
        let angle = (0.5 * (1.0 - place.nu)).max(0.0).sqrt();
        for (row, single) in self.singles.iter().enumerate() {
            let (Some(source), Some(phase)) = (single.at(place), &self.phase) else { continue };
            let phase = phase.at(angle, row);
            for k in 0..4 {
                sum[k] += source[k] * phase[k];
            }
        }
        sum
    }

    /// Radiance of the ground under a sun of zenith cosine `mu_s`.
    fn ground(&self, mu_s: f64) -> [f64; 4] {
        let direct = self.depth.sunlight(0.0, mu_s);
        let diffuse = match self.mapping().sun_coordinate(mu_s) {
            Some(x) => self.irradiance.at(x, 0),
            None => [0.0; 4],
        };
        let mut out = [0.0; 4];
        for (k, albedo) in self.ground_albedo.iter().enumerate() {
            out[k] = albedo * FRAC_1_PI * (direct[k] * mu_s.max(0.0) + diffuse[k]);
        }
        out
    }
}

impl Sky for Compact {
    fn channels(&self) -> Channels {
        Channels::Wavelengths(self.wavelengths_nm.clone())
    }

    fn outside(&self, point: &Point) -> Option<(&'static str, f64, String)> {
        outside(point, self.mapping())
    }

    fn radiance(&self, point: &Point, component: Component, _: AerosolPhase) -> Vec<f64> {
        self.spectrum(point, component)
    }

    fn sunlight(&self, altitude: f64, mu_s: f64) -> [f64; 3] {
        multiply(&self.rgb, &self.depth.sunlight(altitude, mu_s)[..self.wavelengths_nm.len()])
    }

    fn rgb(&self, point: &Point, component: Component) -> [f64; 3] {
        multiply(&self.rgb, &self.spectrum(point, component))
    }
}
