//! What the arguments of `tyndall bake` ask for, checked before any work is done.

use super::super::machine::wavelengths;
use super::Args;
use super::progress::Progress;
use super::window::{Sized, fitted};
use crate::algorithm1::Gather;
use crate::error::{Error, Result};
use crate::files::container::Container;
use crate::layout::settings::{Settings, Solver, Storage};
use crate::layout::water::Waters;
use crate::layout::{self, Layout, MediumKind, compact, elek2010};
use crate::mapping::{Views, Window};
use crate::plan::{Effort, plan};
use crate::preset::names;
use crate::preset::{self, Planet, Scene, Tolerance};
use crate::spectrum::Rgb;
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;
use clap::builder::{PossibleValue, PossibleValuesParser};

/// The settings of each planet of a run: where tables are for a window, their sizes depend on the shell.
pub(super) fn for_planets(settings: &Settings, sized: Sized, planets: &[Result<Planet>]) -> Vec<Settings> {
    let of = |planet: &Result<Planet>| match planet {
        Ok(planet) => for_planet(settings, sized, planet),
        Err(_) => settings.clone(),
    };
    planets.iter().map(of).collect()
}

/// The same of one.
pub(super) fn for_planet(settings: &Settings, sized: Sized, planet: &Planet) -> Settings {
    match settings.window != Window::WHOLE {
        true => fitted(settings, &planet.medium(&settings.wavelengths_nm), sized),
        false => settings.clone(),
    }
}

/// Settings of the least model for a planet within a tolerance: by day and wherever there is to be, or in the window
/// that was asked for.
pub(super) fn planned(
    args: &Args,
    planet: &Planet,
    settings: &Settings,
    tolerance: Tolerance,
    progress: &Progress,
) -> Result<Settings> {
    let mut scene = Scene::default_of(&planet.name, planet.top_radius - planet.ground_radius, tolerance);
    scene.altitudes = args.altitudes.unwrap_or(scene.altitudes);
    scene.suns = args.suns.unwrap_or(scene.suns);
    if args.views == "sky" {
        scene.elevations[0] = 0.0;
    }
    let mut talk = |text: &str| progress.say(&format!("{}: {text}", planet.name));
    let plan = plan(planet, &scene, &Effort::default(), &mut talk, &|| {
        crate::machine::cpu_time::cpu_time().as_secs_f64()
    })?;
    if !plan.unmet.is_empty() {
        let reason = plan.unmet.join("; ");
        return Err(Error::Check(format!("{}: no model holds: {reason}", planet.name)));
    }
    progress.say(&format!("{}: planned: {}", planet.name, plan.command()));
    Ok(plan.planned.model.settings(settings))
}

/// What `--layout` takes.
pub(super) fn layouts() -> PossibleValuesParser {
    let value = |layout: &dyn Layout| {
        let value = PossibleValue::new(layout.name());
        match layout.about() {
            Some(about) => value.help(about),
            None => value,
        }
    };
    PossibleValuesParser::new(layout::ALL.map(value))
}

/// The settings that hold for every preset of the run, and which sizes were asked for.
pub(super) fn settings(args: &Args) -> Result<(Settings, Sized)> {
    // In the order of the list, each once; those of the paper's medium first.
    let asked = |layout: &&'static dyn Layout| args.layout.iter().any(|name| name == layout.name());
    let mut layouts: Vec<&'static dyn Layout> = layout::ALL.into_iter().filter(asked).collect();
    layouts.sort_by_key(|layout| layout.medium() != MediumKind::Paper);
    let wavelengths_nm = wavelengths(&args.wavelengths)
        .map_err(|reason| Error::Argument(format!("--wavelengths {}: {reason}", args.wavelengths)))?;
    let literal = args.solver == "literal";
    let waters = waters(args)?;
    let mut settings = Settings {
        layouts,
        orders: args.orders,
        wavelengths_nm,
        rgb: Rgb { space: args.colour_space, white: args.white.map(|white| (white, args.adaptation)) },
        solver: if literal {
            Solver::Literal { samples: 30, gather: Gather::PerPoint }
        } else {
            Solver::Moments
        },
        spectral: args.spectral,
        storage: storage(args),
        waters,
        window: Window {
            altitudes: args.altitudes,
            suns: args.suns,
            views: if args.views == "sky" { Views::Sky } else { Views::All },
        },
        ..Settings::default()
    };
    settings.compact.folded = args.fold.clone();
    settings.compact.without_scatterers = args.without.is_some();
    refuse_parts(args, &settings)?;
    if literal && matches!(args.orders, Orders::Converged { .. }) {
        return Err(Error::Argument("--solver literal sums orders one by one: give --orders N".into()));
    }
    let without_paper = !settings.has(elek2010::LAYOUT);
    for (option, given) in [("--solver literal", literal), ("--spectral", args.spectral)] {
        if given && without_paper {
            return Err(Error::Argument(format!(
                "{option} is of the layout elek2010, which --layout leaves out"
            )));
        }
    }
    let mut sized = Sized::default();
    for text in &args.size {
        let (name, size) = text.split_once('=').unwrap_or((elek2010::LAYOUT, text));
        if name == "water" {
            settings.waters.size = water_size(size).ok_or_else(|| {
                Error::Argument(format!(
                    "--size {text}: expected three numbers from 2 to 1024, e.g. 32x64x64"
                ))
            })?;
            continue;
        }
        let refuse = |reason: Error| Error::Argument(format!("--size {text}: {reason}"));
        if name == "compact-transmittance" {
            let [altitude, view] = numbers(size).map_err(refuse)?;
            check_size([altitude, view, 2, 2], &settings.window).map_err(refuse)?;
            (settings.compact.sizes.depth, sized.depth) = ([altitude, view], true);
            continue;
        }
        let size = numbers(size).map_err(refuse)?;
        check_size(size, &settings.window).map_err(refuse)?;
        match name {
            "elek2010" => (settings.elek2010_size, sized.elek2010) = (size, true),
            "compact" => (settings.compact.sizes.multiple, sized.multiple) = (size, true),
            "compact-single" => (settings.compact.sizes.single, sized.single) = (size, true),
            "three-atmosphere" => {
                let fixed = "the sizes of three-atmosphere are compiled into its reader";
                return Err(Error::Argument(format!("--size {text}: {fixed}")));
            }
            other => {
                let near =
                    names::nearest(other, SIZED).map_or(String::new(), |n| format!("; the nearest is `{n}`"));
                let known = "elek2010, compact, compact-single, compact-transmittance or water";
                return Err(Error::Argument(format!("--size {text}: {other} is not one of {known}{near}")));
            }
        }
    }
    Ok((settings, sized))
}

/// Constituents of --fold that a planet of the run has not, before anything of another is written.
pub(super) fn check_folded(settings: &Settings, planets: &[Result<Planet>]) -> Result<()> {
    for planet in planets.iter().flatten() {
        let medium = planet.medium(&settings.wavelengths_nm);
        settings.compact.folded.iter().try_for_each(|name| crate::bake::check_folded(&medium, name))?;
    }
    Ok(())
}

/// What --size can be given for.
const SIZED: [&str; 5] = ["elek2010", "compact", "compact-single", "compact-transmittance", "water"];

/// Options that leave out parts of tables which other options need.
fn refuse_parts(args: &Args, settings: &Settings) -> Result<()> {
    let refuse = |reason: &str| Err(Error::Argument(reason.to_string()));
    let windowed = settings.window != Window::WHOLE;
    if windowed && args.solver == "literal" {
        return refuse("--solver literal fills whole tables: leave --altitudes, --suns and --views out");
    }
    if windowed && args.spectral {
        return refuse("--spectral is of whole tables: leave --altitudes, --suns and --views out");
    }
    if let Some(whole) = settings.layouts.iter().find(|layout| windowed && !layout.has_windows()) {
        let name = whole.name();
        return refuse(&format!("{name} has whole tables: leave --altitudes, --suns and --views out"));
    }
    let compact = settings.has(compact::LAYOUT);
    for (option, given) in [("--fold", !args.fold.is_empty()), ("--without", args.without.is_some())] {
        if given && !compact {
            let reason = format!("{option} is of the layout compact, which --layout leaves out");
            return Err(Error::Argument(reason));
        }
    }
    Ok(())
}

/// Containers besides EXR, each once, in a fixed order.
fn storage(args: &Args) -> Storage {
    let mut containers: Vec<Container> =
        args.formats.iter().copied().filter(|&format| format != Container::Exr).collect();
    containers.sort();
    containers.dedup();
    Storage { containers, column: args.exr_atlas == "column" }
}

/// The waters to bake; each name is that of its tables, so it can stand only once.
fn waters(args: &Args) -> Result<Waters> {
    let names: Vec<&String> = args.waters.iter().filter(|w| *w != "none").collect();
    if names.len() != args.waters.len() && args.waters.len() > 1 {
        return Err(Error::Argument("--waters: `none` stands alone".into()));
    }
    let mut list = names.iter().map(|w| preset::load_water(w, &[])).collect::<Result<Vec<_>>>()?;
    if !args.water_depths.is_empty() && args.water_depths.len() != list.len() {
        let (given, of) = (args.water_depths.len(), list.len());
        return Err(Error::Argument(format!("--water-depths: {given} for {of} of --waters")));
    }
    for (water, &depth) in list.iter_mut().zip(&args.water_depths) {
        if !(depth > 0.0 && depth <= water.largest_depth) {
            let most = water.largest_depth;
            let reason = format!("{} has depths up to {most} m", water.name);
            return Err(Error::Argument(format!("--water-depths {depth}: {reason}")));
        }
        water.largest_depth = depth;
    }
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
    // In this order: the product of sizes in their bounds cannot overflow.
    (size.iter().all(|n| (2..=1024).contains(n)) && size.iter().product::<usize>() <= MOST_TEXELS)
        .then_some(size)
}

/// Texels that a table may have: 256 million floats, four a texel, are a gigabyte.
const MOST_TEXELS: usize = 1 << 26;

fn numbers<const N: usize>(text: &str) -> Result<[usize; N]> {
    let parts: Vec<usize> = text
        .split('x')
        .map(|p| p.parse().map_err(|_| Error::Reason(format!("`{p}` is not a number"))))
        .collect::<Result<_>>()?;
    let example = if N == 4 { "four numbers, e.g. 32x128x32x8" } else { "two numbers, e.g. 48x128" };
    parts.try_into().map_err(|_| Error::Reason(format!("expected {example}")))
}

/// Whether a table of a window may have a size.
fn check_size(size: [usize; 4], window: &Window) -> Result<()> {
    let texels = size.iter().try_fold(1usize, |n, &s| n.checked_mul(s)).filter(|&n| n <= MOST_TEXELS);
    if texels.is_none() {
        return Err(format!("more than {MOST_TEXELS} texels").into());
    }
    let [altitudes, views, suns, azimuths] = size;
    let one = |n: usize, given: bool| n >= if given { 1 } else { 2 };
    if !one(altitudes, window.altitudes.is_some()) || !one(suns, window.suns.is_some()) {
        return Err("every size is at least 2; 1 of altitude needs --altitudes, 1 of sun --suns".into());
    }
    let halves = if window.views == Views::All { 2 } else { 1 };
    if azimuths == 0 || views < 2 || !views.is_multiple_of(halves) {
        return Err("every size is at least 2 (of azimuth 1), that of the view even".into());
    }
    Ok(())
}
