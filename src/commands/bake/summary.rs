//! What came of the bakes of a run: lines, one table, or JSON.

use super::super::text::print;
use super::progress::Stage;
use crate::error::{Error, Result};
use crate::layout::settings::Settings;
use crate::layout::{self, Layout};
use crate::machine::memory;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// A finished bake.
pub(super) struct Done {
    pub folder: PathBuf,
    pub files: usize,
    pub bytes: usize,
    pub warnings: Vec<String>,
    pub quality: Map<String, Value>,
    pub stages: Vec<Stage>,
    /// Memory that the bake was thought to take, bytes; 0 where nothing was solved.
    pub need: u64,
    /// It stood there already, and nothing was solved.
    pub reused: bool,
}

/// What came of one preset.
pub(super) struct Outcome {
    /// Name of the planet, or what was asked for where there is no planet.
    pub name: String,
    pub result: Result<Done>,
}

/// The largest error that a bake found in its own tables, and where.
#[derive(Debug, PartialEq)]
pub(super) struct Worst {
    pub error: f64,
    pub layout: String,
    pub region: String,
}

impl Done {
    /// Of a bake that was looked at and left.
    pub(super) fn nothing(folder: PathBuf) -> Self {
        let (warnings, quality, stages) = Default::default();
        Done { folder, files: 0, bytes: 0, warnings, quality, stages, need: 0, reused: true }
    }

    /// Largest error of the tables of all layouts against direct integration of their own medium.
    pub(super) fn worst(&self) -> Option<Worst> {
        let mut worst: Option<Worst> = None;
        let mut look = |layout: &str, region: &str, found: &Value| {
            if let Some(error) = found["max"].as_f64()
                && worst.as_ref().is_none_or(|w| error > w.error)
            {
                worst = Some(Worst { error, layout: layout.into(), region: region.into() });
            }
        };
        let regions = |key: &str| self.quality.get(key).and_then(Value::as_object).into_iter().flatten();
        for layout in layout::ALL {
            let found = |(region, found): (&String, &Value)| {
                look(layout.name(), region, found.get("per_wavelength").unwrap_or(found));
            };
            regions(layout.report_key()).for_each(found);
        }
        for (layout, key) in
            [("water", "tables_against_solver"), ("underwater", "underwater_tables_against_solver")]
        {
            regions("water").for_each(|(water, found)| look(layout, water, &found[key]));
        }
        worst
    }

    /// Error of a layout's tables by day, below which 95 % of the report's views lie.
    fn by_day(&self, layout: &dyn Layout) -> Option<f64> {
        let found = &self.quality.get(layout.report_key())?["day"];
        found.get("per_wavelength").unwrap_or(found)["p95"].as_f64()
    }

    /// Error of the energy balance of the medium as it is, or else of the paper's; none where orders were counted.
    pub(super) fn balance(&self) -> Option<f64> {
        let of = |key: &str| self.quality.get(key).and_then(|s| s["energy_balance_error"].as_f64());
        of("solver").or_else(|| of("paper_medium_solver"))
    }

    fn json(&self) -> Value {
        let seconds = |d: &std::time::Duration| (d.as_secs_f64() * 1e4).round() / 1e4;
        let stage = |(n, w, c): &Stage| json!({ "stage": n, "wall_s": seconds(w), "cpu_s": seconds(c) });
        let worst = |w: Worst| json!({ "error": w.error, "layout": w.layout, "region": w.region });
        json!({
            "folder": self.folder.to_string_lossy(),
            "files": self.files,
            "bytes": self.bytes,
            "worst_table_error": self.worst().map(worst),
            "energy_balance_error": self.balance(),
            "warnings": self.warnings,
            "quality": self.quality,
            "estimated_memory_bytes": self.need,
            "perf": self.stages.iter().map(stage).collect::<Vec<_>>(),
        })
    }
}

impl Outcome {
    /// One object on one line.
    fn json(&self) -> Value {
        match &self.result {
            Ok(done) => {
                let Value::Object(more) = done.json() else { unreachable!("an object was made") };
                let first = [
                    ("preset", json!(self.name)),
                    ("outcome", json!(if done.reused { "reused" } else { "baked" })),
                ];
                first.map(|(k, v)| (k.to_string(), v)).into_iter().chain(more).collect()
            }
            Err(error) => json!({ "preset": self.name, "outcome": "failed", "error": error.to_string(),
                "exit_code": error.exit_code() }),
        }
    }
}

/// Prints what came of all presets, in their order: a line of JSON each, or else the lines of one bake or the table
/// of several, with the times of their stages if wanted.
pub(super) fn tell(outcomes: &[Outcome], as_json: bool, perf: bool) -> Result<()> {
    if as_json {
        return print(&outcomes.iter().map(|o| format!("{}\n", o.json())).collect::<String>());
    }
    let mut out = String::new();
    if perf {
        let bakes = outcomes.iter().filter_map(|o| o.result.as_ref().ok());
        bakes.for_each(|done| out.push_str(&format!("{}{}", headline(done), times(&done.stages))));
        if let Some(peak) = memory::peak() {
            let need = outcomes.iter().filter_map(|o| o.result.as_ref().ok()).map(|done| done.need).max();
            let megabytes = |bytes: u64| bytes as f64 / 1e6;
            out.push_str(&format!(
                "  peak memory {:.0} MB, estimated {:.0} MB\n",
                megabytes(peak),
                megabytes(need.unwrap_or(0))
            ));
        }
    }
    match outcomes {
        [Outcome { result: Ok(done), .. }] if !perf => out.push_str(&headline(done)),
        [_] => {}
        several => out.push_str(&table(several)),
    }
    print(&out)
}

fn headline(done: &Done) -> String {
    let reused = if done.reused { ", there already" } else { "" };
    format!("{}: {} files, {:.1} MB{reused}\n", done.folder.display(), done.files, done.bytes as f64 / 1e6)
}

fn times(stages: &[Stage]) -> String {
    let line = |(name, wall, cpu): &Stage| {
        let (wall, cpu) = (wall.as_secs_f64(), cpu.as_secs_f64());
        format!("  {name:<22} {wall:7.3} s wall {cpu:7.3} s CPU\n")
    };
    stages.iter().map(line).collect()
}

fn table(outcomes: &[Outcome]) -> String {
    let width = outcomes.iter().map(|o| o.name.chars().count()).max().unwrap_or(0).max("preset".len());
    let layouts = shown(outcomes);
    let heads: String = layouts.iter().map(|l| format!("{:>8}  ", l.name())).collect();
    let mut out = format!(
        "{:width$}  {:>5}  {:>6}  {heads}{:>9}  {:>8}  outcome\n",
        "preset", "files", "MB", "balance", "warnings"
    );
    for o in outcomes {
        let line = match &o.result {
            Ok(done) => row(done, &layouts),
            Err(e) => {
                let dash = "-";
                let dashes: String = layouts.iter().map(|l| cell(*l, dash)).collect();
                format!("{dash:>5}  {dash:>6}  {dashes}{dash:>9}  {dash:>8}  failed: {e}")
            }
        };
        out.push_str(&format!("{:width$}  {line}\n", o.name));
    }
    let names: Vec<&str> = layouts.iter().map(|l| l.name()).collect();
    out.push_str(&format!(
        "{}: error of their tables by day, below which 95 % of views lie; balance: energy lost or won\n",
        names.join(", ")
    ));
    out
}

/// Layouts that have a column: the two of a bake that asks for none, and whichever a bake has.
fn shown(outcomes: &[Outcome]) -> Vec<&'static dyn Layout> {
    let usual = Settings::default();
    let bakes = || outcomes.iter().filter_map(|o| o.result.as_ref().ok());
    let has = |layout: &dyn Layout| bakes().any(|done| done.by_day(layout).is_some());
    layout::ALL.into_iter().filter(|layout| usual.has(layout.name()) || has(*layout)).collect()
}

/// A cell below the name of a layout.
fn cell(layout: &dyn Layout, text: &str) -> String {
    let width = layout.name().len().max(8);
    format!("{text:>width$}  ")
}

fn row(done: &Done, layouts: &[&dyn Layout]) -> String {
    let of = |layout: &&dyn Layout| cell(*layout, &done.by_day(*layout).map_or("-".into(), percent));
    let errors: String = layouts.iter().map(of).collect();
    let balance = done.balance().map_or("-".into(), |b| format!("{:+.3} %", 100.0 * b));
    let megabytes = done.bytes as f64 / 1e6;
    let (files, warnings, folder) = (done.files, done.warnings.len(), done.folder.display());
    let reused = if done.reused { " (there already)" } else { "" };
    format!("{files:>5}  {megabytes:>6.1}  {errors}{balance:>9}  {warnings:>8}  {folder}{reused}")
}

/// A share in per cent; what is beyond all use as such.
fn percent(share: f64) -> String {
    match 100.0 * share {
        p if p >= 1e4 => "> 9999 %".into(),
        p => format!("{p:.1} %"),
    }
}

/// The failure of a run: its own where one preset was asked for, else how many failed, with the highest exit code
/// among them.
pub(super) fn failure(outcomes: Vec<Outcome>) -> Result<()> {
    let of = outcomes.len();
    let mut errors: Vec<Error> = outcomes.into_iter().filter_map(|o| o.result.err()).collect();
    match (errors.len(), of) {
        (0, _) => Ok(()),
        (1, 1) => Err(errors.remove(0)),
        (failed, _) => {
            let code = errors.iter().map(Error::exit_code).max().unwrap_or(3);
            Err(Error::Several { failed, of, code })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn done(layout: &dyn Layout) -> Done {
        let error = if layout.name() == "compact" {
            json!({ "day": { "per_wavelength": { "max": 0.7, "p95": 0.25 } } })
        } else {
            json!({ "day": { "max": 0.7, "p95": 0.25 } })
        };
        let mut done = Done::nothing(PathBuf::from("out/x"));
        done.quality.insert(layout.report_key().into(), error);
        done
    }

    /// The worst error of a bake is found in whichever layout it has, and the table of several has its column.
    #[test]
    fn every_layout_is_summed_up() {
        for layout in layout::ALL {
            let worst = done(layout).worst().unwrap();
            assert_eq!(
                (worst.error, worst.layout.as_str(), worst.region.as_str()),
                (0.7, layout.name(), "day")
            );
            let outcome = Outcome { name: "x".into(), result: Ok(done(layout)) };
            let text = table(&[outcome]);
            let lines: Vec<&str> = text.lines().collect();
            assert!(lines[0].contains(layout.name()) && lines[1].contains("25.0 %"), "{text}");
            let end = |line: &str, word: &str| line.find(word).map(|at| at + word.len());
            assert_eq!(end(lines[0], layout.name()), end(lines[1], "25.0 %"), "{text}");
        }
    }
}
