//! What the recorder writes while a run goes on: rows, snapshots, and `results.h5` of a run that goes on with one.

use calcine_coupler::observer::CommittedState;
use calcine_coupler::time::{Ticks, Window};

use super::Recorder;
use crate::results::means::FieldMeans;
use crate::results::moment::SnapshotMoment;
use crate::results::probe::{self, Site};
use crate::results::rebuild::{self, rebuild};
use crate::results::series;
use crate::results::store::Store;
use crate::results::vtk;
use crate::results::{ResultsError, SERIES, STORE, files, inertial_number, snapshot};

impl Recorder {
    /// `results.h5` of the run that goes on: as it is where it was closed with the rows and snapshots of the checkpoint, else made anew.
    pub(super) fn store(
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

    pub(super) fn row(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
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

    pub(super) fn snapshot(&mut self, moment: &CommittedState<'_>) -> Result<(), ResultsError> {
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
    pub(super) fn collect(&self) -> Result<(), ResultsError> {
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

    pub(super) fn flush(&mut self) -> Result<(), ResultsError> {
        match &mut self.open {
            Some(open) => open.flush(),
            None => Ok(()),
        }
    }
}

/// The first multiple of `every` after a time, in ps.
fn following(now: Ticks, every: Ticks) -> i64 {
    let every = every.count().max(1);
    (now.count() / every + 1).saturating_mul(every)
}
