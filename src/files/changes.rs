//! What differs between two JSON values, a line a place.

use serde::Serialize;
use serde_json::{Map, Value};
use std::fmt;

/// A value that is not the same in both; none where one of them lacks it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Change {
    /// Path to it, e.g. `preset.constituents.aerosol.density_factor`.
    pub key: String,
    pub old: Option<Value>,
    pub new: Option<Value>,
}

/// Every place where `new` differs from `old`, in the order of `old`, what is new last. Lists of objects that have
/// names are compared by name; lists of numbers are one place each.
pub fn changes(old: &Value, new: &Value) -> Vec<Change> {
    let mut found = Vec::new();
    compare("", Some(old), Some(new), &mut found);
    found
}

fn compare(key: &str, old: Option<&Value>, new: Option<&Value>, found: &mut Vec<Change>) {
    if old == new {
        return;
    }
    let below = |name: &str| if key.is_empty() { name.to_string() } else { format!("{key}.{name}") };
    if let (Some(old), Some(new)) = (old, new)
        && let (Some(a), Some(b)) = (parts(old), parts(new))
    {
        let gone = a.iter().map(|(name, v)| (name, Some(*v), find(&b, name)));
        let come = b.iter().filter(|(name, _)| find(&a, name).is_none()).map(|(n, v)| (n, None, Some(*v)));
        gone.chain(come).for_each(|(name, a, b)| compare(&below(name), a, b, found));
        // Nothing below differs, and yet they do: the order of a list.
        if found.iter().any(|change| change.key.starts_with(key)) {
            return;
        }
    }
    found.push(Change { key: key.into(), old: old.cloned(), new: new.cloned() });
}

fn find<'a>(parts: &[(&str, &'a Value)], name: &str) -> Option<&'a Value> {
    parts.iter().find(|part| part.0 == name).map(|part| part.1)
}

/// The members of an object, or of a list of objects with names of their own; none of anything else.
fn parts(value: &Value) -> Option<Vec<(&str, &Value)>> {
    match value {
        Value::Object(map) => Some(map.iter().map(|(k, v)| (k.as_str(), v)).collect()),
        Value::Array(list) if !list.is_empty() => {
            let named: Vec<(&str, &Value)> =
                list.iter().map(|v| v["name"].as_str().map(|name| (name, v))).collect::<Option<_>>()?;
            let twice = (1..named.len()).any(|k| named[..k].iter().any(|other| other.0 == named[k].0));
            (!twice).then_some(named)
        }
        _ => None,
    }
}

impl fmt::Display for Change {
    /// `key: old → new`; of long lists the first number that differs.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if let (Some(Value::Array(old)), Some(Value::Array(new))) = (&self.old, &self.new)
            && old.len() == new.len()
            && old.len() > SHORT
            && let Some(first) = (0..old.len()).find(|&k| old[k] != new[k])
        {
            let differ = (0..old.len()).filter(|&k| old[k] != new[k]).count();
            let (was, is) = (brief(&old[first]), brief(&new[first]));
            return write!(f, "{}: {differ} of {} differ, [{first}]: {was} → {is}", self.key, old.len());
        }
        let text = |v: &Option<Value>| v.as_ref().map_or("(nothing)".to_string(), brief);
        write!(f, "{}: {} → {}", self.key, text(&self.old), text(&self.new))
    }
}

/// Values of a list that are shown whole.
const SHORT: usize = 4;
/// Characters of a value that are shown.
const LONGEST: usize = 60;

fn brief(value: &Value) -> String {
    let text = match value {
        Value::Array(list) if list.len() > SHORT => format!("[{} values]", list.len()),
        Value::Object(map) => names(map),
        other => other.to_string(),
    };
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

fn names(map: &Map<String, Value>) -> String {
    let text = Value::Object(map.clone()).to_string();
    if text.len() <= LONGEST {
        return text;
    }
    format!("{{{}}}", map.keys().map(String::as_str).collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn told(old: &Value, new: &Value) -> Vec<String> {
        changes(old, new).iter().map(Change::to_string).collect()
    }

    /// A number deep inside is named by its path, members of lists by their names even if they moved.
    #[test]
    fn places_are_named() {
        let old = json!({"air": [{"name": "gas", "g": 0}, {"name": "dust", "g": 0.7}], "top": 1});
        let new =
            json!({"air": [{"name": "dust", "g": 0.8}, {"name": "gas", "g": 0}], "top": 1, "more": "x"});
        assert_eq!(told(&old, &new), ["air.dust.g: 0.7 → 0.8", "more: (nothing) → \"x\""]);
        assert!(changes(&old, &old).is_empty());
    }

    /// The same members in another order are a difference of the list itself.
    #[test]
    fn order_counts() {
        let (one, two) = (json!([{"name": "a"}, {"name": "b"}]), json!([{"name": "b"}, {"name": "a"}]));
        assert_eq!(changes(&json!({"list": one}), &json!({"list": two})).len(), 1);
    }

    /// Of a long spectrum the count and the first that differs; a list of another length is told by lengths.
    #[test]
    fn long_lists_are_short() {
        let list = |from: usize, n: usize| json!({"v": (from..from + n).collect::<Vec<_>>()});
        assert_eq!(told(&list(0, 6), &list(1, 6)), ["v: 6 of 6 differ, [0]: 0 → 1"]);
        assert_eq!(told(&list(0, 6), &list(0, 7)), ["v: [6 values] → [7 values]"]);
        assert_eq!(told(&list(0, 2), &list(0, 3)), ["v: [0,1] → [0,1,2]"]);
    }
}
