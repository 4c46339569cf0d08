//! The files of a results folder: their names, and how they appear whole or not at all.

use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

use serde::{Deserialize, Deserializer, Serialize};

use super::ResultsError;

/// Name of the summary in a result directory.
pub const SUMMARY: &str = "summary.json";
/// Name of the file with what a comparison of runs found.
pub const COMPARISON: &str = "compare.json";
/// Name of the file to watch while a run goes on.
pub const STATUS: &str = "status.json";
/// Name of the time series.
pub const SERIES: &str = "series.csv";
/// Name of the table of void fractions.
pub const VOIDS: &str = "voids.csv";
/// Name of the HDF5 file.
pub const STORE: &str = "results.h5";
/// Name of the file with the command of the run, from which it is resumed.
pub const COMMAND: &str = "command.json";
/// Name of the report, alone in one file.
pub const REPORT: &str = "report.html";
/// Name of the effective case, `--set` applied.
pub const CASE: &str = "case.toml";

/// Name of the HDF5 file while it is made anew.
pub(super) const DRAFT: &str = "results.h5.new";

/// Collection of the snapshots of the gas.
pub(crate) const GAS: &str = "gas.pvd";
/// Collection of the snapshots of the particles.
pub(crate) const PARTICLES: &str = "particles.pvd";
/// Name of the script that opens a run in ParaView.
pub(crate) const PARAVIEW: &str = "open_in_paraview.py";
/// The script, the same for all runs.
pub(super) const PARAVIEW_SCRIPT: &str = include_str!("open_in_paraview.py");
/// Name of the file of means over time.
pub(crate) const MEANS: &str = "means.vtu";
/// Folders of the snapshots of the gas, of the particles and of the probes.
pub(super) const SNAPSHOTS: [&str; 3] = ["gas", "particles", "probes"];

/// Name of the table of a plant's streams and units at the end.
pub(crate) const STREAMS: &str = "streams.csv";
/// Name of the distributions of a plant over time.
pub(crate) const DISTRIBUTIONS: &str = "distributions.csv";
/// Name of the table of what was measured of a plant, and how that depends on what is tuned.
pub(crate) const SENSITIVITIES: &str = "sensitivities.csv";
/// Folder of the results of beds in those of their plant.
pub(crate) const BEDS: &str = "beds";

/// End of the name of a file that is not whole yet.
const UNFINISHED: &str = ".new";

/// True of what runs of beds and of plants compute in their folder.
pub(crate) fn is_computed(name: &str) -> bool {
    let own = [
        BEDS,
        DISTRIBUTIONS,
        SENSITIVITIES,
        SERIES,
        STORE,
        STREAMS,
        VOIDS,
    ];
    // The last checkpoint, the one before it and others by their endings.
    own.contains(&name) || name.split('.').next() == Some("checkpoint")
}

/// True of what else they write there or remove; a run that failed before it began leaves some of it.
pub(crate) fn is_written(name: &str) -> bool {
    let name = name.strip_suffix(UNFINISHED).unwrap_or(name);
    let own = [
        CASE, COMMAND, GAS, MEANS, PARAVIEW, PARTICLES, STATUS, STORE, SUMMARY, REPORT,
    ];
    own.contains(&name) || SNAPSHOTS.contains(&name) || is_computed(name)
}

/// Name of a snapshot's gas file.
pub(super) fn gas_file(number: usize) -> String {
    format!("gas/gas_{number:04}.vtu")
}

/// Name of a snapshot's particle file.
pub(super) fn particle_file(number: usize) -> String {
    format!("particles/particles_{number:04}.vtp")
}

/// Name of a snapshot's file of probes.
pub(super) fn probe_file(number: usize) -> String {
    format!("probes/probes_{number:04}.csv")
}

/// A number, or NaN for the `null` that JSON has in its place.
pub(super) fn number<'de, D: Deserializer<'de>>(source: D) -> Result<f64, D::Error> {
    Ok(Option::<f64>::deserialize(source)?.unwrap_or(f64::NAN))
}

/// Replaces a file at once: a reader sees the old content or the new, never a part.
pub(crate) fn replace(path: &Path, content: &[u8]) -> Result<(), ResultsError> {
    let mut draft = path.as_os_str().to_owned();
    draft.push(UNFINISHED);
    let draft = Path::new(&draft);
    let written = File::create(draft).and_then(|mut file| {
        file.write_all(content)?;
        file.flush()
    });
    if let Err(error) = written {
        // A disk that is full has room again for what tells of it.
        let _ = fs::remove_file(draft);
        return Err(ResultsError::file("write", draft)(error));
    }
    fs::rename(draft, path).map_err(ResultsError::file("replace", path))
}

/// Writes over a small file in place, as the last resort on a disk without room: one that is there keeps its room.
pub(super) fn write_over(path: &Path, content: &[u8]) -> Result<(), ResultsError> {
    let written = File::options().write(true).open(path).and_then(|mut file| {
        file.write_all(content)?;
        file.set_len(content.len() as u64)
    });
    written.map_err(ResultsError::file("write", path))
}

/// The text of a JSON file.
pub(crate) fn json(path: &Path, value: &impl Serialize) -> Result<String, ResultsError> {
    let mut text = serde_json::to_string_pretty(value)
        .map_err(|error| ResultsError::content(path, error.to_string()))?;
    text.push('\n');
    Ok(text)
}

/// Replaces a JSON file at once.
pub(crate) fn replace_json(path: &Path, value: &impl Serialize) -> Result<(), ResultsError> {
    replace(path, json(path, value)?.as_bytes())
}

/// Creates a directory with its parents.
pub(crate) fn directory(path: &Path) -> Result<(), ResultsError> {
    fs::create_dir_all(path).map_err(ResultsError::file("create", path))
}

/// Reads a text file.
pub(crate) fn read(path: &Path) -> Result<String, ResultsError> {
    fs::read_to_string(path).map_err(ResultsError::file("read", path))
}
