//! Spheres that move in the real LIGGGHTS host: beds, launching, windows.

// Each test file uses its own part of this.
#![allow(dead_code)]

use std::path::PathBuf;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::liggghts::LiggghtsLaunch;
use calcine_adapters::liggghts::inputs::Inputs;
use calcine_adapters::particles::LinkedParticles;
use calcine_coupler::error::PartError;
use calcine_coupler::motion::{Cohesion, ContactForce, ContactLaw, Contacts, Motion, Rolling};
use calcine_coupler::part::{
    Bed as VoidFractions, Part, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};

/// Time step in s.
pub const STEP: f64 = 1e-6;
/// Side of the domain in m.
pub const BOX: f64 = 0.1;

pub fn law() -> ContactLaw {
    ContactLaw {
        force: ContactForce::HertzMindlin,
        attractive_damping: true,
        rolling: Rolling::None,
        cohesion: Cohesion::None,
    }
}

/// A floor, no gravity unless asked for.
pub fn contacts(gravity: Vec3) -> Contacts {
    Contacts {
        gravity,
        ..calcine_coupler::conformance::particles::contacts()
    }
}

/// Spheres of 5 mm at these places with these velocities.
pub fn setup(contacts: Contacts, spheres: &[(Vec3, Vec3)]) -> ParticleSetup {
    let count = spheres.len();
    ParticleSetup {
        id: (1..=count as u64).collect(),
        population: vec![0; count],
        position: spheres.iter().map(|sphere| sphere.0).collect(),
        radius: vec![0.0025; count],
        density: vec![2500.0; count],
        velocity: spheres.iter().map(|sphere| sphere.1).collect(),
        motion: Motion::Free(Box::new(contacts)),
        ..ParticleSetup::default()
    }
}

/// A folder for hosts, and the clock of their windows.
pub struct Bench {
    folder: tempfile::TempDir,
    pub supervisor: Supervisor,
    /// Ranks of the hosts launched next.
    pub ranks: u32,
    pub index: u64,
    pub start: Ticks,
    /// Of the last window.
    pub acted: f64,
    pub support: Option<Vec3>,
}

impl Bench {
    pub fn new() -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            supervisor: Supervisor::new(Duration::from_secs(30), Interrupts::default()),
            ranks: 1,
            index: 0,
            start: Ticks::ZERO,
            acted: 0.0,
            support: None,
        }
    }

    pub fn launch(
        &mut self,
        setup: &ParticleSetup,
        name: &str,
        resume: Option<PathBuf>,
    ) -> LinkedParticles {
        self.try_launch(setup, name, resume).unwrap()
    }

    pub fn try_launch(
        &mut self,
        setup: &ParticleSetup,
        name: &str,
        resume: Option<PathBuf>,
    ) -> Result<LinkedParticles, PartError> {
        let launch = LiggghtsLaunch {
            inputs: Inputs {
                setup,
                bounds: (Vec3::zeros(), Vec3::repeat(BOX)),
                step: STEP,
                ranks: self.ranks,
                wall_impulse: true,
                moving_drag: true,
                template: None,
            },
            case_hash: "moving".into(),
            launcher: Launcher::Mpirun,
            folder: self.folder.path().join(name),
            log: self.folder.path().join(format!("{name}.log")),
            resume,
            deadline: Duration::from_secs(30),
        };
        launch.launch(&mut self.supervisor)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn window(
        &mut self,
        particles: &mut LinkedParticles,
        span: f64,
        force: &[Vec3],
    ) -> Result<Vec<Vec3>, PartError> {
        let push = ParticlePush {
            force: force.to_vec(),
            ..ParticlePush::default()
        };
        Ok(self.push(particles, span, &push)?.impulse)
    }

    pub fn push(
        &mut self,
        particles: &mut LinkedParticles,
        span: f64,
        push: &ParticlePush,
    ) -> Result<ParticleReceived, PartError> {
        let span = Ticks::from_seconds(span).unwrap();
        let window = Window {
            index: self.index,
            attempt: 0,
            start: Clocks {
                motion: self.start,
                process: self.start,
            },
            span: Clocks {
                motion: span,
                process: span,
            },
        };
        particles.start(&window, &VoidFractions::default(), push)?;
        let mut received = ParticleReceived::default();
        particles.finish(&self.supervisor, &mut received)?;
        particles.commit()?;
        (self.acted, self.support) = (received.acted, received.support);
        self.index += 1;
        self.start = self.start.checked_add(span).unwrap();
        Ok(received)
    }
}

/// Mass of a sphere in kg.
pub const MASS: f64 = 4.0 / 3.0 * std::f64::consts::PI * 1.5625e-8 * 2500.0;

pub fn setup_with(contacts: Contacts, other: &ParticleSetup) -> ParticleSetup {
    ParticleSetup {
        motion: Motion::Free(Box::new(contacts)),
        ..other.clone()
    }
}

/// Forty spheres that fall on each other and on the floor.
pub fn heap() -> ParticleSetup {
    heap_from(0.04)
}

/// The same, from this place along x in m on.
pub fn heap_from(x: f64) -> ParticleSetup {
    let spheres: Vec<(Vec3, Vec3)> = (0..40)
        .map(|k| {
            let (i, j, layer) = (k % 3, (k / 3) % 3, k / 9);
            let wiggle = 1e-5 * f64::from(k % 7);
            let centre = Vec3::new(
                x + 0.0052 * f64::from(i) + wiggle,
                0.04 + 0.0052 * f64::from(j) - wiggle,
                0.0026 + 0.0051 * f64::from(layer),
            );
            (centre, Vec3::zeros())
        })
        .collect();
    setup(contacts(Vec3::new(0.0, 0.0, -9.81)), &spheres)
}

/// Momentum in N s of all particles together.
pub fn momentum(particles: &LinkedParticles) -> Vec3 {
    let fields = particles.fields();
    let pairs = fields.mass.iter().zip(fields.velocity);
    pairs.map(|(mass, velocity)| *mass * velocity).sum()
}
