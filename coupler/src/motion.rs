//! What a discrete element solver is told beside the particles: materials, contacts, walls. All
//! values are of the motion clock.

use calcine_physics::Vec3;
use calcine_physics::dimension::Dimension;
use calcine_physics::law::{Bound, LawEntry, LawParameter};

use crate::parcels::ParcelMotion;
use crate::periodicity::Periodicity;

pub use crate::wall_motion::WallMotion;

/// How the particles of a run move.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Motion {
    /// All stay where they are; their support takes up every force.
    #[default]
    Frozen,
    /// They move freely under gravity, contacts and the force of the gas.
    Free(Box<Contacts>),
    /// Each stands for many, and moves under gravity, the force of the gas and the stress of the solid.
    Parcels(Box<ParcelMotion>),
}

impl Motion {
    /// True where no particle moves.
    pub fn is_frozen(&self) -> bool {
        matches!(self, Motion::Frozen)
    }
}

/// Everything that the contacts of moving particles depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Contacts {
    /// Time step in s of motion time.
    pub step: f64,
    /// Gravity in m/s².
    pub gravity: Vec3,
    /// Lower and upper corner of the space in which particles may be, in m; one that leaves it is
    /// an error that names it, unless such particles are taken out.
    pub bounds: (Vec3, Vec3),
    /// What becomes of particles that leave.
    pub lost: LostParticles,
    /// Directions in which this space repeats itself: what leaves through one plane comes in through the other.
    pub periodicity: Periodicity,
    /// Elastic constants of each material.
    pub materials: Vec<Elastic>,
    /// Index of the material of each population.
    pub material_of: Vec<usize>,
    /// True for each population that is held where it is.
    pub held: Vec<bool>,
    /// Law of the contact force.
    pub law: ContactLaw,
    /// Properties of each pair of materials, row by row of a symmetric matrix.
    pub pairs: Vec<Pair>,
    /// Walls.
    pub walls: Vec<Wall>,
}

impl Contacts {
    /// Properties of the contact of two materials.
    pub fn pair(&self, a: usize, b: usize) -> &Pair {
        &self.pairs[a * self.materials.len() + b]
    }
}

/// Why particles leave, and what to do about it.
pub const LOST_REMEDY: &str = "particles leave where no wall closes the gas mesh, through a hole in a wall, where a wall that moves or a feed puts them, or because the step is too long or \
                               the contacts are too soft for their speed: see walls, step and overlap in `calcine check`; \
                               motion.lost = \"take-out\" takes them out and goes on";

/// What becomes of particles whose centres leave the gas mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LostParticles {
    /// They end the run.
    #[default]
    End,
    /// The coordinator takes them out after the window in which they left; a part must not lose them before.
    TakeOut,
    /// Those that left through an outlet the coordinator takes out, others end the run; a part must not lose them before.
    Through,
}

/// Elastic constants of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus in Pa.
    pub young: f64,
    /// Poisson's ratio.
    pub poisson: f64,
}

/// Properties of the contact of a pair of materials.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pair {
    /// Coefficient of restitution, above 0 and up to 1.
    pub restitution: f64,
    /// Coefficient of sliding friction (Coulomb).
    pub friction: f64,
    /// Coefficient of rolling friction.
    pub rolling_friction: f64,
    /// Damping of rolling as a share of the critical one (elastic-plastic law only).
    pub rolling_damping: f64,
    /// Cohesion energy density in J/m³ (SJKR law only).
    pub cohesion_energy: f64,
    /// Work of adhesion in J/m² (JKR law only).
    pub work_of_adhesion: f64,
}

/// Law of the force between two particles, or a particle and a wall, in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    /// The force along the line of centres, with the tangential spring that belongs to it.
    pub force: ContactForce,
    /// True where damping may pull separating spheres together (the linear oscillator of which the
    /// restitution is derived); false where the normal force is cut at zero, which changes the
    /// restitution (0.5 comes out as 0.55).
    pub attractive_damping: bool,
    /// Resistance to rolling.
    pub rolling: Rolling,
    /// Attraction.
    pub cohesion: Cohesion,
}

/// Force of an elastic contact with damping and friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactForce {
    /// Hertz, Mindlin and Tsuji with tangential history (docs/theory.md, COR-12).
    HertzMindlin,
    /// OpenFOAM's pair of spring, slider and dashpot, friction limiting the sum of the two (docs/theory.md, COR-13).
    SpringSliderDashpot,
    /// The same as OpenFOAM has it: friction limits the spring alone, which slip forgets (docs/theory.md, COR-13).
    OpenfoamSpringSliderDashpot,
    /// Linear spring and dashpot with tangential history: the stiffness at which a pair that meets with this
    /// speed in m/s overlaps as much as by Hertz' law.
    Linear {
        /// Characteristic speed of impact in m/s.
        characteristic_speed: f64,
    },
    /// Linear springs and dashpots with tangential history, of one stated stiffness for all pairs.
    LinearSprings {
        /// Normal stiffness in N/m.
        stiffness: f64,
        /// Tangential over normal stiffness.
        tangential_ratio: f64,
    },
}

impl ContactForce {
    /// True where its elastic force is that of Hertz' law.
    pub fn is_hertz(&self) -> bool {
        match self {
            Self::HertzMindlin | Self::SpringSliderDashpot | Self::OpenfoamSpringSliderDashpot => {
                true
            }
            Self::Linear { .. } | Self::LinearSprings { .. } => false,
        }
    }
}

/// Resistance to rolling.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rolling {
    /// None.
    #[default]
    None,
    /// Constant directional torque: μ_r R* |F_n| against the relative rotation.
    ConstantTorque,
    /// Elastic-plastic spring and dashpot (Ai, Chen, Rotter, Ooi 2011, doi 10.1016/j.powtec.2010.09.030).
    ElasticPlastic,
}

/// Attraction between surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Cohesion {
    /// None.
    #[default]
    None,
    /// Simplified Johnson, Kendall, Roberts: cohesion energy density times the contact area.
    Sjkr,
    /// Johnson, Kendall, Roberts: adhesive elastic spheres with a pull-off force, torn off at a distance (docs/theory.md, COR-46).
    Jkr,
}

/// The forces of contacts that a case may choose; the solvers of particles say which of them they have.
pub static CONTACT_LAWS: &[&LawEntry<ContactForce>] = &[
    &LawEntry {
        name: "hertz-mindlin",
        summary: "Hertz, Mindlin and Tsuji with tangential history.",
        source: "Tsuji, Tanaka and Ishida, Powder Technol. 71 (1992) 239, doi 10.1016/0032-5910(92)88030-L",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(ContactForce::HertzMindlin),
    },
    &LawEntry {
        name: "linear",
        summary: "Linear spring and dashpot with tangential history.",
        source: "Cundall and Strack, Geotechnique 29 (1979) 47, doi 10.1680/geot.1979.29.1.47",
        parameters: &[LawParameter {
            name: "characteristic_speed",
            dimension: Dimension::VELOCITY,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "Speed of impact at which the linear spring overlaps as much as by the law of Hertz.",
            example: "\"1 m/s\"",
        }],
        tables: &[],
        make: |values| {
            Box::new(ContactForce::Linear {
                characteristic_speed: values[0],
            })
        },
    },
    &LawEntry {
        name: "linear-springs",
        summary: "Linear springs and dashpots of a stated stiffness with tangential history.",
        source: "Cundall and Strack, Geotechnique 29 (1979) 47, doi 10.1680/geot.1979.29.1.47",
        parameters: &[
            LawParameter {
                name: "stiffness",
                dimension: Dimension::STIFFNESS,
                bound: Bound::Positive,
                default: None,
                needed_with: None,
                meaning: "Normal stiffness of all pairs; Young's moduli then do not act on contacts.",
                example: "\"1 kN/m\"",
            },
            LawParameter {
                name: "tangential_ratio",
                dimension: Dimension::NONE,
                bound: Bound::UpTo(0.0, 1.0),
                default: Some(2.0 / 7.0),
                needed_with: None,
                meaning: "Tangential over normal stiffness, k_t/k_n.",
                example: "0.2857",
            },
        ],
        tables: &[],
        make: |values| {
            Box::new(ContactForce::LinearSprings {
                stiffness: values[0],
                tangential_ratio: values[1],
            })
        },
    },
    &LawEntry {
        name: "spring-slider-dashpot",
        summary: "OpenFOAM's pair of spring, slider and dashpot, the sum of spring and dashpot limited by friction.",
        source: "OpenFOAM 6, `PairSpringSliderDashpot.C`; Luding, Granular Matter 10 (2008) 235, doi 10.1007/s10035-008-0099-x",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(ContactForce::SpringSliderDashpot),
    },
    &LawEntry {
        name: "spring-slider-dashpot-openfoam",
        summary: "The same as OpenFOAM has it: the dashpot is not limited, and slip forgets the spring, so that friction depends on the step.",
        source: "OpenFOAM 6, `PairSpringSliderDashpot.C`",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(ContactForce::OpenfoamSpringSliderDashpot),
    },
];

/// The resistances to rolling that a case may choose.
pub static ROLLING_LAWS: &[&LawEntry<Rolling>] = &[
    &LawEntry {
        name: "none",
        summary: "No resistance to rolling.",
        source: "",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(Rolling::None),
    },
    &LawEntry {
        name: "constant-torque",
        summary: "A torque of one size against the relative rotation.",
        source: "Zhou, Wright, Yang, Xu and Yu, Physica A 269 (1999) 536, doi 10.1016/S0378-4371(99)00183-1",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(Rolling::ConstantTorque),
    },
    &LawEntry {
        name: "elastic-plastic",
        summary: "A spring and dashpot of rolling that yields.",
        source: "Ai, Chen, Rotter and Ooi, Powder Technol. 206 (2011) 269, doi 10.1016/j.powtec.2010.09.030",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(Rolling::ElasticPlastic),
    },
];

/// The attractions between surfaces that a case may choose.
pub static COHESION_LAWS: &[&LawEntry<Cohesion>] = &[
    &LawEntry {
        name: "none",
        summary: "No attraction.",
        source: "",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(Cohesion::None),
    },
    &LawEntry {
        name: "sjkr",
        summary: "Simplified Johnson, Kendall and Roberts: cohesion energy density times the contact area.",
        source: "Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324 (1971) 301, doi 10.1098/rspa.1971.0141",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(Cohesion::Sjkr),
    },
    &LawEntry {
        name: "jkr",
        summary: "Johnson, Kendall and Roberts: adhesive elastic spheres with a pull-off force and a distance at which contacts tear off.",
        source: "Johnson, Kendall and Roberts, Proc. R. Soc. Lond. A 324 (1971) 301, doi 10.1098/rspa.1971.0141; Parteli et al., Sci. Rep. 4 (2014) 6227, doi 10.1038/srep06227",
        parameters: &[],
        tables: &[],
        make: |_| Box::new(Cohesion::Jkr),
    },
];

/// A wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Wall {
    /// Its name.
    pub name: String,
    /// Index of its material.
    pub material: usize,
    /// Where it is.
    pub shape: WallShape,
    /// How it moves.
    pub motion: WallMotion,
}

/// Shape of a wall at the start of the run.
#[derive(Clone, Debug, PartialEq)]
pub enum WallShape {
    /// A plane; particles are on the side to which the normal points.
    Plane {
        /// A point of it in m.
        point: Vec3,
        /// Unit normal, into the particles' side.
        normal: Vec3,
    },
    /// The inner side of an endless circular cylinder.
    Cylinder {
        /// A point of the axis in m.
        point: Vec3,
        /// Unit vector along the axis.
        axis: Vec3,
        /// Radius in m.
        radius: f64,
    },
    /// The inner side of the frustum of a circular cone between two points of its axis.
    Cone {
        /// Ends of the axis in m.
        ends: [Vec3; 2],
        /// Radii at these ends in m.
        radii: [f64; 2],
    },
    /// Triangles, both sides of them; faces, edges and corners act once.
    Mesh {
        /// Corners of each triangle in m.
        triangles: Vec<[Vec3; 3]>,
    },
}

/// Particles that come and go between two windows, become others by what reacts in them, or are held. The
/// coordinator decides on them, so that they are the same for every backend.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ParticleChanges {
    /// Ids of those that go.
    pub remove: Vec<u64>,
    /// Those that come, with ids that were never used before, ascending.
    pub insert: Vec<NewParticle>,
    /// Those that stay with another radius or mass, in ascending id; none of those that go. They keep place,
    /// velocity and the memories of their contacts.
    pub resize: Vec<Resized>,
    /// All that were there come to rest where they are, and keep the memories of their contacts.
    pub rest: bool,
}

impl ParticleChanges {
    /// True where nothing changes.
    pub fn is_empty(&self) -> bool {
        let Self {
            remove,
            insert,
            resize,
            rest,
        } = self;
        remove.is_empty() && insert.is_empty() && resize.is_empty() && !rest
    }
}

/// A particle that has become larger, smaller, lighter or heavier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Resized {
    /// Its id.
    pub id: u64,
    /// Radius in m.
    pub radius: f64,
    /// Mass in kg.
    pub mass: f64,
}

/// A particle that comes in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewParticle {
    /// Its id.
    pub id: u64,
    /// Index of its population.
    pub population: u32,
    /// Centre in m.
    pub position: Vec3,
    /// Velocity in m/s of motion time.
    pub velocity: Vec3,
    /// Radius in m.
    pub radius: f64,
    /// Density in kg/m³.
    pub density: f64,
    /// Number of real particles that it stands for.
    pub weight: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_gate_is_where_its_schedule_says_and_moves_only_on_the_way() {
        let gate = WallMotion::Scheduled {
            direction: Vec3::x(),
            distance: vec![(1.0, 0.0), (1.5, 0.04), (3.0, 0.04), (5.0, 0.0)],
        };
        let at = |time: f64| gate.displacement(time).0.x;
        let speed = |time: f64| gate.displacement(time).1.x;
        assert_eq!(
            [at(0.0), at(1.25), at(2.0), at(9.0)],
            [0.0, 0.02, 0.04, 0.0]
        );
        assert_eq!(
            [speed(0.0), speed(1.0), speed(2.0), speed(4.0), speed(5.0)],
            [0.0, 0.08, 0.0, -0.02, 0.0]
        );
        assert_eq!(gate.largest_speed(), 0.08);
    }

    #[test]
    fn an_oscillation_has_its_velocity_and_closes_after_a_period() {
        let shaker = WallMotion::Oscillating {
            amplitude: Vec3::z() * 2e-3,
            period: 0.05,
        };
        let (start, fast) = shaker.displacement(0.0);
        assert_eq!(start, Vec3::zeros());
        assert!((fast.z / shaker.largest_speed() - 1.0).abs() < 1e-15);
        assert!((shaker.displacement(0.0125).0.z / 2e-3 - 1.0).abs() < 1e-12);
        assert!(shaker.displacement(0.05).0.norm() < 1e-17);
        let (a, b) = (shaker.displacement(0.01), shaker.displacement(0.01 + 1e-7));
        assert!(((b.0 - a.0).z / 1e-7 / a.1.z - 1.0).abs() < 1e-4);
    }
}
