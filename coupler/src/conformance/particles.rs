//! The laws of particles: spheres in a box with a floor, some held, free ones apart from each other and in contact.

use std::path::{Path, PathBuf};

use calcine_physics::Vec3;

pub use super::six_spheres::{BOX, STEP, contacts, soft_spheres};

use super::drag::{self, DragUnderTest};
use super::six_spheres::{DENSITY, RADIUS, mass, setup};
use super::{LawError, LawOutcome, holds, is_refused, same, supervisor, window};
use crate::error::{FailureKind, PartError};
use crate::motion::{NewParticle, ParticleChanges, Resized};
use crate::part::{Bed, ParticlePush, ParticleReceived, Particles};
use crate::setup::ParticleSetup;
use crate::supervisor::Supervisor;

/// Length of a window in s: 49.6 steps, so that windows have 49 or 50.
const SPAN: f64 = 4.96e-5;

/// Makes the particles of a setup, anew or from the folder of a checkpoint.
pub type MakeParticles<'a> = dyn FnMut(&ParticleSetup, Option<&Path>, &mut Supervisor) -> Result<Box<dyn Particles>, PartError>
    + 'a;

/// Particles to be tested.
pub struct ParticlesUnderTest<'a> {
    /// Makes some.
    pub make: &'a mut MakeParticles<'a>,
    /// A folder for checkpoints.
    pub scratch: &'a Path,
}

type Law = fn(&mut Spheres<'_, '_>) -> Result<(), LawError>;

/// The laws by their names.
const LAWS: &[(&str, Law)] = &[
    (
        "ids_ascend_and_columns_are_those_of_the_setup",
        columns_of_setup,
    ),
    (
        "the_impulse_is_the_pushed_force_times_the_span",
        impulse_of_force,
    ),
    (
        "a_free_particle_gains_its_impulse_and_a_held_one_stays",
        gains_impulse,
    ),
    ("a_window_moves_what_is_pushed", window_moves),
    (
        "a_run_goes_on_alike_after_a_checkpoint_and_from_it",
        goes_on_alike,
    ),
    (
        "a_change_takes_out_puts_in_and_resizes_what_it_names_alone",
        changes,
    ),
    ("particles_come_to_rest_where_they_are", comes_to_rest),
    (
        "forces_for_another_number_of_particles_are_refused",
        refuses_other_lengths,
    ),
    (
        "a_column_that_is_not_taken_is_refused_by_its_name",
        refuses_unknown_column,
    ),
    (
        "drag_by_coefficient_and_gas_velocity_follows_the_particle_where_it_is_taken",
        drag_follows,
    ),
    (
        "finishing_what_was_not_started_is_refused",
        refuses_unstarted,
    ),
    ("a_particle_that_leaves_is_named_by_its_id", names_the_lost),
    (
        "particles_that_are_dropped_within_a_window_end",
        ends_when_dropped,
    ),
];

/// Runs all laws.
pub fn run(under_test: &mut ParticlesUnderTest<'_>) -> Vec<LawOutcome> {
    let mut outcomes = Vec::new();
    for (number, &(name, law)) in LAWS.iter().enumerate() {
        let mut spheres = Spheres {
            setup: setup(),
            folder: under_test.scratch.join(format!("law-{number}")),
            supervisor: supervisor(),
            received: ParticleReceived::default(),
            under_test: &mut *under_test,
        };
        let result = law(&mut spheres);
        outcomes.push(LawOutcome { law: name, result });
    }
    outcomes
}

/// The fixture of a law.
struct Spheres<'a, 'b> {
    under_test: &'a mut ParticlesUnderTest<'b>,
    setup: ParticleSetup,
    folder: PathBuf,
    supervisor: Supervisor,
    received: ParticleReceived,
}

impl Spheres<'_, '_> {
    fn make(&mut self, from: Option<&Path>) -> Result<Box<dyn Particles>, LawError> {
        let make = &mut self.under_test.make;
        Ok(make(&self.setup, from, &mut self.supervisor)?)
    }

    fn window(
        &mut self,
        particles: &mut dyn Particles,
        index: u64,
        push: &ParticlePush,
    ) -> Result<(), LawError> {
        particles.start(&window(index, SPAN, SPAN)?, &Bed::default(), push)?;
        Ok(particles.finish(&self.supervisor, &mut self.received)?)
    }

    /// Windows of numbers, each committed, with a force on every particle.
    fn advance(
        &mut self,
        particles: &mut dyn Particles,
        windows: std::ops::Range<u64>,
    ) -> Result<(), LawError> {
        for index in windows {
            let push = push(particles.fields().len());
            self.window(particles, index, &push)?;
            particles.commit()?;
        }
        Ok(())
    }
}

/// A force of another size and direction on each, some hundred times a sphere's weight.
fn push(count: usize) -> ParticlePush {
    let force = |p: usize| Vec3::new(0.1 + 0.01 * p as f64, -0.05, 0.02 * p as f64);
    ParticlePush {
        force: (0..count).map(force).collect(),
        ..ParticlePush::default()
    }
}

/// All bits of what is shown of some particles, by their rows.
fn bits(particles: &dyn Particles, rows: impl Iterator<Item = usize>) -> Vec<u64> {
    let fields = particles.fields();
    let mut all = Vec::new();
    for row in rows {
        all.extend([fields.id[row], u64::from(fields.population[row])]);
        let vectors = [
            fields.position[row],
            fields.velocity[row],
            fields.angular_velocity[row],
        ];
        all.extend(
            vectors
                .iter()
                .flat_map(|vector| vector.iter())
                .map(|x| x.to_bits()),
        );
        all.extend([fields.radius[row].to_bits(), fields.mass[row].to_bits()]);
    }
    all
}

fn all_bits(particles: &dyn Particles) -> Vec<u64> {
    bits(particles, 0..particles.fields().len())
}

fn columns_of_setup(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let particles = spheres.make(None)?;
    let (fields, setup) = (particles.fields(), &spheres.setup);
    holds(fields.id == setup.id, || format!("ids {:?}", fields.id))?;
    holds(fields.population == setup.population, || {
        "other populations".into()
    })?;
    let lengths = [
        fields.position.len(),
        fields.velocity.len(),
        fields.angular_velocity.len(),
        fields.radius.len(),
        fields.mass.len(),
    ];
    holds(lengths == [setup.id.len(); 5], || {
        format!("lengths {lengths:?}")
    })?;
    holds(fields.position == setup.position, || "other centres".into())?;
    holds(fields.velocity == setup.velocity, || {
        "other velocities".into()
    })?;
    holds(fields.radius == setup.radius, || "other radii".into())?;
    let off = |found: &f64| (found / mass(RADIUS) - 1.0).abs() > 1e-12;
    holds(!fields.mass.iter().any(off), || {
        format!("masses {:?}", fields.mass)
    })
}

fn impulse_of_force(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    for index in 0..3 {
        let push = push(particles.fields().len());
        spheres.window(&mut *particles, index, &push)?;
        let impulses = &spheres.received.impulse;
        holds(impulses.len() == push.force.len(), || {
            format!("{} impulses", impulses.len())
        })?;
        for (p, (force, impulse)) in push.force.iter().zip(impulses).enumerate() {
            let due = SPAN * force;
            holds((impulse - due).norm() <= 1e-12 * due.norm(), || {
                let id = particles.fields().id[p];
                format!("window {index}: particle {id} got {impulse:?} N s, due are {due:?} N s")
            })?;
        }
        let acted = spheres.received.acted;
        holds((acted - SPAN).abs() < STEP, || {
            format!("steps of {acted} s for {SPAN} s")
        })?;
        particles.commit()?;
    }
    Ok(())
}

fn gains_impulse(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    let before = particles.fields().velocity.to_vec();
    let place = particles.fields().position.to_vec();
    spheres.advance(&mut *particles, 0..4)?;
    let fields = particles.fields();
    let force = push(fields.len()).force;
    // Those that touch push each other, too.
    for p in 2..5 {
        let gained = fields.mass[p] * (fields.velocity[p] - before[p]);
        let due = 4.0 * SPAN * force[p];
        holds((gained - due).norm() <= 1e-9 * due.norm(), || {
            format!(
                "particle {} gained {gained:?} N s, due are {due:?} N s",
                fields.id[p]
            )
        })?;
    }
    holds(
        fields.position[5] == place[5] && fields.velocity[5] == Vec3::zeros(),
        || "the particle that is held moved".into(),
    )
}

fn window_moves(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    spheres.advance(&mut *particles, 0..1)?;
    let committed = all_bits(&*particles);
    let push = push(particles.fields().len());
    spheres.window(&mut *particles, 1, &push)?;
    particles.commit()?;
    holds(all_bits(&*particles) != committed, || {
        "a window changes nothing".into()
    })
}

fn goes_on_alike(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let folder = spheres.folder.join("at-3");
    std::fs::create_dir_all(&folder)?;
    let mut particles = spheres.make(None)?;
    spheres.advance(&mut *particles, 0..3)?;
    particles.checkpoint(&folder)?;
    let at_checkpoint = all_bits(&*particles);
    spheres.advance(&mut *particles, 3..6)?;
    let at_end = all_bits(&*particles);
    drop(particles);
    spheres.supervisor = supervisor();
    let mut resumed = spheres.make(Some(&folder))?;
    same(
        "the state that was taken up",
        &all_bits(&*resumed),
        &at_checkpoint,
    )?;
    spheres.advance(&mut *resumed, 3..6)?;
    same("three windows later", &all_bits(&*resumed), &at_end)?;
    resumed.finish_run(&spheres.supervisor)?;
    Ok(())
}

fn changes(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    spheres.advance(&mut *particles, 0..2)?;
    // 1, 2, 7 and 11 stay as they are.
    let untouched = bits(&*particles, [0, 1, 3, 5].into_iter());
    let new = NewParticle {
        id: 20,
        population: 0,
        position: Vec3::new(0.05, 0.02, 0.08),
        velocity: Vec3::new(0.0, 0.1, -0.5),
        radius: 0.8 * RADIUS,
        density: DENSITY,
        weight: 1.0,
    };
    let resized = Resized {
        id: 8,
        radius: 0.9 * RADIUS,
        mass: 0.5 * mass(RADIUS),
    };
    let change = ParticleChanges {
        remove: vec![4],
        insert: vec![new],
        resize: vec![resized],
        rest: false,
    };
    particles.change(&spheres.supervisor, &change)?;
    let fields = particles.fields();
    holds(fields.id == [1, 2, 7, 8, 11, 20], || {
        format!("ids {:?}", fields.id)
    })?;
    same(
        "those that stay",
        &bits(&*particles, [0, 1, 2, 4].into_iter()),
        &untouched,
    )?;
    let is = |found: f64, due: f64| (found / due - 1.0).abs() <= 1e-14;
    holds(
        is(fields.radius[3], resized.radius) && is(fields.mass[3], resized.mass),
        || {
            format!(
                "particle 8 has {} m and {} kg",
                fields.radius[3], fields.mass[3]
            )
        },
    )?;
    let came = fields.position[5] == new.position && fields.velocity[5] == new.velocity;
    holds(
        came && is(fields.radius[5], new.radius) && is(fields.mass[5], mass(new.radius)),
        || {
            format!(
                "particle 20 came to {:?} with {} kg",
                fields.position[5], fields.mass[5]
            )
        },
    )?;
    // And they move on.
    spheres.advance(&mut *particles, 2..4)?;
    holds(spheres.received.impulse.len() == 6, || {
        "an impulse is missing".into()
    })
}

fn comes_to_rest(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    spheres.advance(&mut *particles, 0..2)?;
    let place = particles.fields().position.to_vec();
    let change = ParticleChanges {
        rest: true,
        ..ParticleChanges::default()
    };
    particles.change(&spheres.supervisor, &change)?;
    let fields = particles.fields();
    holds(fields.position == place, || "a particle moved".into())?;
    let speeds = fields.velocity.iter().chain(fields.angular_velocity);
    holds(
        speeds.into_iter().all(|speed| *speed == Vec3::zeros()),
        || "one moves on".into(),
    )
}

fn refuses_other_lengths(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    match particles.start(&window(0, SPAN, SPAN)?, &Bed::default(), &push(5)) {
        Ok(()) => Err(LawError::Broken("it took them".into())),
        Err(error) => is_refused(
            &error,
            &[FailureKind::InvalidInput, FailureKind::Protocol],
            "5 forces for 6 particles",
        ),
    }
}

/// What the laws of pushed columns need of fresh particles.
fn pushed(particles: &mut dyn Particles) -> DragUnderTest<'_> {
    DragUnderTest {
        force: push(particles.fields().len()).force,
        particles,
        apart: 2..5,
        held: 5,
        span: SPAN,
        step: STEP,
    }
}

fn refuses_unknown_column(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    drag::refuses_unknown(pushed(&mut *spheres.make(None)?))
}

fn drag_follows(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    drag::follows(pushed(&mut *spheres.make(None)?), &spheres.supervisor)
}

fn refuses_unstarted(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    match particles.finish(&spheres.supervisor, &mut spheres.received) {
        Ok(()) => Err(LawError::Broken("it finished".into())),
        Err(error) => is_refused(&error, &[FailureKind::Protocol], "without a start"),
    }
}

fn names_the_lost(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    // To the ceiling, where no wall is, in less than a window.
    spheres.setup.velocity[3] = Vec3::new(0.0, 0.0, 2000.0);
    let mut particles = spheres.make(None)?;
    let push = ParticlePush {
        force: vec![Vec3::zeros(); 6],
        ..ParticlePush::default()
    };
    for index in 0..3 {
        particles.start(&window(index, SPAN, SPAN)?, &Bed::default(), &push)?;
        match particles.finish(&spheres.supervisor, &mut spheres.received) {
            Ok(()) => particles.commit()?,
            Err(error) => {
                holds(error.window.is_some(), || {
                    "the error does not name its window".into()
                })?;
                return is_refused(&error, &[FailureKind::LostParticles], "particle 7");
            }
        }
    }
    Err(LawError::Broken(
        "particle 7 is outside, and nothing is said".into(),
    ))
}

fn ends_when_dropped(spheres: &mut Spheres<'_, '_>) -> Result<(), LawError> {
    let mut particles = spheres.make(None)?;
    let push = push(particles.fields().len());
    particles.start(&window(0, SPAN, SPAN)?, &Bed::default(), &push)?;
    drop(particles);
    Ok(())
}
