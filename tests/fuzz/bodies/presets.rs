//! Presets: refused, or something that can be computed with and that comes back from its resolved form.

use super::edits::{Base, text};
use super::{good, refused};
use std::sync::OnceLock;
use tyndall::internals::bake::memory::estimate;
use tyndall::internals::layout::settings::Settings;
use tyndall::internals::preset::{self, Planet, Water};

macro_rules! bases {
    ($($file:literal),*) => {{
        static BASES: OnceLock<Vec<Base>> = OnceLock::new();
        BASES.get_or_init(|| vec![$(Base::new(include_str!(concat!("../../../presets/", $file)))),*])
    }};
}

pub fn planet(bytes: &[u8]) {
    let bases = bases!(
        "planets/earth.json",
        "planets/earth-paper.json",
        "planets/mars.json",
        "planets/venus.json",
        "planets/titan.json",
        "planets/earth-blog.json"
    );
    let Some(text) = text(bytes, bases) else { return };
    match preset::read("fuzzed.json", &text, &[]) {
        Err(error) => refused(&error),
        Ok(planet) => sound(&planet),
    }
}

pub fn sound(planet: &Planet) {
    let medium = planet.medium(&[400.0, 550.0, 700.0]);
    assert!(medium.vertical_optical_depth().into_iter().all(good));
    let phases = medium.constituents.iter().flat_map(|c| &c.phase).map(|p| p.value(0.3));
    assert!(phases.into_iter().all(good));
    assert!(planet.star.irradiance.at_all(&medium.wavelengths_nm).into_iter().all(good));
    assert!(Planet::from_resolved(&planet.resolved()).is_ok_and(|p| p == *planet));
    assert!(estimate(planet, &Settings::default()) > 0);
}

pub fn water(bytes: &[u8]) {
    let bases = bases!(
        "waters/phytoplankton.json",
        "waters/sandy.json",
        "waters/jerlov-1c.json",
        "waters/clear-ocean.json"
    );
    let Some(text) = text(bytes, bases) else { return };
    match preset::read_water("fuzzed.json", &text, &[]) {
        Err(error) => refused(&error),
        Ok(water) => {
            let medium = water.medium(&[400.0, 550.0, 700.0]);
            assert!(medium.absorption.iter().copied().all(good));
            assert!(medium.scatterers.iter().flat_map(|s| s.scattering.iter().copied()).all(good));
            assert!(medium.seabed_albedo.iter().copied().all(good));
            assert!(medium.refractive_index.iter().all(|n| *n >= 1.0));
            let phases = medium.scatterers.iter().flat_map(|s| &s.phase).map(|p| p.value(0.3));
            assert!(phases.into_iter().all(good));
            assert!(Water::from_resolved(&water.resolved()).is_ok_and(|w| w == water));
        }
    }
}

pub fn scene(bytes: &[u8]) {
    let bases = bases!("scenes/ocean.json", "scenes/walk.json", "scenes/rover.json", "scenes/orbit.json");
    let Some(text) = text(bytes, bases) else { return };
    match preset::read_scene("fuzzed.json", &text) {
        Err(error) => refused(&error),
        Ok(scene) => {
            let rising = |ends: [f64; 2]| ends[0] <= ends[1] && ends.iter().all(|v| v.is_finite());
            assert!([scene.altitudes, scene.suns, scene.elevations, scene.azimuths].into_iter().all(rising));
            assert!(scene.waters.iter().all(|w| rising(w.depths)));
            assert!(scene.tolerance.most > 0.0 && (0.5..1.0).contains(&scene.tolerance.share));
        }
    }
}

/// A line for each `--set`.
pub fn set(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let lines: Vec<String> = text.lines().take(4).map(str::to_string).collect();
    let paper = include_str!("../../../presets/planets/earth-paper.json");
    match preset::read("fuzzed.json", paper, &lines) {
        Err(error) => refused(&error),
        Ok(planet) => sound(&planet),
    }
}
