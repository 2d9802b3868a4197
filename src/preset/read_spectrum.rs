//! A number, an inline table or a named spectrum in a preset → [`Spectrum`].

use super::library;
use super::raw::{Raw, nearest};
use crate::error::Result;
use crate::spectrum::{RANGE, Spectrum};

/// What values a spectral quantity may take.
#[derive(Clone, Copy)]
pub struct Quantity {
    /// Header of its column in spectrum files.
    pub column: &'static str,
    /// "must be …".
    pub bounds: &'static str,
    pub holds: fn(f64) -> bool,
}

pub const SHARE: Quantity =
    Quantity { column: "share", bounds: "between 0 and 1", holds: |v| (0.0..=1.0).contains(&v) };
pub const ASYMMETRY: Quantity =
    Quantity { column: "asymmetry", bounds: "greater than -1 and less than 1", holds: |v| v.abs() < 1.0 };
pub const KING_FACTOR: Quantity = Quantity {
    column: "king_factor",
    bounds: "between 1 and 1.5 (no to strong depolarisation)",
    holds: |v| (1.0..=1.5).contains(&v),
};
pub const REFRACTIVE_INDEX: Quantity = Quantity {
    column: "refractive_index",
    bounds: "1 or more, below 2 (a gas)",
    holds: |v| (1.0..2.0).contains(&v),
};
pub const CROSS_SECTION: Quantity =
    Quantity { column: "cross_section_m2", bounds: "0 or more", holds: |v| v >= 0.0 };
pub const IRRADIANCE: Quantity =
    Quantity { column: "irradiance_w_m2_nm", bounds: "0 or more", holds: |v| v >= 0.0 };

/// A number (constant), a name (shipped spectrum, or `.csv` beside the preset) or
/// `{"wavelengths_nm": […], "values": […], "source": …}`.
pub fn spectrum(raw: &Raw, quantity: Quantity) -> Result<Spectrum> {
    if raw.is_number() {
        return Ok(Spectrum::constant(raw.number_that(quantity.bounds, quantity.holds)?));
    }
    if raw.is_text() {
        return named(raw, quantity);
    }
    raw.only(&["wavelengths_nm", "values"])?;
    table(raw, "values", quantity.bounds, quantity.holds)
}

/// Lists `wavelengths_nm` and `key` of an object as a spectrum.
pub fn table(raw: &Raw, key: &str, bounds: &str, holds: impl Fn(f64) -> bool) -> Result<Spectrum> {
    let wavelengths = raw.need("wavelengths_nm")?;
    let values = raw.need(key)?;
    let (w, v) = (wavelengths.rising(1)?, values.numbers_that(bounds, holds)?);
    if w[0] <= 0.0 {
        return Err(wavelengths.refuse("wavelengths must be greater than 0"));
    }
    if w.len() != v.len() {
        return Err(values.refuse(format!("{} values for {} wavelengths", v.len(), w.len())));
    }
    Spectrum::new(w, v).map_err(|e| raw.refuse(e))
}

fn named(raw: &Raw, quantity: Quantity) -> Result<Spectrum> {
    let name = raw.text()?;
    let Some(spectrum) = library::spectrum(name, quantity.column, raw.file())? else {
        let near = nearest(name, library::spectrum_names());
        return Err(raw.refuse(format!("no shipped spectrum has this name; the nearest is `{near}`")));
    };
    let (low, high) = spectrum.range();
    if !((quantity.holds)(low) && (quantity.holds)(high)) {
        return Err(raw.refuse(format!("its values, {low} to {high}, must be {}", quantity.bounds)));
    }
    Ok(spectrum)
}

/// A warning where a spectrum ends inside 380–780 nm.
pub fn held(what: &str, spectrum: &Spectrum) -> Option<String> {
    let (first, last) = spectrum.held_outside(RANGE.0, RANGE.1)?;
    Some(format!("{what} is given over {first}–{last} nm only; its end values are held over 380–780 nm"))
}
