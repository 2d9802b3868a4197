//! The schema of a planet: ground, top, star, list of constituents.

use super::super::bounds::{POSITIVE, SHARE as SHARE_BOUNDS};
use super::super::read_planet::{ANGULAR_RADIUS_DEG, BLACK_BODY_K, DISTANCE_AU, NAME, SCHEMA_KEY};
use super::super::read_spectrum::{IRRADIANCE, SHARE};
use super::air;
use super::parts::*;
use serde_json::{Map, Value, json};

pub(super) fn define(defs: &mut Map<String, Value>) {
    air::define(defs);
    let ground = Object::new("The ground: a sphere that scatters evenly (Lambert)")
        .length("radius", POSITIVE, "Radius of the ground")
        .must("albedo", spectrum(SHARE, "Albedo of the ground"));
    let top =
        Object::new("The top of the air").length("height", POSITIVE, "Height of the top over the ground");
    let constituents = json!({
        "description": "Gases and particles; none is a vacuum",
        "type": "array",
        "items": { "$ref": "#/$defs/constituent" },
    });
    let planet = head("A planet")
        .must("ground", ground.build())
        .must("top", top.build())
        .must("star", star())
        .must("constituents", constituents);
    defs.insert("planet".into(), planet.build());
}

/// What every preset begins with.
pub(super) fn head(about: &str) -> Object {
    Object::new(about)
        .may(SCHEMA_KEY, json!({ "description": "Where an editor finds this schema", "type": "string" }))
        .must("name", json!({ "description": "Also the name of its folder or tables: lower-case letters, digits, dashes",
            "type": "string", "pattern": NAME }))
        .must("description", json!({ "description": "One line", "type": "string" }))
}

fn star() -> Value {
    let own_table = table(IRRADIANCE.column, IRRADIANCE.bounds, "Spectral irradiance, W/(m² nm)");
    let measured = json!({ "description": "Spectral irradiance at `spectrum_at_au`, W/(m² nm)", "anyOf": [
        number(IRRADIANCE.bounds, "The same at every wavelength, W/(m² nm)"),
        name_of_spectrum(IRRADIANCE),
        own_table,
    ] });
    Object::new("The star: its spectrum, distance and size")
        .one_of(&[
            ("black_body_k", number(BLACK_BODY_K, "Temperature of a black body, K")),
            ("spectrum", measured),
        ])
        .may("spectrum_at_au", number(POSITIVE, "Distance at which `spectrum` was measured, au"))
        .rule(json!({ "if": { "required": ["spectrum"] }, "then": { "required": ["spectrum_at_au"] },
            "else": { "properties": { "spectrum_at_au": false } } }))
        .must("distance_au", number(DISTANCE_AU, "Distance of the planet, au"))
        .one_of(&[
            (
                "angular_radius_deg",
                number(ANGULAR_RADIUS_DEG, "Angular radius seen from the planet, degrees"),
            ),
            ("radius_km", number(POSITIVE, "Radius of the star, km")),
            ("radius_m", number(POSITIVE, "Radius of the star, m")),
        ])
        .may("limb_darkening", number(SHARE_BOUNDS, "Coefficient u of 1 − u (1 − μ)"))
        .build()
}
