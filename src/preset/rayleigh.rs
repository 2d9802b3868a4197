//! Molecular scattering of dry air after Bodhaine, Wood, Dutton & Slusser 1999, J. Atmos. Oceanic Technol. 16, 1854.

use std::f64::consts::PI;

/// Molecules of air in a cubic metre at 288.15 K and 1013.25 hPa (Bodhaine et al. 1999, below Eq. 22).
pub const AIR_NUMBER_DENSITY: f64 = 2.546_899e25;

/// Refractivity n − 1 of dry air at 288.15 K, 1013.25 hPa: Peck & Reeder 1972 (Bodhaine Eq. 18), brought
/// from 300 ppm to another share of CO2 by Eq. 19. Wavelength in nm (230–1690), error about 1e-9.
pub fn air_refractivity(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let wavelength_um = wavelength_nm * 1e-3;
    let nu2 = 1.0 / (wavelength_um * wavelength_um);
    let at_300_ppm = (8060.51 + 2_480_990.0 / (132.274 - nu2) + 17_455.7 / (39.329_57 - nu2)) * 1e-8;
    at_300_ppm * (1.0 + 0.54 * (co2_ppm - 300.0) * 1e-6)
}

/// King factor (6 + 3δ)/(6 − 7δ) of dry air: Bates 1984, shares by volume (Bodhaine Eqs. 5, 6, 23).
pub fn air_king_factor(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let wavelength_um = wavelength_nm * 1e-3;
    let nu2 = 1.0 / (wavelength_um * wavelength_um);
    let nitrogen = 1.034 + 3.17e-4 * nu2;
    let oxygen = 1.096 + 1.385e-3 * nu2 + 1.448e-4 * nu2 * nu2;
    let co2_percent = co2_ppm * 1e-4;
    (78.084 * nitrogen + 20.946 * oxygen + 0.934 * 1.00 + co2_percent * 1.15)
        / (78.084 + 20.946 + 0.934 + co2_percent)
}

/// Scattering cross-section of a molecule of dry air, m²: 24π³(n²−1)² / (λ⁴N²(n²+2)²) · F (Bodhaine Eq. 22).
///
/// ```
/// // Bodhaine et al. 1999, Table 3: about 4.51e-27 cm² at 550 nm and 360 ppm of CO2.
/// let cross_section = tyndall::internals::preset::air_cross_section(550.0, 360.0);
/// assert!((cross_section / 4.51e-31 - 1.0).abs() < 1e-3);
/// ```
pub fn air_cross_section(wavelength_nm: f64, co2_ppm: f64) -> f64 {
    let n = 1.0 + air_refractivity(wavelength_nm, co2_ppm);
    let (above, below) = (n * n - 1.0, n * n + 2.0);
    let wavelength = wavelength_nm * 1e-9;
    let squared = wavelength * wavelength * AIR_NUMBER_DENSITY * below;
    24.0 * PI * PI * PI * above * above / (squared * squared) * air_king_factor(wavelength_nm, co2_ppm)
}
