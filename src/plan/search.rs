//! Greedy search: of all that can be left out, again and again what saves most for what it costs in error, as long as
//! the tolerance holds.

use super::evaluator::Evaluator;
use super::model::{Cost, Model};
use super::simplifications::Simplification;
use super::validation_views::{Errors, ValidationViews};
use crate::error::Result;
use crate::preset::Scene;
use serde_json::{Value, json};

/// What became of one thing that can be left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Omission {
    pub what: String,
    pub left_out: bool,
    /// Texels of the axis before and after.
    pub sizes: Option<[usize; 2]>,
    pub saves_bytes: i64,
    pub saves_fetches: i64,
    /// Error of the promised share of the views before and after.
    pub error: [f64; 2],
    /// Kept because the worst views beyond that share would get too bad.
    pub worst_views: bool,
}

/// A model that was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Tried {
    pub cost: Cost,
    pub error: f64,
}

/// A search under way.
pub(super) struct Search<'a, 'b> {
    pub scene: &'a Scene,
    pub judge: &'a ValidationViews,
    pub evaluator: &'a mut Evaluator<'b>,
    /// Share of the judge's views that must hold: more than promised, for the views that it does not know.
    pub share: f64,
    pub model: Model,
    pub errors: Errors,
    /// Error that nine in ten of the views beyond the promised share may have.
    tail: f64,
    /// Models on the way here, the first with all that there is.
    pub history: Vec<Model>,
    pub omissions: Vec<Omission>,
    pub tried: Vec<Tried>,
}

/// A move and what is known of it.
struct Candidate {
    step: Simplification,
    /// Saving over strain when it was last measured, and at which model.
    score: f64,
    measured_at: usize,
}

/// How many times the tolerance nine in ten of the views beyond the promised share keep within, or else within what the
/// whole tables do there: a promise about 95 % is not one to spoil the rest.
pub(super) const TAIL: f64 = 4.0;
/// Least strain that a saving is divided by: what costs less is as good as free.
const FREE: f64 = 2e-3;

impl<'a, 'b> Search<'a, 'b> {
    pub(super) fn new(
        scene: &'a Scene,
        judge: &'a ValidationViews,
        evaluator: &'a mut Evaluator<'b>,
        share: f64,
        model: Model,
    ) -> Result<Self> {
        let errors = evaluator.measure(&model, judge)?;
        let first = Tried { cost: evaluator.cost(&model)?, error: errors.at(share) };
        let tail = errors.at(beyond(share)).max(TAIL * scene.tolerance.most);
        Ok(Search {
            scene,
            judge,
            evaluator,
            share,
            tail,
            errors,
            history: vec![model.clone()],
            model,
            omissions: Vec::new(),
            tried: vec![first],
        })
    }

    pub(super) fn error(&self) -> f64 {
        self.errors.at(self.share)
    }

    /// Measures what a step leads to; none where it leads nowhere.
    fn try_step(&mut self, step: &Simplification) -> Result<Option<(Model, Errors, Omission)>> {
        let Some(model) = step.applied(&self.model, self.scene, self.evaluator)? else { return Ok(None) };
        let errors = self.evaluator.measure(&model, self.judge)?;
        let (before, after) = (self.evaluator.cost(&self.model)?, self.evaluator.cost(&model)?);
        self.tried.push(Tried { cost: after, error: errors.at(self.share) });
        let omission = Omission {
            what: step.text(self.scene),
            left_out: false,
            sizes: step.sizes(&self.model, &model),
            saves_bytes: before.bytes as i64 - after.bytes as i64,
            saves_fetches: before.fetches as i64 - after.fetches as i64,
            error: [self.error(), errors.at(self.share)],
            worst_views: errors.at(self.share) <= self.scene.tolerance.most && !self.holds(&errors),
        };
        Ok(Some((model, errors, omission)))
    }

    /// Takes a step, and adds it to what was left out of the same axis before.
    pub(super) fn take(&mut self, model: Model, errors: Errors, omission: Omission) {
        (self.model, self.errors) = (model.clone(), errors);
        self.history.push(model);
        let earlier = self.omissions.iter_mut().find(|o| o.left_out && o.what == omission.what);
        match (earlier, omission.sizes) {
            (Some(o), Some([_, to])) => {
                o.sizes = o.sizes.map(|[from, _]| [from, to]);
                o.saves_bytes += omission.saves_bytes;
                o.saves_fetches += omission.saves_fetches;
                o.error[1] = o.error[1].max(omission.error[1]);
            }
            _ => self.omissions.push(Omission { left_out: true, ..omission }),
        }
    }

    fn keep(&mut self, omission: Omission) {
        self.omissions.push(omission);
    }

    fn holds(&self, errors: &Errors) -> bool {
        errors.at(self.share) <= self.scene.tolerance.most && errors.at(beyond(self.share)) <= self.tail
    }

    /// Leaves out what the scene cannot meet, if that does no harm.
    pub(super) fn windows(&mut self) -> Result<()> {
        for step in Simplification::windows() {
            let Some((model, errors, omission)) = self.try_step(&step)? else { continue };
            let no_worse = errors.at(self.share) <= 1.1 * self.error() || self.holds(&errors);
            if no_worse { self.take(model, errors, omission) } else { self.keep(omission) }
        }
        Ok(())
    }

    /// The same with more texels on every axis of the tables of light, where what there is does not hold.
    pub(super) fn grow(&mut self, factor: f64) -> Result<()> {
        let mut model = self.model.clone();
        let more = |n: &mut usize, even: bool| {
            if *n > 1 {
                *n = ((*n as f64 * factor).round() as usize).max(2);
                *n += usize::from(even && *n % 2 == 1);
            }
        };
        let sizes = &mut model.design.sizes;
        sizes.single.iter_mut().enumerate().for_each(|(axis, n)| more(n, axis == 1));
        sizes.multiple.iter_mut().enumerate().for_each(|(axis, n)| more(n, axis == 1));
        let errors = self.evaluator.measure(&model, self.judge)?;
        let cost = self.evaluator.cost(&model)?;
        self.tried.push(Tried { cost, error: errors.at(self.share) });
        (self.model, self.errors) = (model.clone(), errors);
        self.history = vec![model];
        Ok(())
    }

    /// Leaves out parts and texels until nothing more holds. With `goal`, on until a model costs no more, whatever its
    /// error is.
    pub(super) fn parts(
        &mut self,
        talk: &mut dyn FnMut(&str),
        goal: Option<&dyn Fn(&Cost) -> bool>,
    ) -> Result<()> {
        let steps = Simplification::parts(self.evaluator.medium(&self.model.clone())?);
        let fresh = |step| Candidate { step, score: f64::INFINITY, measured_at: usize::MAX };
        let mut candidates: Vec<Candidate> = steps.into_iter().map(fresh).collect();
        let done = |search: &mut Self| -> Result<bool> {
            let cost = search.evaluator.cost(&search.model)?;
            Ok(goal.is_some_and(|goal| goal(&cost)))
        };
        while !candidates.is_empty() && !done(self)? {
            // The first of equals, so that the order of the moves decides.
            let mut best = 0;
            for k in 1..candidates.len() {
                if candidates[k].score > candidates[best].score {
                    best = k;
                }
            }
            let mut candidate = candidates.remove(best);
            let Some((model, errors, omission)) = self.try_step(&candidate.step)? else { continue };
            if goal.is_none() && !self.holds(&errors) {
                self.keep(omission);
                continue;
            }
            let score = self.score(&model, &errors)?;
            if score <= 0.0 {
                continue;
            }
            let next = candidates.iter().map(|c| c.score).fold(0.0, f64::max);
            if score >= next || candidate.measured_at == self.history.len() {
                talk(&format!(
                    "{}: error {}",
                    omission.what,
                    self.scene.tolerance.text(errors.at(self.share))
                ));
                self.take(model, errors, omission);
            }
            (candidate.score, candidate.measured_at) = (score, self.history.len());
            candidates.push(candidate);
        }
        Ok(())
    }

    /// Shares of bytes and fetches saved, over the strain that it costs.
    fn score(&mut self, model: &Model, errors: &Errors) -> Result<f64> {
        let (before, after) = (self.evaluator.cost(&self.model)?, self.evaluator.cost(model)?);
        let share = |a: usize, b: usize| (a as f64 - b as f64) / a.max(1) as f64;
        let saved = share(before.bytes, after.bytes) + share(before.fetches, after.fetches);
        let most = self.scene.tolerance.most;
        Ok(saved / (errors.strain(most) - self.errors.strain(most)).max(FREE))
    }

    /// Leaves out orders of scattering, where fewer cost the solver less and hold; and says what fewer wavelengths would
    /// cost, which save nothing: sixteen are worked on at once.
    pub(super) fn light(&mut self) -> Result<()> {
        let all = self.evaluator.applications(&self.model.clone())?;
        for n in [2, 3, 4, 6] {
            if n >= all {
                break;
            }
            let Some((model, errors, omission)) = self.try_step(&Simplification::Orders(n))? else { break };
            if self.holds(&errors) {
                self.take(model, errors, omission);
                break;
            }
            self.keep(omission);
        }
        if let Some((_, _, omission)) = self.try_step(&Simplification::Wavelengths(8))? {
            self.keep(omission);
        }
        Ok(())
    }
}

impl Omission {
    pub fn json(&self) -> Value {
        let digits = crate::quality::digits;
        let mut out = json!({
            "what": self.what,
            "left_out": self.left_out,
            "saves_bytes": self.saves_bytes,
            "saves_fetches": self.saves_fetches,
            "error_before": digits(self.error[0]),
            "error_after": digits(self.error[1]),
            "worst_views": self.worst_views,
        });
        if let Some([from, to]) = self.sizes {
            out["from"] = json!(from);
            out["to"] = json!(to);
        }
        out
    }
}

/// The share that has nine in ten of the views beyond another one.
pub(super) fn beyond(share: f64) -> f64 {
    1.0 - 0.1 * (1.0 - share)
}

/// Of all that was tried, what nothing else beats in bytes, fetches and error; smallest first.
pub(super) fn front(tried: &[Tried]) -> Vec<Tried> {
    let beats = |a: &Tried, b: &Tried| {
        let no_worse = a.cost.bytes <= b.cost.bytes && a.cost.fetches <= b.cost.fetches && a.error <= b.error;
        no_worse && a != b
    };
    let mut out: Vec<Tried> =
        tried.iter().filter(|t| !tried.iter().any(|other| beats(other, t))).cloned().collect();
    out.sort_by_key(|t| (t.cost.bytes, t.cost.fetches));
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is larger and worse is left out; what is larger and better stays.
    #[test]
    fn fronts() {
        let tried =
            |bytes, fetches, error| Tried { cost: Cost { bytes, fetches, sky_fetches: fetches }, error };
        let all = [tried(9, 2, 0.1), tried(5, 2, 0.3), tried(6, 2, 0.4), tried(5, 2, 0.3), tried(7, 1, 0.4)];
        assert_eq!(front(&all), [tried(5, 2, 0.3), tried(7, 1, 0.4), tried(9, 2, 0.1)]);
    }
}
