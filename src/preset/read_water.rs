//! A preset of water: index, pure water, constituents, bed → [`Water`].

use super::Coefficient;
use super::bounds::{Bounds, NOT_NEGATIVE, POSITIVE};
use super::fournier_forand::{BACKSCATTER, fournier_forand};
use super::phase::{KingFactor, PhaseLaw};
use super::raw::Raw;
use super::read_coefficient::coefficient;
use super::read_phase::{KINDS, phase};
use super::read_planet::{SCHEMA_KEY, name, schema_key};
use super::read_spectrum::{Quantity, SHARE, held, spectrum};
use super::water::{Water, WaterLaw, WaterSubstance};
use crate::error::Result;
use crate::spectrum::Spectrum;

pub(super) const INDEX: Quantity =
    Quantity { column: "refractive_index", bounds: Bounds::within(1.0, 2.5, "between 1 and 2.5") };
pub(super) const PER_M: Quantity = Quantity { column: "per_m", bounds: NOT_NEGATIVE };
pub(super) const EXPONENT: Quantity =
    Quantity { column: "exponent", bounds: Bounds::within(0.0, 2.0, "between 0 and 2") };
pub(super) const LARGEST_DEPTH_M: Bounds = Bounds::up_to(0.0, 11_000.0, "over 0 and at most 11000 m");
pub(super) const SLOPE_PER_NM: Bounds = Bounds::within(-0.1, 0.1, "between -0.1 and 0.1");
pub(super) const CHLOROPHYLL: Bounds = Bounds::up_to(0.0, 1000.0, "over 0 and at most 1000 mg/m3");
pub(super) const BACKSCATTER_FRACTION: Bounds =
    Bounds::within(BACKSCATTER.0, BACKSCATTER.1, "between 0.001 and 0.05");
pub(super) const DEPOLARISATION: Bounds = Bounds::within(0.0, 0.5, "between 0 and 0.5");

/// Keys that tell a water from a planet.
pub(super) const MARK: &str = "pure_water";

/// The whole water.
pub(super) fn water(raw: &Raw) -> Result<Water> {
    raw.only(&[
        SCHEMA_KEY,
        "name",
        "description",
        "refractive_index",
        "largest_depth_m",
        MARK,
        "constituents",
        "seabed",
    ])?;
    schema_key(raw)?;
    let refractive_index = spectrum(&raw.need("refractive_index")?, INDEX)?;
    let bed = raw.need("seabed")?;
    bed.only(&["albedo"])?;
    let seabed_albedo = spectrum(&bed.need("albedo")?, SHARE)?;
    let mut warnings: Vec<String> = held("refractive index", &refractive_index).into_iter().collect();
    warnings.extend(held("seabed albedo", &seabed_albedo));
    let mut substances = vec![substance(&raw.need(MARK)?, Some("water"), &mut warnings)?];
    for item in raw.need("constituents")?.items()? {
        let one = substance(&item, None, &mut warnings)?;
        if substances.iter().any(|s| s.name == one.name) {
            return Err(item.need("name")?.refuse("another constituent has this name"));
        }
        substances.push(one);
    }
    let depth = raw.need("largest_depth_m")?;
    let water = Water {
        name: name(raw)?,
        description: raw.need("description")?.text()?.to_string(),
        refractive_index,
        largest_depth: depth.number_in(LARGEST_DEPTH_M)?,
        substances,
        seabed_albedo,
        warnings,
    };
    match water.check() {
        Ok(()) => Ok(water),
        Err(reason) => Err(raw.need("constituents")?.refuse(reason)),
    }
}

fn substance(raw: &Raw, called: Option<&str>, warnings: &mut Vec<String>) -> Result<WaterSubstance> {
    let name = match called {
        Some(name) => {
            raw.only(&["absorption", "scattering", "phase"])?;
            name.to_string()
        }
        None => {
            raw.only(&["name", "concentration", "absorption", "scattering", "phase"])?;
            let name = raw.need("name")?;
            if name.text()?.trim().is_empty() {
                return Err(name.refuse("must not be empty"));
            }
            name.text()?.to_string()
        }
    };
    let concentration = raw.get("concentration")?.map_or(Ok(1.0), |c| c.number_in(NOT_NEGATIVE))?;
    let (scattering, absorption) = (raw.get("scattering")?, raw.get("absorption")?);
    if scattering.is_none() && absorption.is_none() {
        return Err(raw.refuse("one of `scattering`, `absorption` is missing"));
    }
    let phase = match (&scattering, raw.get("phase")?) {
        (Some(_), Some(p)) => water_phase(&p)?,
        (Some(_), None) => return Err(raw.refuse("`phase` is missing, but it scatters")),
        (None, Some(p)) => return Err(p.refuse("has no use without `scattering`")),
        (None, None) => PhaseLaw::Isotropic,
    };
    let mut read = |part: Option<Raw>, scatters: bool| -> Result<WaterLaw> {
        let Some(part) = part else { return Ok(WaterLaw::zero()) };
        let law = law(&part, concentration, scatters)?;
        if let WaterLaw::Plain { coefficient, .. } = &law {
            let what = if scatters { "scattering" } else { "absorption" };
            let held = coefficient.spectra().into_iter().find_map(|s| held(&format!("{name}: {what}"), s));
            warnings.extend(held);
        }
        Ok(law)
    };
    let (scattering, absorption) = (read(scattering, true)?, read(absorption, false)?);
    Ok(WaterSubstance { name, scattering, absorption, phase })
}

/// Kinds of coefficients: three of air's, three of water's own.
pub(super) const LAWS: [&str; 6] =
    ["constant", "table", "power_law", "spectrum", "exponential", "chlorophyll"];
/// Kinds of phase functions that air has not.
pub(super) const FOURNIER_FORAND: &str = "fournier_forand";
pub(super) const MOLECULAR: &str = "molecular";

fn law(raw: &Raw, factor: f64, scatters: bool) -> Result<WaterLaw> {
    let plain = |coefficient| WaterLaw::Plain { coefficient, factor };
    let table = |spectrum_per_m| plain(Coefficient::Table { spectrum_per_m });
    match raw.need("kind")?.choice(&LAWS)? {
        // A column is no property of water: 0 makes the reader of air's coefficients refuse one.
        0..=2 => Ok(plain(coefficient(raw, 0.0)?)),
        3 => {
            raw.only(&["kind", "per_m"])?;
            Ok(table(spectrum(&raw.need("per_m")?, PER_M)?))
        }
        4 => {
            raw.only(&["kind", "per_m", "at_nm", "slope_per_nm"])?;
            let slope = raw.need("slope_per_nm")?;
            Ok(WaterLaw::Exponential {
                per_m: factor * raw.need("per_m")?.number_in(NOT_NEGATIVE)?,
                at_nm: raw.need("at_nm")?.number_in(POSITIVE)?,
                slope_per_nm: slope.number_in(SLOPE_PER_NM)?,
            })
        }
        _ if scatters => {
            raw.only(&["kind", "chlorophyll_mg_per_m3"])?;
            Ok(plain(plankton_scattering(chlorophyll(raw)?)))
        }
        _ => {
            raw.only(&["kind", "chlorophyll_mg_per_m3", "factor", "exponent"])?;
            let (a, e) = (raw.need("factor")?, raw.need("exponent")?);
            let (a, e) = (spectrum(&a, PER_M)?, spectrum(&e, EXPONENT)?);
            let chlorophyll = chlorophyll(raw)?;
            let at = |nm: f64| a.at(nm) * libm::pow(chlorophyll, e.at(nm));
            if a.is_constant() {
                return Ok(table(Spectrum::constant(at(550.0))));
            }
            let nodes: Vec<f64> = a.nodes().map(|n| n.0).collect();
            Ok(table(Spectrum::sampled(nodes, at).map_err(|e| raw.refuse(e))?))
        }
    }
}

fn chlorophyll(raw: &Raw) -> Result<f64> {
    let raw = raw.need("chlorophyll_mg_per_m3")?;
    raw.number_in(CHLOROPHYLL)
}

/// Morel & Maritorena 2001, Eqs. 12 to 14: 0.416 Chl^0.766 at 550 nm, and λ^v with v = (log₁₀ Chl − 0.3)/2 up to
/// 2 mg/m³ and 0 above.
fn plankton_scattering(chlorophyll: f64) -> Coefficient {
    let v = 0.5 * (libm::log10(chlorophyll) - 0.3);
    Coefficient::PowerLaw {
        per_m: 0.416 * libm::pow(chlorophyll, 0.766),
        at_nm: 550.0,
        angstrom_exponent: if chlorophyll < 2.0 { -v } else { 0.0 },
    }
}

/// Phase functions of air's particles, and two of water's own.
fn water_phase(raw: &Raw) -> Result<PhaseLaw> {
    let kinds: Vec<&str> = KINDS.iter().copied().chain([FOURNIER_FORAND, MOLECULAR]).collect();
    match kinds[raw.need("kind")?.choice(&kinds)?] {
        FOURNIER_FORAND => {
            raw.only(&["kind", "backscatter_fraction"])?;
            let fraction = raw.need("backscatter_fraction")?;
            Ok(fournier_forand(fraction.number_in(BACKSCATTER_FRACTION)?))
        }
        MOLECULAR => {
            raw.only(&["kind", "depolarisation"])?;
            let depolarisation = raw.need("depolarisation")?;
            let d = depolarisation.number_in(DEPOLARISATION)?;
            let king_factor = KingFactor::Table {
                // The King factor of a depolarisation ratio (Bates 1984).
                spectrum: Spectrum::constant((6.0 + 3.0 * d) / (6.0 - 7.0 * d)),
            };
            Ok(PhaseLaw::Rayleigh { king_factor })
        }
        _ => phase(raw),
    }
}
