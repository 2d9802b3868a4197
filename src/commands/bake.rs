//! `tyndall bake`: presets in, folders of tables out.

use super::machine::{IsaChoice, orders, wavelengths, with_threads};
use super::text::print;
use crate::bake::compact::Sizes;
use crate::bake::settings::{Layout, Settings, Solver, TOLERANCE};
use crate::bake::water::Waters;
use crate::bake::{Product, bake};
use crate::error::{Error, Result};
use crate::export::staging::Staging;
use crate::preset::{self, Planet};
use crate::spectrum::ColourSpace;
use crate::table::Elek2010;
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Bake the lookup tables of planets into folders of EXR files with a bake.json
#[derive(clap::Args, Debug)]
#[command(before_help = "Example: tyndall bake earth --layout compact --out out")]
pub struct Args {
    /// Presets by name (see `tyndall presets`) or paths of JSON files
    #[arg(required = true, value_name = "PRESET")]
    presets: Vec<String>,
    /// Folder that gets a folder for each preset
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    /// Layouts to write, comma-separated
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [Layout::Elek2010, Layout::Compact])]
    layout: Vec<Layout>,
    /// Texels: altitude x view x sun x azimuth (of elek2010), or LAYOUT=AxBxCxD with LAYOUT elek2010, compact
    /// (its table of multiple scattering) or compact-single; water=AxBxC: depth x view x sun; repeatable
    #[arg(long, value_name = "SIZE")]
    size: Vec<String>,
    /// Waters to bake too, comma-separated: names (see `tyndall presets`) or paths of JSON files; or none
    #[arg(long, value_delimiter = ',', default_value = "none", value_name = "WATER")]
    waters: Vec<String>,
    /// Tables for observers under water too
    #[arg(long)]
    underwater: bool,
    /// Orders of scattering of sunlight in the water: auto (all), or a number; 1 is the paper's shortcut
    #[arg(long, default_value = "auto", value_name = "auto|N", value_parser = super::machine::water_orders)]
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
    /// Write spectral EXR files too (large)
    #[arg(long)]
    spectral: bool,
    /// Set a value of the preset, e.g. constituents.aerosol.density_factor=10; repeatable
    #[arg(long, value_name = "PATH.TO.KEY=VALUE")]
    set: Vec<String>,
    /// Threads [default: all]; the bytes do not depend on them
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Instruction set of the hot loops; the bytes do not depend on it
    #[arg(long, value_enum, default_value = "auto")]
    isa: IsaChoice,
    /// Print the time of each stage
    #[arg(long)]
    perf: bool,
    /// Print the outcome as JSON
    #[arg(long)]
    json: bool,
    /// No talk on stderr but errors
    #[arg(long)]
    quiet: bool,
}

fn space(name: &str) -> std::result::Result<ColourSpace, String> {
    let all = ColourSpace::ALL;
    let names: Vec<&str> = all.iter().map(|s| s.name()).collect();
    all.into_iter().find(|s| s.name() == name).ok_or(format!("expected one of {}", names.join(", ")))
}

/// Bakes every preset; the first failure ends the run, with the bakes before it in place.
pub fn run(args: &Args) -> Result<()> {
    args.isa.apply()?;
    let settings = settings(args)?;
    let planets: Vec<Planet> =
        args.presets.iter().map(|p| preset::load(p, &args.set)).collect::<Result<_>>()?;
    for (k, planet) in planets.iter().enumerate() {
        if let Some(j) = planets[..k].iter().position(|other| other.name == planet.name) {
            let (one, two) = (&args.presets[j], &args.presets[k]);
            let reason = format!("{one} and {two} are both named {}: one folder for two bakes", planet.name);
            return Err(Error::Argument(reason));
        }
    }
    for (planet, preset) in planets.iter().zip(&args.presets) {
        let shipped_preset = args.set.is_empty() && preset::is_shipped(preset);
        let settings = Settings { shipped_preset, ..settings.clone() };
        let mut clock = Clock::new(args);
        let staging = Staging::begin(&args.out.join(&planet.name))?;
        let product =
            with_threads(args.threads, || bake(planet, &settings, &mut |stage| clock.stage(stage)))??;
        clock.stage("write");
        for (file, bytes) in &product.files {
            staging.write(file, bytes)?;
        }
        staging.commit()?;
        let stages = clock.end();
        tell(args, planet, &product, &stages)?;
    }
    Ok(())
}

fn settings(args: &Args) -> Result<Settings> {
    let mut layouts = args.layout.clone();
    layouts.sort();
    layouts.dedup();
    let wavelengths_nm = wavelengths(&args.wavelengths)
        .map_err(|reason| Error::Argument(format!("--wavelengths {}: {reason}", args.wavelengths)))?;
    let literal = args.solver == "literal";
    let waters = waters(args)?;
    let mut settings = Settings {
        layouts,
        orders: args.orders,
        wavelengths_nm,
        space: args.colour_space,
        solver: if literal { Solver::Literal { samples: 30 } } else { Solver::Moments },
        spectral: args.spectral,
        waters,
        ..Settings::default()
    };
    if literal && matches!(args.orders, Orders::Converged { .. }) {
        return Err(Error::Argument("--solver literal sums orders one by one: give --orders N".into()));
    }
    let without_paper = !settings.layouts.contains(&Layout::Elek2010);
    for (option, given) in [("--solver literal", literal), ("--spectral", args.spectral)] {
        if given && without_paper {
            return Err(Error::Argument(format!(
                "{option} is of the layout elek2010, which --layout leaves out"
            )));
        }
    }
    for text in &args.size {
        let (name, size) = text.split_once('=').unwrap_or((Layout::Elek2010.name(), text));
        if name == "water" {
            settings.waters.size = water_size(size).ok_or_else(|| {
                Error::Argument(format!(
                    "--size {text}: expected three numbers from 2 to 1024, e.g. 32x64x64"
                ))
            })?;
            continue;
        }
        let size = parse_size(size).map_err(|reason| Error::Argument(format!("--size {text}: {reason}")))?;
        match name {
            "elek2010" => settings.elek2010_size = size,
            "compact" => settings.compact_sizes = Sizes { multiple: size, ..settings.compact_sizes },
            "compact-single" => settings.compact_sizes = Sizes { single: size, ..settings.compact_sizes },
            other => {
                let known = "elek2010, compact, compact-single or water";
                return Err(Error::Argument(format!("--size {text}: {other} is not one of {known}")));
            }
        }
    }
    Ok(settings)
}

/// The waters to bake; each name is that of its tables, so it can stand only once.
fn waters(args: &Args) -> Result<Waters> {
    let names: Vec<&String> = args.waters.iter().filter(|w| *w != "none").collect();
    if names.len() != args.waters.len() && args.waters.len() > 1 {
        return Err(Error::Argument("--waters: `none` stands alone".into()));
    }
    let list = names.iter().map(|w| preset::load_water(w, &[])).collect::<Result<Vec<_>>>()?;
    for (k, water) in list.iter().enumerate() {
        if list[..k].iter().any(|other| other.name == water.name) {
            return Err(Error::Argument(format!("--waters: two are named {}", water.name)));
        }
        if RESERVED.contains(&water.name.as_str()) {
            return Err(Error::Argument(format!(
                "--waters: {} is the name of a table of every bake",
                water.name
            )));
        }
    }
    let counted = args.water_orders != WaterOrders::All;
    if list.is_empty() && (counted || args.underwater) {
        let option = if counted { "--water-orders" } else { "--underwater" };
        return Err(Error::Argument(format!("{option} needs --waters")));
    }
    Ok(Waters { list, underwater: args.underwater, orders: args.water_orders, ..Waters::default() })
}

/// Tables of the water layout that belong to no water.
const RESERVED: [&str; 2] = ["fresnel", "irradiance"];

fn water_size(text: &str) -> Option<[usize; 3]> {
    let parts: Vec<usize> = text.split('x').map(|p| p.parse().ok()).collect::<Option<_>>()?;
    let size: [usize; 3] = parts.try_into().ok()?;
    let few = size.iter().product::<usize>() <= MOST_TEXELS;
    (few && size.iter().all(|n| (2..=1024).contains(n))).then_some(size)
}

/// Texels that a table may have: 256 million floats of four channels are four gigabytes.
const MOST_TEXELS: usize = 1 << 26;

fn parse_size(text: &str) -> std::result::Result<[usize; 4], String> {
    let parts: Vec<usize> = text
        .split('x')
        .map(|p| p.parse().map_err(|_| format!("`{p}` is not a number")))
        .collect::<std::result::Result<_, String>>()?;
    let size: [usize; 4] =
        parts.try_into().map_err(|_| "expected four numbers, e.g. 32x128x32x8".to_string())?;
    let texels = size.iter().try_fold(1usize, |n, &s| n.checked_mul(s)).filter(|&n| n <= MOST_TEXELS);
    if texels.is_none() {
        return Err(format!("more than {MOST_TEXELS} texels"));
    }
    Elek2010::new(1.0, 2.0, size).ok_or("every size is at least 2, that of the view even".to_string())?;
    Ok(size)
}

/// Times the stages and shows them as they come.
struct Clock {
    bar: ProgressBar,
    lines: bool,
    start: Instant,
    stages: Vec<(String, Duration, Duration)>,
    current: Option<(String, Instant, Duration)>,
}

impl Clock {
    fn new(args: &Args) -> Self {
        let terminal = std::io::stderr().is_terminal() && !args.quiet;
        let bar = if terminal { ProgressBar::new_spinner() } else { ProgressBar::hidden() };
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
            bar.set_style(style);
        }
        Clock { bar, lines: false, start: Instant::now(), stages: Vec::new(), current: None }
    }

    fn stage(&mut self, name: &str) {
        self.close();
        self.bar.set_message(name.to_string());
        self.bar.tick();
        self.current = Some((name.to_string(), Instant::now(), cpu_time()));
    }

    fn close(&mut self) {
        if let Some((name, wall, cpu)) = self.current.take() {
            self.stages.push((name, wall.elapsed(), cpu_time().saturating_sub(cpu)));
        }
    }

    fn end(mut self) -> Vec<(String, Duration, Duration)> {
        self.close();
        self.bar.finish_and_clear();
        self.lines = true;
        let all = self.stages.iter().map(|s| s.2).sum();
        self.stages.push(("all".into(), self.start.elapsed(), all));
        self.stages
    }
}

/// Processor time of this process so far, all threads; zero where the system does not tell.
fn cpu_time() -> Duration {
    #[cfg(target_os = "linux")]
    {
        let time = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Duration::new(time.tv_sec.max(0) as u64, time.tv_nsec.max(0) as u32)
    }
    #[cfg(not(target_os = "linux"))]
    Duration::ZERO
}

fn tell(
    args: &Args,
    planet: &Planet,
    product: &Product,
    stages: &[(String, Duration, Duration)],
) -> Result<()> {
    let folder = args.out.join(&planet.name);
    let bytes: usize = product.files.iter().map(|f| f.1.len()).sum();
    if args.json {
        let seconds = |d: &Duration| (d.as_secs_f64() * 1e4).round() / 1e4;
        let perf: Vec<_> = stages
            .iter()
            .map(|(n, w, c)| json!({ "stage": n, "wall_s": seconds(w), "cpu_s": seconds(c) }))
            .collect();
        let answer = json!({ "preset": planet.name, "folder": folder.to_string_lossy(), "bytes": bytes,
            "warnings": product.manifest.warnings, "quality": product.manifest.quality, "perf": perf });
        return print(&format!("{answer}\n"));
    }
    let megabytes = bytes as f64 / 1e6;
    print(&format!("{}: {} files, {megabytes:.1} MB\n", folder.display(), product.files.len()))?;
    if args.perf {
        for (name, wall, cpu) in stages {
            let (wall, cpu) = (wall.as_secs_f64(), cpu.as_secs_f64());
            print(&format!("  {name:<22} {wall:7.3} s wall {cpu:7.3} s CPU\n"))?;
        }
        if let Some(peak) = peak_memory() {
            print(&format!("  peak memory {:.0} MB\n", peak as f64 / 1e6))?;
        }
    }
    if !args.quiet {
        for warning in &product.manifest.warnings {
            eprintln!("warning: {}: {warning}", planet.name);
        }
    }
    Ok(())
}

/// Largest resident size of this process, bytes.
fn peak_memory() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes * 1024)
}
