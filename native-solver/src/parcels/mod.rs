//! Native parcels: rows that stand for many particles each and move by the multiphase particle-in-cell method (MP-PIC,
//! docs/theory.md, MPC-1).

mod changes;
mod collisions;
mod error;
mod firm;
mod flight;
mod friction;
mod packing;
mod rubbing;
mod state;
mod step;
mod stress;
mod stress_system;
mod tetrahedra;
mod track;
mod walls;

use std::path::Path;
use std::sync::Arc;

use calcine_coupler::error::{FailureKind, PartError};
use calcine_coupler::excursion::Excursion;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::tetrahedra::TetPlace;
use calcine_coupler::motion::{Motion, ParticleChanges};
use calcine_coupler::numerics::parallel;
use calcine_coupler::parcels::ParcelMotion;
use calcine_coupler::part::{
    Bed, DRAG_IMPULSE, Part, ParticleFields, ParticlePush, ParticleReceived, Particles, SolverInfo,
};
use calcine_coupler::physics::{Vec3, sphere};
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::Supervisor;
use calcine_coupler::time::Window;

use collisions::CollisionStep;
pub use error::ParcelError;
pub use flight::Flight;
use packing::{Packer, RowAmounts};
use rubbing::RubStep;
use step::{FlyingParcel, fly};
pub use tetrahedra::{Beyond, Tetrahedra};
pub use track::WayEnd;
use walls::{WallFaces, moving};

use crate::particles::check;
use crate::pushed_drag::{pushed_drag, takes};

/// Parcels that move through a mesh.
#[derive(Debug)]
pub struct NativeParcels {
    about: SolverInfo,
    motion: ParcelMotion,
    tetrahedra: Tetrahedra,
    walls: WallFaces,
    packer: Packer,
    rows: ParcelRows,
    started: Option<(Window, Vec<Flight>)>,
    /// True where drag follows velocities in the window.
    drags: bool,
    /// Impulse of the forces in the window in N s, of one real particle each.
    impulse: Vec<Vec3>,
    /// Steps of the run so far.
    steps: u64,
}

/// Parcels in ascending id.
#[derive(Clone, Debug, Default)]
struct ParcelRows {
    id: Vec<u64>,
    population: Vec<u32>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    /// Zero: parcels do not spin.
    spin: Vec<Vec3>,
    radius: Vec<f64>,
    mass: Vec<f64>,
    weight: Vec<f64>,
    place: Vec<TetPlace>,
}

impl NativeParcels {
    /// The parcels of a setup in a mesh; masses are 4/3 π r³ ρ of each real particle.
    pub fn new(mesh: Arc<Mesh>, setup: &ParticleSetup) -> Result<Self, ParcelError> {
        check::check(setup)?;
        let Motion::Parcels(motion) = &setup.motion else {
            return Err(check::not_parcels().into());
        };
        let tetrahedra = Tetrahedra::new(mesh)?;
        let count = setup.id.len();
        let masses = setup.radius.iter().zip(&setup.density);
        let mut velocity = setup.velocity.clone();
        velocity.resize(count, Vec3::zeros());
        let mut rows = ParcelRows {
            id: setup.id.clone(),
            population: setup.population.clone(),
            position: setup.position.clone(),
            velocity,
            spin: vec![Vec3::zeros(); count],
            radius: setup.radius.clone(),
            mass: masses
                .map(|(&radius, &density)| sphere::mass(radius, density))
                .collect(),
            weight: (0..count).map(|row| setup.weight_of(row)).collect(),
            place: Vec::new(),
        };
        rows.place = rows.places(&tetrahedra)?;
        Ok(Self {
            about: SolverInfo {
                name: "native parcels".into(),
                version: env!("CARGO_PKG_VERSION").into(),
                ranks: 1,
            },
            walls: WallFaces::new(tetrahedra.mesh(), motion)?,
            packer: Packer::new(&tetrahedra),
            motion: ParcelMotion::clone(motion),
            tetrahedra,
            started: None,
            drags: false,
            impulse: vec![Vec3::zeros(); count],
            rows,
            steps: 0,
        })
    }

    /// Steps of the run so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// What acts on each parcel in a window, and the impulse of its forces.
    fn flights(&mut self, window: &Window, push: &ParticlePush) -> Result<Vec<Flight>, PartError> {
        let count = self.rows.id.len();
        if push.force.len() != count {
            let message = format!("{} forces for {count} particles", push.force.len());
            return Err(self.failure(FailureKind::Protocol, message));
        }
        let drag = pushed_drag(&push.columns, count)
            .map_err(|message| self.failure(FailureKind::Protocol, message))?;
        self.drags = drag.is_some();
        let span = window.span.motion.seconds();
        self.impulse.clear();
        self.impulse
            .extend(push.force.iter().map(|force| force * span));
        let flight = |row: usize| {
            let mass = self.rows.mass[row];
            let (rate, gas) = match drag {
                Some(drag) => (drag.coefficient[row] / mass, Vec3::from(drag.gas[row])),
                None => (0.0, Vec3::zeros()),
            };
            let (resistance, wall) = match &self.motion.resistance {
                Some(one) => (one.rate, moving(&one.wall, self.rows.position[row])),
                None => (0.0, Vec3::zeros()),
            };
            Flight {
                resistance,
                wall,
                acceleration: push.force[row] / mass + self.motion.gravity,
                rate,
                gas,
            }
        };
        Ok((0..count).map(flight).collect())
    }

    /// The parcels as they fly.
    fn flying(&self) -> Vec<FlyingParcel> {
        let parcel = |row: usize| FlyingParcel {
            position: self.rows.position[row],
            velocity: self.rows.velocity[row],
            place: self.rows.place[row],
            population: self.rows.population[row],
            dragged: Vec3::zeros(),
            resisted: Vec3::zeros(),
            resistance: 0.0,
            yielding: 1.0,
            rebounded: Vec3::zeros(),
        };
        (0..self.rows.id.len()).map(parcel).collect()
    }

    /// Moves the parcels over a window; the impulse in N s that walls gave all of them.
    fn advance(
        &mut self,
        parcels: &mut [FlyingParcel],
        flights: &[Flight],
        (span, supervisor): (f64, &Supervisor),
    ) -> Result<Vec3, PartError> {
        let rows = 0..parcels.len();
        let volume: Vec<f64> = rows.clone().map(|row| self.rows.row_volume(row)).collect();
        let mass: Vec<f64> = rows.map(|row| self.rows.row_mass(row)).collect();
        let amounts = RowAmounts {
            volume: &volume,
            mass: &mass,
        };
        let mut support = Vec3::zeros();
        let mut left = span;
        let mut done = 0;
        while left > 0.0 {
            let steps = self
                .steps_left(parcels, flights, (left, span), done)
                .map_err(|error| self.refused(error))?;
            let time = if steps == 1.0 { left } else { left / steps };
            let begun = (&*parcels, amounts);
            self.packer
                .begin(&self.motion.packing, &self.tetrahedra, begun);
            fly(&self.tetrahedra, &self.walls, (parcels, flights), time);
            for (parcel, mass) in parcels.iter().zip(&mass) {
                support += *mass * parcel.rebounded;
            }
            support += self
                .crowd(parcels, amounts, time)
                .map_err(|error| self.refused(error))?;
            left = if steps == 1.0 { 0.0 } else { left - time };
            done += 1;
            self.steps += 1;
            if supervisor.interrupts().count() >= 2 {
                return Err(self.failure(FailureKind::Interrupted, "interrupted"));
            }
        }
        if self.motion.resistance.is_some() {
            for (parcel, mass) in parcels.iter().zip(&mass) {
                support += *mass * parcel.resisted;
            }
        }
        Ok(support)
    }

    /// Has parcels meet each other by the averages of the mesh: damping, the stress, friction, isotropy. The impulse in N s that walls gave
    /// by the stress.
    fn crowd(
        &mut self,
        parcels: &mut [FlyingParcel],
        amounts: RowAmounts<'_>,
        time: f64,
    ) -> Result<Vec3, ParcelError> {
        let collisions = self.motion.collisions;
        let step = CollisionStep {
            collisions: &collisions,
            id: &self.rows.id,
            radius: &self.rows.radius,
            weight: &self.rows.weight,
            amounts,
            number: self.steps,
            time,
        };
        if collisions.damping {
            let volume = amounts.volume;
            let fraction = self.packer.fraction(&self.tetrahedra, parcels, volume);
            step.damp(parcels, &fraction);
        }
        let packing = &self.motion.packing;
        let action = self.packer.act(
            (packing, self.motion.friction.is_some()),
            &self.tetrahedra,
            (parcels, amounts),
            time,
        )?;
        let given = action.impulse + self.rub(&action.stress, (parcels, amounts), time);
        if collisions.isotropy {
            let volume = amounts.volume;
            let fraction = self.packer.fraction(&self.tetrahedra, parcels, volume);
            step.redraw(parcels, &fraction);
        }
        Ok(given)
    }

    /// Has parcels rub under the stress; the impulse in N s that walls gave.
    fn rub(&self, stress: &[f64], rows: (&mut [FlyingParcel], RowAmounts<'_>), time: f64) -> Vec3 {
        let Some(friction) = self.motion.friction else {
            return Vec3::zeros();
        };
        let step = RubStep {
            friction,
            walls: &self.walls,
            tetrahedra: &self.tetrahedra,
            time,
        };
        step.act((&self.packer, stress), rows)
    }

    /// Cell of each parcel.
    pub fn cells(&self) -> Vec<usize> {
        let places = self.rows.place.iter();
        places.map(|place| place.cell as usize).collect()
    }

    /// Solid fraction of each cell of the mesh by linear weights, as the stress has it.
    pub fn solid_fraction(&self) -> Vec<f64> {
        let rows = 0..self.rows.id.len();
        let volume: Vec<f64> = rows.map(|row| self.rows.row_volume(row)).collect();
        self.packer
            .fraction(&self.tetrahedra, &self.flying(), &volume)
    }

    /// Number of equal steps that the rest of a window needs, by the velocities now and as they would be at its end.
    fn steps_left(
        &self,
        parcels: &[FlyingParcel],
        flights: &[Flight],
        (left, span): (f64, f64),
        done: u32,
    ) -> Result<f64, ParcelError> {
        let mesh = self.tetrahedra.mesh();
        let rate = |row: usize| {
            let (parcel, flight) = (&parcels[row], &flights[row]);
            let cell = parcel.place.cell as usize;
            let last = flight.after(left, parcel.velocity).1;
            let mut through = [0.0; 2];
            for &face in mesh.faces_of(cell) {
                let area = mesh.face_area()[face as usize];
                through[0] += parcel.velocity.dot(&area).abs();
                through[1] += last.dot(&area).abs();
            }
            // What goes out of a closed cell is half of what goes through its faces.
            0.5 * through[0].max(through[1]) / mesh.cell_volume()[cell]
        };
        let (fastest, rate) = match parcels.len() {
            0 => (0, 0.0),
            count => parallel::largest(count, rate),
        };
        let courant = self.motion.courant;
        let steps = (left * rate / courant).ceil().max(1.0);
        let most = self.motion.most_steps;
        if f64::from(done) + steps > f64::from(most) || !rate.is_finite() {
            return Err(ParcelError::TooManySteps {
                speed: parcels[fastest].velocity.norm(),
                steps: f64::from(done) + steps,
                span,
                courant,
                most,
            });
        }
        Ok(steps)
    }

    /// Takes over where the parcels have come, with the impulses of drag.
    fn land(&mut self, parcels: &[FlyingParcel]) -> Vec<Vec3> {
        for (row, parcel) in parcels.iter().enumerate() {
            self.rows.position[row] = parcel.position;
            self.rows.velocity[row] = parcel.velocity;
            self.rows.place[row] = parcel.place;
        }
        let drags = parcels.iter().zip(&self.rows.mass);
        drags.map(|(parcel, &mass)| mass * parcel.dragged).collect()
    }

    fn failure(&self, kind: FailureKind, message: impl Into<String>) -> PartError {
        PartError::new(self.about.name.clone(), kind, message)
    }

    fn refused(&self, error: ParcelError) -> PartError {
        let kind = match &error {
            ParcelError::Outside { .. } => FailureKind::LostParticles,
            _ => FailureKind::InvalidInput,
        };
        self.failure(kind, error.to_string()).caused_by(error)
    }
}

impl ParcelRows {
    /// Mass in kg of all real particles of a row.
    fn row_mass(&self, row: usize) -> f64 {
        self.weight[row] * self.mass[row]
    }

    /// Solid volume in m³ of all real particles of a row.
    fn row_volume(&self, row: usize) -> f64 {
        self.weight[row] * sphere::volume(self.radius[row])
    }

    /// The tetrahedra of all positions.
    fn places(&self, tetrahedra: &Tetrahedra) -> Result<Vec<TetPlace>, ParcelError> {
        let found = self.position.iter().zip(&self.id).map(|(&place, &id)| {
            let outside = || ParcelError::Outside {
                id,
                place: place.into(),
            };
            tetrahedra.locate(place).ok_or_else(outside)
        });
        found.collect()
    }
}

impl Part for NativeParcels {
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

impl Particles for NativeParcels {
    fn fields(&self) -> ParticleFields<'_> {
        let rows = &self.rows;
        ParticleFields {
            id: &rows.id,
            population: &rows.population,
            position: &rows.position,
            velocity: &rows.velocity,
            angular_velocity: &rows.spin,
            radius: &rows.radius,
            mass: &rows.mass,
            weight: &rows.weight,
        }
    }

    fn change(
        &mut self,
        _supervisor: &Supervisor,
        change: &ParticleChanges,
    ) -> Result<(), PartError> {
        self.exchange(change).map_err(|error| self.refused(error))
    }

    fn takes(&self, column: &str) -> bool {
        takes(column)
    }

    fn start(&mut self, window: &Window, _bed: &Bed, push: &ParticlePush) -> Result<(), PartError> {
        let flights = self
            .flights(window, push)
            .map_err(|error| error.in_window(window))?;
        self.started = Some((*window, flights));
        Ok(())
    }

    fn finish(
        &mut self,
        supervisor: &Supervisor,
        received: &mut ParticleReceived,
    ) -> Result<(), PartError> {
        let Some((window, flights)) = self.started.take() else {
            return Err(self.failure(FailureKind::Protocol, "finished without a start"));
        };
        let span = window.span.motion.seconds();
        let mut parcels = self.flying();
        let support = self
            .advance(&mut parcels, &flights, (span, supervisor))
            .map_err(|error| error.in_window(&window))?;
        let drags = self.land(&parcels);
        received.columns.clear();
        if self.drags {
            for (impulse, drag) in self.impulse.iter_mut().zip(&drags) {
                *impulse += drag;
            }
            let values = drags.iter().flat_map(|drag| <[f64; 3]>::from(*drag));
            received.columns.set(DRAG_IMPULSE, 3, values.collect());
        }
        received.impulse.clone_from(&self.impulse);
        received.acted = span;
        received.support = Some(support);
        received.deep_contacts = Some(Excursion::default());
        Ok(())
    }
}
