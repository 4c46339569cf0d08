//! `--set KEY=VALUE`: changes of a case file on the command line.

use std::path::Path;

use toml_edit::{DocumentMut, Item, Value};

use super::problem::CaseErrors;
use super::syntax::{one, syntax};
use super::table;

/// What one `--set` changed.
pub(super) struct Change {
    /// The key, entries of lists by their numbers.
    pub key: String,
    /// Its value.
    new: String,
    /// The value that it had, if it had one.
    old: Option<String>,
}

impl Change {
    fn of(key: String, old: &Item, new: &Value) -> Self {
        let old = match old {
            // A step down to a key that is not there makes an empty one.
            Item::None => None,
            Item::Value(Value::InlineTable(table)) if table.is_empty() => None,
            Item::Value(value) => Some(written(value)),
            Item::Table(_) | Item::ArrayOfTables(_) => Some("what the file says".into()),
        };
        Self {
            key,
            new: written(new),
            old,
        }
    }

    /// The change in words.
    pub fn line(&self) -> String {
        let Self { key, new, old } = self;
        match old {
            Some(old) => format!("{key} = {new} in place of {old}"),
            None => format!("{key} = {new}, which the file does not state"),
        }
    }
}

/// Steps down from the whole case to any key.
const DEEPEST: usize = 32;

/// The text with `--set` applied, in which lines stay where they are unless a key is new, and what each changed.
pub(super) fn apply(
    path: &Path,
    text: &str,
    set: &[String],
) -> Result<(String, Vec<Change>), CaseErrors> {
    if set.is_empty() {
        return Ok((text.to_owned(), Vec::new()));
    }
    let mut changes = Vec::new();
    syntax(path, text)?;
    let mut document: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| {
        one(path, text, 0..0, error.to_string(), "see toml.io")
    })?;
    for setting in set {
        let wrong = |why: &str, help: &str| {
            let message = format!("`--set {setting}`: {why}");
            one(path, text, 0..0, message, help)
        };
        let (key, value) = setting.split_once('=').ok_or_else(|| {
            let help = "write it as --set time.acceleration=200";
            wrong("there is no `=`", help)
        })?;
        let value = value.trim();
        // A bare text such as 10 s or native needs no quotes on the command line.
        let value: Value = value.parse().unwrap_or_else(|_| value.into());
        let parts = parts(key.trim());
        if parts.len() > DEEPEST {
            return Err(wrong(
                "no key lies so deep",
                "see `calcine schema` for the keys of a case",
            ));
        }
        let mut item: &mut Item = document.as_item_mut();
        let mut place = String::new();
        for part in parts {
            let help = remedy(item, &place, part);
            if let Some(index) = entry(item, part) {
                place.push_str(&format!("[{index}]"));
            } else {
                place = table::dotted(&place, part);
            }
            item = step(item, part)
                .ok_or_else(|| wrong(&format!("there is no `{part}` to change"), &help))?;
        }
        let is_entry = place.ends_with(']');
        if is_entry && item.is_table_like() && !value.is_inline_table() {
            let why = format!(
                "`{place}` is a table, and {} cannot take its place",
                value.type_name()
            );
            let help = format!("write {key}={{ … }}, or change one of its keys: {key}.KEY=VALUE");
            return Err(wrong(&why, &help));
        }
        changes.push(Change::of(place, item, &value));
        replace(item, value);
    }
    Ok((document.to_string(), changes))
}

/// The line in the file, from 1, of each line of the text with `--set` applied: of a line that is new, that of the one before.
pub(super) fn lines(file: &str, effective: &str) -> Vec<usize> {
    let [old, new] = [file, effective].map(|text| text.lines().collect::<Vec<_>>());
    let mut lines = Vec::with_capacity(new.len());
    let mut pairs = common(&old, &new);
    pairs.push((old.len(), new.len()));
    // Numbers of the lines up to the last one that both have.
    let mut known = 0;
    for (own, place) in pairs {
        // Lines that were changed in place keep their numbers.
        let changed = (known + 1..=own).map(Some).chain(std::iter::repeat(None));
        for number in changed.take(place - lines.len()) {
            lines.push(number.unwrap_or(lines.last().copied().unwrap_or(1)));
        }
        if own < old.len() {
            lines.push(own + 1);
        }
        known = own + 1;
    }
    lines
}

/// Most pairs of lines that are compared; of longer texts only what is the same at both ends is found.
const MOST_PAIRS: usize = 1 << 22;

/// Places of a longest common subsequence of two lists of lines, in their order.
fn common(old: &[&str], new: &[&str]) -> Vec<(usize, usize)> {
    let head = old.iter().zip(new).take_while(|(a, b)| a == b).count();
    let (inner_old, inner_new) = (&old[head..], &new[head..]);
    let ends = inner_old.iter().rev().zip(inner_new.iter().rev());
    let tail = ends.take_while(|(a, b)| a == b).count();
    let inner_old = &inner_old[..inner_old.len() - tail];
    let inner_new = &inner_new[..inner_new.len() - tail];
    let (rows, columns) = (inner_old.len(), inner_new.len());
    let mut pairs: Vec<(usize, usize)> = (0..head).map(|k| (k, k)).collect();
    if rows * columns <= MOST_PAIRS {
        let width = columns + 1;
        // Length of the longest one of what lies behind each pair.
        let mut longest = vec![0u32; (rows + 1) * width];
        for (i, a) in inner_old.iter().enumerate().rev() {
            for (j, b) in inner_new.iter().enumerate().rev() {
                let at = i * width + j;
                longest[at] = match a == b {
                    true => longest[at + width + 1] + 1,
                    false => longest[at + width].max(longest[at + 1]),
                };
            }
        }
        let (mut i, mut j) = (0, 0);
        while i < rows && j < columns {
            let at = i * width + j;
            if inner_old[i] == inner_new[j] {
                pairs.push((head + i, head + j));
                (i, j) = (i + 1, j + 1);
            } else if longest[at + width] >= longest[at + 1] {
                i += 1;
            } else {
                j += 1;
            }
        }
    }
    pairs.extend((0..tail).map(|k| (old.len() - tail + k, new.len() - tail + k)));
    pairs
}

/// The names of a dotted key; one in quotes may have dots of its own, as in `parameters."one.activation_energy".low`.
fn parts(key: &str) -> Vec<&str> {
    let mut quote = None;
    let dots = key.split(|letter: char| {
        match quote {
            Some(open) if open == letter => quote = None,
            None if letter == '"' || letter == '\'' => quote = Some(letter),
            _ => {}
        }
        letter == '.' && quote.is_none()
    });
    let within =
        |part: &'_ str, mark: char| part.strip_prefix(mark)?.strip_suffix(mark).map(str::len);
    dots.map(
        |part| match within(part, '"').or_else(|| within(part, '\'')) {
            Some(length) => &part[1..=length],
            None => part,
        },
    )
    .collect()
}

/// A value without the space and the comments about it.
fn written(value: &Value) -> String {
    let mut bare = value.clone();
    bare.decor_mut().clear();
    bare.to_string()
}

/// One step down a dotted key; `name[2]` steps into a list, and so does the name of one of its entries.
fn step<'i>(item: &'i mut Item, part: &str) -> Option<&'i mut Item> {
    if let Some(index) = entry(item, part) {
        return item.get_mut(index);
    }
    let (name, index) = match part.strip_suffix(']').and_then(|part| part.split_once('[')) {
        Some((name, index)) => (name, Some(index.parse::<usize>().ok()?)),
        None => (part, None),
    };
    if name.is_empty() {
        return None;
    }
    let table = item.as_table_like_mut()?;
    if index.is_some() && !table.contains_key(name) {
        return None;
    }
    let below = table.entry(name).or_insert(Item::None);
    match index {
        None if below.is_none() => {
            *below = Item::Value(Value::InlineTable(toml_edit::InlineTable::new()));
            Some(below)
        }
        None => Some(below),
        Some(index) => below.get_mut(index),
    }
}

/// The entry of a list that has this name.
fn entry(list: &Item, name: &str) -> Option<usize> {
    let named = |own: Option<&str>| own == Some(name);
    if let Some(tables) = list.as_array_of_tables() {
        let mut tables = tables.iter();
        return tables.position(|one| named(one.get("name").and_then(Item::as_str)));
    }
    let mut values = list.as_array()?.iter();
    values.position(|one| {
        let table = one.as_inline_table();
        named(
            table
                .and_then(|table| table.get("name"))
                .and_then(Value::as_str),
        )
    })
}

/// What a part of a key may be in place of one that is not there: the entries of a list.
fn remedy(item: &Item, place: &str, part: &str) -> String {
    let list = part.split_once('[').map(|(name, _)| name);
    let list = list.and_then(|name| Some((name, item.get(name)?)));
    let (key, list) = match list {
        Some((name, list)) => (table::dotted(place, name), list),
        None => (place.to_owned(), item),
    };
    let count = match (list.as_array_of_tables(), list.as_array()) {
        (Some(tables), _) => tables.len(),
        (None, Some(values)) => values.len(),
        (None, None) => return "write it as --set time.acceleration=200".into(),
    };
    match count {
        0 => format!("`{key}` is an empty list"),
        1 => format!("`{key}` is a list of one: name it, or write {key}[0]"),
        _ => format!(
            "`{key}` is a list: name one of its entries, or write {key}[0] to {key}[{}]",
            count - 1
        ),
    }
}

/// Puts a value in the place of an item. A table stays one, where it is in the file, so that an entry of a list stays in its list.
fn replace(item: &mut Item, value: Value) {
    *item = match (item.as_table(), value) {
        (Some(old), Value::InlineTable(new)) => {
            let mut table = new.into_table();
            table.set_position(old.position());
            Item::Table(table)
        }
        (_, value) => Item::Value(value),
    };
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::{apply, lines, parts};

    #[test]
    fn lines_of_the_file_keep_their_numbers_where_set_adds_some() {
        let text = "[a]\nx = 1\n[b]\ny = [\n1,\n2]\nz = 3\n";
        let of = |set: &[&str]| {
            let set: Vec<String> = set.iter().map(|&one| one.to_owned()).collect();
            lines(text, &apply(Path::new("case.toml"), text, &set).unwrap().0)
        };
        assert_eq!(of(&[]), [1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(of(&["a.x=2", "b.z=4"]), [1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(of(&["a.new=2"]), [1, 2, 2, 3, 4, 5, 6, 7]);
        assert_eq!(of(&["a.new=2", "a.other=2"]), [1, 2, 2, 2, 3, 4, 5, 6, 7]);
        assert_eq!(of(&["b.y=4"]), [1, 2, 3, 4, 7]);
        assert_eq!(of(&["a.new=2", "b.y=4"]), [1, 2, 2, 3, 4, 7]);
    }

    #[test]
    fn a_list_of_tables_that_becomes_a_value_at_the_top_leaves_the_lines_between() {
        let text = "format = 1\n[time]\nend = 1\n[[particles]]\nx = 1\n[gas]\ny = 1\n";
        let set = vec!["particles=[{ x = 2 }]".to_owned()];
        let (changed, _) = apply(Path::new("case.toml"), text, &set).unwrap();
        let lines = lines(text, &changed);
        for (line, number) in changed.lines().zip(&lines) {
            let place = text.lines().position(|own| own == line);
            assert!(
                place.is_none_or(|place| place + 1 == *number),
                "{changed} {lines:?}"
            );
        }
        assert_eq!(lines.len(), changed.lines().count());
    }

    #[test]
    fn dots_between_quotes_part_no_names() {
        assert_eq!(parts("time.end"), ["time", "end"]);
        let low = r#"parameters."one.activation_energy".low"#;
        assert_eq!(parts(low), ["parameters", "one.activation_energy", "low"]);
        let single = low.replace('"', "'");
        assert_eq!(parts(&single), parts(low));
        assert_eq!(parts("a.\"b"), ["a", "\"b"]);
    }
}
