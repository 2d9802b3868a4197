//! Arguments → command → exit code.

use clap::Parser;
#[cfg(feature = "chart")]
use tyndall::internals::commands::chart;
use tyndall::internals::commands::share_threads;
use tyndall::internals::commands::{bake, colour, diff, plan, presets, recolour, reference, sample, verify};
use tyndall::internals::files::signals::handle_interrupts;
use tyndall::internals::machine::output;

#[global_allocator]
static MEMORY: tyndall::internals::machine::memory::Allocator =
    tyndall::internals::machine::memory::Allocator;

/// Offline baker of lookup tables for planetary atmospheres
#[derive(Parser)]
#[command(name = "tyndall", version, about)]
#[command(before_help = "Example: tyndall bake earth && tyndall verify out/earth")]
enum Command {
    Bake(Box<bake::Args>),
    Sample(sample::Args),
    Reference(reference::Args),
    Verify(verify::Args),
    Diff(diff::Args),
    Recolour(recolour::Args),
    #[cfg(feature = "chart")]
    Chart(chart::Args),
    Plan(plan::Args),
    Colour(colour::Args),
    Presets(presets::Args),
}

fn main() -> std::process::ExitCode {
    let result = match Command::try_parse() {
        Ok(command) => handle_interrupts().and_then(|()| run(command)).and_then(|()| output::heard()),
        Err(error) => output::refused(&error),
    };
    match result {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            output::say(&format!("error: {error}"));
            error.exit_code().into()
        }
    }
}

impl Command {
    /// The threads of a command that has no `--threads`; where there are none to be had, that is an error, not a panic.
    fn threads(&self) -> tyndall::Result<()> {
        match self {
            Command::Bake(_) | Command::Plan(_) => Ok(()),
            #[cfg(feature = "chart")]
            Command::Chart(_) => Ok(()),
            Command::Sample(_) | Command::Reference(_) => Ok(()),
            _ => share_threads(None),
        }
    }
}

fn run(command: Command) -> tyndall::Result<()> {
    command.threads()?;
    match command {
        Command::Bake(args) => bake::run(&args),
        Command::Sample(args) => sample::run(&args),
        Command::Reference(args) => reference::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Recolour(args) => recolour::run(&args),
        #[cfg(feature = "chart")]
        Command::Chart(args) => chart::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Colour(args) => colour::run(&args),
        Command::Presets(args) => presets::run(&args),
    }
}
