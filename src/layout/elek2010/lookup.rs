//! Look-ups in the paper's layout.

use crate::error::Result;
use crate::geometry::Point;
use crate::layout::sky::volume::{Plane, Volume, enter, outside, sun_at_ground};
use crate::layout::sky::{AerosolPhase, Channels, Component, Sky, Source, multiply};
use std::f64::consts::{FRAC_1_PI, PI};

/// The layout of Elek & Kmoch 2010 in memory.
pub struct Elek2010Sky {
    scattering: Volume,
    depth: Plane,
    irradiance: Plane,
    /// None where nothing scatters.
    phase: Option<Plane>,
    aerosol_row: usize,
    ground_albedo: Vec<f64>,
    /// Rows R, G, B from the four wavelengths, over the star's illuminance.
    rgb: Vec<Vec<f64>>,
    illuminance: f64,
}

impl Elek2010Sky {
    pub(in crate::internals::layout) fn new(source: &Source) -> Result<Self> {
        let illuminance = source.number("star_illuminance_lx")?;
        let rgb = source.matrix("rgb_from_four")?;
        Ok(Elek2010Sky {
            scattering: source.volume("scattering")?,
            depth: source.plane("transmittance")?,
            irradiance: source.plane("irradiance")?,
            phase: if source.has("phase") { Some(source.plane("phase")?) } else { None },
            aerosol_row: source.number("elek2010_aerosol_phase_row")? as usize,
            ground_albedo: source.constant("ground_albedo_at_four")?,
            rgb: rgb.iter().map(|row| row.iter().map(|v| v / illuminance).collect()).collect(),
            illuminance,
        })
    }

    /// Linear RGB over the star's illuminance, 1/sr (I_F = I_S + I_P e^−t of the paper's §5).
    fn colour(&self, point: &Point, component: Component, phase: AerosolPhase) -> [f64; 3] {
        let Some(place) = enter(point, self.scattering.mapping()) else { return [0.0; 3] };
        let mut out = [0.0; 3];
        if component != Component::Ground
            && let Some([r, g, b, aerosol]) = self.scattering.at(&place)
        {
            let sunlight = self.depth.sunlight(place.altitude, place.mu_s);
            let direct =
                multiply(&self.rgb, &self.with_phase(sunlight, place.nu, phase)[..self.rgb[0].len()]);
            for (c, gas) in [r, g, b].into_iter().enumerate() {
                out[c] += gas / self.illuminance + aerosol * direct[c].max(0.0);
            }
        }
        if component != Component::Scattering && place.hits_ground {
            let through = self.depth.depth(place.altitude, place.mu, true).map(|d| libm::exp(-d));
            let ground = self.ground(sun_at_ground(&place, self.scattering.mapping()), &through);
            (0..3).for_each(|c| out[c] += ground[c]);
        }
        out
    }

    fn with_phase(&self, sunlight: [f64; 4], nu: f64, phase: AerosolPhase) -> [f64; 4] {
        match phase {
            AerosolPhase::Isotropic => sunlight.map(|t| t / (4.0 * PI)),
            AerosolPhase::Preset => {
                let Some(phase) = &self.phase else { return [0.0; 4] };
                let p = phase.at((0.5 * (1.0 - nu)).max(0.0).sqrt(), self.aerosol_row);
                std::array::from_fn(|k| sunlight[k] * p[k])
            }
        }
    }

    /// Ground light that arrives: direct light attenuated per wavelength, ambient light per RGB.
    fn ground(&self, mu_s: f64, through: &[f64; 4]) -> [f64; 3] {
        let count = self.ground_albedo.len();
        let sunlight = self.depth.sunlight(0.0, mu_s);
        let direct: Vec<f64> =
            (0..count).map(|k| self.ground_albedo[k] * sunlight[k] * mu_s.max(0.0) * through[k]).collect();
        let direct = multiply(&self.rgb, &direct);
        let ambient = match self.scattering.mapping().sun_coordinate(mu_s) {
            Some(x) => self.irradiance.at(x, 0),
            None => [0.0; 4],
        };
        let reflected: Vec<f64> = (0..count).map(|k| self.ground_albedo[k] * through[k]).collect();
        let (reflected, white) = (multiply(&self.rgb, &reflected), multiply(&self.rgb, &vec![1.0; count]));
        std::array::from_fn(|c| {
            let ambient = ambient[c] / self.illuminance * (reflected[c] / white[c]).max(0.0);
            FRAC_1_PI * (direct[c].max(0.0) + ambient)
        })
    }
}

impl Sky for Elek2010Sky {
    fn channels(&self) -> Channels {
        Channels::Rgb
    }

    fn outside(&self, point: &Point) -> Option<(&'static str, f64, String)> {
        outside(point, self.scattering.mapping())
    }

    fn radiance(&self, point: &Point, component: Component, phase: AerosolPhase) -> Vec<f64> {
        self.colour(point, component, phase).to_vec()
    }

    fn sunlight(&self, altitude: f64, mu_s: f64) -> [f64; 3] {
        multiply(&self.rgb, &self.depth.sunlight(altitude, mu_s)[..self.rgb[0].len()])
    }

    fn rgb(&self, point: &Point, component: Component) -> [f64; 3] {
        self.colour(point, component, AerosolPhase::Preset)
    }
}
