//! Monte Carlo for water under a flat surface: what the slab solver is held against.
//!
//! Paths run backwards from above the surface: refracted in, scattered, mirrored by the underside, thrown back by
//! the bed; at every event the refracted sunbeam is added with its exact transmittance, and a path that finds its
//! way out meets the sky. It shares the medium with the solver and no line of its transport, Fresnel and Snell
//! included.

use super::angles::ScatteringAngle;
use super::random::{Numbers, Stream};
use crate::medium::{PhaseFunction, WaterMedium};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Light that comes down on the water.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// A sun of this zenith cosine, irradiance 1 on a plane normal to its beam above the water.
    Sun(f64),
    /// An evenly bright sky of irradiance 1.
    Sky,
}

/// Where the light arrives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Cosine of the angle between the ray and the vertical, in the air above.
    pub mu: f64,
    /// Azimuth between view and sun, rad; none: the mean over all.
    pub azimuth: Option<f64>,
}

/// Radiance that leaves the water, and standard error: what never met the bed, and what did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leaving {
    pub water: (f64, f64),
    pub seabed: (f64, f64),
}

/// A body of water at one wavelength, ready to be traced.
pub struct WaterTracer {
    n: f64,
    extinction: f64,
    albedo: f64,
    depth: f64,
    bed: f64,
    /// Share of the scattering, phase function and its sampler.
    kinds: Vec<(f64, PhaseFunction, ScatteringAngle)>,
}

/// Independent replicates, whose scatter is the standard error.
const REPLICATES: u64 = 32;
/// Weight below which a path lives on by chance only.
const FAINT: f64 = 0.05;

impl WaterTracer {
    /// Wavelength number `w` of a medium, `depth` metres deep.
    pub fn new(medium: &WaterMedium, w: usize, depth: f64) -> Self {
        let scattering: f64 = medium.scatterers.iter().map(|s| s.scattering[w]).sum();
        let kinds =
            medium.scatterers.iter().filter(|s| s.scattering[w] > 0.0).map(|s| {
                (s.scattering[w] / scattering, s.phase[w].clone(), ScatteringAngle::new(&s.phase[w]))
            });
        let extinction = scattering + medium.absorption[w];
        WaterTracer {
            n: medium.refractive_index[w],
            extinction,
            albedo: if extinction > 0.0 { scattering / extinction } else { 0.0 },
            depth,
            bed: medium.seabed_albedo[w],
            kinds: kinds.collect(),
        }
    }

    /// Radiance that leaves along a look, from `paths` paths; the same seed gives the same bits.
    pub fn leaving(&self, look: Look, source: Source, paths: u64, seed: u64) -> Leaving {
        let each = paths.div_ceil(REPLICATES).max(1);
        let sums: Vec<[f64; 2]> = (0..REPLICATES)
            .into_par_iter()
            .map(|r| {
                let mut sum = [0.0; 2];
                for path in 0..each {
                    let light = self.follow(look, source, Numbers::new(seed, r, path).1);
                    sum = [sum[0] + light[0], sum[1] + light[1]];
                }
                sum.map(|s| s / each as f64)
            })
            .collect();
        let of = |k: usize| {
            let n = REPLICATES as f64;
            let mean = sums.iter().map(|s| s[k]).sum::<f64>() / n;
            let scatter = sums.iter().map(|s| (s[k] - mean) * (s[k] - mean)).sum::<f64>() / (n - 1.0);
            (mean, (scatter / n).sqrt())
        };
        Leaving { water: of(0), seabed: of(1) }
    }

    /// Light of one path that never met the bed, and that did.
    fn follow(&self, look: Look, source: Source, mut random: Stream) -> [f64; 2] {
        let azimuth = look.azimuth.unwrap_or_else(|| 2.0 * PI * random.uniform());
        let sine = (1.0 - look.mu * look.mu).max(0.0).sqrt() / self.n;
        let (s, c) = libm::sincos(azimuth);
        let mut direction = DVec3::new(sine * c, sine * s, -(1.0 - sine * sine).sqrt());
        let mut weight = (1.0 - self.mirror(-direction.z)) / (self.n * self.n);
        let (mut z, mut met, mut light) = (0.0, 0, [0.0; 2]);
        loop {
            let step = -libm::log(random.uniform()) / self.extinction;
            let next = z - step * direction.z;
            if next <= 0.0 && direction.z > 0.0 {
                let mirrored = self.mirror(direction.z);
                if random.uniform() >= mirrored {
                    if source == Source::Sky {
                        light[met] += weight * self.n * self.n / PI;
                    }
                    return light;
                }
                direction.z = -direction.z;
                z = 0.0;
                continue;
            }
            if next >= self.depth {
                met = 1;
                z = self.depth;
                weight *= self.bed;
                direction = cosine_up(&mut random);
                light[met] += weight / PI * self.sunlight(source, z).map_or(0.0, |(e, l)| e * l.z);
            } else {
                z = next;
                weight *= self.albedo;
                if let Some((e, towards_sun)) = self.sunlight(source, z) {
                    light[met] += weight * e * self.phase(direction.dot(towards_sun));
                }
                direction = self.turn(direction, &mut random);
            }
            if weight < FAINT {
                if weight <= 0.0 || random.uniform() >= weight / FAINT {
                    return light;
                }
                weight = FAINT;
            }
        }
    }

    /// Irradiance of the sunbeam normal to it at a depth, and the direction towards the sun in the water.
    fn sunlight(&self, source: Source, z: f64) -> Option<(f64, DVec3)> {
        let Source::Sun(mu) = source else { return None };
        if mu <= 0.0 {
            return None;
        }
        let sine = (1.0 - mu * mu).max(0.0).sqrt() / self.n;
        let cosine = (1.0 - sine * sine).sqrt();
        let entered = (1.0 - self.mirror(cosine)) * mu / cosine;
        Some((entered * libm::exp(-self.extinction * z / cosine), DVec3::new(sine, 0.0, cosine)))
    }

    /// Reflectance of the surface for light of cosine `inside` in the water, by the angles themselves.
    fn mirror(&self, inside: f64) -> f64 {
        let t = libm::acos(inside.clamp(-1.0, 1.0));
        let sine = self.n * libm::sin(t);
        if sine >= 1.0 {
            return if self.n > 1.0 { 1.0 } else { 0.0 };
        }
        let i = libm::asin(sine);
        if (i - t).abs() < 1e-6 {
            let r = (self.n - 1.0) / (self.n + 1.0);
            return if self.n > 1.0 { r * r } else { 0.0 };
        }
        let across = libm::sin(i - t) / libm::sin(i + t);
        let along = libm::tan(i - t) / libm::tan(i + t);
        0.5 * (across * across + along * along)
    }

    fn phase(&self, nu: f64) -> f64 {
        self.kinds.iter().map(|(share, phase, _)| share * phase.value(nu)).sum()
    }

    fn turn(&self, direction: DVec3, random: &mut Stream) -> DVec3 {
        let mut pick = random.uniform();
        let mut kind = &self.kinds[0];
        for k in &self.kinds {
            kind = k;
            if pick < k.0 {
                break;
            }
            pick -= k.0;
        }
        let nu = kind.2.sample(random.uniform());
        let (s, c) = libm::sincos(2.0 * PI * random.uniform());
        let (one, two) = direction.any_orthonormal_pair();
        let sine = (1.0 - nu * nu).max(0.0).sqrt();
        (direction * nu + (one * c + two * s) * sine).normalize()
    }
}

fn cosine_up(random: &mut Stream) -> DVec3 {
    let (u, azimuth) = (random.uniform(), 2.0 * PI * random.uniform());
    let (s, c) = libm::sincos(azimuth);
    let sine = (1.0 - u).sqrt();
    DVec3::new(sine * c, sine * s, u.sqrt())
}
