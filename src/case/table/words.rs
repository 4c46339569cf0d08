//! Texts, choices between words, whole numbers; what a misspelt word may have meant.

use super::TableReader;

impl<'a> TableReader<'a> {
    /// A text.
    pub fn text(&self, key: &str) -> Option<&'a str> {
        let item = self.item(key)?;
        let text = item.as_str();
        if text.is_none() {
            self.wrong_type(key, "a text in quotes", item);
        }
        text
    }

    /// A text that must be there.
    pub fn required_text(&self, key: &str, example: &str) -> Option<&'a str> {
        if !self.has(key) {
            self.missing(key, example);
        }
        self.text(key)
    }

    /// One of several words.
    pub fn choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Option<T> {
        let text = self.text(key)?;
        let found = choices
            .iter()
            .find(|(name, _)| *name == text)
            .map(|(_, value)| *value);
        if found.is_none() {
            let names: Vec<&str> = choices.iter().map(|(name, _)| *name).collect();
            let near = nearest(text, names.iter().copied());
            let hint = near
                .map(|name| format!("; did you mean \"{name}\"?"))
                .unwrap_or_default();
            self.fail(
                key,
                format!("is \"{text}\""),
                format!("it may be {}{hint}", quoted(&names)),
            );
        }
        found
    }

    /// One of several words that must be there.
    pub fn required_choice<T: Copy>(&self, key: &str, choices: &[(&str, T)]) -> Option<T> {
        if !self.has(key) {
            let example = choices.first().map_or("", |(name, _)| name);
            self.missing(key, &format!("\"{example}\""));
        }
        self.choice(key, choices)
    }

    /// A whole number in a range.
    pub fn whole(&self, key: &str, range: std::ops::RangeInclusive<i64>) -> Option<u64> {
        let item = self.item(key)?;
        match item.as_integer() {
            Some(number) if range.contains(&number) => u64::try_from(number).ok(),
            Some(number) => {
                let rule = format!("is {number}");
                let help = format!("it must lie between {} and {}", range.start(), range.end());
                self.fail(key, rule, help);
                None
            }
            None => {
                self.wrong_type(key, "a whole number", item);
                None
            }
        }
    }

    /// `true` or `false`.
    pub fn truth(&self, key: &str) -> Option<bool> {
        let item = self.item(key)?;
        let truth = item.as_bool();
        if truth.is_none() {
            self.wrong_type(key, "true or false", item);
        }
        truth
    }

    /// Several whole numbers, at least 1 each.
    pub fn wholes<const N: usize>(&self, key: &str) -> Option<[usize; N]> {
        let Some(item) = self.item(key) else {
            self.missing(key, &format!("[{}]", vec!["10"; N].join(", ")));
            return None;
        };
        let numbers: Option<Vec<usize>> = item.as_array().and_then(|array| {
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
            self.fail(
                key,
                format!("needs {N} whole numbers of at least 1"),
                format!("for example [{}]", vec!["10"; N].join(", ")),
            );
        }
        numbers
    }

    /// A list of texts.
    pub fn texts(&self, key: &str) -> Option<Vec<String>> {
        let item = self.item(key)?;
        let texts: Option<Vec<String>> = item.as_array().and_then(|array| {
            array
                .iter()
                .map(|value| value.as_str().map(str::to_owned))
                .collect()
        });
        if texts.is_none() {
            self.wrong_type(key, "a list of texts such as [\"temperature\"]", item);
        }
        texts
    }
}

fn quoted(names: &[&str]) -> String {
    names
        .iter()
        .map(|name| format!("\"{name}\""))
        .collect::<Vec<_>>()
        .join(", ")
}

/// The nearest of several names, if it is near enough to be meant.
pub(super) fn nearest<'n>(word: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let limit = 1 + word.chars().count() / 4;
    names
        .map(|name| (strsim::levenshtein(word, name), name))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, name)| name)
}
