//! An item of `constituents` → [`Substance`].

use super::bounds::NOT_NEGATIVE;
use super::coefficient::Coefficient;
use super::phase::PhaseLaw;
use super::planet::{Optics, Substance};
use super::raw::Raw;
use super::read_coefficient::coefficient;
use super::read_phase::phase;
use super::read_profile::{absent, profile};
use super::read_spectrum::{SHARE, held, spectrum};
use crate::error::Result;
use crate::medium::Role;
use crate::spectrum::{Spectrum, fine_grid};

/// What a constituent can be to the layouts: [`Role::Gas`], [`Role::Aerosol`].
pub(super) const ROLES: [&str; 2] = ["gas", "aerosol"];

/// The constituent, and warnings about what its tables leave open; `height` is that of the shell, m.
pub(super) fn constituent(raw: &Raw, height: f64) -> Result<(Substance, Vec<String>)> {
    raw.only(&[
        "name",
        "role",
        "density_factor",
        "profile",
        "scattering",
        "absorption",
        "extinction",
        "single_scattering_albedo",
        "phase",
    ])?;
    let name = raw.need("name")?;
    if name.text()?.trim().is_empty() {
        return Err(name.refuse("must not be empty"));
    }
    let profile = profile(&raw.need("profile")?)?;
    let column = profile.column(0.0, height);
    let optics = optics(raw, column)?;
    let factor = raw.get("density_factor")?.map(|f| f.number_in(NOT_NEGATIVE));
    let substance = Substance {
        name: name.text()?.to_string(),
        role: [Role::Gas, Role::Aerosol][raw.need("role")?.choice(&ROLES)?],
        density_factor: factor.unwrap_or(Ok(1.0))?,
        phase: phase_of(raw)?,
        optics,
        profile,
    };
    refuse_overflow(raw, &substance, column)?;
    let warnings = warnings(&substance, height);
    Ok((substance, warnings))
}

/// Numbers can each be fine and their product be beyond all numbers.
fn refuse_overflow(raw: &Raw, substance: &Substance, column: f64) -> Result<()> {
    let fits = |v: &f64| *v >= 0.0 && v.is_finite() && (v * column).is_finite();
    if substance.coefficients(&fine_grid()).iter().flatten().all(fits) {
        return Ok(());
    }
    Err(raw.refuse("its optical depth is beyond all numbers"))
}

fn optics(raw: &Raw, column: f64) -> Result<Optics> {
    let read = |key: &str| -> Result<Option<Coefficient>> {
        raw.get(key)?.map(|r| coefficient(&r, column)).transpose()
    };
    let (scattering, absorption, extinction) =
        (read("scattering")?, read("absorption")?, read("extinction")?);
    let albedo = raw.get("single_scattering_albedo")?;
    match (scattering, absorption, extinction, albedo) {
        (None, None, Some(extinction), Some(albedo)) => Ok(Optics::ExtinctionAndAlbedo {
            extinction,
            single_scattering_albedo: spectrum(&albedo, SHARE)?,
        }),
        (None, None, Some(_), None) => Err(raw.refuse("`extinction` needs `single_scattering_albedo`")),
        (scattering, absorption, None, None) if scattering.is_some() || absorption.is_some() => {
            Ok(Optics::ScatteringAndAbsorption {
                scattering: scattering.unwrap_or(Coefficient::zero()),
                absorption: absorption.unwrap_or(Coefficient::zero()),
            })
        }
        _ => Err(raw.refuse(
            "needs `scattering` or `absorption` (or both), or else `extinction` and `single_scattering_albedo`",
        )),
    }
}

/// A phase function may be left out where no scattering is stated.
fn phase_of(raw: &Raw) -> Result<PhaseLaw> {
    match raw.get("phase")? {
        Some(given) => phase(&given),
        None if raw.get("scattering")?.is_none() && raw.get("extinction")?.is_none() => {
            Ok(PhaseLaw::Isotropic)
        }
        None => Err(raw.refuse("`phase` is missing")),
    }
}

fn warnings(c: &Substance, height: f64) -> Vec<String> {
    let named = |what: &str, spectra: Vec<&Spectrum>| -> Vec<String> {
        spectra.into_iter().filter_map(|s| held(&format!("{what} of {}", c.name), s)).collect()
    };
    let mut list: Vec<String> = absent(&c.name, &c.profile, height).into_iter().collect();
    match &c.optics {
        Optics::ScatteringAndAbsorption { scattering, absorption } => {
            list.extend(named("scattering", scattering.spectra()));
            list.extend(named("absorption", absorption.spectra()));
        }
        Optics::ExtinctionAndAlbedo { extinction, single_scattering_albedo } => {
            list.extend(named("extinction", extinction.spectra()));
            list.extend(named("single_scattering_albedo", vec![single_scattering_albedo]));
        }
    }
    list.extend(named("phase function", c.phase.spectra()));
    list
}
