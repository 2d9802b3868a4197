//! One order of scattering as a linear operator on the state, and the first order that starts it.

use super::azimuth::{Pairs, SunAxis, midpoint_azimuths};
use super::bundles::{self, Between, Bundle, BundleScratch, Degrees, Part};
use super::column::Shells;
use super::kernels::{self, FieldGroup, Scratch, SingleGroup};
use super::levels::Levels;
use super::moments::Basis;
use super::optics::Optics;
use super::path::Path;
use super::rays::{Attenuation, Hit, Ray, Sample};
use super::refined::RefinedAxis;
use super::state::{State, source_factors};
use super::sunlight::Sunlight;
use crate::geometry::{Direction, directions};
use crate::machine::lanes::Lanes;
use rayon::prelude::*;
use std::f64::consts::{FRAC_1_PI, PI};
use std::ops::Range;

/// Intervals of the refined sun axis for each of the state's.
const REFINEMENT: usize = 3;

/// Whether a shell from a radius to another is so tall that its rays turn far around the planet.
pub(super) fn is_tall(ground: f64, top: f64) -> bool {
    top > TALL * ground
}

/// Radius of the top over that of the ground from which on a shell is tall.
const TALL: f64 = 2.0;

/// The directions at one coarse level, with their paths.
pub struct Gather {
    pub directions: Vec<(Direction, Path)>,
}

/// What does not depend on wavelength: where the moments are gathered and along which paths.
pub struct Geometry {
    pub levels: Levels,
    pub shells: Shells,
    pub axis: SunAxis,
    /// The axis that fields are looked up on while orders are summed.
    pub refined: RefinedAxis,
    pub gathers: Vec<Gather>,
}

impl Geometry {
    pub fn new(levels: Levels, shells: Shells, axis: SunAxis, zeniths: usize, terms: usize) -> Self {
        let (ground, top) = (shells.edges[0], shells.edges[shells.len()]);
        let gathers = levels
            .coarse
            .par_iter()
            .map(|&r| Gather {
                directions: directions(r, ground, top, zeniths)
                    .into_iter()
                    .map(|d| (d, Path::new(&shells, &levels, r, d.mu, d.hits_ground)))
                    .collect(),
            })
            .collect();
        Geometry { levels, shells, refined: RefinedAxis::new(&axis, REFINEMENT, terms), axis, gathers }
    }

    /// Whether the shell is so tall that its rays turn far around the planet.
    pub fn is_tall(&self) -> bool {
        is_tall(self.shells.edges[0], self.shells.edges[self.shells.len()])
    }
}

/// A batch of wavelengths ready to scatter.
pub(super) struct Operator<'a> {
    pub geometry: &'a Geometry,
    pub optics: &'a Optics,
    pub sunlight: &'a Sunlight,
    pub basis: &'a Basis,
    /// `[constituent][level of the field]`
    pub shares: Vec<Vec<Lanes>>,
    /// All constituents that scatter.
    pub scatterers: Vec<usize>,
    /// `[level][direction]`
    pub rays: Vec<Vec<Ray>>,
    /// `[level][direction]`: the rays' samples in bundles, in thick air.
    bundles: Option<Vec<Vec<Vec<Bundle>>>>,
    degrees: Degrees,
    pairs: Pairs,
}

impl<'a> Operator<'a> {
    pub(super) fn new(
        geometry: &'a Geometry,
        optics: &'a Optics,
        sunlight: &'a Sunlight,
        basis: &'a Basis,
        azimuths: usize,
    ) -> Self {
        let levels = &geometry.levels;
        let constituents = 0..optics.extinction.len();
        let shares =
            constituents.clone().map(|c| optics.shares(&geometry.shells, &levels.field, c)).collect();
        let scatterers = constituents.filter(|&c| optics.scattering[c] != Lanes::ZERO).collect();
        let rays = geometry
            .gathers
            .par_iter()
            .map(|g| {
                let build = |(_, path): &(Direction, Path)| {
                    crate::machine::isa::run(
                        #[inline(always)]
                        || Ray::new(path, levels, &optics.extinction),
                    )
                };
                g.directions.iter().map(build).collect()
            })
            .collect();
        let pairs = Pairs::new(&geometry.axis.mu_s, &midpoint_azimuths(azimuths));
        let (bundles, degrees) = (None, Degrees::new(basis));
        let mut operator =
            Operator { geometry, optics, sunlight, basis, shares, scatterers, rays, bundles, degrees, pairs };
        operator.bundles = levels.is_refined().then(|| operator.bundle());
        operator
    }

    /// The samples of all rays in bundles.
    fn bundle(&self) -> Vec<Vec<Vec<Bundle>>> {
        let levels = &self.geometry.levels;
        let zeroth: Vec<usize> = self.basis.of_order(0).collect();
        let sources: Vec<Vec<Lanes>> = (0..levels.field.len())
            .map(|n| source_factors(self.basis, self.optics, &self.shares, &self.scatterers, n))
            .map(|all| zeroth.iter().map(|&t| all[t]).collect())
            .collect();
        let turns = bundles::turns(self.geometry.is_tall());
        let level = |(gather, rays): (&Gather, &Vec<Ray>)| {
            let one = |((d, _), ray): (&(Direction, Path), &Ray)| {
                let part = Part { weights: &ray.weights, sources: &sources };
                let between = Between::Squares;
                bundles::bundle(&ray.samples, d.mu, &[part], levels, self.basis, &turns, between)
            };
            gather.directions.iter().zip(rays).map(one).collect()
        };
        self.geometry.gathers.par_iter().zip(&self.rays).map(level).collect()
    }

    fn zero(&self) -> State {
        State::zero(self.geometry.levels.coarse.len(), self.geometry.axis.len(), self.basis.len())
    }

    /// Gathers the moments of a radiance, given along each direction of each level for all pairs.
    /// `radiance(level, direction number, room, out)` adds to `out`, one value a pair; of a level, it is asked for all
    /// directions in order, with the same room.
    pub(super) fn gather<Buffers: Default>(
        &self,
        pairs: &Pairs,
        radiance: impl Fn(usize, usize, &mut Buffers, &mut [Lanes]) + Sync,
    ) -> State {
        let mut state = self.zero();
        let stride = state.suns * state.terms;
        let mut ground = vec![Lanes::ZERO; state.suns];
        let azimuth = AzimuthMoments::new(self.basis, pairs, &self.geometry.axis);
        let on_ground: Vec<Vec<Lanes>> = state
            .moments
            .par_chunks_mut(stride)
            .enumerate()
            .map_init(
                || (Buffers::default(), vec![Lanes::ZERO; pairs.len()]),
                |(room, out), (level, moments)| {
                    let mut flux = vec![Lanes::ZERO; if level == 0 { state.suns } else { 0 }];
                    for (j, (d, _)) in self.geometry.gathers[level].directions.iter().enumerate() {
                        out.fill(Lanes::ZERO);
                        crate::machine::isa::run(
                            #[inline(always)]
                            || {
                                radiance(level, j, room, out);
                                azimuth.add(d, out, moments, &mut flux);
                            },
                        );
                    }
                    azimuth.close_overhead(moments);
                    flux
                },
            )
            .collect();
        ground.copy_from_slice(&on_ground[0]);
        state.ground = ground;
        state
    }

    /// The next order of scattering: moments of the light that the field of `state` and the ground lit by it
    /// send out (Elek & Kmoch Eqs. 9–12 in one step).
    pub(super) fn apply(&self, state: &State) -> State {
        match &self.bundles {
            Some(bundles) => self.apply_bundles(bundles, state),
            None => self.apply_samples(state),
        }
    }

    /// [`Operator::apply`] sample by sample.
    fn apply_samples(&self, state: &State) -> State {
        let levels = &self.geometry.levels;
        let field = state.field(self.basis, self.optics, levels, &self.shares, &self.scatterers);
        let field = self.geometry.refined.prepare(field);
        self.gather(
            &self.pairs,
            #[inline(always)]
            |level, j, scratch: &mut Scratch, out| {
                let (d, ray) = (&self.geometry.gathers[level].directions[j].0, &self.rays[level][j]);
                let group = FieldGroup { field: &field, basis: self.basis, weights: &ray.weights };
                let axis = &self.geometry.refined;
                kernels::multiple(&ray.samples, d.mu as f32, &[group], axis, &self.pairs, scratch, out);
                self.add_ground(ray, state, out);
            },
        )
    }

    /// [`Operator::apply`] in thick air.
    fn apply_bundles(&self, bundles: &[Vec<Vec<Bundle>>], state: &State) -> State {
        let moments = &state.moments;
        let size = state.suns * self.basis.modes;
        self.gather(
            &self.pairs,
            #[inline(always)]
            |level, j, (products, range, room): &mut (Vec<Lanes>, Range<usize>, BundleScratch), out| {
                let rays = &bundles[level];
                if j == 0 || j == range.end {
                    *range = j..j + bundles::together(&rays[j..]);
                    let rays = &rays[range.clone()];
                    bundles::products(rays, moments, state.suns, self.basis, &self.degrees, products);
                }
                let begin: usize = rays[range.start..j].iter().map(Vec::len).sum();
                let own = &products[begin * size..][..rays[j].len() * size];
                let mu = self.geometry.gathers[level].directions[j].0.mu as f32;
                let (axis, suns) = (&self.geometry.refined, state.suns);
                bundles::add(&rays[j], own, mu, self.basis, axis, suns, &self.pairs, room, out);
                self.add_ground(&self.rays[level][j], state, out);
            },
        )
    }

    /// Adds the light that the ground scatters, lit by the diffuse light of `state`.
    #[inline(always)]
    fn add_ground(&self, ray: &Ray, state: &State, out: &mut [Lanes]) {
        if let Some(hit) = &ray.hit {
            let factor = hit.transmittance * (self.optics.albedo * FRAC_1_PI as f32);
            for (p, out) in out.iter_mut().enumerate() {
                let mu_s = self.pairs.mu_s[p] * hit.cos_turn + self.pairs.across[p] * hit.sin_turn;
                *out += interpolate(&state.ground, &self.geometry.axis, mu_s) * factor;
            }
        }
    }

    /// The first order: sunlight scattered or reflected once (Eqs. 7–8).
    pub(super) fn first_order(&self, azimuths: usize) -> State {
        let geometry = self.geometry;
        let pairs = Pairs::new(&geometry.axis.mu_s, &midpoint_azimuths(azimuths));
        let scattering: Vec<Vec<Lanes>> =
            self.scatterers.iter().map(|&c| self.optics.group_scattering(&[c])).collect();
        self.gather(
            &pairs,
            #[inline(always)]
            |level, j, (): &mut (), out| {
                let (d, path) = &geometry.gathers[level].directions[j];
                let samples = Sample::all(path, &geometry.levels, false);
                let attenuation = Attenuation::new(path, &self.optics.extinction);
                let group =
                    |s: &Vec<Lanes>| SingleGroup { weights: attenuation.weights(path, s), deeper: None };
                let groups: Vec<SingleGroup> = scattering.iter().map(group).collect();
                let mut once = vec![Lanes::ZERO; groups.len() * pairs.len()];
                kernels::single(&samples, self.sunlight, &groups, &pairs, &mut once, &mut []);
                self.add_phases(d.mu as f32, &pairs, &once, out);
                if path.hits_ground {
                    let hit = Hit::at(path, attenuation.transmittance);
                    let factor = hit.transmittance * self.optics.albedo * FRAC_1_PI as f32;
                    for (p, out) in out.iter_mut().enumerate() {
                        let mu_s = pairs.mu_s[p] * hit.cos_turn + pairs.across[p] * hit.sin_turn;
                        let cosine = if mu_s > 0.0 { mu_s } else { 0.0 };
                        *out += self.sunlight.at(0, mu_s) * factor * cosine;
                    }
                }
            },
        )
    }

    /// Adds phase-free single scattering times the phase function, constituent by constituent.
    #[inline(always)]
    fn add_phases(&self, mu: f32, pairs: &Pairs, once: &[Lanes], out: &mut [Lanes]) {
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        for (once, &c) in once.chunks_exact(pairs.len()).zip(&self.scatterers) {
            for (p, (out, once)) in out.iter_mut().zip(once).enumerate() {
                let nu = pairs.mu_s[p] * mu + pairs.across[p] * sine;
                let nu = nu.clamp(-1.0, 1.0);
                *out += self.optics.smooth_phase[c].value(nu) * *once;
            }
        }
    }
}

/// A row over the sun axis, interpolated linearly; 0 below its lowest node.
#[inline(always)]
pub(super) fn interpolate(row: &[Lanes], axis: &SunAxis, mu_s: f32) -> Lanes {
    let (n, t) = axis.locate(mu_s);
    if t < 0.0 {
        return Lanes::ZERO;
    }
    row[n as usize] * (1.0 - t) + row[n as usize + 1] * t
}

/// Projects radiance at azimuth midpoints onto cos mφ and onto the moments.
struct AzimuthMoments<'a> {
    basis: &'a Basis,
    azimuths: usize,
    /// `[mode][azimuth]`: 2π/n cos mφ
    cosines: Vec<f32>,
    /// `[sun node][mode]`: 1 / s^min(m,2), 0 where the sun stands overhead and m > 0.
    inverse_sines: Vec<f32>,
    suns: usize,
}

impl<'a> AzimuthMoments<'a> {
    fn new(basis: &'a Basis, pairs: &Pairs, axis: &SunAxis) -> Self {
        let n = pairs.azimuth_count;
        let mut cosines = Vec::new();
        for m in 0..basis.modes {
            for k in 0..n {
                let phi = (k as f64 + 0.5) * PI / n as f64;
                cosines.push((2.0 * PI / n as f64 * libm::cos(m as f64 * phi)) as f32);
            }
        }
        let mut inverse_sines = Vec::new();
        for &mu_s in &axis.mu_s {
            let s2 = (1.0 - mu_s * mu_s).max(0.0);
            for m in 0..basis.modes {
                let power = [1.0, s2.sqrt(), s2][m.min(2)];
                inverse_sines.push(if power > 0.0 { (1.0 / power) as f32 } else { 0.0 });
            }
        }
        AzimuthMoments { basis, azimuths: n, cosines, inverse_sines, suns: pairs.sun_count }
    }

    /// Adds one direction's radiance, `[sun node][azimuth]`, to the moments, and to the flux where wanted.
    #[inline(always)]
    fn add(&self, d: &Direction, radiance: &[Lanes], moments: &mut [Lanes], flux: &mut [Lanes]) {
        let (modes, terms) = (self.basis.modes, self.basis.len());
        let p = self.basis.polynomials(d.mu);
        let sine = (1.0 - d.mu * d.mu).max(0.0).sqrt();
        let mut sine_power = vec![1.0; modes];
        for m in 1..modes {
            sine_power[m] = sine_power[m - 1] * sine;
        }
        let factors: Vec<f32> =
            (0..terms).map(|t| (d.weight * p[t] * sine_power[self.basis.orders[t]]) as f32).collect();
        let mut projected = vec![Lanes::ZERO; modes];
        for sun in 0..self.suns {
            let row = &radiance[sun * self.azimuths..][..self.azimuths];
            for m in 0..modes {
                let mut sum = Lanes::ZERO;
                for (value, c) in row.iter().zip(&self.cosines[m * self.azimuths..]) {
                    sum += *value * *c;
                }
                projected[m] = sum * self.inverse_sines[sun * modes + m];
            }
            let out = &mut moments[sun * terms..][..terms];
            for t in 0..terms {
                out[t] += projected[self.basis.orders[t]] * factors[t];
            }
            if d.mu > 0.0 && !flux.is_empty() {
                flux[sun] += projected[0] * (d.weight * d.mu) as f32;
            }
        }
    }

    /// With the sun overhead the scaled moments of m > 0 are 0/0: they take the value of the node beside.
    fn close_overhead(&self, moments: &mut [Lanes]) {
        let terms = self.basis.len();
        let last = (self.suns - 1) * terms;
        for t in (0..terms).filter(|&t| self.basis.orders[t] > 0) {
            moments[last + t] = moments[last - terms + t];
        }
    }
}
