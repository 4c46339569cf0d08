//! The native particles: spheres that stay where they are, or that move by the discrete element solver.

pub(crate) mod check;
pub mod dem;
mod state;

use std::path::Path;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::motion::{Contacts, Motion, ParticleChanges};
use calcine_coupler::named_columns::NamedColumns;
use calcine_coupler::part::{
    Bed, DRAG_IMPULSE, Part, ParticleFields, ParticlePush, ParticleReceived, Particles, SolverInfo,
};
use calcine_coupler::periodic_motion::check_period;
use calcine_coupler::physics::figures::Brief;
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::{Ticks, Window};

pub use crate::gas::NativeError;
use crate::pushed_drag::{pushed_drag, takes};
use check::check;
use dem::energy::BedEnergy;
use dem::{Engine, EscapedParticle, InsertedSphere, StoredContact, StoredWallContact};

/// Steps between two looks at the user's interrupts.
const SLICE: i64 = 200;
/// A window is whole steps where it differs from them by a smaller share: by the rounding of its ticks.
const WHOLE: f64 = 1e-11;

/// A bed: frozen, or in motion.
#[derive(Debug)]
pub struct NativeParticles {
    about: SolverInfo,
    id: Vec<u64>,
    population: Vec<u32>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    angular_velocity: Vec<Vec3>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    /// Empty where each particle stands for itself alone.
    weight: Vec<f64>,
    started: Option<Window>,
    impulse: Vec<Vec3>,
    /// Coefficients and gas velocities of the drag that follows velocities in the window, as its steps have them; empty
    /// where there is none.
    drag: (Vec<f64>, Vec<Vec3>),
    /// Motion time in s that the steps of the window cover.
    acted: f64,
    /// The solver of moving particles.
    engine: Option<Box<Engine>>,
    /// Steps of the run so far.
    steps: i64,
}

impl NativeParticles {
    /// The bed of a setup; masses are 4/3 π r³ ρ.
    pub fn new(setup: &ParticleSetup) -> Result<Self, NativeError> {
        check(setup)?;
        if matches!(setup.motion, Motion::Parcels(_)) {
            return Err(NativeError::OtherMotion {
                takes: "frozen and free particles",
                given: "parcels",
            });
        }
        let count = setup.id.len();
        let spheres = setup.radius.iter().zip(&setup.density);
        let mut bed = Self {
            about: SolverInfo {
                name: "native particles".into(),
                version: env!("CARGO_PKG_VERSION").into(),
                ranks: 1,
            },
            id: setup.id.clone(),
            population: setup.population.clone(),
            position: setup.position.clone(),
            velocity: vec![Vec3::zeros(); count],
            angular_velocity: vec![Vec3::zeros(); count],
            radius: setup.radius.clone(),
            mass: spheres
                .map(|(&radius, &density)| sphere::mass(radius, density))
                .collect(),
            weight: setup.weight.clone(),
            started: None,
            impulse: vec![Vec3::zeros(); count],
            drag: (Vec::new(), Vec::new()),
            acted: 0.0,
            engine: None,
            steps: 0,
        };
        if let Motion::Free(contacts) = &setup.motion {
            if !setup.velocity.is_empty() {
                bed.velocity.clone_from(&setup.velocity);
            }
            if !setup.angular_velocity.is_empty() {
                bed.angular_velocity.clone_from(&setup.angular_velocity);
            }
            bed.engine = Some(Box::new(Engine::new(Contacts::clone(contacts))));
            bed.hand_over((Vec::new(), Vec::new()))
                .map_err(|stray| bed.outside(stray))?;
        }
        Ok(bed)
    }

    /// The solver of moving particles; nothing for a frozen bed.
    pub fn engine(&self) -> Option<&Engine> {
        self.engine.as_deref()
    }

    /// Counts energies from now on, at some cost, or no longer.
    pub fn count_energy(&mut self, on: bool) {
        if let Some(engine) = &mut self.engine {
            engine.count_energy(on);
        }
    }

    /// Energies of a moving bed now, as far as they are counted.
    pub fn energy(&self) -> BedEnergy {
        self.engine
            .as_ref()
            .map(|engine| engine.energy())
            .unwrap_or_default()
    }

    /// All particles as the solver takes them.
    fn spheres(&self) -> Vec<InsertedSphere> {
        let Some(engine) = &self.engine else {
            return Vec::new();
        };
        let contacts = engine.contacts();
        let particle = |row: usize| {
            let population = self.population[row] as usize;
            InsertedSphere {
                centre: self.position[row],
                velocity: self.velocity[row],
                spin: self.angular_velocity[row],
                radius: self.radius[row],
                mass: self.mass[row],
                material: contacts.material_of[population] as u32,
                held: contacts.held[population],
            }
        };
        (0..self.id.len()).map(particle).collect()
    }

    /// Gives all particles to the solver, with the memories of their contacts; it evaluates their forces.
    fn hand_over(
        &mut self,
        memories: (Vec<StoredContact>, Vec<StoredWallContact>),
    ) -> Result<(), EscapedParticle> {
        let particles = self.spheres();
        let Some(engine) = &mut self.engine else {
            return Ok(());
        };
        engine.load(&particles, memories, self.steps)?;
        self.read();
        Ok(())
    }

    /// Takes over what the solver has reached; places between the periodic planes.
    fn read(&mut self) {
        self.read_unwrapped();
        let Some(engine) = &self.engine else { return };
        let periodicity = &engine.contacts().periodicity;
        if !periodicity.is_none() {
            for place in &mut self.position {
                *place = periodicity.wrap(*place);
            }
        }
    }

    /// The same with places as the solver has them, beyond periodic planes since its last search for neighbours.
    fn read_unwrapped(&mut self) {
        if let Some(engine) = &self.engine {
            engine.read(
                &mut self.position,
                &mut self.velocity,
                &mut self.angular_velocity,
            );
        }
    }

    /// The error of a particle that left the bounds.
    fn outside(&self, stray: EscapedParticle) -> NativeError {
        NativeError::OutOfBounds {
            id: self.id[stray.row as usize],
            place: stray.centre.into(),
            velocity: stray.velocity.into(),
        }
    }

    /// Number of the first and the last step of a window.
    fn steps(&self, window: &Window) -> (i64, i64) {
        let end = window.start.motion.count() + window.span.motion.count();
        let begin = self.nearest(window.start.motion);
        (begin, self.nearest(Ticks::new(end)))
    }

    /// Has the forces act over the window's steps so much that their impulse is that over its span.
    fn push(&mut self, window: &Window, force: &[Vec3]) -> Result<(), PartError> {
        let span = window.span.motion.seconds();
        self.impulse.clear();
        self.impulse.extend(force.iter().map(|force| force * span));
        self.acted = span;
        let (begin, end) = self.steps(window);
        let Some(engine) = &mut self.engine else {
            return Ok(());
        };
        let step = engine.contacts().step;
        if end <= begin {
            let message = format!(
                "a window of {} s holds no time step of {} s; shorten `motion.motion_step`",
                Brief(span),
                Brief(step)
            );
            return Err(self
                .failure(FailureKind::Protocol, message)
                .in_window(window));
        }
        self.acted = (end - begin) as f64 * step;
        let scale = span / self.acted;
        if (scale - 1.0).abs() < WHOLE {
            engine.push(force);
        } else {
            let scaled: Vec<Vec3> = force.iter().map(|force| force * scale).collect();
            engine.push(&scaled);
        }
        Ok(())
    }

    /// Takes up drag by coefficient and gas velocity, after the forces. Like these, coefficients are scaled such that they
    /// act over the window's span, whatever the steps.
    fn take_drag(&mut self, window: &Window, columns: &NamedColumns) -> Result<(), PartError> {
        self.drag.0.clear();
        self.drag.1.clear();
        let pushed = pushed_drag(columns, self.id.len()).map_err(|message| {
            self.failure(FailureKind::Protocol, message)
                .in_window(window)
        })?;
        let Some(drag) = pushed else { return Ok(()) };
        let scale = window.span.motion.seconds() / self.acted;
        self.drag
            .0
            .extend(drag.coefficient.iter().map(|drag| scale * drag));
        self.drag
            .1
            .extend(drag.gas.iter().map(|one| Vec3::from(*one)));
        if let Some(engine) = &mut self.engine {
            engine.drag(&self.drag.0, &self.drag.1);
        }
        Ok(())
    }

    /// Reports the impulse of drag that followed velocities, and adds it to that of the forces.
    fn report_drag(&mut self, received: &mut ParticleReceived) {
        received.columns.clear();
        let (coefficient, gas) = &self.drag;
        if coefficient.is_empty() {
            return;
        }
        let pairs = coefficient.iter().zip(gas);
        let mut drags: Vec<Vec3> = pairs.map(|(drag, gas)| *drag * self.acted * gas).collect();
        if let Some(engine) = &self.engine {
            engine.read_drag(&mut drags);
        }
        for (impulse, drag) in self.impulse.iter_mut().zip(&drags) {
            *impulse += drag;
        }
        let values = drags.iter().flat_map(|drag| <[f64; 3]>::from(*drag));
        received.columns.set(DRAG_IMPULSE, 3, values.collect());
    }

    fn advance(&mut self, window: &Window, supervisor: &Supervisor) -> Result<(), PartError> {
        let (mut done, end) = self.steps(window);
        while done < end {
            let steps = (end - done).min(SLICE);
            let Some(engine) = &mut self.engine else {
                return Ok(());
            };
            if let Err(stray) = engine.advance(done, steps) {
                let error = self.outside(stray);
                return Err(self
                    .failure(FailureKind::LostParticles, error.to_string())
                    .in_window(window)
                    .caused_by(error));
            }
            done += steps;
            if supervisor.interrupts().count() >= 2 {
                return Err(self
                    .failure(FailureKind::Interrupted, "interrupted")
                    .in_window(window));
            }
        }
        self.steps = end;
        self.read();
        Ok(())
    }

    /// The step nearest to a motion time; windows are whole steps between those of their ends, so that
    /// rounding never adds up.
    fn nearest(&self, time: Ticks) -> i64 {
        let step = self
            .engine
            .as_ref()
            .map_or(1.0, |engine| engine.contacts().step);
        (time.count() as f64 / (step * Ticks::PER_SECOND)).round() as i64
    }

    fn failure(&self, kind: FailureKind, message: impl Into<String>) -> PartError {
        PartError::new(self.about.name.clone(), kind, message)
    }

    fn refused(&self, error: NativeError) -> PartError {
        let kind = match &error {
            NativeError::OutOfBounds { .. } => FailureKind::LostParticles,
            _ => FailureKind::InvalidInput,
        };
        self.failure(kind, error.to_string()).caused_by(error)
    }

    /// Gives particles that stay another radius and mass.
    fn resize(&mut self, change: &ParticleChanges) -> Result<(), NativeError> {
        for (row, new) in check::resized(change, &self.id)? {
            self.radius[row] = new.radius;
            self.mass[row] = new.mass;
        }
        Ok(())
    }

    /// Takes particles out and puts new ones in; the others keep the memories of their contacts.
    fn exchange(&mut self, change: &ParticleChanges) -> Result<(), NativeError> {
        // Memories go with places as the solver has them.
        self.read_unwrapped();
        self.resize(change)?;
        if change.rest {
            self.velocity.fill(Vec3::zeros());
            self.angular_velocity.fill(Vec3::zeros());
        }
        let (mut pairs, mut walls) = (Vec::new(), Vec::new());
        // A frozen bed has no materials to its populations.
        let mut populations = usize::MAX;
        if let Some(engine) = &mut self.engine {
            (pairs, walls) = engine.memories();
            let contacts = engine.contacts();
            populations = contacts.material_of.len().min(contacts.held.len());
        }
        let gone = check::change(change, &self.id, populations, check::AllowedWeights::One)?;
        let mut keep = vec![true; self.id.len()];
        for &row in &gone {
            keep[row] = false;
        }
        let mut kept = 0;
        let renumber: Vec<Option<u32>> = keep
            .iter()
            .map(|&keep| {
                let row = keep.then_some(kept);
                kept += u32::from(keep);
                row
            })
            .collect();
        retain(&mut self.id, &keep);
        retain(&mut self.population, &keep);
        retain(&mut self.position, &keep);
        retain(&mut self.velocity, &keep);
        retain(&mut self.angular_velocity, &keep);
        retain(&mut self.radius, &keep);
        retain(&mut self.mass, &keep);
        retain(&mut self.weight, &keep);
        // Ids that come are above all others: rows of those that stay only close up.
        pairs.retain_mut(|one| {
            let rows = one.rows.map(|row| renumber[row as usize]);
            one.rows = rows.map(Option::unwrap_or_default);
            rows.iter().all(Option::is_some)
        });
        walls.retain_mut(|one| {
            let row = renumber[one.row as usize];
            one.row = row.unwrap_or_default();
            row.is_some()
        });
        for new in &change.insert {
            self.id.push(new.id);
            self.population.push(new.population);
            self.position.push(new.position);
            self.velocity.push(new.velocity);
            self.angular_velocity.push(Vec3::zeros());
            self.radius.push(new.radius);
            self.mass.push(sphere::mass(new.radius, new.density));
            if !self.weight.is_empty() {
                self.weight.push(new.weight);
            }
        }
        self.impulse = vec![Vec3::zeros(); self.id.len()];
        let Some(engine) = &self.engine else {
            return Ok(());
        };
        let largest = self.radius.iter().copied().fold(0.0, f64::max);
        check_period(engine.contacts(), largest)?;
        self.hand_over((pairs, walls))
            .map_err(|stray| self.outside(stray))
    }
}

pub(crate) fn retain<T>(values: &mut Vec<T>, keep: &[bool]) {
    let mut keep = keep.iter();
    values.retain(|_| keep.next().copied().unwrap_or(true));
}

impl Part for NativeParticles {
    fn about(&self) -> &SolverInfo {
        &self.about
    }

    fn commit(&mut self) -> Result<(), PartError> {
        Ok(())
    }

    fn checkpoint(&mut self, directory: &Path) -> Result<(), PartError> {
        self.write(directory).map_err(|error| {
            self.failure(FailureKind::Io, error.to_string())
                .caused_by(error)
        })
    }
}

impl Particles for NativeParticles {
    fn fields(&self) -> ParticleFields<'_> {
        ParticleFields {
            id: &self.id,
            population: &self.population,
            position: &self.position,
            velocity: &self.velocity,
            angular_velocity: &self.angular_velocity,
            radius: &self.radius,
            mass: &self.mass,
            weight: &self.weight,
        }
    }

    fn change(
        &mut self,
        _supervisor: &Supervisor,
        change: &ParticleChanges,
    ) -> Result<(), PartError> {
        if change.is_empty() {
            return Ok(());
        }
        if self.engine.is_none() && !change.insert.is_empty() {
            return Err(self.failure(FailureKind::Protocol, "a frozen bed takes no particles in"));
        }
        self.exchange(change).map_err(|error| self.refused(error))
    }

    fn takes(&self, column: &str) -> bool {
        takes(column)
    }

    fn start(&mut self, window: &Window, _bed: &Bed, push: &ParticlePush) -> Result<(), PartError> {
        if push.force.len() != self.id.len() {
            let (found, count) = (push.force.len(), self.id.len());
            let message = format!("{found} forces for {count} particles");
            return Err(self
                .failure(FailureKind::Protocol, message)
                .in_window(window));
        }
        self.push(window, &push.force)?;
        self.take_drag(window, &push.columns)?;
        self.started = Some(*window);
        Ok(())
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError> {
        let Some(window) = self.started.take() else {
            return Err(self.failure(FailureKind::Protocol, "finished without a start"));
        };
        if self.engine.is_some() {
            self.advance(&window, supervisor)?;
        }
        self.report_drag(received);
        received.impulse.clone_from(&self.impulse);
        received.acted = self.acted;
        received.support = self.engine.as_mut().map(|engine| engine.take_support());
        let deep = self
            .engine
            .as_mut()
            .map(|engine| engine.take_deep_contacts());
        received.deep_contacts = Some(deep.unwrap_or_default());
        Ok(())
    }
}
