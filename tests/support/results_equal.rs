//! Results of two runs compared: every dataset to the bit, the series and the ParaView files byte
//! for byte, the summary but for wall times.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use calcine::results::Summary;

/// All values of `results.h5` by dataset, and the attributes of the snapshots, as bits.
pub fn datasets(path: &Path) -> BTreeMap<String, Vec<u64>> {
    fn walk(group: &hdf5::Group, found: &mut BTreeMap<String, Vec<u64>>) {
        for dataset in group.datasets().unwrap() {
            let values = dataset.read_raw::<f64>().unwrap();
            let bits = values.iter().map(|value| value.to_bits()).collect();
            found.insert(dataset.name(), bits);
        }
        for inner in group.groups().unwrap() {
            for name in ["process_time", "motion_time", "windows"] {
                if let Ok(value) = inner.attr(name).and_then(|it| it.read_scalar::<f64>()) {
                    found.insert(format!("{}:{name}", inner.name()), vec![value.to_bits()]);
                }
            }
            walk(&inner, found);
        }
    }
    let file = hdf5::File::open(path).unwrap();
    let mut found = BTreeMap::new();
    walk(&file.as_group().unwrap(), &mut found);
    assert!(found.len() > 10, "{} datasets", found.len());
    found
}

/// Datasets that differ between two result folders, by name.
fn datasets_that_differ(expected: &Path, found: &Path) -> Vec<String> {
    let [one, other] = [expected, found].map(|folder| datasets(&folder.join("results.h5")));
    let names: std::collections::BTreeSet<_> = one.keys().chain(other.keys()).collect();
    let differing = names.into_iter();
    differing
        .filter(|&name| one.get(name) != other.get(name))
        .cloned()
        .collect()
}

/// What differs of the values of two runs, of cases that may differ in what is no matter of values, by name; empty where
/// nothing does.
#[allow(dead_code)]
pub fn values_that_differ(expected: &Path, found: &Path) -> Vec<String> {
    let mut list = datasets_that_differ(expected, found);
    let [one, other] = [expected, found].map(|folder| fs::read(folder.join("series.csv")).unwrap());
    if one != other {
        list.push("series.csv".into());
    }
    list
}

/// What differs between two result folders, by name; empty where nothing does.
#[allow(dead_code)]
pub fn differences(expected: &Path, found: &Path) -> Vec<String> {
    let mut list = datasets_that_differ(expected, found);
    let files = |folder: &Path| -> BTreeMap<String, Vec<u8>> {
        let read = |name: &str| fs::read(folder.join(name)).unwrap();
        let mut files: BTreeMap<_, _> = ["series.csv", "gas.pvd", "particles.pvd", "case.toml"]
            .map(|name| (name.to_owned(), read(name)))
            .into();
        if folder.join("voids.csv").is_file() {
            files.insert("voids.csv".into(), read("voids.csv"));
        }
        for sub in ["gas", "particles"] {
            for entry in fs::read_dir(folder.join(sub)).unwrap() {
                let name = format!("{sub}/{}", entry.unwrap().file_name().display());
                files.insert(name.clone(), read(&name));
            }
        }
        files
    };
    let (one, other) = (files(expected), files(found));
    let names: std::collections::BTreeSet<_> = one.keys().chain(other.keys()).collect();
    list.extend(
        names
            .into_iter()
            .filter(|&name| one.get(name) != other.get(name))
            .cloned(),
    );
    let [mut one, mut other] = [expected, found].map(|folder| Summary::read(folder).unwrap());
    for summary in [&mut one, &mut other] {
        summary.wall_time_s = Default::default();
        summary.processor_time_s = Default::default();
        summary.gas_phases_s = Default::default();
    }
    if one != other {
        let [one, other] = [one, other].map(|summary| serde_json::to_value(summary).unwrap());
        let keys = one.as_object().unwrap().iter();
        let differing = keys.filter(|(key, value)| other[key.as_str()] != **value);
        let parts = differing.map(|(key, value)| format!("{key}: {value}, {}", other[key]));
        list.push(format!(
            "summary.json: {}",
            parts.collect::<Vec<_>>().join("; ")
        ));
    }
    list
}
