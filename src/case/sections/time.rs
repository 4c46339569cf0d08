//! `[time]`.

use calcine_coupler::time::{Acceleration, GasStorage, Ticks};
use calcine_coupler::window_control::WindowBounds;

use crate::case::model::TimeSpec;
use crate::case::table::TableReader;

pub(super) fn read(root: &TableReader<'_>) -> Option<(TimeSpec, GasStorage)> {
    let section = root.table("time")?;
    let end = ticks(&section, "end");
    let process_step = process_steps(&section);
    let stepped = section.has("process_step");
    if !stepped {
        section.need("motion_window");
    }
    let (motion_window, bounds) = match section.is_table("motion_window") {
        true => {
            let bounds = bounds(&section);
            (bounds.map(|bounds| bounds.max), bounds)
        }
        false => (ticks(&section, "motion_window"), None),
    };
    let acceleration = acceleration(&section);
    let storage = section.choice("gas_storage").unwrap_or_default();
    let (mut every, mut wall) = (None, None);
    if let Some(checkpoint) = section.table("checkpoint") {
        every = ticks(&checkpoint, "every");
        wall = checkpoint.wall_time("wall");
        checkpoint.finish();
    }
    section.finish();
    if stepped {
        exclusive(&section, storage);
    }
    let key = if stepped {
        "process_step"
    } else {
        "motion_window"
    };
    let longest = process_step
        .as_ref()
        .and_then(|steps| steps.iter().map(|step| step.1).max());
    let motion_window = if stepped { longest } else { motion_window };
    let (end, motion_window, acceleration) = (end?, motion_window?, acceleration?);
    if motion_window > end {
        let rule = format!("is {motion_window}, longer than the run of {end}");
        section.fail(key, rule, "lower it, or raise `time.end`");
    }
    let time = TimeSpec {
        end,
        process_step,
        motion_window,
        window_bounds: bounds,
        acceleration,
        storage,
        checkpoint_every: every,
        checkpoint_wall: wall,
    };
    Some((time, storage))
}

/// Bounds between which the length of windows follows the gas.
fn bounds(section: &TableReader<'_>) -> Option<WindowBounds> {
    let table = section.table("motion_window")?;
    let (min, max) = (ticks(&table, "min"), ticks(&table, "max"));
    let (courant, error) = (table.number("courant"), table.number("error"));
    if !table.has("courant") && !table.has("error") {
        let help = "write a largest Courant number or error, for example courant = 2, or a fixed window: motion_window = \"1 ms\"";
        section.fail("motion_window", "has nothing that windows follow", help);
    }
    table.finish();
    let (min, max) = (min?, max?);
    if min > max {
        let rule = format!("is {min}, longer than `max`, {max}");
        table.fail("min", rule, "lower it, or raise `max`");
        return None;
    }
    Some(WindowBounds {
        min,
        max,
        courant,
        error,
    })
}

/// Lengths of windows in process time, each from its time on.
fn process_steps(section: &TableReader<'_>) -> Option<Vec<(Ticks, Ticks)>> {
    const KEY: &str = "process_step";
    let entries = section.schedule(KEY)?.0;
    let help = "write a time, or times and the steps from them on, the first at 0 s: [[\"0 s\", \"60 s\"], [\"5000 s\", \"10 s\"]]";
    if let (Some(first), true) = (entries.first(), entries.len() > 1)
        && first.0 != 0.0
    {
        let rule = format!("begins at {} s, not at 0 s", first.0);
        section.fail(KEY, rule, help);
        return None;
    }
    let step = |(time, seconds): (f64, f64)| {
        let at = Ticks::from_seconds(time).ok()?;
        let step = Ticks::from_seconds(seconds).ok()?;
        (step > Ticks::ZERO).then_some((at, step))
    };
    let steps: Option<Vec<_>> = entries.iter().copied().map(step).collect();
    if steps.is_none() {
        let rule = "has a time that the clock cannot hold";
        section.fail(KEY, rule, "its tick is 1e-12 s, and it ends after 106 days");
    }
    steps
}

/// A process step stands for the motion clock as a whole.
fn exclusive(section: &TableReader<'_>, storage: GasStorage) {
    for key in ["motion_window", "acceleration"] {
        if section.has(key) {
            let help = "remove one of the two: `process_step` chooses the motion time by itself";
            section.fail(key, "does not go with `time.process_step`", help);
        }
    }
    if storage == GasStorage::Accelerated {
        let help = "write gas_storage = \"process\", or `motion_window` and `acceleration`";
        section.fail(
            "gas_storage",
            "is \"accelerated\", which does not go with `time.process_step`",
            help,
        );
    }
}

/// A time of the case's clock; errors where it is below the tick or too long.
pub(super) fn ticks(section: &TableReader<'_>, key: &str) -> Option<Ticks> {
    let seconds = section.number(key)?;
    match Ticks::from_seconds(seconds) {
        Ok(ticks) if ticks > Ticks::ZERO => Some(ticks),
        Ok(_) => {
            section.fail(
                key,
                format!("is {seconds} s"),
                "the clock's tick is 1e-12 s",
            );
            None
        }
        Err(error) => {
            section.fail(key, format!("is too long: {error}"), "write a shorter time");
            None
        }
    }
}

/// A number, or a list of [process time, number].
fn acceleration(section: &TableReader<'_>) -> Option<Acceleration> {
    let key = "acceleration";
    let steps = section.schedule(key)?.0;
    let steps = steps
        .into_iter()
        .map(|(time, factor)| Ok((Ticks::from_seconds(time)?, factor)))
        .collect::<Result<Vec<_>, calcine_coupler::time::TimeError>>();
    let made = steps
        .map_err(|error| error.to_string())
        .and_then(|steps| Acceleration::schedule(steps).map_err(|error| error.to_string()));
    match made {
        Ok(acceleration) => Some(acceleration),
        Err(why) => {
            section.fail(
                key,
                format!("cannot be used: {why}"),
                "write a factor of at least 1, or [[\"0 s\", 1], [\"5 s\", 50]]",
            );
            None
        }
    }
}
