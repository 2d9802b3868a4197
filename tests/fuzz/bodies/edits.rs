//! Bytes as changes to a JSON file, so that what lies behind its syntax is reached: an input that begins with a control
//! character is a list of edits of the file of that number, any other one is taken as it is.

use serde_json::{Value, json};

/// A file, and the paths to all its values.
pub struct Base {
    value: Value,
    places: Vec<String>,
    keys: Vec<String>,
}

impl Base {
    pub fn new(text: &str) -> Self {
        let value: Value = serde_json::from_str(text).expect("a file of ours");
        let (mut places, mut keys) = (Vec::new(), Vec::new());
        walk(&value, String::new(), &mut places, &mut keys);
        keys.sort();
        keys.dedup();
        Base { value, places, keys }
    }
}

/// Of lists the first three, one in the middle and the last, since tables have hundreds of numbers alike.
fn walk(value: &Value, at: String, places: &mut Vec<String>, keys: &mut Vec<String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, v)| {
            keys.push(key.clone());
            let step = key.replace('~', "~0").replace('/', "~1");
            walk(v, format!("{at}/{step}"), places, keys)
        }),
        Value::Array(list) => list.iter().enumerate().for_each(|(k, v)| {
            if k < 3 || k == list.len() / 2 || k + 1 == list.len() {
                walk(v, format!("{at}/{k}"), places, keys)
            }
        }),
        _ => {}
    }
    places.push(at);
}

/// The text that an input stands for; none where it is no text.
pub fn text(bytes: &[u8], bases: &[Base]) -> Option<String> {
    match bytes.split_first() {
        Some((&number, edits)) if number < 9 => {
            let base = &bases[usize::from(number) % bases.len()];
            let mut value = base.value.clone();
            let mut input = Input(edits);
            for _ in 0..8 {
                if input.0.is_empty() {
                    break;
                }
                edit(&mut value, base, &mut input);
            }
            Some(value.to_string())
        }
        _ => std::str::from_utf8(bytes).ok().map(str::to_string),
    }
}

struct Input<'a>(&'a [u8]);

impl Input<'_> {
    fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().unwrap_or((&0, &[]));
        self.0 = rest;
        *first
    }

    fn below(&mut self, n: usize) -> usize {
        (usize::from(self.byte()) | usize::from(self.byte()) << 8) % n.max(1)
    }

    fn number(&mut self) -> f64 {
        f64::from_le_bytes(std::array::from_fn(|_| self.byte()))
    }
}

/// Numbers at the ends of what there is.
const NUMBERS: [f64; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    1e-3,
    1e3,
    1e-300,
    1e300,
    5e-324,
    1.7e308,
    4294967296.0,
    1e15,
    90.0,
    0.999999999999,
];

fn edit(value: &mut Value, base: &Base, input: &mut Input) {
    let path = &base.places[input.below(base.places.len())];
    let kind = input.byte() % 12;
    let other = || -> Value { Value::Null };
    let copied = |input: &mut Input| -> Value {
        let from = &base.places[input.below(base.places.len())];
        base.value.pointer(from).cloned().unwrap_or_else(other)
    };
    let new = match kind {
        0 => json!(NUMBERS[input.below(NUMBERS.len())]),
        1 => json!(input.number()),
        2 => json!(input.below(65536)),
        3 => [
            json!(null),
            json!(true),
            json!("x"),
            json!(""),
            json!([]),
            json!({}),
            json!("a\nb"),
            json!("../x.csv"),
        ][input.below(8)]
        .clone(),
        4 | 5 => copied(input),
        6 => {
            let factor = NUMBERS[input.below(NUMBERS.len())];
            json!(value.pointer(path).and_then(Value::as_f64).unwrap_or(1.0) * factor)
        }
        _ => return change(value, path, kind, base, input, &copied),
    };
    if let Some(place) = value.pointer_mut(path) {
        *place = new;
    }
}

/// Changes of the object or list at a path, or of the one around it.
fn change(
    value: &mut Value,
    path: &str,
    kind: u8,
    base: &Base,
    input: &mut Input,
    copied: &dyn Fn(&mut Input) -> Value,
) {
    let (around, step) = path.rsplit_once('/').unwrap_or(("", ""));
    let step = step.replace("~1", "/").replace("~0", "~");
    match (kind, value.pointer_mut(around)) {
        (7, Some(Value::Object(map))) => drop(map.remove(&step)),
        (7, Some(Value::Array(list))) => drop(list.pop()),
        (8, Some(Value::Object(map))) => {
            let key = base.keys[input.below(base.keys.len())].clone();
            map.insert(key, copied(input));
        }
        (8 | 9, Some(Value::Array(list))) => {
            let item = list.last().cloned().unwrap_or(Value::Null);
            list.extend(std::iter::repeat_n(item, input.below(300)));
        }
        (10, Some(Value::Array(list))) => list.reverse(),
        (11, Some(place)) => *place = json!([place.clone()]),
        _ => {}
    }
}
