//! What the recorder tells of a run as it stands: the summary, and the status that is watched.

use std::collections::BTreeMap;
use std::time::Duration;

use calcine_coupler::ledger::BalanceLine as LedgerSums;
use calcine_coupler::observer::{CommittedState, CutNotice, Timing};
use calcine_coupler::part::SolverInfo;

use super::Recorder;
use crate::results::ResultsError;
use crate::results::status::Status;
use crate::results::summary::{
    Backends, CaseName, LedgerLineSummary, LedgerSummary, PassedParticles, ProcessorTimes,
    SmootherSummary, SolverSummaries, SolverSummary, Summary, Verdict, WallTimes,
};

impl Recorder {
    pub(super) fn wall(&self, timing: &Timing) -> WallTimes {
        let sum = |before: f64, now: Duration| before + now.as_secs_f64();
        WallTimes {
            total: sum(self.before.total, self.watch.elapsed()),
            gas: sum(self.before.gas, timing.gas),
            particles: sum(self.before.particles, timing.particles),
            interior: sum(self.before.interior, timing.interior),
            mapping: sum(self.before.mapping, timing.mapping),
            smoother: sum(self.before.smoother, timing.smoother),
            exchange: sum(self.before.exchange, timing.exchange),
            output: sum(self.before.output, timing.output),
        }
    }

    pub(super) fn processor(&self, timing: &Timing) -> ProcessorTimes {
        let before = &self.processor_before;
        let gas = timing.gas_processor + timing.gas_processes;
        let particles = timing.particles_processor + timing.particles_processes;
        ProcessorTimes {
            gas: before.gas + gas.as_secs_f64(),
            particles: before.particles + particles.as_secs_f64(),
        }
    }

    pub(super) fn gas_phases(&self, timing: &Timing) -> BTreeMap<String, f64> {
        let Some(phases) = timing.gas_phases else {
            return self.gas_phases_before.clone();
        };
        let all = |(name, time): (&'static str, Duration)| {
            let before = self.gas_phases_before.get(name).copied();
            (name.into(), before.unwrap_or_default() + time.as_secs_f64())
        };
        phases.named().map(all).into()
    }

    pub(super) fn status(&self, moment: &CommittedState<'_>, verdict: Verdict) -> Status {
        let (now, end) = (moment.clocks.process, self.case.time.end);
        Status {
            state: verdict.state().into(),
            process_time_s: now.seconds(),
            process_end_s: end.seconds(),
            motion_time_s: moment.clocks.motion.seconds(),
            acceleration: self.case.time.acceleration.at(now).0,
            windows: moment.windows,
            motion_window_s: moment.window.map(|window| window.span.motion.seconds()),
            step_error: moment.step_error.map(|error| error.largest()),
            courant: moment.courant,
            cuts: 0,
            cut_to_s: None,
            fraction_done: now.seconds() / end.seconds(),
            wall_time_left_s: None,
        }
    }

    /// Tells the status of a window that is begun again, shorter.
    pub(super) fn tell_cut(
        &mut self,
        moment: &CommittedState<'_>,
        notice: CutNotice,
    ) -> Result<(), ResultsError> {
        if !self.watch.is_due() {
            return Ok(());
        }
        self.watch.replace(Status {
            cuts: notice.cuts,
            cut_to_s: Some(notice.span),
            ..self.status(moment, Verdict::Running)
        })
    }

    pub(super) fn summarise(
        &mut self,
        moment: &CommittedState<'_>,
        verdict: Verdict,
    ) -> Result<(), ResultsError> {
        let case = &self.case;
        let over = verdict != Verdict::Running;
        let mut captured = self.counters.captured.clone();
        captured.take(moment, self.so_far(), true);
        let steps = case.time.acceleration.steps();
        let summary = Summary {
            format: 1,
            calcine: env!("CARGO_PKG_VERSION").into(),
            case: CaseName {
                name: case.name.clone(),
                title: case.title.clone(),
                hash: case.hash.clone(),
                files: case.files.clone(),
            },
            from: self.counters.from.clone(),
            verdict,
            backend: Backends {
                gas: self.info.gas.clone(),
                particles: self.info.particles.clone(),
            },
            solver: SolverSummaries {
                gas: solver(moment.about[0]),
                particles: solver(moment.about[1]),
            },
            transport: self.info.transport.clone(),
            storage: case.time.storage.name().into(),
            acceleration: steps
                .iter()
                .map(|&(from, factor)| (from.seconds(), factor))
                .collect(),
            motion_time_s: moment.clocks.motion.seconds(),
            process_time_s: moment.clocks.process.seconds(),
            process_end_s: case.time.end.seconds(),
            case_warnings: case.warnings.clone(),
            windows: moment.windows,
            particles: moment.particles.len(),
            cells: moment.mesh.cells(),
            passed: PassedParticles::of(moment.ledger),
            flows: self.counters.flows.clone(),
            ledger: LedgerSummary {
                lines: moment
                    .ledger
                    .lines()
                    .into_iter()
                    .map(|(name, unit, line)| {
                        let told = LedgerLineSummary {
                            relative_error: moment.ledger.relative_error_in(unit, &line),
                            ..ledger_line(unit, line)
                        };
                        (name.to_owned(), told)
                    })
                    .collect(),
                elements: moment
                    .ledger
                    .elements
                    .iter()
                    .map(|(name, line)| {
                        let relative_error = moment.ledger.relative_error_of(line);
                        let line = LedgerLineSummary {
                            relative_error,
                            ..ledger_line("kg", *line)
                        };
                        (name.clone(), line)
                    })
                    .collect(),
            },
            wall_time_s: self.wall(moment.timing),
            processor_time_s: self.processor(moment.timing),
            gas_phases_s: self.gas_phases(moment.timing),
            quantities: captured.results(case, over),
            convergence: self.counters.convergence,
            steps: self.counters.steps,
            smoother: SmootherSummary {
                moved_share: moment.smoothed_share,
                largest_moved_share: self.counters.largest_moved_share,
            },
            warnings: self.counters.warnings.clone(),
            results_sum: None,
            failure: None,
            pace: (self.counters.pace.rows > 0).then_some(self.counters.pace),
        };
        summary.replace(&self.directory)?;
        self.summary = Some(summary);
        let status = self.status(moment, verdict);
        self.watch.replace(status)
    }
}

fn solver(about: &SolverInfo) -> SolverSummary {
    SolverSummary {
        name: about.name.clone(),
        version: about.version.clone(),
        ranks: about.ranks,
    }
}

fn ledger_line(unit: &str, line: LedgerSums) -> LedgerLineSummary {
    LedgerLineSummary {
        relative_error: line.relative_error(),
        drift: line.drift,
        error: line.error,
        throughput: line.throughput,
        unit: unit.into(),
    }
}
