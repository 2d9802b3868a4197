//! One wavelength of a planet, prepared for tracing, and single rays in it with their sampling weights.

use super::angles::ScatteringAngle;
use super::guide::Guide;
use super::ray::{Cell, Ray};
use super::shells::Shells;
use crate::medium::{Medium, PhaseFunction};
use glam::DVec3;

pub(super) struct Scene {
    pub shells: Shells,
    pub guide: Guide,
    pub ground_radius: f64,
    pub albedo: f64,
    /// Per constituent that scatters.
    pub phases: Vec<PhaseFunction>,
    pub angles: Vec<ScatteringAngle>,
    /// Whether its scattering is peaked enough forward for the sky to be brightest around the sun.
    pub peaked: Vec<bool>,
}

impl Scene {
    pub(super) fn new(medium: &Medium, wavelength: usize) -> Self {
        let shells = Shells::new(medium, wavelength);
        let phases: Vec<PhaseFunction> =
            shells.scatterers.iter().map(|&i| medium.constituents[i].phase[wavelength].clone()).collect();
        Scene {
            guide: Guide::new(&shells),
            ground_radius: medium.ground_radius,
            albedo: medium.ground_albedo[wavelength],
            angles: phases.iter().map(ScatteringAngle::new).collect(),
            peaked: phases.iter().map(|p| p.mean_cosine() > 0.25).collect(),
            phases,
            shells,
        }
    }

    /// Transmittance to the sun from a place in a shell.
    pub(super) fn sunlight(&self, position: DVec3, shell: usize, sun: DVec3) -> f64 {
        let depth = self.shells.depth_to_space(position.length_squared(), shell, position.dot(sun));
        depth.map_or(0.0, |t| libm::exp(-t))
    }

    /// Squared radius of the ground, m².
    pub(super) fn ground2(&self) -> f64 {
        self.shells.ground2()
    }
}

/// A ray with what sampling a place on it needs.
#[derive(Default)]
pub(super) struct Segment {
    pub origin: DVec3,
    pub direction: DVec3,
    pub ray: Ray,
    /// Phase function of each scatterer at the angle between this ray and the sun, 1/sr.
    pub phase: Vec<f64>,
    /// Sum of the cells' weights up to each: estimates of the light that reaches the ray's start, 1/sr.
    cumulative: Vec<f64>,
}

/// How far apart the cells of a camera ray may be: as a part of its length, and in optical depth.
const FINE_LENGTH: f64 = 1.0 / 192.0;
const FINE_DEPTH: f64 = 0.05;

impl Segment {
    /// A ray from a place in the atmosphere, with weights from the guide.
    pub(super) fn aim(&mut self, scene: &Scene, origin: DVec3, shell: usize, direction: DVec3, sun: DVec3) {
        self.point(scene, origin, shell, direction, sun);
        self.weigh(scene, sun, |scene, cell, _, mu_s| scene.guide.transmittance(cell.shell, mu_s));
    }

    /// The same for the camera, finer and with the true sunlight in each cell's middle.
    pub(super) fn aim_finely(&mut self, scene: &Scene, origin: DVec3, direction: DVec3, sun: DVec3) {
        self.point(scene, origin, scene.shells.find(origin.length_squared()), direction, sun);
        let length = (self.ray.end - self.ray.start) * FINE_LENGTH;
        self.ray.subdivide(&scene.shells, length, FINE_DEPTH);
        self.weigh(scene, sun, |scene, cell, place, mu_s| {
            // The true sunlight can vanish where the cell's edge is lit: never weigh it as nothing.
            let guide = scene.guide.transmittance(cell.shell, mu_s);
            scene.sunlight(place, cell.shell, sun).max(0.01 * guide)
        });
    }

    fn point(&mut self, scene: &Scene, origin: DVec3, shell: usize, direction: DVec3, sun: DVec3) {
        self.origin = origin;
        self.direction = direction;
        self.ray.trace(&scene.shells, origin.length_squared(), shell, origin.dot(direction));
        let nu = direction.dot(sun).clamp(-1.0, 1.0);
        self.phase.clear();
        self.phase.extend(scene.phases.iter().map(|p| p.value(nu)));
    }

    fn weigh(&mut self, scene: &Scene, sun: DVec3, sunlight: impl Fn(&Scene, &Cell, DVec3, f64) -> f64) {
        self.cumulative.clear();
        let (mut sum, mut before) = (0.0, 1.0);
        for cell in &self.ray.cells {
            let x = 0.5 * (cell.from + cell.to);
            let radius2 = self.ray.b2 + x * x;
            let place = self.place(x);
            let mu_s = place.dot(sun) / radius2.sqrt();
            let t = sunlight(scene, cell, place, mu_s);
            let diffuse = scene.guide.diffuse(cell.shell, mu_s);
            let u = scene.shells.across(cell.shell, radius2);
            let mut source = 0.0;
            for (i, p) in self.phase.iter().enumerate() {
                source += scene.shells.scattering(cell.shell, i, u) * (p * t + diffuse);
            }
            let (through, mean) = cell.rough_transmittance();
            sum += source * (cell.to - cell.from) * before * mean;
            before *= through;
            self.cumulative.push(sum);
        }
    }

    #[inline]
    pub(super) fn place(&self, x: f64) -> DVec3 {
        self.origin + self.direction * (x - self.ray.start)
    }

    /// Estimate of the scattered light that reaches the ray's start, 1/sr; 0 where nothing scatters.
    pub(super) fn expected(&self) -> f64 {
        self.cumulative.last().copied().unwrap_or(0.0)
    }

    /// Cell, signed path and density (1/m) of a scattering place.
    pub(super) fn sample(&self, u: f64) -> (&Cell, f64, f64) {
        let total = self.expected();
        let at = u * total;
        let k = self.cumulative.partition_point(|&c| c <= at).min(self.cumulative.len() - 1);
        let low = if k > 0 { self.cumulative[k - 1] } else { 0.0 };
        let weight = self.cumulative[k] - low;
        let cell = &self.ray.cells[k];
        let (x, density) = cell.sample(((at - low) / weight).clamp(0.0, 1.0));
        (cell, x, density * weight / total)
    }
}
