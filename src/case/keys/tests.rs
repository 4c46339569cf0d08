//! The table of keys is what the reader asks for, and what the page says.

use std::collections::BTreeSet;
use std::path::Path;

use super::*;
use crate::case::table::{Problems, TableReader};
use crate::laws::LawCatalogue;

/// Reads a case of a kind for the keys that its reader asks for.
fn ask(kind: &CaseKind, root: &TableReader<'_>, path: &Path, text: &str) {
    root.has("kind");
    match kind.name {
        "bed" => {
            crate::case::sections::case(root, path, text, String::new());
        }
        "tuning" => {
            crate::case::sections::tuning::tuning(root, path, text, String::new());
        }
        "flowsheet" => {
            let given = crate::case::plant::Given {
                beds_in: path.parent(),
                idle_windows: false,
            };
            crate::case::plant::plant(root, path, text, String::new(), given);
        }
        other => panic!("which reader takes a case of kind \"{other}\"?"),
    }
}

#[test]
fn the_keys_that_are_declared_are_exactly_those_that_the_reader_asks_for() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let laws = LawCatalogue::default();
    for kind in KINDS {
        let mut asked = BTreeSet::new();
        for folder in ["cases", "tests/inputs/good", "tests/inputs/plants/good"] {
            for entry in std::fs::read_dir(root.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_none_or(|extension| extension != "toml") {
                    continue;
                }
                let text = std::fs::read_to_string(&path).unwrap();
                if crate::case::kind_of_text(&path, &text, &[]).unwrap().name != kind.name {
                    continue;
                }
                let document = toml_edit::Document::parse(text.as_str()).unwrap();
                let problems = Problems::default();
                let reader = TableReader::root(&problems, kind, &laws, document.as_table());
                ask(kind, &reader, &path, &text);
                asked.append(&mut problems.asked());
            }
        }
        let all = keys(kind, &laws);
        let known: BTreeSet<String> = all.iter().map(|key| key.place.clone()).collect();
        assert_eq!(known.len(), all.len(), "a key is declared twice");
        let missing: Vec<_> = asked.difference(&known).collect();
        let never: Vec<_> = known.difference(&asked).collect();
        let name = kind.name;
        assert!(missing.is_empty(), "{name}: not declared: {missing:?}");
        assert!(never.is_empty(), "{name}: never asked for: {never:?}");
    }
}

#[test]
fn every_example_is_toml_and_every_default_a_value_of_its_key() {
    let laws = LawCatalogue::default();
    for placed in KINDS.iter().flat_map(|kind| keys(kind, &laws)) {
        let example = placed.example(&laws);
        let heading = example.starts_with('[') && !example.contains(['"', ',', '{']);
        let text = match heading {
            true => example,
            false => format!("x = {example}"),
        };
        assert!(toml_edit::Document::parse(text.as_str()).is_ok(), "{text}");
        let KeyPresence::Default(text) = placed.key.presence else {
            continue;
        };
        let sound = allows(placed.key.value, text, &laws);
        assert!(sound, "{}: {text}", placed.place);
    }
}

/// Whether a text is a value of a key.
fn allows(value: KeyValue, text: &str, laws: &LawCatalogue) -> bool {
    match value {
        KeyValue::Number(dimension, bound) => crate::case::units::quantities(text)
            .is_ok_and(|found| found.1 == dimension && bound.holds(found.0[0])),
        KeyValue::Vector(dimension) => crate::case::units::quantities(text)
            .is_ok_and(|found| found.1 == dimension && found.0.len() == 3),
        KeyValue::Schedule(..) => parse_number(text).is_some(),
        KeyValue::Whole(least, most) => text.parse().is_ok_and(|n| (least..=most).contains(&n)),
        KeyValue::Truth => ["true", "false"].contains(&text),
        KeyValue::Either(one, other) => allows(*one, text, laws) || allows(*other, text, laws),
        value => {
            let forms = value.alternatives(laws).into_iter();
            let mut words = forms.flat_map(|one| one.choices(laws));
            words.any(|word| word == text)
        }
    }
}

#[test]
fn the_page_of_the_docs_is_made_from_the_table() {
    for kind in KINDS {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join(kind.page);
        let mut written = std::fs::read_to_string(&page).unwrap();
        let begin = written.find(BEGIN).unwrap_or(written.len());
        if std::env::var_os("CALCINE_WRITE_DOCS").is_some() {
            let prose = written[..begin].trim_end();
            std::fs::write(&page, format!("{prose}\n\n{}", markdown(kind))).unwrap();
            written = std::fs::read_to_string(&page).unwrap();
        }
        let begin = written.find(BEGIN).unwrap_or(written.len());
        assert_eq!(
            &written[begin..],
            markdown(kind),
            "set CALCINE_WRITE_DOCS=1 and run this test again to write {}",
            kind.page
        );
    }
}
