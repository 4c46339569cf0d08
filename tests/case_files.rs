//! Case files: the good ones read; the bad ones give exactly the messages that they hold, each
//! under its line as `#^ message`, all at once and each with a remedy.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::fs;
use std::path::{Path, PathBuf};

use calcine::case::keys::KINDS;
use calcine::case::{kind_of, parse, read};
use calcine::laws::LawCatalogue;
use proptest::prelude::*;

/// Cases of beds in a folder.
fn files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut found: Vec<PathBuf> = fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "toml")
        })
        .filter(|path| kind(path) == "bed")
        .collect();
    found.sort();
    found
}

/// The kind of a case; errors of beds are those of a case whose kind is wrong.
fn kind(path: &Path) -> &'static str {
    kind_of(path, &[]).map_or("bed", |kind| kind.name)
}

/// (line, message) of each `#^`, which stands under its line or under another `#^`.
fn expected(text: &str) -> Vec<(usize, String)> {
    let (mut line, mut found) = (0, Vec::new());
    for (number, content) in (1..).zip(text.lines()) {
        match content.trim_start().strip_prefix("#^ ") {
            Some(message) => found.push((line, message.to_owned())),
            None => line = number,
        }
    }
    found
}

#[test]
fn every_good_case_is_read() {
    let all = [
        files("cases"),
        files("cases/full-size"),
        files("tests/inputs/good"),
    ]
    .concat();
    assert!(all.len() >= 35, "{all:?}");
    for path in all {
        if let Err(errors) = read(&path, &[]) {
            panic!("{errors}");
        }
    }
}

#[test]
fn every_bad_case_gives_its_messages_all_at_once_each_with_a_remedy() {
    let all = files("tests/inputs/bad");
    assert!(all.len() >= 25, "{} bad cases", all.len());
    for path in all {
        let text = fs::read_to_string(&path).unwrap();
        let wanted = expected(&text);
        assert!(!wanted.is_empty(), "{} holds no message", path.display());
        let errors = match read(&path, &[]) {
            Ok(_) => panic!("{} was read without an error", path.display()),
            Err(errors) => errors,
        };
        let mut found: Vec<(usize, String)> = errors
            .problems()
            .iter()
            .map(|problem| (problem.line, problem.message.clone()))
            .collect();
        let mut wanted = wanted;
        found.sort();
        wanted.sort();
        assert_eq!(found, wanted, "{}", path.display());
        for problem in errors.problems() {
            assert!(
                !problem.help.is_empty(),
                "{}: {}",
                path.display(),
                problem.message
            );
        }
        let shown = errors.render();
        assert_eq!(
            shown.matches("help:").count(),
            errors.problems().len(),
            "{shown}"
        );
    }
}

#[test]
fn set_changes_values_and_refuses_what_it_does_not_know() {
    let path = &Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-bed.toml");
    let set = |text: &str| read(path, &[text.to_owned()]);
    let case = set("time.end=3 s").unwrap();
    assert_eq!(case.time.end.seconds(), 3.0);
    assert_eq!(
        set("time.acceleration=7")
            .unwrap()
            .time
            .acceleration
            .largest(),
        7.0
    );
    let changed = set("particles[0].diameter=9 mm").unwrap();
    assert!((changed.particles[0].sizes.largest() - 9e-3).abs() < 1e-17);
    assert_ne!(case.hash, read(path, &[]).unwrap().hash);
    let named = set("particles.beads.diameter=9 mm").unwrap();
    assert_eq!(named.hash, changed.hash);
    let stranger = set("particles.strangers.diameter=1 mm").unwrap_err();
    let help = &stranger.problems()[0].help;
    assert!(help.contains("write particles[0]"), "{help}");
    for wrong in [
        "time.ent=3 s",
        "time.end",
        "particles[7].diameter=1 mm",
        "particles.beads.diameter=-1 mm",
        "particles.strangers.diameter=1 mm",
        "time.end.x=1",
        "tme.end=1 s",
        "time.end=-1 s",
        "=",
        ".",
    ] {
        let errors = set(wrong).unwrap_err();
        assert!(!errors.problems().is_empty(), "{wrong}");
        for problem in errors.problems() {
            assert!(
                problem.message.starts_with(&format!("`--set {wrong}`: ")),
                "{}",
                problem.message
            );
        }
    }
}

#[test]
fn set_replaces_an_entry_of_a_list_and_refuses_what_is_no_table() {
    let path = &Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/settled-bed.toml");
    let set = |text: &str| read(path, &[text.to_owned()]);
    let (plain, place) = (read(path, &[]).unwrap(), plain_entries(path));
    for (list, count, index) in place {
        // An entry in its own place changes nothing, wherever its list is.
        let text = format!("{list}[{index}]={}", entry(path, &list, index));
        let again = set(&text).unwrap_or_else(|error| panic!("{text}: {error}"));
        assert_eq!(again.hash, plain.hash, "{text}");
        for wrong in ["3", "\"text\"", "[]"] {
            let text = format!("{list}[{index}]={wrong}");
            let error = set(&text).unwrap_err();
            let message = &error.problems()[0].message;
            let told = format!("`--set {text}`: `{list}[{index}]` is a table, and ");
            assert!(message.starts_with(&told), "{message}");
        }
        let beyond = format!("{list}[{count}]={{}}");
        let error = set(&beyond).unwrap_err();
        let help = &error.problems()[0].help;
        assert!(
            help.starts_with(&format!("`{list}` is a list")),
            "{beyond}: {help}"
        );
    }
    let changed = set("time.end=0.2 s").unwrap().changes;
    assert_eq!(changed, ["time.end = \"0.2 s\" in place of \"0.4 s\""]);
    let new = set("time.acceleration=1").unwrap().changes;
    assert_eq!(
        new,
        ["time.acceleration = 1, which the file does not state"]
    );
    // Less than an entry needs is told of the entry, which is not dropped.
    let error = set("walls[0]={ name = \"floor\" }").unwrap_err();
    let message = &error.problems()[0].message;
    assert!(message.contains("`walls[0]"), "{message}");
}

#[test]
fn errors_have_the_lines_of_the_file_where_set_adds_keys() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-column.toml");
    let text = fs::read_to_string(&path).unwrap();
    let spoilt = text.replace("diameter = \"10 mm\"", "diameter = \"-5 mm\"");
    let line = 1 + spoilt
        .lines()
        .position(|line| line.contains("-5 mm"))
        .unwrap();
    for settings in [&[][..], &["time.checkpoint={ every = \"5 s\" }".to_owned()]] {
        let errors = parse(&path, &spoilt, settings).unwrap_err();
        assert_eq!(errors.problems()[0].line, line, "{settings:?}");
        let shown = errors.render();
        assert!(shown.contains(&format!("column.toml:{line}:")), "{shown}");
        assert!(shown.contains(&format!("{line} │ diameter = ")), "{shown}");
    }
}

/// Each entry of the lists at the top of a case: the list, its length and the entry's place.
fn plain_entries(path: &Path) -> Vec<(String, usize, usize)> {
    let text = std::fs::read_to_string(path).unwrap();
    let document: toml_edit::DocumentMut = text.parse().unwrap();
    let lists = document.iter().filter_map(|(name, item)| {
        let count = item.as_array_of_tables()?.len();
        Some((name.to_owned(), count))
    });
    lists
        .flat_map(|(name, count)| (0..count).map(move |index| (name.clone(), count, index)))
        .collect()
}

/// An entry as it is written on one line.
fn entry(path: &Path, list: &str, index: usize) -> String {
    let text = std::fs::read_to_string(path).unwrap();
    let document: toml_edit::DocumentMut = text.parse().unwrap();
    let table = document[list].as_array_of_tables().unwrap().get(index);
    let mut inline = table.unwrap().clone().into_inline_table();
    inline.fmt();
    inline.to_string()
}

#[test]
fn eddies_and_the_stirred_reactor_have_their_documented_numbers_where_a_case_has_none() {
    use calcine_coupler::gas_chemistry::Combustion;
    use calcine_coupler::setup::Turbulence;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = &folder.join("tests/inputs/good/gas-mechanism.toml");
    let text = fs::read_to_string(path).unwrap();
    let without = text.replace("mixing_constant = 0.5\n", "");
    assert!(without.len() < text.len() && !text.contains("prandtl"));
    let gas = parse(path, &without, &[]).unwrap().gas;
    let Turbulence::KEpsilon {
        prandtl, schmidt, ..
    } = gas.turbulence
    else {
        panic!("{:?}", gas.turbulence)
    };
    assert_eq!((prandtl, schmidt), (0.85, 0.7));
    assert_eq!(
        gas.chemistry.reacting().unwrap().combustion,
        Combustion::Pasr {
            mixing_constant: 1.0
        }
    );
}

#[test]
fn spacing_order_and_comments_do_not_change_the_hash() {
    let path = &Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-bed.toml");
    let text = fs::read_to_string(path).unwrap();
    let other = text
        .replace(" = ", "   =  ")
        .replace("[time] ", "[time] # again ");
    let hash = |text: &str| parse(path, text, &[]).unwrap().hash;
    assert_eq!(hash(&text), hash(&other));
    // The title is for people.
    let titled = text.replacen("title = \"", "title = \"Another: ", 1);
    assert_ne!(titled, text);
    assert_eq!(hash(&text), hash(&titled));
    assert_ne!(hash(&text), hash(&text.replace("0.5 m/s\"", "0.6 m/s\"")));
}

#[test]
fn particles_of_a_file_stay_in_the_box_and_apart_from_other_populations() {
    use calcine::case::particles;
    let good = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/two-populations.toml");
    let case = |set: &str| read(&good, &[set.to_owned()]).unwrap();
    assert_eq!(
        particles(&case("time.end=1 s"), &Default::default())
            .unwrap()
            .setup
            .id
            .len(),
        4
    );
    // The upper sphere (radius 5 mm) at 19 mm, the lower grain (2 mm) at 25 mm.
    let error = particles(
        &case("particles[0].place.grid.first=\"5 5 9 mm\""),
        &Default::default(),
    )
    .unwrap_err();
    assert_eq!(
        error.to_string(),
        "particle 2 of \"spheres\" and particle 3 of \"grains\" overlap: their centres are 0.006 m \
         apart, their radii add up to 0.007 m; move one of the populations"
    );
    let error = particles(&case("mesh.box.size=10 10 30 mm"), &Default::default()).unwrap_err();
    let message = error.to_string();
    assert!(
        message.contains("bed.csv, line 3: the centre lies at z = 0.031 m, but the mesh reaches from 0 m to 0.03 m"),
        "{message}"
    );
}

#[test]
fn free_particles_start_with_the_velocities_and_spins_of_their_file_and_frozen_ones_at_rest() {
    use calcine::case::particles;
    let good =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/springs-and-gates.toml");
    let placed = |set: &[String]| {
        particles(&read(&good, set).unwrap(), &Default::default())
            .unwrap()
            .setup
    };
    let free = placed(&[]);
    let first = (free.velocity[0], free.angular_velocity[0]);
    assert_eq!(first.0.as_slice(), [0.1, 0.0, -0.2]);
    assert_eq!(first.1.as_slice(), [0.0, 30.0, 0.0]);
    assert_eq!(free.velocity[1].norm(), 0.0);
    let frozen = placed(&["particles[0].motion=frozen".into()]);
    assert!(frozen.velocity.is_empty() && frozen.angular_velocity.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn no_text_makes_the_reader_panic(
        at in 0.0..1.0f64,
        length in 0usize..40,
        insert in prop_oneof![
            "[ -~]{0,12}",
            Just("1e999 m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9*m^9".to_owned()),
            Just("[[\"0 s\", 1], [\"0 s\"]]".to_owned()),
            Just("9223372036854775807".to_owned()),
            Just("{ }".to_owned()),
            Just("\u{b5}m\u{0}".to_owned()),
        ],
        key in "[a-z\\[\\].0-9]{0,20}",
    ) {
        let path = &Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-bed.toml");
        let text = fs::read_to_string(path).unwrap();
        let start = text.floor_char_boundary((at * text.len() as f64) as usize);
        let end = text.floor_char_boundary((start + length).min(text.len()));
        let changed = format!("{}{insert}{}", &text[..start], &text[end..]);
        let _ = parse(path, &changed, &[]).map_err(|errors| errors.render());
        let _ = parse(path, &text, &[format!("{key}={insert}")]).map_err(|errors| errors.render());
    }
}

/// Dotted keys of a table, without the names that users choose and the places in lists.
fn keys(table: &toml::Table, place: &str, found: &mut Vec<String>) {
    for (key, value) in table {
        let chosen = [
            "materials",
            "solids",
            "gas.patch",
            "gas.species_data.transport",
        ]
        .contains(&place);
        let below = match (place.is_empty(), chosen) {
            (_, true) => place.to_owned(),
            (true, _) => key.clone(),
            (false, _) => format!("{place}.{key}"),
        };
        let inner = match value {
            toml::Value::Array(list) => list.first().and_then(toml::Value::as_table),
            value => value.as_table(),
        };
        match inner {
            Some(inner) => keys(inner, &below, found),
            None => found.push(below),
        }
    }
}

#[test]
fn every_key_of_the_shipped_and_good_cases_is_documented() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = fs::read_to_string(folder.join(KINDS[0].page)).unwrap();
    let mut found = Vec::new();
    for path in [files("cases"), files("tests/inputs/good")].concat() {
        keys(
            &fs::read_to_string(path).unwrap().parse().unwrap(),
            "",
            &mut found,
        );
    }
    assert!(found.len() > 40, "{found:?}");
    for key in found {
        let last = key.rsplit('.').next().unwrap();
        assert!(
            docs.contains(last),
            "docs/reference/case-file.md says nothing of `{key}`"
        );
    }
}

/// Replaces the value at `place` (keys, and indices of lists as numbers) by one of a wrong kind:
/// tables and lists of tables by `true`, anything else by a table.
fn spoil(item: &mut toml::Value, place: &[String]) {
    if let [step, rest @ ..] = place {
        let inner = match item {
            toml::Value::Table(table) => table.get_mut(step).unwrap(),
            toml::Value::Array(list) => &mut list[step.parse::<usize>().unwrap()],
            _ => panic!("{step} of a value"),
        };
        return spoil(inner, rest);
    }
    let holds_tables = match &*item {
        toml::Value::Array(list) => list.first().is_some_and(toml::Value::is_table),
        value => value.is_table(),
    };
    *item = if holds_tables {
        toml::Value::Boolean(true)
    } else {
        toml::Value::Table(
            [("nonsense".to_owned(), toml::Value::Integer(1))]
                .into_iter()
                .collect(),
        )
    };
}

/// Each place of a value in a case with its documented key, `NAME` for a name that users choose.
fn places(
    value: &toml::Value,
    place: &mut Vec<String>,
    key: &str,
    found: &mut Vec<(String, Vec<String>)>,
) {
    match value {
        toml::Value::Table(table) => {
            for (name, inner) in table {
                let chosen = [
                    "bodies",
                    "materials",
                    "solids",
                    "gas.patch",
                    "gas.species_data.transport",
                    "laws.mass_transfer.diffusivity.species",
                ]
                .contains(&key);
                let below = match (key, chosen) {
                    (_, true) => format!("{key}.NAME"),
                    ("", _) => name.clone(),
                    _ => format!("{key}.{name}"),
                };
                place.push(name.clone());
                found.push((below.clone(), place.clone()));
                places(inner, place, &below, found);
                place.pop();
            }
        }
        toml::Value::Array(list) => {
            for (index, inner) in list.iter().enumerate() {
                place.push(index.to_string());
                places(inner, place, key, found);
                place.pop();
            }
        }
        _ => {}
    }
}

#[test]
fn every_documented_key_occurs_in_a_good_case_and_refuses_a_value_of_a_wrong_kind() {
    let mut missing: std::collections::BTreeSet<String> =
        calcine::case::keys::keys(&KINDS[0], &LawCatalogue::default())
            .into_iter()
            .map(|key| key.place)
            .collect();
    for path in [files("tests/inputs/good"), files("cases")].concat() {
        let case: toml::Value =
            toml::Value::Table(fs::read_to_string(&path).unwrap().parse().unwrap());
        let mut found = Vec::new();
        places(&case, &mut Vec::new(), "", &mut found);
        for (key, place) in found {
            if !missing.remove(key.as_str()) {
                continue;
            }
            let mut spoilt = case.clone();
            spoil(&mut spoilt, &place);
            let text = toml::to_string(&spoilt).unwrap();
            let Err(errors) = parse(&path, &text, &[]) else {
                panic!("{}: `{key}` took a value of a wrong kind", path.display());
            };
            let last = place.last().unwrap();
            let lines: Vec<&str> = text.lines().collect();
            let named = errors.problems().iter().any(|problem| {
                problem.message.contains(last.as_str())
                    || lines
                        .get(problem.line - 1)
                        .is_some_and(|line| line.contains(last.as_str()))
            });
            assert!(
                named,
                "{}: `{key}`:\n{text}\n{}",
                path.display(),
                errors.render()
            );
        }
    }
    assert!(missing.is_empty(), "in no good case: {missing:#?}");
}

/// Dotted keys of all values of a table, those of lists with their number.
fn all_keys(place: &str, table: &dyn toml_edit::TableLike, found: &mut Vec<String>) {
    for (key, item) in table.iter() {
        let place = match place {
            "" => key.to_owned(),
            _ => format!("{place}.{key}"),
        };
        found.push(place.clone());
        if let Some(list) = item.as_array_of_tables() {
            for (index, table) in list.iter().enumerate() {
                all_keys(&format!("{place}[{index}]"), table, found);
            }
        } else if let Some(table) = item.as_table_like() {
            all_keys(&place, table, found);
        }
    }
}

#[test]
fn a_value_of_a_wrong_kind_is_one_error_and_nothing_that_only_follows_from_it() {
    let mut tried = 0;
    for path in files("cases") {
        let text = fs::read_to_string(&path).unwrap();
        let document: toml_edit::DocumentMut = text.parse().unwrap();
        let mut all = Vec::new();
        all_keys("", document.as_table(), &mut all);
        for set in all
            .iter()
            .flat_map(|key| [format!("{key}=true"), format!("{key}=nan")])
        {
            // The only ones that may be true.
            if [
                "gas.held=true",
                "liggghts.wall_impulse=true",
                "motion.parcels.damping=true",
                "motion.parcels.isotropy=true",
            ]
            .contains(&set.as_str())
            {
                continue;
            }
            tried += 1;
            let errors = read(&path, std::slice::from_ref(&set)).unwrap_err();
            let found = errors.problems();
            assert!(
                found.len() == 1 && found[0].message.starts_with(&format!("`--set {set}`: ")),
                "{} {set}: {errors}",
                path.display()
            );
            if set.ends_with("=nan") {
                let message = &found[0].message;
                assert!(
                    message.contains(" is nan, not a finite number"),
                    "{message}"
                );
            }
        }
    }
    assert!(tried > 1000, "{tried}");
}
