//! Beds of parcels for tests.
#![allow(dead_code)]

use std::sync::Arc;
use std::time::Duration;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::motion::{Motion, WallMotion};
use calcine_coupler::parcels::{
    ParcelCollisions, ParcelImpact, ParcelMotion, ParcelPacking, ParcelWall,
};
use calcine_coupler::part::{Bed as GasBed, ParticlePush, ParticleReceived, Particles};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::parcels::CollisionTimes;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::parcels::NativeParcels;

/// Parcels without gravity, stress and collisions, between walls of one restitution and friction.
pub fn motion(mesh: &Mesh, restitution: f64, friction: f64) -> ParcelMotion {
    let patches = mesh.patches().iter();
    let walls = patches.filter(|patch| mesh.partner(patch).is_none());
    let impact = ParcelImpact {
        restitution,
        friction,
    };
    ParcelMotion {
        gravity: Vec3::zeros(),
        courant: 1.0,
        most_steps: 10_000,
        walls: walls
            .map(|patch| ParcelWall {
                patch: patch.name.clone(),
                motion: WallMotion::Still,
                impact: vec![impact],
            })
            .collect(),
        packing: ParcelPacking::None,
        collisions: ParcelCollisions {
            times: CollisionTimes {
                restitution: 1.0,
                close_packing: 0.6,
            },
            damping: false,
            isotropy: false,
            seed: 1,
        },
        friction: None,
        resistance: None,
    }
}

/// Parcels of equal particles, by places and velocities.
pub fn setup(
    motion: ParcelMotion,
    parcels: &[(Vec3, Vec3)],
    radius: f64,
    weight: f64,
) -> ParticleSetup {
    let count = parcels.len();
    ParticleSetup {
        id: (1..=count as u64).collect(),
        population: vec![0; count],
        position: parcels.iter().map(|one| one.0).collect(),
        radius: vec![radius; count],
        density: vec![2500.0; count],
        velocity: parcels.iter().map(|one| one.1).collect(),
        angular_velocity: Vec::new(),
        weight: vec![weight; count],
        motion: Motion::Parcels(Box::new(motion)),
    }
}

/// A bed with its clock.
pub struct ParcelBed {
    pub parcels: NativeParcels,
    pub clock: Ticks,
    pub received: ParticleReceived,
    supervisor: Supervisor,
}

impl ParcelBed {
    pub fn new(mesh: &Arc<Mesh>, setup: &ParticleSetup) -> Self {
        Self {
            parcels: NativeParcels::new(Arc::clone(mesh), setup).unwrap(),
            clock: Ticks::new(0),
            received: ParticleReceived::default(),
            supervisor: Supervisor::new(Duration::from_secs(60), Interrupts::default()),
        }
    }

    /// A window of so many seconds.
    pub fn window(&mut self, seconds: f64, push: &ParticlePush) {
        let span = Ticks::from_seconds(seconds).unwrap();
        let both = |ticks: Ticks| Clocks {
            motion: ticks,
            process: ticks,
        };
        let window = Window {
            index: 0,
            attempt: 0,
            start: both(self.clock),
            span: both(span),
        };
        self.parcels
            .start(&window, &GasBed::default(), push)
            .unwrap();
        self.parcels
            .finish(&self.supervisor, &mut self.received)
            .unwrap();
        self.clock = Ticks::new(self.clock.count() + span.count());
    }

    /// Windows without any force of the gas.
    pub fn run(&mut self, windows: usize, seconds: f64) {
        let push = ParticlePush {
            force: vec![Vec3::zeros(); self.parcels.fields().len()],
            ..ParticlePush::default()
        };
        for _ in 0..windows {
            self.window(seconds, &push);
        }
    }

    /// Momentum in N s of all real particles.
    pub fn momentum(&self) -> Vec3 {
        let fields = self.parcels.fields();
        (0..fields.len())
            .map(|row| fields.row_mass(row) * fields.velocity[row])
            .sum()
    }

    /// All bits of places and velocities.
    pub fn bits(&self) -> Vec<u64> {
        let fields = self.parcels.fields();
        let vectors = fields.position.iter().chain(fields.velocity);
        vectors
            .flat_map(|vector| vector.iter().map(|x| x.to_bits()).collect::<Vec<_>>())
            .collect()
    }
}
