//! Keys below a key, and what it may be, with what laws declare.

use super::key::{Key, KeyPresence, KeyValue};
use super::law_path::LawPath;
use super::of_laws;
use crate::laws::LawCatalogue;

impl Key {
    /// The keys of the table that it is, or may be.
    pub(in crate::case) fn below(&self, laws: &LawCatalogue) -> Vec<Key> {
        self.value.below(laws)
    }

    /// What the key means; with each law, where laws differ.
    pub(in crate::case) fn told(&self, laws: &LawCatalogue) -> String {
        match self.value {
            KeyValue::OfLaws(family, path) => of_laws::meaning(family, laws, path),
            _ => self.meaning.to_owned(),
        }
    }
}

/// Keys of a table with those of laws, which stand behind the law's name.
fn with_laws(keys: &[Key], laws: &LawCatalogue) -> Vec<Key> {
    let mut all = Vec::new();
    for key in keys {
        all.push(*key);
        if let KeyValue::LawName(family) = key.value {
            all.extend(of_laws::keys(family, laws, LawPath::default()));
        }
    }
    all
}

impl KeyValue {
    /// The values that it may be, one or more.
    pub(in crate::case) fn alternatives(self, laws: &LawCatalogue) -> Vec<KeyValue> {
        match self {
            KeyValue::Either(one, other) => {
                [one.alternatives(laws), other.alternatives(laws)].concat()
            }
            KeyValue::OfLaws(family, path) => of_laws::values(family, laws, path),
            one => vec![one],
        }
    }

    /// The keys of the table that it may be.
    pub(in crate::case) fn below(self, laws: &LawCatalogue) -> Vec<Key> {
        let of = |value: KeyValue| match value {
            KeyValue::Table(keys)
            | KeyValue::Tables(keys)
            | KeyValue::Dated(keys)
            | KeyValue::Named(keys) => with_laws(keys, laws),
            KeyValue::Law(family, own) => {
                let law = Key {
                    name: "law",
                    value: KeyValue::LawName(family),
                    presence: KeyPresence::Required,
                    meaning: "The law, see \"Laws\" below.",
                    example: "",
                };
                with_laws(&[&[law], own].concat(), laws)
            }
            KeyValue::LawTable(family, path) => of_laws::keys(family, laws, path),
            _ => Vec::new(),
        };
        let mut keys: Vec<Key> = Vec::new();
        for key in self.alternatives(laws).into_iter().flat_map(of) {
            // Tables of several laws have the same keys, those of all of them.
            if keys.iter().all(|one| one.name != key.name) {
                keys.push(key);
            }
        }
        keys
    }
}
