//! Arguments → command → exit code.

use clap::Parser;
use tyndall::commands::{colour, presets};

#[derive(Parser)]
#[command(name = "tyndall", version, about)]
enum Command {
    Colour(colour::Args),
    Presets(presets::Args),
}

fn main() -> std::process::ExitCode {
    let result = match Command::parse() {
        Command::Colour(args) => colour::run(&args),
        Command::Presets(args) => presets::run(&args),
    };
    match result {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            error.exit_code().into()
        }
    }
}
