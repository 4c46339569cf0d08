//! `--set`: no assignments, of keys that a case has or has not, make the reader panic, and those that are taken are told.

use std::fs;
use std::path::{Path, PathBuf};

use calcine::case::parse;

use crate::mutate::mutate;
use crate::random::Random;
use crate::{Files, Target};

/// The shipped cases with the keys and values that they state.
pub struct Assignments {
    cases: Vec<(PathBuf, String)>,
    /// Keys and values, of each case and of all.
    stated: Vec<Vec<[String; 2]>>,
    all: Vec<[String; 2]>,
}

impl Assignments {
    pub fn new() -> Self {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut cases = Vec::new();
        for entry in ["cases", "tests/inputs/good"]
            .iter()
            .flat_map(|folder| fs::read_dir(root.join(folder)).unwrap())
        {
            let path = entry.unwrap().path();
            let of_bed = || calcine::case::kind_of(&path, &[]).is_ok_and(|kind| kind.name == "bed");
            if path.extension().is_some_and(|one| one == "toml") && of_bed() {
                let text = fs::read_to_string(&path).unwrap();
                cases.push((path, text));
            }
        }
        // The order of a folder's entries is not the same everywhere.
        cases.sort();
        let stated: Vec<_> = cases.iter().map(|(_, text)| stated(text)).collect();
        let all = stated.concat();
        assert!(all.len() > 1000, "{} keys", all.len());
        Self { cases, stated, all }
    }
}

/// Keys with their tables, and values, as far as lines tell them.
fn stated(text: &str) -> Vec<[String; 2]> {
    let mut found = Vec::new();
    let mut table = String::new();
    let mut counts = std::collections::BTreeMap::<String, usize>::new();
    for line in text.lines() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if let Some(name) = line.strip_prefix("[[").and_then(|l| l.strip_suffix("]]")) {
            let count = counts.entry(name.to_owned()).or_default();
            table = format!("{name}[{count}]");
            *count += 1;
        } else if let Some(name) = line.strip_prefix('[').and_then(|l| l.strip_suffix(']')) {
            name.clone_into(&mut table);
        } else if let Some((key, value)) = line.split_once('=') {
            let dot = if table.is_empty() { "" } else { "." };
            let key = format!("{table}{dot}{}", key.trim());
            found.push([key, value.trim().to_owned()]);
        }
    }
    found
}

impl Target for Assignments {
    fn input(&self, random: &mut Random) -> Files {
        let number = random.below(self.cases.len());
        let path = self.cases[number].0.to_string_lossy().into_owned();
        let mut files: Files = vec![("place".to_owned(), path.into())];
        let others: Vec<&[u8]> = self.all.iter().map(|[_, value]| value.as_bytes()).collect();
        for count in 0..=random.below(3) {
            // Mostly what the case itself states: another's keys are refused.
            let list = match random.once_in(6) {
                true => &self.all,
                false => &self.stated[number],
            };
            let [key, value] = random.one(list);
            let value = match random.once_in(6) {
                true => &random.one(&self.all)[1],
                false => value,
            };
            let (mut key, mut value) = (key.clone().into_bytes(), value.clone().into_bytes());
            if random.once_in(6) {
                mutate(&mut key, random, &others);
            }
            if random.once_in(2) {
                mutate(&mut value, random, &others);
            }
            files.push((format!("set-{count}"), [&key[..], b"=", &value].concat()));
        }
        files
    }

    fn execute(&mut self, files: &Files) -> bool {
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let place = text(&files[0].1);
        let set: Vec<String> = files[1..].iter().map(|(_, bytes)| text(bytes)).collect();
        let found = self
            .cases
            .iter()
            .find(|(path, _)| *path == Path::new(&place));
        let Some((path, content)) = found else {
            return false;
        };
        match parse(path, content, &set) {
            Ok(case) => {
                assert_eq!(case.changes.len(), set.len(), "a change is not told");
                // What was taken is in the case that the results keep, and reads again as the same.
                let again = parse(path, &case.effective, &[]);
                let again = again.unwrap_or_else(|errors| panic!("{}", errors.render()));
                assert_eq!(again.hash, case.hash);
                true
            }
            Err(errors) => {
                assert!(!errors.problems().is_empty(), "refused without a problem");
                assert!(!errors.render().is_empty());
                false
            }
        }
    }
}
