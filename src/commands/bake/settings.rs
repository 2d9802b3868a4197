//! What the arguments of `tyndall bake` ask for, checked before any work is done.

use super::super::machine::wavelengths;
use super::Args;
use crate::bake::compact::Sizes;
use crate::bake::settings::{Layout, Settings, Solver, Storage};
use crate::bake::water::Waters;
use crate::error::{Error, Result};
use crate::export::container::Container;
use crate::methods::literal::Gather;
use crate::preset;
use crate::spectrum::Rgb;
use crate::table::Elek2010;
use crate::transport::slab::WaterOrders;
use crate::transport::solve::Orders;

/// The settings that hold for every preset of the run.
pub fn settings(args: &Args) -> Result<Settings> {
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
        rgb: Rgb { space: args.colour_space, white: args.white.map(|white| (white, args.adaptation)) },
        solver: if literal {
            Solver::Literal { samples: 30, gather: Gather::PerPoint }
        } else {
            Solver::Moments
        },
        spectral: args.spectral,
        storage: storage(args),
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
            "three-atmosphere" => {
                let fixed = "the sizes of three-atmosphere are compiled into its reader";
                return Err(Error::Argument(format!("--size {text}: {fixed}")));
            }
            other => {
                let known = "elek2010, compact, compact-single or water";
                return Err(Error::Argument(format!("--size {text}: {other} is not one of {known}")));
            }
        }
    }
    Ok(settings)
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
