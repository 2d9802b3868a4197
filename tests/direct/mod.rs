//! Direct integration of orders 1 and 2 at one wavelength, in Cartesian f64 with midpoint rules: nothing of
//! the library but the medium's numbers. The ground is a sphere around the origin.

use std::f64::consts::PI;
use tyndall::internals::medium::{DensityProfile, Medium, PhaseFunction, Role};

pub type Vector = [f64; 3];

pub struct Planet {
    ground: f64,
    top: f64,
    albedo: f64,
    /// Scale height, scattering, extinction, species.
    parts: Vec<(f64, f64, f64, usize)>,
    phases: [PhaseFunction; 2],
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn ahead(p: Vector, v: Vector, s: f64) -> Vector {
    [p[0] + s * v[0], p[1] + s * v[1], p[2] + s * v[2]]
}

impl Planet {
    pub fn new(medium: &Medium, w: usize) -> Self {
        let mut phases = [PhaseFunction::Isotropic, PhaseFunction::Isotropic];
        let mut parts = Vec::new();
        for c in &medium.constituents {
            let species = usize::from(c.role == Role::Aerosol);
            let DensityProfile::Exponential { scale_height } = c.density else { panic!("exponential only") };
            phases[species] = c.phase[w].clone();
            parts.push((scale_height, c.scattering[w], c.scattering[w] + c.absorption[w], species));
        }
        let (ground, top) = (medium.ground_radius, medium.top_radius);
        Planet { ground, top, albedo: medium.ground_albedo[w], parts, phases }
    }

    /// Position, view and sun vectors; the sun in the x–z plane.
    pub fn place(&self, altitude: f64, mu: f64, mu_s: f64, cos_azimuth: f64) -> (Vector, Vector, Vector) {
        let sin = |c: f64| (1.0 - c * c).max(0.0).sqrt();
        let view = [sin(mu) * cos_azimuth, sin(mu) * sin(cos_azimuth), mu];
        ([0.0, 0.0, self.ground + altitude], view, [sin(mu_s), 0.0, mu_s])
    }

    /// Distance to the ground or the top, and whether it is the ground.
    fn end(&self, p: Vector, v: Vector) -> (f64, bool) {
        let (b, c) = (dot(p, v), dot(p, p));
        let ground = b * b - c + self.ground * self.ground;
        if b < 0.0 && ground > 0.0 {
            return ((-b - ground.sqrt()).max(0.0), true);
        }
        ((-b + (b * b - c + self.top * self.top).max(0.0).sqrt()).max(0.0), false)
    }

    fn extinction(&self, p: Vector) -> f64 {
        let altitude = dot(p, p).sqrt() - self.ground;
        self.parts.iter().map(|(h, _, extinction, _)| extinction * libm::exp(-altitude / h)).sum()
    }

    fn scattering(&self, p: Vector) -> [f64; 2] {
        let altitude = dot(p, p).sqrt() - self.ground;
        let mut sum = [0.0; 2];
        for (h, scattering, _, species) in &self.parts {
            sum[*species] += scattering * libm::exp(-altitude / h);
        }
        sum
    }

    fn depth(&self, p: Vector, v: Vector, length: f64, steps: usize) -> f64 {
        let step = length / steps as f64;
        (0..steps).map(|k| self.extinction(ahead(p, v, (k as f64 + 0.5) * step)) * step).sum()
    }

    /// Transmittance to the sun, 0 behind the planet. The point is lifted by a millimetre, so that rounding
    /// does not put a point of the ground in its own shadow.
    fn sunlight(&self, p: Vector, sun: Vector, steps: usize) -> f64 {
        let lift = 1.0 + 1e-3 / dot(p, p).sqrt();
        let p = p.map(|x| x * lift);
        match self.end(p, sun) {
            (_, true) => 0.0,
            (length, false) => libm::exp(-self.depth(p, sun, length, steps)),
        }
    }

    /// Single scattering by gas and aerosol, and sunlight off the ground, along a ray.
    pub fn single(&self, p: Vector, v: Vector, sun: Vector, steps: usize) -> ([f64; 2], f64) {
        let (length, hits) = self.end(p, v);
        let (step, mut depth, mut sum) = (length / steps as f64, 0.0, [0.0; 2]);
        for k in 0..steps {
            let here = ahead(p, v, (k as f64 + 0.5) * step);
            let thickness = self.extinction(here) * step;
            let light = libm::exp(-depth - 0.5 * thickness) * self.sunlight(here, sun, 120.min(steps)) * step;
            for (s, sigma) in self.scattering(here).into_iter().enumerate() {
                sum[s] += light * sigma * self.phases[s].value(dot(v, sun));
            }
            depth += thickness;
        }
        let mut ground = 0.0;
        if hits {
            let at = ahead(p, v, length);
            let mu_s = (dot(at, sun) / self.ground).max(0.0);
            ground = self.albedo / PI * mu_s * self.sunlight(at, sun, 2 * 120.min(steps)) * libm::exp(-depth);
        }
        (sum, ground)
    }

    /// Order 2 by gas and aerosol along a ray: all light of order 1, the ground's too, scattered once more.
    pub fn second(&self, p: Vector, v: Vector, sun: Vector) -> [f64; 2] {
        const STEPS: usize = 32;
        let (length, _) = self.end(p, v);
        let (step, mut depth, mut sum) = (length / STEPS as f64, 0.0, [0.0; 2]);
        for k in 0..STEPS {
            let here = ahead(p, v, (k as f64 + 0.5) * step);
            let thickness = self.extinction(here) * step;
            let gathered = self.gathered(here, v, sun);
            for (s, sigma) in self.scattering(here).into_iter().enumerate() {
                sum[s] += libm::exp(-depth - 0.5 * thickness) * sigma * gathered[s] * step;
            }
            depth += thickness;
        }
        sum
    }

    fn gathered(&self, p: Vector, v: Vector, sun: Vector) -> [f64; 2] {
        let mut sum = [0.0; 2];
        self.sphere(p, |direction, weight| {
            let (air, ground) = self.single(p, direction, sun, 24);
            for s in 0..2 {
                sum[s] += self.phases[s].value(dot(v, direction)) * (air[0] + air[1] + ground) * weight;
            }
        });
        sum
    }

    /// Irradiance of the ground by order 1 of the sky.
    pub fn sky_irradiance(&self, mu_s: f64) -> f64 {
        let (p, _, sun) = self.place(1e-3, 0.0, mu_s, 1.0);
        let mut sum = 0.0;
        self.sphere(p, |direction, weight| {
            if direction[2] > 0.0 {
                let (air, _) = self.single(p, direction, sun, 60);
                sum += (air[0] + air[1]) * direction[2] * weight;
            }
        });
        sum
    }

    /// Calls with directions and solid angles around a point, the zenith angle split at its horizon.
    fn sphere(&self, p: Vector, mut each: impl FnMut(Vector, f64)) {
        const RINGS: usize = 12;
        const AZIMUTHS: usize = 16;
        let r = dot(p, p).sqrt();
        let up = p.map(|x| x / r);
        // Any two horizontal axes: up crossed with y, and the third.
        let norm = (up[0] * up[0] + up[2] * up[2]).sqrt();
        let x = [up[2] / norm, 0.0, -up[0] / norm];
        let y = [up[1] * x[2] - up[2] * x[1], up[2] * x[0] - up[0] * x[2], up[0] * x[1] - up[1] * x[0]];
        let horizon = PI - libm::asin((self.ground / r).min(1.0));
        for (from, to) in [(0.0, horizon), (horizon, PI)] {
            for a in 0..RINGS {
                let step = (to - from) / RINGS as f64;
                let zenith = from + (a as f64 + 0.5) * step;
                let (sin, cos) = (libm::sin(zenith), libm::cos(zenith));
                for b in 0..AZIMUTHS {
                    let azimuth = 2.0 * PI * (b as f64 + 0.5) / AZIMUTHS as f64;
                    let (c, s) = (sin * libm::cos(azimuth), sin * libm::sin(azimuth));
                    let direction = [0, 1, 2].map(|i| c * x[i] + s * y[i] + cos * up[i]);
                    each(direction, sin * step * 2.0 * PI / AZIMUTHS as f64);
                }
            }
        }
    }

    /// Direct sunlight on the ground.
    pub fn direct_irradiance(&self, mu_s: f64) -> f64 {
        let (p, _, sun) = self.place(0.0, 0.0, mu_s, 1.0);
        if mu_s > 0.0 { mu_s * self.sunlight(p, sun, 400) } else { 0.0 }
    }

    /// Power of the direct beam that passes the planet through its air, per unit irradiance, m².
    pub fn beam_past_the_limb(&self) -> f64 {
        const STEPS: usize = 320;
        let step = (self.top - self.ground) / STEPS as f64;
        (0..STEPS)
            .map(|k| {
                let b = self.ground + (k as f64 + 0.5) * step;
                let start = [-(self.top * self.top - b * b).sqrt(), 0.0, b];
                2.0 * PI * b * step * libm::exp(-self.depth(start, [1.0, 0.0, 0.0], -2.0 * start[0], 400))
            })
            .sum()
    }
}
