//! Tables of numbers as CSV: refused, or numbers that can be answered, drawn and written again.

use super::{file, one_line, refused};
use tyndall::internals::chart::draw::pictures;
use tyndall::internals::chart::{Measure, mark, parse_csv, to_csv};
use tyndall::internals::commands::colour_input;
use tyndall::internals::files::points::parse_points;
use tyndall::internals::preset;

pub fn points(bytes: &[u8]) {
    match parse_points(file(), bytes) {
        Err(error) => refused(&error),
        Ok(points) => assert!(points.iter().all(|p| p.altitude >= 0.0 && p.nu().is_finite())),
    }
}

/// Of `tyndall colour`.
pub fn spectra(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match colour_input::parse(file(), text) {
        Err(error) => refused(&error),
        Ok(list) => assert!(list.spectra.iter().all(|s| s.spectrum.at(550.0).is_finite())),
    }
}

/// Of presets.
pub fn spectrum(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    match preset::read_spectrum("fuzzed.csv", text, "share") {
        Err(error) => refused(&error),
        Ok(spectrum) => assert!(spectrum.at_all(&[1.0, 550.0, 1e9]).iter().all(|v| v.is_finite())),
    }
}

/// Of `tyndall chart --redraw`; one in 64 is drawn, which takes long.
pub fn chart(bytes: &[u8]) {
    let mut rows = match parse_csv(file(), bytes) {
        Err(error) => return refused(&error),
        Ok(rows) => rows,
    };
    mark(&mut rows);
    let again = to_csv(&rows).expect("a CSV of what was one");
    assert_eq!(parse_csv(file(), &again).map(|r| r.len()).ok(), Some(rows.len()));
    if bytes.iter().map(|b| usize::from(*b)).sum::<usize>() % 64 == 0
        && let Err(error) = pictures(&rows, Measure::DEFAULT)
    {
        one_line(&error.to_string());
    }
}
