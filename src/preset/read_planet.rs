//! The top level of a preset: name, ground, top, star, constituents → [`Planet`].

use super::bounds::{Bounds, POSITIVE};
use super::lost::lost;
use super::planet::{Planet, Star};
use super::raw::Raw;
use super::read_constituent::constituent;
use super::read_spectrum::{IRRADIANCE, SHARE, held, spectrum, table};
use crate::error::Result;
use crate::medium::check_shell;
use crate::spectrum::{OBSERVER_RANGE, Spectrum, fine_grid, grid, planck_law};
use std::f64::consts::PI;

/// Astronomical unit, m (IAU 2012 Resolution B2, exact).
const ASTRONOMICAL_UNIT: f64 = 149_597_870_700.0;

pub(super) const DISTANCE_AU: Bounds = Bounds::up_to(0.0, 1e6, "greater than 0, and 1e6 at the most");
pub(super) const ANGULAR_RADIUS_DEG: Bounds = Bounds::between(0.0, 90.0, "greater than 0 and less than 90");
pub(super) const BLACK_BODY_K: Bounds = Bounds::within(100.0, 1e6, "between 100 and 1000000");
/// Letters of a name at most, as in [`NAME`].
const MOST_NAME: usize = 100;
/// What the name of a planet or water may consist of, as a regular expression.
pub(super) const NAME: &str = "^[a-z0-9-]{1,100}$";

/// The whole planet.
pub(super) fn planet(raw: &Raw) -> Result<Planet> {
    raw.only(&[SCHEMA_KEY, "name", "description", "ground", "top", "star", "constituents"])?;
    schema_key(raw)?;
    let ground = raw.need("ground")?;
    ground.only(&["radius_km", "radius_m", "albedo"])?;
    let ground_radius = ground.length("radius", POSITIVE)?;
    let ground_albedo = spectrum(&ground.need("albedo")?, SHARE)?;
    let top = raw.need("top")?;
    top.only(&["height_km", "height_m"])?;
    let height = top.length("height", POSITIVE)?;
    if ground_radius + height <= ground_radius {
        return Err(top.refuse("the shell is too thin for its radius to be told from the ground's"));
    }
    check_shell(ground_radius, ground_radius + height).map_err(|reason| top.refuse(reason))?;
    let star_raw = raw.need("star")?;
    let star = star(&star_raw)?;
    let lit = fine_grid().iter().map(|&w| star.irradiance.at(w)).sum::<f64>();
    if !(lit > 0.0 && lit.is_finite()) {
        return Err(star_raw.refuse("its light between 380 and 780 nm is nothing or beyond all numbers"));
    }

    let mut warnings: Vec<String> = held("ground albedo", &ground_albedo).into_iter().collect();
    warnings.extend(held("spectrum of the star", &star.irradiance));
    let mut constituents = Vec::new();
    let items = raw.need("constituents")?.items()?;
    for item in &items {
        let (substance, about) = constituent(item, height)?;
        if constituents.iter().any(|c: &super::Substance| c.name == substance.name) {
            return Err(item.need("name")?.refuse("another constituent has this name"));
        }
        warnings.extend(about);
        constituents.push(substance);
    }
    let mut planet = Planet {
        name: name(raw)?,
        description: raw.need("description")?.text()?.to_string(),
        ground_radius,
        top_radius: ground_radius + height,
        ground_albedo,
        star,
        constituents,
        warnings,
    };
    // What formulas make of numbers that are good each by itself.
    let medium = planet.medium(&grid(9));
    if let Err(reason) = medium.check() {
        return Err(raw.need("constituents")?.refuse(reason));
    }
    planet.warnings.extend(lost(&medium, &top, &items)?);
    Ok(planet)
}

/// The key by which an editor finds the schema of a file; it means nothing to the preset.
pub(super) const SCHEMA_KEY: &str = "$schema";

pub(super) fn schema_key(raw: &Raw) -> Result<()> {
    raw.get(SCHEMA_KEY)?.map_or(Ok(()), |key| key.text().map(drop))
}

/// The name becomes a folder's, so only letters that every file system and shell takes are let in.
pub(super) fn name(raw: &Raw) -> Result<String> {
    let raw = raw.need("name")?;
    let text = raw.text()?;
    check_name(text).map_err(|reason| raw.refuse(reason))?;
    Ok(text.to_string())
}

/// Whether a text can be a name; the reason why not.
pub(super) fn check_name(text: &str) -> Result<()> {
    let good = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if text.is_empty() || !text.chars().all(good) {
        return Err("must consist of lower-case letters, digits and dashes".into());
    }
    // A folder's name may have 255 bytes, and a bake adds some of its own while it is written.
    if text.len() > MOST_NAME {
        return Err(format!("must have {MOST_NAME} letters at most").into());
    }
    Ok(())
}

fn star(raw: &Raw) -> Result<Star> {
    raw.only(&[
        "black_body_k",
        "spectrum",
        "spectrum_at_au",
        "distance_au",
        "radius_km",
        "radius_m",
        "angular_radius_deg",
        "limb_darkening",
    ])?;
    let distance = raw.need("distance_au")?.number_in(DISTANCE_AU)? * ASTRONOMICAL_UNIT;
    let angular_radius = angular_radius(raw, distance)?;
    let limb_darkening = raw.get("limb_darkening")?;
    Ok(Star {
        irradiance: irradiance(raw, distance, angular_radius)?,
        angular_radius,
        distance,
        limb_darkening: limb_darkening.map_or(Ok(0.0), |l| l.number_in(SHARE.bounds))?,
    })
}

fn angular_radius(raw: &Raw, distance: f64) -> Result<f64> {
    let (which, given) = raw.one_of(&["angular_radius_deg", "radius_km", "radius_m"])?;
    if which == 0 {
        return Ok(given.number_in(ANGULAR_RADIUS_DEG)?.to_radians());
    }
    let radius = given.number_in(POSITIVE)? * [1e3, 1.0][which - 1];
    if radius >= distance {
        return Err(given.refuse("the star would reach its planet"));
    }
    Ok(libm::asin(radius / distance))
}

/// Irradiance at the planet, W/(m² nm). A black body's is π B sin² α, tabulated at 1 nm; a measured spectrum is
/// brought from the distance it was measured at.
fn irradiance(raw: &Raw, distance: f64, angular_radius: f64) -> Result<Spectrum> {
    let (which, given) = raw.one_of(&["black_body_k", "spectrum"])?;
    let measured_at = raw.get("spectrum_at_au")?;
    if which == 0 {
        if let Some(unused) = measured_at {
            return Err(unused.refuse("belongs to `spectrum`, but the star is a black body"));
        }
        let temperature = given.number_in(BLACK_BODY_K)?;
        let sine = libm::sin(angular_radius);
        let grid = (OBSERVER_RANGE.0..=OBSERVER_RANGE.1).map(|w| w as f64).collect();
        let per_nm = PI * sine * sine * 1e-9;
        return Spectrum::sampled(grid, |w| per_nm * planck_law(w, temperature)).map_err(|e| given.refuse(e));
    }
    let spectrum = if given.is_text() || given.is_number() {
        spectrum(&given, IRRADIANCE)?
    } else {
        given.only(&["wavelengths_nm", IRRADIANCE.column])?;
        table(&given, IRRADIANCE.column, IRRADIANCE.bounds)?
    };
    let measured_at = raw.need("spectrum_at_au")?.number_in(POSITIVE)?;
    let ratio = measured_at * ASTRONOMICAL_UNIT / distance;
    Ok(spectrum.scaled(ratio * ratio))
}
