//! The bed of the laws of particles.

use calcine_physics::{Vec3, sphere};

use crate::motion::{
    Cohesion, ContactForce, ContactLaw, Contacts, Elastic, Motion, Pair, Rolling, Wall, WallMotion,
    WallShape,
};
use crate::setup::ParticleSetup;

/// Time step in s.
pub const STEP: f64 = 1e-6;
/// Side of the box in m.
pub const BOX: f64 = 0.1;
/// Radius in m.
pub const RADIUS: f64 = 0.0025;
/// Density in kg/m³.
pub const DENSITY: f64 = 2500.0;
/// The population that is held.
const HELD: u32 = 1;

/// Six spheres: two that touch, three apart, one held. Their ids have gaps.
pub fn setup() -> ParticleSetup {
    let place = |x: f64, z: f64| Vec3::new(x, 0.05, z);
    let position = vec![
        place(0.02, 0.05),
        place(0.02, 0.05 + 1.99 * RADIUS),
        place(0.04, 0.03),
        place(0.06, 0.07),
        place(0.08, 0.02),
        place(0.08, 0.05),
    ];
    let mut velocity = vec![Vec3::zeros(); position.len()];
    velocity[3] = Vec3::new(0.1, -0.2, 0.3);
    ParticleSetup {
        id: vec![1, 2, 4, 7, 8, 11],
        population: vec![0, 0, 0, 0, 0, HELD],
        radius: vec![RADIUS; position.len()],
        density: vec![DENSITY; position.len()],
        velocity,
        position,
        motion: Motion::Free(Box::new(contacts())),
        ..ParticleSetup::default()
    }
}

/// Soft spheres to test with: two materials alike, of which the second is held, of Young's modulus in Pa, with a Poisson's
/// ratio of 0.25, a restitution of 0.5 and a friction of 0.3; steps in s. No gravity, no walls.
pub fn soft_spheres(step: f64, young: f64) -> Contacts {
    Contacts {
        step,
        gravity: Vec3::zeros(),
        bounds: (Vec3::zeros(), Vec3::repeat(BOX)),
        lost: Default::default(),
        periodicity: Default::default(),
        materials: vec![Elastic {
            young,
            poisson: 0.25,
        }],
        material_of: vec![0, 0],
        held: vec![false, true],
        law: ContactLaw {
            force: ContactForce::HertzMindlin,
            attractive_damping: true,
            rolling: Rolling::None,
            cohesion: Cohesion::None,
        },
        pairs: vec![Pair {
            restitution: 0.5,
            friction: 0.3,
            ..Pair::default()
        }],
        walls: Vec::new(),
    }
}

/// The spheres of the laws: of 50 MPa, above a floor.
pub fn contacts() -> Contacts {
    Contacts {
        walls: vec![Wall {
            name: "floor".into(),
            material: 0,
            shape: WallShape::Plane {
                point: Vec3::zeros(),
                normal: Vec3::z(),
            },
            motion: WallMotion::Still,
        }],
        ..soft_spheres(STEP, 5e7)
    }
}

/// Mass of a sphere in kg.
pub fn mass(radius: f64) -> f64 {
    sphere::mass(radius, DENSITY)
}
