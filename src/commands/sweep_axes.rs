//! The combinations of a sweep and their folders.

use std::collections::BTreeSet;
use std::path::Path;

use super::failure::Failure;
use super::jobs::Job;
use crate::exit;

/// The keys that `--set KEY=A,B,C` names, and every combination of their values as settings.
pub(super) fn combinations(set: &[String]) -> Result<(Vec<String>, Vec<Vec<String>>), Failure> {
    let axes = axes(set)?;
    Ok((keys(&axes).map(str::to_owned).collect(), combine(&axes)))
}

/// The values of each key that is swept, as settings.
pub(super) fn axes(set: &[String]) -> Result<Vec<Vec<String>>, Failure> {
    let axes: Vec<Vec<String>> = set
        .iter()
        .map(|text| axis(text))
        .collect::<Result<_, _>>()?;
    let mut seen = BTreeSet::new();
    let twice = keys(&axes).find(|key| !seen.insert(*key));
    match twice.map(str::to_owned) {
        None => Ok(axes),
        Some(key) => {
            let message = format!(
                "`{key}` stands in two `--set`: write all of its values in one, separated by commas"
            );
            Err(Failure::new(exit::CASE, message))
        }
    }
}

/// The keys that are swept.
pub(super) fn keys(axes: &[Vec<String>]) -> impl Iterator<Item = &str> {
    axes.iter()
        .filter_map(|axis| axis.first()?.split_once('=').map(|(key, _)| key))
}

/// `key=a,b,c` as `key=a`, `key=b`, `key=c`; commas inside brackets or quotes do not separate.
fn axis(text: &str) -> Result<Vec<String>, Failure> {
    let Some((key, values)) = text.split_once('=') else {
        let message = format!("`--set {text}`: expected KEY=A,B,C");
        return Err(Failure::new(exit::CASE, message));
    };
    let (mut depth, mut quoted, mut parts) = (0u32, false, vec![String::new()]);
    for letter in values.chars() {
        match letter {
            '"' => quoted = !quoted,
            '[' | '{' if !quoted => depth += 1,
            ']' | '}' if !quoted => depth = depth.saturating_sub(1),
            ',' if !quoted && depth == 0 => {
                parts.push(String::new());
                continue;
            }
            _ => {}
        }
        if let Some(part) = parts.last_mut() {
            part.push(letter);
        }
    }
    let settings = parts.into_iter();
    let settings = settings.map(|value| format!("{}={}", key.trim(), value.trim()));
    let settings: Vec<String> = settings.collect();
    let twice = |(place, setting): (usize, &String)| settings[..place].contains(setting);
    if let Some((place, _)) = settings.iter().enumerate().find(|one| twice(*one)) {
        let message = format!(
            "`--set {text}` names `{}` twice: each value is a run and a folder of its own",
            settings[place]
        );
        return Err(Failure::new(exit::CASE, message));
    }
    Ok(settings)
}

/// Every combination of one value from each axis, the last axis changing fastest.
pub(super) fn combine(axes: &[Vec<String>]) -> Vec<Vec<String>> {
    axes.iter().fold(vec![Vec::new()], |rows, axis| {
        rows.iter()
            .flat_map(|row| {
                axis.iter().map(move |setting| {
                    let mut next = row.clone();
                    next.push(setting.clone());
                    next
                })
            })
            .collect()
    })
}

/// Longest name of a folder in characters.
const LONGEST: usize = 120;

/// The runs of all combinations, each in a folder of its own.
pub(super) fn jobs(out: &Path, combinations: Vec<Vec<String>>) -> Vec<Job> {
    let mut taken = BTreeSet::new();
    let numbered = combinations.into_iter().enumerate();
    let job = |(place, settings): (usize, Vec<String>)| {
        let mut name = folder_name(&settings);
        if !taken.insert(name.clone()) {
            name = format!("{name},{}", place + 1);
            taken.insert(name.clone());
        }
        let folder = out.join(name);
        Job { settings, folder }
    };
    numbered.map(job).collect()
}

/// A folder name made of the last words of the keys and the values: `diameter=4mm,velocity=1.5mps`.
fn folder_name(settings: &[String]) -> String {
    let part = |setting: &String| {
        let (key, value) = setting.split_once('=').unwrap_or(("", setting));
        let key = key.rsplit('.').next().unwrap_or(key);
        let plain = |letter: char| match letter {
            '/' => Some('p'),
            '"' | '^' | '\'' => None,
            letter if letter.is_alphanumeric() || "._+-".contains(letter) => Some(letter),
            _ => Some('-'),
        };
        let words = [key, value].map(|text| {
            // Blanks between numbers tell one list from another.
            let parts: Vec<String> = text
                .split_whitespace()
                .map(|part| part.chars().filter_map(plain).collect())
                .collect();
            let is_number =
                |part: &str| part.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
            parts.iter().fold(String::new(), |text, part| {
                match text.is_empty() || !is_number(part) {
                    true => text + part,
                    false => text + "_" + part,
                }
            })
        });
        words.join("=")
    };
    let name = settings.iter().map(part).collect::<Vec<String>>().join(",");
    name.chars().take(LONGEST).collect()
}

/// The values of settings.
pub(super) fn values(settings: &[String]) -> Vec<String> {
    let values = settings.iter();
    let values = values.filter_map(|setting| Some(setting.split_once('=')?.1.to_owned()));
    values.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_separate_values_except_inside_brackets_and_quotes() {
        let split = |text| axis(text).unwrap();
        assert_eq!(split("a.b=1,2"), ["a.b=1", "a.b=2"]);
        assert_eq!(split("a=[1,2],[3]"), ["a=[1,2]", "a=[3]"]);
        assert_eq!(split("a=\"x,y\""), ["a=\"x,y\""]);
        assert!(axis("nothing").is_err());
        assert!(axis("a=1,2,1").is_err());
    }

    #[test]
    fn folders_are_named_by_keys_and_values_and_none_twice() {
        let settings = |one: &str, two: &str| vec![one.to_owned(), two.to_owned()];
        let named = jobs(
            Path::new("out"),
            vec![
                settings("particles.beads.diameter=4 mm", "gas.velocity=\"1.5 m/s\""),
                settings("a.x=[1]", "b.x=2"),
                settings("a.x=(1)", "c.x=2"),
            ],
        );
        let names = named.iter().map(|job| job.folder.to_str().unwrap());
        assert_eq!(
            names.collect::<Vec<_>>(),
            [
                "out/diameter=4mm,velocity=1.5mps",
                "out/x=-1-,x=2",
                "out/x=-1-,x=2,3"
            ]
        );
    }

    #[test]
    fn combinations_run_the_last_axis_fastest() {
        let axes = [
            vec!["a=1".to_owned(), "a=2".to_owned()],
            vec!["b=x".to_owned(), "b=y".to_owned()],
        ];
        let rows = combine(&axes);
        assert_eq!(rows.len(), 4);
        assert_eq!(rows[1], ["a=1", "b=y"]);
    }
}
