//! The recorder: the observer that writes the results of a run.

mod means;
mod opened;
mod summarise;
mod written;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calcine_coupler::findings::Finding;
use calcine_coupler::observer::{CommittedState, CutNotice, Observer, ObserverError};

use super::means::FieldMeans;
use super::open::{feeds_wait, open_balance};
use super::passages;
use super::probe;
use super::quantities::{self, Captured, RunSoFar};
use super::resume::{self, Counters, Restored};
use super::series::{self, TRACKED_PARTICLES, Table};
use super::status::{Status, Watch};
use super::store::Store;
use super::summary::{ProcessorTimes, Provenance, RunFailure, Summary, Verdict, WallTimes};
use super::vtk::Cells;
use super::{CASE, ResultsError, STORE, SUMMARY, files, voids, warnings};
use crate::case::model::Case;
use opened::Open;

/// What the summary says of a run beside its case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunInfo {
    /// Kind of the gas solver: `native`, `openfoam`.
    pub gas: String,
    /// Kind of the particle solver: `native`, `liggghts`.
    pub particles: String,
    /// How the coordinator talks to them: `none`, `shared-memory`, `mpi`.
    pub transport: String,
    /// The run that this one continues from; where it resumes, what it began with counts.
    pub from: Option<Provenance>,
}

/// Writes the results of a run.
pub struct Recorder {
    case: Case,
    info: RunInfo,
    directory: PathBuf,
    resumed: bool,
    /// False where `results.h5` of the run to go on with may be in the middle of a change.
    store_is_closed: bool,
    counters: Counters,
    /// Wall times of the processes before this one.
    before: WallTimes,
    /// Their processor times.
    processor_before: ProcessorTimes,
    /// Their wall times of the gas' phases.
    gas_phases_before: BTreeMap<String, f64>,
    watch: Watch,
    /// Means over time, once the run has begun.
    means: Option<FieldMeans>,
    /// The checkpoint to go on from.
    resumed_from: Option<PathBuf>,
    /// By how many ps of process time measures look back.
    reach: i64,
    open: Option<Open>,
    summary: Option<Summary>,
}

impl Recorder {
    /// Prepares the result directory `out`. With `resume`, a checkpoint directory that
    /// [`Observer::checkpoint`] filled, the results go on from there; without, a directory that
    /// holds the results of another run is refused.
    pub fn create(
        case: &Case,
        info: RunInfo,
        out: &Path,
        resume: Option<&Path>,
    ) -> Result<Self, ResultsError> {
        if resume.is_none() {
            unoccupied(out)?;
        }
        let probes = (!case.probes.is_empty()).then_some("probes");
        for folder in ["gas", "particles"].into_iter().chain(probes) {
            files::directory(&out.join(folder))?;
        }
        let restored = match resume {
            Some(checkpoint) => resume::restore(checkpoint, out, case)?,
            None => Restored {
                counters: Counters {
                    case_hash: case.hash.clone(),
                    from: info.from.clone(),
                    captured: Captured::new(case.quantities.len()),
                    ..Counters::default()
                },
                store_is_closed: false,
            },
        };
        let counters = restored.counters;
        files::replace(&out.join(CASE), case.effective.as_bytes())?;
        files::replace(
            &out.join(files::PARAVIEW),
            files::PARAVIEW_SCRIPT.as_bytes(),
        )?;
        Ok(Self {
            case: case.clone(),
            info,
            directory: out.to_owned(),
            resumed: resume.is_some(),
            store_is_closed: restored.store_is_closed,
            before: counters.wall,
            processor_before: counters.processor,
            gas_phases_before: counters.gas_phases.clone(),
            counters,
            watch: Watch::new(out, 0.0),
            means: None,
            resumed_from: resume.map(Path::to_owned),
            reach: passages::reach(case),
            open: None,
            summary: None,
        })
    }

    /// The summary as written last; `None` before the run has started.
    pub fn summary(&self) -> Option<&Summary> {
        self.summary.as_ref()
    }

    /// Says in summary and status that the run stopped early: on an interrupt, or with an error.
    pub fn stopped(&mut self, failure: Option<RunFailure>) -> Result<(), ResultsError> {
        // Closed before the summary says so.
        self.open = None;
        let Some(summary) = &mut self.summary else {
            return Ok(());
        };
        summary.results_sum = resume::sum_of_store(&self.directory);
        summary.warnings.clone_from(&self.counters.warnings);
        summary.failure = failure;
        summary.verdict = Verdict::Stopped;
        let status = Status::of(summary);
        let summary = summary.replace(&self.directory);
        self.watch.close(status)?;
        summary
    }

    fn begin(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        self.watch = Watch::new(&self.directory, moment.clocks.process.seconds());
        for quantity in &self.case.quantities {
            quantities::check(quantity, moment.mesh)?;
        }
        if !self.resumed && moment.particles.len() <= TRACKED_PARTICLES {
            self.counters.tracked = moment.particles.id.to_vec();
        }
        self.begin_means(moment)?;
        let columns = series::columns(&self.case, moment);
        let sites = probe::sites(&self.case.probes, moment.mesh)?;
        let tracked = &self.counters.tracked;
        let table = if self.resumed {
            Table::resume(&self.directory, &columns, tracked)?
        } else {
            Table::create(&self.directory, &columns, tracked)?
        };
        let store = if self.resumed {
            self.store(moment, &columns, &sites)?
        } else {
            let path = self.directory.join(STORE);
            Store::create(&path, &self.case, moment.mesh, &columns, tracked, &sites)?
        };
        self.open = Some(Open {
            table,
            sites,
            cells: Cells::new(moment.mesh),
            pending: Vec::new(),
            store,
        });
        self.collect()?;
        self.smoothed(moment);
        self.note_outflow(moment);
        if !self.resumed {
            self.row(moment)?;
            self.snapshot(moment)?;
        }
        self.flush()?;
        self.summarise(moment, Verdict::Running)
    }

    fn advance(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        self.count(moment);
        self.average(moment)?;
        let now = moment.clocks.process;
        if self.counters.captured.is_due(&self.case, now.seconds()) {
            self.capture(moment, false);
        }
        if now.count() >= self.counters.next_row {
            self.row(moment)?;
        }
        if now.count() >= self.counters.next_snapshot {
            self.snapshot(moment)?;
        }
        if self.watch.is_due() {
            if let Some(open) = &mut self.open {
                open.table.flush()?;
            }
            self.watch.replace(self.status(moment, Verdict::Running))?;
        }
        Ok(())
    }

    fn save(&mut self, moment: &CommittedState<'_>, directory: &Path) -> Result<(), ResultsError> {
        self.flush()?;
        resume::seal(&self.directory, &mut self.counters)?;
        let mut counters = self.counters.clone();
        if let Some(open) = &mut self.open {
            counters.series = open.table.mark()?;
        }
        counters.wall = self.wall(moment.timing);
        counters.processor = self.processor(moment.timing);
        counters.gas_phases = self.gas_phases(moment.timing);
        resume::save(&self.directory, directory, counters)?;
        if let Some(means) = &self.means {
            means.save(directory)?;
        }
        self.summarise(moment, Verdict::Running)
    }

    fn end(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let now = Some(moment.clocks.process.count());
        if self.counters.last_row != now {
            self.row(moment)?;
        }
        if self.counters.last_snapshot != now {
            self.snapshot(moment)?;
        }
        self.flush()?;
        if let Some(voids) = voids::of_bed(&self.case, &moment.particles) {
            voids.write(&self.directory)?;
        }
        self.capture(moment, true);
        if let Some(words) = self.pace_warning() {
            tracing::warn!("{words}");
        }
        let time = moment.clocks.process.seconds();
        let findings = open_balance(moment).into_iter().chain(feeds_wait(moment));
        let findings: Vec<Finding> = findings.collect();
        for words in warnings::add(&mut self.counters.warnings, &findings, time) {
            tracing::warn!("{words}");
        }
        let results = self.counters.captured.results(&self.case, true);
        self.summarise(moment, quantities::overall(results.values()))
    }

    /// What measures look at beside the moment.
    fn so_far(&self) -> RunSoFar<'_> {
        RunSoFar {
            case: &self.case,
            sites: self.open.as_ref().map_or(&[][..], |open| &open.sites),
            outflow: &self.counters.outflow,
        }
    }

    /// Names and values of the quantities of the case at a moment of this run.
    pub fn quantities(&self, moment: &CommittedState<'_>) -> Vec<(&str, f64)> {
        let quantities = self.case.quantities.iter();
        let value = |quantity| quantities::evaluate(quantity, moment, self.so_far());
        quantities
            .map(|quantity| (quantity.name.as_str(), value(quantity)))
            .collect()
    }

    /// Keeps the values of quantities whose time has come, or with `latest` of all.
    fn capture(&mut self, moment: &CommittedState<'_>, latest: bool) {
        let mut captured = std::mem::take(&mut self.counters.captured);
        captured.take(moment, self.so_far(), latest);
        self.counters.captured = captured;
    }

    /// Whether the bed was moved too fast, in words.
    fn pace_warning(&self) -> Option<String> {
        let pace = &self.counters.pace;
        (pace.rows > 0).then(|| pace.warning()).flatten()
    }

    /// Keeps the largest share of the solid that the smoother moved.
    fn smoothed(&mut self, moment: &CommittedState<'_>) {
        let largest = &mut self.counters.largest_moved_share;
        *largest = largest.max(moment.smoothed_share);
    }

    /// Notes what left through outlets.
    fn note_outflow(&mut self, moment: &CommittedState<'_>) {
        self.counters.outflow.note(moment, self.reach);
    }

    /// Adds the window's convergence.
    fn count(&mut self, moment: &CommittedState<'_>) {
        self.smoothed(moment);
        self.note_outflow(moment);
        let time = moment.clocks.process.seconds();
        let span = moment
            .window
            .map_or(0.0, |window| window.span.process.seconds());
        let species = self.case.gas.properties.species();
        let flows = &mut self.counters.flows;
        flows.add(&moment.ledger.flows, species, span);
        let patches = moment.mesh.patches();
        flows.add_patches(patches, moment.patch_flows, species, span);
        for first in warnings::add(&mut self.counters.warnings, moment.findings, time) {
            tracing::warn!("{first}; counted in {SUMMARY}, not told of again");
        }
        let bounds = self.case.time.window_bounds;
        let bounds = [
            bounds.and_then(|bounds| bounds.error),
            bounds.and_then(|bounds| bounds.courant),
        ];
        self.counters.steps.add(moment, bounds);
        let (sums, window) = (&mut self.counters.convergence, moment.convergence);
        sums.unconverged_windows += u64::from(!window.converged);
        sums.unsettled_windows += u64::from(!moment.exchange_convergence.settled);
        sums.attempts += u64::from(moment.exchange_convergence.attempts);
        sums.cuts += u64::from(moment.exchange_convergence.cuts);
        sums.largest_misplaced = sums
            .largest_misplaced
            .max(moment.exchange_convergence.misplaced);
        sums.outer_iterations += u64::from(window.outer_iterations);
        sums.linear_iterations += u64::from(window.linear_iterations);
        sums.largest_residual = sums.largest_residual.max(window.residual);
        sums.largest_volume_residual = sums.largest_volume_residual.max(window.volume_residual);
    }
}

/// Refuses a directory that holds the results of a run.
pub fn unoccupied(out: &Path) -> Result<(), ResultsError> {
    if !out.join(SUMMARY).exists() {
        return Ok(());
    }
    let summary = Summary::read(out)?;
    Err(ResultsError::Occupied {
        path: out.to_owned(),
        case: summary.case.name,
        state: summary.verdict.state(),
        time: summary.process_time_s,
    })
}

impl Observer for Recorder {
    fn start(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError> {
        Ok(self.begin(moment)?)
    }

    fn window(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError> {
        Ok(self.advance(moment)?)
    }

    fn cut(&mut self, moment: &CommittedState<'_>, notice: CutNotice) -> Result<(), ObserverError> {
        Ok(self.tell_cut(moment, notice)?)
    }

    fn checkpoint(
        &mut self,
        moment: &CommittedState<'_>,
        directory: &Path,
    ) -> Result<(), ObserverError> {
        Ok(self.save(moment, directory)?)
    }

    fn finish(&mut self, moment: &CommittedState<'_>) -> Result<(), ObserverError> {
        Ok(self.end(moment)?)
    }
}
