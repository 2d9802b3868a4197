//! Slips in a preset: the message says what is wrong and not something else.

use super::run::*;
use serde_json::{Value, json};
use std::fs;

/// What `presets check` says of `earth-paper` with one value put in, at a JSON pointer whose last part may be new.
fn told(pointer: &str, value: Value) -> String {
    let mut preset: Value =
        serde_json::from_str(include_str!("../../presets/planets/earth-paper.json")).unwrap();
    let (place, key) = pointer.rsplit_once('/').unwrap();
    preset.pointer_mut(place).unwrap()[key] = value;
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("p.json");
    fs::write(&file, preset.to_string()).unwrap();
    let done = words(&format!("presets check {}", file.display()));
    assert_eq!(done.code, Some(2), "{pointer}: {}", done.out);
    done.out
}

/// A key that nobody knows is told first, whatever its value: a number under it has no source either, but that is not
/// what is wrong. A nearest key is offered only where one is near; else all that are known here are.
#[test]
fn unknown_keys_come_first() {
    for value in [json!(1), json!("x"), json!([1.0]), json!({"a": 1}), json!(null)] {
        for (pointer, reasons) in [
            (
                "/raduis_kilometres",
                ["p.json: raduis_kilometres = ", "unknown key; known are `$schema`, `name`"],
            ),
            ("/grond", ["p.json: grond = ", "unknown key; the nearest known one is `ground`"]),
            ("/ground/raduis_km", ["p.json: ground.raduis_km = ", "the nearest known one is `radius_km`"]),
            ("/star/irradiance", ["p.json: star.irradiance = ", "unknown key; known are `black_body_k`"]),
            ("/constituents/1/densty_factor", ["constituents[1].densty_factor = ", "`density_factor`"]),
            ("/constituents/0/phase/gg", ["constituents[0].phase.gg = ", "unknown key; known are "]),
            (
                "/constituents/0/scattering/colour",
                ["constituents[0].scattering.colour = ", "unknown key; known are "],
            ),
        ] {
            let text = told(pointer, value.clone());
            for reason in reasons {
                assert!(text.contains(reason), "{pointer} {value}: {text}");
            }
            assert!(!text.contains("without a source"), "{text}");
        }
    }
}

/// An unknown key is told before a source that is missing elsewhere.
#[test]
fn sources_come_last() {
    let text = told("/ground", json!({"radius_km": 6371, "albedo": 0.3}));
    assert!(text.contains("ground = ") && text.contains("without a source"), "{text}");
    let text = told("/ground", json!({"radius_km": 6371, "albedo": 0.3, "hieght": 2}));
    assert!(text.contains("ground.hieght = 2: unknown key"), "{text}");
}

/// A number in quotation marks is called that, and not an unknown spectrum.
#[test]
fn numbers_as_text_are_called_so() {
    for (pointer, value) in [
        ("/constituents/1/phase/g", "0.76"),
        ("/ground/albedo", "0,3"),
        ("/ground/radius_km", "6371"),
        ("/star/black_body_k", " 5778 "),
        ("/constituents/1/density_factor", "2"),
        ("/constituents/0/scattering/refractive_index", "1.0003"),
    ] {
        let text = told(pointer, json!(value));
        assert!(
            text.contains("must be a finite number; quotation marks make it a text"),
            "{pointer}: {text}"
        );
    }
    let text = told("/ground/albedo", json!("granite"));
    assert!(text.contains("no shipped spectrum has this name; a path must end in .csv"), "{text}");
    let text = told("/ground/albedo", json!("seabed-sent"));
    assert!(text.contains("the nearest is `seabed-sand`"), "{text}");
}

/// A key that is missing because it was mistyped brings the one that stands there.
#[test]
fn a_missing_key_brings_the_one_that_was_typed() {
    let text = told("/constituents/0/phase", json!({"knd": "rayleigh"}));
    assert!(text.contains("`kind` is missing; is `knd` meant to be it?"), "{text}");
    let text = told("/constituents/0/phase", json!({"kind": "Rayleigh"}));
    assert!(text.contains("the nearest known one is `rayleigh`, all are `isotropic`"), "{text}");
    let text = told("/constituents/0/phase", json!({"kind": "clouds"}));
    assert!(text.contains("unknown here; known are `isotropic`"), "{text}");
}

/// A byte-order mark, as Windows editors put it, is no part of a text: in presets, scenes, waters, lists, spectra and
/// points.
#[test]
fn byte_order_marks_are_read_over() {
    let dir = tempfile::tempdir().unwrap();
    let at = |name: &str, text: &str| {
        let file = dir.path().join(name);
        fs::write(&file, format!("\u{feff}{text}")).unwrap();
        file.display().to_string()
    };
    let planet = include_str!("../../presets/planets/earth-paper.json")
        .replace("\"albedo\": 0.45", "\"albedo\": \"a.csv\"");
    assert!(planet.contains("a.csv"));
    at("a.csv", "# source: me 2020\nwavelength_nm,share\n400,0.2\n700,0.4\n");
    let planet = at("p.json", &planet);
    let water = at("w.json", include_str!("../../presets/waters/muddy.json"));
    let scene = at("s.json", include_str!("../../presets/scenes/walk.json"));
    let done = words(&format!("presets check {planet} {water} {scene}"));
    assert_eq!(done.code, Some(0), "{}", done.out);
    let list = at("l.txt", "p.json\n");
    let small = SMALL.join(" ");
    let out = dir.path().join("out");
    let done = words(&format!("bake --list {list} --out {} --quiet --layout compact {small}", out.display()));
    assert_eq!(done.code, Some(0), "{}", done.err);
    let points = at("v.csv", VIEWS);
    let bake = out.join("earth-paper");
    let done = words(&format!("sample {} --points {points}", bake.display()));
    assert_eq!(done.code, Some(0), "{}", done.err);
    let spectra = at("c.csv", "wavelength_nm,a\n400,1\n700,2\n");
    assert_eq!(words(&format!("colour {spectra}")).code, Some(0));
}

/// Cosines that were rounded to single precision lie beyond 1 by a ten-millionth, and are 1; what lies further is none.
#[test]
fn rounded_cosines_are_clamped() {
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("v.csv");
    let ask = |mu: &str, mu_s: &str| {
        fs::write(&file, format!("altitude_m,mu_view,mu_sun,azimuth_deg\n2,{mu},{mu_s},0\n")).unwrap();
        words(&format!("sample {} --points {}", earth().display(), file.display()))
    };
    let answer = |done: Ran| done.out.lines().nth(1).unwrap_or("").to_string();
    let exact = answer(ask("1", "1"));
    assert!(!exact.is_empty());
    for beyond in ["1.0000001192", "1.000001"] {
        assert_eq!(answer(ask(beyond, beyond)), exact, "{beyond}");
    }
    assert_eq!(ask("-1.0000001192", "0.5").code, Some(0));
    for far in ["1.0001", "-1.00001", "2"] {
        let done = ask("0.5", far);
        assert!(done.code == Some(2) && done.err.contains("a cosine is between -1 and 1"), "{}", done.err);
    }
}
