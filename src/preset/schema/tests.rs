//! Reader and schema know the same keys; `scripts/validate-schema` holds both against files, good and bad.

use super::*;
use crate::preset;
use record::Keys;
use std::collections::BTreeSet;

/// Known keys of every object in a schema, but for `source`, which all have.
fn keys(schema: &Value, out: &mut BTreeSet<Keys>) {
    match schema {
        Value::Object(map) => {
            if map.get("additionalProperties") == Some(&json!(false)) {
                let known = map["properties"].as_object().unwrap().keys();
                out.insert(known.filter(|k| *k != "source").cloned().collect());
            }
            map.values().for_each(|v| keys(v, out));
        }
        Value::Array(list) => list.iter().for_each(|v| keys(v, out)),
        _ => {}
    }
}

fn constituent(name: &str, profile: Value, scattering: Value, phase: Value) -> Value {
    let with_source = |mut v: Value| {
        v["source"] = json!("x");
        v
    };
    json!({ "name": name, "role": "gas", "profile": with_source(profile), "scattering": with_source(scattering),
        "phase": with_source(phase) })
}

/// A planet with every kind of profile, coefficient and phase function.
fn planet_of_everything() -> String {
    let table = json!({ "wavelengths_nm": [400, 700], "values": [1.0, 1.1], "source": "x" });
    let exponential = json!({ "kind": "exponential", "scale_height_km": 8 });
    let constant = json!({ "kind": "constant", "per_m": 1e-6 });
    let isotropic = json!({ "kind": "isotropic" });
    let nodes = |kind: &str| json!({ "kind": kind, "altitudes_km": [0, 9], "densities": [1, 0.5] });
    let profiles = [
        exponential.clone(),
        json!({ "kind": "tent", "bottom_km": 1, "centre_km": 2, "top_km": 3 }),
        json!({ "kind": "layer", "bottom_m": 0, "top_m": 900 }),
        nodes("linear"),
        nodes("log_linear"),
    ];
    let coefficients = [
        constant.clone(),
        json!({ "kind": "table", "wavelengths_nm": [400, 700], "per_km": [1e-3, 2e-3] }),
        json!({ "kind": "power_law", "optical_depth": 0.1, "at_nm": 550, "angstrom_exponent": 1 }),
        json!({ "kind": "refractive_index", "refractive_index": 1.0003, "king_factor": table,
            "number_density_per_m3": 2e25 }),
        json!({ "kind": "bodhaine1999", "number_density_per_m3": 2e25, "co2_ppm": 400 }),
        json!({ "kind": "cross_section", "cross_section_m2": 1e-30, "column_du": 300 }),
    ];
    let phases = [
        isotropic.clone(),
        json!({ "kind": "rayleigh", "king_factor": "bodhaine1999", "co2_ppm": 400 }),
        json!({ "kind": "henyey_greenstein", "g": 0.5 }),
        json!({ "kind": "cornette_shanks", "mean_cosine": 0.5 }),
        json!({ "kind": "double_henyey_greenstein", "g1": 0.5, "g2": -0.5, "weight": 0.5 }),
        json!({ "kind": "tabulated", "angles_deg": [0, 180], "values": [1, 2] }),
    ];
    let mut all = Vec::new();
    for (k, p) in profiles.into_iter().enumerate() {
        all.push(constituent(&format!("p{k}"), p, constant.clone(), isotropic.clone()));
    }
    for (k, c) in coefficients.into_iter().enumerate() {
        all.push(constituent(&format!("c{k}"), exponential.clone(), c, isotropic.clone()));
    }
    for (k, f) in phases.into_iter().enumerate() {
        all.push(constituent(&format!("f{k}"), exponential.clone(), constant.clone(), f));
    }
    let light = json!({ "wavelengths_nm": [400, 700], "irradiance_w_m2_nm": [1, 2], "source": "x" });
    json!({
        "$schema": "planet.schema.json",
        "name": "everything", "description": "every kind there is",
        "ground": { "radius_km": 1200, "albedo": 0.2, "source": "x" },
        "top": { "height_km": 60, "source": "x" },
        "star": { "spectrum": light, "spectrum_at_au": 1, "distance_au": 2, "angular_radius_deg": 0.1, "source": "x" },
        "constituents": all,
    })
    .to_string()
}

/// A water with every kind of coefficient and phase function.
const WATER_OF_EVERYTHING: &str = r#"{
    "$schema": "water.schema.json", "name": "soup", "description": "every kind there is",
    "refractive_index": 1.34, "largest_depth_m": 20, "source": "x", "seabed": { "albedo": 0.1, "source": "x" },
    "pure_water": { "absorption": { "kind": "constant", "per_m": 0.1, "source": "x" } },
    "constituents": [
        { "name": "a",
          "absorption": { "kind": "exponential", "per_m": 0.1, "at_nm": 440, "slope_per_nm": 0.014, "source": "x" } },
        { "name": "b",
          "absorption": { "kind": "chlorophyll", "chlorophyll_mg_per_m3": 1, "factor": 0.05, "exponent": 0.6, "source": "x" },
          "scattering": { "kind": "chlorophyll", "chlorophyll_mg_per_m3": 1, "source": "x" },
          "phase": { "kind": "fournier_forand", "backscatter_fraction": 0.01, "source": "x" } },
        { "name": "c", "concentration": 2, "source": "x",
          "scattering": { "kind": "spectrum", "per_m": 0.1, "source": "x" },
          "phase": { "kind": "molecular", "depolarisation": 0.04, "source": "x" } }
    ] }"#;

/// Every list of keys that the reader lets through is one of the schema's, and the other way round: a key added to
/// one alone is found here.
#[test]
fn reader_and_schema_know_the_same_keys() {
    preset::read("p.json", &planet_of_everything(), &[]).unwrap();
    preset::read_water("w.json", WATER_OF_EVERYTHING, &[]).unwrap();
    preset::shipped_names().for_each(|name| drop(preset::load(name, &[]).unwrap()));
    preset::shipped_water_names().for_each(|name| drop(preset::load_water(name, &[]).unwrap()));
    let mut stated = BTreeSet::new();
    keys(&schema(None), &mut stated);
    let read = record::taken();
    let missing: Vec<&Keys> = read.difference(&stated).collect();
    let unread: Vec<&Keys> = stated.difference(&read).collect();
    assert!(
        missing.is_empty() && unread.is_empty(),
        "only read: {missing:?}\nonly in the schema: {unread:?}"
    );
    assert!(read.len() > 20, "{read:?}");
}

/// Each schema stands alone: what it refers to is in it.
#[test]
fn references_lead_somewhere() {
    fn references(value: &Value, out: &mut Vec<String>) {
        match value {
            Value::Object(map) => map.iter().for_each(|(k, v)| match v {
                Value::String(to) if k == "$ref" => out.push(to.clone()),
                other => references(other, out),
            }),
            Value::Array(list) => list.iter().for_each(|v| references(v, out)),
            _ => {}
        }
    }
    for kind in [None, Some(Kind::Planet), Some(Kind::Water)] {
        let schema = schema(kind);
        let mut all = Vec::new();
        references(&schema, &mut all);
        assert!(all.len() > 10);
        for to in all {
            let found = schema.pointer(to.strip_prefix('#').unwrap());
            assert!(found.is_some(), "{kind:?}: {to}");
        }
    }
}
