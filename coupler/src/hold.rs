//! Times in which a bed that moves is held: nothing of it moves, and its solver takes no step.
//!
//! A bed comes to rest where it lies as it is held, and is let go from rest, with the springs of its contacts as
//! they were. Its solver knows nothing of the time between: walls stand, feeds and outlets too, and its clock goes
//! on from where it stopped. Gas and interior go on.

use thiserror::Error;

use crate::time::{Acceleration, Ticks};

/// Spans of process time in which the bed is held.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Holds {
    spans: Vec<[Ticks; 2]>,
}

/// Spans that cannot be kept.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum HoldError {
    /// A span that ends before it begins.
    #[error("the bed is held from {from} to {to}, which is no span of time")]
    Empty {
        /// Its begin.
        from: Ticks,
        /// Its end.
        to: Ticks,
    },
    /// A span that begins before the one before it ends, or as it does.
    #[error("the bed is held from {from}, but until {until} it is held already")]
    Overlap {
        /// Begin of the later one.
        from: Ticks,
        /// End of the earlier one.
        until: Ticks,
    },
}

impl Holds {
    /// Spans of process time, one after the other: begin and end of each.
    pub fn new(spans: Vec<[Ticks; 2]>) -> Result<Self, HoldError> {
        if let Some(&[from, to]) = spans.iter().find(|span| span[0] >= span[1]) {
            return Err(HoldError::Empty { from, to });
        }
        if let Some(pair) = spans.windows(2).find(|pair| pair[1][0] <= pair[0][1]) {
            return Err(HoldError::Overlap {
                from: pair[1][0],
                until: pair[0][1],
            });
        }
        Ok(Self { spans })
    }

    /// Spans of one length, the first from `from` on and one each `every`, up to the end of a run.
    pub fn periodic(
        from: Ticks,
        length: Ticks,
        every: Ticks,
        end: Ticks,
    ) -> Result<Self, HoldError> {
        let (mut begin, mut spans) = (from, Vec::new());
        while begin < end {
            let to = Ticks::new(begin.count().saturating_add(length.count()));
            spans.push([begin, to]);
            if every <= length {
                let next = Ticks::new(begin.count().saturating_add(every.count()));
                return Err(HoldError::Overlap {
                    from: next,
                    until: to,
                });
            }
            begin = Ticks::new(begin.count().saturating_add(every.count()));
        }
        Self::new(spans)
    }

    /// True where the bed is never held.
    pub fn is_none(&self) -> bool {
        self.spans.is_empty()
    }

    /// Begin and end of each span.
    pub fn spans(&self) -> &[[Ticks; 2]] {
        &self.spans
    }

    /// Whether the bed is held at a process time, and until when that stays so.
    pub fn at(&self, process: Ticks) -> (bool, Option<Ticks>) {
        let next = self.spans.partition_point(|span| span[1] <= process);
        match self.spans.get(next) {
            Some(&[from, to]) if from <= process => (true, Some(to)),
            Some(&[from, _]) => (false, Some(from)),
            None => (false, None),
        }
    }

    /// Spans of process time up to the end of a run in which the bed moves at one acceleration factor, with it.
    pub fn moving(&self, acceleration: &Acceleration, end: Ticks) -> Vec<([Ticks; 2], f64)> {
        let (mut now, mut spans) = (Ticks::ZERO, Vec::new());
        while now < end {
            let (held, release) = self.at(now);
            let (factor, change) = acceleration.at(now);
            let next = [release, change]
                .into_iter()
                .flatten()
                .fold(end, Ticks::min);
            if !held {
                spans.push(([now, next], factor));
            }
            now = next;
        }
        spans
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(seconds: f64) -> Ticks {
        Ticks::from_seconds(seconds).unwrap()
    }

    fn span(from: f64, to: f64) -> [Ticks; 2] {
        [ticks(from), ticks(to)]
    }

    #[test]
    fn a_bed_is_held_from_the_begin_of_a_span_until_its_end() {
        let holds = Holds::new(vec![span(1.0, 2.0), span(3.0, 5.0)]).unwrap();
        let at = |time: f64| holds.at(ticks(time));
        assert_eq!(at(0.0), (false, Some(ticks(1.0))));
        assert_eq!(at(1.0), (true, Some(ticks(2.0))));
        assert_eq!(at(1.999), (true, Some(ticks(2.0))));
        assert_eq!(at(2.0), (false, Some(ticks(3.0))));
        assert_eq!(at(4.0), (true, Some(ticks(5.0))));
        assert_eq!(at(5.0), (false, None));
        assert_eq!(Holds::default().at(ticks(1.0)), (false, None));
    }

    #[test]
    fn periodic_spans_are_as_long_and_as_far_apart_as_told() {
        let holds = Holds::periodic(ticks(2.0), ticks(9.0), ticks(10.0), ticks(25.0)).unwrap();
        let spans = [span(2.0, 11.0), span(12.0, 21.0), span(22.0, 31.0)];
        assert_eq!(holds.spans(), spans);
    }

    #[test]
    fn spans_that_are_none_or_overlap_are_refused() {
        let empty = Holds::new(vec![span(2.0, 2.0)]).unwrap_err().to_string();
        assert_eq!(
            empty,
            "the bed is held from 2 s to 2 s, which is no span of time"
        );
        let overlap = Holds::new(vec![span(1.0, 3.0), span(3.0, 5.0)]).unwrap_err();
        let told = overlap.to_string();
        assert_eq!(
            told,
            "the bed is held from 3 s, but until 3 s it is held already"
        );
        let always = Holds::periodic(ticks(0.0), ticks(2.0), ticks(2.0), ticks(9.0));
        assert!(matches!(always, Err(HoldError::Overlap { .. })));
    }

    #[test]
    fn a_bed_moves_at_the_factors_of_the_times_in_which_it_is_not_held() {
        let steps = vec![
            (Ticks::ZERO, 1.0),
            (ticks(1.0), 100.0),
            (ticks(4.0), 1.0),
            (ticks(6.0), 7.0),
        ];
        let acceleration = Acceleration::schedule(steps).unwrap();
        let holds = Holds::new(vec![span(1.0, 4.0), span(5.0, 6.5)]).unwrap();
        let moving = holds.moving(&acceleration, ticks(8.0));
        let expected = vec![
            (span(0.0, 1.0), 1.0),
            (span(4.0, 5.0), 1.0),
            (span(6.5, 8.0), 7.0),
        ];
        assert_eq!(moving, expected);
    }
}
