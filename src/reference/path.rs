//! Paths: backwards from the observer, with the sun's light added at every event.

use super::angles;
use super::guide;
use super::random::{Numbers, Stream};
use super::scene::{Scene, Segment};
use glam::DVec3;
use std::f64::consts::PI;

/// Orders that are counted one by one; the sum of all is counted apart.
pub const ORDERS: usize = 12;

/// Window of the light still expected of a path, as parts of the estimate of the whole: below it, chance
/// decides whether the path goes on; above it, it goes on as several. Without the upper end the weights of
/// hundreds of events would spread without bound in thick air.
const WINDOW: (f64, f64) = (0.05, 1.5);
/// Copies of a path at most, at one event and in all.
const COPIES: (usize, usize) = (16, 4096);

/// What one path found, 1/sr.
#[derive(Clone, Copy, Default)]
pub(super) struct Light {
    pub total: f64,
    pub orders: [f64; ORDERS],
    /// Estimate of the light of more events than were followed.
    pub left: f64,
}

impl Light {
    #[inline]
    fn add(&mut self, event: usize, light: f64) {
        self.total += light;
        if event <= ORDERS {
            self.orders[event - 1] += light;
        }
    }

    pub(super) fn accumulate(&mut self, other: &Light) {
        self.total += other.total;
        for (a, b) in self.orders.iter_mut().zip(&other.orders) {
            *a += b;
        }
    }
}

/// Buffers of a path, kept between paths.
#[derive(Default)]
pub(super) struct Scratch {
    segment: Segment,
    /// Share of each constituent in the scattering at the last event in the air.
    shares: Vec<f64>,
    pending: Vec<Start>,
}

/// Where a path may go on from: the factor of the light that arrives there.
#[derive(Clone, Copy)]
struct Event {
    weight: f64,
    position: DVec3,
    shell: usize,
    /// Estimate of the mean radiance there, 1/sr.
    diffuse: f64,
    mu_s: f64,
}

impl Event {
    /// Estimate of the light that is still to come by way of this event, 1/sr.
    fn hope(&self) -> f64 {
        self.weight * self.diffuse
    }
}

/// The next ray of a path, or of a copy of it.
#[derive(Clone, Copy)]
struct Start {
    weight: f64,
    position: DVec3,
    shell: usize,
    direction: DVec3,
    /// Events before.
    events: usize,
    /// Copies draw numbers that belong to no sequence.
    copy: bool,
    stream: Stream,
}

/// Follows one path along a camera ray, up to `orders` events.
pub(super) fn follow(
    scene: &Scene,
    camera: &Segment,
    sun: DVec3,
    orders: usize,
    (numbers, stream): (Numbers, Stream),
    scratch: &mut Scratch,
) -> Light {
    let mut light = Light::default();
    let Scratch { segment, shares, pending } = scratch;
    pending.clear();
    let mut walk = Walk { scene, sun, orders, reference: 0.0, copies: 0, numbers, shares, pending };
    walk.ray(camera, 1.0, 1, false, stream, &mut light);
    while let Some(s) = walk.pending.pop() {
        segment.aim(scene, s.position, s.shell, s.direction, sun);
        walk.ray(segment, s.weight, s.events + 1, s.copy, s.stream, &mut light);
    }
    light
}

/// A path on its way.
struct Walk<'a> {
    scene: &'a Scene,
    sun: DVec3,
    orders: usize,
    /// Estimate of all the light that the camera ray sees, 1/sr.
    reference: f64,
    copies: usize,
    numbers: Numbers,
    shares: &'a mut Vec<f64>,
    pending: &'a mut Vec<Start>,
}

impl Walk<'_> {
    /// Adds the sun's light from event number `event` on a ray and lays out how the path goes on.
    fn ray(
        &mut self,
        from: &Segment,
        weight: f64,
        event: usize,
        copy: bool,
        mut stream: Stream,
        light: &mut Light,
    ) {
        let numbers = self.numbers.event(event - 1, copy, &mut stream);
        let ground = ground_event(self.scene, from, self.sun, weight);
        let air = air_event(self.scene, from, self.sun, weight, numbers[0], self.shares);
        for (e, direct) in ground.iter().chain(&air) {
            light.add(event, e.weight * direct);
        }
        if event == 1 {
            self.reference = from.expected() + ground.map_or(0.0, |(e, d)| e.weight * (d + e.diffuse));
        }
        let (ground, air) = (ground.map(|g| g.0), air.map(|a| a.0));
        let hope = ground.map_or(0.0, |e| e.hope()) + air.map_or(0.0, |e| e.hope());
        if event == self.orders {
            light.left += hope;
            return;
        }
        let part = hope / self.reference;
        let (all, factor) = if part < WINDOW.0 {
            if stream.uniform() * WINDOW.0 >= part {
                return;
            }
            (1, WINDOW.0 / part)
        } else {
            let wanted = ((part / WINDOW.1).ceil() as usize).clamp(1, COPIES.0);
            let all = wanted.min(1 + COPIES.1 - self.copies);
            (all, 1.0 / all as f64)
        };
        self.copies += all - 1;
        for k in 0..all {
            let numbers = if k == 0 { numbers } else { self.numbers.event(event - 1, true, &mut stream) };
            let (copy, stream) = (copy || k > 0, stream.branch());
            self.go_on(ground, air, from.direction, event, numbers, copy, factor, stream);
        }
    }

    /// Goes on from the ground or the air, as each promises light.
    fn go_on(
        &mut self,
        ground: Option<Event>,
        air: Option<Event>,
        looking: DVec3,
        events: usize,
        [_, choice, u, v]: [f64; 4],
        copy: bool,
        factor: f64,
        stream: Stream,
    ) {
        let hope_ground = ground.map_or(0.0, |e| e.hope());
        let share = hope_ground / (hope_ground + air.map_or(0.0, |e| e.hope()));
        let (e, direction, weight) = match (ground, air) {
            (Some(e), _) if choice < share => {
                let (direction, w) =
                    leave_ground(self.scene, &e, self.sun, steering(events), choice / share, u, v);
                (e, direction, w / share)
            }
            (_, Some(e)) => {
                let rest = (choice - share) / (1.0 - share);
                let (direction, w) =
                    scatter(self.scene, &e, looking, self.sun, self.shares, steering(events), rest, u, v);
                (e, direction, w / (1.0 - share))
            }
            _ => return,
        };
        let weight = e.weight * weight * factor;
        if weight > 0.0 {
            let Event { position, shell, .. } = e;
            self.pending.push(Start { weight, position, shell, direction, events, copy, stream });
        }
    }
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
/// coefficients, as shares of their sum, in `shares`.
fn air_event(
    scene: &Scene,
    from: &Segment,
    sun: DVec3,
    weight: f64,
    u: f64,
    shares: &mut Vec<f64>,
) -> Option<(Event, f64)> {
    if from.expected() <= 0.0 {
        return None;
    }
    let (cell, x, density) = from.sample(u);
    let depth = cell.before + from.ray.cell_depth(&scene.shells, cell.shell, cell.from, x);
    let radius2 = from.ray.b2 + x * x;
    let across = scene.shells.across(cell.shell, radius2);
    shares.clear();
    shares.extend((0..from.phase.len()).map(|i| scene.shells.scattering(cell.shell, i, across)));
    let sum: f64 = shares.iter().sum();
    if sum <= 0.0 {
        return None;
    }
    let mut phase = 0.0;
    for (s, p) in shares.iter_mut().zip(&from.phase) {
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
const GUIDED: f64 = 0.35;
const AUREOLE: f64 = 0.3;
/// Events after which these shares fall with the square of the number of events: where light has been
/// scattered often it comes evenly, and weights other than 1 only add up.
const STEERED: f64 = 4.0;

fn steering(events: usize) -> f64 {
    let s = (STEERED / events as f64).min(1.0);
    s * s
}

/// A direction to look into next after scattering, and phase function / density of it.
fn scatter(
    scene: &Scene,
    event: &Event,
    looking: DVec3,
    sun: DVec3,
    shares: &[f64],
    steering: f64,
    choice: f64,
    u: f64,
    v: f64,
) -> (DVec3, f64) {
    let up = event.position.normalize();
    let learnt = scene.guide.directions(event.shell, event.mu_s);
    let guided = if learnt.is_some() { GUIDED * steering } else { 0.0 };
    let aureole = steering * aureole_share(scene, event, shares);
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
fn leave_ground(
    scene: &Scene,
    event: &Event,
    sun: DVec3,
    steering: f64,
    choice: f64,
    u: f64,
    v: f64,
) -> (DVec3, f64) {
    let up = event.position.normalize();
    let learnt = scene.guide.directions(0, event.mu_s);
    let guided = if learnt.is_some() { GUIDED * steering } else { 0.0 };
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
