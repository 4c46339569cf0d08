//! `motion.held`: when a bed that moves is held.

use calcine_coupler::hold::{HoldError, Holds};
use calcine_coupler::time::Ticks;

use super::time::ticks;
use crate::case::model::{FreeMotion, TimeSpec};
use crate::case::table::TableReader;
use crate::case::units::Dimension;

const KEY: &str = "held";
const HELP: &str = "write begin and end of each time, one after the other, for example \
                    held = [[\"10 s\", \"60 s\"], [\"70 s\", \"120 s\"]]";
/// Spans that a run may have.
const MOST: i64 = 1_000_000;

/// Spans of process time, or a table of spans that repeat.
pub(super) fn holds(section: &TableReader<'_>, time: Option<&TimeSpec>) -> Holds {
    let Some(item) = section.raw(KEY) else {
        return Holds::default();
    };
    let made = match item.as_array() {
        Some(_) => spans(section).map(Holds::new),
        None => periodic(section, time),
    };
    let held = made.and_then(|made| {
        let refuse = |error: HoldError| section.fail(KEY, format!("cannot be: {error}"), HELP);
        made.map_err(refuse).ok()
    });
    held.unwrap_or_default()
}

/// [begin, end] of each.
fn spans(section: &TableReader<'_>) -> Option<Vec<[Ticks; 2]>> {
    let mut spans = Vec::new();
    for entry in section.raw(KEY)?.as_array()? {
        let pair = entry.as_array().filter(|pair| pair.len() == 2);
        let Some((from, to)) = pair.and_then(|pair| Some((pair.get(0)?, pair.get(1)?))) else {
            section.fail(KEY, "needs pairs of times", HELP);
            return None;
        };
        let time = |value| {
            let seconds = section.value(KEY, value, Dimension::TIME)?;
            let ticks = Ticks::from_seconds(seconds).ok();
            let ticks = ticks.filter(|&ticks| ticks >= Ticks::ZERO);
            if ticks.is_none() {
                let rule = format!("has the time {seconds} s, which no run comes to");
                section.fail(KEY, rule, HELP);
            }
            ticks
        };
        spans.push([time(from)?, time(to)?]);
    }
    Some(spans)
}

/// `{ from, for, every }`, up to the end of the run.
fn periodic(
    section: &TableReader<'_>,
    time: Option<&TimeSpec>,
) -> Option<Result<Holds, HoldError>> {
    let table = section.table(KEY)?;
    let from = table.number("from")?;
    let length = ticks(&table, "for");
    let every = ticks(&table, "every");
    table.finish();
    let begin = Ticks::from_seconds(from).ok();
    let begin = begin.filter(|&begin| begin >= Ticks::ZERO);
    if begin.is_none() {
        let rule = format!("is {from} s, which no run comes to");
        table.fail("from", rule, "write a time of the run");
    }
    let (begin, length, every, end) = (begin?, length?, every?, time?.end);
    if every <= length {
        let rule = format!("is {every}, in which a hold of {length} leaves no time to move");
        let help = "raise it above `for`, or write motion = \"frozen\" for the population";
        table.fail("every", rule, help);
        return None;
    }
    let count = end.since(begin).count() / every.count();
    if count >= MOST {
        let rule = format!("is {every}: the bed would be held {count} times up to {end}");
        table.fail("every", rule, "hold it less often, and longer");
        return None;
    }
    Some(Holds::periodic(begin, length, every, end))
}

/// Checks that there is something to hold, and a time to hold it.
pub(super) fn fits(
    root: &TableReader<'_>,
    motion: Option<&FreeMotion>,
    time: &TimeSpec,
    frozen: bool,
) {
    let (Some(motion), Some(section)) = (motion, root.table("motion")) else {
        return;
    };
    if !section.has(KEY) {
        return;
    }
    if frozen {
        let help = "remove it, or write motion = \"free\" for the population that is to move";
        section.fail(KEY, "is for beds that move, but none does", help);
        return;
    }
    let late = |span: &&[Ticks; 2]| span[0] >= time.end;
    if let Some([from, _]) = motion.held.spans().iter().find(late) {
        let rule = format!("begins at {from}, but the run ends at {}", time.end);
        section.fail(KEY, rule, "remove it, or raise `time.end`");
    }
    if motion.held.moving(&time.acceleration, time.end).is_empty() {
        let help = "write motion = \"frozen\" for its populations";
        section.fail(KEY, "holds the bed for the whole run", help);
    }
}
