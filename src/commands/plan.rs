//! `tyndall plan`: the least model that shows a scene within its tolerance.

use super::machine::{IsaChoice, share_threads};
use super::text::{print, say};
use crate::error::{Error, Result};
use crate::plan::{Effort, Plan, plan};
use crate::preset::{self, Scene};
use std::path::PathBuf;
use std::time::Instant;

/// The least model that shows a scene within its tolerance: settings for bake, with what was left out
#[derive(clap::Args, Debug)]
#[command(
    before_help = "Example: tyndall plan walk
         tyndall plan my-scene.json --bake --out out",
    after_help = "Exit code 0: planned; 1: no model keeps tolerance and budget, the front of what was tried is shown; \
                  2: bad input."
)]
pub struct Args {
    /// A shipped scene by name (walk, flight, orbit, rover, ocean) or the path of a JSON file
    #[arg(value_name = "SCENE")]
    scene: String,
    /// Bake the model
    #[arg(long)]
    bake: bool,
    /// With --bake: folder that gets a folder for the planet
    #[arg(long, default_value = "out", value_name = "FOLDER")]
    out: PathBuf,
    /// Answer in JSON, the same every time: without times
    #[arg(long)]
    json: bool,
    /// Views that models are measured on, and as many again to confirm and to report
    #[arg(long, default_value_t = Effort::default().views, value_name = "N", value_parser = views)]
    views: usize,
    /// Other views for another number
    #[arg(long, default_value_t = Effort::default().seed, value_name = "N")]
    seed: u32,
    /// Threads [default: all]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Instruction set of the hot loops
    #[arg(long, value_enum, default_value = "auto")]
    isa: IsaChoice,
    /// No talk on stderr but errors
    #[arg(long)]
    quiet: bool,
}

fn views(text: &str) -> Result<usize> {
    match text.parse() {
        Ok(n) if (20..=20_000).contains(&n) => Ok(n),
        _ => Err("expected a number from 20 to 20000".into()),
    }
}

/// Plans, prints, and bakes if asked to.
pub fn run(args: &Args) -> Result<()> {
    args.isa.apply()?;
    let scene = preset::load_scene(&args.scene)?;
    share_threads(args.threads)?;
    let planned = planned(args, &scene)?;
    print(&if args.json { format!("{:#}\n", planned.json()) } else { planned.text() })?;
    if !planned.unmet.is_empty() {
        let reason = planned.unmet.join("; ");
        return Err(Error::Check(format!("scene {}: no model holds: {reason}", scene.name)));
    }
    if args.bake {
        return super::bake::planned(&planned, &args.out, args.quiet, args.json);
    }
    Ok(())
}

fn planned(args: &Args, scene: &Scene) -> Result<Plan> {
    let planet = preset::load(&scene.planet, &[])?;
    let effort = Effort { views: args.views, seed: args.seed, ..Effort::default() };
    let start = Instant::now();
    let mut talk = |text: &str| {
        if !args.quiet {
            say(&format!("{:6.1} s  {text}", start.elapsed().as_secs_f64()));
        }
    };
    plan(&planet, scene, &effort, &mut talk, &|| crate::machine::cpu_time::cpu_time().as_secs_f64())
}
