//! Arguments → command → exit code.

use clap::Parser;
use std::io::Write;
use tyndall::commands::{bake, chart, colour, diff, presets, recolour, reference, sample, verify};

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
    Chart(chart::Args),
    Colour(colour::Args),
    Presets(presets::Args),
}

fn main() -> std::process::ExitCode {
    let command = Command::parse();
    let result = tyndall::export::interrupt::handle_interrupts().and_then(|()| run(command));
    match result {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            // Not eprintln, which panics where nobody reads stderr: the exit code would be lost.
            let _ = writeln!(std::io::stderr(), "error: {error}");
            error.exit_code().into()
        }
    }
}

fn run(command: Command) -> tyndall::Result<()> {
    match command {
        Command::Bake(args) => bake::run(&args),
        Command::Sample(args) => sample::run(&args),
        Command::Reference(args) => reference::run(&args),
        Command::Verify(args) => verify::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Recolour(args) => recolour::run(&args),
        Command::Chart(args) => chart::run(&args),
        Command::Colour(args) => colour::run(&args),
        Command::Presets(args) => presets::run(&args),
    }
}
