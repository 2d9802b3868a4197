//! Paths: backwards from the observer, with the sun's light added at every event.

use super::angles;
use super::guide;
use super::random::Numbers;
use super::scene::{Scene, Segment};
use glam::DVec3;
use std::f64::consts::PI;

/// Orders that are counted one by one; the sum of all is counted apart.
pub const ORDERS: usize = 12;

/// Part of the estimate of the whole below which the light still to be gathered is left to chance.
const ROULETTE: f64 = 0.05;

/// What one path found, 1/sr.
#[derive(Clone, Copy, Default)]
pub struct Light {
    pub total: f64,
    pub orders: [f64; ORDERS],
}

impl Light {
    #[inline]
    fn add(&mut self, event: usize, light: f64) {
        self.total += light;
        if event <= ORDERS {
            self.orders[event - 1] += light;
        }
    }

    pub fn accumulate(&mut self, other: &Light) {
        self.total += other.total;
        for (a, b) in self.orders.iter_mut().zip(&other.orders) {
            *a += b;
        }
    }
}

/// Buffers of a path, kept between paths.
#[derive(Default)]
pub struct Scratch {
    segment: Segment,
    scattering: Vec<f64>,
}

/// Where a path may go on from: the factor of the light that arrives there.
struct Event {
    weight: f64,
    position: DVec3,
    shell: usize,
    /// Estimate of the mean radiance there, 1/sr.
    diffuse: f64,
    mu_s: f64,
}

/// Follows one path along a camera ray, up to `orders` events.
pub fn follow(
    scene: &Scene,
    camera: &Segment,
    sun: DVec3,
    orders: usize,
    numbers: &mut Numbers,
    scratch: &mut Scratch,
) -> Light {
    let mut light = Light::default();
    let mut weight = 1.0;
    let mut reference = 0.0;
    let Scratch { segment, scattering } = scratch;
    for event in 1..=orders {
        let from = if event == 1 { camera } else { &*segment };
        let [u_place, u_choice, u, v] = numbers.event();
        let ground = ground_event(scene, from, sun, weight);
        let air = air_event(scene, from, sun, weight, u_place, scattering);
        if let Some((e, direct)) = &ground {
            light.add(event, e.weight * direct);
        }
        if let Some((e, direct)) = &air {
            light.add(event, e.weight * direct);
        }
        if event == orders {
            break;
        }
        if event == 1 {
            reference = from.expected() + ground.as_ref().map_or(0.0, |(e, d)| e.weight * (d + e.diffuse));
        }
        let hope = |e: &Option<(Event, f64)>| e.as_ref().map_or(0.0, |(e, _)| e.weight * e.diffuse);
        let (hope_ground, hope_air) = (hope(&ground), hope(&air));
        let hope = hope_ground + hope_air;
        let survival = (hope / (ROULETTE * reference)).min(1.0);
        if hope <= 0.0 || (survival < 1.0 && numbers.uniform() >= survival) {
            break;
        }
        let share = hope_ground / hope;
        let looking = from.direction;
        let (e, direction, factor) = if u_choice < share {
            let e = ground.expect("has hope").0;
            let (direction, factor) = leave_ground(scene, &e, sun, u_choice / share, u, v);
            (e, direction, factor / share)
        } else {
            let e = air.expect("has hope").0;
            let choice = (u_choice - share) / (1.0 - share);
            let (direction, factor) = scatter(scene, &e, looking, sun, scattering, choice, u, v);
            (e, direction, factor / (1.0 - share))
        };
        weight = e.weight * factor / survival;
        if weight <= 0.0 {
            break;
        }
        segment.aim(scene, e.position, e.shell, direction, sun);
    }
    light
}

/// The ground at a ray's end and the sun's light from there per weight, 1/sr.
fn ground_event(scene: &Scene, from: &Segment, sun: DVec3, weight: f64) -> Option<(Event, f64)> {
    if !from.ray.hits_ground || scene.albedo <= 0.0 {
        return None;
    }
    let position = from.place(from.ray.end).normalize() * scene.ground_radius;
    let mu_s = position.dot(sun) / scene.ground_radius;
    let direct = if mu_s > 0.0 {
        // From the ground's exact radius, which rounding may have moved the position off.
        let depth = scene.shells.depth_to_space(scene.ground2(), 0, mu_s * scene.ground_radius);
        depth.map_or(0.0, |t| libm::exp(-t)) * mu_s / PI
    } else {
        0.0
    };
    let weight = weight * scene.albedo * libm::exp(-from.ray.depth);
    let diffuse = scene.guide.diffuse(0, mu_s);
    Some((Event { weight, position, shell: 0, diffuse, mu_s }, direct))
}

/// A scattering place on a ray and the sun's light from there per weight, 1/sr. Leaves the scattering
/// coefficients, as shares of their sum, in `scattering`.
fn air_event(
    scene: &Scene,
    from: &Segment,
    sun: DVec3,
    weight: f64,
    u: f64,
    scattering: &mut Vec<f64>,
) -> Option<(Event, f64)> {
    if from.expected() <= 0.0 {
        return None;
    }
    let (cell, x, density) = from.sample(u);
    let depth = cell.before + from.ray.cell_depth(&scene.shells, cell.shell, cell.from, x);
    let radius2 = from.ray.b2 + x * x;
    let across = scene.shells.across(cell.shell, radius2);
    scattering.clear();
    scattering.extend((0..from.phase.len()).map(|i| scene.shells.scattering(cell.shell, i, across)));
    let sum: f64 = scattering.iter().sum();
    if sum <= 0.0 {
        return None;
    }
    let mut phase = 0.0;
    for (s, p) in scattering.iter_mut().zip(&from.phase) {
        *s /= sum;
        phase += *s * p;
    }
    let position = from.place(x);
    let along = position.dot(sun);
    let sunlight = scene.shells.depth_to_space(radius2, cell.shell, along).map_or(0.0, |t| libm::exp(-t));
    let mu_s = along / radius2.sqrt();
    let diffuse = scene.guide.diffuse(cell.shell, mu_s);
    let weight = weight * sum * libm::exp(-depth) / density;
    Some((Event { weight, position, shell: cell.shell, diffuse, mu_s }, phase * sunlight))
}

/// Share of directions that follow the learnt light, and of those that follow the glow around the sun.
const GUIDED: f64 = 0.4;
const AUREOLE: f64 = 0.3;

/// A direction to look into next after scattering, and phase function / density of it.
fn scatter(
    scene: &Scene,
    event: &Event,
    looking: DVec3,
    sun: DVec3,
    shares: &[f64],
    choice: f64,
    u: f64,
    v: f64,
) -> (DVec3, f64) {
    let up = event.position.normalize();
    let learnt = scene.guide.directions(event.shell, event.mu_s);
    let guided = if learnt.is_some() { GUIDED } else { 0.0 };
    let aureole = aureole_share(scene, event, shares);
    let direction = match learnt {
        Some(l) if choice < guided => guide::sample(l, up, sun, u, v),
        _ => {
            let axis = if choice < guided + aureole { sun } else { looking };
            let low = if choice < guided + aureole { guided } else { guided + aureole };
            let width = if choice < guided + aureole { aureole } else { 1.0 - guided - aureole };
            let i = pick(shares, (choice - low) / width);
            angles::around(axis, scene.angles[i].sample(u), v)
        }
    };
    let phase = |axis: DVec3| {
        let nu = direction.dot(axis).clamp(-1.0, 1.0);
        shares.iter().zip(&scene.phases).map(|(s, p)| s * p.value(nu)).sum::<f64>()
    };
    let wanted = phase(looking);
    let mut density = (1.0 - guided - aureole) * wanted;
    if aureole > 0.0 {
        density += aureole * phase(sun);
    }
    if let Some(l) = learnt {
        density += guided * guide::density(l, up, sun, direction);
    }
    (direction, wanted / density)
}

fn aureole_share(scene: &Scene, event: &Event, shares: &[f64]) -> f64 {
    let peaked: f64 = shares.iter().zip(&scene.peaked).filter(|(_, p)| **p).map(|(s, _)| s).sum();
    let lit = scene.guide.transmittance(event.shell, event.mu_s);
    AUREOLE * peaked * lit / (lit + 0.1)
}

fn pick(shares: &[f64], choice: f64) -> usize {
    let mut rest = choice;
    for (i, s) in shares.iter().enumerate() {
        if rest < *s {
            return i;
        }
        rest -= s;
    }
    // Rounding left a little over: the last that scatters at all.
    shares.iter().rposition(|s| *s > 0.0).unwrap_or(0)
}

/// A direction to look into next from the ground, and cosine law / density of it.
fn leave_ground(scene: &Scene, event: &Event, sun: DVec3, choice: f64, u: f64, v: f64) -> (DVec3, f64) {
    let up = event.position.normalize();
    let learnt = scene.guide.directions(0, event.mu_s);
    let guided = if learnt.is_some() { GUIDED } else { 0.0 };
    let direction = match learnt {
        Some(l) if choice < guided => guide::sample(l, up, sun, u, v),
        _ => angles::around(up, u.sqrt(), v),
    };
    let cosine = direction.dot(up);
    if cosine <= 0.0 {
        return (direction, 0.0);
    }
    let wanted = cosine / PI;
    let mut density = (1.0 - guided) * wanted;
    if let Some(l) = learnt {
        density += guided * guide::density(l, up, sun, direction);
    }
    (direction, wanted / density)
}
