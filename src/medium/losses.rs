//! What a shell loses of its air: what its top cuts off, and how much of it holds nothing.

use super::{Constituent, DensityProfile, Medium};

/// Optical depth of a ray that grazes a constituent below which nobody sees whether it is there: 1 % of the light.
const SEEN: f64 = 0.01;
/// Share of a constituent's column above the top from which on the loss is told: by day as much of thin air's light is
/// lost, and tables err by 1 % anyway. Thick air is lit to a depth of about 1, so that a hundredth of that counts.
const CUT: f64 = 0.01;
/// Optical depth of a ray that grazes the air below which the shell counts as empty there: a tenth of what is seen.
const EMPTY: f64 = 1e-3;
/// Scale heights of an exponential above the top in which its rest is taken to lie: e^−20 of it is beyond.
const SCALES: f64 = 20.0;
/// Altitudes at which the shell is looked at, besides those of the profiles, and steps along half a ray.
const ALTITUDES: usize = 200;
const STEPS: usize = 64;

/// What the top does to a constituent.
#[derive(Clone, Debug, PartialEq)]
pub struct Cut {
    /// Number of the constituent.
    pub constituent: usize,
    /// Share of its column that lies above the top.
    pub share: f64,
    /// Its density below the top over its largest, and whether the largest is that at the ground.
    pub at_top: f64,
    pub over_ground: bool,
    /// Largest vertical optical depth that lies above the top, and its wavelength, nm.
    pub depth: f64,
    pub nm: f64,
}

impl Medium {
    /// Constituents of which the top cuts off more than is seen, or whose tables end there with much left.
    pub fn cuts(&self) -> Vec<Cut> {
        (0..self.constituents.len()).filter_map(|c| self.cut(c)).collect()
    }

    fn cut(&self, constituent: usize) -> Option<Cut> {
        let c = &self.constituents[constituent];
        let (height, end) = (self.height(), c.density.end());
        let (w, extinction) = strongest(c)?;
        // Columns take long, and nothing is cut off a profile that ends below the top.
        let over = end > height;
        let [whole, lost] = [0.0, height].map(|from| if over { c.density.column(from, end) } else { 0.0 });
        let largest = largest(&c.density, height);
        let at_top = c.density.at(height * (1.0 - 1e-9)) / largest;
        let cut = Cut {
            constituent,
            share: if whole > 0.0 { lost / whole } else { 0.0 },
            at_top: if at_top.is_finite() { at_top } else { 0.0 },
            over_ground: c.density.at(0.0) >= largest,
            depth: lost * extinction,
            nm: self.wavelengths_nm[w],
        };
        let ceiling = end.min(height.max(0.0) + SCALES * c.density.scale());
        let told = over
            && cut.depth >= CUT * (whole * extinction).min(1.0)
            && self.grazing(&[constituent], w, (height, ceiling)) >= SEEN;
        // A table that ends at the top says nothing of what is above it.
        let stops = matches!(c.density, DensityProfile::Linear { .. } | DensityProfile::LogLinear { .. })
            && end <= height * (1.0 + 1e-9)
            && cut.at_top >= CUT
            && self.grazing(&[constituent], w, (0.9 * height, height)) >= SEEN;
        (told || stops).then_some(cut)
    }

    /// The altitude (m) above which a ray that grazes the air meets next to nothing; none where that holds everywhere.
    pub fn empty_above(&self) -> Option<f64> {
        let height = self.height();
        let mut altitudes: Vec<f64> = (0..ALTITUDES)
            .map(|k| height * k as f64 / ALTITUDES as f64)
            .chain(self.middles(0.0, height))
            .collect();
        altitudes.sort_by(f64::total_cmp);
        let filled = altitudes.iter().rposition(|&z| self.is_filled(z))?;
        Some(altitudes.get(filled + 1).copied().unwrap_or(height))
    }

    /// Whether a ray that grazes the air at an altitude, m, meets more than next to nothing.
    pub fn is_filled(&self, altitude: f64) -> bool {
        let path = |c: &Constituent| self.path(&c.density, altitude, self.height());
        let paths: Vec<f64> = self.constituents.iter().map(path).collect();
        let depth = |w: usize| -> f64 {
            self.constituents.iter().zip(&paths).map(|(c, path)| c.extinction(w) * path).sum()
        };
        (0..self.wavelengths_nm.len()).any(|w| depth(w) >= EMPTY)
    }

    /// Largest optical depth at wavelength number `w` of some constituents along a ray that grazes them between two
    /// altitudes, m, up to the upper one.
    fn grazing(&self, which: &[usize], w: usize, (from, to): (f64, f64)) -> f64 {
        let kinks = self.middles(from, to);
        kinks.into_iter().chain([from]).map(|z| self.chord(which, w, z, to)).fold(0.0, f64::max)
    }

    /// Altitudes in the middle between neighbouring kinks of all profiles and two ends, m.
    fn middles(&self, from: f64, to: f64) -> Vec<f64> {
        let mut edges: Vec<f64> = self.constituents.iter().flat_map(|c| c.density.kinks()).collect();
        edges.retain(|&z| z > from && z < to);
        edges.extend([from, to]);
        edges.sort_by(f64::total_cmp);
        edges.windows(2).map(|e| 0.5 * (e[0] + e[1])).collect()
    }

    /// Optical depth at wavelength number `w` of some constituents along the level ray at an altitude, both ways, up to
    /// a ceiling, m.
    fn chord(&self, which: &[usize], w: usize, altitude: f64, ceiling: f64) -> f64 {
        let depth = |c: &usize| {
            let c = &self.constituents[*c];
            c.extinction(w) * self.path(&c.density, altitude, ceiling)
        };
        which.iter().map(depth).sum()
    }

    /// Integral of a density along the level ray at an altitude, both ways, up to a ceiling, m.
    fn path(&self, density: &DensityProfile, altitude: f64, ceiling: f64) -> f64 {
        let r = self.ground_radius + altitude;
        let length = ((ceiling - altitude).max(0.0) * (ceiling + altitude + 2.0 * self.ground_radius)).sqrt();
        // s = length · x²: short steps where the ray is level.
        let step = |k: usize| {
            let x = (k as f64 + 0.5) / STEPS as f64;
            let s = length * x * x;
            density.at(altitude + s * s / ((r * r + s * s).sqrt() + r)) * 2.0 * x
        };
        2.0 * length / STEPS as f64 * (0..STEPS).map(step).sum::<f64>()
    }
}

/// Wavelength number at which a constituent takes most, and its extinction there, 1/m; none where it takes nothing.
fn strongest(c: &Constituent) -> Option<(usize, f64)> {
    let all = (0..c.scattering.len()).map(|w| (w, c.extinction(w)));
    all.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|found| found.1 > 0.0)
}

/// Largest density up to an altitude.
fn largest(density: &DensityProfile, height: f64) -> f64 {
    let kinks = density.kinks().into_iter().filter(|&z| z <= height);
    kinks.chain([0.0, height]).map(|z| density.at(z)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use crate::medium::{DensityProfile, Medium};
    use crate::preset;

    fn earth() -> Medium {
        preset::load("earth-paper", &[]).unwrap().medium(&[440.0, 550.0, 680.0])
    }

    /// Air of a scale height of 8 km loses e^(−10/8) of its column to a top of 10 km, and next to nothing to one of 65.
    #[test]
    fn a_low_top_cuts_what_the_profile_says() {
        let mut medium = earth();
        assert_eq!(medium.cuts(), []);
        medium.top_radius = medium.ground_radius + 10e3;
        let cuts = medium.cuts();
        assert_eq!(cuts.len(), 1, "{cuts:?}");
        let share = libm::exp(-10.0 / 8.0);
        assert!((cuts[0].share - share).abs() < 1e-6 && (cuts[0].at_top - share).abs() < 1e-6, "{cuts:?}");
        assert_eq!((cuts[0].constituent, cuts[0].nm), (0, 440.0));
    }

    /// A layer above the top is lost as a whole, one across it in part; of one of next to no depth nothing is told.
    #[test]
    fn layers_are_cut_by_their_share() {
        let share = |bottom: f64, top: f64, factor: f64| {
            let mut medium = earth();
            medium.constituents[1].density = DensityProfile::Layer { bottom, top };
            medium.constituents[1].scattering.iter_mut().for_each(|s| *s *= factor);
            medium.cuts().first().map(|c| c.share)
        };
        assert_eq!(share(82e3, 84e3, 0.01), Some(1.0));
        assert!((share(64e3, 66e3, 0.01).unwrap() - 0.5).abs() < 1e-6);
        assert_eq!(share(64e3, 66e3, 1e-7), None);
        assert_eq!(share(60e3, 65e3, 1.0), None);
    }

    /// A table that ends at the top with density left is told of; one that thins out is not.
    #[test]
    fn a_table_that_stops_at_the_top_is_told_of() {
        let found = |last: f64| {
            let mut medium = earth();
            medium.constituents[0].density = DensityProfile::Linear { nodes: vec![(0.0, 1.0), (65e3, last)] };
            medium.cuts().first().map(|c| (c.share, c.at_top))
        };
        let (share, at_top) = found(0.4).unwrap();
        assert!(share == 0.0 && (at_top - 0.4).abs() < 1e-6, "{share} {at_top}");
        assert_eq!(found(1e-3), None);
    }

    /// Air of 8 km is empty above some ten scale heights, however high the shell; a sheet far above it fills the shell.
    #[test]
    fn a_tall_shell_is_empty_above_its_air() {
        let mut medium = earth();
        medium.top_radius = medium.ground_radius + 800e3;
        let above = medium.empty_above().unwrap();
        assert!((70e3..100e3).contains(&above), "{above}");
        medium.constituents[1].density = DensityProfile::Layer { bottom: 700e3, top: 701e3 };
        let above = medium.empty_above().unwrap();
        assert!((701e3..710e3).contains(&above), "{above}");
        medium.constituents.clear();
        assert_eq!(medium.empty_above(), None);
    }
}
