//! Layers of a constituent that stand out of the air around them: what tables over altitude may be too coarse for.

use super::{DensityProfile, Medium};

/// Where the density of a constituent is at least half of a maximum that it has, and it and all air on either side are
/// thinner than a third of what is there.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheet {
    /// Number of the constituent.
    pub constituent: usize,
    /// Where it begins and ends, m.
    pub altitudes: [f64; 2],
    /// Its vertical optical depth where it takes most.
    pub depth: f64,
}

/// Vertical optical depth from which on a sheet that only absorbs is told of: it takes no more of the light than that.
const ABSORBED: f64 = 0.1;
/// Optical depth by scattering of the level ray inside a sheet from which on it is told of: it shines with as much light.
const SCATTERED: f64 = 0.01;
/// Extinction half a thickness beside a sheet over that in its middle, at most. Air that thins out evenly has 0.5, and
/// tables hold it well, since it is straight in their logarithm; decks of clouds of several kinds, as on Venus, as much.
const BESIDE: f64 = 1.0 / 3.0;
/// Halvings of a stretch in which the density falls to half.
const HALVINGS: usize = 50;

impl Sheet {
    /// m.
    pub fn thickness(&self) -> f64 {
        self.altitudes[1] - self.altitudes[0]
    }
}

impl Medium {
    /// Sheets that are thinner than the shell by a factor of 2 at least and thick enough in light to be seen.
    pub fn sheets(&self) -> Vec<Sheet> {
        let of = |c: usize| {
            let ranges = half_maxima(&self.constituents[c].density, self.height());
            ranges.into_iter().filter_map(move |altitudes| self.sheet(c, altitudes))
        };
        (0..self.constituents.len()).flat_map(of).collect()
    }

    fn sheet(&self, constituent: usize, altitudes: [f64; 2]) -> Option<Sheet> {
        let [bottom, top] = altitudes;
        let (c, thickness) = (&self.constituents[constituent], top - bottom);
        let column = c.density.column(bottom, top);
        let most = |of: &dyn Fn(usize) -> f64| (0..self.wavelengths_nm.len()).map(of).fold(0.0, f64::max);
        // Half of the longest straight way inside the layer, and its mean density on it.
        let level = (2.0 * (self.ground_radius + bottom) * thickness).sqrt().max(thickness);
        let scattered = most(&|w| c.scattering[w] * column / thickness * 2.0 * level);
        let depth = most(&|w| c.extinction(w) * column);
        let seen = scattered >= SCATTERED || depth >= ABSORBED;
        let falls = |of: &dyn Fn(f64) -> f64| {
            let here = of(0.5 * (bottom + top));
            let beside = [bottom - 0.5 * thickness, top + 0.5 * thickness];
            let inside = 0.0..self.height();
            here > 0.0 && beside.iter().all(|z| !inside.contains(z) || of(*z) < BESIDE * here)
        };
        let stands_out = || {
            let any = |w| falls(&|z| self.extinction_at(w, z));
            falls(&|z| c.density.at(z)) && (0..self.wavelengths_nm.len()).any(any)
        };
        let thin = thickness > 0.0 && thickness <= 0.5 * self.height();
        (thin && seen && stands_out()).then_some(Sheet { constituent, altitudes, depth })
    }

    /// Extinction of all constituents at an altitude (m) and wavelength number `w`, 1/m.
    fn extinction_at(&self, w: usize, altitude: f64) -> f64 {
        self.constituents.iter().map(|c| c.extinction(w) * c.density.at(altitude)).sum()
    }
}

/// Stretches between ground and top (m) in which a profile is at least half of a local maximum, lowest first.
fn half_maxima(density: &DensityProfile, height: f64) -> Vec<[f64; 2]> {
    // Profiles have their maxima at kinks, at the ground or, cut off, at the top.
    let mut places: Vec<f64> = density.kinks().into_iter().filter(|&z| z > 0.0 && z < height).collect();
    places.extend([0.0, height]);
    places.sort_by(f64::total_cmp);
    let value = |z: f64| density.at(z.clamp(0.0, height));
    let mut out: Vec<[f64; 2]> = Vec::new();
    for (k, &at) in places.iter().enumerate() {
        let peak = value(at);
        let least = |other: Option<&f64>| other.is_none_or(|&z| value(z) <= peak);
        let before = k.checked_sub(1).and_then(|k| places.get(k));
        if peak <= 0.0 || !least(before) || !least(places.get(k + 1)) {
            continue;
        }
        let below = places[..k].iter().rev();
        let found = [
            fall(&value, at, below.copied(), 0.0),
            fall(&value, at, places[k + 1..].iter().copied(), height),
        ];
        // A small maximum beside a larger one is a part of that.
        let highest = places.iter().filter(|z| (found[0]..=found[1]).contains(z)).all(|&z| value(z) <= peak);
        if highest && out.last().is_none_or(|last| *last != found) {
            out.push(found);
        }
    }
    out
}

/// Where, from a maximum on over places in one direction, the density first is half of it; `end` where it stays above.
fn fall(value: &impl Fn(f64) -> f64, from: f64, places: impl Iterator<Item = f64>, end: f64) -> f64 {
    let half = 0.5 * value(from);
    let mut above = from;
    for place in places {
        if value(place) >= half && value(0.5 * (above + place)) >= half {
            above = place;
            continue;
        }
        let mut below = place;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (above + below);
            if value(middle) >= half { above = middle } else { below = middle }
        }
        return above;
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::preset;

    fn air() -> Medium {
        preset::load("earth-paper", &[]).unwrap().medium(&[440.0, 550.0, 680.0])
    }

    /// Half maxima of a tent are half of its sides, of a layer itself, of an exponential ln 2 of its scale height; a table
    /// may have several.
    #[test]
    fn half_maxima_are_where_they_should_be() {
        let of = |density: DensityProfile| half_maxima(&density, 60e3);
        let close = |found: Vec<[f64; 2]>, wanted: &[[f64; 2]]| {
            assert_eq!(found.len(), wanted.len(), "{found:?}");
            let pairs = found.iter().flatten().zip(wanted.iter().flatten());
            pairs.for_each(|(a, b)| assert!((a - b).abs() < 1.0, "{found:?}"));
        };
        close(of(DensityProfile::Tent { bottom: 16e3, centre: 20e3, top: 25e3 }), &[[18e3, 22.5e3]]);
        close(of(DensityProfile::Layer { bottom: 10e3, top: 10.2e3 }), &[[10e3, 10.2e3]]);
        close(of(DensityProfile::Exponential { scale_height: 8e3 }), &[[0.0, 8e3 * std::f64::consts::LN_2]]);
        let nodes = vec![
            (1e3, 0.0),
            (2e3, 1.0),
            (3e3, 0.0),
            (9e3, 0.0),
            (9e3 + 1e-6, 2.0),
            (9.1e3, 2.0),
            (9.2e3, 0.1),
        ];
        let table = of(DensityProfile::Linear { nodes });
        close(table, &[[1.5e3, 2.5e3], [9e3, 9.1e3 + 100.0 / 1.9]]);
        let steps = vec![(1e3, 0.0), (2e3, 1.0), (3e3, 0.1), (4e3, 0.11), (5e3, 0.0)];
        close(of(DensityProfile::Linear { nodes: steps }), &[[1.5e3, 2.0e3 + 500.0 / 0.9]]);
        let cut = of(DensityProfile::Layer { bottom: 59.9e3, top: 60.1e3 });
        close(cut, &[[59.9e3, 60e3]]);
    }

    /// A sheet stands out of the air around it in extinction, and is seen.
    #[test]
    fn only_what_stands_out_is_a_sheet() {
        let count = |factor: f64, absorbs: bool| {
            let mut medium = air();
            let haze = &mut medium.constituents[1];
            haze.density = DensityProfile::Layer { bottom: 20e3, top: 20.5e3 };
            haze.scattering.iter_mut().for_each(|s| *s *= factor);
            if absorbs {
                std::mem::swap(&mut haze.scattering, &mut haze.absorption);
            }
            medium.sheets().iter().filter(|s| s.constituent == 1).count()
        };
        assert_eq!(
            [count(1.0, false), count(1e-4, false), count(30.0, true), count(1.0, true)],
            [1, 0, 1, 0]
        );
    }
}
