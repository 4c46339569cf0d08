//! From the sections of a case to what a discrete element solver is told, and its time step.

use std::f64::consts::PI;

use calcine_coupler::coordinator::LONGEST_STEP;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::motion::{
    ContactForce, Contacts, Elastic, LostParticles, Motion as Told, Pair, Wall, WallMotion,
};
use calcine_coupler::periodic_motion::{self, PeriodicMotionError};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::contact::time_step;
use calcine_coupler::setup::ParticleSetup;
use calcine_coupler::time::Ticks;
use thiserror::Error;

use super::fall;
use super::impact;
use super::model::{Case, FreeMotion, MaterialSpec, MotionKind, MotionSpec};
use super::moving::moving_spheres;
use super::servo_cautions;
use super::touching::{Touching, touching};
use super::units::{short3, shown};

/// A step above this share of Rayleigh's time gets a warning, above the second it is refused.
const RAYLEIGH: [f64; 2] = [0.2, LONGEST_STEP];
/// The same for the duration of a Hertzian impact.
const HERTZ: [f64; 2] = [0.1, 0.25];
/// Shares by which a step is chosen where the case states none.
const CHOSEN: [f64; 2] = [0.15, 0.05];

/// Contacts that cannot be computed.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ContactsError {
    /// The step is too long for the contacts.
    #[error(
        "`motion.motion_step` is {} s, but {}the fastest impact lasts {} s (at {} m/s); write {} s or less, a \
         softer material, or motion.long_step = true, which warns in place of this error", shown(*.step), wave(*.rayleigh),
        shown(*.hertz), shown(*.speed), shown(*.fit)
    )]
    Step {
        /// The step in s.
        step: f64,
        /// Rayleigh's time in s.
        rayleigh: f64,
        /// Duration of an impact in s.
        hertz: f64,
        /// Speed of the impact in m/s.
        speed: f64,
        /// A step that fits, in s.
        fit: f64,
    },
    /// Walls that move over a changing acceleration factor.
    #[error(
        "wall \"{wall}\" moves, but `time.acceleration` changes: its speed on the motion clock would \
         change too; write one factor, or hold the bed where it is another"
    )]
    Schedule {
        /// Its name.
        wall: String,
    },
    /// Walls that move by a schedule of process time in a bed that is held.
    #[error(
        "wall \"{wall}\" is `moved` or `oscillating`, but `motion.held` stops it while its schedule goes on; leave out one of the two"
    )]
    Held {
        /// Its name.
        wall: String,
    },
    /// Walls or particles that do not go with the periodic directions.
    #[error("{cause}; {}", .cause.remedy())]
    Periodic {
        /// What does not.
        #[from]
        cause: PeriodicMotionError,
    },
    /// A time between two in which the bed is held that is shorter than a step.
    #[error(
        "between two times of `motion.held` the bed moves from {from} to {to}, which is {} s of motion time, less \
         than the step of {} s; hold it less often, or lower `motion.motion_step`", shown(*.motion), shown(*.step)
    )]
    Short {
        /// Begin of the process time in which it moves.
        from: Ticks,
        /// Its end.
        to: Ticks,
        /// Motion time between them in s.
        motion: f64,
        /// The step in s.
        step: f64,
    },
}

/// Rayleigh's time in s in words; nothing where waves do not limit.
fn wave(rayleigh: f64) -> String {
    match rayleigh.is_finite() {
        true => format!(
            "a surface wave crosses the smallest particle in {} s (Rayleigh) and ",
            shown(rayleigh)
        ),
        false => String::new(),
    }
}

/// Times that limit the step of a contact solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Shortest [Rayleigh time](time_step::rayleigh) in s of a particle, softer where all that it can touch is; infinite where springs are stated, in which no wave runs.
    pub rayleigh: f64,
    /// Shortest [duration of an impact](time_step::hertz_collision) in s at `speed`.
    pub hertz: f64,
    /// Speed in m/s: of the start, of walls, or of a fall through the mesh, whichever is largest.
    pub speed: f64,
}

impl Limits {
    /// The step in s that suits both.
    pub fn fit(&self) -> f64 {
        (CHOSEN[0] * self.rayleigh).min(CHOSEN[1] * self.hertz)
    }

    /// What is to be said of a step in s.
    pub fn warning(&self, step: f64) -> Option<String> {
        let shares = [step / self.rayleigh, step / self.hertz];
        (shares[0] > RAYLEIGH[0] || shares[1] > HERTZ[0]).then(|| {
            if self.rayleigh.is_infinite() {
                return format!(
                    "`motion.motion_step` is {:.0} % of the shortest impact; contacts lose accuracy above {:.0} %",
                    100.0 * shares[1],
                    100.0 * HERTZ[0]
                );
            }
            format!(
                "`motion.motion_step` is {:.0} % of Rayleigh's time and {:.0} % of the shortest impact; \
                 contacts lose accuracy above {:.0} % and {:.0} %",
                100.0 * shares[0],
                100.0 * shares[1],
                100.0 * RAYLEIGH[0],
                100.0 * HERTZ[0]
            )
        })
    }

    fn refuse(&self, step: f64) -> Option<ContactsError> {
        let far = step > RAYLEIGH[1] * self.rayleigh || step > HERTZ[1] * self.hertz;
        far.then(|| ContactsError::Step {
            step,
            rayleigh: self.rayleigh,
            hertz: self.hertz,
            speed: self.speed,
            fit: self.fit(),
        })
    }
}

/// How the particles of a case move, on the motion clock.
pub fn motion(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Result<Told, ContactsError> {
    let free = case
        .particles
        .iter()
        .any(|one| one.motion == MotionSpec::Free);
    let Some(motion) = case.motion.as_ref().filter(|_| free) else {
        return Ok(Told::Frozen);
    };
    let limits = limits(case, motion, mesh, setup);
    let window = case.time.motion_window.seconds();
    let step = match motion.step {
        Some(step) => step,
        // A whole number of steps fills a window.
        None => window / (window / limits.fit()).ceil().max(1.0),
    };
    if let Some(error) = limits.refuse(step).filter(|_| !motion.long_step) {
        return Err(error);
    }
    let moving = motion.held.moving(&case.time.acceleration, case.time.end);
    for &([from, to], factor) in moving.iter().filter(|_| !motion.held.is_none()) {
        let motion = to.since(from).seconds() / factor;
        if motion < step {
            return Err(ContactsError::Short {
                from,
                to,
                motion,
                step,
            });
        }
    }
    // The reader asks for the elastic constants of what touches; others are never used.
    let elastic = |material: &MaterialSpec| Elastic {
        young: material.young.unwrap_or(1e7),
        poisson: material.poisson.unwrap_or(0.3),
    };
    let contacts = Contacts {
        step,
        gravity: case.gas.gravity,
        bounds: mesh.bounds().into(),
        lost: match motion.lost {
            LostParticles::End if case.outlets.iter().any(|one| one.rate.is_none()) => {
                LostParticles::Through
            }
            lost => lost,
        },
        periodicity: *mesh.periodicity(),
        materials: case.materials.iter().map(elastic).collect(),
        material_of: case.particles.iter().map(|one| one.material).collect(),
        held: case
            .particles
            .iter()
            .map(|one| one.motion == MotionSpec::Frozen)
            .collect(),
        law: motion.law,
        pairs: pairs(case),
        walls: walls(case, moving.iter().map(|one| one.1))?,
    };
    let radii = setup.radius.iter().copied().fold(0.0, f64::max);
    let fed = case
        .feeds
        .iter()
        .map(|feed| 0.5 * case.particles[feed.population].sizes.largest());
    periodic_motion::check(&contacts, fed.fold(radii, f64::max))?;
    Ok(Told::Free(Box::new(contacts)))
}

/// Properties of all pairs; those that are not stated never touch.
fn pairs(case: &Case) -> Vec<Pair> {
    let count = case.materials.len();
    let unused = Pair {
        restitution: 1.0,
        ..Pair::default()
    };
    let mut pairs = vec![unused; count * count];
    for contact in &case.contacts {
        let [a, b] = contact.between;
        let pair = Pair {
            restitution: contact.restitution.unwrap_or(1.0),
            friction: contact.friction.unwrap_or(0.0),
            rolling_friction: contact.rolling_friction.unwrap_or(0.0),
            rolling_damping: contact.rolling_damping.unwrap_or(0.0),
            cohesion_energy: contact.cohesion_energy.unwrap_or(0.0),
            work_of_adhesion: contact.work_of_adhesion.unwrap_or(0.0),
        };
        pairs[a * count + b] = pair;
        pairs[b * count + a] = pair;
    }
    pairs
}

/// The walls; what users write of their speed is process time, of which so many pass in one of motion time while
/// the bed moves.
fn walls(case: &Case, mut factors: impl Iterator<Item = f64>) -> Result<Vec<Wall>, ContactsError> {
    let held = case
        .motion
        .as_ref()
        .is_some_and(|motion| !motion.held.is_none());
    let factor = factors.next().unwrap_or(1.0);
    let changes = factors.any(|one| one != factor);
    let quicker = |wall: &Wall| {
        let motion = match &wall.motion {
            // A servo follows the particles, on whatever clock they move.
            WallMotion::Still | WallMotion::Servo { .. } => wall.motion.clone(),
            WallMotion::Scheduled { .. } | WallMotion::Oscillating { .. } if held => {
                let wall = wall.name.clone();
                return Err(ContactsError::Held { wall });
            }
            _ if changes => {
                let wall = wall.name.clone();
                return Err(ContactsError::Schedule { wall });
            }
            WallMotion::Translating(velocity) => WallMotion::Translating(factor * velocity),
            WallMotion::Rotating {
                point,
                angular_velocity,
            } => WallMotion::Rotating {
                point: *point,
                angular_velocity: factor * angular_velocity,
            },
            WallMotion::Scheduled {
                direction,
                distance,
            } => WallMotion::Scheduled {
                direction: *direction,
                distance: distance
                    .iter()
                    .map(|(time, one)| (time / factor, *one))
                    .collect(),
            },
            WallMotion::Oscillating { amplitude, period } => WallMotion::Oscillating {
                amplitude: *amplitude,
                period: period / factor,
            },
        };
        Ok(Wall {
            motion,
            ..wall.clone()
        })
    };
    case.walls.iter().map(quicker).collect()
}

/// Largest speed in m/s with which two particles, or one and a wall at rest, can approach at the start: at most the diagonal of the
/// box about all velocities and zero, and twice the fastest.
fn approach(velocities: &[Vec3]) -> f64 {
    let zero = (Vec3::zeros(), Vec3::zeros());
    let (low, high) = velocities
        .iter()
        .fold(zero, |(low, high), one| (low.inf(one), high.sup(one)));
    let fastest = velocities.iter().map(|one| one.norm()).fold(0.0, f64::max);
    (high - low).norm().min(2.0 * fastest)
}

/// Speed in m/s of the start, of walls, or of a fall through the mesh, whichever is largest.
fn fastest(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> f64 {
    let [low, high] = mesh.bounds();
    let gravity = case.gas.gravity.norm();
    let fall = match gravity > 0.0 {
        true => (2.0 * gravity * (high - low).dot(&case.gas.gravity.abs()) / gravity).sqrt(),
        false => 0.0,
    };
    let start = std::iter::once(approach(&setup.velocity));
    let moving = case.walls.iter().map(|wall| wall.motion.largest_speed());
    start.chain(moving).fold(fall, f64::max)
}

/// What limits the time step, over all contacts that particles which are free can have.
pub fn limits(case: &Case, motion: &FreeMotion, mesh: &Mesh, setup: &ParticleSetup) -> Limits {
    let mut limits = Limits {
        rayleigh: f64::INFINITY,
        hertz: f64::INFINITY,
        speed: match motion.law.force {
            ContactForce::Linear {
                characteristic_speed,
            } => characteristic_speed,
            _ => fastest(case, mesh, setup),
        },
    };
    for one in moving_spheres(case, setup) {
        for Touching {
            young,
            mass,
            radius,
        } in touching(case, setup, &one)
        {
            if let ContactForce::LinearSprings { stiffness, .. } = motion.law.force {
                let time = time_step::linear_collision(mass, stiffness);
                limits.hertz = limits.hertz.min(time);
                continue;
            }
            let poisson = one.elastic.poisson;
            let rayleigh = time_step::rayleigh(one.radius[0], one.density, young, poisson);
            let stiff = young / (2.0 * (1.0 - poisson * poisson));
            let hertz = time_step::hertz_collision(radius, mass, stiff, limits.speed);
            limits.rayleigh = limits.rayleigh.min(rayleigh);
            limits.hertz = limits.hertz.min(hertz);
        }
    }
    limits
}

/// How well steps of a share of the shortest impact resolve the lowest restitution of linear dashpots, whose force jumps at first touch:
/// about ζ π over the steps of an impact, by where in a step that begins, ζ = −ln e/√(π² + ln² e).
fn restitution(case: &Case, motion: &FreeMotion, share: f64) -> Option<String> {
    let linear = matches!(
        motion.law.force,
        ContactForce::Linear { .. } | ContactForce::LinearSprings { .. }
    );
    let stated = case.contacts.iter().filter_map(|one| one.restitution);
    let lowest = stated.filter(|e| *e > 0.0 && *e < 1.0).reduce(f64::min)?;
    let damping = -lowest.ln() / PI.hypot(lowest.ln());
    linear.then(|| {
        format!(
            "    {:.0} steps in the shortest impact: restitution of {lowest} to about {} %\n",
            1.0 / share,
            short3(100.0 * PI * damping * share)
        )
    })
}

/// What `calcine check` says of moving particles: step and times.
pub fn report(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Option<String> {
    let (Told::Free(contacts), Some(motion)) = (&setup.motion, &case.motion) else {
        return None;
    };
    let limits = limits(case, motion, mesh, setup);
    let step = contacts.step;
    let window = case.time.motion_window.seconds();
    let kind = match motion.kind {
        MotionKind::RealTime => "real-time",
        MotionKind::Accelerated => "accelerated",
    };
    let mut text = format!(
        "  moving particles ({kind}):\n    step {step:.3e} s of motion time, {:.0} in a window; {}shortest impact {:.3e} s \
         (at {:.3} m/s)\n",
        window / step,
        match limits.rayleigh.is_finite() {
            true => format!("Rayleigh's time {:.3e} s, ", limits.rayleigh),
            false => String::new(),
        },
        limits.hertz,
        limits.speed
    );
    text.extend(restitution(case, motion, step / limits.hertz));
    if !motion.held.is_none() {
        let end = case.time.end;
        let moving = motion.held.moving(&case.time.acceleration, end);
        let moves: f64 = moving
            .iter()
            .map(|one| one.0[1].since(one.0[0]).seconds())
            .sum();
        text.push_str(&format!(
            "    held {} times, {} s of process time altogether; it moves for {} s\n",
            motion.held.spans().len(),
            shown(end.seconds() - moves),
            shown(moves)
        ));
    }
    let speed = fastest(case, mesh, setup);
    if let Some(impacts) = impact::hardest(case, motion, setup, speed) {
        text.push_str(&impacts.lines());
    }
    Some(text)
}

/// What of the contacts of a case is to be warned of.
pub(super) fn warnings(case: &Case, mesh: &Mesh, setup: &ParticleSetup) -> Vec<String> {
    let (Told::Free(contacts), Some(motion)) = (&setup.motion, &case.motion) else {
        return Vec::new();
    };
    let step = limits(case, motion, mesh, setup).warning(contacts.step);
    let impacts = impact::hardest(case, motion, setup, fastest(case, mesh, setup));
    let impact = impacts.and_then(|impacts| impacts.warning());
    let servos = servo_cautions::all(case, mesh, setup);
    let falls = fall::out_of_the_mesh(case, mesh, setup, contacts);
    let all = impact.into_iter().chain(step).chain(servos);
    all.chain(falls).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn particles_that_fly_towards_each_other_approach_faster_than_each_flies() {
        let x = Vec3::x();
        assert_eq!(approach(&[x, -x]), 2.0);
        assert_eq!(approach(&[x, -0.5 * x]), 1.5);
        assert_eq!(approach(&[2.0 * x, x]), 2.0, "against a wall at rest");
        assert_eq!(approach(&[]), 0.0);
    }

    /// Glass of 2500 kg/m³, 5 GPa, 0.25 and a radius of 1 mm, at 1 m/s, evaluated apart.
    #[test]
    fn the_times_of_a_contact_are_those_of_rayleigh_and_hertz() {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/moving.toml");
        let case = crate::case::read(&path, &[]).unwrap();
        let mesh = crate::case::mesh(&case.mesh).unwrap();
        let setup = crate::case::particles(&case, &Default::default())
            .unwrap()
            .setup;
        let mut motion = case.motion.clone().unwrap();
        motion.law.force = ContactForce::Linear {
            characteristic_speed: 1.0,
        };
        let limits = limits(&case, &motion, &mesh, &setup);
        // π 1e-3 √(2500/2e9)/(0.1631·0.25 + 0.8766) and 2.868266 (m*²/(R* E*² v))^0.2 with
        // m* = 5.235988e-6 kg, R* = 0.5 mm, E* = 2.666667 GPa.
        assert!(
            (limits.rayleigh / 3.828_7e-6 - 1.0).abs() < 1e-4,
            "{}",
            limits.rayleigh
        );
        assert!(
            (limits.hertz / 1.718_06e-5 - 1.0).abs() < 1e-5,
            "{}",
            limits.hertz
        );
    }

    #[test]
    fn what_only_a_feed_brings_limits_the_step_by_its_smallest_size() {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/moving.toml");
        let sizes = r#"{ uniform = { min = "1 mm", max = "2 mm" }, share = "number", seed = 1 }"#;
        let case = crate::case::read(&path, &[format!("particles[0].diameter={sizes}")]).unwrap();
        let mesh = crate::case::mesh(&case.mesh).unwrap();
        let limits = |setup: &ParticleSetup| {
            let motion = case.motion.clone().unwrap();
            super::limits(&case, &motion, &mesh, setup)
        };
        let placed = |radius| ParticleSetup {
            population: vec![0],
            radius: vec![radius],
            ..ParticleSetup::default()
        };
        let fed = limits(&ParticleSetup::default());
        assert_eq!(fed.rayleigh, limits(&placed(0.5e-3)).rayleigh);
        assert!(fed.rayleigh < 0.6 * limits(&placed(1e-3)).rayleigh);
    }

    /// A sphere of 50 MPa that is alone among walls of 5 MPa: their E* is that of spheres of 2/(1/5 + 1/50) = 9.0909 MPa with each other.
    /// Rebound speed of a sphere of 1 kg from a spring of 1 N/m by the method of Verlet, as contacts are computed; `begins` is where in a
    /// step it touches.
    fn rebound(restitution: f64, steps: f64, begins: f64) -> f64 {
        let damping = -restitution.ln() / PI.hypot(restitution.ln());
        let step = PI / (1.0 - damping * damping).sqrt() / steps;
        let force = |x: f64, v: f64| if x > 0.0 { -x - 2.0 * damping * v } else { 0.0 };
        let (mut x, mut v) = (-begins * step, 1.0);
        let mut acting = 0.0;
        while v > 0.0 || x > 0.0 {
            v += 0.5 * step * acting;
            x += step * v;
            acting = force(x, v);
            v += 0.5 * step * acting;
        }
        -v
    }

    #[test]
    fn restitutions_scatter_by_about_as_much_as_check_tells() {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let case = folder.join("tests/inputs/good/moving.toml");
        for (restitution, steps) in [(0.5, 20.0), (0.7, 20.0), (0.7, 50.0), (0.9, 20.0)] {
            let set = [format!("contacts[0].restitution={restitution}")];
            let case = crate::case::read(&case, &set).unwrap();
            let motion = case.motion.as_ref().unwrap();
            let told = super::restitution(&case, motion, 1.0 / steps).unwrap();
            let words = format!(
                "{steps} steps in the shortest impact: restitution of {restitution} to about "
            );
            let told = told.trim().strip_prefix(&words).unwrap();
            let told: f64 = told.trim_end_matches(" %").parse().unwrap();
            let found: Vec<f64> = (0..100)
                .map(|place| rebound(restitution, steps, f64::from(place) / 100.0))
                .collect();
            let most = found.iter().copied().fold(f64::MIN, f64::max);
            let least = found.iter().copied().fold(f64::MAX, f64::min);
            let scatter = 50.0 * (most - least) / restitution;
            assert!((0.8..1.3).contains(&(scatter / told)), "{scatter} {told}");
        }
    }

    #[test]
    fn a_particle_that_is_alone_is_limited_by_what_it_can_touch() {
        let path =
            std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/settling-sphere.toml");
        let limits = |material: &str| {
            let entry = |other: &str| {
                format!(
                    "{{ between = [\"{material}\", \"{other}\"], restitution = 0.8, friction = 0.3 }}"
                )
            };
            let set = [
                "materials.hard={ density = \"2500 kg/m^3\", heat_capacity = \"840 J/kg/K\", young = \"50 MPa\", poisson = 0.22 }".to_owned(),
                format!("contacts=[{}]", [entry("glass"), entry("hard")].join(", ")),
                format!("particles[0].material={material}"),
            ];
            let case = crate::case::read(&path, &set).unwrap();
            let mesh = crate::case::mesh(&case.mesh).unwrap();
            let setup = crate::case::particles(&case, mesh.periodicity())
                .unwrap()
                .setup;
            super::limits(&case, &case.motion.clone().unwrap(), &mesh, &setup)
        };
        let (soft, hard) = (limits("glass"), limits("hard"));
        // T_R goes with E^(-1/2), the impact with E*^(-2/5).
        let stiffer = 2.0 / (1.0 / 5.0 + 1.0 / 50.0) / 5.0f64;
        let rayleigh = hard.rayleigh / soft.rayleigh * stiffer.sqrt();
        let hertz = hard.hertz / soft.hertz * stiffer.powf(0.4);
        assert!((rayleigh - 1.0).abs() < 1e-12, "{hard:?} {soft:?}");
        assert!((hertz - 1.0).abs() < 1e-12, "{hard:?} {soft:?}");
    }
}
