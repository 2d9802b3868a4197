//! The CIE 1931 2° standard observer: from a spectrum to XYZ by plain summation at 1 nm.

use super::Spectrum;
use std::sync::OnceLock;

/// Lumens per watt of XYZ in photometric units (CIE 018:2019: K_m rounded to 683).
pub const LUMINOUS_EFFICACY: f64 = 683.0;

/// First and last wavelength of the tabulated observer, nm.
pub const OBSERVER_RANGE: (usize, usize) = (360, 830);

const TABLE_1931: &str = include_str!("../../presets/spectra/cie1931-2deg.csv");
const TABLE_1964: &str = include_str!("../../presets/spectra/cie1964-10deg.csv");

/// Whose colours are meant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
pub enum StandardObserver {
    /// CIE 1931, 2°: the one of all RGB spaces.
    #[default]
    #[cfg_attr(feature = "cli", value(name = "cie1931-2deg"))]
    Cie1931,
    /// CIE 1964, 10°: for large fields, as skies are. Its Y is no luminance.
    #[cfg_attr(feature = "cli", value(name = "cie1964-10deg"))]
    Cie1964,
}

impl StandardObserver {
    pub fn observer(self) -> &'static Observer {
        match self {
            StandardObserver::Cie1931 => Observer::cie1931(),
            StandardObserver::Cie1964 => Observer::cie1964(),
        }
    }

    /// As in manifests.
    pub fn name(self) -> &'static str {
        match self {
            StandardObserver::Cie1931 => "CIE 1931 2 degrees",
            StandardObserver::Cie1964 => "CIE 1964 10 degrees",
        }
    }
}

/// The colour-matching functions x̄, ȳ, z̄ at whole nanometres.
pub struct Observer {
    /// Row k belongs to 360 + k nm.
    rows: Vec<[f64; 3]>,
}

impl Observer {
    /// The CIE 1931 2° observer at 1 nm, 360–830 nm (471 rows).
    pub fn cie1931() -> &'static Observer {
        static OBSERVER: OnceLock<Observer> = OnceLock::new();
        OBSERVER.get_or_init(|| Observer { rows: parse(TABLE_1931) })
    }

    /// The CIE 1964 10° observer at 1 nm, 360–830 nm (471 rows).
    pub fn cie1964() -> &'static Observer {
        static OBSERVER: OnceLock<Observer> = OnceLock::new();
        OBSERVER.get_or_init(|| Observer { rows: parse(TABLE_1964) })
    }

    /// x̄, ȳ, z̄ at a wavelength (nm): linear between whole nanometres, 0 outside 360–830 nm.
    pub fn at(&self, wavelength_nm: f64) -> [f64; 3] {
        let from_start = wavelength_nm - OBSERVER_RANGE.0 as f64;
        if !(0.0..=(self.rows.len() - 1) as f64).contains(&from_start) {
            return [0.0; 3];
        }
        let below = (from_start as usize).min(self.rows.len() - 2);
        let t = from_start - below as f64;
        std::array::from_fn(|c| {
            let (a, b) = (self.rows[below][c], self.rows[below + 1][c]);
            a + (b - a) * t
        })
    }

    /// Rows (wavelength in nm, [x̄, ȳ, z̄]) between two whole nanometres, both included.
    pub fn rows(&self, from_nm: usize, to_nm: usize) -> impl Iterator<Item = (f64, [f64; 3])> + '_ {
        let range = from_nm - OBSERVER_RANGE.0..=to_nm - OBSERVER_RANGE.0;
        range.map(|k| ((OBSERVER_RANGE.0 + k) as f64, self.rows[k]))
    }

    /// Σ f·(x̄, ȳ, z̄)·1 nm over 360–830 nm: XYZ in the unit of f times nm. Times [`LUMINOUS_EFFICACY`] it is
    /// photometric. ASTM E308 in its practice range stops at 780 nm: 2e-6 less X for a white, else the same.
    pub fn xyz(&self, f: impl Fn(f64) -> f64) -> [f64; 3] {
        self.xyz_between(OBSERVER_RANGE.0, OBSERVER_RANGE.1, f)
    }

    /// [`Observer::xyz`] over part of the range, in whole nanometres, both ends included.
    pub fn xyz_between(&self, from_nm: usize, to_nm: usize, f: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut xyz = [0.0; 3];
        for (wavelength, cmf) in self.rows(from_nm, to_nm) {
            let value = f(wavelength);
            for c in 0..3 {
                xyz[c] += value * cmf[c];
            }
        }
        xyz
    }

    /// XYZ of a spectrum, its end values held over 360–830 nm.
    pub fn xyz_of(&self, spectrum: &Spectrum) -> [f64; 3] {
        self.xyz(|w| spectrum.at(w))
    }
}

/// Σ ȳ at 1 nm over 360–830 nm; 100 / Σ ȳ is the k of ASTM E308 for the equal-energy illuminant.
pub fn y_bar_sum() -> f64 {
    Observer::cie1931().xyz(|_| 1.0)[1]
}

/// Chromaticity x, y of XYZ; that of nothing is (0, 0).
pub fn chromaticity(xyz: [f64; 3]) -> [f64; 2] {
    let sum = xyz[0] + xyz[1] + xyz[2];
    if sum == 0.0 { [0.0; 2] } else { [xyz[0] / sum, xyz[1] / sum] }
}

/// The table is ours and embedded: a line that does not parse is a build defect and caught by every test.
fn parse(table: &str) -> Vec<[f64; 3]> {
    let lines = table.lines().filter(|l| l.starts_with(|c: char| c.is_ascii_digit()));
    let rows: Vec<[f64; 3]> = lines
        .enumerate()
        .map(|(k, line)| {
            let v: Vec<f64> = line.split(',').map(|t| t.parse().expect("a number")).collect();
            assert_eq!(v[0], (OBSERVER_RANGE.0 + k) as f64, "wavelengths in steps of 1 nm");
            [v[1], v[2], v[3]]
        })
        .collect();
    assert_eq!(rows.len(), OBSERVER_RANGE.1 - OBSERVER_RANGE.0 + 1);
    rows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Σ ȳ of the CIE table at 1 nm is 106.856917, and the equal-energy spectrum is nearly (1/3, 1/3).
    #[test]
    fn the_table_sums_to_the_published_values() {
        assert!((y_bar_sum() - 106.856_917).abs() < 1e-6);
        let xy = chromaticity(Observer::cie1931().xyz(|_| 1.0));
        assert!((xy[0] - 0.333_31).abs() < 1e-5 && (xy[1] - 0.333_29).abs() < 1e-5, "{xy:?}");
    }

    /// Σ of the 10° functions at 1 nm, in CIE 15:2004: 116.648519, 116.661877, 116.673980.
    #[test]
    fn the_larger_field_sums_to_the_published_values() {
        let sums = Observer::cie1964().xyz(|_| 1.0);
        for (sum, known) in sums.iter().zip([116.648_519, 116.661_877, 116.673_981]) {
            assert!((sum - known).abs() < 2e-6, "{sums:?}");
        }
    }

    /// ȳ peaks at 1 between 555 and 556 nm by the definition of the photopic observer.
    #[test]
    fn luminosity_peaks_at_one() {
        let o = Observer::cie1931();
        assert!((o.at(555.0)[1] - 1.0).abs() < 1e-4);
        assert_eq!(o.at(359.9), [0.0; 3]);
        assert_eq!(o.at(830.0), o.rows(830, 830).next().unwrap().1);
        let (a, b) = (o.at(450.0)[2], o.at(451.0)[2]);
        assert_eq!(o.at(450.5)[2], a + (b - a) * 0.5);
    }

    /// A black body of 5778 K has the chromaticity (.326432, .335725) of an independent implementation.
    #[test]
    fn the_sun_as_a_black_body() {
        let xy = chromaticity(Observer::cie1931().xyz(|w| crate::spectrum::planck_law(w, 5778.0)));
        assert!((xy[0] - 0.326_432).abs() < 1e-6 && (xy[1] - 0.335_725).abs() < 1e-6, "{xy:?}");
    }
}
