//! The force of one contact, of two spheres or of a sphere and a wall.

use calcine_coupler::motion::{Cohesion, Rolling};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::{
    AdhesiveContact, CohesionArea, ContactModel, PairConstants, RollingSpring, constant_torque,
    elastic_plastic, friction, jkr, sjkr,
};

use super::energy::ContactEnergy;
use super::rules::ContactRules;

/// Two surfaces that overlap.
pub struct SurfaceOverlap {
    /// Unit normal from the other body to the sphere.
    pub normal: Vec3,
    /// Overlap δ in m; negative where adhesion holds surfaces that have parted.
    pub overlap: f64,
    /// Effective radius in m.
    pub radius: f64,
    /// Effective mass in kg.
    pub mass: f64,
    /// Velocity of the sphere's centre against the other body in m/s.
    pub velocity: Vec3,
    /// Arm times angular velocity, summed over both bodies, in m/s.
    pub turning: Vec3,
    /// Rotation against the other body in rad/s.
    pub rotation: Vec3,
    /// 7/5 of the reduced moment m R² in kg m²; read with a rolling spring only.
    pub inertia: f64,
    /// Contact area; read with `sjkr` only.
    pub area: CohesionArea,
}

/// What the contact does to the sphere; the other body gets the opposite.
pub struct ContactLoad {
    /// Force in N.
    pub force: Vec3,
    /// n × F_t in N; the torque of each body is −arm times this.
    pub twist: Vec3,
    /// Torque of rolling on the sphere in N m.
    pub rolling: Vec3,
}

/// Evaluates a contact and brings its memory up to date over a step in s.
#[inline(always)]
#[allow(clippy::too_many_arguments)]
pub fn evaluate<L: ContactModel, const BUDGET: bool>(
    law: &L,
    rules: &ContactRules,
    (pair, prepared): (&PairConstants, f64),
    surfaces: &SurfaceOverlap,
    shift: &mut Vec3,
    torque: &mut Vec3,
    step: f64,
    budget: &mut ContactEnergy,
) -> ContactLoad {
    let normal = surfaces.normal;
    let adhesion = match rules.cohesion {
        Cohesion::Jkr => jkr(pair, surfaces.overlap, surfaces.radius),
        Cohesion::None | Cohesion::Sjkr => AdhesiveContact::none(surfaces.overlap),
    };
    let springs = law.springs(
        pair,
        prepared,
        adhesion.hertz_overlap,
        surfaces.radius,
        surfaces.mass,
    );
    let elastic = springs.elastic + adhesion.pull;
    let approach = surfaces.velocity.dot(&normal);
    let mut damped = elastic - springs.normal_damping * approach;
    // Damping pulls no more than adhesion does.
    if !rules.attractive && damped < elastic.min(0.0) {
        damped = elastic.min(0.0);
    }
    let mut push = damped;
    let mut stored = springs.energy + adhesion.energy;
    if rules.cohesion == Cohesion::Sjkr {
        let (pull, energy) = sjkr(pair, surfaces.area);
        push += pull;
        stored += energy;
    }
    let slip = surfaces.velocity - approach * normal - surfaces.turning.cross(&normal);
    let mut moved = *shift + slip * step;
    moved -= moved.dot(&normal) * normal;
    // Friction is limited by the force without attraction, of an adhesive contact by what presses beyond the pull-off force twice.
    let load = damped + 2.0 * adhesion.pull_off;
    let limit = pair.friction * load.abs();
    let mut tangential = friction::<L>(moved, slip, &springs, limit);
    *shift = tangential.shift;
    // An evaluation that only looks must not take a contact that slides for one that sticks: rounding
    // decides which, and the dashpot is not limited.
    if step == 0.0 {
        let force = tangential.force.norm();
        if force > limit {
            tangential.force *= limit / force;
        }
    }
    let rolling = match rules.rolling {
        Rolling::None => Vec3::zeros(),
        Rolling::ConstantTorque => constant_torque(
            pair,
            elastic + 2.0 * adhesion.pull_off,
            surfaces.radius,
            surfaces.rotation,
            normal,
        ),
        Rolling::ElasticPlastic => {
            let spring = RollingSpring {
                force: load,
                stiffness: springs.elastic / adhesion.hertz_overlap,
                radius: surfaces.radius,
                inertia: surfaces.inertia,
            };
            let across = surfaces.rotation - surfaces.rotation.dot(&normal) * normal;
            elastic_plastic(pair, &spring, torque, across, step)
        }
    };
    if BUDGET {
        budget.elastic_normal += stored;
        budget.elastic_tangential += 0.5 * springs.tangential_stiffness * shift.norm_squared();
        budget.lost_normal += (elastic - damped) * approach * step;
        // The block takes off what its springs hold more than before.
        budget.lost_tangential -= tangential.force.dot(&slip) * step;
        budget.lost_rolling -= rolling.dot(&surfaces.rotation) * step;
    }
    ContactLoad {
        force: push * normal + tangential.force,
        twist: normal.cross(&tangential.force),
        rolling,
    }
}
