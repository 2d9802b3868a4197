//! Every value of the shipped presets replaced by every nasty one: a preset is refused in one line or it is a
//! planet that can be computed with. Nothing panics and nothing infinite gets past the border.

use rayon::prelude::*;
use serde_json::{Value, json};
use tyndall::internals::preset::{self, Planet, Water};

/// Every place in a value; of lists longer than `longest` the ends and a middle, since tables of optics have
/// hundreds of numbers alike.
fn pointers(value: &Value, at: String, longest: usize, out: &mut Vec<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(k, v)| pointers(v, format!("{at}/{k}"), longest, out)),
        Value::Array(list) => list.iter().enumerate().for_each(|(k, v)| {
            if list.len() <= longest || k < 3 || k + 2 > list.len() || k == list.len() / 2 {
                pointers(v, format!("{at}/{k}"), longest, out)
            }
        }),
        _ => {}
    }
    out.push(at);
}

/// Whether a water can be computed with, and comes back from its resolved form.
fn sound_water(water: &Water) -> bool {
    let medium = water.medium(&tyndall::internals::spectrum::grid(9));
    let finite = |v: &f64| v.is_finite() && *v >= 0.0;
    let phases = medium.scatterers.iter().flat_map(|s| &s.phase).map(|p| p.value(0.3));
    water.largest_depth > 0.0
        && medium.absorption.iter().all(finite)
        && medium.scatterers.iter().all(|s| s.scattering.iter().all(finite))
        && medium.seabed_albedo.iter().all(finite)
        && medium.refractive_index.iter().all(|n| *n >= 1.0)
        && phases.into_iter().all(|v| v.is_finite() && v >= 0.0)
        && Water::from_resolved(&water.resolved()).is_ok_and(|w| w == *water)
}

fn sound(planet: &Planet) -> bool {
    let medium = planet.medium(&tyndall::internals::spectrum::grid(9));
    let depths = medium.vertical_optical_depth();
    let finite = |v: &f64| v.is_finite() && *v >= 0.0;
    let phases = medium.constituents.iter().flat_map(|c| &c.phase).map(|p| p.value(0.3));
    medium.top_radius > medium.ground_radius
        && medium.top_radius.is_finite()
        && depths.iter().all(finite)
        && medium.ground_albedo.iter().all(finite)
        && phases.into_iter().all(|v| v.is_finite() && v >= 0.0)
        && planet.star.irradiance.at_all(&medium.wavelengths_nm).iter().all(finite)
        && Planet::from_resolved(&planet.resolved()).is_ok_and(|p| p == *planet)
}

/// Values that most places cannot take.
fn nasty() -> [Value; 17] {
    [
        json!(0),
        json!(-1),
        json!(-0.0),
        json!(1),
        json!(1e308),
        json!(5e-324),
        json!(12345678901234567890u64),
        json!("x"),
        json!(""),
        json!("../../etc/passwd.csv"),
        json!(null),
        json!(true),
        json!([]),
        json!([1, 2]),
        json!([[1], [2]]),
        json!({}),
        json!({"kind": "tabulated"}),
    ]
}

/// Puts every nasty value to every place of a preset. `read` says whether what it got is sound. Returns how many
/// were refused and accepted.
fn spoil(text: &str, longest: usize, read: impl Fn(&str) -> tyndall::Result<bool> + Sync) -> [usize; 2] {
    let value: Value = serde_json::from_str(text).unwrap();
    let mut places = Vec::new();
    pointers(&value, String::new(), longest, &mut places);
    let changes: Vec<(&String, Value)> = places.iter().flat_map(|p| nasty().map(|bad| (p, bad))).collect();
    let accepted = |(place, bad): &(&String, Value)| {
        let mut changed = value.clone();
        *changed.pointer_mut(place).unwrap() = bad.clone();
        match read(&changed.to_string()) {
            Ok(sound) => assert!(sound, "{place} = {bad}"),
            Err(error) => {
                let line = error.to_string();
                assert_eq!(error.exit_code(), 2, "{place} = {bad}: {line}");
                assert!(!line.contains('\n') && line.len() > 10, "{place} = {bad}: {line}");
                return false;
            }
        }
        true
    };
    let count = changes.par_iter().filter(|change| accepted(change)).count();
    [changes.len() - count, count]
}

#[test]
fn no_value_gets_past_the_border_unchecked() {
    let mut sums = [0, 0];
    for (name, _) in preset::shipped() {
        let text = std::fs::read_to_string(format!("presets/planets/{name}.json")).unwrap();
        // One is tried whole.
        let longest = if name == "earth-paper" { usize::MAX } else { 6 };
        let counts = spoil(&text, longest, |t| preset::read("p.json", t, &[]).map(|p| sound(&p)));
        sums = [sums[0] + counts[0], sums[1] + counts[1]];
    }
    // Both happen: 1 is a fair density, an empty list of constituents a vacuum.
    assert!(sums[0] > 500 && sums[1] > 50, "{sums:?}");
}

/// The same for waters of every kind of law.
#[test]
fn no_value_gets_into_water_unchecked() {
    let mut sums = [0, 0];
    for name in ["phytoplankton", "sandy", "jerlov-1c"] {
        let text = std::fs::read_to_string(format!("presets/waters/{name}.json")).unwrap();
        let counts = spoil(&text, 6, |t| preset::read_water("w.json", t, &[]).map(|w| sound_water(&w)));
        sums = [sums[0] + counts[0], sums[1] + counts[1]];
    }
    assert!(sums[0] > 500 && sums[1] > 50, "{sums:?}");
}
