//! JSON (RFC 8259), as much as is needed to read what our own programs and Criterion wrote.

/// A JSON value.
#[derive(Clone, Debug, PartialEq)]
pub enum Json {
    /// `null`, `true` or `false`; nobody here asks which.
    Word,
    /// A number.
    Number(f64),
    /// A string.
    Text(String),
    /// An array.
    List(Vec<Json>),
    /// An object, its keys in the order of the text.
    Table(Vec<(String, Json)>),
}

impl Json {
    /// Reads a text; `None` if it is not JSON.
    pub fn read(text: &str) -> Option<Self> {
        let mut rest = text;
        let value = value(&mut rest)?;
        rest.trim_start().is_empty().then_some(value)
    }

    /// The value below a path of keys.
    pub fn at(&self, path: &[&str]) -> Option<&Self> {
        path.iter().try_fold(self, |value, key| match value {
            Self::Table(entries) => entries
                .iter()
                .find(|(name, _)| name == key)
                .map(|(_, inner)| inner),
            _ => None,
        })
    }

    /// The number below a path of keys.
    pub fn number(&self, path: &[&str]) -> Option<f64> {
        match self.at(path)? {
            Self::Number(number) => Some(*number),
            _ => None,
        }
    }

    /// The string below a path of keys.
    pub fn text(&self, path: &[&str]) -> Option<&str> {
        match self.at(path)? {
            Self::Text(text) => Some(text),
            _ => None,
        }
    }
}

fn value(rest: &mut &str) -> Option<Json> {
    *rest = rest.trim_start();
    match rest.chars().next()? {
        '{' => table(rest),
        '[' => list(rest),
        '"' => string(rest).map(Json::Text),
        'n' | 't' | 'f' => ["null", "true", "false"]
            .into_iter()
            .find_map(|word| rest.strip_prefix(word))
            .map(|after| {
                *rest = after;
                Json::Word
            }),
        _ => {
            let end = rest.find(|c: char| !(c.is_ascii_alphanumeric() || "+-.".contains(c)));
            let (number, after) = rest.split_at(end.unwrap_or(rest.len()));
            *rest = after;
            number.parse().ok().map(Json::Number)
        }
    }
}

/// Whether this is next, which is then consumed.
fn take(rest: &mut &str, wanted: char) -> bool {
    let after = rest.trim_start().strip_prefix(wanted);
    if let Some(after) = after {
        *rest = after;
    }
    after.is_some()
}

fn list(rest: &mut &str) -> Option<Json> {
    let mut items = Vec::new();
    take(rest, '[');
    if take(rest, ']') {
        return Some(Json::List(items));
    }
    loop {
        items.push(value(rest)?);
        if take(rest, ']') {
            return Some(Json::List(items));
        }
        take(rest, ',').then_some(())?;
    }
}

fn table(rest: &mut &str) -> Option<Json> {
    let mut entries = Vec::new();
    take(rest, '{');
    if take(rest, '}') {
        return Some(Json::Table(entries));
    }
    loop {
        *rest = rest.trim_start();
        let key = string(rest)?;
        take(rest, ':').then_some(())?;
        entries.push((key, value(rest)?));
        if take(rest, '}') {
            return Some(Json::Table(entries));
        }
        take(rest, ',').then_some(())?;
    }
}

fn string(rest: &mut &str) -> Option<String> {
    let inner = rest.strip_prefix('"')?;
    let mut text = String::new();
    let mut letters = inner.char_indices();
    while let Some((place, letter)) = letters.next() {
        match letter {
            '"' => {
                *rest = &inner[place + 1..];
                return Some(text);
            }
            '\\' => match letters.next()?.1 {
                'n' => text.push('\n'),
                't' => text.push('\t'),
                'r' => text.push('\r'),
                'b' => text.push('\u{8}'),
                'f' => text.push('\u{c}'),
                'u' => {
                    let digits: String = letters.by_ref().take(4).map(|(_, c)| c).collect();
                    let code = u32::from_str_radix(&digits, 16).ok()?;
                    text.push(char::from_u32(code).unwrap_or(char::REPLACEMENT_CHARACTER));
                }
                other => text.push(other),
            },
            letter => text.push(letter),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_texts_are_found_below_their_keys() {
        let text = r#" {"mean": {"point_estimate": 4.25e-1, "list": [1, -2.5, [], {}]},
            "name": "a \"quoted\" \u00b5m\n", "band": null} "#;
        let json = Json::read(text).unwrap();
        assert_eq!(json.number(&["mean", "point_estimate"]), Some(0.425));
        assert_eq!(json.text(&["name"]), Some("a \"quoted\" µm\n"));
        assert_eq!(json.at(&["band"]), Some(&Json::Word));
        assert_eq!(json.number(&["mean", "median"]), None);
        let list = json.at(&["mean", "list"]);
        let numbers = [Json::Number(1.0), Json::Number(-2.5)];
        assert!(matches!(list, Some(Json::List(items)) if items[..2] == numbers));
    }

    #[test]
    fn what_is_not_json_is_not_read() {
        for text in ["", "{", "{\"a\" 1}", "[1,]", "{} x", "\"open", "nothing"] {
            assert_eq!(Json::read(text), None, "{text}");
        }
    }
}
