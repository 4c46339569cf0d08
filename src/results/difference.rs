//! In which keys and files the case of a run differs from the one that it is to go on with.

use std::collections::BTreeMap;
use std::path::Path;

use toml_edit::{DocumentMut, Item, Value};

use super::{CASE, ResultsError, Summary};
use crate::case::model::Case;

/// Most keys that are named.
const MOST: usize = 5;

/// A case as it is compared with that of a results folder.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CaseIdentity<'a> {
    /// Its text, with `--set` applied.
    pub(crate) effective: &'a str,
    /// Its hash.
    pub(crate) hash: &'a str,
    /// The hashes of the files that it names; `None` of a plant, of which none are kept.
    pub(crate) files: Option<&'a BTreeMap<String, String>>,
}

impl<'a> CaseIdentity<'a> {
    /// That of the case of a bed.
    pub(crate) fn of(case: &'a Case) -> Self {
        Self {
            effective: &case.effective,
            hash: &case.hash,
            files: Some(&case.files),
        }
    }
}

/// Refuses a results folder whose run is of a case with another hash.
pub(crate) fn same_case(
    results: &Path,
    stored: &str,
    case: CaseIdentity<'_>,
) -> Result<(), ResultsError> {
    if stored == case.hash {
        return Ok(());
    }
    Err(ResultsError::OtherCase {
        path: results.to_owned(),
        kept: results.join(CASE),
        differences: differences(results, stored, case),
    })
}

/// What differs between the case in a results folder and another one: keys with both values, and files of the same name that
/// hold something else; the hashes where neither says it.
pub(crate) fn differences(results: &Path, stored: &str, case: CaseIdentity<'_>) -> String {
    let CaseIdentity {
        effective,
        hash,
        files,
    } = case;
    let mut differ = keys(results, effective);
    let none = BTreeMap::new();
    let files = files.unwrap_or(&none);
    let there = Summary::read(results).map(|summary| summary.case.files);
    let there = there.unwrap_or_default();
    for name in there
        .keys()
        .chain(files.keys().filter(|name| !there.contains_key(*name)))
    {
        let what = match (there.get(name), files.get(name)) {
            (Some(before), Some(now)) if before == now => continue,
            (Some(_), Some(_)) => "holds something else than it did",
            (Some(_), None) => "is not there any more",
            // What wrote the summary may not have kept them.
            _ if there.is_empty() => continue,
            _ => "was not there",
        };
        differ.push(format!("`{name}` {what}"));
    }
    match differ.len() {
        0 => format!(
            "no key differs and no file, but the hash is {stored} there and {hash} here, as where another release of Calcine began it"
        ),
        count if count > MOST => {
            format!("{} and {} more", differ[..MOST].join(", "), count - MOST)
        }
        _ => differ.join(", "),
    }
}

/// The keys that differ, with both values.
fn keys(results: &Path, effective: &str) -> Vec<String> {
    let stored = std::fs::read_to_string(results.join(CASE)).unwrap_or_default();
    let (Some(there), Some(here)) = (flat(&stored), flat(effective)) else {
        return Vec::new();
    };
    let mut keys: Vec<&String> = there.keys().chain(here.keys()).collect();
    keys.sort();
    keys.dedup();
    let shown = |value: Option<&String>| value.map_or("nothing", String::as_str).to_owned();
    keys.into_iter()
        // The title is for people: the hash leaves it out.
        .filter(|key| *key != "title" && there.get(*key) != here.get(*key))
        .map(|key| {
            let (old, new) = (shown(there.get(key)), shown(here.get(key)));
            format!("`{key}` is {old} there and {new} here")
        })
        .collect()
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
            keys(folder.path(), here).join(", ")
        };
        let there = "[time]\nend = \"1 s\"\n[[particles]]\nname = \"a\"\nplace = { number = 3 }\n";
        assert_eq!(told(there, there), "");
        let here = there.replace("\"1 s\"", "\"2 s\"").replace('3', "4");
        assert_eq!(
            told(there, &here),
            "`particles[0].place.number` is 3 there and 4 here, `time.end` is \"1 s\" there and \"2 s\" here"
        );
        assert_eq!(told("not toml", &here), "");
        assert_eq!(told("[time]\n", "[time]\nend = 1\n"), "");
    }
}
