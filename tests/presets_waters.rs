//! Waters that are none, or that lack something: the defined error, or the light that physics leaves.

use serde_json::{Value, json};
use std::f64::consts::PI;
use tyndall::internals::preset::{self, Water};
use tyndall::internals::transport::slab::{Layer, Light, Slab, Streams, Surface, WaterOrders, leaving};

/// A pond with a dye in it, nothing like any sea.
fn pond() -> Value {
    json!({
        "name": "pond", "description": "test water",
        "refractive_index": 1.2, "largest_depth_m": 5, "source": "x",
        "pure_water": {
            "absorption": {"kind": "table", "wavelengths_nm": [400, 600], "per_m": [0.1, 0.3], "source": "x"},
            "scattering": {"kind": "constant", "per_m": 0.05, "source": "x"},
            "phase": {"kind": "molecular", "depolarisation": 0.1, "source": "x"}
        },
        "constituents": [
            {"name": "dye", "concentration": 2, "source": "x",
             "absorption": {"kind": "exponential", "per_m": 0.4, "at_nm": 500, "slope_per_nm": 0.01, "source": "x"}}
        ],
        "seabed": {"albedo": 0.3, "source": "x"}
    })
}

fn read(value: &Value) -> tyndall::Result<Water> {
    preset::read_water("pond.json", &value.to_string(), &[])
}

/// The pond with one value changed (by JSON pointer).
fn with(pointer: &str, value: Value) -> Value {
    let mut pond = pond();
    *pond.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = value;
    pond
}

/// Every form becomes what it means: 0.1 to 0.3 is 0.2 halfway, and twice the dye at 600 nm absorbs
/// 2 · 0.4 e^(−1).
#[test]
fn forms_become_si() {
    let medium = read(&pond()).unwrap().medium(&[500.0, 600.0]);
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    close(medium.absorption[0], 0.2 + 0.8);
    close(medium.absorption[1], 0.3 + 0.8 * libm::exp(-1.0));
    close(medium.scattering(0), 0.05);
}

/// Negative and absurd numbers, empty and disordered tables, two of one name: one line that says which and why.
#[test]
fn bad_waters_are_refused_in_one_line() {
    let dye = |key: &str| format!("/constituents/0/{key}");
    let table = |key: &str| format!("/pure_water/absorption/{key}");
    let cases = [
        ("/largest_depth_m".into(), json!(0), "largest_depth_m = 0: must be over 0"),
        ("/largest_depth_m".into(), json!(1e6), "at most 11000 m"),
        ("/refractive_index".into(), json!(0.9), "refractive_index = 0.9: must be between 1 and 2.5"),
        ("/seabed/albedo".into(), json!(-0.1), "seabed.albedo = -0.1: must be between 0 and 1"),
        (table("per_m"), json!([-0.1, 0.3]), "pure_water.absorption.per_m[0] = -0.1: must be 0 or more"),
        (table("per_m"), json!([]), "0 values for 2 wavelengths"),
        (table("wavelengths_nm"), json!([]), "wavelengths_nm = []: must have 1 or more"),
        (table("wavelengths_nm"), json!([600, 400]), "must be greater than the number before it"),
        (table("wavelengths_nm"), json!([-400, 600]), "wavelengths must be greater than 0"),
        (table("per_m"), json!([1e9, 1e9]), "coefficient of"),
        (dye("concentration"), json!(-1), "constituents[0].concentration = -1: must be 0 or more"),
        (dye("concentration"), json!(1e308), "coefficient of"),
        (dye("absorption/slope_per_nm"), json!(3), "between -0.1 and 0.1"),
        (dye("absorption/kind"), json!("exponental"), "nearest known one is `exponential`"),
        (dye("name"), json!(" "), "must not be empty"),
        (dye("name"), json!("water"), "another constituent has this name"),
        ("/pure_water/phase/depolarisation".into(), json!(0.9), "between 0 and 0.5"),
        (
            "/pure_water/phase".into(),
            json!({"kind": "tabulated", "angles_deg": [0, 90, 45, 180], "values": [1, 1, 1, 1], "source": "x"}),
            "angles_deg[2] = 45",
        ),
        ("/name".into(), json!("../pond"), "lower-case letters"),
        ("/constituents".into(), json!(null), "must be a list"),
    ];
    for (pointer, value, expected) in cases {
        let error = read(&with(&pointer, value)).expect_err(&pointer);
        let line = error.to_string();
        assert_eq!(error.exit_code(), 2);
        assert!(line.starts_with("pond.json: ") && line.contains(expected), "{pointer}: {line}");
        assert!(!line.contains('\n'), "{line}");
    }
    for key in ["pure_water", "seabed", "constituents", "refractive_index", "largest_depth_m", "name"] {
        let mut pond = pond();
        pond.as_object_mut().unwrap().shift_remove(key);
        let line = read(&pond).unwrap_err().to_string();
        assert!(line.contains(&format!("`{key}` is missing")), "{key}: {line}");
    }
}

/// Light that leaves a depth of water straight up under a sun of unit irradiance: the water's own, and the bed's.
fn light(water: &Water, depth: f64, mu_s: f64) -> [f64; 2] {
    let medium = water.medium(&[500.0]);
    let slab = Slab::new(&medium, 0, Surface { n: medium.refractive_index[0] }, Streams::TABLES);
    let sun = Light::sun(mu_s, 1.0);
    leaving(&medium, 0, &Layer::new(&slab, depth), 1.0, sun, WaterOrders::All)
}

/// The pond with only what absorbs, as much as that, under no surface.
fn absorber(per_m: f64) -> Water {
    let mut pond = with("/constituents", json!([]));
    pond["refractive_index"] = json!(1);
    pond["pure_water"] = json!({"absorption": {"kind": "constant", "per_m": per_m, "source": "x"}});
    read(&pond).unwrap()
}

/// Water that does nothing to light is a vacuum: dark itself, and the bed sends back albedo / π of what falls on it,
/// from any depth. The sun's irradiance is that of the surface.
#[test]
fn a_vacuum_shows_its_bed_alone() {
    for depth in [0.0, 0.5, 5.0] {
        let [own, bed] = light(&absorber(0.0), depth, 0.7);
        assert_eq!(own, 0.0);
        assert!((bed * PI / 0.3 - 1.0).abs() < 1e-6, "{depth} m: {bed}");
    }
}

/// Water that only absorbs is dark itself and dims the bed along the way down, d/mu_s, and up, d.
#[test]
fn an_absorber_alone_dims_its_bed() {
    for (per_m, depth, mu_s) in [(0.2, 3.0, 0.7), (1.5, 2.0, 0.4)] {
        let [own, bed] = light(&absorber(per_m), depth, mu_s);
        assert_eq!(own, 0.0);
        let expected = 0.3 / PI * libm::exp(-per_m * depth * (1.0 / mu_s + 1.0));
        assert!((bed / expected - 1.0).abs() < 1e-6, "{bed} is not {expected}");
    }
}
