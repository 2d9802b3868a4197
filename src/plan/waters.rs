//! Waters of a scene: sizes of their tables and orders of scattering, measured as those of the sky are.

use super::search::{Omission, TAIL, beyond};
use super::validation_views::Errors;
use super::water_trial::{Trial, Under};
use crate::colour::weights::ColourWeights;
use crate::error::Result;
use crate::layout::water::lookup::{WaterSky, WaterView};
use crate::layout::water::{SIZE, Split, bytes};
use crate::medium::Medium;
use crate::preset::{self, Metric, Planet, Scene, SceneWater, Water};
use crate::quality::colour_error;
use crate::spectrum::{ColourSpace, delta_e_2000_scaled, multiply};
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Solution;
use sobol_burley::sample;

/// Views of a water in each of the three sets.
const VIEWS: usize = 300;
/// Lowest sun and view over a water, degrees: closer to the horizontal all that is seen is the mirrored sky.
const LOWEST: f64 = 3.0;
const AXES: [&str; 3] = ["depth", "view", "sun"];

/// What the waters of a scene need.
#[derive(Clone, Debug)]
pub struct WaterPlan {
    /// As the scene names them, and the largest depth of each, m.
    pub waters: Vec<(String, f64)>,
    /// Texels of depth, view and sun.
    pub size: [usize; 3],
    pub orders: WaterOrders,
    /// Bytes of texels, whole and planned.
    pub bytes: [usize; 2],
    /// Errors on views that nothing was decided on, whole and planned: of the water that does worst.
    pub errors: [Errors; 2],
    pub omissions: Vec<Omission>,
    pub measured: usize,
}

/// Loads the waters of a scene, their tables no deeper than it needs.
pub fn load(scene: &Scene) -> Result<Vec<Water>> {
    let one = |w: &SceneWater| {
        let mut water = preset::load_water(&w.water, &[])?;
        water.largest_depth = water.largest_depth.min(w.depths[1].max(0.1));
        Ok(water)
    };
    scene.waters.iter().map(one).collect()
}

/// Light over the waters.
pub(super) struct Sky<'a> {
    pub planet: &'a Planet,
    pub medium: &'a Medium,
    pub solution: &'a Solution,
    pub palette: &'a ColourWeights,
}

/// A water with its views and the truth about them, in three sets.
struct Case<'a> {
    trial: Trial<'a>,
    sets: [(Vec<WaterView>, Vec<[f64; 3]>); 3],
}

struct Bench<'a> {
    scene: &'a Scene,
    cases: Vec<Case<'a>>,
    measured: usize,
}

impl Bench<'_> {
    /// Errors of a size on one of the sets, of the water that does worst.
    fn errors(&mut self, size: [usize; 3], orders: WaterOrders, sets: &[usize]) -> Result<Vec<Errors>> {
        self.measured += 1;
        let share = self.scene.tolerance.share;
        let mut worst: Vec<Errors> = Vec::new();
        for case in &self.cases {
            let sky = case.trial.sky(size, orders)?;
            for (k, &set) in sets.iter().enumerate() {
                let errors = self.compare(case, &case.sets[set], &sky);
                match worst.get_mut(k) {
                    Some(w) if errors.at(share) > w.at(share) => *w = errors,
                    Some(_) => {}
                    None => worst.push(errors),
                }
            }
        }
        Ok(worst)
    }

    fn compare(&self, case: &Case, set: &(Vec<WaterView>, Vec<[f64; 3]>), sky: &WaterSky) -> Errors {
        let found = case.trial.found(&set.0, sky);
        let to_xyz = ColourSpace::Srgb.to_xyz();
        let one = |(found, truth): (&[f64; 3], &[f64; 3])| match self.scene.tolerance.metric {
            Metric::Relative => colour_error(*found, *truth),
            Metric::DeltaE => delta_e_2000_scaled(multiply(&to_xyz, *truth), multiply(&to_xyz, *found)),
        };
        Errors::new(found.iter().zip(&set.1).map(one).collect())
    }
}

fn views(scene: &Scene, [shallow, deep]: [f64; 2], water: &Water, seed: u32) -> Vec<WaterView> {
    let sine = |degrees: f64| libm::sin(degrees.to_radians());
    let [low, high] = scene.suns.map(|e| e.max(LOWEST));
    let one = |k: u32| {
        let u = |dimension| f64::from(sample(k, dimension, seed));
        let depth = shallow + (deep.min(water.largest_depth) - shallow).max(0.0) * u(0);
        let mu = sine(LOWEST) + (1.0 - sine(LOWEST)) * u(1);
        WaterView { depth, mu, mu_s: sine(low + (high - low) * u(2)) }
    };
    (0..VIEWS as u32).map(one).collect()
}

/// Plans the waters of a scene; none where it has none.
pub(super) fn plan(
    scene: &Scene,
    sky: &Sky,
    share: f64,
    seed: u32,
    talk: &mut dyn FnMut(&str),
) -> Result<Option<WaterPlan>> {
    let waters = load(scene)?;
    if waters.is_empty() {
        return Ok(None);
    }
    talk("waters: truth");
    let Sky { planet, medium, solution, palette } = *sky;
    let split = Split::new(medium, solution);
    let under = Under { planet, medium, solution, palette, split: &split };
    let mut cases = Vec::new();
    for (water, stated) in waters.iter().zip(&scene.waters) {
        let trial = Trial::new(under, water)?;
        // Of the smallest tables the colours, which are those of all.
        let colours = trial.sky([2, 2, 2], WaterOrders::All)?;
        let sets = [0, 1, 2].map(|k| {
            let views = views(scene, stated.depths, water, seed.wrapping_add(k));
            let truth = trial.truth(&views, &colours);
            (views, truth)
        });
        cases.push(Case { trial, sets });
    }
    let mut bench = Bench { scene, cases, measured: 0 };
    let (whole, all) = (SIZE, WaterOrders::All);
    let most = scene.tolerance.most;
    let (mut size, mut orders, mut omissions) = (whole, all, Vec::new());
    let mut error = bench.errors(size, orders, &[0])?[0].at(share);
    let cost = |size| bytes(waters.len(), size);
    let mut refused = [false; 3];
    let mut history = vec![size];
    while refused.contains(&false) {
        // The axis with the most texels first: it saves as much as any, and has the closest.
        let axis = (0..3).filter(|&a| !refused[a]).max_by_key(|&a| (size[a], 3 - a)).expect("one is left");
        let mut next = size;
        next[axis] = (size[axis] * 5).div_ceil(8).max(2);
        if next == size {
            refused[axis] = true;
            continue;
        }
        let errors = bench.errors(next, orders, &[0])?.remove(0);
        let after = errors.at(share);
        let worst_views = after <= most && errors.at(beyond(share)) > TAIL * most;
        let left_out = after <= most && !worst_views;
        let omission = Omission {
            what: format!("waters: {} texels", AXES[axis]),
            left_out,
            sizes: Some([size[axis], next[axis]]),
            saves_bytes: cost(size) as i64 - cost(next) as i64,
            saves_fetches: 0,
            error: [error, after],
            worst_views,
        };
        if left_out {
            talk(&format!("{}: error {}", omission.what, scene.tolerance.text(after)));
            (size, error) = (next, after);
            history.push(size);
        } else {
            refused[axis] = true;
        }
        add(&mut omissions, omission);
    }
    // The second set confirms, as for the sky.
    while history.len() > 1 {
        size = history[history.len() - 1];
        if bench.errors(size, orders, &[1])?[0].share_within(most) >= scene.tolerance.share {
            break;
        }
        history.pop();
    }
    size = history[history.len() - 1];
    for n in [1, 2] {
        let fewer = WaterOrders::First(n);
        let after = bench.errors(size, fewer, &[0])?[0].at(share);
        let left_out = after <= most;
        let what = format!("waters: orders of scattering after {n}");
        omissions.push(Omission {
            what,
            left_out,
            sizes: None,
            saves_bytes: 0,
            saves_fetches: 0,
            error: [error, after],
            worst_views: false,
        });
        if left_out {
            orders = fewer;
            break;
        }
    }
    let full = bench.errors(whole, all, &[2])?.remove(0);
    let planned = bench.errors(size, orders, &[2])?.remove(0);
    let named = scene.waters.iter().zip(&waters).map(|(s, w)| (s.water.clone(), w.largest_depth)).collect();
    Ok(Some(WaterPlan {
        waters: named,
        size,
        orders,
        bytes: [cost(whole), cost(size)],
        errors: [full, planned],
        omissions,
        measured: bench.measured,
    }))
}

/// Adds an omission to an earlier one of the same axis.
fn add(omissions: &mut Vec<Omission>, omission: Omission) {
    let same = |o: &&mut Omission| o.what == omission.what && o.left_out && omission.left_out;
    match (omissions.iter_mut().find(same), omission.sizes) {
        (Some(o), Some([_, to])) => {
            o.sizes = o.sizes.map(|[from, _]| [from, to]);
            o.saves_bytes += omission.saves_bytes;
            o.error[1] = omission.error[1];
        }
        _ => omissions.push(omission),
    }
}
