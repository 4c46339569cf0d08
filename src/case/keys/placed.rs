//! All keys of a case file with their places.

use calcine_coupler::physics::law::LawSummary;

use super::key::{Key, KeyPresence, KeyValue};
use super::root::ROOT;
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
}

impl PlacedKey {
    /// What the key means, and of which laws it is.
    pub fn meaning(&self) -> String {
        let laws: Vec<String> = self.laws.iter().map(|law| format!("`{law}`")).collect();
        match &laws[..] {
            [] => self.key.meaning.to_owned(),
            laws => format!("{} Of {}.", self.key.meaning, laws.join(", ")),
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

/// All keys in the order of a case file.
pub fn keys(laws: &LawCatalogue) -> Vec<PlacedKey> {
    let mut all = Vec::new();
    place("", ROOT, laws, &mut all);
    all
}

fn place(above: &str, keys: &[Key], laws: &LawCatalogue, all: &mut Vec<PlacedKey>) {
    for key in keys {
        let place_of = match above {
            "" => key.name.to_owned(),
            _ => format!("{above}.{}", key.name),
        };
        all.push(PlacedKey {
            place: place_of.clone(),
            key: *key,
            laws: Vec::new(),
        });
        let from = all.len();
        let inner = match key.value.is_named() {
            true => format!("{place_of}.NAME"),
            false => place_of,
        };
        place(&inner, &key.below(laws), laws, all);
        if let Some(family) = key.value.family() {
            let of = |name: &str| {
                let takes = |law: &LawSummary| law.parameters.iter().any(|one| one.name == name);
                let laws = family(laws).into_iter();
                laws.filter(takes).map(|law| law.name).collect()
            };
            // Those of a law below this one are told already.
            let own = |placed: &&mut PlacedKey| {
                matches!(placed.key.presence, KeyPresence::OfLaw(_)) && placed.laws.is_empty()
            };
            for placed in all[from..].iter_mut().filter(own) {
                placed.laws = of(placed.key.name);
            }
        }
    }
}
