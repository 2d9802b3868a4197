//! `tyndall chart`: accuracy against cost of every method on one planet, as CSV, SVG and PNG.

use super::machine::with_threads;
use super::text::{print, say, watched};
use crate::chart::draw::pictures;
use crate::chart::stability::{Case, Shared, cases, markdown, run as run_case};
use crate::chart::{
    Chart, Check, Cost, Effort, Measure, Quantity, Row, Statistic, checks_csv, exceptions, front, mark,
    measure, read_csv, rows, to_csv,
};
use crate::error::{Error, Result};
use crate::files::whole;
use crate::methods::{Method, catalogue};
use crate::preset::{self, Planet};
use crate::quality::{REGIONS, digits};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Chart accuracy against cost for every method and setting: CSV, SVG and PNG
#[derive(clap::Args, Debug)]
#[command(before_help = "Example: tyndall chart earth --out out/charts")]
pub struct Args {
    /// A planet by name or path
    #[arg(required_unless_present = "stability")]
    preset: Option<String>,
    /// Instead: how each method bears awkward planets and views, as a table in Markdown on stdout
    #[arg(long, conflicts_with_all = ["preset", "only", "set", "json"])]
    stability: bool,
    /// Folder for `<preset>.csv`, .svg and .png; unfinished work is kept there too
    #[arg(long, default_value = "out/charts", value_name = "FOLDER")]
    out: PathBuf,
    /// Views of each region
    #[arg(long, default_value_t = Effort::default().views, value_name = "N", value_parser = count)]
    views: usize,
    /// Only methods whose name contains this (family: setting)
    #[arg(long, value_name = "TEXT")]
    only: Option<String>,
    /// Error that is drawn; the CSV holds both
    #[arg(long, value_enum, default_value = "delta-e")]
    error: Quantity,
    /// Of its distribution over views; the CSV holds all
    #[arg(long, value_enum, default_value = "p95")]
    statistic: Statistic,
    /// Draw again from the CSV in the folder, without measuring
    #[arg(long, conflicts_with_all = ["views", "only", "set", "stability"])]
    redraw: bool,
    /// Replace a value of the preset, path.to.key=value; repeatable
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Threads [default: all]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// A summary as JSON on stdout
    #[arg(long)]
    json: bool,
    /// No progress on stderr
    #[arg(long)]
    quiet: bool,
}

fn count(text: &str) -> Result<usize> {
    match text.parse() {
        Ok(n) if (1..=10_000).contains(&n) => Ok(n),
        _ => Err("expected a number from 1 to 10000".into()),
    }
}

/// Measures, writes the three files and tells what lies on the fronts.
pub fn run(args: &Args) -> Result<()> {
    let Some(preset) = &args.preset else { return stability(args) };
    let planet = preset::load(preset, &args.set)?;
    let csv = args.out.join(format!("{}.csv", planet.name));
    let (mut rows, checks) = if args.redraw {
        (read_csv(&csv)?, Vec::new())
    } else {
        let chart = measured(args, &planet)?;
        let rows = rows(&chart);
        write(&args.out, &format!("{}-checks.csv", planet.name), checks_csv(&chart).as_bytes())?;
        (rows, chart.checks)
    };
    mark(&mut rows);
    write(&args.out, &format!("{}.csv", planet.name), &to_csv(&rows)?)?;
    let (svg, png) = pictures(&rows, Measure(args.error, args.statistic))?;
    write(&args.out, &format!("{}.svg", planet.name), svg.as_bytes())?;
    write(&args.out, &format!("{}.png", planet.name), &png)?;
    if !args.redraw {
        crate::chart::forget_work(&work_folder(args, &planet))?;
    }
    if args.json {
        return print(&format!("{}\n", summary(&rows, &checks)));
    }
    print(&text(&rows, &checks))
}

fn work_folder(args: &Args, planet: &Planet) -> PathBuf {
    args.out.join(format!("{}.work", planet.name))
}

fn measured(args: &Args, planet: &Planet) -> Result<Chart> {
    let methods = chosen(args)?;
    let effort = Effort { views: args.views, ..Effort::default() };
    let bar = bar(args);
    let tell = |part: &str, done: usize, all: usize| told(args, &bar, part, done, all);
    let folder = work_folder(args, planet);
    let chart = with_threads(args.threads, || measure(planet, &methods, effort, &folder, &tell))??;
    bar.finish_and_clear();
    Ok(chart)
}

fn stability(args: &Args) -> Result<()> {
    let (cases, shared) = (cases()?, Shared::default());
    let bar = bar(args);
    let run = |(n, case): (usize, &Case)| {
        told(args, &bar, case.name, n, cases.len());
        (case.name, run_case(case, false, &shared))
    };
    let outcomes = with_threads(args.threads, || cases.iter().enumerate().map(run).collect::<Vec<_>>())?;
    bar.finish_and_clear();
    print(&markdown(&outcomes))
}

/// Progress: so many parts are done, and this one begins.
fn told(args: &Args, bar: &ProgressBar, part: &str, done: usize, all: usize) {
    bar.set_length(all as u64);
    bar.set_position(done as u64);
    bar.set_message(part.to_string());
    if !args.quiet && bar.is_hidden() {
        say(&format!("{}/{all} {part}", done + 1));
    }
}

fn chosen(args: &Args) -> Result<Vec<Box<dyn Method>>> {
    let wanted = |m: &dyn Method| match &args.only {
        Some(text) => name(m).contains(text.as_str()),
        None => true,
    };
    let methods: Vec<Box<dyn Method>> = catalogue::all().into_iter().filter(|m| wanted(m.as_ref())).collect();
    match (methods.is_empty(), &args.only) {
        (true, Some(text)) => Err(Error::Argument(format!("--only {text}: no method has that in its name"))),
        _ => Ok(methods),
    }
}

fn name(m: &dyn Method) -> String {
    format!("{}: {}", m.family().title(), m.setting())
}

fn bar(args: &Args) -> ProgressBar {
    if args.quiet || !watched() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} {elapsed} {msg}");
    ProgressBar::new(1).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    whole::write(&folder.join(name), bytes)
}

/// Fronts, failures, exceptions by cost and method, and what Monte Carlo says.
fn text(rows: &[Row], checks: &[Check]) -> String {
    let mut out = String::new();
    for region in REGIONS.map(|r| r.name) {
        for cost in Cost::ALL {
            out.push_str(&format!("{region}, front by {}:\n", cost.label()));
            for row in front(rows, region, cost, Measure::DEFAULT) {
                let [median, p95, worst] = [row.delta_e_median, row.delta_e_p95, row.delta_e_worst]
                    .map(|e| e.unwrap_or(f64::INFINITY));
                let cost = digits(cost.of(row));
                out.push_str(&format!(
                    "  {cost:>10}  ΔE2000 {median:.3} {p95:.3} {worst:.3}  {}\n",
                    row.name()
                ));
            }
        }
    }
    for row in rows.iter().filter(|r| !r.failure.is_empty() && r.region == REGIONS[0].name) {
        out.push_str(&format!("no answer: {}: {}\n", row.name(), row.failure));
    }
    for cost in Cost::ALL {
        for (name, regions) in not_dominated(rows, cost) {
            out.push_str(&format!("not dominated by {}: {name} ({})\n", cost.name(), regions.join("; ")));
        }
    }
    for c in checks {
        let (difference, sigma) = (c.monte_carlo / c.truth - 1.0, c.stderr / c.truth);
        let (difference, sigma) = (100.0 * difference, 100.0 * sigma);
        out.push_str(&format!("Monte Carlo, {}: {difference:+.2} ± {sigma:.2} %\n", REGIONS[c.region].name));
    }
    out
}

/// Methods of others that none of ours dominates, with the regions where that is so.
fn not_dominated(rows: &[Row], cost: Cost) -> BTreeMap<String, Vec<&'static str>> {
    let mut out: BTreeMap<String, Vec<&'static str>> = BTreeMap::new();
    for region in REGIONS.map(|r| r.name) {
        for row in exceptions(rows, region, cost) {
            out.entry(row.name()).or_default().push(region);
        }
    }
    out
}

fn summary(rows: &[Row], checks: &[Check]) -> Value {
    let fronts = REGIONS.iter().flat_map(|region| {
        Cost::ALL.map(|cost| {
            let front = front(rows, region.name, cost, Measure::DEFAULT);
            let names: Vec<String> = front.into_iter().map(Row::name).collect();
            json!({ "region": region.name, "cost": cost.name(), "front": names })
        })
    });
    let exceptions = Cost::ALL.into_iter().flat_map(|cost| {
        let found = not_dominated(rows, cost).into_iter();
        found.map(
            move |(method, regions)| json!({ "cost": cost.name(), "method": method, "regions": regions }),
        )
    });
    let checks = checks.iter().map(|c| {
        json!({ "region": REGIONS[c.region].name, "view": c.view, "truth_per_sr": c.truth,
                "monte_carlo_per_sr": c.monte_carlo, "stderr_per_sr": c.stderr })
    });
    json!({
        "preset": rows.first().map(|r| r.preset.as_str()),
        "fronts": fronts.collect::<Vec<_>>(),
        "not_dominated": exceptions.collect::<Vec<_>>(),
        "checks": checks.collect::<Vec<_>>(),
    })
}
