//! The laws of columns that are pushed to particles, above all of drag by coefficient and gas velocity (docs/theory.md,
//! DRG-3).

use calcine_physics::Vec3;

use super::{LawError, holds, is_refused, window};
use crate::error::FailureKind;
use crate::part::{
    Bed, DRAG_COEFFICIENT, DRAG_IMPULSE, GAS_VELOCITY, ParticlePush, ParticleReceived, Particles,
};
use crate::supervisor::Supervisor;

/// A column that no solver takes.
const UNKNOWN: &str = "phlogiston";
/// Relaxation times m/K in a window, by the place among the rows: from one without drag to one that follows the gas
/// within any step.
const RELAXATIONS: [f64; 5] = [0.3, 5.0, 0.0, 500.0, 1.0];

/// What is pushed to a bed of free and held particles that touch nothing.
pub struct DragUnderTest<'a> {
    /// The particles, at their start, without gravity.
    pub particles: &'a mut dyn Particles,
    /// Rows of free ones that touch nothing.
    pub apart: std::ops::Range<usize>,
    /// The row of one that is held.
    pub held: usize,
    /// A force in N on each.
    pub force: Vec<Vec3>,
    /// Length of a window in s, and of a step.
    pub span: f64,
    /// Time step in s.
    pub step: f64,
}

/// A column of another name than those that a solver takes is refused by its name.
pub fn refuses_unknown(under_test: DragUnderTest<'_>) -> Result<(), LawError> {
    let mut push = ParticlePush {
        force: under_test.force,
        ..ParticlePush::default()
    };
    push.columns.set(UNKNOWN, 1, vec![0.0; push.force.len()]);
    holds(!under_test.particles.takes(UNKNOWN), || {
        format!("it claims to take a column `{UNKNOWN}`")
    })?;
    let window = window(0, under_test.span, under_test.span)?;
    match under_test.particles.start(&window, &Bed::default(), &push) {
        Ok(()) => Err(LawError::Broken(format!("it took a column `{UNKNOWN}`"))),
        Err(error) => is_refused(
            &error,
            &[FailureKind::InvalidInput, FailureKind::Protocol],
            UNKNOWN,
        ),
    }
}

/// Three windows of drag that follows the particles, against the exact solution of m dv/dt = K (u − v) + F.
pub fn follows(under_test: DragUnderTest<'_>, supervisor: &Supervisor) -> Result<(), LawError> {
    let DragUnderTest {
        particles,
        apart,
        held,
        force,
        span,
        step,
    } = under_test;
    if ![DRAG_COEFFICIENT, GAS_VELOCITY]
        .iter()
        .all(|name| particles.takes(name))
    {
        return Ok(()); // the law is of those that take it
    }
    let count = force.len();
    let mass = particles.fields().mass.to_vec();
    let row = |p: usize| RELAXATIONS[p % RELAXATIONS.len()];
    let drag: Vec<f64> = (0..count).map(|p| row(p) * mass[p] / span).collect();
    let gas = |p: usize| Vec3::new(0.3 - 0.1 * p as f64, 0.2, -0.05 * p as f64);
    let mut push = ParticlePush {
        force,
        ..ParticlePush::default()
    };
    let velocities = (0..count).flat_map(|p| <[f64; 3]>::from(gas(p)));
    push.columns.set(GAS_VELOCITY, 3, velocities.collect());
    push.columns.set(DRAG_COEFFICIENT, 1, drag.clone());
    let mut received = ParticleReceived::default();
    for index in 0..3 {
        let before = particles.fields().velocity.to_vec();
        let place = particles.fields().position.to_vec();
        particles.start(&window(index, span, span)?, &Bed::default(), &push)?;
        particles.finish(supervisor, &mut received)?;
        particles.commit()?;
        let Some(told) = received.columns.get(DRAG_IMPULSE, 3, count) else {
            return Err(LawError::Broken(format!("no column `{DRAG_IMPULSE}`")));
        };
        let told: Vec<Vec3> = told
            .as_chunks::<3>()
            .0
            .iter()
            .map(|x| Vec3::from(*x))
            .collect();
        let fields = particles.fields();
        for p in apart.clone() {
            let (a, pushed) = (row(p), push.force[p] * span);
            let exact = Flight::new(a, gas(p), pushed / mass[p], before[p]);
            // Exact at any step, but for the rounding of some 50 of them.
            let size = before[p].norm() + gas(p).norm() + (pushed / mass[p]).norm();
            let off = (fields.velocity[p] - exact.velocity()).norm();
            holds(off <= 1e-12 * size, || {
                let (id, found) = (fields.id[p], fields.velocity[p]);
                let due = exact.velocity();
                format!("window {index}: particle {id} has {found:?} m/s, due are {due:?} m/s")
            })?;
            let due = mass[p] * (exact.velocity() - before[p]) - pushed;
            holds((told[p] - due).norm() <= 1e-12 * mass[p] * size, || {
                let (id, found) = (fields.id[p], told[p]);
                format!(
                    "window {index}: drag gave particle {id} {found:?} N s, due are {due:?} N s"
                )
            })?;
            // The midpoint rule of velocities that are exact, twice its error.
            let way = received.acted * exact.mean_velocity();
            let moved = fields.position[p] - place[p];
            let bound = step * step / 12.0 * a / span * exact.slip.norm() + 1e-15;
            holds((moved - way).norm() <= bound, || {
                let id = fields.id[p];
                format!("window {index}: particle {id} moved by {moved:?} m, due are {way:?} m")
            })?;
        }
        let due = drag[held] * span * gas(held);
        holds((told[held] - due).norm() <= 1e-12 * due.norm(), || {
            let (id, found) = (fields.id[held], told[held]);
            format!(
                "window {index}: drag gave the held particle {id} {found:?} N s, due are {due:?} N s"
            )
        })?;
        for (p, impulse) in received.impulse.iter().enumerate() {
            let pushed = push.force[p] * span;
            let (due, size) = (told[p] + pushed, told[p].norm() + pushed.norm());
            holds((impulse - due).norm() <= 1e-12 * size, || {
                let id = fields.id[p];
                format!("window {index}: particle {id} got {impulse:?} N s, due are {due:?} N s")
            })?;
        }
    }
    Ok(())
}

/// Flight by drag and a constant force over one window.
struct Flight {
    /// Relaxation times in the window.
    relaxations: f64,
    /// What the force alone adds to the velocity in m/s.
    gained: Vec3,
    /// How far the velocity is at first from that which it approaches, in m/s; without drag zero.
    slip: Vec3,
    /// The velocity at first in m/s.
    start: Vec3,
}

impl Flight {
    fn new(relaxations: f64, gas: Vec3, gained: Vec3, start: Vec3) -> Self {
        let slip = match relaxations > 0.0 {
            true => gas + gained / relaxations - start,
            false => Vec3::zeros(),
        };
        Self {
            relaxations,
            gained,
            slip,
            start,
        }
    }

    /// At the end in m/s.
    fn velocity(&self) -> Vec3 {
        match self.relaxations > 0.0 {
            true => self.start - self.slip * (-self.relaxations).exp_m1(),
            false => self.start + self.gained,
        }
    }

    /// The mean over the window in m/s.
    fn mean_velocity(&self) -> Vec3 {
        let a = self.relaxations;
        match a > 0.0 {
            true => self.start + self.slip * (1.0 + (-a).exp_m1() / a),
            false => self.start + 0.5 * self.gained,
        }
    }
}
