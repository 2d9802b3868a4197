//! The schema of a water.

use super::super::bounds::{NOT_NEGATIVE, POSITIVE};
use super::super::read_spectrum::SHARE;
use super::super::read_water::*;
use super::coefficient::{self, Where};
use super::parts::*;
use super::phase;
use super::planet::head;
use serde_json::{Map, Value, json};

pub(super) fn define(defs: &mut Map<String, Value>) {
    let law = |about: &str, scatters: bool| {
        let mut all = coefficient::all(Where::Water);
        all.extend(own_laws(scatters));
        kinds(about, all)
    };
    defs.insert("water_scattering".into(), law("Scattering coefficient where the concentration is 1", true));
    defs.insert("water_absorption".into(), law("Absorption coefficient where the concentration is 1", false));
    let mut phases = phase::all();
    phases.extend(own_phases());
    defs.insert("water_phase".into(), kinds("How light that is scattered spreads over angles", phases));
    defs.insert("water_constituent".into(), constituent());
    let bed = Object::new("The bed: scatters evenly (Lambert)")
        .must("albedo", spectrum(SHARE, "Albedo of the bed"));
    let constituents = json!({ "description": "What is in the water", "type": "array",
        "items": { "$ref": "#/$defs/water_constituent" } });
    let water = head("A type of water over its bed")
        .must("refractive_index", spectrum(INDEX, "Refractive index against air"))
        .must("largest_depth_m", number(LARGEST_DEPTH_M, "Depth at which tables end, m"))
        .must(MARK, parts_of(Object::new("The water itself")))
        .must("constituents", constituents)
        .must("seabed", bed.build());
    defs.insert("water".into(), water.build());
}

fn constituent() -> Value {
    let object = Object::new("Something in the water")
        .must("name", json!({ "description": "Unlike all others'", "$ref": "#/$defs/text" }))
        .may("concentration", number(NOT_NEGATIVE, "Multiplies its coefficients (1 unless given)"));
    parts_of(object)
}

/// Absorption, scattering and phase function.
fn parts_of(object: Object) -> Value {
    let of = |name: &str| json!({ "$ref": format!("#/$defs/water_{name}") });
    object
        .may("absorption", of("absorption"))
        .may("scattering", of("scattering"))
        .may("phase", of("phase"))
        .rule(json!({ "anyOf": [{ "required": ["absorption"] }, { "required": ["scattering"] }] }))
        .rule(json!({ "dependentRequired": { "scattering": ["phase"], "phase": ["scattering"] } }))
        .build()
}

/// Laws that air has not.
fn own_laws(scatters: bool) -> Vec<Value> {
    let [.., of_spectrum, exponential, chlorophyll] = LAWS;
    let chlorophyll_key = ("chlorophyll_mg_per_m3", number(CHLOROPHYLL, "Chlorophyll a, mg/m³"));
    let plankton = match scatters {
        true => Object::new("Scattering by phytoplankton (Morel & Maritorena 2001)").kind(chlorophyll),
        false => Object::new("factor · chlorophyll^exponent (Bricaud et al. 1998)")
            .kind(chlorophyll)
            .must("factor", spectrum(PER_M, "Absorption at 1 mg/m³, 1/m"))
            .must("exponent", spectrum(EXPONENT, "Exponent of the chlorophyll")),
    };
    vec![
        Object::new("A spectrum")
            .kind(of_spectrum)
            .must("per_m", spectrum(PER_M, "Coefficient, 1/m"))
            .build(),
        Object::new("per_m · exp(−slope_per_nm · (wavelength − at_nm)): dissolved matter, detritus")
            .kind(exponential)
            .must("per_m", number(NOT_NEGATIVE, "Coefficient at `at_nm`, 1/m"))
            .must("at_nm", number(POSITIVE, "Wavelength, nm"))
            .must("slope_per_nm", number(SLOPE_PER_NM, "Slope, 1/nm"))
            .build(),
        plankton.must(chlorophyll_key.0, chlorophyll_key.1).build(),
    ]
}

/// Phase functions that air has not.
fn own_phases() -> [Value; 2] {
    [
        Object::new("Particles (Fournier & Jonasz 1999)")
            .kind(FOURNIER_FORAND)
            .must("backscatter_fraction", number(BACKSCATTER_FRACTION, "Share of light that goes backwards"))
            .build(),
        Object::new("Water molecules")
            .kind(MOLECULAR)
            .must("depolarisation", number(DEPOLARISATION, "Depolarisation ratio"))
            .build(),
    ]
}
