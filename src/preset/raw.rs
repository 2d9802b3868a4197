//! A value of a preset file with the path that leads to it, so that every complaint says where.

use super::bounds::Bounds;
use super::names;
use super::names::nearest;
use crate::error::{Error, Result};
use serde_json::{Map, Value};

/// Longest length of a preset, m: more than the radius of the largest star.
pub(super) const MOST_METRES: f64 = 1e13;

/// What is wrong with `"g": "0.76"`.
pub(super) const WITHOUT_QUOTES: &str = "must be a finite number; quotation marks make it a text";

/// A JSON value, the file it stands in and the path to it (`constituents[1].phase.g`).
#[derive(Clone, Debug)]
pub(super) struct Raw<'a> {
    file: &'a str,
    path: String,
    value: &'a Value,
}

impl<'a> Raw<'a> {
    pub(super) fn root(file: &'a str, value: &'a Value) -> Self {
        Raw { file, path: String::new(), value }
    }

    pub(super) fn file(&self) -> &'a str {
        self.file
    }

    /// Path of this value; `(top level)` for the whole file.
    pub(super) fn path(&self) -> &str {
        if self.path.is_empty() { "(top level)" } else { &self.path }
    }

    /// An error about this value.
    pub(super) fn refuse(&self, reason: impl ToString) -> Error {
        Error::Value {
            file: self.file.to_string(),
            key: self.path().to_string(),
            value: brief(self.value),
            reason: reason.to_string(),
        }
    }

    fn child(&self, key: &str, value: &'a Value) -> Raw<'a> {
        let path = if self.path.is_empty() { key.to_string() } else { format!("{}.{key}", self.path) };
        Raw { file: self.file, path, value }
    }

    fn map(&self) -> Result<&'a Map<String, Value>> {
        self.value.as_object().ok_or_else(|| self.refuse("must be an object { … }"))
    }

    /// Refuses keys that are not known here, naming the nearest or all known; `source` is known everywhere.
    pub(super) fn only(&self, known: &[&str]) -> Result<()> {
        #[cfg(test)]
        super::schema::record::note(known);
        let known_here = known.iter().copied().chain(["source"]);
        for (key, value) in self.map()? {
            if !known_here.clone().any(|k| k == key) {
                let reason = format!("unknown key; {}", names::known(key, known_here));
                return Err(self.child(key, value).refuse(reason));
            }
        }
        Ok(())
    }

    pub(super) fn get(&self, key: &str) -> Result<Option<Raw<'a>>> {
        Ok(self.map()?.get_key_value(key).map(|(k, v)| self.child(k, v)))
    }

    pub(super) fn need(&self, key: &str) -> Result<Raw<'a>> {
        if let Some(found) = self.get(key)? {
            return Ok(found);
        }
        let like = nearest(key, self.map()?.keys().map(String::as_str));
        let meant = like.map_or(String::new(), |like| format!("; is `{like}` meant to be it?"));
        Err(self.refuse(format!("`{key}` is missing{meant}")))
    }

    /// The only one of several alternative keys that is given, with its number in the list.
    pub(super) fn one_of(&self, keys: &[&str]) -> Result<(usize, Raw<'a>)> {
        self.at_most_one_of(keys)?
            .ok_or_else(|| self.refuse(format!("one of {} is missing", names::quoted(keys.iter().copied()))))
    }

    /// The only one of several alternative keys, or none; two are refused.
    pub(super) fn at_most_one_of(&self, keys: &[&str]) -> Result<Option<(usize, Raw<'a>)>> {
        let mut found = None;
        for (k, key) in keys.iter().enumerate() {
            if let Some(raw) = self.get(key)? {
                if found.is_some() {
                    return Err(
                        raw.refuse(format!("give only one of {}", names::quoted(keys.iter().copied())))
                    );
                }
                found = Some((k, raw));
            }
        }
        Ok(found)
    }

    pub(super) fn is_number(&self) -> bool {
        self.value.is_number()
    }

    pub(super) fn is_text(&self) -> bool {
        self.value.is_string()
    }

    /// Whether it is a number in quotation marks, which JSON takes for a text.
    pub(super) fn is_quoted_number(&self) -> bool {
        self.value.as_str().is_some_and(names::is_number)
    }

    pub(super) fn text(&self) -> Result<&'a str> {
        self.value.as_str().ok_or_else(|| self.refuse("must be a text"))
    }

    pub(super) fn flag(&self) -> Result<bool> {
        self.value.as_bool().ok_or_else(|| self.refuse("must be true or false"))
    }

    /// A text out of a list, by number; another is refused with the nearest.
    pub(super) fn choice(&self, choices: &[&str]) -> Result<usize> {
        let text = self.text()?;
        choices.iter().position(|c| *c == text).ok_or_else(|| {
            let all = names::quoted(choices.iter().copied());
            self.refuse(match nearest(text, choices.iter().copied()) {
                Some(near) => format!("unknown here; the nearest known one is `{near}`, all are {all}"),
                None => format!("unknown here; known are {all}"),
            })
        })
    }

    /// A finite number.
    pub(super) fn number(&self) -> Result<f64> {
        match self.value.as_f64() {
            Some(v) if v.is_finite() => Ok(v),
            _ if self.is_quoted_number() => Err(self.refuse(WITHOUT_QUOTES)),
            _ => Err(self.refuse("must be a finite number")),
        }
    }

    /// A number inside bounds.
    pub(super) fn number_in(&self, bounds: Bounds) -> Result<f64> {
        let v = self.number()?;
        if bounds.hold(v) { Ok(v) } else { Err(self.refuse(format!("must be {}", bounds.text))) }
    }

    pub(super) fn items(&self) -> Result<Vec<Raw<'a>>> {
        let list = self.value.as_array().ok_or_else(|| self.refuse("must be a list [ … ]"))?;
        let item = |(k, value)| Raw { file: self.file, path: format!("{}[{k}]", self.path), value };
        Ok(list.iter().enumerate().map(item).collect())
    }

    /// A list of numbers inside bounds; a bad one is named by its place.
    pub(super) fn numbers_in(&self, bounds: Bounds) -> Result<Vec<f64>> {
        self.items()?.iter().map(|item| item.number_in(bounds)).collect()
    }

    /// A list of at least `least` numbers, each greater than the one before.
    pub(super) fn rising(&self, least: usize) -> Result<Vec<f64>> {
        let items = self.items()?;
        if items.len() < least {
            return Err(self.refuse(format!("must have {least} or more numbers")));
        }
        let mut list: Vec<f64> = Vec::with_capacity(items.len());
        for item in items {
            let v = item.number()?;
            if list.last().is_some_and(|&last| v <= last) {
                return Err(item.refuse("must be greater than the number before it"));
            }
            list.push(v);
        }
        Ok(list)
    }

    /// Key `{stem}_m` or `{stem}_km`, whichever is given, as a length in metres (no longer than any star is wide)
    /// whose number is inside bounds.
    pub(super) fn length(&self, stem: &str, bounds: Bounds) -> Result<f64> {
        let (metres, kilometres) = (format!("{stem}_m"), format!("{stem}_km"));
        let (unit, raw) = self.one_of(&[&kilometres, &metres])?;
        let length = raw.number_in(bounds)? * [1e3, 1.0][unit];
        if length > MOST_METRES {
            return Err(raw.refuse("must be less than 1e13 m"));
        }
        Ok(length)
    }

    /// Every object that holds numbers must say where they come from.
    pub(super) fn check_sources(&self) -> Result<()> {
        match self.value {
            Value::Object(map) => {
                let source = map.get("source");
                if source.is_none() && map.values().any(bears_numbers) {
                    return Err(self.refuse(
                        "numbers without a source: add \"source\", a citation or \"project choice: why\"",
                    ));
                }
                if let Some(source) = source
                    && source.as_str().is_none_or(|text| text.trim().is_empty())
                {
                    return Err(self.child("source", source).refuse("must be a text that is not empty"));
                }
                map.iter().try_for_each(|(key, value)| self.child(key, value).check_sources())
            }
            Value::Array(_) => self.items()?.iter().try_for_each(Raw::check_sources),
            _ => Ok(()),
        }
    }
}

/// True of a number and of a list that holds numbers, at any depth.
pub(super) fn bears_numbers(value: &Value) -> bool {
    match value {
        Value::Number(_) => true,
        Value::Array(list) => list.iter().any(bears_numbers),
        _ => false,
    }
}

/// JSON of a value on one short line.
fn brief(value: &Value) -> String {
    const MOST: usize = 60;
    let text = value.to_string();
    if text.chars().count() <= MOST {
        return text;
    }
    text.chars().take(MOST).chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::super::bounds::POSITIVE;
    use super::*;
    use serde_json::json;

    /// Errors carry the path as one would type it, and a slip of the pen brings the key that was meant.
    #[test]
    fn errors_name_the_place_and_the_nearest_key() {
        let value = json!({"constituents": [{"phase": {"g": 1.5}, "densty_factor": 1}]});
        let root = Raw::root("a.json", &value);
        let item = root.need("constituents").unwrap().items().unwrap().remove(0);
        let g = item.need("phase").unwrap().need("g").unwrap();
        let bounds = Bounds::between(-1.0, 1.0, "between -1 and 1");
        let error = g.number_in(bounds).unwrap_err().to_string();
        assert_eq!(error, "a.json: constituents[0].phase.g = 1.5: must be between -1 and 1");
        let error = item.only(&["phase", "density_factor", "profile"]).unwrap_err().to_string();
        assert!(error.contains("constituents[0].densty_factor = 1"), "{error}");
        assert!(error.contains("nearest known one is `density_factor`"), "{error}");
    }

    /// A number needs a source in the object that holds it, also when it sits in a list; texts need none.
    #[test]
    fn numbers_need_sources() {
        let check = |v: Value| Raw::root("a.json", &v).check_sources().map_err(|e| e.to_string());
        assert!(check(json!({"name": "x", "list": [{"kind": "isotropic"}]})).is_ok());
        assert!(check(json!({"a": {"b": 1, "source": "somewhere 1999"}})).is_ok());
        assert!(check(json!({"a": {"b": 1}})).unwrap_err().starts_with("a.json: a = {\"b\":1}"));
        assert!(check(json!({"a": [{"b": [[1.0]]}]})).unwrap_err().starts_with("a.json: a[0]"));
        assert!(check(json!({"b": 1, "source": " "})).unwrap_err().contains("source"));
        assert!(check(json!({"b": 1, "source": 7})).unwrap_err().contains("source"));
    }

    /// Lengths come in metres or kilometres by their key, never in both.
    #[test]
    fn units_are_in_the_key() {
        let length = |v: Value| Raw::root("a", &v).length("top", POSITIVE).ok();
        assert_eq!(length(json!({"top_km": 2.5})), Some(2500.0));
        assert_eq!(length(json!({"top_m": 2.5})), Some(2.5));
        assert_eq!(length(json!({"top_m": 2.5, "top_km": 1})), None);
        assert_eq!(length(json!({"top_km": 0})), None);
    }
}
