//! `[output]`.

use super::time::ticks;
use crate::case::model::Output;
use crate::case::table::TableReader;

pub(super) fn output(root: &TableReader<'_>) -> Option<Output> {
    let section = root.table("output")?;
    let every = ticks(&section, "every");
    let series_every = ticks(&section, "series_every");
    let gas = section.choices("gas");
    let particles = section.choices("particles");
    section.finish();
    Some(Output {
        every: every?,
        series_every,
        gas: gas?,
        particles: particles?,
    })
}
