//! Links to the files beside the page.

use std::path::Path;

use super::page::escape;
use crate::results::files::{CASE, GAS, MEANS, PARAVIEW, PARTICLES, SERIES, STORE, SUMMARY, VOIDS};

/// Files that a page links to, and what each is.
pub(crate) const LINKED: [(&str, &str); 9] = [
    (SERIES, "time series (CSV)"),
    (STORE, "all results (HDF5)"),
    (GAS, "gas (VTK, for ParaView)"),
    (PARTICLES, "particles (VTK, for ParaView)"),
    (PARAVIEW, "script that opens gas and particles in ParaView"),
    (MEANS, "means over time (VTK, for ParaView)"),
    (VOIDS, "void fractions (CSV)"),
    (SUMMARY, "summary (JSON)"),
    (CASE, "case (TOML)"),
];

/// A list of those that are there.
pub(super) fn render(directory: &Path) -> String {
    let there = LINKED
        .iter()
        .filter(|(file, _)| directory.join(file).is_file());
    let links: String = there
        .map(|(file, what)| format!("<li><a href=\"{file}\">{file}</a> {}</li>", escape(what)))
        .collect();
    match links.is_empty() {
        true => links,
        false => format!("<ul class=\"links\">{links}</ul>"),
    }
}
