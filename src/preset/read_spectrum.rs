//! A number, an inline table or a named spectrum in a preset → [`Spectrum`].

use super::bounds::{self, Bounds, NOT_NEGATIVE};
use super::library;
use super::names;
use super::raw::{Raw, WITHOUT_QUOTES};
use crate::error::Result;
use crate::spectrum::{RANGE, Spectrum};

/// What values a spectral quantity may take.
#[derive(Clone, Copy)]
pub(super) struct Quantity {
    /// Header of its column in spectrum files.
    pub column: &'static str,
    pub bounds: Bounds,
}

pub(super) const SHARE: Quantity = Quantity { column: "share", bounds: bounds::SHARE };
pub(super) const ASYMMETRY: Quantity =
    Quantity { column: "asymmetry", bounds: Bounds::between(-1.0, 1.0, "greater than -1 and less than 1") };
pub(super) const KING_FACTOR: Quantity = Quantity {
    column: "king_factor",
    bounds: Bounds::within(1.0, 1.5, "between 1 and 1.5 (no to strong depolarisation)"),
};
pub(super) const REFRACTIVE_INDEX: Quantity =
    Quantity { column: "refractive_index", bounds: Bounds::below(1.0, 2.0, "1 or more, below 2 (a gas)") };
pub(super) const CROSS_SECTION: Quantity = Quantity { column: "cross_section_m2", bounds: NOT_NEGATIVE };
pub(super) const IRRADIANCE: Quantity = Quantity { column: "irradiance_w_m2_nm", bounds: NOT_NEGATIVE };

/// A number (constant), a name (shipped spectrum, or `.csv` beside the preset) or
/// `{"wavelengths_nm": […], "values": […], "source": …}`.
pub(super) fn spectrum(raw: &Raw, quantity: Quantity) -> Result<Spectrum> {
    if raw.is_number() {
        return Ok(Spectrum::constant(raw.number_in(quantity.bounds)?));
    }
    if raw.is_text() {
        return named(raw, quantity);
    }
    raw.only(&["wavelengths_nm", "values"])?;
    table(raw, "values", quantity.bounds)
}

/// Lists `wavelengths_nm` and `key` of an object as a spectrum.
pub(super) fn table(raw: &Raw, key: &str, bounds: Bounds) -> Result<Spectrum> {
    let w = wavelengths(&raw.need("wavelengths_nm")?)?;
    let values = raw.need(key)?;
    let v = values.numbers_in(bounds)?;
    if w.len() != v.len() {
        return Err(values.refuse(format!("{} values for {} wavelengths", v.len(), w.len())));
    }
    Spectrum::new(w, v).map_err(|e| raw.refuse(e))
}

/// One wavelength or more, rising, nm.
pub(super) fn wavelengths(raw: &Raw) -> Result<Vec<f64>> {
    let list = raw.rising(1)?;
    if list[0] <= 0.0 {
        return Err(raw.refuse("wavelengths must be greater than 0"));
    }
    Ok(list)
}

fn named(raw: &Raw, quantity: Quantity) -> Result<Spectrum> {
    let name = raw.text()?;
    let Some(spectrum) = library::spectrum(name, quantity.column, raw.file())? else {
        if raw.is_quoted_number() {
            return Err(raw.refuse(WITHOUT_QUOTES));
        }
        let known = match names::nearest(name, library::spectrum_names()) {
            Some(near) => format!("the nearest is `{near}`"),
            None => "a path must end in .csv".into(),
        };
        return Err(raw.refuse(format!("no shipped spectrum has this name; {known}")));
    };
    let (low, high) = spectrum.range();
    if !(quantity.bounds.hold(low) && quantity.bounds.hold(high)) {
        return Err(raw.refuse(format!("its values, {low} to {high}, must be {}", quantity.bounds.text)));
    }
    Ok(spectrum)
}

/// A warning where a spectrum ends inside 380–780 nm.
pub(super) fn held(what: &str, spectrum: &Spectrum) -> Option<String> {
    let (first, last) = spectrum.held_outside(RANGE.0, RANGE.1)?;
    Some(format!("{what} is given over {first}–{last} nm only; its end values are held over 380–780 nm"))
}
