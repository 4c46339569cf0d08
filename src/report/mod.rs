//! The report of a run: one self-contained HTML page made from a result directory.

mod bed_columns;
mod cells;
pub(crate) mod colour;
mod convergence;
mod costs;
mod flows;
mod headline;
pub(crate) mod links;
mod means;
pub(crate) mod number;
mod over_radius;
mod over_time;
pub(crate) mod overview;
pub(crate) mod page;
mod picture;
pub(crate) mod plot;
mod probes;
mod profiles;
mod provenance;
mod section;
mod shade;
mod spread;
mod swept_axis;
mod ticks;
mod view;
mod voids;
mod warnings;

use std::path::{Path, PathBuf};

use self::page::{Page, badge, escape};
use self::view::View;
use crate::results::read::Series;
use crate::results::{CASE, ResultsError, Summary, files};

/// Name of the page in a result directory.
pub use crate::results::files::REPORT;

/// Bytes of a page at most, as far as its view of the bed can see to that.
const PAGE: usize = 3_000_000;
/// Stands for the view until it is known how much room there is for it.
const VIEW_PLACE: &str = "<!--view-->";

/// Writes `report.html` into a result directory, from the files that are in it.
pub fn write(directory: &Path) -> Result<PathBuf, ResultsError> {
    let path = directory.join(REPORT);
    files::replace(&path, page(directory)?.as_bytes())?;
    Ok(path)
}

/// The page of a result directory, from the files that are in it.
pub(crate) fn page(directory: &Path) -> Result<String, ResultsError> {
    let summary = Summary::now(directory)?;
    let series = Series::read(directory)?;
    let case = files::read(&directory.join(CASE))?;
    let kicker = format!(
        "{} · {} gas · {} particles",
        summary.case.name, summary.backend.gas, summary.backend.particles
    );
    let mut page = Page::new(&kicker, &summary.case.title, &badge(summary.verdict));
    page.raw(&headline::headline(&summary));
    let told = warnings::render(&summary);
    if !told.is_empty() {
        let text =
            "What was outside the range of a law, or did not converge, in committed windows.";
        page.section("Warnings", text, &told);
    }
    page.section(
        "Quantities of interest",
        "",
        &headline::quantities(&summary),
    );
    let came_and_went = headline::passed(&summary);
    if !came_and_went.is_empty() {
        let text = "Particles that feeds brought, that outlets took, and what was left of those that reactions used up.";
        page.section("Particles that came and went", text, &came_and_went);
    }
    let view = View::read(directory)?;
    let picture = picture::render(directory, |shade| view.as_ref()?.range(shade))?;
    page.section(
        "Bed and gas",
        "A cut through the middle, seen from the side. Gas cells and particles are coloured by temperature, in one scale; where all of \
         it is one temperature, by their speeds.",
        &picture.html,
    );
    let view = view.zip(picture.shade);
    if view.is_some() {
        let text = "All particles, snapshot by snapshot, and walls as they are at the start, in the colours of the picture above.";
        page.section("The bed in three dimensions", text, VIEW_PLACE);
        page.adds(view::STYLE, view::SCRIPT);
    }
    let averaged = means::render(directory)?;
    if !averaged.is_empty() {
        let text = "Means over the interval of output.means, and root mean squares of the fluctuation about them, in the same cut; of vectors \
                    the magnitude, of particles what the cells hold. Grey cells held no particle.";
        page.section("Means over time", text, &averaged);
    }
    let text = "What came in and went out, as the ledger counts it.";
    page.section("Heat and mass in and out", text, &flows::render(&summary));
    page.section("Over time", "", &over_time::plots(&summary, &series));
    let sampled = probes::render(directory)?;
    if !sampled.is_empty() {
        let text = "Fields at the points of the case's probes, snapshot by snapshot.";
        page.section("Probes", text, &sampled);
    }
    let distributions = profiles::render(directory)?;
    page.section(
        "Profiles",
        "Means over layers across the longest side: of the gas by volume, of the particles by number.",
        &distributions.profiles,
    );
    let inside = over_radius::render(directory)?;
    if !inside.is_empty() {
        let text = "Of particles with shells, each value where r² is its mean over the shell: means over all of them shell by shell, and single ones at the end.";
        page.section("Over the radius of particles", text, &inside);
    }
    page.section(
        "Histograms",
        "Of the number of particles, at the first snapshot and at the last.",
        &distributions.histograms,
    );
    let profiles = voids::render(directory)?;
    if !profiles.is_empty() {
        let text = "Share of the cross-section, and in a cylinder of the surface of each distance from its wall, \
                    that no particle covers, at the end.";
        page.section("Void fraction", text, &profiles);
    }
    page.section(
        "Ledger",
        "What did not close, relative to all that moved, over the whole run.",
        &costs::ledger(&summary),
    );
    page.section("Where the wall time went", "", &costs::timing(&summary));
    let phases = costs::gas_phases(&summary);
    if !phases.is_empty() {
        page.section("Where the gas' wall time went", "", &phases);
    }
    page.section(
        "Convergence of the gas",
        &convergence::converged(&summary),
        &convergence::residuals(&series),
    );
    page.section("What was run", "", &provenance::provenance(&summary));
    let text = "They open where they lie beside this page.";
    page.section("Files", text, &links::render(directory));
    let text = format!(
        "<details><summary>The case as it was run</summary><pre>{}</pre></details>",
        escape(&case)
    );
    page.section("Case file", "", &text);
    let footer = format!(
        "Calcine {} · all times are process (real) time unless said otherwise",
        summary.calcine
    );
    let text = page.finish(&footer);
    Ok(match view {
        Some((view, shade)) => {
            let room = PAGE.saturating_sub(text.len());
            let html = view.render(shade, picture.range, room);
            text.replacen(VIEW_PLACE, &html, 1)
        }
        None => text,
    })
}
