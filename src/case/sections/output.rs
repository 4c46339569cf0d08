//! `[output]`.

use calcine_coupler::time::Ticks;

use super::time::ticks;
use crate::case::model::{MeanSpec, Output};
use crate::case::table::TableReader;

/// `end`: the end of the run, where it could be read.
pub(super) fn output(root: &TableReader<'_>, end: Option<Ticks>) -> Option<Output> {
    let section = root.table("output")?;
    let every = ticks(&section, "every");
    let series_every = ticks(&section, "series_every");
    let gas = section.choices("gas");
    let particles = section.choices("particles");
    let means = section.table("means").map(|table| means(&table, end));
    section.finish();
    let means = match means {
        Some(means) => Some(means?),
        None => None,
    };
    Some(Output {
        every: every?,
        series_every,
        gas: gas?,
        particles: particles?,
        means,
    })
}

/// `output.means`: an interval within the run, and what is averaged over it.
fn means(table: &TableReader<'_>, end: Option<Ticks>) -> Option<MeanSpec> {
    let time = |key: &str| table.has(key).then(|| ticks(table, key));
    let (from, to) = (time("from"), time("to"));
    let gas = table.choices("gas");
    let particles = table.has("particles").then(|| table.choices("particles"));
    table.finish();
    let particles = match particles {
        Some(names) => names?,
        None => Vec::new(),
    };
    let from = match from {
        Some(from) => from?,
        None => Ticks::new(0),
    };
    let end = end?;
    let to = match to {
        Some(to) => to?,
        None => end,
    };
    if to > end {
        let rule = format!("is {} s, after the end of the run", to.seconds());
        let help = format!("write at most {} s, or raise `time.end`", end.seconds());
        table.fail("to", rule, help);
        return None;
    }
    if from >= to {
        let rule = format!("is {} s, not before the end of the means", from.seconds());
        let help = format!("write less than {} s", to.seconds());
        table.fail("from", rule, help);
        return None;
    }
    Some(MeanSpec {
        from,
        to,
        gas: gas?,
        particles,
    })
}
