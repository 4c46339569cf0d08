//! Checkpoints: one folder, replaced atomically, with all that decides the next window. Writing one changes nothing in the
//! coordinator and in native participants.

use std::fs;
use std::time::Instant;

use calcine_physics::Vec3;

use super::CoupledRun;
use super::error::{CheckpointError, RunError};
use super::meter::{Meter, Stage};
use super::neighbours::NeighbourStanding;
use super::repeat::WindowCut;
use crate::checkpoint::StateFile;
use crate::ledger::{CarriedInventory, Ledger};
use crate::observer::Observer;
use crate::part::{Gas as _, Part as _};
use crate::time::{Clocks, Ticks};

impl CoupledRun {
    /// Writes a checkpoint of all participants.
    pub fn checkpoint(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), RunError> {
        let running = Meter::start(Stage::Output);
        let written = self.write_checkpoint(observers);
        if written.is_err() {
            // What could not be written fills the disk no longer; the last one stays.
            let _ = fs::remove_dir_all(self.plan.checkpoint.fresh());
        }
        self.meter.stop(running);
        written
    }

    fn write_checkpoint(&mut self, observers: &mut [&mut dyn Observer]) -> Result<(), RunError> {
        let fresh = self.plan.checkpoint.fresh();
        let failed = |doing, cause| CheckpointError::Io {
            path: fresh.clone(),
            doing,
            cause,
        };
        if fresh.exists() {
            fs::remove_dir_all(&fresh).map_err(|cause| failed("clearing it", cause))?;
        }
        let (gas, particles) = (fresh.join("gas"), fresh.join("particles"));
        for directory in [&gas, &particles] {
            fs::create_dir_all(directory).map_err(|cause| failed("creating it", cause))?;
        }
        self.parts.gas.checkpoint(&gas)?;
        self.parts.particles.checkpoint(&particles)?;
        self.own_state().write(&fresh.join("coordinator.state"))?;
        self.note_processors();
        for observer in observers.iter_mut() {
            observer.checkpoint(&self.moment(None), &fresh)?;
        }
        self.plan.checkpoint.publish()?;
        self.last_checkpoint = Instant::now();
        Ok(())
    }

    /// Takes up the state of all particles.
    pub(super) fn restore_particles(&mut self, state: &StateFile) -> Result<(), RunError> {
        self.interior.models.restore(state)?;
        self.interior.weigh(&self.parts.particles.fields());
        Ok(())
    }

    fn own_state(&self) -> StateFile {
        let mut state = StateFile::new();
        let ledger: Vec<f64> = self
            .ledger
            .all()
            .iter()
            .flat_map(|line| [line.drift, line.error, line.throughput])
            .collect();
        let clocks = [
            self.windows,
            self.clocks.motion.count().cast_unsigned(),
            self.clocks.process.count().cast_unsigned(),
        ];
        let hash = self
            .plan
            .case_hash
            .bytes()
            .map(u64::from)
            .collect::<Vec<_>>();
        state.set_f64s("ledger", &ledger);
        state.set_u64s("windows_and_clocks", &clocks);
        state.set_u64s("window_cut", &self.cut.numbers());
        self.length.record(&mut state);
        state.set_u64s("held", &[self.motion.held.count().cast_unsigned()]);
        state.set_u64s("case_hash", &hash);
        self.interior.models.record(&mut state);
        let particles = self.parts.particles.fields();
        let standing = NeighbourStanding {
            time: self.clocks.process.seconds(),
            moves: !self.plan.free.is_empty(),
            moved: self.neighbours_due || self.bed.is_of_other_places(&particles),
        };
        self.interior.record_neighbours(&standing, &mut state);
        state.set_f64s("particle_heat", &self.exchange.exchange.heat);
        self.bodies.record(&mut state);
        let other: Vec<f64> = self
            .motion
            .other
            .iter()
            .flat_map(|f| f.iter().copied())
            .collect();
        state.set_f64s("particle_other_force", &other);
        if self.plan.window_drag.follows() {
            let owed = self.motion.carry.owed().iter();
            let owed: Vec<f64> = owed.flat_map(|impulse| impulse.iter().copied()).collect();
            state.set_f64s("drag_carry", &owed);
        }
        let moved: Vec<f64> = self
            .ledger
            .fed_and_discharged
            .iter()
            .chain([&self.ledger.used_up, &self.ledger.lost])
            .flat_map(CarriedInventory::numbers)
            .collect();
        state.set_f64s("traffic_moved", &moved);
        self.plan.feeds_and_outlets.record(&mut state);
        self.plan.feeds_and_outlets.outflows.record(&mut state);
        self.record_controls(&mut state);
        self.record_identity(&mut state);
        state
    }

    /// Takes up the committed checkpoint. Gas and particles were built from its folders already.
    pub fn resume(&mut self) -> Result<(), RunError> {
        let directory = self.plan.checkpoint.committed();
        let state = StateFile::read(&directory.join("coordinator.state"))?;
        let found: String = state
            .u64s("case_hash")?
            .iter()
            .map(|&byte| char::from(u8::try_from(byte).unwrap_or(b'?')))
            .collect();
        if found != self.plan.case_hash {
            let expected = self.plan.case_hash.clone();
            return Err(CheckpointError::OtherCase {
                path: directory,
                found,
                expected,
            }
            .into());
        }
        let heat = state.f64s("particle_heat")?;
        let expected = self.parts.particles.fields().len();
        if heat.len() != expected {
            let found = heat.len();
            return Err(CheckpointError::Particles {
                path: directory,
                found,
                expected,
            }
            .into());
        }
        self.motion.restore_other(&state)?;
        if self.plan.window_drag.follows() {
            let owed = state.f64s("drag_carry")?.as_chunks::<3>().0.iter();
            let owed = owed.map(|impulse| Vec3::from(*impulse)).collect();
            self.motion.carry.restore(owed);
        }
        let moved = state.f64s_of("traffic_moved", 24)?.chunks_exact(6);
        let Ledger {
            fed_and_discharged,
            used_up,
            lost,
            ..
        } = &mut self.ledger;
        for (total, values) in fed_and_discharged
            .iter_mut()
            .chain([used_up, lost])
            .zip(moved)
        {
            let numbers = <[f64; 6]>::try_from(values).unwrap_or_default();
            *total = CarriedInventory::from_numbers(numbers);
        }
        self.plan.feeds_and_outlets.restore(&state)?;
        self.plan.feeds_and_outlets.outflows.restore(&state)?;
        self.restore_particles(&state)?;
        self.exchange.exchange.heat.copy_from_slice(heat);
        self.bodies.resume(&state)?;
        for (line, values) in self
            .ledger
            .lines_mut()
            .into_iter()
            .zip(state.f64s("ledger")?.chunks_exact(3))
        {
            line.drift = values[0];
            line.error = values[1];
            line.throughput = values[2];
        }
        if let [windows, motion, process] = *state.u64s("windows_and_clocks")? {
            self.windows = windows;
            self.clocks = Clocks {
                motion: Ticks::new(motion.cast_signed()),
                process: Ticks::new(process.cast_signed()),
            };
        }
        if let Ok(numbers) = <[u64; 3]>::try_from(state.u64s("window_cut")?) {
            self.cut = WindowCut::from_numbers(numbers);
        }
        if let [held] = *state.u64s("held")? {
            self.motion.held = Ticks::new(held.cast_signed());
        }
        self.restore_controls(&state)?;
        self.length.restore(&self.parts.gas.fields(), &state)?;
        self.neighbours_due = self.interior.restore_neighbours(&state)?;
        Ok(())
    }
}
