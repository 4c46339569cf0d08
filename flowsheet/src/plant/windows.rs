//! Waveform relaxation.

use super::flows::{LOOP_CLOSURE, Moment};
use super::run::PlantRun;
use super::waveform::{NODES, NodeIteration, TearAcceleration, Waveform, WaveformSettings};
use crate::PlantError;

/// What tear streams may differ from their polynomials between nodes, relative to the integrator's tolerance, whose own
/// errors are in them.
const BEND: f64 = 10.0;
/// An iteration whose difference has grown to so many times its least one will not settle.
const RUNAWAY: f64 = 1e4;

/// The larger of two; NaN counts as the largest.
fn larger(one: f64, other: f64) -> f64 {
    if other > one || other.is_nan() {
        other
    } else {
        one
    }
}

impl PlantRun<'_> {
    /// Advances to a time in s by waveform relaxation (docs/theory.md, FLS-1): in each window the plant, opened at its tear
    /// streams, is followed with these given as polynomials in time, until what they become at the nodes is what they were.
    pub fn advance_by_windows(
        &mut self,
        until: f64,
        settings: &WaveformSettings,
    ) -> Result<(), PlantError> {
        if self.plant.tears().is_empty() {
            return self.advance(until);
        }
        let mut span = if self.window > 0.0 {
            self.window
        } else {
            settings.first
        };
        let mut why = None;
        while self.time < until {
            let end = self.plant.next_break(self.time).min(until);
            let start = self.time;
            let took = span.min(end - start);
            match self.window(took, end, settings, &mut why)? {
                Some(iterations) => {
                    if took >= end - start {
                        self.time = end;
                        self.exchange()?;
                        self.settle()?;
                    }
                    self.window = if took < span {
                        // Shortened by the end: says nothing about the next.
                        span
                    } else if iterations <= settings.few {
                        (span * settings.change).min(settings.longest)
                    } else if iterations > settings.many {
                        // Shorter ones may need as many: those that settle are not shortened below the first.
                        (span / settings.change).max(settings.first.min(span))
                    } else {
                        span
                    };
                }
                None => {
                    self.window = 0.5 * took;
                    if self.window < settings.shortest {
                        return Err(why.unwrap_or(PlantError::Steps {
                            reached: self.time,
                            cause: "windows became too short for their tear streams; take `monolithic` in place of `waveform`",
                        }));
                    }
                }
            }
            span = self.window;
        }
        Ok(())
    }

    /// One window; the iterations it took, or none where it has to be shorter (the state is then that of its start). A plant
    /// that could not be followed with tear streams that are given, too, is tried in a shorter one; `why` is what it said.
    fn window(
        &mut self,
        span: f64,
        end: f64,
        settings: &WaveformSettings,
        why: &mut Option<PlantError>,
    ) -> Result<Option<usize>, PlantError> {
        let start = self.clone_state();
        let streams = self.now.work.streams.clone();
        let mut ways = vec![settings.acceleration];
        // Secants of every number for itself do not settle on all recycles.
        if settings.acceleration != TearAcceleration::Anderson {
            ways.push(TearAcceleration::Anderson);
        }
        for acceleration in ways {
            match self.relax(span, end, settings, acceleration) {
                Err(error) => {
                    self.now.work.given = None;
                    self.now.work.streams.copy_from_slice(&streams);
                    self.restore(&start);
                    if matches!(error, PlantError::Interrupted(_)) {
                        return Err(error);
                    }
                    *why = Some(error);
                }
                done => return done,
            }
        }
        Ok(None)
    }

    /// [`Self::window`] by one acceleration; an error where that does not settle.
    fn relax(
        &mut self,
        span: f64,
        end: f64,
        settings: &WaveformSettings,
        acceleration: TearAcceleration,
    ) -> Result<Option<usize>, PlantError> {
        let start = self.clone_state();
        let from = self.time;
        // The streams of now, closed at once, are the first guess of all nodes.
        let at = Moment { time: from, end };
        self.now.work.given = None;
        self.plant.flows(at, &self.now.y, &mut self.now.work)?;
        let mut wave = Waveform::constant(from, span, &self.plant.torn(&self.now.work));
        let size = wave.values[0].len();
        let mut iteration = NodeIteration::new();
        let mut least = f64::INFINITY;
        // What settles does so soon, and where secants do not, Anderson's method is tried.
        let most = match acceleration {
            TearAcceleration::Anderson => settings.most,
            TearAcceleration::Wegstein(_) => settings.most.min(2 * settings.many),
        };
        for count in 1..=most {
            self.restore(&start);
            self.now.work.given = Some(wave.clone());
            let mut x = Vec::with_capacity(NODES * size);
            let mut made = Vec::with_capacity(NODES * size);
            let (mut closures, mut bend) = (vec![0.0f64; self.closures.len()], 0.0f64);
            for k in 0..NODES {
                let time = if k == NODES - 1 {
                    from + span
                } else {
                    from + span * Waveform::node(k)
                };
                // Halfway between nodes the polynomial is compared with what it became, too.
                if k > 0 {
                    let middle = 0.5 * (self.time + time);
                    self.follow(middle, |_| ())?;
                    let there = self.torn_differences(middle, end)?;
                    bend = there.into_iter().fold(bend, larger);
                    self.follow(time, |_| ())?;
                }
                let there = self.torn_differences(time, end)?;
                let pairs = closures.iter_mut().zip(there);
                pairs.for_each(|(largest, own)| *largest = larger(*largest, own));
                x.extend_from_slice(&wave.values[k]);
                made.extend_from_slice(&self.now.work.became);
            }
            let closure = closures.iter().copied().fold(0.0, larger);
            if closure <= LOOP_CLOSURE * 10.0 {
                if bend > BEND * self.tolerance.max(LOOP_CLOSURE * 100.0)
                    && span > settings.shortest
                {
                    self.now.work.given = None;
                    self.restore(&start);
                    return Ok(None);
                }
                self.time = from + span;
                self.now.work.given = None;
                let pairs = self.closures.iter_mut().zip(&closures);
                pairs.for_each(|(largest, own)| *largest = largest.max(*own));
                let now = Moment {
                    time: self.time,
                    end,
                };
                self.plant.verify(now, &self.now.y, &self.now.work)?;
                return Ok(Some(count));
            }
            if closure.is_nan() || closure > RUNAWAY * least {
                break;
            }
            least = least.min(closure);
            let plain = made.clone();
            self.plant.weigh_heat(&mut x, true);
            self.plant.weigh_heat(&mut made, true);
            iteration.accelerate(acceleration, &x, &mut made);
            self.plant.weigh_heat(&mut made, false);
            let pairs = made.chunks_exact(size).zip(plain.chunks_exact(size));
            for (values, (new, plain)) in wave.values.iter_mut().zip(pairs) {
                // A guess whose flows run backwards is none.
                let turned = self.plant.turns(new, plain);
                values.copy_from_slice(if turned { plain } else { new });
            }
        }
        Err(PlantError::Steps {
            reached: from,
            cause: "tear streams of its windows do not settle; take `monolithic` in place of `waveform`",
        })
    }

    /// What the tear streams became at the present unknowns, against what they were.
    fn torn_differences(&mut self, time: f64, end: f64) -> Result<Vec<f64>, PlantError> {
        let at = Moment { time, end };
        self.plant.flows(at, &self.now.y, &mut self.now.work)?;
        let were = self.plant.torn(&self.now.work);
        let mut all = Vec::new();
        let became = &self.now.work.became;
        self.plant.differences(&were, became, &mut all);
        Ok(all)
    }
}
