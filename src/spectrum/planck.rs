//! Black bodies.

/// First radiation constant 2πhc², W m² (CIE 15:2004; the exact SI value is 3.741771852e-16).
const FIRST: f64 = 3.741_771e-16;
/// Second radiation constant hc/k, m K, as ITS-90 and CIE 15:2004 fix it for colour temperatures. The exact SI
/// value, 1.438776877e-2, gives 8e-5 more light at 500 nm and 5778 K and moves the chromaticity by 2e-6.
const SECOND: f64 = 1.4388e-2;

/// Spectral radiance of a black body, W/(m² sr m): c₁/(πλ⁵) / (exp(c₂/λT) − 1) (Planck 1901, constants of
/// CIE 15:2004), for a
/// wavelength in nm and a temperature in K, both positive. Relative error a few 1e-16.
///
/// ```
/// let sun = tyndall::internals::spectrum::planck_law(500.0, 5778.0);
/// assert!((sun / 2.637353833e13 - 1.0).abs() < 1e-9);
/// ```
pub fn planck_law(wavelength_nm: f64, temperature: f64) -> f64 {
    let wavelength = wavelength_nm * 1e-9;
    let fifth = wavelength * wavelength * wavelength * wavelength * wavelength;
    FIRST / (std::f64::consts::PI * fifth) / libm::expm1(SECOND / (wavelength * temperature))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Wien: λ_max T = c₂ / 4.965114231744276, so a 4000 K body peaks at 724.45 nm.
    #[test]
    fn the_peak_obeys_wien() {
        let peak = SECOND / 4.965_114_231_744_276 / 4000.0 * 1e9;
        let at = |w| planck_law(w, 4000.0);
        assert!(at(peak) > at(peak - 0.2) && at(peak) > at(peak + 0.2));
    }

    /// Stefan–Boltzmann: ∫ B dλ = σT⁴/π with σ = 5.670374419e-8 W/(m² K⁴), here at 900 K; the constants of
    /// colorimetry, with the fourth power of their c₂, lie 6.5e-5 below the exact ones.
    #[test]
    fn the_integral_obeys_stefan_boltzmann() {
        let (mut sum, step) = (0.0, 5.0);
        for k in 0..400_000 {
            sum += planck_law(200.0 + step * (k as f64 + 0.5), 900.0) * step * 1e-9;
        }
        let expected = 5.670_374_419e-8 * 900.0_f64 * 900.0 * 900.0 * 900.0 / std::f64::consts::PI;
        assert!((sum / expected - 1.0 + 6.5e-5).abs() < 2e-6, "{sum} {expected}");
    }
}
