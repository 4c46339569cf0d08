//! A frictionless elastic box of 1000 spheres over 1e5 steps: energy, and momentum where there are no walls.

use std::time::Duration;

use calcine_coupler::conformance::particles::soft_spheres;
use calcine_coupler::motion::{Contacts, Motion, Pair, Wall, WallMotion, WallShape};
use calcine_coupler::part::{Bed as VoidFractions, ParticlePush, ParticleReceived, Particles};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::particles::NativeParticles;

/// Edge of the box in m.
const EDGE: f64 = 0.03;
/// Radius in m.
const RADIUS: f64 = 1e-3;
/// Time step in s: some 40 in a collision at 1 m/s.
const STEP: f64 = 2e-6;
/// Steps of a look, and looks.
const STEPS: [u64; 2] = [10_000, 10];

pub fn run() {
    let spheres = cloud(1000);
    println!("  |   step | energy − 1 | kinetic − 1 |");
    let mut bed = Bed::new(contacts(walls()), &spheres);
    let before = bed.particles.energy();
    let mut worst = 0.0f64;
    for look in 1..=STEPS[1] {
        bed.steps(STEPS[0]);
        let after = bed.particles.energy();
        let drift = after.stored() / before.stored() - 1.0;
        let kinetic = after.kinetic / before.kinetic - 1.0;
        println!(
            "  | {:>6} | {drift:>10.2e} | {kinetic:>11.2e} |",
            look * STEPS[0]
        );
        worst = worst.max(drift.abs());
        assert_eq!(after.lost(), 0.0);
        assert_eq!(after.rotational, 0.0);
    }
    assert!(worst < 1e-4, "{worst}");

    // Without walls: the cloud falls in on itself, bounces and flies apart.
    let mut free = spheres;
    for (place, velocity) in &mut free {
        *velocity += (Vec3::repeat(0.5 * EDGE) - *place) * 40.0 + Vec3::x();
        *place += Vec3::repeat(0.5);
    }
    let mut bed = Bed::new(contacts(Vec::new()), &free);
    let before = bed.particles.energy().momentum;
    let mut drift = 0.0f64;
    for _ in 0..STEPS[1] {
        bed.steps(STEPS[0]);
        let after = bed.particles.energy().momentum;
        drift = drift.max((after - before).norm() / before.norm());
    }
    println!("  momentum without walls: {drift:.1e}");
    assert!(drift < 1e-12, "{drift}");
}

/// Spheres on a loose grid with random velocities up to 1 m/s.
fn cloud(count: usize) -> Vec<(Vec3, Vec3)> {
    let mut state = 7u64;
    let mut random = || {
        // Knuth's MMIX generator.
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 * 2.0 - 1.0
    };
    let side = (count as f64).cbrt().round() as usize;
    let spacing = EDGE / side as f64;
    (0..count)
        .map(|k| {
            let [i, j, l] = [k % side, k / side % side, k / side / side];
            let corner = Vec3::new(i as f64, j as f64, l as f64) * spacing;
            let mut vector = || Vec3::new(random(), random(), random());
            let shake = 0.9 * (0.5 * spacing - RADIUS) * vector();
            (corner + Vec3::repeat(0.5 * spacing) + shake, vector())
        })
        .collect()
}

fn walls() -> Vec<Wall> {
    let plane = |k: usize| {
        let mut normal = Vec3::zeros();
        normal[k / 2] = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let far = Vec3::repeat(EDGE);
        Wall {
            name: format!("side {k}"),
            material: 0,
            shape: WallShape::Plane {
                point: if k.is_multiple_of(2) {
                    Vec3::zeros()
                } else {
                    far
                },
                normal,
            },
            motion: WallMotion::Still,
        }
    };
    (0..6).map(plane).collect()
}

fn contacts(walls: Vec<Wall>) -> Contacts {
    Contacts {
        bounds: (Vec3::repeat(-1.0), Vec3::repeat(2.0)),
        periodicity: Default::default(),
        pairs: vec![Pair {
            restitution: 1.0,
            ..Pair::default()
        }],
        walls,
        ..soft_spheres(STEP, 1e7)
    }
}

/// A bed whose energies are counted.
struct Bed {
    particles: NativeParticles,
    supervisor: Supervisor,
    push: ParticlePush,
    start: Ticks,
}

impl Bed {
    fn new(contacts: Contacts, spheres: &[(Vec3, Vec3)]) -> Self {
        let count = spheres.len();
        let setup = ParticleSetup {
            id: (1..=count as u64).collect(),
            population: vec![0; count],
            position: spheres.iter().map(|sphere| sphere.0).collect(),
            radius: vec![RADIUS; count],
            density: vec![2500.0; count],
            velocity: spheres.iter().map(|sphere| sphere.1).collect(),
            motion: Motion::Free(Box::new(contacts)),
            ..ParticleSetup::default()
        };
        let mut particles = NativeParticles::new(&setup).unwrap();
        particles.count_energy(true);
        let mut bed = Self {
            particles,
            supervisor: Supervisor::new(Duration::from_secs(60), Interrupts::default()),
            push: ParticlePush {
                force: vec![Vec3::zeros(); count],
                ..ParticlePush::default()
            },
            start: Ticks::ZERO,
        };
        // Elastic energies are known from the first step on.
        bed.steps(1);
        bed
    }

    fn steps(&mut self, steps: u64) {
        let span = Ticks::from_seconds(steps as f64 * STEP).unwrap();
        let clocks = |ticks| Clocks {
            motion: ticks,
            process: ticks,
        };
        let window = Window {
            start: clocks(self.start),
            span: clocks(span),
            ..Window::default()
        };
        self.particles
            .start(&window, &VoidFractions::default(), &self.push)
            .unwrap();
        let mut received = ParticleReceived::default();
        self.particles
            .finish(&self.supervisor, &mut received)
            .unwrap();
        self.start = self.start.checked_add(span).unwrap();
    }
}
