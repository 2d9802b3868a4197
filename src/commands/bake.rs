//! `tyndall bake`: presets in, folders of tables out.

mod depfile;
mod fresh;
mod jobs;
pub mod list;
mod progress;
mod settings;
mod summary;
pub(super) mod window;

use super::machine::{IsaChoice, orders, share_threads, water_orders};
use crate::bake::bake;
use crate::bake::memory::estimate;
use crate::error::{Error, Result};
use crate::files::claim::Claim;
use crate::files::container::Container;
use crate::files::manifest::Manifest;
use crate::files::staging::Staging;
use crate::layout;
use crate::layout::settings::{Settings, TOLERANCE};
use crate::layout::water::Waters;
use crate::machine::memory;
use crate::plan::{Plan, load_waters};
use crate::preset::{self, Planet, Tolerance};
use crate::spectrum::{Adaptation, ColourSpace, White};
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;
use jobs::{Bounds, run_all};
use progress::{Progress, stages};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use summary::{Done, Outcome};

/// Bake the lookup tables of planets into folders of EXR files with a bake.json
#[derive(clap::Args, Debug)]
#[command(
    before_help = "Example: tyndall bake earth --layout compact --out out
         tyndall bake earth mars --check
         tyndall bake --all --memory 2GiB
         tyndall bake --list planets.txt --shard 3/8",
    after_help = "A bake that is there already, from the same preset, settings and program and with every file whole, is \
                  not baked again.
Exit code 0: done; 1: --check found a stale bake; 2: bad arguments or presets; 3: the machine failed, or a stop."
)]
pub struct Args {
    /// Presets by name (see `tyndall presets`) or paths of JSON files
    #[arg(required_unless_present_any = ["all", "list"], value_name = "PRESET")]
    presets: Vec<String>,
    /// All shipped planets
    #[arg(long, conflicts_with = "presets")]
    all: bool,
    /// Presets from a file, one a line. Several processes may work on one list and one --out: none bakes what another
    /// is at or has done
    #[arg(long, value_name = "FILE", conflicts_with_all = ["presets", "all"])]
    list: Option<PathBuf>,
    /// Of the presets only every Nth from the Kth (1 to N)
    #[arg(long, value_name = "K/N", value_parser = list::shard)]
    shard: Option<list::Shard>,
    /// Memory that bakes may take together, e.g. 2GiB: as many run at once as fit [default: half of what is free]
    #[arg(long, value_name = "AMOUNT", value_parser = memory::parse)]
    memory: Option<u64>,
    /// Folder that gets a folder for each preset
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    /// Layouts to write, comma-separated
    #[arg(long, value_delimiter = ',', value_parser = settings::layouts(), default_value = "elek2010,compact")]
    layout: Vec<String>,
    /// Texels: altitude x view x sun x azimuth (of elek2010), or LAYOUT=AxBxCxD with LAYOUT elek2010, compact
    /// (its table of multiple scattering) or compact-single; compact-transmittance=AxB: altitude x view;
    /// water=AxBxC: depth x view x sun; repeatable. One texel of azimuth is the mean over it
    #[arg(long, value_name = "SIZE")]
    size: Vec<String>,
    /// Heights of observers that the tables are for, e.g. 2m or 0..12km; those above the air look in from its top
    /// [default: all]
    #[arg(long, value_name = "RANGE", value_parser = window::altitudes)]
    altitudes: Option<Range>,
    /// Elevations of the sun that the tables are for, degrees, e.g. 35 or -6..60 [default: all]
    #[arg(long, value_name = "RANGE", allow_hyphen_values = true, value_parser = window::suns)]
    suns: Option<Range>,
    /// Plan: the least tables of compact that keep within this error, e.g. 1% (of RGB) or 1dE (ΔE2000), on 95 % of views
    /// by day, or of those of --altitudes and --suns
    #[arg(long, value_name = "ERROR", value_parser = window::tolerance, conflicts_with_all = ["size", "fold", "without", "layout", "orders", "wavelengths"])]
    tolerance: Option<Tolerance>,
    /// Rays that the tables hold: all, or those of the sky alone, which do not meet the ground
    #[arg(long, default_value = "all", value_parser = ["all", "sky"])]
    views: String,
    /// Constituents whose light scattered once goes into compact's table of the rest, phase function and all,
    /// comma-separated, e.g. air
    #[arg(long, value_delimiter = ',', value_name = "NAME")]
    fold: Vec<String>,
    /// A table of compact to leave out
    #[arg(long, value_name = "TABLE", value_parser = ["scatterers"])]
    without: Option<String>,
    /// Waters to bake too, comma-separated: names (see `tyndall presets`) or paths of JSON files; or none
    #[arg(long, value_delimiter = ',', default_value = "none", value_name = "WATER")]
    waters: Vec<String>,
    /// Largest depth that the tables of each water hold, m, comma-separated in the order of --waters [default: the
    /// preset's]
    #[arg(long, value_delimiter = ',', value_name = "M")]
    water_depths: Vec<f64>,
    /// Tables for observers under water too
    #[arg(long)]
    underwater: bool,
    /// Orders of scattering of sunlight in the water: auto (all), or a number; 1 is the paper's shortcut
    #[arg(long, default_value = "auto", value_name = "auto|N", value_parser = water_orders)]
    water_orders: WaterOrders,
    /// Orders of scattering to sum: auto (until converged) or a number
    #[arg(long, default_value = "auto", value_parser = |t: &str| orders(t, TOLERANCE))]
    orders: Orders,
    /// Wavelengths: auto (15 even ones), a number of even ones, or a list in nm
    #[arg(long, default_value = "auto", value_name = "auto|N|LIST")]
    wavelengths: String,
    /// Who sums the orders of elek2010: moments, or Algorithm 1 of the paper taken literally (slow)
    #[arg(long, default_value = "moments", value_parser = ["moments", "literal"])]
    solver: String,
    /// Primaries of RGB tables, always linear
    #[arg(long, default_value = "srgb", value_parser = space)]
    colour_space: ColourSpace,
    /// What becomes the white of the colour space: star, an illuminant (a, d50, d55, d65, aces, e) or a chromaticity
    /// x,y [default: nothing is adapted]
    #[arg(long, value_name = "WHITE", value_parser = White::parse)]
    white: Option<White>,
    /// How --white is adapted
    #[arg(long, value_enum, default_value = "bradford", requires = "white")]
    adaptation: Adaptation,
    /// Containers of tables, comma-separated; EXR is always written, since this tool reads it
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [Container::Exr])]
    formats: Vec<Container>,
    /// How slices lie in the pictures of EXR files: in a grid, or one below the other
    #[arg(long, default_value = "grid", value_parser = ["grid", "column"])]
    exr_atlas: String,
    /// Write spectral EXR files too (large)
    #[arg(long)]
    spectral: bool,
    /// Bake even what is there already from the same preset, settings and program
    #[arg(long, conflicts_with = "check")]
    force: bool,
    /// Solve and write nothing: say what of the bakes in --out is stale, a line each, with exit code 1 if anything is
    #[arg(long, conflicts_with_all = ["perf", "depfile"])]
    check: bool,
    /// Write which files the bakes depend on, as make and ninja read it
    #[arg(long, value_name = "FILE")]
    depfile: Option<PathBuf>,
    /// Set a value of the preset, e.g. constituents.aerosol.density_factor=10; repeatable
    #[arg(long, value_name = "PATH.TO.KEY=VALUE")]
    set: Vec<String>,
    /// Threads [default: all]; the bytes do not depend on them
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Instruction set of the hot loops; the bytes do not depend on it
    #[arg(long, value_enum, default_value = "auto")]
    isa: IsaChoice,
    /// Print the time of each stage; presets then run one after another, also those that are there already
    #[arg(long)]
    perf: bool,
    /// Print the outcome as JSON, a line for each preset
    #[arg(long)]
    json: bool,
    /// No talk on stderr but errors
    #[arg(long)]
    quiet: bool,
}

/// Lowest and highest of something.
type Range = [f64; 2];

pub(super) fn space(name: &str) -> Result<ColourSpace> {
    let all = ColourSpace::ALL;
    let names: Vec<&str> = all.iter().map(|s| s.name()).collect();
    all.into_iter().find(|s| s.name() == name).ok_or(format!("expected one of {}", names.join(", ")).into())
}

/// Bakes every preset, as many at once as fit in memory. One that fails does not stop the others; the error is
/// then its own where there is one preset, and else has the highest exit code of those that failed.
pub fn run(args: &Args) -> Result<()> {
    args.isa.apply()?;
    let (settings, sized) = settings::settings(args)?;
    let asked = list::asked(args)?;
    let planets: Vec<Result<Planet>> = asked.iter().map(|p| preset::load(p, &args.set)).collect();
    let progress = Progress::new(args.quiet);
    list::refuse_unknown(&asked, &planets, &progress)?;
    settings::check_folded(&settings, &planets)?;
    refuse_shared_folders(&asked, &planets)?;
    share_threads(args.threads)?;
    let names = depfile::names(&planets);
    if asked.len() > 1 {
        planets.iter().filter_map(|p| p.as_ref().err()).for_each(|e| progress.always(&format!("error: {e}")));
    }
    let mut all = settings::for_planets(&settings, sized, &planets);
    if let Some(tolerance) = args.tolerance {
        for (planet, settings) in planets.iter().zip(&mut all) {
            if let Ok(planet) = planet {
                *settings = settings::planned(args, planet, settings, tolerance, &progress)?;
            }
        }
    }
    if args.check {
        return fresh::check(args, &all, &asked, planets);
    }
    let outcomes = bake_all(args, &all, &progress, &asked, planets);
    summary::tell(&outcomes, args.json, args.perf)?;
    summary::failure(outcomes)?;
    depfile::write(args, &asked, &names)
}

/// What the arguments ask for of a planet that is not to be planned.
///
/// # Errors
/// `Argument` for options that do not go together, `File` for waters that cannot be read.
pub fn settings_of(args: &Args, planet: &Planet) -> Result<Settings> {
    let (settings, sized) = settings::settings(args)?;
    Ok(settings::for_planet(&settings, sized, planet))
}

/// The settings of one preset's bake.
fn of_preset(args: &Args, settings: &Settings, asked: &str) -> Settings {
    Settings { shipped_preset: args.set.is_empty() && preset::is_shipped(asked), ..settings.clone() }
}

/// Two planets of one name would share a folder, and the first bake would be lost in silence.
fn refuse_shared_folders(asked: &[String], planets: &[Result<Planet>]) -> Result<()> {
    let mut seen = BTreeMap::new();
    for (k, planet) in planets.iter().enumerate() {
        let Ok(Planet { name, .. }) = planet else { continue };
        if let Some(j) = seen.insert(name, k) {
            let (one, two) = (&asked[j], &asked[k]);
            let reason = format!("{one} and {two} are both named {name}: one folder for two bakes");
            return Err(Error::Argument(reason));
        }
    }
    Ok(())
}

/// What came of each preset, in the order asked for.
fn bake_all(
    args: &Args,
    all: &[Settings],
    progress: &Progress,
    asked: &[String],
    planets: Vec<Result<Planet>>,
) -> Vec<Outcome> {
    let need = |(p, settings): (&Result<Planet>, &Settings)| p.as_ref().map_or(0, |p| estimate(p, settings));
    let needs: Vec<u64> = planets.iter().zip(all).map(need).collect();
    let memory = args.memory.unwrap_or_else(default_memory);
    let at_once = if args.perf { 1 } else { rayon::current_num_threads() };
    let bounds = Bounds { memory, at_once };
    let attempt = |k: usize, busy: Busy| {
        let planet = planets[k].as_ref().ok()?;
        let settings = of_preset(args, &all[k], &asked[k]);
        if let Err(error) = affordable(args.memory, &args.out.join(&planet.name), needs[k]) {
            return Some(Err(error));
        }
        if needs[k] > memory && planets.len() > 1 {
            let (need, bound) = (memory::shown(needs[k]), memory::shown(memory));
            progress
                .say(&format!("{}: needs some {need}, over the bound of {bound}: runs alone", planet.name));
        }
        let result = one(args, &settings, progress, planet, needs[k], busy);
        if let (Err(error), true) = (&result, planets.len() > 1) {
            progress.always(&format!("error: {}: {error}", planet.name));
        }
        Some(result)
    };
    let mut answers: Vec<Option<Result<Option<Done>>>> =
        run_all(&needs, bounds, |k| attempt(k, Busy::Leave)).into_iter().map(Option::flatten).collect();
    // What other processes were at; done by now, in most cases, or left by one that was killed.
    let left: Vec<usize> = (0..answers.len()).filter(|&k| matches!(answers[k], Some(Ok(None)))).collect();
    let needs_left: Vec<u64> = left.iter().map(|&k| needs[k]).collect();
    let later = run_all(&needs_left, bounds, |n| attempt(left[n], Busy::Wait));
    left.iter().zip(later).for_each(|(&k, answer)| answers[k] = answer.flatten());
    let whole = |answer: Result<Option<Done>>| answer.transpose();
    let answers = answers.into_iter().map(|answer| answer.and_then(whole));
    planets.into_iter().zip(answers).zip(asked).map(|((p, a), asked)| outcome(args, asked, p, a)).collect()
}

/// Puts together what is known of one preset; no `answer` to a good planet means that its bake panicked.
fn outcome(args: &Args, asked: &str, planet: Result<Planet>, answer: Option<Result<Done>>) -> Outcome {
    match (planet, answer) {
        (Err(error), _) => Outcome { name: asked.to_string(), result: Err(error) },
        (Ok(planet), Some(result)) => Outcome { name: planet.name, result },
        (Ok(planet), None) => {
            let bug = std::io::Error::other("the bake panicked, which is a bug of this program");
            Outcome { result: Err(Error::machine(args.out.join(&planet.name), bug)), name: planet.name }
        }
    }
}

/// Half of what is free now, so that what else runs here has room; 2 GiB where the system does not say.
fn default_memory() -> u64 {
    memory::available().map_or(2 << 30, |free| free / 2)
}

/// Refuses a bake that would take more than this machine has left, before it takes anything; who gives it so much by
/// `--memory` knows better.
fn affordable(memory: Option<u64>, folder: &Path, need: u64) -> Result<()> {
    if memory.is_some_and(|given| given >= need) {
        return Ok(());
    }
    memory::check(need).map_err(|reason| {
        let mend = "bake smaller tables or fewer wavelengths, or say --memory if that much can be had";
        Error::machine(folder, std::io::Error::other(format!("{reason}: {mend}")))
    })
}

/// What to do where another process bakes the same folder.
#[derive(Clone, Copy, PartialEq)]
enum Busy {
    Leave,
    Wait,
}

/// One bake, from planet to folder; none if it was left to another process.
fn one(
    args: &Args,
    settings: &Settings,
    progress: &Progress,
    planet: &Planet,
    need: u64,
    busy: Busy,
) -> Result<Option<Done>> {
    let folder = args.out.join(&planet.name);
    let _claim = match (args.list.is_some(), busy) {
        (false, _) => None,
        (true, Busy::Wait) => Some(Claim::take(&folder)?),
        (true, Busy::Leave) => match Claim::try_take(&folder)? {
            None => return Ok(None),
            claim => claim,
        },
    };
    if !args.force
        && !args.perf
        && let Some(done) = fresh::current(&folder, planet, settings)
    {
        Staging::sweep_beside(&folder);
        progress.end(&planet.name, "is there already; --force bakes it again");
        return Ok(Some(done));
    }
    make(&folder, settings, progress, planet, need).map(Some)
}

/// Bakes what was planned into a folder of `out`.
pub fn planned(plan: &Plan, out: &Path, quiet: bool, json: bool) -> Result<()> {
    let planet = preset::load(&plan.scene.planet, &[])?;
    let shipped_preset = preset::is_shipped(&plan.scene.planet);
    let mut settings = Settings { shipped_preset, ..plan.planned.model.settings(&Settings::default()) };
    if let Some(waters) = &plan.waters {
        let list = load_waters(&plan.scene)?;
        settings.waters = Waters { list, size: waters.size, orders: waters.orders, underwater: false };
    }
    let need = estimate(&planet, &settings);
    let folder = out.join(&planet.name);
    let result = affordable(None, &folder, need)
        .and_then(|()| make(&folder, &settings, &Progress::new(quiet), &planet, need));
    let outcomes = vec![Outcome { name: planet.name, result }];
    // One JSON document is one answer: the plan's.
    if !json {
        summary::tell(&outcomes, false, false)?;
    }
    summary::failure(outcomes)
}

/// Layouts of the bake that stands in a folder; none where there is none.
fn layouts_at(folder: &Path) -> Vec<String> {
    let Ok(manifest) = Manifest::read(folder) else { return Vec::new() };
    let has = |name: &&str| manifest.tables.iter().any(|table| table.layout == *name);
    layout::ALL.map(|layout| layout.name()).into_iter().filter(has).map(str::to_string).collect()
}

fn left_out(layout: &str) -> String {
    format!("layout {layout} of the bake before is gone: --layout leaves it out")
}

/// Solves and writes.
fn make(folder: &Path, settings: &Settings, progress: &Progress, planet: &Planet, need: u64) -> Result<Done> {
    let before = layouts_at(folder);
    let staging = Staging::begin(folder)?;
    let about = format!(", in some {}", memory::shown(need));
    let mut clock = progress.begin(&planet.name, stages(settings), &about);
    let product = bake(planet, settings, &mut |stage| clock.stage(stage))?;
    clock.stage("write");
    product.write_into(staging)?;
    let gone = before.iter().filter(|name| !settings.layouts.iter().any(|layout| layout.name() == **name));
    gone.for_each(|name| progress.say(&format!("{}: {}", planet.name, left_out(name))));
    product.manifest.warnings.iter().for_each(|w| progress.say(&format!("warning: {}: {w}", planet.name)));
    progress.end(&planet.name, &format!("done in {:.1} s", clock.elapsed().as_secs_f64()));
    Ok(Done {
        folder: folder.to_path_buf(),
        files: product.files.len(),
        bytes: product.files.iter().map(|f| f.1.len()).sum(),
        warnings: product.manifest.warnings,
        quality: product.manifest.quality.as_object().cloned().unwrap_or_default(),
        stages: clock.finish(),
        need,
        reused: false,
    })
}
