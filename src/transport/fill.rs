//! Light along one ray for many sun positions at once: what tables are filled from.

use super::azimuth::Pairs;
use super::bundles::{self, Between, Degrees, Part};
use super::kernels::{self, Field, FieldGroup, Scratch, SingleGroup};
use super::moments::Basis;
use super::operator::interpolate;
use super::optics::{Optics, PhaseLanes};
use super::path::Path;
use super::rays::{Attenuation, Hit, Sample};
use super::refined::RefinedAxis;
use super::solve::{Batch, Solution};
use super::state::source_factors;
use crate::machine::lanes::{Lanes, WIDTH};
use std::f64::consts::FRAC_1_PI;

pub use super::azimuth::Pairs as SunPairs;

/// Intervals of the sun axis on which fields are looked up for each of the solver's.
const REFINEMENT: usize = 4;

/// The light of a batch of wavelengths, by groups of constituents that scatter it last.
pub struct RayIntegrator<'a> {
    solution: &'a Solution,
    batch: &'a Batch,
    axis: RefinedAxis,
    groups: Vec<Group>,
    /// Extinction per constituent, 0 for those that only absorb.
    scatterers: Vec<Lanes>,
    /// In thick air: what bundles of samples are multiplied with.
    thick: Option<Thick>,
    /// All groups' light scattered more than once is added up in the first's place.
    together: bool,
}

struct Thick {
    degrees: Degrees,
    turns: Vec<f64>,
    /// `[group][0][degree]`: source of a moment 1.
    sources: Vec<Vec<Vec<Lanes>>>,
}

struct Group {
    /// For a forward peak: T τ towards the sun.
    deeper: Option<Vec<Lanes>>,
    /// The group's part of what counts as unscattered.
    share_of_peaks: Lanes,
    basis: Basis,
    field: Field,
    /// First constituent of the group, for its phase function and forward peak.
    first: usize,
    scattering: Vec<Lanes>,
}

/// Which parts of the light a table wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    Single,
    Multiple,
    Both,
}

/// Light along one ray, `[group][pair]`, per unit solar irradiance.
#[derive(Default)]
pub struct RayLight {
    /// Scattered once, without the phase function (and with what multiple scattering by small angles adds to
    /// a forward peak, as if it had been scattered once).
    pub single: Vec<Lanes>,
    /// Scattered more often, 1/sr.
    pub multiple: Vec<Lanes>,
    /// Optical depth of the ray, and without the constituents that only absorb.
    pub depth: Lanes,
    pub scatterers_depth: Lanes,
    scratch: Scratch,
    products: Vec<Lanes>,
    room: bundles::BundleScratch,
    deeper: Vec<Lanes>,
}

impl<'a> RayIntegrator<'a> {
    /// `groups`: lists of constituents; those of one group share a phase function.
    pub fn new(solution: &'a Solution, batch: &'a Batch, groups: &[Vec<usize>]) -> Self {
        let mut groups: Vec<Group> =
            groups.iter().filter(|g| !g.is_empty()).map(|g| group(solution, batch, g)).collect();
        let terms = groups.iter().map(|g| g.basis.len()).max().unwrap_or(0);
        let axis = RefinedAxis::new(&solution.geometry.axis, REFINEMENT, terms);
        for group in &mut groups {
            if !group.field.values.is_empty() {
                group.field = axis.prepare(std::mem::take(&mut group.field));
            }
        }
        let optics = &batch.optics;
        let scatterers = (0..optics.extinction.len())
            .map(
                |c| if optics.scattering[c] == Lanes::ZERO { Lanes::ZERO } else { optics.full_extinction[c] },
            )
            .collect();
        let thick = solution.geometry.levels.is_refined().then(|| Thick::new(solution, batch, &groups));
        RayIntegrator { solution, batch, axis, groups, scatterers, thick, together: false }
    }

    /// The same, but light scattered more than once counts for the first group, whoever scatters it.
    pub fn together(self) -> Self {
        RayIntegrator { together: true, ..self }
    }

    /// Optical depths of rays from radius `r`, to the ground or to the top: `mus` fall from the zenith (or, to
    /// the ground, rise from the nadir) to the horizon. Constituents that only absorb may be left out.
    pub fn depths(&self, r: f64, mus: &[f64], to_ground: bool, scatterers_only: bool) -> Vec<Lanes> {
        let shells = &self.solution.geometry.shells;
        let ground = shells.edges[0];
        let b2: Vec<f64> = mus.iter().map(|mu| r * r * (1.0 - mu * mu)).collect();
        let columns = crate::machine::isa::run(
            #[inline(always)]
            || {
                if to_ground {
                    // Rounding must not lift a ray that grazes the ground above it.
                    let b2: Vec<f64> = b2.iter().map(|b| b.min(ground * ground)).collect();
                    shells.columns_to_ground(r, &b2)
                } else {
                    shells.columns_to_top(r, &b2, mus.iter().filter(|&&mu| mu >= 0.0).count())
                }
            },
        );
        let depth = |n: usize| {
            let mut sum = Lanes::ZERO;
            let optics = &self.batch.optics;
            let counts = |c: usize| !scatterers_only || optics.scattering[c] != Lanes::ZERO;
            for (c, e) in optics.full_extinction.iter().enumerate().filter(|(c, _)| counts(*c)) {
                sum += *e * columns[c * mus.len() + n] as f32;
            }
            sum
        };
        (0..mus.len()).map(depth).collect()
    }

    /// Number of groups.
    pub fn groups(&self) -> usize {
        self.groups.len()
    }

    /// Light that arrives at radius `r` from zenith cosine `mu`, for all pairs.
    pub fn ray(&self, r: f64, mu: f64, hits_ground: bool, pairs: &Pairs, wanted: Wanted, out: &mut RayLight) {
        let geometry = &self.solution.geometry;
        let path = Path::new(&geometry.shells, &geometry.levels, r, mu, hits_ground);
        let count = self.groups.len() * pairs.len();
        for values in [&mut out.single, &mut out.multiple] {
            values.clear();
            values.resize(count, Lanes::ZERO);
        }
        crate::machine::isa::run(
            #[inline(always)]
            || {
                let attenuation = Attenuation::new(&path, &self.batch.optics.extinction);
                out.depth =
                    *path.depths(&self.batch.optics.full_extinction).last().expect("a path has a stop");
                out.scatterers_depth = *path.depths(&self.scatterers).last().expect("a path has a stop");
                if wanted != Wanted::Single {
                    self.multiple(&path, &attenuation, mu as f32, pairs, out);
                }
                let peaks_are_wanted = self.groups.iter().any(|g| g.deeper.is_some());
                if wanted != Wanted::Multiple || peaks_are_wanted {
                    self.single(&path, &attenuation, mu as f32, pairs, out);
                }
                if hits_ground && wanted != Wanted::Single {
                    self.ground_beside_its_image(&path, &attenuation, pairs, out);
                }
            },
        );
    }

    #[inline(always)]
    fn multiple(&self, path: &Path, attenuation: &Attenuation, mu: f32, pairs: &Pairs, out: &mut RayLight) {
        let samples = Sample::all(path, &self.solution.geometry.levels, true);
        let weights = |g: &Group| attenuation.field_weights(path, &g.scattering);
        let weights: Vec<Vec<Lanes>> = self.groups.iter().map(weights).collect();
        if let Some(thick) = &self.thick {
            let each = if self.together { self.groups.len().max(1) } else { 1 };
            for (g, weights) in weights.chunks(each).enumerate() {
                self.multiple_in_bundles(thick, g * each, weights, &samples, mu, pairs, out);
            }
            return;
        }
        let groups: Vec<FieldGroup> = (self.groups.iter().zip(&weights))
            .map(|(g, weights)| FieldGroup { field: &g.field, basis: &g.basis, weights })
            .collect();
        kernels::multiple(&samples, mu, &groups, &self.axis, pairs, &mut out.scratch, &mut out.multiple);
        if self.together && self.groups.len() > 1 {
            let (first, rest) = out.multiple.split_at_mut(pairs.len());
            for group in rest.chunks_exact_mut(pairs.len()) {
                first.iter_mut().zip(group.iter()).for_each(|(f, g)| *f += *g);
                group.fill(Lanes::ZERO);
            }
        }
    }

    /// Light of some groups, from number `first` on, added up in the place of the first.
    #[inline(always)]
    fn multiple_in_bundles(
        &self,
        thick: &Thick,
        first: usize,
        weights: &[Vec<Lanes>],
        samples: &[Sample],
        mu: f32,
        pairs: &Pairs,
        out: &mut RayLight,
    ) {
        let Solution { basis, geometry, .. } = self.solution;
        let parts: Vec<Part> = (weights.iter().zip(&thick.sources[first..]))
            .map(|(weights, sources)| Part { weights, sources })
            .collect();
        let (turns, between) = (&thick.turns, Between::Line);
        let rays = [bundles::bundle(samples, f64::from(mu), &parts, &geometry.levels, basis, turns, between)];
        let RayLight { products, room, multiple, .. } = out;
        let state = &self.batch.state;
        let suns = state.suns;
        bundles::products(&rays, &state.moments, suns, basis, &thick.degrees, products);
        let light = &mut multiple[first * pairs.len()..][..pairs.len()];
        bundles::add(&rays[0], products, mu, basis, &self.axis, suns, pairs, room, light);
    }

    #[inline(always)]
    fn single(&self, path: &Path, attenuation: &Attenuation, mu: f32, pairs: &Pairs, out: &mut RayLight) {
        let optics = &self.batch.optics;
        let count = pairs.len();
        let peaked = |g: &Group| g.deeper.is_some();
        let groups: Vec<SingleGroup> = self
            .groups
            .iter()
            .map(|g| SingleGroup {
                weights: attenuation.weights(path, &g.scattering),
                deeper: g.deeper.as_deref(),
            })
            .collect();
        out.deeper.clear();
        out.deeper.resize(if self.groups.iter().any(peaked) { out.single.len() } else { 0 }, Lanes::ZERO);
        let samples = Sample::all(path, &self.solution.geometry.levels, false);
        let RayLight { single, deeper, .. } = out;
        kernels::single(&samples, &self.batch.sunlight, &groups, pairs, single, deeper);
        for (g, group) in self.groups.iter().enumerate().filter(|(_, group)| peaked(group)) {
            let range = g * count..(g + 1) * count;
            let (once, multiple) = (&mut out.single[range.clone()], &mut out.multiple[range.clone()]);
            self.add_peak(optics, group, mu, pairs, once, multiple, &out.deeper[range]);
        }
    }

    /// Adds the forward peak's higher orders: near the peak to single scattering, which shares its shape, and
    /// away from it to multiple scattering, whose ripples it fills.
    #[inline(always)]
    fn add_peak(
        &self,
        optics: &Optics,
        group: &Group,
        mu: f32,
        pairs: &Pairs,
        once: &mut [Lanes],
        multiple: &mut [Lanes],
        deeper: &[Lanes],
    ) {
        let Some(peak) = &optics.peaks[group.first] else { return };
        let phase: &PhaseLanes = &optics.phase[group.first];
        let sine = (1.0 - mu * mu).max(0.0).sqrt();
        for p in 0..pairs.len() {
            let nu = (pairs.mu_s[p] * mu + pairs.across[p] * sine).clamp(-1.0, 1.0);
            let mut depth = Lanes::ZERO;
            for w in 0..WIDTH {
                depth[w] = if once[p][w] > 0.0 { deeper[p][w] / once[p][w] } else { 0.0 };
            }
            let more = peak.mean(nu, depth) * once[p];
            let value = phase.value(nu);
            let near = nearness(nu);
            for w in 0..WIDTH {
                multiple[p][w] += (1.0 - near) * more[w];
                once[p][w] += if value[w] > 0.0 { near * more[w] / value[w] } else { 0.0 };
            }
        }
    }

    /// Adds the ground's light that forward peaks send on towards the start: seen through the air without them,
    /// less what comes straight and is no part of the air's light.
    #[inline(always)]
    fn ground_beside_its_image(
        &self,
        path: &Path,
        attenuation: &Attenuation,
        pairs: &Pairs,
        out: &mut RayLight,
    ) {
        let beside = attenuation.transmittance - (out.depth * -1.0).exp();
        if beside.0.iter().all(|&v| v <= 0.0) {
            return;
        }
        let (batch, axis) = (self.batch, &self.solution.geometry.axis);
        let albedo = batch.optics.albedo * FRAC_1_PI as f32;
        let hit = Hit::at(path, beside);
        for p in 0..pairs.len() {
            let mu_s = pairs.mu_s[p] * hit.cos_turn + pairs.across[p] * hit.sin_turn;
            let cosine = if mu_s > 0.0 { mu_s } else { 0.0 };
            let flux = batch.sunlight.at(0, mu_s) * cosine + interpolate(&batch.state.ground, axis, mu_s);
            let light = beside * albedo * flux;
            for (g, group) in self.groups.iter().enumerate() {
                out.multiple[g * pairs.len() + p] += light * group.share_of_peaks;
            }
        }
    }
}

impl Thick {
    fn new(solution: &Solution, batch: &Batch, groups: &[Group]) -> Self {
        let Solution { basis, .. } = solution;
        let zeroth: Vec<usize> = basis.of_order(0).collect();
        let one = [Lanes::splat(1.0)];
        let sources = |g: &Group| {
            let shares: Vec<Vec<Lanes>> = batch.optics.scattering.iter().map(|_| one.to_vec()).collect();
            let all = source_factors(basis, &batch.optics, &shares, &[g.first], 0);
            vec![zeroth.iter().map(|&t| all[t]).collect()]
        };
        Thick {
            degrees: Degrees::new(basis),
            turns: bundles::turns(solution.geometry.is_tall()),
            sources: groups.iter().map(sources).collect(),
        }
    }
}

/// 1 near the forward direction, 0 from about a right angle on.
#[inline(always)]
fn nearness(nu: f32) -> f32 {
    let t = (nu / 0.6).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn group(solution: &Solution, batch: &Batch, members: &[usize]) -> Group {
    let geometry = &solution.geometry;
    let optics = &batch.optics;
    let scattering = optics.group_scattering(members);
    let deeper = optics.peaks[members[0]]
        .is_some()
        .then(|| batch.sunlight.times_depth(&solution.columns, &scattering));
    let share_of_peaks = solution.share_of_peaks(optics, members);
    if geometry.levels.is_refined() {
        // Bundles take the state as it is.
        let (basis, field) = (solution.basis.clone(), Field::default());
        return Group { deeper, share_of_peaks, basis, field, first: members[0], scattering };
    }
    // The shares are in the weights of the rays; those of the group's first constituent stand for its phase.
    let shares: Vec<Vec<Lanes>> =
        (0..optics.scattering.len()).map(|_| vec![Lanes::splat(1.0); geometry.levels.field.len()]).collect();
    let all = batch.state.field(&solution.basis, optics, &geometry.levels, &shares, &members[..1]);
    let (basis, field) = needed_terms(&solution.basis, optics, members, all);
    Group { deeper, share_of_peaks, basis, field, first: members[0], scattering }
}

/// Keeps the degrees that the group's phase functions have: an isotropic group needs but one term.
fn needed_terms(basis: &Basis, optics: &Optics, members: &[usize], all: Field) -> (Basis, Field) {
    let needed =
        |l: usize| l == 0 || members.iter().any(|&c| optics.legendre[c][l].0.iter().any(|v| v.abs() > 1e-6));
    let mut degrees: Vec<usize> = basis.terms.iter().map(|t| t.0).filter(|&l| needed(l)).collect();
    degrees.sort_unstable();
    degrees.dedup();
    let smaller = Basis::new(&degrees);
    if smaller.len() == basis.len() {
        return (smaller, all);
    }
    let from = smaller.terms.iter().map(|&(l, m)| basis.index(l, m).expect("a term of the larger basis"));
    let from: Vec<usize> = from.collect();
    let levels = all.values.chunks_exact(basis.len() * all.suns);
    let values =
        levels.flat_map(|level| from.iter().flat_map(|t| &level[t * all.suns..][..all.suns])).copied();
    (smaller.clone(), Field { terms: smaller.len(), suns: all.suns, values: values.collect() })
}
