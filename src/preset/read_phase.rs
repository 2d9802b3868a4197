//! `phase` of a constituent → [`PhaseLaw`].

use super::bounds::NOT_NEGATIVE;
use super::phase::{AsymmetryParameter, KingFactor, MOST_ANGLES, PhaseLaw};
use super::raw::Raw;
use super::read_coefficient::co2_ppm;
use super::read_spectrum::{ASYMMETRY, KING_FACTOR, SHARE, spectrum, wavelengths};
use crate::error::Result;
use crate::medium::PhaseFunction;
use crate::spectrum::Spectrum;

pub(super) const KINDS: [&str; 6] = [
    "isotropic",
    "rayleigh",
    "henyey_greenstein",
    "cornette_shanks",
    "double_henyey_greenstein",
    "tabulated",
];

/// The King factor of air as a formula.
pub(super) const AIR_KING_FACTOR: &str = "bodhaine1999";

/// The phase function at every wavelength.
pub(super) fn phase(raw: &Raw) -> Result<PhaseLaw> {
    match raw.need("kind")?.choice(&KINDS)? {
        0 => {
            raw.only(&["kind"])?;
            Ok(PhaseLaw::Isotropic)
        }
        1 => rayleigh(raw),
        2 => Ok(PhaseLaw::HenyeyGreenstein { g: asymmetry(raw)?.1 }),
        3 => {
            let (stated, asymmetry) = asymmetry(raw)?;
            Ok(PhaseLaw::CornetteShanks { stated, asymmetry })
        }
        4 => {
            raw.only(&["kind", "g1", "g2", "weight"])?;
            Ok(PhaseLaw::DoubleHenyeyGreenstein {
                g1: spectrum(&raw.need("g1")?, ASYMMETRY)?,
                g2: spectrum(&raw.need("g2")?, ASYMMETRY)?,
                weight: spectrum(&raw.need("weight")?, SHARE)?,
            })
        }
        _ => tabulated(raw),
    }
}

fn rayleigh(raw: &Raw) -> Result<PhaseLaw> {
    raw.only(&["kind", "king_factor", "co2_ppm"])?;
    let king_factor = match raw.get("king_factor")? {
        None => KingFactor::Table { spectrum: Spectrum::constant(1.0) },
        Some(law) if law.is_text() && law.text()? == AIR_KING_FACTOR => {
            return Ok(PhaseLaw::Rayleigh {
                king_factor: KingFactor::Bodhaine1999 { co2_ppm: co2_ppm(raw)? },
            });
        }
        Some(law) => KingFactor::Table { spectrum: spectrum(&law, KING_FACTOR)? },
    };
    if let Some(unused) = raw.get("co2_ppm")? {
        return Err(unused.refuse("belongs to `king_factor`: \"bodhaine1999\", which is not given"));
    }
    Ok(PhaseLaw::Rayleigh { king_factor })
}

fn asymmetry(raw: &Raw) -> Result<(AsymmetryParameter, Spectrum)> {
    raw.only(&["kind", "g", "mean_cosine"])?;
    let (which, value) = raw.one_of(&["g", "mean_cosine"])?;
    Ok(([AsymmetryParameter::G, AsymmetryParameter::MeanCosine][which], spectrum(&value, ASYMMETRY)?))
}

/// Relative values over scattering angles (0° straight on … 180°): one list, or one a wavelength.
fn tabulated(raw: &Raw) -> Result<PhaseLaw> {
    raw.only(&["kind", "angles_deg", "wavelengths_nm", "values"])?;
    let angles_key = raw.need("angles_deg")?;
    let angles = angles_key.rising(2)?;
    if angles.len() > MOST_ANGLES {
        return Err(angles_key.refuse(format!("{} angles: {MOST_ANGLES} are the most", angles.len())));
    }
    if angles[0] != 0.0 || angles[angles.len() - 1] != 180.0 {
        return Err(angles_key.refuse("must go from 0 to 180"));
    }
    // Cosines rise where angles fall; cos 0 and cos 180° are set, not rounded.
    let mut cosines: Vec<f64> = angles.iter().rev().map(|a| libm::cos(a.to_radians())).collect();
    let last = cosines.len() - 1;
    (cosines[0], cosines[last]) = (-1.0, 1.0);
    if cosines.windows(2).any(|c| c[1] <= c[0]) {
        return Err(angles_key.refuse("angles so close that their cosines are equal"));
    }
    let values = raw.need("values")?;
    let (wavelengths_nm, rows) = match raw.get("wavelengths_nm")? {
        None => (vec![550.0], vec![row(&values, &cosines)?]),
        Some(w) => {
            let rows = values.items()?.iter().map(|r| row(r, &cosines)).collect::<Result<Vec<_>>>()?;
            (wavelengths(&w)?, rows)
        }
    };
    if rows.len() != wavelengths_nm.len() {
        return Err(values.refuse(format!("{} rows for {} wavelengths", rows.len(), wavelengths_nm.len())));
    }
    Ok(PhaseLaw::Tabulated { cosines, wavelengths_nm, rows })
}

/// One row, brought to the order of the cosines and normalised.
fn row(raw: &Raw, cosines: &[f64]) -> Result<Vec<f64>> {
    let mut values = raw.numbers_in(NOT_NEGATIVE)?;
    if values.len() != cosines.len() {
        return Err(raw.refuse(format!("{} values for {} angles", values.len(), cosines.len())));
    }
    if values.iter().all(|&v| v == 0.0) {
        return Err(raw.refuse("scatters nowhere: every value is 0"));
    }
    values.reverse();
    match PhaseFunction::tabulated(cosines.iter().copied().zip(values).collect()) {
        PhaseFunction::Tabulated { nodes } => Ok(nodes.iter().map(|n| n.1).collect()),
        _ => unreachable!("tabulated makes a table"),
    }
}
