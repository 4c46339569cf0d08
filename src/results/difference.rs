//! In which keys the case of a run differs from the one that it is to go on with.

use std::collections::BTreeMap;
use std::path::Path;

use toml_edit::{DocumentMut, Item, Value};

use super::CASE;

/// Most keys that are named.
const MOST: usize = 5;

/// The keys that differ between the case in a results folder and another one, with both values, as the end of a sentence;
/// empty where they are not known.
pub(crate) fn difference(results: &Path, effective: &str) -> String {
    let stored = std::fs::read_to_string(results.join(CASE)).unwrap_or_default();
    let (Some(there), Some(here)) = (flat(&stored), flat(effective)) else {
        return String::new();
    };
    let mut keys: Vec<&String> = there.keys().chain(here.keys()).collect();
    keys.sort();
    keys.dedup();
    let shown = |value: Option<&String>| value.map_or("nothing", String::as_str).to_owned();
    let differ: Vec<String> = keys
        .into_iter()
        .filter(|key| there.get(*key) != here.get(*key))
        .map(|key| {
            let (old, new) = (shown(there.get(key)), shown(here.get(key)));
            format!("`{key}` is {old} there and {new} here")
        })
        .collect();
    match differ.len() {
        0 => String::new(),
        count if count > MOST => {
            format!(": {} and {} more", differ[..MOST].join(", "), count - MOST)
        }
        _ => format!(": {}", differ.join(", ")),
    }
}

/// Values by their dotted keys; `None` where the text is no TOML.
fn flat(text: &str) -> Option<BTreeMap<String, String>> {
    let document: DocumentMut = text.parse().ok()?;
    let mut all = BTreeMap::new();
    for (key, item) in document.iter() {
        add(key.to_owned(), item, &mut all);
    }
    (!all.is_empty()).then_some(all)
}

fn add(place: String, item: &Item, all: &mut BTreeMap<String, String>) {
    if let Some(table) = item.as_table_like() {
        for (key, item) in table.iter() {
            add(format!("{place}.{key}"), item, all);
        }
    } else if let Some(list) = item.as_array_of_tables() {
        for (index, table) in list.iter().enumerate() {
            for (key, item) in table.iter() {
                add(format!("{place}[{index}].{key}"), item, all);
            }
        }
    } else if let Some(value) = item.as_value() {
        let tables = value.as_array().filter(|list| {
            let mut entries = list.iter();
            !list.is_empty() && entries.all(Value::is_inline_table)
        });
        let Some(list) = tables else {
            all.insert(place, value.to_string().trim().to_owned());
            return;
        };
        for (index, table) in list.iter().enumerate() {
            let item = Item::Value(table.clone());
            add(format!("{place}[{index}]"), &item, all);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_that_differ_are_named_with_both_values() {
        let folder = tempfile::tempdir().unwrap();
        let told = |there: &str, here: &str| {
            std::fs::write(folder.path().join(CASE), there).unwrap();
            difference(folder.path(), here)
        };
        let there = "[time]\nend = \"1 s\"\n[[particles]]\nname = \"a\"\nplace = { number = 3 }\n";
        assert_eq!(told(there, there), "");
        let here = there.replace("\"1 s\"", "\"2 s\"").replace('3', "4");
        assert_eq!(
            told(there, &here),
            ": `particles[0].place.number` is 3 there and 4 here, `time.end` is \"1 s\" there and \"2 s\" here"
        );
        assert_eq!(told("not toml", &here), "");
        assert_eq!(told("[time]\n", "[time]\nend = 1\n"), "");
    }
}
