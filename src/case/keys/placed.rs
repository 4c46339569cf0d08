//! All keys of a case file with their places.

use super::key::{Key, KeyValue};
use super::kinds::CaseKind;
use super::law_path::{LawFamily, LawPath};
use super::of_laws;
use crate::laws::LawCatalogue;

/// A key with its dotted place.
#[derive(Clone, Debug)]
pub struct PlacedKey {
    /// Dotted place; `NAME` stands for a name that the user chooses.
    pub place: String,
    /// The key.
    pub key: Key,
    /// The laws that it belongs to; empty where it belongs to all.
    pub laws: Vec<&'static str>,
    told: String,
}

impl PlacedKey {
    /// What the key means, and of which laws it is.
    pub fn meaning(&self) -> String {
        let laws: Vec<String> = self.laws.iter().map(|law| format!("`{law}`")).collect();
        match &laws[..] {
            [] => self.told.clone(),
            laws => format!("{} Of {}.", self.told, laws.join(", ")),
        }
    }

    /// An example of its value, in TOML.
    pub fn example(&self, laws: &LawCatalogue) -> String {
        match self.key.value {
            KeyValue::LawName(family) => {
                let first = family(laws).first().map_or("none", |law| law.name);
                format!("\"{first}\"")
            }
            _ => self.key.example.to_owned(),
        }
    }
}

/// All keys of a kind of case, in the order of its file.
pub fn keys(kind: &CaseKind, laws: &LawCatalogue) -> Vec<PlacedKey> {
    let mut all = Vec::new();
    place("", kind.keys, None, laws, &mut all);
    all
}

/// Places keys of a table; those of laws are of a family, in its table at a path.
fn place(
    above: &str,
    keys: &[Key],
    family: Option<(LawFamily, LawPath)>,
    laws: &LawCatalogue,
    all: &mut Vec<PlacedKey>,
) {
    let named = keys.iter().find_map(|key| match key.value {
        KeyValue::LawName(family) => Some((family, LawPath::default())),
        _ => None,
    });
    let family = family.or(named);
    for key in keys {
        let place_of = match above {
            "" => key.name.to_owned(),
            _ => format!("{above}.{}", key.name),
        };
        let takers = family.map(|(family, path)| of_laws::takers(family, laws, path, key.name));
        all.push(PlacedKey {
            place: place_of.clone(),
            key: *key,
            laws: takers.unwrap_or_default(),
            told: key.told(laws),
        });
        let inner = match key.value.is_named() {
            true => format!("{place_of}.NAME"),
            false => place_of,
        };
        let tables = key.value.alternatives(laws);
        let below = tables.into_iter().find_map(|value| match value {
            KeyValue::LawTable(family, path) => Some((family, path)),
            _ => None,
        });
        place(&inner, &key.below(laws), below, laws, all);
    }
}
