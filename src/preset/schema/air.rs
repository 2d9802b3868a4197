//! The schema of a constituent of air, and of its density profile.

use super::super::bounds::{Bounds, NOT_NEGATIVE, POSITIVE};
use super::super::raw::MOST_METRES;
use super::super::read_constituent::ROLES;
use super::super::read_profile::KINDS;
use super::super::read_spectrum::SHARE;
use super::coefficient::{self, Where};
use super::parts::*;
use super::phase;
use crate::medium::MOST_NODES;
use serde_json::{Map, Value, json};

pub(super) fn define(defs: &mut Map<String, Value>) {
    defs.insert("profile".into(), profile());
    defs.insert(
        "coefficient".into(),
        kinds("A coefficient where the density is 1", coefficient::all(Where::Air)),
    );
    defs.insert("phase".into(), kinds("How light that is scattered spreads over angles", phase::all()));
    defs.insert("constituent".into(), constituent());
}

fn constituent() -> Value {
    let of = |name: &str, about: &str| json!({ "description": about, "$ref": format!("#/$defs/{name}") });
    let albedo = spectrum(SHARE, "Scattering over extinction");
    let either = json!({ "oneOf": [
        { "required": ["extinction", "single_scattering_albedo"],
          "properties": { "scattering": false, "absorption": false } },
        { "anyOf": [{ "required": ["scattering"] }, { "required": ["absorption"] }],
          "properties": { "extinction": false, "single_scattering_albedo": false } },
    ] });
    Object::new("A gas or a kind of particle")
        .must("name", json!({ "description": "Unlike all others'", "$ref": "#/$defs/text" }))
        .must("role", choice(&ROLES, "Which light it counts to in layouts that tell gas from aerosol"))
        .may("density_factor", number(NOT_NEGATIVE, "Multiplies all its coefficients"))
        .must("profile", of("profile", "Relative density over altitude"))
        .may("scattering", of("coefficient", "Scattering coefficient"))
        .may("absorption", of("coefficient", "Absorption coefficient"))
        .may("extinction", of("coefficient", "Scattering and absorption coefficient together"))
        .may("single_scattering_albedo", albedo)
        .may("phase", of("phase", "Needed where something is scattered"))
        .rule(either)
        .rule(json!({ "dependentRequired": { "scattering": ["phase"], "extinction": ["phase"] } }))
        .build()
}

fn profile() -> Value {
    let [exponential, tent, layer, linear, log_linear] = KINDS;
    let altitude = |object: Object, stem: &str| object.length(stem, NOT_NEGATIVE, "Altitude over the ground");
    let nodes = |kind: &str, bounds, about: &str| {
        let altitudes = |unit: &str, factor: f64| {
            let bounds = Bounds::within(0.0, MOST_METRES / factor, "0 or more");
            at_most(MOST_NODES, numbers(bounds, 2, &format!("Altitudes in {unit}, rising")))
        };
        Object::new(about)
            .kind(kind)
            .one_of(&[("altitudes_km", altitudes("km", 1e3)), ("altitudes_m", altitudes("m", 1.0))])
            .must("densities", at_most(MOST_NODES, numbers(bounds, 2, "Relative densities")))
            .build()
    };
    let exponential = Object::new("exp(−altitude / scale height)")
        .kind(exponential)
        .length("scale_height", POSITIVE, "Height over which density falls to 1/e")
        .build();
    let tent = Object::new("Rises evenly from bottom to centre, falls evenly to top").kind(tent);
    let layer = Object::new("1 between bottom and top").kind(layer);
    kinds(
        "Relative density over altitude",
        vec![
            exponential,
            altitude(altitude(altitude(tent, "bottom"), "centre"), "top").build(),
            altitude(altitude(layer, "bottom"), "top").build(),
            nodes(linear, NOT_NEGATIVE, "Straight lines between altitudes, nothing outside"),
            nodes(log_linear, POSITIVE, "Straight lines of the logarithm between altitudes, nothing outside"),
        ],
    )
}
