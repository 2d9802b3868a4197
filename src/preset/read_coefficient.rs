//! `scattering`, `absorption`, `extinction` of a constituent → [`Coefficient`].

use super::bounds::{Bounds, NOT_NEGATIVE, POSITIVE};
use super::coefficient::Coefficient;
use super::raw::Raw;
use super::read_spectrum::{CROSS_SECTION, KING_FACTOR, REFRACTIVE_INDEX, spectrum, table};
use crate::error::Result;
use crate::spectrum::Spectrum;

pub(super) const KINDS: [&str; 6] =
    ["constant", "table", "power_law", "refractive_index", "bodhaine1999", "cross_section"];

/// Units in which a coefficient may be stated; the last is the vertical optical depth of the whole shell.
pub(super) const UNITS: [&str; 3] = ["per_m", "per_km", "optical_depth"];

/// Ångström exponents; gas has 4.
pub(super) const EXPONENT: Bounds = Bounds::within(-10.0, 10.0, "between -10 and 10");
pub(super) const CO2_PPM: Bounds = Bounds::within(0.0, 1e4, "between 0 and 10000 (air)");
/// Keys of a cross-section's amount.
pub(super) const AMOUNTS: [&str; 3] = ["number_density_per_m3", "column_per_m2", "column_du"];

/// Molecules in a square metre for one Dobson unit (2.6868e20: 1e-5 m at 273.15 K and 1013.25 hPa).
const DOBSON_UNIT: f64 = 2.686_8e20;

/// The coefficient where the density is 1, 1/m; `column` is ∫ density dz of the profile in m, by which optical
/// depths and columns are divided.
pub(super) fn coefficient(raw: &Raw, column: f64) -> Result<Coefficient> {
    match raw.need("kind")?.choice(&KINDS)? {
        0 => {
            raw.only(&["kind", "per_m", "per_km", "optical_depth"])?;
            let (unit, value) = raw.one_of(&UNITS)?;
            let value = value.number_in(NOT_NEGATIVE)?;
            Ok(Coefficient::Table { spectrum_per_m: Spectrum::constant(value * factor(raw, unit, column)?) })
        }
        1 => {
            raw.only(&["kind", "wavelengths_nm", "per_m", "per_km", "optical_depth"])?;
            let (unit, _) = raw.one_of(&UNITS)?;
            let values = table(raw, UNITS[unit], NOT_NEGATIVE)?;
            Ok(Coefficient::Table { spectrum_per_m: values.scaled(factor(raw, unit, column)?) })
        }
        2 => {
            raw.only(&["kind", "per_m", "per_km", "optical_depth", "at_nm", "angstrom_exponent"])?;
            let (unit, value) = raw.one_of(&UNITS)?;
            let value = value.number_in(NOT_NEGATIVE)?;
            Ok(Coefficient::PowerLaw {
                per_m: value * factor(raw, unit, column)?,
                at_nm: raw.need("at_nm")?.number_in(POSITIVE)?,
                angstrom_exponent: raw.need("angstrom_exponent")?.number_in(EXPONENT)?,
            })
        }
        3 => refractive_index(raw),
        4 => {
            raw.only(&["kind", "number_density_per_m3", "co2_ppm"])?;
            Ok(Coefficient::Bodhaine1999 {
                number_density_per_m3: number_density(raw)?,
                co2_ppm: co2_ppm(raw)?,
            })
        }
        _ => cross_section(raw, column),
    }
}

/// `co2_ppm` of the formulas for dry air.
pub(super) fn co2_ppm(raw: &Raw) -> Result<f64> {
    raw.need("co2_ppm")?.number_in(CO2_PPM)
}

fn refractive_index(raw: &Raw) -> Result<Coefficient> {
    const REFERENCE: &str = "reference_number_density_per_m3";
    raw.only(&["kind", "refractive_index", "king_factor", "number_density_per_m3", REFERENCE])?;
    let here = number_density(raw)?;
    let reference = raw.get(REFERENCE)?.map_or(Ok(here), |r| r.number_in(POSITIVE))?;
    if reference <= 0.0 {
        return Err(raw.refuse("the number density that belongs to the refractive index must exceed 0"));
    }
    let king_factor = raw.get("king_factor")?.map(|r| spectrum(&r, KING_FACTOR)).transpose()?;
    Ok(Coefficient::RefractiveIndex {
        refractive_index: spectrum(&raw.need("refractive_index")?, REFRACTIVE_INDEX)?,
        king_factor: king_factor.unwrap_or(Spectrum::constant(1.0)),
        number_density_per_m3: here,
        reference_number_density_per_m3: reference,
    })
}

fn cross_section(raw: &Raw, column: f64) -> Result<Coefficient> {
    raw.only(&["kind", "cross_section_m2", AMOUNTS[0], AMOUNTS[1], AMOUNTS[2]])?;
    let (unit, amount) = raw.one_of(&AMOUNTS)?;
    let amount = amount.number_in(NOT_NEGATIVE)?;
    let number_density_per_m3 = match unit {
        0 => amount,
        1 => amount * per_column(raw, column)?,
        _ => amount * DOBSON_UNIT * per_column(raw, column)?,
    };
    let cross_section_m2 = spectrum(&raw.need("cross_section_m2")?, CROSS_SECTION)?;
    Ok(Coefficient::CrossSection { cross_section_m2, number_density_per_m3 })
}

fn number_density(raw: &Raw) -> Result<f64> {
    raw.need("number_density_per_m3")?.number_in(NOT_NEGATIVE)
}

/// What turns the unit into 1/m.
fn factor(raw: &Raw, unit: usize, column: f64) -> Result<f64> {
    match unit {
        0 => Ok(1.0),
        1 => Ok(1e-3),
        _ => per_column(raw, column),
    }
}

fn per_column(raw: &Raw, column: f64) -> Result<f64> {
    if column > 0.0 {
        return Ok(1.0 / column);
    }
    Err(raw.refuse("states a column, but the profile holds nothing between ground and top"))
}
