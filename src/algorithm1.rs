//! Algorithm 1 of Elek & Kmoch 2010 taken literally: 4D tables of scattered (TS) and gathered light (TG), a
//! regular trapezoidal rule in every integral, one order of scattering at a time, and a correction texture
//! (TC) that takes the ground's light out again. The baseline that the solver is measured against.
//!
//! Where the paper's equations are not followed to the letter, and why:
//! - They keep gas and aerosol apart in everything (Eqs. 7, 9, 12), so that each species scatters its own light
//!   only, light that gas hands to aerosol is lost, and the ground's light R and A is counted twice. Here
//!   the *sum* over the species is gathered, and ground light is counted once. Light last scattered by gas and
//!   by aerosol is told apart in the result only.
//! - A bounce off the ground counts as one event, as in the paper: R belongs to order 1, A^(k−1) to order k.
//! - Phase functions integrate to 1 and a Lambertian ground reflects albedo / π, see the crate's conventions.
//! - The parameterisation is the repaired [`Elek2010`], and optical depth (Eq. 6) is a finer quadrature: the
//!   trapezoidal rule over one horizontal ray would be wrong by a factor before any scattering is computed.
//! - Eq. 9's sphere is not split at the horizon, and 30 equidistant samples stay 30 equidistant samples: those
//!   are the method's own errors, of first order in the step.

mod air;
mod gather;
mod ray;

use crate::error::{Error, Result};
use crate::machine::isa;
use crate::machine::lanes::{Lanes, WIDTH};
use crate::mapping::{Array, Elek2010, texel};
use crate::medium::Medium;
use air::{AEROSOL, Air, GAS};
use gather::Gathered;
use ray::Ray;
use rayon::prelude::*;

pub use air::{altitude_along, radius_along};
pub use gather::Gather;

/// How finely, and how far, Algorithm 1 is run.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Texels of the 4D tables: altitude, view, sun, azimuth.
    pub size: [usize; 4],
    /// Scattering orders K, at least 1.
    pub orders: usize,
    /// Samples of every integral, at least 2.
    pub samples: usize,
    /// Texels of the extinction table: altitude, distance to the top.
    pub extinction_size: [usize; 2],
    pub gather: Gather,
}

impl Default for Settings {
    /// The paper's (§6).
    fn default() -> Self {
        Settings {
            size: Elek2010::PAPER_SIZE,
            orders: 6,
            samples: 30,
            extinction_size: [256, 512],
            gather: Gather::PerPoint,
        }
    }
}

/// The result of Algorithm 1, all per unit solar irradiance.
pub struct Literal {
    pub map: Elek2010,
    /// TS − TC: light last scattered by [gas, aerosol], 1/sr, over [altitude, view, sun, azimuth].
    pub scattering: Array<[Lanes; 2], 4>,
    /// TC: light last reflected by the ground, seen through the air, 1/sr.
    pub ground_light: Array<Lanes, 4>,
    /// TA: diffuse irradiance of the ground, orders 1 … K−1, per texel of the sun axis.
    pub ambient: Vec<Lanes>,
    /// Share of the values of TS − TC, all wavelengths and both species, that are negative.
    pub negative_fraction: f64,
    /// Sum of the radiance in TSΔ (ground light included) over all texels, per order and wavelength.
    pub order_totals: Vec<[f64; WIDTH]>,
}

impl Literal {
    /// TS − TC at a place inside the shell, of [gas, aerosol], 1/sr: zero where the sun is below the axis.
    pub fn at(&self, altitude: f64, mu: f64, mu_s: f64, cos_azimuth: f64) -> [Lanes; 2] {
        let hits_ground = self.map.hits_ground(altitude, mu);
        match self.map.locate(altitude, mu, mu_s, cos_azimuth, hits_ground) {
            Some(place) => self.scattering.interpolate(&place),
            None => [Lanes::ZERO; 2],
        }
    }
}

/// Samples that a run evaluates, each for all its wavelengths at once: the cost is proportional to it, and
/// nearly all of it is the S² samples of Eq. 9 per texel. The extinction table is left out.
pub fn work(settings: &Settings) -> f64 {
    let [altitudes, views, suns, azimuths] = settings.size.map(|n| n as f64);
    let samples = settings.samples as f64;
    let texels = altitudes * views * suns * azimuths;
    let directions = samples * samples;
    let (fetched, gathered) = match settings.gather {
        Gather::PerPoint => (altitudes * suns * directions, texels * directions),
        Gather::PerTexel => (texels * directions, texels * directions),
        Gather::Mean => (altitudes * suns * directions, 0.0),
        Gather::AtSample => (texels * samples * directions, texels * samples * directions),
    };
    let ambient = suns * directions;
    let marched = texels * samples;
    marched + (settings.orders as f64 - 1.0) * (fetched + gathered + ambient + marched)
}

/// Runs Algorithm 1 for a medium of at most sixteen wavelengths whose aerosols are isotropic (see
/// [`Medium::similarity`]). `progress` is told (passes done, passes in all). Errors: settings out of range,
/// more wavelengths, other phase functions.
pub fn bake(medium: &Medium, settings: &Settings, progress: &dyn Fn(usize, usize)) -> Result<Literal> {
    if settings.orders < 1 || settings.samples < 2 {
        return Err(Error::Argument("the literal method needs at least 1 order and 2 samples".into()));
    }
    let map = Elek2010::new(medium.ground_radius, medium.top_radius, settings.size)
        .ok_or_else(|| Error::Argument(format!("{:?} is no size of an elek2010 table", settings.size)))?;
    let solver = Solver { air: Air::new(medium, settings.extinction_size)?, map, settings };
    let passes = 2 * settings.orders;
    let algorithm = solver.algorithm_1(&|done| progress(done, passes));
    Ok(algorithm.into_literal(solver.map, medium.wavelengths_nm.len()))
}

/// The tables of Algorithm 1.
struct Tables {
    ts: Array<[Lanes; 2], 4>,
    tc: Array<Lanes, 4>,
    ta: Vec<Lanes>,
    order_totals: Vec<[f64; WIDTH]>,
}

struct Solver<'a> {
    air: Air,
    map: Elek2010,
    settings: &'a Settings,
}

impl Solver<'_> {
    /// Algorithm 1, line by line. TSΔ is the sum of the species, which is what the next order gathers; the
    /// ground's light is filed under gas until it is subtracted.
    fn algorithm_1(&self, progress: &dyn Fn(usize)) -> Tables {
        let size = self.settings.size;
        let mut ts = Array::zero(size);
        let mut ts_delta = Array::zero(size);
        self.march(&mut ts, &mut ts_delta, &|row| self.first_order(row)); // Eq. 7
        let mut ta = vec![Lanes::ZERO; size[2]];
        let mut tg = Gathered::new(self.settings.gather, size, self.settings.samples);
        let mut order_totals = vec![total(&ts_delta)];
        progress(1);
        for k in 2..=self.settings.orders {
            self.gather(&ts_delta, &mut tg); // Eq. 9
            progress(2 * k - 2);
            let ta_delta = self.ambient(&ts_delta); // Eq. 10
            self.march(&mut ts, &mut ts_delta, &|row| self.next_order(row, &tg, &ta_delta)); // Eq. 12
            add(&mut ta, &ta_delta);
            order_totals.push(total(&ts_delta));
            progress(2 * k - 1);
        }
        let tc = self.correction(&ta); // Eq. 15
        subtract(&mut ts, &tc);
        progress(2 * self.settings.orders);
        Tables { ts, tc, ta, order_totals }
    }

    /// Computes TSΔ row by row, [suns × azimuths] for each altitude and view, and TS ← TS + TSΔ.
    fn march(
        &self,
        ts: &mut Array<[Lanes; 2], 4>,
        ts_delta: &mut Array<Lanes, 4>,
        order: &(impl Fn(Row) -> Vec<[Lanes; 2]> + Sync),
    ) {
        let [_, views, suns, azimuths] = self.settings.size;
        let rows = ts.values_mut().par_chunks_mut(suns * azimuths);
        rows.zip(ts_delta.values_mut().par_chunks_mut(suns * azimuths)).enumerate().for_each(
            |(row, (ts, ts_delta))| {
                let values = order(Row { altitude: row / views, view: row % views });
                for (value, (sum, delta)) in values.into_iter().zip(ts.iter_mut().zip(ts_delta)) {
                    *delta = value[GAS] + value[AEROSOL];
                    sum[GAS] += value[GAS];
                    sum[AEROSOL] += value[AEROSOL];
                }
            },
        );
    }

    /// I_S^(1) of one row: Eq. 7, with R (Eq. 8) under gas.
    fn first_order(&self, row: Row) -> Vec<[Lanes; 2]> {
        isa::run(
            #[inline(always)]
            || {
                self.texels_of(
                    row,
                    #[inline(always)]
                    |ray, mu_s, nu| {
                        let mut sum = self.single_scattering(ray, mu_s, nu);
                        sum[GAS] += self.reflected(ray, mu_s, nu);
                        sum
                    },
                )
            },
        )
    }

    /// I_S^(k) of one row: Eq. 12 from TG and TAΔ of order k − 1, with A under gas.
    fn next_order(&self, row: Row, tg: &Gathered, ta_delta: &[Lanes]) -> Vec<[Lanes; 2]> {
        isa::run(
            #[inline(always)]
            || {
                self.texels_of(
                    row,
                    #[inline(always)]
                    |ray, mu_s, nu| {
                        let mut sum = self.in_scattered(ray, mu_s, nu, tg);
                        sum[GAS] += self.composite_ambient(ray, mu_s, nu, ta_delta);
                        sum
                    },
                )
            },
        )
    }

    /// TC (Eq. 15): R, and A of all orders at once from their summed ambient light.
    fn correction(&self, ta: &[Lanes]) -> Array<Lanes, 4> {
        let [_, views, suns, azimuths] = self.settings.size;
        let mut tc = Array::zero(self.settings.size);
        tc.values_mut().par_chunks_mut(suns * azimuths).enumerate().for_each(|(row, texels)| {
            let row = Row { altitude: row / views, view: row % views };
            let light = isa::run(
                #[inline(always)]
                || {
                    self.texels_of(
                        row,
                        #[inline(always)]
                        |ray, mu_s, nu| {
                            self.reflected(ray, mu_s, nu) + self.composite_ambient(ray, mu_s, nu, ta)
                        },
                    )
                },
            );
            texels.copy_from_slice(&light);
        });
        tc
    }

    /// Traces the ray of a row and asks `texel` for each (sun, azimuth), as (ray, mu_s, nu).
    #[inline(always)]
    fn texels_of<T>(&self, row: Row, texel: impl Fn(&Ray, f64, f64) -> T) -> Vec<T> {
        let [_, _, suns, azimuths] = self.settings.size;
        let ray = Ray::trace(&self.air, &self.map, [row.altitude, row.view], self.settings.samples);
        let mut texels = Vec::with_capacity(suns * azimuths);
        for k in 0..suns {
            for l in 0..azimuths {
                let mu_s = self.map.mu_s(k);
                let nu = ray.nu(mu_s, self.map.cos_azimuth(l));
                texels.push(texel(&ray, mu_s, nu));
            }
        }
        texels
    }

    /// The integral of Eq. 7, of gas and aerosol.
    #[inline(always)]
    fn single_scattering(&self, ray: &Ray, mu_s: f64, nu: f64) -> [Lanes; 2] {
        let mut sum = [Lanes::ZERO; 2];
        for sample in &ray.samples {
            let light = self.air.sunlight(sample.altitude, ray.mu_s_at(sample, mu_s, nu));
            sum[GAS] += sample.strength[GAS] * light;
            sum[AEROSOL] += sample.strength[AEROSOL] * light;
        }
        let phase = self.air.phase;
        [sum[GAS] * phase[GAS].value(nu as f32), sum[AEROSOL] * phase[AEROSOL].value(nu as f32)]
    }

    /// The integral of Eq. 12, of gas and aerosol.
    #[inline(always)]
    fn in_scattered(&self, ray: &Ray, mu_s: f64, nu: f64, tg: &Gathered) -> [Lanes; 2] {
        let mut sum = [Lanes::ZERO; 2];
        for sample in &ray.samples {
            if let Some(gathered) = self.gathered_at(tg, ray, sample, mu_s, nu) {
                sum[GAS] += sample.strength[GAS] * gathered[GAS];
                sum[AEROSOL] += sample.strength[AEROSOL] * gathered[AEROSOL];
            }
        }
        sum
    }

    /// R: sunlight off the ground at P_g (Eq. 8).
    #[inline(always)]
    fn reflected(&self, ray: &Ray, mu_s: f64, nu: f64) -> Lanes {
        let mu_s_ground = ray.mu_s_at(ray.end(), mu_s, nu);
        if !ray.hits_ground || mu_s_ground <= 0.0 {
            return Lanes::ZERO;
        }
        let sunlight = self.air.sunlight(0.0, mu_s_ground);
        self.air.reflectance * mu_s_ground as f32 * sunlight * ray.transmittance
    }

    /// A: ambient light off the ground at P_g (Eq. 11).
    #[inline(always)]
    fn composite_ambient(&self, ray: &Ray, mu_s: f64, nu: f64, ambient: &[Lanes]) -> Lanes {
        let mu_s_ground = ray.mu_s_at(ray.end(), mu_s, nu);
        match self.map.sun_coordinate(mu_s_ground) {
            Some(w) if ray.hits_ground => {
                let (k, fraction) = texel(w, ambient.len());
                let here = ambient[k] * (1.0 - fraction) as f32 + ambient[k + 1] * fraction as f32;
                self.air.reflectance * here * ray.transmittance
            }
            _ => Lanes::ZERO,
        }
    }
}

/// A row of the 4D tables, by texel.
#[derive(Clone, Copy)]
struct Row {
    altitude: usize,
    view: usize,
}

impl Tables {
    fn into_literal(self, map: Elek2010, wavelengths: usize) -> Literal {
        let values = self.ts.values().iter().flatten().flat_map(|lanes| &lanes.0[..wavelengths]);
        let negative = values.filter(|&&v| v < 0.0).count();
        let count = 2 * wavelengths * self.ts.values().len();
        Literal {
            map,
            scattering: self.ts,
            ground_light: self.tc,
            ambient: self.ta,
            negative_fraction: negative as f64 / count.max(1) as f64,
            order_totals: self.order_totals,
        }
    }
}

/// TA ← TA + TAΔ.
fn add(ta: &mut [Lanes], ta_delta: &[Lanes]) {
    for (sum, delta) in ta.iter_mut().zip(ta_delta) {
        *sum += *delta;
    }
}

/// TS ← TS − TC, where the ground's light was filed: under gas.
fn subtract(ts: &mut Array<[Lanes; 2], 4>, tc: &Array<Lanes, 4>) {
    for (sum, ground) in ts.values_mut().iter_mut().zip(tc.values()) {
        sum[GAS] = sum[GAS] - *ground;
    }
}

/// Sum over all texels in their order, so that it does not depend on threads.
fn total(table: &Array<Lanes, 4>) -> [f64; WIDTH] {
    let mut sum = [0.0; WIDTH];
    for lanes in table.values() {
        for (s, v) in sum.iter_mut().zip(lanes.0) {
            *s += f64::from(v);
        }
    }
    sum
}
