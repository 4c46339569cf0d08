//! JSON schema of a case file for editors, made from the table of keys: nothing stands twice.

use std::str::FromStr;

use serde_json::{Map, Value, json};

use super::keys::{CaseKind, Key, KeyPresence, KeyValue, number_words};
use super::units::{self, Dimension};
use crate::laws::LawCatalogue;

/// A number as a quantity writes it.
const NUMBER: &str = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?";

/// The schema, draft 2020-12, of cases of a kind that choose among these laws.
pub fn schema(kind: &CaseKind, laws: &LawCatalogue) -> Value {
    let mut schema = object(kind.keys, laws);
    let head = [
        ("$schema", "https://json-schema.org/draft/2020-12/schema"),
        ("title", "A case of Calcine"),
    ];
    for (name, text) in head {
        schema.insert(name.into(), text.into());
    }
    Value::Object(schema)
}

/// Names of the keys that are needed so.
fn named(keys: &[Key], presence: KeyPresence) -> Vec<&'static str> {
    let needed = keys.iter().filter(|key| key.presence == presence);
    needed.map(|key| key.name).collect()
}

/// The table of some keys.
fn object(keys: &[Key], laws: &LawCatalogue) -> Map<String, Value> {
    let mut schema = Map::new();
    schema.insert("type".into(), "object".into());
    let properties = keys.iter();
    let properties = properties.map(|key| (key.name.to_owned(), described(key, laws)));
    schema.insert("properties".into(), Value::Object(properties.collect()));
    schema.insert("additionalProperties".into(), false.into());
    let required = named(keys, KeyPresence::Required);
    if !required.is_empty() {
        schema.insert("required".into(), json!(required));
    }
    let one_of = named(keys, KeyPresence::OneOf);
    if !one_of.is_empty() {
        let each = one_of.iter().map(|name| json!({"required": [name]}));
        let each: Vec<Value> = each.collect();
        schema.insert("oneOf".into(), each.into());
    }
    let together = together(keys);
    if !together.is_empty() {
        schema.insert("dependentRequired".into(), Value::Object(together));
    }
    schema
}

/// Keys of which neither stands without the other.
fn together(keys: &[Key]) -> Map<String, Value> {
    let mut pairs = Map::new();
    for key in keys {
        if let KeyPresence::With(partner) = key.presence {
            pairs.insert(key.name.into(), json!([partner]));
            pairs.insert(partner.into(), json!([key.name]));
        }
    }
    pairs
}

/// The value of a key, with what an editor shows of it.
fn described(key: &Key, laws: &LawCatalogue) -> Value {
    let mut schema = match form(key.value, laws) {
        Value::Object(schema) => schema,
        other => Map::from_iter([("const".into(), other)]),
    };
    let mut description = format!("{} ({})", key.told(laws), key.value.words(laws));
    let without = match (key.presence, key.value) {
        (KeyPresence::Default(text) | KeyPresence::Without(text), _) => Some(text.to_owned()),
        (KeyPresence::With(partner), _) => Some(format!("goes with `{partner}`")),
        (KeyPresence::OfLaw(Some(value)), KeyValue::Number(dimension, _)) => {
            Some(number_words(value, dimension))
        }
        _ => None,
    };
    if let Some(without) = without {
        description.push_str(&format!(" Without it: {without}."));
    }
    if let Some(value) = default(key) {
        schema.insert("default".into(), value);
    }
    schema.insert("description".into(), description.into());
    if let Some(example) = toml(key.example) {
        schema.insert("examples".into(), json!([example]));
    }
    Value::Object(schema)
}

/// What a value may be.
fn form(value: KeyValue, laws: &LawCatalogue) -> Value {
    let table = || Value::Object(object(&value.below(laws), laws));
    let texts = || json!({"type": "string"});
    match value {
        KeyValue::Text | KeyValue::Path => texts(),
        KeyValue::Texts(0) => list(texts()),
        KeyValue::Texts(count) => tuple(count, texts()),
        KeyValue::Truth => json!({"type": "boolean"}),
        KeyValue::Whole(least, most) => {
            let mut schema = json!({"type": "integer", "minimum": least});
            if most < i64::MAX {
                schema["maximum"] = most.into();
            }
            schema
        }
        KeyValue::Wholes(count) => tuple(count, json!({"type": "integer", "minimum": 1})),
        KeyValue::Number(dimension, _) => number(dimension),
        KeyValue::Numbers(0) => list(json!({"type": "number"})),
        KeyValue::Numbers(count) => tuple(count, json!({"type": "number"})),
        KeyValue::Vector(dimension) => vector(dimension),
        KeyValue::Vectors(dimension) => list(vector(dimension)),
        KeyValue::Schedule(dimension, _) | KeyValue::Curve(dimension, _) => {
            let value = number(dimension);
            either(value.clone(), pairs(quantity(1), value))
        }
        KeyValue::Choice(_) | KeyValue::LawName(_) => json!({"enum": value.choices(laws)}),
        KeyValue::Choices(words) => list(json!({"enum": words})),
        KeyValue::Band => json!({"type": "string", "pattern": plain()["pattern"]}),
        KeyValue::Measured => plain(),
        KeyValue::Spans => pairs(quantity(1), quantity(1)),
        KeyValue::Shares => pairs(quantity(1), plain()),
        KeyValue::Grading => either(plain(), list(tuple(3, plain()))),
        KeyValue::Table(_) | KeyValue::Law(..) | KeyValue::LawTable(..) => table(),
        KeyValue::Tables(_) => list(table()),
        KeyValue::Dated(_) => either(table(), pairs(quantity(1), table())),
        KeyValue::Named(_) => {
            json!({"type": "object", "additionalProperties": table()})
        }
        KeyValue::ByName(dimension) => {
            let value = match dimension {
                Dimension::NONE => json!({"type": "number"}),
                _ => quantity(1),
            };
            json!({"type": "object", "additionalProperties": value})
        }
        KeyValue::OfLaws(..) => any_of_laws(value, laws),
        // A number in quotes would be both.
        KeyValue::Either(one, KeyValue::Number(Dimension::NONE, _)) => {
            either(form(*one, laws), json!({"type": "number"}))
        }
        KeyValue::Either(one, other) => either(form(*one, laws), form(*other, laws)),
    }
}

/// What a value may be that laws take differently.
fn any_of_laws(value: KeyValue, laws: &LawCatalogue) -> Value {
    let mut forms: Vec<Value> = Vec::new();
    for one in value.alternatives(laws) {
        let form = match one {
            // A number in quotes would be a quantity too.
            KeyValue::Number(Dimension::NONE, _) => json!({"type": "number"}),
            one => form(one, laws),
        };
        if !forms.contains(&form) {
            forms.push(form);
        }
    }
    match &forms[..] {
        [form] => form.clone(),
        _ => json!({"oneOf": forms}),
    }
}

fn number(dimension: Dimension) -> Value {
    match dimension {
        Dimension::NONE => plain(),
        _ => quantity(1),
    }
}

fn vector(dimension: Dimension) -> Value {
    match dimension {
        Dimension::NONE => direction(),
        _ => quantity(3),
    }
}

fn either(one: Value, other: Value) -> Value {
    json!({"oneOf": [one, other]})
}

fn list(of: Value) -> Value {
    json!({"type": "array", "items": of})
}

fn tuple(length: usize, of: Value) -> Value {
    json!({"type": "array", "items": of, "minItems": length, "maxItems": length})
}

/// At least one pair.
fn pairs(first: Value, second: Value) -> Value {
    let pair = json!({
        "type": "array", "prefixItems": [first, second], "minItems": 2, "maxItems": 2
    });
    json!({"type": "array", "items": pair, "minItems": 1})
}

/// A number without a dimension; in quotes it may have a unit such as `%`.
fn plain() -> Value {
    let pattern = format!(r"^\s*{NUMBER}(?:{})?\s*$", unit());
    json!({"type": ["number", "string"], "pattern": pattern})
}

/// Three numbers in one text.
fn direction() -> Value {
    let pattern = format!(r"^\s*{NUMBER}\s+{NUMBER}\s+{NUMBER}\s*$");
    json!({"type": "string", "pattern": pattern})
}

/// So many numbers and a unit that the reader knows. The dimension is left to `calcine check`.
fn quantity(numbers: usize) -> Value {
    let numbers = vec![NUMBER; numbers].join(r"\s+");
    let pattern = format!(r"^\s*{numbers}(?:{})\s*$", unit());
    json!({"type": "string", "pattern": pattern})
}

/// A unit after a number, such as ` kg/m^3` or ` 1/s`.
fn unit() -> String {
    let symbols: Vec<&str> = units::symbols().collect();
    let one = format!(r"(?:{})(?:\^[+-]?\d)?", symbols.join("|"));
    format!(r"\s*{one}(?:[/*· ]{one})*|\s+1(?:/{one})+|\s*(?:degC|°C)")
}

/// The value that holds without a key, where it is one that a case could write.
fn default(key: &Key) -> Option<Value> {
    let text = match (key.presence, key.value) {
        (KeyPresence::Default(text), _) => text,
        (KeyPresence::OfLaw(Some(value)), KeyValue::Number(Dimension::NONE, _)) => {
            return Some(json!(value));
        }
        (KeyPresence::OfLaw(Some(value)), KeyValue::Number(dimension, _)) => {
            return Some(number_words(value, dimension).into());
        }
        _ => return None,
    };
    Some(match key.value {
        KeyValue::Choices(_) => json!([text]),
        KeyValue::Truth => (text == "true").into(),
        _ => match serde_json::Number::from_str(text) {
            Ok(number) => Value::Number(number),
            Err(_) => text.into(),
        },
    })
}

/// A value of TOML in JSON; `None` for the heading of a table.
fn toml(text: &str) -> Option<Value> {
    let document = toml_edit::Document::parse(format!("x = {text}")).ok()?;
    let value = json_of(document.get("x")?.as_value()?);
    // `[[contacts]]` is also a list that holds a list: a heading has no quotes and no numbers.
    let heading = text.starts_with('[') && !text.contains(['"', '{', ',']);
    (!heading).then_some(value?)
}

fn json_of(value: &toml_edit::Value) -> Option<Value> {
    Some(match value {
        toml_edit::Value::String(text) => text.value().as_str().into(),
        toml_edit::Value::Integer(number) => (*number.value()).into(),
        toml_edit::Value::Float(number) => (*number.value()).into(),
        toml_edit::Value::Boolean(truth) => (*truth.value()).into(),
        toml_edit::Value::Array(list) => {
            Value::Array(list.iter().map(json_of).collect::<Option<_>>()?)
        }
        toml_edit::Value::InlineTable(table) => {
            let entries = table.iter();
            let entries = entries.map(|(name, value)| Some((name.to_owned(), json_of(value)?)));
            Value::Object(entries.collect::<Option<_>>()?)
        }
        toml_edit::Value::Datetime(_) => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::keys::KINDS;

    /// The schema of a dotted key, through lists and whatever a name of the user's stands for.
    fn at<'s>(schema: &'s Value, path: &str) -> &'s Value {
        path.split('.').fold(schema, |schema, name| {
            let inner = [&schema["items"], &schema["oneOf"][1], schema];
            let table = inner
                .iter()
                .find(|value| value["type"] == "object")
                .unwrap();
            match name {
                "NAME" => &table["additionalProperties"],
                name => &table["properties"][name],
            }
        })
    }

    #[test]
    fn a_key_has_its_form_its_default_its_example_and_what_it_means() {
        let schema = schema(&KINDS[0], &LawCatalogue::default());
        let storage = at(&schema, "time.gas_storage");
        assert_eq!(storage["enum"], json!(["process", "accelerated"]));
        assert_eq!(storage["default"], "process");
        let density = at(&schema, "materials.NAME.density");
        assert_eq!(density["type"], "string");
        assert_eq!(density["examples"], json!(["2500 kg/m^3"]));
        let meaning = density["description"].as_str().unwrap();
        assert_eq!(meaning, "Density. (density, kg/m^3)");
        let iterations = at(&schema, "gas.controls.outer_iterations");
        assert_eq!(iterations["default"], 30);
        assert_eq!(
            [&iterations["minimum"], &iterations["maximum"]],
            [1, 10_000]
        );
        assert_eq!(
            at(&schema, "output.particles")["default"],
            json!(["temperature"])
        );
        let required = &at(&schema, "gas.patch.NAME")["oneOf"];
        assert_eq!(required[0], json!({"required": ["inlet"]}));
        assert_eq!(required.as_array().unwrap().len(), 8);
        let moving = at(&schema, "gas.patch.NAME.wall.velocity.moving");
        assert!(moving["pattern"].is_string());
        assert_eq!(schema["additionalProperties"], false);
        assert_eq!(
            at(&schema, "gas")["dependentRequired"]["species"],
            json!(["schmidt"])
        );
    }

    #[test]
    fn laws_and_their_keys_come_from_where_the_laws_are() {
        let schema = schema(&KINDS[0], &LawCatalogue::default());
        let laws = at(&schema, "laws.drag.law")["enum"].as_array().unwrap();
        assert!(laws.contains(&json!("tenneti")) && laws.contains(&json!("none")));
        assert_eq!(at(&schema, "laws.conduction.gap.cone")["default"], 0.66);
        let width = at(&schema, "laws.conduction.gap.least_width");
        assert_eq!(width["examples"], json!(["1 um"]));
    }
}
