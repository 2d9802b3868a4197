//! The medium as Algorithm 1 sees it: coefficients in lanes, and optical depth to the top as a table, the
//! paper's extinction texture (§5).

use crate::error::{Error, Result};
use crate::machine::lanes::{Lanes, WIDTH};
use crate::mapping::{Array, Elek2010, texel};
use crate::medium::{DensityProfile, Medium, PhaseFunction, Role};
use std::f64::consts::PI;

/// Index of the gas in every pair of species.
pub(super) const GAS: usize = 0;
/// Index of the aerosol in every pair of species.
pub(super) const AEROSOL: usize = 1;

/// Intervals of the quadrature of a column; even, for Simpson's rule.
const COLUMN_INTERVALS: usize = 128;

/// A phase function a + b ν², 1/sr: isotropic or Rayleigh, each wavelength with its own King factor.
#[derive(Clone, Copy)]
pub(super) struct Quadratic {
    a: Lanes,
    b: Lanes,
}

impl Quadratic {
    #[inline(always)]
    pub(super) fn value(&self, nu: f32) -> Lanes {
        self.a + self.b * (nu * nu)
    }
}

/// One constituent: where it is, what it removes, what it scatters and as which species.
struct Part {
    density: DensityProfile,
    extinction: Lanes,
    scattering: Lanes,
    species: usize,
    /// Column from a place to the top, m at density 1, over [altitude, distance to the top].
    columns: Array<f64, 2>,
}

/// The medium at up to sixteen wavelengths.
pub(super) struct Air {
    parts: Vec<Part>,
    /// Mapping of `columns`; only the sky half of its view axis is used.
    map: Elek2010,
    /// F of gas and aerosol.
    pub phase: [Quadratic; 2],
    /// Lambertian ground: albedo / π, 1/sr.
    pub reflectance: Lanes,
}

impl Air {
    /// Refuses what the paper's method has no place for: more than sixteen wavelengths, a gas that is not
    /// Rayleigh (or isotropic), an aerosol that is not isotropic.
    pub(super) fn new(medium: &Medium, extinction_size: [usize; 2]) -> Result<Self> {
        let wavelengths = medium.wavelengths_nm.len();
        if wavelengths > WIDTH {
            return Err(Error::Argument(format!(
                "the literal method takes {WIDTH} wavelengths at a time, not {wavelengths}"
            )));
        }
        let [altitudes, distances] = extinction_size;
        let map = Elek2010::new(medium.ground_radius, medium.top_radius, [altitudes, 2 * distances, 2, 2])
            .ok_or_else(|| Error::Argument("the extinction table needs at least 2 × 2 texels".into()))?;
        let parts = medium.constituents.iter().map(|c| Part {
            density: c.density.clone(),
            extinction: Lanes::from_f64(&(0..wavelengths).map(|w| c.extinction(w)).collect::<Vec<_>>()),
            scattering: Lanes::from_f64(&c.scattering),
            species: if c.role == Role::Gas { GAS } else { AEROSOL },
            columns: columns(&map, medium.ground_radius, [altitudes, distances], &c.density),
        });
        Ok(Air {
            parts: parts.collect(),
            map,
            phase: [species_phase(medium, Role::Gas)?, species_phase(medium, Role::Aerosol)?],
            reflectance: Lanes::from_f64(&medium.ground_albedo.iter().map(|a| a / PI).collect::<Vec<_>>()),
        })
    }

    /// σ ρ of gas and aerosol at an altitude, 1/m.
    pub(super) fn scattering(&self, altitude: f64) -> [Lanes; 2] {
        let mut sum = [Lanes::ZERO; 2];
        for part in &self.parts {
            sum[part.species] += part.scattering * part.density.at(altitude) as f32;
        }
        sum
    }

    /// Optical depth of a path, from the column (m at density 1) of each constituent's density along it.
    #[inline(always)]
    pub(super) fn depth(&self, column: impl Fn(&DensityProfile) -> f64) -> Lanes {
        let mut sum = Lanes::ZERO;
        for part in &self.parts {
            sum += part.extinction * column(&part.density) as f32;
        }
        sum
    }

    /// e^−t from a place to the sun (Eq. 6), 0 behind the planet.
    #[inline(always)]
    pub(super) fn sunlight(&self, altitude: f64, mu_s: f64) -> Lanes {
        if self.map.hits_ground(altitude, mu_s) {
            return Lanes::ZERO;
        }
        let [altitudes, distances] = self.parts.first().map_or([2, 2], |p| p.columns.shape());
        let place = [
            texel(self.map.altitude_coordinate(altitude), altitudes),
            texel(self.map.view_coordinate(altitude, mu_s, false), distances),
        ];
        let mut minus_depth = Lanes::ZERO;
        for part in &self.parts {
            minus_depth += part.extinction * -(part.columns.interpolate(&place) as f32);
        }
        minus_depth.exp()
    }
}

impl Air {
    /// Whether anything of a species scatters.
    pub(super) fn has(&self, species: usize) -> bool {
        self.parts.iter().any(|p| p.species == species && p.scattering != Lanes::ZERO)
    }
}

/// The phase function that all scatterers of a role share, as a + b ν²; zero where there is none.
fn species_phase(medium: &Medium, role: Role) -> Result<Quadratic> {
    let (mut a, mut b) = (Lanes::ZERO, Lanes::ZERO);
    let mut scatterers = medium.constituents.iter().filter(|c| c.role == role && c.scatters());
    let Some(first) = scatterers.next() else {
        return Ok(Quadratic { a, b });
    };
    for (w, phase) in first.phase.iter().enumerate() {
        let fits = match phase {
            PhaseFunction::Isotropic => true,
            PhaseFunction::Rayleigh { .. } => role == Role::Gas,
            _ => false,
        };
        if !fits || scatterers.clone().any(|c| c.phase[w] != *phase) {
            return Err(Error::Argument(format!(
                "{}: the literal method has one Rayleigh phase function for the gas and isotropic aerosols \
                 (Eq. 16); this is {phase:?}",
                first.name
            )));
        }
        a[w] = phase.value(0.0) as f32;
        b[w] = (phase.value(1.0) - phase.value(0.0)) as f32;
    }
    Ok(Quadratic { a, b })
}

/// ∫ density ds to the top for rays that miss the ground, m, over [altitude, distance to the top].
fn columns(map: &Elek2010, ground_radius: f64, shape: [usize; 2], density: &DensityProfile) -> Array<f64, 2> {
    Array::fill(shape, |[i, j]| {
        let altitude = map.altitude(i);
        let (mu, _) = map.mu(altitude, shape[1] + j);
        let length = map.distance(altitude, mu, false);
        let radius = ground_radius + altitude;
        if mu >= 0.0 {
            return rising_column(density, radius, altitude, mu, length);
        }
        // Downwards first: both ways from the lowest point, where the ray is horizontal.
        let to_lowest = -radius * mu;
        let lowest = altitude_along(radius, altitude, mu, to_lowest).max(0.0);
        let rising = |length| rising_column(density, ground_radius + lowest, lowest, 0.0, length);
        rising(to_lowest) + rising(length - to_lowest)
    })
}

/// ∫ density ds from a point, upwards: Simpson's rule in t with s = length · t², dense at the low end.
fn rising_column(density: &DensityProfile, radius: f64, altitude: f64, mu: f64, length: f64) -> f64 {
    let integrand = |k: usize| {
        let t = k as f64 / COLUMN_INTERVALS as f64;
        density.at(altitude_along(radius, altitude, mu, length * t * t)) * 2.0 * length * t
    };
    simpson(COLUMN_INTERVALS, 1.0, integrand)
}

/// Composite Simpson's rule over `intervals` (even) of a range `width`, values given by their number.
pub(super) fn simpson(intervals: usize, width: f64, value: impl Fn(usize) -> f64) -> f64 {
    let inner: f64 = (1..intervals).map(|k| (2.0 + 2.0 * (k % 2) as f64) * value(k)).sum();
    (value(0) + inner + value(intervals)) * width / (3.0 * intervals as f64)
}

/// Altitude at a distance `s` along a ray, m, without the difference of two radii.
#[inline]
pub fn altitude_along(radius: f64, altitude: f64, mu: f64, s: f64) -> f64 {
    altitude + s * (s + 2.0 * radius * mu) / (radius + radius_along(radius, mu, s))
}

/// Radius at a distance `s` along a ray, m.
#[inline]
pub fn radius_along(radius: f64, mu: f64, s: f64) -> f64 {
    (radius * radius + s * (s + 2.0 * radius * mu)).max(0.0).sqrt()
}
