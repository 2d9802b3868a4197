//! Monte Carlo for water under a flat surface: what the slab solver is held against.
//!
//! Paths run backwards from above the surface: refracted in, scattered, mirrored by the underside, thrown back by
//! the bed; at every event the refracted sunbeam is added with its exact transmittance, and a path that finds its
//! way out meets the sky, even or a planet's own. It shares the medium with the solver and no line of its transport, Fresnel and Snell
//! included.

use super::Tracer;
use super::angles::ScatteringAngle;
use super::path::{Scratch, follow};
use super::random::{Numbers, Stream};
use super::scene::Segment;
use crate::geometry::Point;
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
    /// Both together.
    pub total: (f64, f64),
}

/// A planet's air over the water: its sun, weakened, and its sky, of which each path that leaves the water follows
/// one path of the air's own tracer.
pub struct Air<'a> {
    tracer: &'a Tracer,
    sun: DVec3,
    /// Transmittance from the water to the sun.
    direct: f64,
}

impl<'a> Air<'a> {
    /// The sun at this zenith cosine, of irradiance 1 on a plane normal to its beam outside the air.
    pub fn new(tracer: &'a Tracer, mu_s: f64) -> Self {
        let towards = Point { altitude: 0.0, mu: mu_s, mu_s, azimuth_deg: 0.0 };
        let direct = if mu_s > 0.0 { libm::exp(-tracer.optical_depth(&towards)) } else { 0.0 };
        Air { tracer, sun: DVec3::new((1.0 - mu_s * mu_s).max(0.0).sqrt(), 0.0, mu_s), direct }
    }

    /// Radiance of the sky from a direction, by one path.
    fn sky(&self, towards: DVec3, numbers: (Numbers, Stream), buffers: &mut (Segment, Scratch)) -> f64 {
        let scene = &self.tracer.scene;
        let origin = DVec3::new(0.0, 0.0, scene.ground_radius);
        let (camera, scratch) = buffers;
        camera.aim(scene, origin, scene.shells.find(origin.length_squared()), towards, self.sun);
        follow(scene, camera, self.sun, usize::MAX, numbers, scratch).total
    }
}

/// Told apart from paths in the water.
const AIR_SEED: u64 = 0x61_69_72;

/// A body of water at one wavelength, ready to be traced.
pub struct WaterTracer {
    n: f64,
    extinction: f64,
    albedo: f64,
    depth: f64,
    bed: f64,
    /// Times that light is scattered in the water at most.
    most: usize,
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
            most: usize::MAX,
            kinds: kinds.collect(),
        }
    }

    /// The same without light that is scattered in the water more than `orders` times.
    pub fn first(self, orders: usize) -> Self {
        WaterTracer { most: orders, ..self }
    }

    /// Radiance that leaves along a look, from `paths` paths; the same seed gives the same bits.
    pub fn leaving(&self, look: Look, source: Source, paths: u64, seed: u64) -> Leaving {
        let (sun, even) = match source {
            Source::Sun(mu) => (Some((mu, 1.0)), 0.0),
            Source::Sky => (None, 1.0 / PI),
        };
        self.replicates(paths, |replicate, path, _| {
            self.follow(look, sun, |_| even, Numbers::new(seed, replicate, path).1)
        })
    }

    /// The same under a planet's air, over the irradiance of its star.
    pub fn leaving_under(&self, air: &Air, look: Look, paths: u64, seed: u64) -> Leaving {
        let sun = Some((air.sun.z, air.direct));
        self.replicates(paths, |replicate, path, buffers| {
            let numbers = || Numbers::new(seed ^ AIR_SEED, replicate, path);
            let sky = |towards| air.sky(towards, numbers(), buffers);
            self.follow(look, sun, sky, Numbers::new(seed, replicate, path).1)
        })
    }

    /// Mean and standard error of what `one` finds for replicate and path.
    fn replicates(
        &self,
        paths: u64,
        one: impl Fn(u64, u64, &mut (Segment, Scratch)) -> [f64; 2] + Sync,
    ) -> Leaving {
        let each = paths.div_ceil(REPLICATES).max(1);
        let sums: Vec<[f64; 2]> = (0..REPLICATES)
            .into_par_iter()
            .map(|r| {
                let mut sum = [0.0; 2];
                let mut buffers = (Segment::default(), Scratch::default());
                for path in 0..each {
                    let light = one(r, path, &mut buffers);
                    sum = [sum[0] + light[0], sum[1] + light[1]];
                }
                sum.map(|s| s / each as f64)
            })
            .collect();
        let of = |pick: &dyn Fn(&[f64; 2]) -> f64| {
            let n = REPLICATES as f64;
            let mean = sums.iter().map(pick).sum::<f64>() / n;
            let scatter = sums.iter().map(|s| (pick(s) - mean) * (pick(s) - mean)).sum::<f64>() / (n - 1.0);
            (mean, (scatter / n).sqrt())
        };
        Leaving { water: of(&|s| s[0]), seabed: of(&|s| s[1]), total: of(&|s| s[0] + s[1]) }
    }

    /// Light of one path that never met the bed, and that did.
    /// `sun`: its cosine and irradiance; `sky`: its radiance from a direction.
    fn follow(
        &self,
        look: Look,
        sun: Option<(f64, f64)>,
        mut sky: impl FnMut(DVec3) -> f64,
        mut random: Stream,
    ) -> [f64; 2] {
        let azimuth = look.azimuth.unwrap_or_else(|| 2.0 * PI * random.uniform());
        let sine = (1.0 - look.mu * look.mu).max(0.0).sqrt() / self.n;
        let (s, c) = libm::sincos(azimuth);
        let mut direction = DVec3::new(sine * c, sine * s, -(1.0 - sine * sine).sqrt());
        let mut weight = (1.0 - self.mirror(-direction.z)) / (self.n * self.n);
        let (mut z, mut met, mut light, mut events) = (0.0, 0, [0.0; 2], 0);
        loop {
            let step = -libm::log(random.uniform()) / self.extinction;
            let next = z - step * direction.z;
            if next <= 0.0 && direction.z > 0.0 {
                let mirrored = self.mirror(direction.z);
                if random.uniform() >= mirrored {
                    let across = direction * self.n;
                    let above = (1.0 - across.x * across.x - across.y * across.y).max(0.0).sqrt();
                    let towards = DVec3::new(across.x, across.y, above);
                    light[met] += weight * self.n * self.n * sky(towards);
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
                light[met] += weight / PI * self.sunlight(sun, z).map_or(0.0, |(e, l)| e * l.z);
            } else {
                z = next;
                events += 1;
                if events > self.most {
                    return light;
                }
                weight *= self.albedo;
                if let Some((e, towards_sun)) = self.sunlight(sun, z) {
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
    fn sunlight(&self, sun: Option<(f64, f64)>, z: f64) -> Option<(f64, DVec3)> {
        let (mu, irradiance) = sun.filter(|s| s.0 > 0.0)?;
        let sine = (1.0 - mu * mu).max(0.0).sqrt() / self.n;
        let cosine = (1.0 - sine * sine).sqrt();
        let entered = irradiance * (1.0 - self.mirror(cosine)) * mu / cosine;
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
