//! JSON schema of a case file for editors, made from the table of keys: nothing stands twice.

use std::str::FromStr;

use serde_json::{Map, Value, json};

use super::keys::{Key, KeyPresence, keys};
use super::units;

/// A number as a quantity writes it.
const NUMBER: &str = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?";
/// What stands in the table of keys for a name that the user chooses.
const NAME: &str = "NAME";

/// The schema, draft 2020-12.
pub fn schema() -> Value {
    let mut root = YamlNode::default();
    for key in keys() {
        root.insert(key.key, key);
    }
    let mut schema = root.object();
    let head = [
        ("$schema", "https://json-schema.org/draft/2020-12/schema"),
        ("title", "A case of Calcine"),
    ];
    for (name, text) in head {
        schema.insert(name.into(), text.into());
    }
    Value::Object(schema)
}

/// A key with the keys below it, in the order of the table.
#[derive(Default)]
struct YamlNode {
    key: Option<&'static Key>,
    below: Vec<(&'static str, YamlNode)>,
}

impl YamlNode {
    fn insert(&mut self, path: &'static str, key: &'static Key) {
        let (name, rest) = match path.split_once('.') {
            Some((name, rest)) => (name, Some(rest)),
            None => (path, None),
        };
        let at = self.below.iter().position(|(other, _)| *other == name);
        let at = at.unwrap_or_else(|| {
            self.below.push((name, YamlNode::default()));
            self.below.len() - 1
        });
        let node = &mut self.below[at].1;
        match rest {
            Some(rest) => node.insert(rest, key),
            None => node.key = Some(key),
        }
    }

    /// Names of the keys below that are needed so.
    fn named(&self, wanted: impl Fn(&KeyPresence) -> bool) -> Vec<&'static str> {
        let keys = self.below.iter().filter_map(|(name, node)| {
            let need = &node.key?.need;
            wanted(need).then_some(*name)
        });
        keys.collect()
    }

    /// The table of the keys below.
    fn object(&self) -> Map<String, Value> {
        let mut schema = Map::new();
        schema.insert("type".into(), "object".into());
        if let [(NAME, node)] = &self.below[..] {
            let named = Value::Object(node.object());
            schema.insert("additionalProperties".into(), named);
            return schema;
        }
        let properties = self.below.iter();
        let properties = properties.map(|(name, node)| ((*name).to_owned(), node.schema()));
        schema.insert("properties".into(), Value::Object(properties.collect()));
        schema.insert("additionalProperties".into(), false.into());
        let required = self.named(|need| *need == KeyPresence::Required);
        if !required.is_empty() {
            schema.insert("required".into(), json!(required));
        }
        let one_of = self.named(|need| *need == KeyPresence::OneOf);
        if !one_of.is_empty() {
            let each = one_of.iter().map(|name| json!({"required": [name]}));
            let each: Vec<Value> = each.collect();
            schema.insert("oneOf".into(), each.into());
        }
        let together = self.together();
        if !together.is_empty() {
            schema.insert("dependentRequired".into(), Value::Object(together));
        }
        schema
    }

    /// Keys of which neither stands without the other: "goes with `species`".
    fn together(&self) -> Map<String, Value> {
        let mut pairs = Map::new();
        for (name, node) in &self.below {
            if let Some(KeyPresence::Default(without)) = node.key.map(|key| key.need)
                && let Some(partner) = without.strip_prefix("goes with ")
            {
                let partner = partner.trim_matches('`');
                pairs.insert((*name).into(), json!([partner]));
                pairs.insert(partner.into(), json!([name]));
            }
        }
        pairs
    }

    /// The value of this key, with what an editor shows of it.
    fn schema(&self) -> Value {
        let Some(key) = self.key else {
            return Value::Object(self.object());
        };
        let mut schema = match self.form(key.value) {
            Value::Object(schema) => schema,
            other => Map::from_iter([("const".into(), other)]),
        };
        let mut description = format!("{} ({})", key.meaning, key.value);
        if let KeyPresence::Default(without) = key.need {
            description.push_str(&format!(" Without it: {without}."));
            if let Some(value) = default(key, without) {
                schema.insert("default".into(), value);
            }
        }
        schema.insert("description".into(), description.into());
        if let Some(example) = toml(key.example) {
            schema.insert("examples".into(), json!([example]));
        }
        Value::Object(schema)
    }

    /// What a value may be, from the words in the table of keys.
    fn form(&self, words: &str) -> Value {
        let object = || Value::Object(self.object());
        let stripped = |ending: &str| {
            let words = words.strip_suffix(ending)?;
            Some(self.form(words.strip_suffix(',').unwrap_or(words)))
        };
        if let Some(value) = stripped(" or `closed`") {
            return either(value, json!({"const": "closed"}));
        }
        if let Some(value) = stripped(" or a number") {
            return either(value, json!({"type": "number"}));
        }
        if let Some(value) = stripped(" or schedule") {
            return either(value.clone(), pairs(quantity(1), value));
        }
        if let Some(value) = stripped(" or points over temperature") {
            return either(value.clone(), pairs(quantity(1), value));
        }
        if let Some(value) = stripped(" or table") {
            return either(value, object());
        }
        if let Some(choices) = words.strip_prefix("list of `") {
            return list(json!({"enum": choices_of(&format!("`{choices}"))}));
        }
        if let Some(each) = words.strip_prefix("list of three ") {
            return list(self.form(&format!("three {each}")));
        }
        match words {
            "table" => object(),
            "list of tables" => list(object()),
            "table, or schedule of tables" => either(object(), pairs(quantity(1), object())),
            "table of numbers" => {
                json!({"type": "object", "additionalProperties": {"type": "number"}})
            }
            "text" | "path" => json!({"type": "string"}),
            "list of texts" => list(json!({"type": "string"})),
            "two texts" => tuple(2, json!({"type": "string"})),
            "six texts" => tuple(6, json!({"type": "string"})),
            "whole number" => json!({"type": "integer", "minimum": 0}),
            "two whole numbers" => tuple(2, json!({"type": "integer", "minimum": 1})),
            "three whole numbers" => tuple(3, json!({"type": "integer", "minimum": 1})),
            "true or false" => json!({"type": "boolean"}),
            "three numbers" => direction(),
            "seven numbers" => tuple(7, json!({"type": "number"})),
            "number" | "plain number" | "as the field measured" => plain(),
            "number, or list" => either(plain(), list(tuple(3, plain()))),
            "list of pairs" => pairs(quantity(1), plain()),
            "list of [begin, end]" => pairs(quantity(1), quantity(1)),
            "band" => json!({"type": "string", "pattern": plain()["pattern"]}),
            _ if words.starts_with('`') => json!({"enum": choices_of(words)}),
            _ if words.starts_with("table of ") => {
                json!({"type": "object", "additionalProperties": quantity(1)})
            }
            _ if words.starts_with("three ") => quantity(3),
            _ => quantity(1),
        }
    }
}

/// The words in backticks.
fn choices_of(words: &str) -> Vec<&str> {
    words.split('`').skip(1).step_by(2).collect()
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

/// The value that holds without a key, where the table's words say it.
fn default(key: &Key, without: &str) -> Option<Value> {
    let word = without
        .strip_prefix('`')
        .and_then(|rest| rest.strip_suffix('`'))
        .filter(|word| !word.contains('`'));
    if let Some(word) = word {
        let in_list = key.value.starts_with("list of ");
        return Some(if in_list { json!([word]) } else { json!(word) });
    }
    if let Ok(number) = serde_json::Number::from_str(without) {
        return Some(Value::Number(number));
    }
    units::quantities(without).is_ok().then(|| json!(without))
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

    /// The schema of a dotted key, through lists and whatever a name of the user's stands for.
    fn at<'s>(schema: &'s Value, path: &str) -> &'s Value {
        path.split('.').fold(schema, |schema, name| {
            let inner = [&schema["items"], &schema["oneOf"][1], schema];
            let table = inner
                .iter()
                .find(|value| value["type"] == "object")
                .unwrap();
            match name {
                NAME => &table["additionalProperties"],
                name => &table["properties"][name],
            }
        })
    }

    #[test]
    fn a_key_has_its_form_its_default_its_example_and_what_it_means() {
        let schema = schema();
        let window = at(&schema, "time.gas_storage");
        assert_eq!(window["enum"], json!(["process", "accelerated"]));
        assert_eq!(window["default"], "process");
        let density = at(&schema, "materials.NAME.density");
        assert_eq!(density["type"], "string");
        assert_eq!(density["examples"], json!(["2500 kg/m^3"]));
        let meaning = density["description"].as_str().unwrap();
        assert_eq!(meaning, "Density. (density, kg/m^3)");
        assert_eq!(at(&schema, "gas.controls.outer_iterations")["default"], 20);
        assert_eq!(
            at(&schema, "output.particles")["default"],
            json!(["temperature"])
        );
        let required = &at(&schema, "gas.patch.NAME")["oneOf"];
        assert_eq!(required[0], json!({"required": ["inlet"]}));
        assert_eq!(required.as_array().unwrap().len(), 4);
        let moving = at(&schema, "gas.patch.NAME.wall.velocity.moving");
        assert!(moving["pattern"].is_string());
        assert_eq!(schema["additionalProperties"], false);
        assert_eq!(
            at(&schema, "gas")["dependentRequired"]["species"],
            json!(["schmidt"])
        );
    }

    #[test]
    fn every_value_of_the_table_has_a_form_of_its_own_or_a_dimension_with_a_unit() {
        for key in keys() {
            let form = YamlNode::default().form(key.value);
            let text = form.to_string();
            let quantity = form == quantity(1) || form == quantity(3);
            let dimensional = key.value.contains(", ");
            assert!(
                !quantity || dimensional,
                "{}: {} is {text}",
                key.key,
                key.value
            );
        }
    }
}
