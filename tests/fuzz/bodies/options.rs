//! What `tyndall bake` is asked: options, a line each, refused by the parser or by the command, or settings whose memory
//! can be told; and lists of planets.

use super::{file, good, refused};
use clap::{Args as _, Command, FromArgMatches};
use std::sync::OnceLock;
use tyndall::internals::bake::memory::estimate;
use tyndall::internals::commands::bake::{Args, list, settings_of};
use tyndall::internals::preset::{self, Planet};

pub fn bake(bytes: &[u8]) {
    static PLANET: OnceLock<Planet> = OnceLock::new();
    let planet = PLANET.get_or_init(|| preset::load("earth-paper", &[]).expect("a shipped preset"));
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    // Files are other targets' business.
    if ["--list", "--waters", "--depfile"].iter().any(|option| text.contains(option)) {
        return;
    }
    let words = ["bake", "earth-paper"].into_iter().chain(text.lines().take(12));
    let Ok(found) = Args::augment_args(Command::new("bake")).try_get_matches_from(words) else { return };
    let args = Args::from_arg_matches(&found).expect("what the parser took");
    match settings_of(&args, planet) {
        Err(error) => refused(&error),
        Ok(settings) => {
            assert!(settings.wavelengths_nm.iter().copied().all(good) && settings.json().is_object());
            assert!(estimate(planet, &settings) > 0);
        }
    }
}

/// A list names presets, whose files may be anything: each is refused in its turn, or read.
pub fn planets(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match list::parse(file(), text) {
        Err(error) => refused(&error),
        Ok(names) => {
            assert!(names.iter().all(|n| !n.is_empty() && n.trim() == n && !n.contains(['#', '\n'])));
            names.iter().take(4).for_each(|name| {
                let _ = preset::load(name, &[]).map_err(|error| refused(&error));
            });
        }
    }
}
