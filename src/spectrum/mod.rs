//! Spectra and what the eye makes of them: wavelength grids, Planck's law, the CIE observer, colour spaces,
//! and the two ways back from a few wavelengths to XYZ. Wavelengths in nm, everything else in SI.

mod adaptation;
mod colour_space;
mod curve;
mod lab;
mod nanometres;
mod observer;
mod planck;
mod reconstruct;
mod spline;
mod weights;

pub use adaptation::{Adaptation, ILLUMINANTS, Rgb, RgbMatrix, White};
pub use colour_space::{ColourSpace, invert, multiply, srgb_decode, srgb_encode, white_of};
pub use curve::Spectrum;
pub use lab::{D65, Lab, delta_e_2000, delta_e_2000_scaled, lab_of_xyz};
pub use nanometres::at_nanometres;
pub use observer::{LUMINOUS_EFFICACY, OBSERVER_RANGE, Observer, StandardObserver, chromaticity, y_bar_sum};
pub use planck::planck_law;
pub use reconstruct::Reconstruction;
pub use spline::LogSpline;
pub use weights::{DEFAULT_RIDGE, fit_weights, fit_weights_by, hat_weights, hat_weights_seen_by, weighted};

/// First and last wavelength of every planet's spectra, nm.
pub const RANGE: (f64, f64) = (380.0, 780.0);

/// `n` wavelengths spread evenly over 380–780 nm, both ends included; one is put in the middle.
pub fn grid(n: usize) -> Vec<f64> {
    if n == 1 {
        return vec![0.5 * (RANGE.0 + RANGE.1)];
    }
    (0..n).map(|k| RANGE.0 + (RANGE.1 - RANGE.0) * k as f64 / (n - 1) as f64).collect()
}

/// Whole nanometres from 380 to 780, on which colours of planets are integrated (401 values).
pub fn fine_grid() -> Vec<f64> {
    (380..=780).map(f64::from).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Even grids have both ends and equal steps, whatever their size: 5 points are 100 nm apart.
    #[test]
    fn even_grids_reach_both_ends() {
        assert_eq!(grid(5), [380.0, 480.0, 580.0, 680.0, 780.0]);
        assert_eq!(grid(2), [380.0, 780.0]);
        assert_eq!(grid(1), [580.0]);
        assert_eq!(fine_grid().len(), 401);
    }
}
