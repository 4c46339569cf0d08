//! Texts, choices between words, whole numbers.

use super::nearest::nearest;
use super::{KeyPresence, KeyValue, TableReader};
use crate::case::words::CaseWord;

impl<'a> TableReader<'a> {
    /// A text, or a path.
    pub fn text(&self, key: &str) -> Option<&'a str> {
        let (declared, ()) = self.declared_as(key, |value| match value {
            KeyValue::Text | KeyValue::Path | KeyValue::Band => Some(()),
            _ => None,
        })?;
        let item = self.item_of(&declared)?;
        let text = item.as_str();
        if text.is_none() {
            self.wrong_type(key, "a text in quotes", item);
        }
        text
    }

    /// One of several words.
    pub fn choice<T: CaseWord>(&self, key: &str) -> Option<T> {
        let (declared, words) = self.declared_as(key, |value| match value {
            KeyValue::Choice(words) => Some(words()),
            _ => None,
        })?;
        debug_assert!(
            words.iter().eq(T::ALL.iter().map(|(word, _)| word)),
            "{key}"
        );
        let word = match (self.item_of(&declared), declared.presence) {
            (None, KeyPresence::Default(word)) => word,
            (None, _) => return None,
            (Some(_), _) => self.word(key, &words)?,
        };
        let found = T::ALL.iter().find(|(name, _)| *name == word);
        found.map(|(_, value)| *value)
    }

    /// One of these words, as it stands in the file.
    pub(super) fn word(&self, key: &str, names: &[&str]) -> Option<&'a str> {
        let item = self.item_of(&self.declared(key)?)?;
        let Some(text) = item.as_str() else {
            let declared = self.declared(key)?;
            let tables = declared.value.alternatives(self.laws);
            let keys = tables.iter().find_map(|one| match one {
                KeyValue::Table(keys) => Some(keys.iter().take(2)),
                _ => None,
            });
            let needs = match keys {
                Some(keys) => {
                    let keys = keys.map(|key| format!("{} = {}", key.name, key.example));
                    let keys: Vec<String> = keys.collect();
                    format!(
                        "{} or a table such as {{ {} }}",
                        quoted(names),
                        keys.join(", ")
                    )
                }
                None => format!("one of {}", quoted(names)),
            };
            self.wrong_type(key, &needs, item);
            return None;
        };
        if names.contains(&text) {
            return Some(text);
        }
        let near = nearest(text, names.iter().copied());
        let hint = near
            .map(|name| format!("; did you mean \"{name}\"?"))
            .unwrap_or_default();
        let help = format!("it may be {}{hint}", quoted(names));
        self.refuse(key, format!("is \"{text}\""), help);
        None
    }

    /// A list of words.
    pub fn choices(&self, key: &str) -> Option<Vec<String>> {
        let (declared, words) = self.declared_as(key, |value| match value {
            KeyValue::Choices(words) => Some(words),
            _ => None,
        })?;
        if self.item_of(&declared).is_none() {
            let KeyPresence::Default(word) = declared.presence else {
                return None;
            };
            return Some(vec![word.to_owned()]);
        }
        let found = self.list_of_texts(key)?;
        for name in found.iter().filter(|name| !words.contains(&name.as_str())) {
            let near = nearest(name, words.iter().copied());
            let hint = near
                .map(|name| format!("; did you mean \"{name}\"?"))
                .unwrap_or_default();
            let help = format!("known are {}{hint}", words.join(", "));
            self.refuse(key, format!("names \"{name}\""), help);
        }
        Some(found)
    }

    /// A whole number.
    pub fn whole(&self, key: &str) -> Option<u64> {
        let (declared, (least, most)) = self.declared_as(key, |value| match value {
            KeyValue::Whole(least, most) => Some((least, most)),
            _ => None,
        })?;
        let Some(item) = self.item_of(&declared) else {
            return match declared.presence {
                KeyPresence::Default(number) => number.parse().ok(),
                _ => None,
            };
        };
        match item.as_integer() {
            Some(number) if (least..=most).contains(&number) => u64::try_from(number).ok(),
            Some(number) => {
                let help = format!("it must lie between {least} and {most}");
                self.refuse(key, format!("is {number}"), help);
                None
            }
            None => {
                self.wrong_type(key, "a whole number", item);
                None
            }
        }
    }

    /// A whole number of 32 bits.
    pub fn small_whole(&self, key: &str) -> Option<u32> {
        self.whole(key)
            .and_then(|number| u32::try_from(number).ok())
    }

    /// `true` or `false`.
    pub fn truth(&self, key: &str) -> Option<bool> {
        let (declared, ()) =
            self.declared_as(key, |value| matches!(value, KeyValue::Truth).then_some(()))?;
        let Some(item) = self.item_of(&declared) else {
            return match declared.presence {
                KeyPresence::Default(word) => Some(word == "true"),
                _ => None,
            };
        };
        let truth = item.as_bool();
        if truth.is_none() {
            self.wrong_type(key, "true or false", item);
        }
        truth
    }

    /// Several whole numbers, at least 1 each.
    pub fn wholes<const N: usize>(&self, key: &str) -> Option<[usize; N]> {
        let (declared, ()) = self.declared_as(key, |value| match value {
            KeyValue::Wholes(count) => (count == N).then_some(()),
            _ => None,
        })?;
        let numbers: Option<Vec<usize>> = self.item_of(&declared)?.as_array().and_then(|array| {
            array
                .iter()
                .map(|value| {
                    value
                        .as_integer()
                        .and_then(|n| usize::try_from(n).ok())
                        .filter(|n| (1..=1 << 32).contains(n))
                })
                .collect()
        });
        let numbers = numbers.and_then(|numbers| <[usize; N]>::try_from(numbers).ok());
        if numbers.is_none() {
            self.unread(
                key,
                format!("needs {N} whole numbers of at least 1"),
                format!("for example {}", declared.example),
            );
        }
        numbers
    }

    /// A list of texts.
    pub fn texts(&self, key: &str) -> Option<Vec<String>> {
        let (declared, ()) = self.declared_as(key, |value| match value {
            KeyValue::Texts(_) | KeyValue::Vectors(_) => Some(()),
            _ => None,
        })?;
        self.item_of(&declared)?;
        self.list_of_texts(key)
    }

    fn list_of_texts(&self, key: &str) -> Option<Vec<String>> {
        let declared = self.declared(key)?;
        let item = self.item(key)?;
        let texts: Option<Vec<String>> = item.as_array().and_then(|array| {
            array
                .iter()
                .map(|value| value.as_str().map(str::to_owned))
                .collect()
        });
        if texts.is_none() {
            let needs = format!("a list of texts such as {}", declared.example);
            self.wrong_type(key, &needs, item);
        }
        texts
    }
}

pub(super) fn quoted(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ")
}
