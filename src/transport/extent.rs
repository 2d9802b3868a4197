//! How many stops, samples and bundles the rays of a medium have, told from its levels and directions alone.

use super::bundles::turns;
use super::levels::Levels;
use super::operator::is_tall;
use super::path::LONGEST_ARC;
use super::solve::Resolution;
use crate::geometry::{Direction, directions};
use crate::medium::Medium;

/// Sums over all rays of a solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// Points at which rays are cut.
    pub stops: f64,
    /// Bundles of thick air, 0 in thin; and the state's levels that these touch.
    pub bundles: f64,
    pub touched: f64,
}

/// Levels of the state that a bundle touches besides those that its part of the ray crosses: cubic weights.
const AROUND: f64 = 3.0;

impl Extent {
    /// Of the rays that solve a medium.
    pub fn of(medium: &Medium, resolution: &Resolution) -> Self {
        Extent::new(&Levels::new(medium, resolution.levels_in(medium)), resolution.zeniths)
    }

    /// Of the rays from all levels of the state, with so many zenith directions above the horizontal.
    fn new(levels: &Levels, zeniths: usize) -> Self {
        let (ground, top) = (levels.fine[0], levels.fine[levels.fine.len() - 1]);
        let turns = if levels.is_refined() { turns(is_tall(ground, top)) } else { Vec::new() };
        let mut sum = Extent::default();
        for &r in &levels.coarse {
            for d in directions(r, ground, top, zeniths) {
                sum.add(&d, r, levels, &turns);
            }
        }
        sum
    }

    fn add(&mut self, d: &Direction, r: f64, levels: &Levels, turns: &[f64]) {
        let (ground, top) = (levels.fine[0], levels.fine[levels.fine.len() - 1]);
        let nearest = r * (1.0 - d.mu * d.mu).max(0.0).sqrt();
        // Angle at the centre between the ray's nearest point and where it reaches a radius.
        let angle = |radius: f64| libm::acos((nearest / radius).clamp(-1.0, 1.0));
        let crossed = |list: &[f64]| {
            let below = |z: f64| list.partition_point(|&x| x < z) as f64;
            let (here, down) = (below(r), below(nearest.max(ground)));
            match (d.hits_ground, d.mu < 0.0) {
                (true, _) => here,
                (false, true) => here - down + list.len() as f64 - down,
                (false, false) => list.len() as f64 - here,
            }
        };
        let turn = match (d.hits_ground, d.mu < 0.0) {
            (true, _) => angle(r) - angle(ground),
            (false, true) => angle(r) + angle(top),
            (false, false) => angle(top) - angle(r),
        };
        // Most arcs between two shells are short.
        let shells = crossed(&levels.fine);
        self.stops += 1.0 + shells + (turn / LONGEST_ARC - 0.25 * shells).max(0.0);
        if !turns.is_empty() {
            let bundles = 1.0 + turns.partition_point(|&t| t < turn) as f64;
            self.bundles += bundles;
            // Each part of the ray counts for the bundles at both of its ends.
            self.touched += 2.0 * crossed(&levels.coarse) + AROUND * bundles;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset;
    use crate::transport::column::Shells;
    use crate::transport::path::Path;

    fn counted(medium: &Medium) -> (f64, f64) {
        let levels = Levels::new(medium, Resolution::PAPER.levels_in(medium));
        let shells = Shells::new(medium, &levels);
        let (ground, top) = (medium.ground_radius, medium.top_radius);
        let rays = levels
            .coarse
            .iter()
            .flat_map(|&r| directions(r, ground, top, 10).into_iter().map(move |d| (r, d)));
        let stops: usize =
            rays.map(|(r, d)| Path::new(&shells, &levels, r, d.mu, d.hits_ground).stops.len()).sum();
        (stops as f64, Extent::new(&levels, 10).stops)
    }

    /// Within a tenth of what paths are cut into, in a low shell and in one of two radii.
    #[test]
    fn stops_are_foreseen() {
        for set in [vec![], vec!["ground.radius_km=32".to_string()]] {
            let medium = preset::load("earth-paper", &set).unwrap().medium(&[440.0, 550.0]);
            let (found, foreseen) = counted(&medium);
            assert!((foreseen / found - 1.0).abs() < 0.1, "{set:?}: {foreseen} instead of {found}");
        }
    }
}
