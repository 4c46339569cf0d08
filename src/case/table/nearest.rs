//! What a misspelt word, or the name of a file that is not there, may have meant.

use std::path::{Path, PathBuf};

/// What to do where there is no case file of this name: those of its folder, or of the folder of this name.
pub(in crate::case) fn instead_of_file(path: &Path) -> String {
    let parent = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = match path.is_dir() {
        true => path,
        false => parent.unwrap_or(Path::new(".")),
    };
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder)
        .map(|entries| entries.flatten().map(|entry| entry.path()).collect())
        .unwrap_or_default();
    files.retain(|file| file.extension().is_some_and(|end| end == "toml") && file.is_file());
    files.sort();
    let names: Vec<String> = files
        .iter()
        .map(|file| file.strip_prefix(".").unwrap_or(file).display().to_string())
        .collect();
    let wanted = path.with_extension("toml").display().to_string();
    match nearest(&wanted, names.iter().map(String::as_str)) {
        Some(near) => format!("did you mean {near}?"),
        None if !names.is_empty() && names.len() <= 20 => {
            format!("name a case; there are {}", names.join(", "))
        }
        None => "name a case that exists, or make one with `calcine new NAME`".into(),
    }
}

/// The nearest of several names, if it is near enough to be meant.
pub(in crate::case) fn nearest<'n>(
    word: &str,
    names: impl Iterator<Item = &'n str>,
) -> Option<&'n str> {
    let limit = 1 + word.chars().count() / 4;
    names
        .map(|name| (strsim::levenshtein(word, name), name))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, name)| name)
}
