//! Where light is: a coarse picture of the direct and the diffuse light in the shell that only steers the
//! sampling. Every weight is exact, so an error in here costs time and no truth.

use super::shells::Shells;
use glam::DVec3;
use std::f64::consts::PI;

/// Sun angles of the transmittance, per shell.
const SUNS: usize = 64;
/// Altitudes and sun angles at which diffuse light is learnt.
const BANDS: usize = 16;
pub(super) const ANGLES: usize = 25;
/// Bins of directions: cosine of the zenith angle, and half a turn of azimuth from the sun's.
pub(super) const ZENITHS: usize = 12;
pub(super) const AZIMUTHS: usize = 4;
pub(super) const BINS: usize = ZENITHS * AZIMUTHS;
/// Smallest diffuse light that sampling counts with, relative to the brightest at the same sun angle.
const FLOOR: f64 = 0.02;

pub(super) struct Guide {
    /// Transmittance to the sun in the middle of each shell, at even steps of √((mu_s − horizon)/(1 − horizon)).
    sun: Vec<[f64; SUNS]>,
    /// Cosine of the horizon's zenith angle in the middle of each shell.
    horizon: Vec<f64>,
    /// The band of each shell.
    band: Vec<usize>,
    /// Radius in the middle of each band, m.
    pub radii: Vec<f64>,
    /// Mean radiance over all directions, per band and sun angle, 1/sr.
    diffuse: Vec<[f64; ANGLES]>,
    /// Probability up to each bin of directions, per band and sun angle.
    directions: Vec<Option<[f64; BINS]>>,
}

impl Guide {
    /// Direct light, and a first guess of diffuse light.
    pub(super) fn new(shells: &Shells) -> Self {
        let count = shells.count();
        let middle = |k: usize| (0.5 * (shells.edges2[k] + shells.edges2[k + 1])).sqrt();
        let bands = BANDS.min(count);
        let band: Vec<usize> = (0..count).map(|k| k * bands / count).collect();
        let mut guide = Guide {
            sun: Vec::new(),
            horizon: Vec::new(),
            band,
            radii: Vec::new(),
            diffuse: Vec::new(),
            directions: Vec::new(),
        };
        for k in 0..count {
            let r = middle(k);
            let horizon = -(1.0 - shells.ground2() / (r * r)).sqrt();
            let transmittance = |j: usize| {
                let s = j as f64 / (SUNS - 1) as f64;
                // Just above the horizon, where the ray is not blocked yet.
                let mu = horizon + (1.0 - horizon) * (s * s).max(1e-9);
                shells.depth_to_space(r * r, k, r * mu).map_or(0.0, |t| libm::exp(-t))
            };
            guide.sun.push(std::array::from_fn(transmittance));
            guide.horizon.push(horizon);
        }
        for b in 0..bands {
            let inside: Vec<usize> = (0..count).filter(|&k| guide.band[k] == b).collect();
            guide.radii.push(middle(inside[inside.len() / 2]));
        }
        let first: [f64; ANGLES] =
            std::array::from_fn(|a| 0.03 * guide.transmittance(count - 1, sun_angle(a)).max(1e-3));
        guide.diffuse = vec![first; bands];
        guide.directions = vec![None; bands * ANGLES];
        guide
    }

    /// Takes over what the radiance was found to be in each bin of directions (bands × sun angles).
    pub(super) fn learn(&mut self, radiance: &[[f64; BINS]]) {
        for a in 0..ANGLES {
            let mean = |b: usize| {
                let bins = &radiance[b * ANGLES + a];
                (0..BINS).map(|i| bins[i] * solid_angle(i)).sum::<f64>() / (4.0 * PI)
            };
            let means: Vec<f64> = (0..self.radii.len()).map(mean).collect();
            let most = means.iter().copied().fold(1e-12, f64::max);
            for (b, m) in means.iter().enumerate() {
                self.diffuse[b][a] = m.max(FLOOR * most);
                self.directions[b * ANGLES + a] = distribution(&radiance[b * ANGLES + a]);
            }
        }
    }

    /// Transmittance to the sun somewhere in a shell.
    #[inline]
    pub(super) fn transmittance(&self, shell: usize, mu_s: f64) -> f64 {
        let h = self.horizon[shell];
        let v = (mu_s - h) / (1.0 - h);
        if v <= 0.0 {
            return 0.0;
        }
        let s = v.min(1.0).sqrt() * (SUNS - 1) as f64;
        let j = (s as usize).min(SUNS - 2);
        let t = s - j as f64;
        let row = &self.sun[shell];
        row[j] + t * (row[j + 1] - row[j])
    }

    /// Mean diffuse radiance somewhere in a shell, 1/sr.
    #[inline]
    pub(super) fn diffuse(&self, shell: usize, mu_s: f64) -> f64 {
        let s = place(mu_s);
        let j = (s as usize).min(ANGLES - 2);
        let t = s - j as f64;
        let row = &self.diffuse[self.band[shell]];
        row[j] + t * (row[j + 1] - row[j])
    }

    /// The distribution of directions at a place, where one was learnt.
    #[inline]
    pub(super) fn directions(&self, shell: usize, mu_s: f64) -> Option<&[f64; BINS]> {
        let a = ((place(mu_s) + 0.5) as usize).min(ANGLES - 1);
        self.directions[self.band[shell] * ANGLES + a].as_ref()
    }
}

fn distribution(bins: &[f64; BINS]) -> Option<[f64; BINS]> {
    let total: f64 = (0..BINS).map(|i| bins[i] * solid_angle(i)).sum();
    if total <= 0.0 {
        return None;
    }
    let mut sum = 0.0;
    Some(std::array::from_fn(|i| {
        // A tenth goes evenly to all directions.
        sum += 0.9 * bins[i] * solid_angle(i) / total + 0.1 * solid_angle(i) / (4.0 * PI);
        sum
    }))
}

const BEND: f64 = 0.15;

/// Cosine of the sun's zenith angle of grid line `a`: closest together at the horizon.
pub(super) fn sun_angle(a: usize) -> f64 {
    let y = (2.0 * a as f64 / (ANGLES - 1) as f64 - 1.0) / (1.0 + BEND);
    BEND * y / (1.0 - y.abs())
}

/// Where between the grid lines a sun angle lies.
#[inline]
fn place(mu_s: f64) -> f64 {
    let y = mu_s / (mu_s.abs() + BEND) * (1.0 + BEND);
    (0.5 * (y + 1.0) * (ANGLES - 1) as f64).clamp(0.0, (ANGLES - 1) as f64)
}

/// Zenith cosine at the lower side of row `i`: rows are even in √|mu|, so closest at the horizon.
#[inline]
fn row_edge(i: usize) -> f64 {
    let y = 2.0 * i as f64 / ZENITHS as f64 - 1.0;
    y * y.abs()
}

fn solid_angle(bin: usize) -> f64 {
    let row = bin / AZIMUTHS;
    (row_edge(row + 1) - row_edge(row)) * 2.0 * PI / AZIMUTHS as f64
}

/// Horizontal axis towards the sun and one across it, at an upward direction.
fn horizontal(up: DVec3, sun: DVec3) -> (DVec3, DVec3) {
    let flat = sun - up * up.dot(sun);
    let along = flat.try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
    (along, up.cross(along))
}

/// A direction inside a bin, from two numbers between 0 and 1.
pub(super) fn direction_in(bin: usize, up: DVec3, sun: DVec3, u: f64, v: f64) -> DVec3 {
    let row = bin / AZIMUTHS;
    let mu = row_edge(row) + u * (row_edge(row + 1) - row_edge(row));
    let half = PI * ((bin % AZIMUTHS) as f64 + (2.0 * v).fract()) / AZIMUTHS as f64;
    let azimuth = if v < 0.5 { half } else { -half };
    let (along, across) = horizontal(up, sun);
    let sine = (1.0 - mu * mu).max(0.0).sqrt();
    let (s, c) = libm::sincos(azimuth);
    (up * mu + along * (sine * c) + across * (sine * s)).normalize()
}

/// Draws a direction.
pub(super) fn sample(cumulative: &[f64; BINS], up: DVec3, sun: DVec3, u: f64, v: f64) -> DVec3 {
    let bin = cumulative.partition_point(|&c| c <= u).min(BINS - 1);
    let low = if bin > 0 { cumulative[bin - 1] } else { 0.0 };
    let rest = ((u - low) / (cumulative[bin] - low)).clamp(0.0, 1.0);
    direction_in(bin, up, sun, rest, v)
}

/// Density of [`sample`], 1/sr.
pub(super) fn density(cumulative: &[f64; BINS], up: DVec3, sun: DVec3, direction: DVec3) -> f64 {
    let mu = direction.dot(up);
    let y = 0.5 * (mu.signum() * mu.abs().sqrt() + 1.0) * ZENITHS as f64;
    let row = (y.max(0.0) as usize).min(ZENITHS - 1);
    let (along, across) = horizontal(up, sun);
    let azimuth = libm::atan2(direction.dot(across).abs(), direction.dot(along));
    let column = ((azimuth / PI * AZIMUTHS as f64) as usize).min(AZIMUTHS - 1);
    let bin = row * AZIMUTHS + column;
    let low = if bin > 0 { cumulative[bin - 1] } else { 0.0 };
    (cumulative[bin] - low) / solid_angle(bin)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The density of drawn directions is what the weights divide by: the mean of 1/density over draws is
    /// the whole sphere, 4π, and every draw lies in the bin that its density is looked up in.
    #[test]
    fn directions_are_drawn_with_their_density() {
        let bins: [f64; BINS] = std::array::from_fn(|i| 0.1 + ((7 * i) % 11) as f64);
        let cumulative = distribution(&bins).expect("light");
        let up = DVec3::new(0.2, 0.5, -0.8).normalize();
        let sun = DVec3::new(0.9, -0.1, 0.3).normalize();
        const N: usize = 256;
        let mut sum = 0.0;
        for i in 0..N {
            for j in 0..N {
                let (u, v) = ((i as f64 + 0.5) / N as f64, (j as f64 + 0.5) / N as f64);
                let d = sample(&cumulative, up, sun, u, v);
                let bin = cumulative.partition_point(|&c| c <= u).min(BINS - 1);
                let low = if bin > 0 { cumulative[bin - 1] } else { 0.0 };
                let expected = (cumulative[bin] - low) / solid_angle(bin);
                let found = density(&cumulative, up, sun, d);
                assert!((found / expected - 1.0).abs() < 1e-9);
                sum += 1.0 / found;
            }
        }
        let mean = sum / (N * N) as f64;
        assert!((mean / (4.0 * PI) - 1.0).abs() < 0.02, "{mean}");
    }

    /// Sun angles of the grid are found again where they lie.
    #[test]
    fn sun_angles_round_trip() {
        for a in 0..ANGLES {
            assert!((place(sun_angle(a)) - a as f64).abs() < 1e-9);
        }
    }
}
