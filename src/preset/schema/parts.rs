//! Pieces that schemas of presets are put together from.

use super::super::bounds::Bounds;
use super::super::library;
use super::super::raw::MOST_METRES;
use super::super::read_spectrum::Quantity;
use serde_json::{Map, Value, json};

/// An object of known keys: properties, those that must be there, and lists of alternatives of which exactly one
/// must be there. Every object may have a source, and must where it holds numbers.
pub(super) struct Object {
    about: String,
    properties: Map<String, Value>,
    required: Vec<String>,
    rules: Vec<Value>,
}

impl Object {
    pub(super) fn new(about: &str) -> Self {
        Object { about: about.into(), properties: Map::new(), required: Vec::new(), rules: Vec::new() }
    }

    pub(super) fn may(mut self, key: &str, value: Value) -> Self {
        self.properties.insert(key.into(), value);
        self
    }

    pub(super) fn must(mut self, key: &str, value: Value) -> Self {
        self.required.push(key.into());
        self.may(key, value)
    }

    /// `kind`, of one value.
    pub(super) fn kind(self, kind: &str) -> Self {
        self.must("kind", json!({ "const": kind }))
    }

    /// Exactly one of some keys.
    pub(super) fn one_of(mut self, alternatives: &[(&str, Value)]) -> Self {
        let required = |(key, _): &(&str, Value)| json!({ "required": [key] });
        self.rules.push(json!({ "oneOf": alternatives.iter().map(required).collect::<Vec<_>>() }));
        alternatives.iter().fold(self, |object, (key, value)| object.may(key, value.clone()))
    }

    /// A length as `{stem}_km` or `{stem}_m`.
    pub(super) fn length(self, stem: &str, bounds: Bounds, about: &str) -> Self {
        let [metres, kilometres] = [("m", 1.0), ("km", 1e3)].map(|(unit, factor)| {
            let most = Bounds { high: MOST_METRES / factor, ..bounds };
            (format!("{stem}_{unit}"), number(most, &format!("{about}, {unit}")))
        });
        self.one_of(&[(&kilometres.0, kilometres.1), (&metres.0, metres.1)])
    }

    /// Another condition that must hold.
    pub(super) fn rule(mut self, rule: Value) -> Self {
        self.rules.push(rule);
        self
    }

    pub(super) fn build(mut self) -> Value {
        self.properties.insert("source".into(), json!({ "$ref": "#/$defs/source" }));
        self.rules.push(json!({ "$ref": "#/$defs/sourced" }));
        json!({
            "description": self.about,
            "type": "object",
            "properties": self.properties,
            "required": self.required,
            "additionalProperties": false,
            "allOf": self.rules,
        })
    }
}

/// What all schemas refer to.
pub(super) fn definitions() -> Map<String, Value> {
    let source = json!({
        "description": "Where the numbers of this object come from: a citation, or \"project choice: why\"",
        "type": "string",
        "pattern": "\\S",
    });
    let bears_numbers = json!({ "anyOf": [
        { "type": "number" },
        { "type": "array", "contains": { "$ref": "#/$defs/bears_numbers" } },
    ] });
    let sourced = json!({
        "description": "An object that holds numbers needs a source",
        "anyOf": [
            { "required": ["source"] },
            { "additionalProperties": { "not": { "$ref": "#/$defs/bears_numbers" } } },
        ],
    });
    let text = json!({ "type": "string", "pattern": "\\S" });
    let all = [("source", source), ("bears_numbers", bears_numbers), ("sourced", sourced), ("text", text)];
    all.map(|(name, value)| (name.to_string(), value)).into_iter().collect()
}

/// A number inside bounds.
pub(super) fn number(bounds: Bounds, about: &str) -> Value {
    let mut out = json!({ "description": format!("{about}: {}", bounds.text), "type": "number" });
    let keys = [["minimum", "exclusiveMinimum"], ["maximum", "exclusiveMaximum"]];
    for (end, key) in [bounds.low, bounds.high].into_iter().zip(keys.iter().zip(bounds.open)) {
        if end.is_finite() {
            out[key.0[usize::from(key.1)]] = json!(end);
        }
    }
    out
}

/// A list of numbers inside bounds.
pub(super) fn numbers(bounds: Bounds, least: usize, about: &str) -> Value {
    json!({ "description": about, "type": "array", "minItems": least, "items": number(bounds, about) })
}

/// The same list of so many at most.
pub(super) fn at_most(most: usize, mut list: Value) -> Value {
    list["maxItems"] = json!(most);
    list
}

/// Wavelengths of a table.
pub(super) fn wavelengths() -> Value {
    let bounds = Bounds::above(0.0, "greater than 0");
    numbers(bounds, 1, "Wavelengths in nm, rising; values between are interpolated, end values are held")
}

/// A text out of a list.
pub(super) fn choice(choices: &[&str], about: &str) -> Value {
    json!({ "description": about, "enum": choices })
}

/// A number, the name of a spectrum, or a table over wavelength.
pub(super) fn spectrum(quantity: Quantity, about: &str) -> Value {
    json!({ "description": about, "anyOf": [
        number(quantity.bounds, about),
        name_of_spectrum(quantity),
        table("values", quantity.bounds, about),
    ] })
}

/// A spectrum that is shipped, or a CSV file beside the preset.
pub(super) fn name_of_spectrum(quantity: Quantity) -> Value {
    let file =
        format!("A CSV file with the header wavelength_nm,{} and a line `# source: …`", quantity.column);
    json!({ "type": "string", "anyOf": [
        { "enum": library::spectra_of(quantity.column) },
        { "description": file, "pattern": "\\.csv$" },
    ] })
}

/// Values over wavelength under a key.
pub(super) fn table(key: &str, bounds: Bounds, about: &str) -> Value {
    let values = numbers(bounds, 1, &format!("{about}, a value for each wavelength"));
    Object::new(about).must("wavelengths_nm", wavelengths()).must(key, values).build()
}

/// One of several objects, told apart by their `kind`.
pub(super) fn kinds(about: &str, all: Vec<Value>) -> Value {
    json!({ "description": about, "oneOf": all })
}
