//! How far windows go.

use crate::time::{Acceleration, Clocks, Ticks, TimeError};

/// How far the next window goes. The schedule shortens a window that would cross its change or the
/// run's end; what is left before either never becomes a sliver: the last two windows share it
/// evenly, and an overhang of round-off is taken up by the last. Over a sliver the gas would turn
/// its tolerance in mass, divided by the span, into velocity, and that into pressure: a final
/// window of 1e-5 of the others gave a pressure drop of 8372 Pa instead of 17.4 Pa.
pub(super) fn next_span(
    acceleration: &Acceleration,
    clocks: Clocks,
    motion_window: Ticks,
    end: Ticks,
) -> Result<Clocks, TimeError> {
    const ROUND_OFF: i64 = 1_000_000;
    let span = acceleration.span(clocks, motion_window, end)?;
    let (factor, change) = acceleration.at(clocks.process);
    let left = change
        .map_or(end, |time| time.min(end))
        .since(clocks.process);
    let after = left.since(span.process);
    let process = if after == Ticks::ZERO || after >= span.process {
        return Ok(span);
    } else if after.count() <= span.process.count() / ROUND_OFF {
        left
    } else {
        Ticks::new(left.count() / 2)
    };
    let motion = Ticks::from_seconds(process.seconds() / factor)?;
    Ok(Clocks { motion, process })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(seconds: f64) -> Ticks {
        Ticks::from_seconds(seconds).unwrap()
    }

    fn spans(acceleration: &Acceleration, end: f64) -> Vec<Clocks> {
        let (mut clocks, mut spans) = (Clocks::default(), Vec::new());
        while clocks.process < ticks(end) {
            let span = next_span(acceleration, clocks, ticks(1e-3), ticks(end)).unwrap();
            clocks = clocks.advanced(span).unwrap();
            spans.push(span);
        }
        assert_eq!(clocks.process, ticks(end));
        spans
    }

    #[test]
    fn no_window_is_a_sliver_where_the_end_is_no_multiple_of_the_window() {
        for factor in [1.0, 33.333_333_333_3, 33.333_333, 50.0, 333.333_3, 678.0] {
            let acceleration = Acceleration::constant(factor).unwrap();
            for end in [2.0, 2.025, 2.000_000_5, 3.000_37] {
                for span in spans(&acceleration, end) {
                    let share = span.motion.seconds() / 1e-3;
                    assert!(
                        (0.499..1.000_002).contains(&share),
                        "a window of {share} windows at AF {factor}, end {end} s"
                    );
                    let kept = span.process.seconds() / span.motion.seconds() / factor;
                    assert!((kept - 1.0).abs() < 1e-8, "AF {factor} became {kept} of it");
                }
            }
        }
    }

    #[test]
    fn no_window_is_a_sliver_before_the_acceleration_changes() {
        let steps = vec![(Ticks::ZERO, 1.0), (ticks(1.000_000_1), 50.0)];
        let acceleration = Acceleration::schedule(steps).unwrap();
        let spans = spans(&acceleration, 3.0);
        assert!(spans.iter().all(|span| span.motion >= ticks(0.499e-3)));
    }

    #[test]
    fn windows_that_fit_are_all_alike() {
        let acceleration = Acceleration::constant(50.0).unwrap();
        let spans = spans(&acceleration, 2.0);
        assert_eq!(spans.len(), 40);
        assert!(spans.iter().all(|span| *span == spans[0]));
    }
}
