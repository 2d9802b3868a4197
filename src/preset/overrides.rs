//! `--set path.to.key=value`: changes to a preset's JSON before it is read.
//!
//! The path is that of the error messages: keys joined by dots, items of a list by number (`constituents[1]` or
//! `constituents.1`) or by their name (`constituents.aerosol`). The value is JSON, or a bare text where it is not;
//! `null` takes the key or item away. Sources stay honest: the object changed says that it was.

use super::names::{nearest, quoted};
use super::raw::bears_numbers;
use crate::error::{Error, Result};
use serde_json::{Map, Value};

/// Applies one assignment. Errors: no `=`, a path that leads nowhere (with the nearest key that exists).
pub(super) fn apply(root: &mut Value, file: &str, assignment: &str) -> Result<()> {
    let refuse = |reason: Error| Error::Argument(format!("--set {assignment}: {reason} ({file})"));
    let (path, text) =
        assignment.split_once('=').ok_or_else(|| refuse("needs the form path.to.key=value".into()))?;
    if text.parse::<f64>().is_ok_and(|v| !v.is_finite()) {
        return Err(refuse("not a finite number".into()));
    }
    let mut value = serde_json::from_str(text).unwrap_or_else(|_| Value::String(text.to_string()));
    add_sources(&mut value);
    let steps = steps(path);
    let (last, way) =
        steps.split_last().filter(|(l, _)| !l.is_empty()).ok_or_else(|| refuse("empty path".into()))?;
    let mut place = root;
    for step in way {
        place = descend(place, step).map_err(&refuse)?;
    }
    put(place, last, value).map_err(&refuse)
}

/// `a.b[2].c` → a, b, 2, c.
fn steps(path: &str) -> Vec<String> {
    path.trim().replace('[', ".").replace(']', "").split('.').map(str::to_string).collect()
}

fn descend<'a>(place: &'a mut Value, step: &str) -> Result<&'a mut Value> {
    match place {
        Value::Object(map) => {
            if !map.contains_key(step) {
                return Err(missing(step, map.keys().map(String::as_str)));
            }
            Ok(&mut map[step])
        }
        Value::Array(list) => {
            let k = index(list, step)?;
            Ok(&mut list[k])
        }
        _ => Err(format!("`{step}` lies below a plain value").into()),
    }
}

fn put(place: &mut Value, step: &str, value: Value) -> Result<()> {
    match place {
        Value::Object(map) => {
            set_key(map, step, value);
            Ok(())
        }
        Value::Array(list) => {
            let k = index(list, step)?;
            if value.is_null() {
                list.remove(k);
            } else {
                list[k] = value;
            }
            Ok(())
        }
        _ => Err(format!("`{step}` lies below a plain value").into()),
    }
}

fn set_key(map: &mut Map<String, Value>, key: &str, value: Value) {
    if value.is_null() {
        map.shift_remove(key);
        return;
    }
    if bears_numbers(&value) {
        let note = format!("{key} set on the command line");
        let source = match map.get("source").and_then(Value::as_str) {
            Some(old) => format!("{old}; {note}"),
            None => note,
        };
        map.insert("source".into(), Value::String(source));
    }
    map.insert(key.to_string(), value);
}

/// Objects given on the command line have the command line as their source, unless they name another.
fn add_sources(value: &mut Value) {
    match value {
        Value::Object(map) => {
            map.values_mut().for_each(add_sources);
            if map.values().any(bears_numbers) && !map.contains_key("source") {
                map.insert("source".into(), "set on the command line".into());
            }
        }
        Value::Array(list) => list.iter_mut().for_each(add_sources),
        _ => {}
    }
}

fn index(list: &[Value], step: &str) -> Result<usize> {
    if let Ok(k) = step.parse::<usize>() {
        return if k < list.len() {
            Ok(k)
        } else {
            Err(format!("item {k} of a list of {}", list.len()).into())
        };
    }
    let name = |v: &Value| v.get("name").and_then(Value::as_str).map(str::to_string);
    let names: Vec<String> = list.iter().filter_map(name).collect();
    list.iter()
        .position(|v| name(v).as_deref() == Some(step))
        .ok_or_else(|| missing(step, names.iter().map(String::as_str)))
}

fn missing<'a>(step: &str, present: impl Iterator<Item = &'a str>) -> Error {
    let present: Vec<&str> = present.collect();
    let reason = match nearest(step, present.iter().copied()) {
        _ if present.is_empty() => format!("there is no `{step}`, and nothing beside it"),
        None => format!("there is no `{step}`; there are {}", quoted(present)),
        Some(nearest) => format!("there is no `{step}`; the nearest is `{nearest}`"),
    };
    Error::Reason(reason)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn example() -> Value {
        json!({"top": {"height_km": 66, "source": "me"}, "constituents": [{"name": "air"}, {"name": "aerosol"}]})
    }

    /// Paths reach through names and numbers alike, and the changed object says what changed it.
    #[test]
    fn values_are_set_and_their_origin_noted() {
        let mut v = example();
        for a in ["constituents.aerosol.density_factor=10", "constituents[0].role=gas", "top.height_km=80"] {
            apply(&mut v, "x", a).unwrap();
        }
        assert_eq!(v["constituents"][1]["density_factor"], 10);
        assert_eq!(v["constituents"][1]["source"], "density_factor set on the command line");
        assert_eq!(v["constituents"][0], json!({"name": "air", "role": "gas"}));
        assert_eq!(v["top"]["source"], "me; height_km set on the command line");
        apply(&mut v, "x", "constituents.air=null").unwrap();
        assert_eq!(v["constituents"].as_array().unwrap().len(), 1);
        apply(&mut v, "x", r#"constituents.0.phase={"kind":"cornette_shanks","g":0.5}"#).unwrap();
        assert_eq!(v["constituents"][0]["phase"]["source"], "set on the command line");
    }

    /// A path that leads nowhere brings the key that was meant.
    #[test]
    fn wrong_paths_are_refused() {
        let refused = |a: &str| apply(&mut example(), "x", a).unwrap_err().to_string();
        assert!(refused("tops.height_km=1").contains("the nearest is `top`"));
        assert!(refused("constituents.aerosl.phase=1").contains("the nearest is `aerosol`"));
        assert!(refused("constituents[7].phase=1").contains("item 7 of a list of 2"));
        assert!(refused("top.height_km.x=1").contains("below a plain value"));
        assert!(refused("top.height_km").contains("path.to.key=value"));
        for number in ["NaN", "-inf", "1e999"] {
            assert!(refused(&format!("top.height_km={number}")).contains("not a finite number"));
        }
        assert!(refused("=3").contains("empty path"));
    }
}
