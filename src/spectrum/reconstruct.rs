//! From a few wavelengths back to colour, through a smooth curve at 1 nm.

use super::{LUMINOUS_EFFICACY, LogSpline, Observer, RANGE, Spectrum};

/// Takes transfers (radiance over solar irradiance, 1/sr) at a few wavelengths to XYZ: log-spline to 1 nm over
/// 380–780 nm, times the star's irradiance and the observer. The star's lines stay where they are, since only
/// the smooth transfer is interpolated.
pub struct Reconstruction {
    spline: LogSpline,
    /// Wavelength (nm) and 683 · irradiance · (x̄, ȳ, z̄), cd/m² per unit transfer and nm.
    rows: Vec<(f64, [f64; 3])>,
}

impl Reconstruction {
    /// Prepares for samples at rising wavelengths (nm) under a star's irradiance, W/(m² nm).
    pub fn new(wavelengths_nm: &[f64], irradiance: &Spectrum) -> Self {
        Reconstruction::seen_by(Observer::cie1931(), wavelengths_nm, irradiance)
    }

    /// The same for another observer.
    pub fn seen_by(observer: &Observer, wavelengths_nm: &[f64], irradiance: &Spectrum) -> Self {
        let rows = observer
            .rows(RANGE.0 as usize, RANGE.1 as usize)
            .map(|(w, cmf)| (w, cmf.map(|c| LUMINOUS_EFFICACY * irradiance.at(w) * c)))
            .collect();
        Reconstruction { spline: LogSpline::new(wavelengths_nm), rows }
    }

    /// XYZ in cd/m² of transfers at the wavelengths, 1/sr; zero where no transfer is positive.
    pub fn xyz(&self, transfer: &[f64]) -> [f64; 3] {
        let Some(curve) = self.spline.fit(transfer) else { return [0.0; 3] };
        self.sum(|w| curve.at(w))
    }

    /// XYZ in cd/m² of a transfer known at every wavelength: the reference of [`Reconstruction::xyz`].
    pub fn sum(&self, transfer: impl Fn(f64) -> f64) -> [f64; 3] {
        let mut xyz = [0.0; 3];
        for (w, row) in &self.rows {
            let t = transfer(*w);
            for c in 0..3 {
                xyz[c] += t * row[c];
            }
        }
        xyz
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{delta_e_2000_scaled, grid, planck_law};

    fn star() -> Spectrum {
        // Not the Sun, and with a line in it: an M dwarf with a deep band at 589 nm.
        let line = |w: f64| if (w - 589.0).abs() < 2.0 { 0.2 } else { 1.0 };
        Spectrum::sampled((360..=830).map(f64::from).collect(), |w| line(w) * planck_law(w, 3600.0) * 1e-14)
            .unwrap()
    }

    /// A sky of λ⁻⁴ scattering under an exponential veil: eight samples cannot be told from the 1 nm sum
    /// (a difference of 1 is just visible), and even four stay within 2.
    #[test]
    fn a_few_samples_give_the_colour_of_the_whole() {
        let sky = |w: f64| {
            let ratio = 550.0 / w;
            let tau = 0.3 * ratio * ratio * ratio * ratio;
            (1.0 - libm::exp(-tau)) * libm::exp(-2.0 * tau) * 0.05
        };
        for (n, limit) in [(4, 2.0), (8, 0.03), (15, 0.003)] {
            let r = Reconstruction::new(&grid(n), &star());
            let samples: Vec<f64> = grid(n).into_iter().map(sky).collect();
            let difference = delta_e_2000_scaled(r.sum(sky), r.xyz(&samples));
            assert!(difference < limit, "{n}: {difference}");
        }
    }

    /// A grey transfer gives the star's own XYZ times its value, with any number of wavelengths.
    #[test]
    fn grey_is_the_colour_of_the_star() {
        let star = star();
        let expected = Observer::cie1931().xyz_between(380, 780, |w| star.at(w)).map(|v| v * 683.0 * 0.25);
        for n in [1, 2, 3, 15] {
            let xyz = Reconstruction::new(&grid(n), &star).xyz(&vec![0.25; n]);
            assert!((0..3).all(|c| (xyz[c] / expected[c] - 1.0).abs() < 1e-12), "{n}: {xyz:?} {expected:?}");
        }
        assert_eq!(Reconstruction::new(&grid(3), &star).xyz(&[0.0; 3]), [0.0; 3]);
    }
}
