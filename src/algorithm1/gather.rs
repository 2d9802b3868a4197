//! Integrals over directions: light gathered at a point (Eq. 9) and on the ground (Eq. 10), by the regular
//! trapezoidal rule in zenith angle and azimuth.

use super::air::{AEROSOL, GAS};
use super::ray::{Ray, Sample};
use super::{Air, Solver};
use crate::machine::isa;
use crate::machine::lanes::Lanes;
use crate::mapping::{Array, Elek2010, Texel, texel};
use std::f64::consts::PI;

/// Where Eq. 9 is evaluated, and how often it reads the radiance that comes from a direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Gather {
    /// 4D table; once for each point and sun, shared by all views: it does not depend on the view. Same bits.
    PerPoint,
    /// 4D table; once for each texel, as the equation is written and a shader would run it.
    PerTexel,
    /// 2D table over altitude and sun: the view direction is neglected, and with it the phase function (§4.1).
    Mean,
    /// No table: at each sample of Eq. 12 afresh.
    AtSample,
}

/// What Eq. 12 reads of Eq. 9.
pub(super) enum Gathered {
    Table(Array<[Lanes; 2], 4>),
    Mean(Array<[Lanes; 2], 2>),
    /// The light of the last order itself, and the directions to sum it over.
    Field(Array<Lanes, 4>, Vec<Direction>),
}

impl Gathered {
    /// Room for tables of a size.
    pub(super) fn new(gather: Gather, size: [usize; 4], samples: usize) -> Self {
        match gather {
            Gather::PerPoint | Gather::PerTexel => Gathered::Table(Array::zero(size)),
            Gather::Mean => Gathered::Mean(Array::zero([size[0], size[2]])),
            Gather::AtSample => Gathered::Field(Array::zero([0; 4]), directions(samples, PI)),
        }
    }
}

/// A sample ω of a trapezoidal rule over the sphere; x is towards the sun's azimuth, z is up.
pub(super) struct Direction {
    x: f32,
    y: f32,
    z: f32,
    mu: f64,
    cos_azimuth: f64,
    /// dω, sr.
    weight: f32,
}

/// `count` zenith angles from 0 to `widest` and `count` azimuths all around.
fn directions(count: usize, widest: f64) -> Vec<Direction> {
    let (step, step_azimuth) = (widest / (count - 1) as f64, 2.0 * PI / count as f64);
    let mut directions = Vec::with_capacity(count * count);
    for i in 0..count {
        let (sin, mu) = (libm::sin(step * i as f64), libm::cos(step * i as f64));
        let ends = if i == 0 || i + 1 == count { 0.5 } else { 1.0 };
        for j in 0..count {
            let azimuth = step_azimuth * j as f64;
            let cos_azimuth = libm::cos(azimuth);
            directions.push(Direction {
                x: (sin * cos_azimuth) as f32,
                y: (sin * libm::sin(azimuth)) as f32,
                z: mu as f32,
                mu,
                cos_azimuth,
                weight: (ends * sin * step * step_azimuth) as f32,
            });
        }
    }
    directions
}

/// Where the radiance from each direction is found at one altitude: texels of the view and azimuth axes.
fn places(map: &Elek2010, altitude: f64, directions: &[Direction]) -> Vec<[Texel; 2]> {
    let place = |d: &Direction| {
        let view = map.view_texel(altitude, d.mu, map.hits_ground(altitude, d.mu));
        [view, texel(map.azimuth_coordinate(d.cos_azimuth), map.size()[3])]
    };
    directions.iter().map(place).collect()
}

impl Solver<'_> {
    /// TG: light of the last order that is scattered into each view by gas and by aerosol, per unit of
    /// scattering, 1/sr (Eq. 9).
    pub(super) fn gather(&self, ts_delta: &Array<Lanes, 4>, gathered: &mut Gathered) {
        match gathered {
            Gathered::Table(tg) => self.gather_views(ts_delta, tg),
            Gathered::Mean(tg) => self.gather_mean(ts_delta, tg),
            Gathered::Field(last, _) => last.clone_from(ts_delta),
        }
    }

    /// I_G of gas and aerosol at a sample of a ray (Eq. 9): from its table, or summed there; none where it is dark.
    #[inline(always)]
    pub(super) fn gathered_at(
        &self,
        gathered: &Gathered,
        ray: &Ray,
        sample: &Sample,
        mu_s: f64,
        nu: f64,
    ) -> Option<[Lanes; 2]> {
        match gathered {
            Gathered::Table(tg) => ray.place(&self.map, sample, mu_s, nu).map(|p| tg.interpolate(&p)),
            Gathered::Mean(tg) => {
                ray.place(&self.map, sample, mu_s, nu).map(|[u, _, w, _]| tg.interpolate(&[u, w]))
            }
            Gathered::Field(last, directions) => {
                let (mu_s, cos_azimuth) = ray.sun_at(sample, mu_s, nu);
                let (u, w) = (sample.u, texel(self.map.sun_coordinate(mu_s)?, self.map.size()[2]));
                let view = unit(sample.mu, cos_azimuth);
                let places = places(&self.map, sample.altitude, directions);
                let light = |d: usize| {
                    let [v, r]: [Texel; 2] = places[d];
                    last.interpolate(&[u, v, w, r]) * directions[d].weight
                };
                Some(scattered_into(&self.air, directions, view, &light))
            }
        }
    }

    /// TG without its view direction: as scattered by an isotropic phase function, over [altitude, sun].
    fn gather_mean(&self, ts_delta: &Array<Lanes, 4>, tg: &mut Array<[Lanes; 2], 2>) {
        let directions = directions(self.settings.samples, PI);
        tg.for_each_slab(|i, suns| {
            let places = places(&self.map, self.map.altitude(i), &directions);
            let point =
                Point { i, map: &self.map, air: &self.air, ts_delta, places, directions: &directions };
            for (k, out) in suns.iter_mut().enumerate() {
                let mut sum = Lanes::ZERO;
                for d in 0..directions.len() {
                    sum += point.light(k, d);
                }
                let mean = sum * (0.25 / PI) as f32;
                let scatters = |species: usize| if self.air.has(species) { mean } else { Lanes::ZERO };
                *out = [scatters(GAS), scatters(AEROSOL)];
            }
        });
    }

    fn gather_views(&self, ts_delta: &Array<Lanes, 4>, tg: &mut Array<[Lanes; 2], 4>) {
        let directions = directions(self.settings.samples, PI);
        tg.for_each_slab(|i, slab| {
            let places = places(&self.map, self.map.altitude(i), &directions);
            let point =
                Point { i, map: &self.map, air: &self.air, ts_delta, places, directions: &directions };
            for k in 0..self.settings.size[2] {
                isa::run(
                    #[inline(always)]
                    || point.gather(k, self.settings.gather == Gather::PerPoint, slab),
                );
            }
        });
    }

    /// TAΔ: irradiance of the ground by light of the last order, per texel of the sun axis (Eq. 10).
    pub(super) fn ambient(&self, ts_delta: &Array<Lanes, 4>) -> Vec<Lanes> {
        let directions = directions(self.settings.samples, 0.5 * PI);
        let places = places(&self.map, 0.0, &directions);
        let point = Point { i: 0, map: &self.map, air: &self.air, ts_delta, places, directions: &directions };
        (0..self.settings.size[2])
            .map(|k| {
                let mut sum = Lanes::ZERO;
                for (d, direction) in directions.iter().enumerate() {
                    sum += point.light(k, d) * direction.z;
                }
                sum
            })
            .collect()
    }
}

/// A point at altitude texel `i`, and the light that reaches it.
struct Point<'a> {
    i: usize,
    map: &'a Elek2010,
    air: &'a Air,
    ts_delta: &'a Array<Lanes, 4>,
    places: Vec<[Texel; 2]>,
    directions: &'a [Direction],
}

impl Point<'_> {
    /// I_S dω from direction number `d` at sun texel `k`.
    #[inline(always)]
    fn light(&self, k: usize, d: usize) -> Lanes {
        let [view, azimuth] = self.places[d];
        self.ts_delta.interpolate(&[(self.i, 0.0), view, (k, 0.0), azimuth]) * self.directions[d].weight
    }

    /// All views at sun texel `k`, written into the point's slab [views, suns, azimuths]; the light is read `once`
    /// for all of them.
    #[inline(always)]
    fn gather(&self, k: usize, once: bool, slab: &mut [[Lanes; 2]]) {
        if once {
            let field: Vec<Lanes> = (0..self.directions.len())
                .map(
                    #[inline(always)]
                    |d| self.light(k, d),
                )
                .collect();
            self.views(
                k,
                slab,
                #[inline(always)]
                |d| field[d],
            );
        } else {
            self.views(
                k,
                slab,
                #[inline(always)]
                |d| self.light(k, d),
            );
        }
    }

    #[inline(always)]
    fn views(&self, k: usize, slab: &mut [[Lanes; 2]], light: impl Fn(usize) -> Lanes) {
        let [_, views, suns, azimuths] = self.map.size();
        for j in 0..views {
            let (mu, _) = self.map.mu(self.map.altitude(self.i), j);
            for l in 0..azimuths {
                let view = unit(mu, self.map.cos_azimuth(l));
                slab[(j * suns + k) * azimuths + l] = scattered_into(self.air, self.directions, view, &light);
            }
        }
    }
}

/// A direction by its zenith cosine and the cosine of its azimuth, in the axes of [`Direction`].
#[inline(always)]
fn unit(mu: f64, cos_azimuth: f64) -> [f32; 3] {
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    let sin_azimuth = (1.0 - cos_azimuth * cos_azimuth).max(0.0).sqrt();
    [(sin * cos_azimuth) as f32, (sin * sin_azimuth) as f32, mu as f32]
}

/// I_G of gas and aerosol for one view direction (Eq. 9), `light` being I_S dω by the number of the direction. The
/// aerosol is isotropic (§4.2): F leaves the sum.
#[inline(always)]
fn scattered_into(
    air: &Air,
    directions: &[Direction],
    view: [f32; 3],
    light: &impl Fn(usize) -> Lanes,
) -> [Lanes; 2] {
    let mut sum = [Lanes::ZERO; 2];
    for (d, w) in directions.iter().enumerate() {
        let light = light(d);
        let nu = view[0] * w.x + view[1] * w.y + view[2] * w.z;
        sum[GAS] += air.phase[GAS].value(nu) * light;
        sum[AEROSOL] += light;
    }
    [sum[GAS], sum[AEROSOL] * air.phase[AEROSOL].value(0.0)]
}
