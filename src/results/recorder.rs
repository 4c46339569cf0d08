//! The recorder: the observer that writes the results of a run.

mod summarise;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use calcine_coupler::findings::Finding;
use calcine_coupler::observer::{CommittedState, CutNotice, Observer, ObserverError};
use calcine_coupler::time::{Ticks, Window};

use super::means::FieldMeans;
use super::moment::SnapshotMoment;
use super::open::{feeds_wait, open_balance};
use super::passages;
use super::probe::{self, Site};
use super::quantities::{self, Captured, RunSoFar};
use super::rebuild::{self, rebuild};
use super::resume::{self, Counters, Restored};
use super::series::{self, Row, TRACKED_PARTICLES, Table};
use super::status::{Status, Watch};
use super::store::Store;
use super::summary::{ProcessorTimes, Provenance, RunFailure, Summary, Verdict, WallTimes};
use super::vtk::{self, Cells};
use super::{
    CASE, ResultsError, SERIES, STORE, SUMMARY, files, inertial_number, snapshot, voids, warnings,
};
use crate::case::model::Case;

/// So many rows are gathered before they go to the HDF5 file.
const BATCH: usize = 256;

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

/// What exists once the first moment is known.
struct Open {
    table: Table,
    sites: Vec<Site>,
    cells: Cells,
    /// Rows not yet in the HDF5 file.
    pending: Vec<Row>,
    store: Store,
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

    /// `results.h5` of the run that goes on: as it is where it was closed with the rows and snapshots of the checkpoint, else made anew.
    fn store(
        &self,
        moment: &CommittedState<'_>,
        columns: &[series::Column],
        sites: &[Site],
    ) -> Result<Store, ResultsError> {
        let counters = &self.counters;
        let (rows, snapshots) = (counters.rows, &counters.snapshots);
        if self.store_is_closed {
            let path = self.directory.join(STORE);
            if let Ok(store) = Store::resume(&path, columns, rows, snapshots.len()) {
                return Ok(store);
            }
        }
        tracing::info!(
            "{STORE} is made anew from {SERIES} and {} snapshots",
            snapshots.len()
        );
        let output = &self.case.output;
        let inside = snapshot::inside(output, moment);
        let mut store = rebuild(
            &self.directory,
            &rebuild::Source {
                case: &self.case,
                mesh: moment.mesh,
                columns,
                tracked: &counters.tracked,
                sites,
                rows,
                snapshots,
                gas: &snapshot::gas_fields(&output.gas, self.case.gas.properties.species(), moment),
                particles: &snapshot::particle_fields(output, &inside, moment),
            },
        )?;
        let over = |means: &&FieldMeans| means.is_over(moment.clocks.process);
        if let Some(means) = self.means.as_ref().filter(over) {
            means.with_fields(moment.mesh, |fields| store.means(means.interval(), fields))?;
        }
        Ok(store)
    }

    /// Begins means over time, or takes them up again.
    fn begin_means(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let Some(spec) = &self.case.output.means else {
            return Ok(());
        };
        let species = self.case.gas.properties.species();
        let mut means = FieldMeans::new(spec, species, moment);
        if let Some(checkpoint) = &self.resumed_from {
            means.restore(checkpoint)?;
        }
        if !means.is_over(moment.clocks.process) {
            // Those of a run that had come further, or that begins again.
            resume::remove(&self.directory.join(files::MEANS))?;
        }
        self.means = Some(means);
        Ok(())
    }

    /// Adds a window to the means over time; when their interval is over, they are written.
    fn average(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let Some(means) = &mut self.means else {
            return Ok(());
        };
        let Some(window) = moment.window else {
            return Ok(());
        };
        means.add(self.case.gas.properties.species(), moment);
        let was_over = means.is_over(window.start.process);
        if was_over || !means.is_over(moment.clocks.process) {
            return Ok(());
        }
        let (Some(means), Some(open)) = (&self.means, &mut self.open) else {
            return Ok(());
        };
        let path = self.directory.join(files::MEANS);
        let interval = means.interval();
        means.with_fields(moment.mesh, |fields| {
            vtk::write_gas(&path, moment.mesh, &open.cells, interval[1], fields)?;
            open.store.means(interval, fields)
        })
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
        if !moment.outlets.is_empty() {
            self.counters.outflow.note(moment, self.reach);
        }
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

    fn row(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let acceleration = match moment.window {
            Some(window) => window.acceleration(),
            None => self.case.time.acceleration.at(moment.clocks.process).0,
        };
        let tracked = &self.counters.tracked;
        let row = series::row(moment, acceleration, tracked, self.so_far());
        let every = self
            .case
            .output
            .series_every
            .unwrap_or(self.case.output.every);
        let moves = |window: &Window| !series::held(&self.case, window);
        if moment.window.is_some_and(moves) && series::accelerated(&self.case) {
            let number = inertial_number::of_bed(moment, self.case.gas.gravity);
            self.counters.pace.add(number);
        }
        let now = moment.clocks.process;
        self.counters.last_row = Some(now.count());
        self.counters.next_row = following(now, every);
        self.counters.rows += 1;
        let Some(open) = &mut self.open else {
            return Ok(());
        };
        open.table.append(&row)?;
        open.keep(row)
    }

    fn snapshot(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
        let gas = snapshot::gas(
            &self.case.output,
            self.case.gas.properties.species(),
            moment,
        )?;
        let inside = snapshot::inside(&self.case.output, moment);
        let particles = snapshot::particles(&self.case.output, &inside, moment)?;
        let number = self.counters.snapshots.len();
        let now = moment.clocks.process;
        let Some(open) = &mut self.open else {
            return Ok(());
        };
        let path = self.directory.join(files::gas_file(number));
        vtk::write_gas(&path, moment.mesh, &open.cells, now.seconds(), &gas)?;
        let path = self.directory.join(files::particle_file(number));
        vtk::write_particles(&path, moment.particles.position, now.seconds(), &particles)?;
        let bed = moment.particles;
        let samples = probe::samples(&open.sites, &gas, &particles, bed.position, bed.radius);
        if !samples.is_empty() {
            let path = self.directory.join(files::probe_file(number));
            probe::write(&path, &samples)?;
        }
        let at = SnapshotMoment::of(moment);
        open.store
            .snapshot(number, &at, bed.position, &gas, &particles, &samples)?;
        self.counters.snapshots.push(at);
        self.counters.last_snapshot = Some(now.count());
        self.counters.next_snapshot = following(now, self.case.output.every);
        self.collect()?;
        self.flush()
    }

    /// Replaces the two `.pvd` files.
    fn collect(&self) -> Result<(), ResultsError> {
        let entries = |file: fn(usize) -> String| -> Vec<_> {
            let times = self.counters.snapshots.iter().enumerate();
            times
                .map(|(number, at)| (at.process_time, file(number)))
                .collect()
        };
        let gas = self.directory.join(files::GAS);
        vtk::write_collection(&gas, &entries(files::gas_file))?;
        let particles = self.directory.join(files::PARTICLES);
        vtk::write_collection(&particles, &entries(files::particle_file))?;
        Ok(())
    }

    fn flush(&mut self) -> Result<(), ResultsError> {
        match &mut self.open {
            Some(open) => open.flush(),
            None => Ok(()),
        }
    }
}

impl Open {
    fn keep(&mut self, row: Row) -> Result<(), ResultsError> {
        self.pending.push(row);
        if self.pending.len() >= BATCH {
            self.flush()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), ResultsError> {
        self.store.append(&self.pending)?;
        self.pending.clear();
        self.store.flush()?;
        self.table.flush()
    }
}

/// The first multiple of `every` after a time, in ps.
fn following(now: Ticks, every: Ticks) -> i64 {
    let every = every.count().max(1);
    (now.count() / every + 1).saturating_mul(every)
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
