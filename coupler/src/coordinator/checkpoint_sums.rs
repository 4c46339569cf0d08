//! Checksums of the files of a checkpoint, by which a damaged one is known.

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read, Write as _};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// Name of the list, in the format of `sha256sum`.
pub(super) const SUMS: &str = "SHA256SUMS";
/// The coordinator's own state.
pub(super) const OWN: &str = "coordinator.state";

/// Flushes all files of a checkpoint to disk and leaves the list of their checksums, with a file of its own last: a list
/// that was cut short lacks it.
pub(super) fn seal(folder: &Path, own: &str) -> io::Result<()> {
    let mut list = String::new();
    for path in files(folder, own)? {
        let sum = sum(&folder.join(&path), true)?;
        let _ = writeln!(list, "{sum}  {}", path.display());
    }
    let mut file = File::create(folder.join(SUMS))?;
    file.write_all(list.as_bytes())?;
    file.sync_all()
}

/// What is wrong with a checkpoint; `None` where every file is as it was written.
pub(super) fn damage(folder: &Path, own: &str) -> Option<String> {
    let list = match fs::read_to_string(folder.join(SUMS)) {
        Ok(list) => list,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Some(format!(
                "it has no {SUMS}: it was not written to its end, or by an earlier release"
            ));
        }
        Err(error) => return Some(format!("{SUMS} cannot be read: {error}")),
    };
    if !list.ends_with(&format!("  {own}\n")) {
        return Some(format!("{SUMS} is cut short"));
    }
    let mut listed = Vec::new();
    for line in list.lines() {
        let Some((expected, name)) = line.split_once("  ") else {
            return Some(format!("{SUMS} is damaged itself"));
        };
        listed.push(Path::new(name));
        match sum(&folder.join(name), false) {
            Ok(found) if found == expected => {}
            Ok(_) => return Some(format!("{name} has another content than was written")),
            Err(error) => return Some(format!("{name} cannot be read: {error}")),
        }
    }
    let found = files(folder, own).unwrap_or_default();
    let other = found
        .iter()
        .find(|path| !listed.contains(&path.as_path()))?;
    Some(format!("{SUMS} does not list {}", other.display()))
}

/// The files of a folder and of those in it, relative to it, in a fixed order with `own` last.
fn files(folder: &Path, own: &str) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![PathBuf::new()];
    while let Some(inner) = folders.pop() {
        for entry in fs::read_dir(folder.join(&inner))? {
            let path = inner.join(entry?.file_name());
            match folder.join(&path).is_dir() {
                true => folders.push(path),
                false => found.push(path),
            }
        }
    }
    found.retain(|path| path != Path::new(SUMS));
    found.sort_by_key(|path| (path == Path::new(own), path.clone()));
    Ok(found)
}

/// SHA-256 of a file in hexadecimal digits, which is flushed to disk before where that is asked for.
pub fn sum(path: &Path, flush: bool) -> io::Result<String> {
    let mut file = File::open(path)?;
    if flush {
        file.sync_all()?;
    }
    let mut hasher = Sha256::new();
    let mut part = vec![0; 1 << 18];
    loop {
        match file.read(&mut part)? {
            0 => break,
            read => hasher.update(&part[..read]),
        }
    }
    let digits = hasher.finalize();
    Ok(digits.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    }))
}
