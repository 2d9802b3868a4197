//! Planets that the reader lets through are solved, coarsely: light is finite and not negative, and does not take long.

use super::edits::{Base, text};
use super::{good, refused};
use std::sync::OnceLock;
use tyndall::internals::geometry::Point;
use tyndall::internals::geometry::view::View;
use tyndall::internals::medium::Medium;
use tyndall::internals::preset;
use tyndall::internals::transport::solve::{Orders, Resolution, Solution};

pub fn solve(bytes: &[u8]) {
    static BASES: OnceLock<Vec<Base>> = OnceLock::new();
    let bases = BASES.get_or_init(|| {
        let texts = [
            include_str!("../../../presets/planets/earth-paper.json"),
            include_str!("../../../presets/planets/mars.json"),
            include_str!("../../../presets/planets/venus.json"),
        ];
        texts.iter().map(|t| Base::new(t)).collect()
    });
    let Some(text) = text(bytes, bases) else { return };
    let planet = match preset::read("fuzzed.json", &text, &[]) {
        Err(error) => return refused(&error),
        Ok(planet) => planet,
    };
    let medium = planet.medium(&[400.0, 700.0]);
    // As every command does.
    if medium.check().is_ok() {
        shines(&medium);
    }
}

fn shines(medium: &Medium) {
    let mut resolution =
        Resolution { zeniths: 6, first_azimuths: 4, azimuths: 2, sun_nodes: 12, ..Resolution::PAPER };
    (resolution.sunlight_nodes, resolution.levels.coarse) = (24, 8);
    let solution = Solution::new(medium, &resolution, Orders::First(3));
    let all: Vec<usize> = (0..medium.constituents.len()).collect();
    let height = medium.top_radius - medium.ground_radius;
    for (share, mu, mu_s) in [(0.0, 0.5, 0.4), (0.3, -0.2, -0.1), (1.5, -1.0, 0.9), (0.0, 0.0, 1.0)] {
        let point = Point { altitude: share * height, mu, mu_s, azimuth_deg: 20.0 };
        let Some(view) = View::enter(&point, medium.ground_radius, medium.top_radius) else { continue };
        let light = solution.radiance(&view, &all);
        assert!(light.scattering.iter().chain(&light.ground).copied().all(good), "{point:?}: {light:?}");
    }
    assert!(solution.ground_irradiance(0.4).into_iter().all(good));
}
