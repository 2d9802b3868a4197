//! Every value of the shipped presets replaced by every nasty one: a preset is refused in one line or it is a
//! planet that can be computed with. Nothing panics and nothing infinite gets past the border.

use serde_json::{Value, json};
use tyndall::preset::{self, Planet};

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

fn sound(planet: &Planet) -> bool {
    let medium = planet.medium(&tyndall::spectrum::grid(9));
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

#[test]
fn no_value_gets_past_the_border_unchecked() {
    let nasty = [
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
    ];
    let (mut refused, mut accepted) = (0, 0);
    for (name, _) in preset::shipped() {
        let text = std::fs::read_to_string(format!("presets/planets/{name}.json")).unwrap();
        let value: Value = serde_json::from_str(&text).unwrap();
        let mut places = Vec::new();
        // Earth's presets are tried whole.
        let longest = if ["earth", "earth-paper"].contains(&name) { usize::MAX } else { 6 };
        pointers(&value, String::new(), longest, &mut places);
        for place in &places {
            for bad in &nasty {
                let mut changed = value.clone();
                *changed.pointer_mut(place).unwrap() = bad.clone();
                match preset::read("p.json", &changed.to_string(), &[]) {
                    Ok(planet) => {
                        accepted += 1;
                        assert!(sound(&planet), "{name}{place} = {bad}");
                    }
                    Err(error) => {
                        refused += 1;
                        let line = error.to_string();
                        assert_eq!(error.exit_code(), 2, "{name}{place} = {bad}: {line}");
                        assert!(!line.contains('\n') && line.len() > 10, "{name}{place} = {bad}: {line}");
                    }
                }
            }
        }
    }
    // Both happen: 1 is a fair density, an empty list of constituents a vacuum.
    assert!(refused > 500 && accepted > 50, "{refused} {accepted}");
}
