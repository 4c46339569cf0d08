//! Snapshots of Calcine as the benchmarks read them.

use std::fs;
use std::path::{Path, PathBuf};

use crate::steps::{Stop, TaskResult};

/// The last file of a folder with an ending: `vtu` of the gas, `vtp` of particles.
pub fn last(folder: &Path, ending: &str) -> TaskResult<PathBuf> {
    let entries = fs::read_dir(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let paths = entries.flatten().map(|entry| entry.path());
    let last = paths
        .filter(|path| path.extension().is_some_and(|own| own == ending))
        .max();
    last.ok_or_else(|| Stop(format!("{}: no snapshots", folder.display())))
}

/// A raw appended array of 64-bit numbers by its name.
pub fn appended(bytes: &[u8], name: &str) -> Option<Vec<f64>> {
    let mark: &[u8] = b"<AppendedData encoding=\"raw\">\n_";
    let begin = bytes
        .windows(mark.len())
        .position(|window| window == mark)?;
    let head = std::str::from_utf8(&bytes[..begin]).ok()?;
    let named = format!("type=\"Float64\" Name=\"{name}\"");
    let element = head.split('<').find(|element| element.contains(&named))?;
    let offset: usize = element
        .split_once("offset=\"")?
        .1
        .split_once('"')?
        .0
        .parse()
        .ok()?;
    let data = bytes.get(begin + mark.len() + offset..)?;
    let (length, data) = data.split_first_chunk::<8>()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let numbers = data.get(..length)?.as_chunks::<8>().0;
    Some(
        numbers
            .iter()
            .map(|number| f64::from_le_bytes(*number))
            .collect(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn appended_arrays_of_calcine_are_found_by_their_names() {
        let mut bytes = b"<VTKFile><DataArray type=\"Float64\" Name=\"points\" offset=\"0\"/>\n\
            <DataArray type=\"Float64\" Name=\"temperature\" NumberOfComponents=\"1\" format=\"appended\" offset=\"16\"/>\n\
            <AppendedData encoding=\"raw\">\n_"
            .to_vec();
        for number in [8u64.to_le_bytes(), 1f64.to_le_bytes(), 16u64.to_le_bytes()] {
            bytes.extend(number);
        }
        bytes.extend(300.5f64.to_le_bytes());
        bytes.extend(301f64.to_le_bytes());
        assert_eq!(appended(&bytes, "temperature"), Some(vec![300.5, 301.0]));
        assert_eq!(appended(&bytes, "pressure"), None);
        assert_eq!(appended(&bytes[..bytes.len() - 1], "temperature"), None);
    }
}
