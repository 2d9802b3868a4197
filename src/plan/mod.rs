//! The planner: the least model that shows a scene within its tolerance.
//!
//! It starts from the whole tables and leaves out, one by one, what the scene cannot meet, whole parts, and texels of
//! every axis. Each is measured: tables are filled and looked up as a reader of the bake would, on views drawn from the
//! scene, against direct integration of the solver's field at its finest. A second set of views confirms what the first
//! has chosen, and a third, on which nothing was decided, says how well it does.

mod evaluator;
mod model;
mod report;
mod search;
mod simplifications;
mod validation_views;
mod water_trial;
mod waters;

pub use model::{Cost, Model};
pub use search::{Omission, Tried};
pub use validation_views::Errors;
pub use waters::{WaterPlan, load as load_waters};

use crate::error::{Error, Result};
use crate::layout::settings::WAVELENGTHS;
use crate::preset::{Planet, Scene};
use crate::spectrum::{Reconstruction, grid};
use crate::transport::solve::{Orders, Resolution, Solution};
use evaluator::Evaluator;
use search::{Search, front};
use validation_views::{Truth, ValidationViews};

/// Views of each of the three sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    pub views: usize,
    /// Resolution and tolerance of the light that is taken for true.
    pub truth: (Resolution, f64),
    /// Seed of the first set; the others follow.
    pub seed: u32,
}

impl Default for Effort {
    fn default() -> Self {
        Effort { views: 1000, truth: (Resolution::EXACT, 2e-5), seed: 1 }
    }
}

/// A model with its costs and what it does on views that nothing was decided on.
#[derive(Clone, Debug)]
pub struct Measured {
    pub model: Model,
    pub cost: Cost,
    pub errors: Errors,
    /// Processor seconds of the light and of the tables.
    pub seconds: [f64; 2],
}

/// What a scene needs.
#[derive(Clone, Debug)]
pub struct Plan {
    pub scene: Scene,
    pub full: Measured,
    pub planned: Measured,
    pub omissions: Vec<Omission>,
    pub waters: Option<WaterPlan>,
    /// What the scene asks for and the planned model does not give; none where all holds.
    pub unmet: Vec<String>,
    /// Of all models that were measured, those that nothing beats, by the first set of views.
    pub front: Vec<Tried>,
    pub measured: usize,
    /// Share of the first set's views that had to hold.
    pub share: f64,
}

/// Plans a scene of a planet. `talk` is told what happens, `clock` gives processor seconds.
///
/// # Errors
/// `Argument` for a scene of whose views none is lit, or a medium without meaning.
pub fn plan(
    planet: &Planet,
    scene: &Scene,
    effort: &Effort,
    talk: &mut dyn FnMut(&str),
    clock: &dyn Fn() -> f64,
) -> Result<Plan> {
    talk("truth: solve");
    let medium = planet.medium(&grid(WAVELENGTHS));
    medium.check().map_err(|reason| Error::Argument(format!("{}: {reason}", planet.name)))?;
    let (resolution, tolerance) = effort.truth;
    let solution = Solution::new(&medium, &resolution, Orders::Converged { tolerance });
    let reconstruction = Reconstruction::new(&medium.wavelengths_nm, &planet.star.irradiance);
    let truth = Truth { medium: &medium, solution: &solution, reconstruction: &reconstruction };
    talk("truth: views");
    let [first, second, third] =
        [0, 1, 2].map(|k| ValidationViews::new(scene, &truth, effort.views, effort.seed.wrapping_add(k)));
    if first.is_empty() || second.is_empty() || third.is_empty() {
        return Err(Error::Argument(format!("scene {}: none of its views is lit", scene.name)));
    }
    let mut evaluator = Evaluator::new(planet);
    let share = with_margin(scene.tolerance.share, effort.views);
    let mut search = Search::new(scene, &first, &mut evaluator, share, Model::default())?;
    search.windows()?;
    for _ in 0..2 {
        if search.error() > scene.tolerance.most {
            search.grow(1.4)?;
        }
    }
    if search.error() <= scene.tolerance.most {
        search.parts(talk, None)?;
        search.light()?;
    }
    let over = |cost: &Cost| over_budget(scene, cost).is_empty();
    let chosen = confirmed(&mut search, &second)?;
    let (omissions, mut tried) = (search.omissions.clone(), search.tried.clone());
    if !over(&search.evaluator.cost(&chosen)?) {
        talk("over the budget: looking further");
        search.parts(talk, Some(&over))?;
        tried.clone_from(&search.tried);
    }
    let water_plan = {
        let (medium, solution, palette) = evaluator.lit(&chosen)?;
        let sky = waters::Sky { planet, medium, solution, palette: &palette };
        waters::plan(scene, &sky, share, effort.seed, talk)?
    };
    talk("times");
    let full = measured(&mut evaluator, &Model::default(), &third, clock)?;
    let planned = measured(&mut evaluator, &chosen, &third, clock)?;
    let unmet = unmet(scene, &planned, water_plan.as_ref());
    let measured = evaluator.measured;
    Ok(Plan {
        scene: scene.clone(),
        full,
        planned,
        omissions,
        waters: water_plan,
        unmet,
        front: front(&tried),
        measured,
        share,
    })
}

/// The share of some views that has to hold so that, but for one case in twenty, the promised share of all views does.
fn with_margin(share: f64, views: usize) -> f64 {
    (share + 1.65 * (share * (1.0 - share) / views as f64).sqrt()).min(1.0)
}

/// The last model on the way that keeps its promise on views that the search does not know.
fn confirmed(search: &mut Search, judge: &ValidationViews) -> Result<Model> {
    let tolerance = search.scene.tolerance;
    while search.history.len() > 1 {
        let model = search.history.last().expect("not empty").clone();
        if search.evaluator.measure(&model, judge)?.share_within(tolerance.most) >= tolerance.share {
            break;
        }
        search.history.pop();
        search.model = search.history.last().expect("not empty").clone();
    }
    Ok(search.history.last().expect("never empty").clone())
}

fn measured(
    evaluator: &mut Evaluator,
    model: &Model,
    judge: &ValidationViews,
    clock: &dyn Fn() -> f64,
) -> Result<Measured> {
    evaluator.forget();
    let start = clock();
    let cost = evaluator.cost(model)?;
    let solved = clock();
    let sky = evaluator.sky(model)?;
    let filled = clock();
    let errors = judge.errors(sky.as_ref());
    Ok(Measured { model: model.clone(), cost, errors, seconds: [solved - start, filled - solved] })
}

fn over_budget(scene: &Scene, cost: &Cost) -> Vec<String> {
    let mut out = Vec::new();
    if let Some(most) = scene.budget.bytes.filter(|most| cost.bytes as f64 > *most) {
        out.push(format!("{} of texels, over {}", report::bytes(cost.bytes), report::bytes(most as usize)));
    }
    if let Some(most) = scene.budget.fetches.filter(|most| cost.fetches as f64 > *most) {
        out.push(format!("{} fetches a view, over {most}", cost.fetches));
    }
    out
}

/// What the scene asks for and a model does not give.
fn unmet(scene: &Scene, planned: &Measured, waters: Option<&WaterPlan>) -> Vec<String> {
    let tolerance = scene.tolerance;
    let of_waters = waters.map_or(0, |w| w.bytes[1]);
    let mut out = over_budget(scene, &Cost { bytes: planned.cost.bytes + of_waters, ..planned.cost });
    let seconds = planned.seconds[0] + planned.seconds[1];
    if let Some(most) = scene.budget.bake_s.filter(|most| seconds > *most) {
        out.push(format!("{seconds:.1} s of processor time, over {most}"));
    }
    // The promise is one about shares: on a set of its own size a hundredth of it is chance.
    let all = [("views", Some(&planned.errors)), ("views of water", waters.map(|w| &w.errors[1]))];
    for (what, errors) in all {
        let Some(share) = errors.map(|e| e.share_within(tolerance.most)) else { continue };
        if share < 0.99 * tolerance.share {
            let (found, wanted) = (100.0 * share, 100.0 * tolerance.share);
            let most = tolerance.text(tolerance.most);
            out.push(format!("{found:.1} % of {what} within {most}, not {wanted:.1} %"));
        }
    }
    out
}
