//! The two clocks of a case over its whole run: motion time and windows.

use calcine_coupler::time::Ticks;

use super::model::TimeSpec;

/// Spans of process time in s with a constant acceleration factor, and the factor.
fn spans(time: &TimeSpec) -> impl Iterator<Item = ([Ticks; 2], f64)> + '_ {
    let steps = time.acceleration.steps();
    let spans = steps.iter().enumerate().map(|(index, &(from, factor))| {
        let next = steps.get(index + 1).map_or(time.end, |step| step.0);
        ([from, next.min(time.end)], factor)
    });
    spans.filter(|([from, to], _)| from < to)
}

/// Motion time in s between two process times in s.
pub(super) fn motion_time(time: &TimeSpec, [from, to]: [f64; 2]) -> f64 {
    spans(time)
        .map(|([start, end], factor)| {
            (to.min(end.seconds()) - from.max(start.seconds())).max(0.0) / factor
        })
        .sum()
}

/// The process time in s at which so much motion time in s has passed since a process time in s; the end of the run where
/// it has not.
pub(super) fn process_after(time: &TimeSpec, from: f64, motion: f64) -> f64 {
    let mut left = motion;
    for ([start, end], factor) in spans(time) {
        let (start, end) = (from.max(start.seconds()), end.seconds());
        let length = (end - start).max(0.0) / factor;
        if length > 0.0 && left <= length {
            return start + left * factor;
        }
        left -= length;
    }
    time.end.seconds()
}

/// True where process time passes faster than motion time between two process times in s.
pub(super) fn is_accelerated(time: &TimeSpec, [from, to]: [f64; 2]) -> bool {
    spans(time)
        .any(|([start, end], factor)| factor > 1.0 && from < end.seconds() && start.seconds() < to)
}

/// Windows of the run, as [`calcine_coupler::time::Acceleration::span`] cuts them; the fewest where their length follows the gas.
pub(super) fn windows(time: &TimeSpec) -> i64 {
    windows_of(time, time.motion_window)
}

/// The most windows that the run may make.
pub(super) fn most_windows(time: &TimeSpec) -> i64 {
    let shortest = time.window_bounds.map(|bounds| bounds.min);
    windows_of(time, shortest.unwrap_or(time.motion_window))
}

fn windows_of(time: &TimeSpec, motion_window: Ticks) -> i64 {
    let windows = spans(time).map(|([from, to], factor)| {
        let full = Ticks::from_seconds(motion_window.seconds() * factor);
        let full = full.map_or(i64::MAX, |full| full.count().max(1));
        let length = to.since(from).count();
        length / full + i64::from(length % full > 0)
    });
    windows.fold(0, i64::saturating_add)
}

#[cfg(test)]
mod tests {
    use super::*;
    use calcine_coupler::time::Clocks;

    fn case(set: &[&str]) -> TimeSpec {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-bed.toml");
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        let mut case = crate::case::read(&path, &set).unwrap();
        let mesh = crate::case::mesh(&case.mesh).unwrap();
        crate::case::settle(&mut case, &mesh);
        case.time
    }

    /// Windows as a run cuts them.
    fn cut(time: &TimeSpec) -> i64 {
        let (mut clocks, mut count) = (Clocks::default(), 0);
        while clocks.process < time.end {
            let span = time
                .acceleration
                .span(clocks, time.motion_window, time.end)
                .unwrap();
            clocks = clocks.advanced(span).unwrap();
            count += 1;
        }
        count
    }

    #[test]
    fn windows_are_as_many_as_a_run_makes() {
        for set in [
            [
                "time.motion_window=0.1 ms",
                "time.end=1 s",
                "time.acceleration=10",
            ],
            [
                "time.motion_window=0.3 ms",
                "time.end=7 s",
                "time.acceleration=252.66695217",
            ],
            [
                "time.motion_window=1 ms",
                "time.end=2 s",
                "time.acceleration=[[\"0 s\", 7], [\"0.5 s\", 3.3]]",
            ],
        ] {
            let time = case(&set);
            assert_eq!(windows(&time), cut(&time), "{set:?}");
        }
    }

    #[test]
    fn motion_time_follows_the_schedule_there_and_back() {
        let set = "time.acceleration=[[\"0 s\", 10], [\"1 s\", 1], [\"2 s\", 4]]";
        let time = case(&["time.end=4 s", "time.motion_window=1 ms", set]);
        let motion = motion_time(&time, [0.5, 3.0]);
        assert!((motion - (0.05 + 1.0 + 0.25)).abs() < 1e-12, "{motion}");
        assert!((process_after(&time, 0.5, motion) - 3.0).abs() < 1e-9);
        assert_eq!(process_after(&time, 0.5, 99.0), 4.0);
        assert!(is_accelerated(&time, [0.0, 4.0]) && !is_accelerated(&time, [1.0, 2.0]));
    }
}
