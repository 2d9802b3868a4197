//! The schema of phase functions.

use super::super::bounds::{Bounds, NOT_NEGATIVE};
use super::super::phase::MOST_ANGLES;
use super::super::read_coefficient::CO2_PPM;
use super::super::read_phase::{AIR_KING_FACTOR, KINDS};
use super::super::read_spectrum::{ASYMMETRY, KING_FACTOR, SHARE};
use super::parts::*;
use serde_json::{Value, json};

/// One object for each kind.
pub(super) fn all() -> Vec<Value> {
    let [isotropic, rayleigh, henyey_greenstein, cornette_shanks, double, tabulated] = KINDS;
    vec![
        Object::new("The same in all directions").kind(isotropic).build(),
        of_molecules(rayleigh),
        peaked(henyey_greenstein, "Henyey & Greenstein 1941; g is its mean cosine"),
        peaked(cornette_shanks, "Cornette & Shanks 1992; g is not its mean cosine: state either"),
        Object::new("weight · HG(g1) + (1 − weight) · HG(g2)")
            .kind(double)
            .must("g1", spectrum(ASYMMETRY, "g of the first part"))
            .must("g2", spectrum(ASYMMETRY, "g of the second part"))
            .must("weight", spectrum(SHARE, "Share of the first part"))
            .build(),
        table_of(tabulated),
    ]
}

fn of_molecules(kind: &str) -> Value {
    let by_formula = json!({ "description": "That of air (Bodhaine et al. 1999); needs `co2_ppm`",
        "const": AIR_KING_FACTOR });
    let king_factor = json!({ "description": "King factor (1 unless given)",
        "anyOf": [by_formula, spectrum(KING_FACTOR, "King factor")] });
    let formula =
        json!({ "properties": { "king_factor": { "const": AIR_KING_FACTOR } }, "required": ["king_factor"] });
    Object::new("Rayleigh's, with depolarisation by the King factor")
        .kind(kind)
        .may("king_factor", king_factor)
        .may("co2_ppm", number(CO2_PPM, "Carbon dioxide, parts per million by volume"))
        .rule(json!({ "if": formula, "then": { "required": ["co2_ppm"] },
            "else": { "properties": { "co2_ppm": false } } }))
        .build()
}

fn peaked(kind: &str, about: &str) -> Value {
    Object::new(about)
        .kind(kind)
        .one_of(&[
            ("g", spectrum(ASYMMETRY, "Parameter g of the function")),
            ("mean_cosine", spectrum(ASYMMETRY, "Mean cosine of the scattering angle")),
        ])
        .build()
}

fn table_of(kind: &str) -> Value {
    let angle = Bounds::within(0.0, 180.0, "between 0 and 180");
    let row = |about: &str| {
        let mut row = numbers(NOT_NEGATIVE, 2, about);
        row["contains"] = json!({ "exclusiveMinimum": 0 });
        row
    };
    let rows = json!({ "type": "array", "minItems": 1, "items": row("Values at one wavelength") });
    Object::new("Relative values over scattering angle, normalised when they are read")
        .kind(kind)
        .must(
            "angles_deg",
            at_most(
                MOST_ANGLES,
                numbers(angle, 2, "Scattering angles in degrees, rising from 0 (straight on) to 180"),
            ),
        )
        .may("wavelengths_nm", wavelengths())
        .must("values", json!({ "description": "A value for each angle; with wavelengths, a list for each" }))
        .rule(json!({ "if": { "required": ["wavelengths_nm"] },
            "then": { "properties": { "values": rows } },
            "else": { "properties": { "values": row("A value for each angle") } } }))
        .build()
}
