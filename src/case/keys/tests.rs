//! The table of keys is what the reader asks for, and what the page says.

use std::collections::BTreeSet;
use std::path::Path;

use super::*;
use crate::case::table::{Problems, TableReader};

#[test]
fn the_table_holds_exactly_the_keys_that_the_reader_asks_for() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut asked = BTreeSet::new();
    for folder in ["cases", "tests/inputs/good"] {
        for entry in std::fs::read_dir(root.join(folder)).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let document = toml_edit::Document::parse(text.as_str()).unwrap();
            let problems = Problems::default();
            let reader = TableReader::root(&problems, document.as_table());
            crate::case::sections::case(&reader, &path, &text, String::new());
            asked.append(&mut problems.asked());
        }
    }
    let known: BTreeSet<String> = KEYS.iter().map(|key| key.key.to_owned()).collect();
    assert_eq!(known.len(), KEYS.len(), "a key stands twice");
    let missing: Vec<_> = asked.difference(&known).collect();
    let never: Vec<_> = known.difference(&asked).collect();
    assert!(missing.is_empty(), "not in the table: {missing:?}");
    assert!(never.is_empty(), "the reader never asks for: {never:?}");
}

#[test]
fn every_example_is_toml() {
    for key in KEYS
        .iter()
        .filter(|key| !key.example.starts_with("[[") || key.example.contains('"'))
    {
        let text = if key.value == "table" && key.example.starts_with('[') {
            key.example.to_owned()
        } else {
            format!("x = {}", key.example)
        };
        assert!(toml_edit::Document::parse(text.as_str()).is_ok(), "{text}");
    }
}

#[test]
fn the_page_of_the_docs_is_made_from_the_table() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/case-file.md");
    let mut written = std::fs::read_to_string(&page).unwrap();
    let begin = written.find(BEGIN).unwrap_or(written.len());
    if std::env::var_os("CALCINE_WRITE_DOCS").is_some() {
        let prose = written[..begin].trim_end();
        std::fs::write(&page, format!("{prose}\n\n{}", markdown())).unwrap();
        written = std::fs::read_to_string(&page).unwrap();
    }
    let begin = written.find(BEGIN).unwrap_or(written.len());
    assert_eq!(
        &written[begin..],
        markdown(),
        "set CALCINE_WRITE_DOCS=1 and run this test again to write docs/case-file.md"
    );
}
