//! The schema of coefficients over wavelength.

use super::super::bounds::{NOT_NEGATIVE, POSITIVE};
use super::super::read_coefficient::{AMOUNTS, CO2_PPM, EXPONENT, KINDS, UNITS};
use super::super::read_spectrum::{CROSS_SECTION, KING_FACTOR, REFRACTIVE_INDEX};
use super::parts::*;
use serde_json::{Value, json};

/// What is scattered in: only air has a column from top to ground.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Where {
    Air,
    Water,
}

/// One object for each kind; in water only the first three.
pub(super) fn all(place: Where) -> Vec<Value> {
    let [constant, table, power_law, refractive_index, bodhaine1999, cross_section] = KINDS;
    let mut all = vec![
        Object::new("The same at every wavelength").kind(constant).one_of(&units(place, false)).build(),
        Object::new("A table over wavelength")
            .kind(table)
            .must("wavelengths_nm", wavelengths())
            .one_of(&units(place, true))
            .build(),
        Object::new("value · (wavelength / at_nm)^(−angstrom_exponent)")
            .kind(power_law)
            .one_of(&units(place, false))
            .must("at_nm", number(POSITIVE, "Wavelength of the value, nm"))
            .must("angstrom_exponent", number(EXPONENT, "Ångström exponent"))
            .build(),
    ];
    if place == Where::Air {
        all.extend([of_index(refractive_index), of_air(bodhaine1999), of_particles(cross_section)]);
    }
    all
}

/// The value in each of its units, as a number or a list.
fn units(place: Where, list: bool) -> [(&'static str, Value); 3] {
    let value = |about: &str| match list {
        true => numbers(NOT_NEGATIVE, 1, about),
        false => number(NOT_NEGATIVE, about),
    };
    let abouts =
        ["Coefficient, 1/m", "Coefficient, 1/km", "Vertical optical depth from the ground to the top"];
    std::array::from_fn(|k| {
        let known = place == Where::Air || UNITS[k] != "optical_depth";
        (UNITS[k], if known { value(abouts[k]) } else { json!(false) })
    })
}

fn density() -> Value {
    number(NOT_NEGATIVE, "Molecules where the density is 1, 1/m³")
}

fn of_index(kind: &str) -> Value {
    const HERE: &str = "number_density_per_m3";
    const KNOWN: &str = "reference_number_density_per_m3";
    // Without a reference the density here is the one that the index belongs to, and cannot be 0.
    let either = json!({ "anyOf": [
        { "required": [KNOWN] },
        { "properties": { (HERE): { "exclusiveMinimum": 0 } } },
    ] });
    Object::new("Scattering by molecules, from their refractive index (Elek & Kmoch 2010, Eqs. 1–2)")
        .kind(kind)
        .must("refractive_index", spectrum(REFRACTIVE_INDEX, "Refractive index of the gas"))
        .may("king_factor", spectrum(KING_FACTOR, "King factor (1 unless given)"))
        .must(HERE, density())
        .may(
            KNOWN,
            number(POSITIVE, "Number density that the index belongs to, 1/m³ (that above unless given)"),
        )
        .rule(either)
        .build()
}

fn of_air(kind: &str) -> Value {
    Object::new("Scattering by dry air (Bodhaine et al. 1999)")
        .kind(kind)
        .must("number_density_per_m3", density())
        .must("co2_ppm", number(CO2_PPM, "Carbon dioxide, parts per million by volume"))
        .build()
}

fn of_particles(kind: &str) -> Value {
    let abouts = [
        "Particles where the density is 1, 1/m³",
        "Particles over a square metre of ground, 1/m²",
        "Particles over the ground, Dobson units",
    ];
    let amounts: Vec<(&str, Value)> =
        AMOUNTS.into_iter().zip(abouts).map(|(key, about)| (key, number(NOT_NEGATIVE, about))).collect();
    Object::new("A cross-section times a number of particles")
        .kind(kind)
        .must("cross_section_m2", spectrum(CROSS_SECTION, "Cross-section of a particle, m²"))
        .one_of(&amounts)
        .build()
}
