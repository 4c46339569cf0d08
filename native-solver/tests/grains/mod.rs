//! Beds of moving spheres for tests and benchmarks.
#![allow(dead_code, clippy::unwrap_used)]

use std::time::Duration;

use calcine_coupler::checkpoint::StateFile;
use calcine_coupler::conformance::particles::soft_spheres;
use calcine_coupler::error::PartError;
use calcine_coupler::motion::{
    Contacts, Motion, NewParticle, ParticleChanges, Wall, WallMotion, WallShape,
};
use calcine_coupler::part::{
    Bed as VoidFractions, Part, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::particles::NativeParticles;

/// One material of 10 MPa with a Poisson's ratio of 0.25, a restitution of 0.5, friction 0.3.
pub fn contacts(step: f64) -> Contacts {
    Contacts {
        bounds: (Vec3::repeat(-1.0), Vec3::repeat(1.0)),
        periodicity: Default::default(),
        ..soft_spheres(step, 1e7)
    }
}

/// A plane through a point, at rest.
pub fn plane(point: Vec3, normal: Vec3) -> Wall {
    wall(WallShape::Plane { point, normal })
}

/// A wall at rest.
pub fn wall(shape: WallShape) -> Wall {
    Wall {
        name: "wall".into(),
        material: 0,
        shape,
        motion: WallMotion::Still,
    }
}

/// Six planes around a box.
pub fn cuboid(low: Vec3, high: Vec3) -> Vec<Wall> {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let lower = axes.iter().map(|&axis| plane(low, axis));
    lower
        .chain(axes.iter().map(|&axis| plane(high, -axis)))
        .collect()
}

/// A sphere of glass' density.
pub fn sphere(id: u64, position: Vec3, velocity: Vec3, radius: f64) -> NewParticle {
    NewParticle {
        id,
        population: 0,
        position,
        velocity,
        radius,
        density: 2500.0,
        weight: 1.0,
    }
}

/// A bed, its clock and what it was pushed with.
pub struct Bed {
    pub particles: NativeParticles,
    pub clocks: Clocks,
    pub push: ParticlePush,
    pub received: ParticleReceived,
    pub step: f64,
    supervisor: Supervisor,
}

impl Bed {
    pub fn new(contacts: Contacts, spheres: &[NewParticle]) -> Self {
        Self::try_new(contacts, spheres).unwrap()
    }

    pub fn try_new(
        contacts: Contacts,
        spheres: &[NewParticle],
    ) -> Result<Self, calcine_native::gas::NativeError> {
        let step = contacts.step;
        let setup = setup(contacts, spheres);
        Ok(Self {
            particles: NativeParticles::new(&setup)?,
            clocks: Clocks::default(),
            push: ParticlePush {
                force: vec![Vec3::zeros(); spheres.len()],
                ..ParticlePush::default()
            },
            received: ParticleReceived::default(),
            step,
            supervisor: Supervisor::new(Duration::from_secs(60), Interrupts::default()),
        })
    }

    /// The bed with an angular velocity in rad/s of one of its spheres, through its state on disk: setups
    /// know no rotation.
    pub fn spun(mut self, row: usize, spin: Vec3) -> Self {
        let folder = tempfile::tempdir().unwrap();
        self.particles.checkpoint(folder.path()).unwrap();
        let path = folder.path().join("particles.state");
        let mut state = StateFile::read(&path).unwrap();
        let mut spins = state.f64s("angular_velocity").unwrap().to_vec();
        spins[3 * row..3 * row + 3].copy_from_slice(spin.as_slice());
        state.set_f64s("angular_velocity", &spins);
        state.write(&path).unwrap();
        self.particles.restore(folder.path()).unwrap();
        self
    }

    /// One window of so many steps.
    pub fn try_run(&mut self, steps: u64) -> Result<(), PartError> {
        self.try_span(steps as f64 * self.step)
    }

    /// One window of a length in s.
    pub fn try_span(&mut self, seconds: f64) -> Result<(), PartError> {
        let span = Ticks::from_seconds(seconds).unwrap();
        let window = Window {
            start: self.clocks,
            span: Clocks {
                motion: span,
                process: span,
            },
            ..Window::default()
        };
        self.particles
            .start(&window, &VoidFractions::default(), &self.push)?;
        self.particles
            .finish(&self.supervisor, &mut self.received)?;
        self.clocks = window.end().unwrap();
        Ok(())
    }

    pub fn run(&mut self, steps: u64) {
        self.try_run(steps).unwrap();
    }

    pub fn change(&mut self, change: &ParticleChanges) -> Result<(), PartError> {
        self.particles.change(&self.supervisor, change)?;
        self.push.force = vec![Vec3::zeros(); self.particles.fields().len()];
        Ok(())
    }

    pub fn place(&self, row: usize) -> Vec3 {
        self.particles.fields().position[row]
    }

    pub fn velocity(&self, row: usize) -> Vec3 {
        self.particles.fields().velocity[row]
    }

    pub fn spin(&self, row: usize) -> Vec3 {
        self.particles.fields().angular_velocity[row]
    }

    /// The bits of all places, velocities and rotations.
    pub fn bits(&self) -> Vec<u64> {
        let fields = self.particles.fields();
        let all = fields
            .position
            .iter()
            .chain(fields.velocity)
            .chain(fields.angular_velocity);
        all.flat_map(|vector| [vector.x, vector.y, vector.z])
            .map(f64::to_bits)
            .collect()
    }
}

pub fn setup(contacts: Contacts, spheres: &[NewParticle]) -> ParticleSetup {
    ParticleSetup {
        id: spheres.iter().map(|sphere| sphere.id).collect(),
        population: spheres.iter().map(|sphere| sphere.population).collect(),
        position: spheres.iter().map(|sphere| sphere.position).collect(),
        radius: spheres.iter().map(|sphere| sphere.radius).collect(),
        density: spheres.iter().map(|sphere| sphere.density).collect(),
        velocity: spheres.iter().map(|sphere| sphere.velocity).collect(),
        motion: Motion::Free(Box::new(contacts)),
        ..ParticleSetup::default()
    }
}

/// Numbers in [0, 1) of a linear congruential generator (Knuth's MMIX constants).
pub fn scatter(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Spheres on a loose grid above the origin, shaken, at random speeds up to one in m/s.
pub fn loose(counts: [usize; 3], spacing: f64, radius: f64, speed: f64) -> Vec<NewParticle> {
    let mut next = scatter(7);
    let mut spheres = Vec::new();
    for k in 0..counts[2] {
        for j in 0..counts[1] {
            for i in 0..counts[0] {
                let shake = 0.9 * (0.5 * spacing - radius);
                let mut random = || Vec3::new(next(), next(), next()) * 2.0 - Vec3::repeat(1.0);
                let corner = Vec3::new(i as f64, j as f64, k as f64) * spacing;
                let position = corner + Vec3::repeat(0.5 * spacing) + random() * shake;
                let id = spheres.len() as u64 + 1;
                spheres.push(sphere(id, position, random() * speed, radius));
            }
        }
    }
    spheres
}
