//! `tyndall chart`: accuracy against cost of every method on one planet, as CSV, SVG and PNG.

use super::machine::with_threads;
use super::text::print;
use crate::chart::draw::{Quantity, Statistic, pictures};
use crate::chart::stability::{Case, cases, markdown, run as run_case};
use crate::chart::{Chart, Cost, Effort, Exception, checks_csv, csv, exceptions, front, measure};
use crate::error::{Error, Result};
use crate::methods::{Method, catalogue};
use crate::preset;
use crate::quality::{REGIONS, digits};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::{Value, json};
use std::io::{IsTerminal, Write};
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
    /// Folder for <preset>.csv, .svg and .png; unfinished work is kept there too
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

fn count(text: &str) -> std::result::Result<usize, String> {
    match text.parse() {
        Ok(n) if (1..=10_000).contains(&n) => Ok(n),
        _ => Err("expected a number from 1 to 10000".into()),
    }
}

/// Measures, writes the three files and tells what lies on the fronts.
pub fn run(args: &Args) -> Result<()> {
    let Some(preset) = &args.preset else { return stability(args) };
    let planet = preset::load(preset, &args.set)?;
    let methods = chosen(args)?;
    let work = args.out.join(format!("{}.work", planet.name));
    let effort = Effort { views: args.views, ..Effort::default() };
    let bar = bar(args);
    let tell = |part: &str, done: usize, all: usize| told(args, &bar, part, done, all);
    let chart = with_threads(args.threads, || measure(&planet, &methods, effort, &work, &tell))??;
    bar.finish_and_clear();
    let (svg, png) = pictures(&chart, args.error, args.statistic)?;
    write(&args.out, &format!("{}.csv", chart.planet), csv(&chart).as_bytes())?;
    write(&args.out, &format!("{}-checks.csv", chart.planet), checks_csv(&chart).as_bytes())?;
    write(&args.out, &format!("{}.svg", chart.planet), svg.as_bytes())?;
    write(&args.out, &format!("{}.png", chart.planet), &png)?;
    std::fs::remove_dir_all(&work).map_err(|e| Error::machine(&work, e))?;
    if args.json { print(&format!("{}\n", summary(&chart))) } else { print(&text(&chart)) }
}

fn stability(args: &Args) -> Result<()> {
    let cases = cases()?;
    let bar = bar(args);
    let run = |(n, case): (usize, &Case)| {
        told(args, &bar, case.name, n, cases.len());
        (case.name, run_case(case, false))
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
        let _ = writeln!(std::io::stderr(), "{}/{all} {part}", done + 1);
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
    if args.quiet || !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{wide_bar} {pos}/{len} {elapsed} {msg}");
    ProgressBar::new(1).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// Beside, then renamed: a chart is there whole or not at all.
fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<()> {
    let (path, beside) = (folder.join(name), folder.join(format!("{name}.tmp")));
    std::fs::write(&beside, bytes).map_err(|e| Error::machine(&beside, e))?;
    std::fs::rename(&beside, &path).map_err(|e| Error::machine(&path, e))
}

fn of(chart: &Chart, n: usize) -> String {
    format!("{}: {}", chart.methods[n].family.title(), chart.methods[n].setting)
}

fn text(chart: &Chart) -> String {
    let mut out = String::new();
    for (region, named) in REGIONS.iter().enumerate() {
        for cost in Cost::ALL {
            out.push_str(&format!("{}, front by {}:\n", named.name, cost.name()));
            for n in front(chart, region, cost) {
                let m = &chart.methods[n];
                let e = m.errors(&chart.truth, region).expect("what is on a front answers");
                out.push_str(&format!(
                    "  {:>10}  ΔE2000 {:.3} {:.3} {:.3}  {}\n",
                    digits(cost.of(m)),
                    e.delta_e.median,
                    e.delta_e.p95,
                    e.delta_e.max,
                    of(chart, n)
                ));
            }
        }
    }
    for m in chart.methods.iter().filter(|m| m.failure.is_some()) {
        let reason = m.failure.as_deref().unwrap_or_default();
        out.push_str(&format!("no answer: {}: {}: {reason}\n", m.family.title(), m.setting));
    }
    for Exception { region, cost, method } in exceptions(chart) {
        out.push_str(&format!("not dominated: {region}, {}: {}\n", cost.name(), of(chart, method)));
    }
    for c in &chart.checks {
        let (difference, sigma) = (c.monte_carlo / c.truth - 1.0, c.stderr / c.truth);
        let (difference, sigma) = (100.0 * difference, 100.0 * sigma);
        out.push_str(&format!("Monte Carlo, {}: {difference:+.2} ± {sigma:.2} %\n", REGIONS[c.region].name));
    }
    out
}

fn summary(chart: &Chart) -> Value {
    let fronts = REGIONS.iter().enumerate().flat_map(|(region, named)| {
        Cost::ALL.map(|cost| {
            let names: Vec<String> = front(chart, region, cost).into_iter().map(|n| of(chart, n)).collect();
            json!({ "region": named.name, "cost": cost.name(), "front": names })
        })
    });
    let exceptions = exceptions(chart);
    let exceptions = exceptions
        .iter()
        .map(|e| json!({ "region": e.region, "cost": e.cost.name(), "method": of(chart, e.method) }));
    let checks = chart.checks.iter().map(|c| {
        json!({ "region": REGIONS[c.region].name, "view": c.view, "truth_per_sr": c.truth,
                "monte_carlo_per_sr": c.monte_carlo, "stderr_per_sr": c.stderr })
    });
    json!({
        "preset": chart.planet,
        "fronts": fronts.collect::<Vec<_>>(),
        "not_dominated": exceptions.collect::<Vec<_>>(),
        "checks": checks.collect::<Vec<_>>(),
    })
}
