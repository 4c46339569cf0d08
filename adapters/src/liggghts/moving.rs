//! Materials, contacts, walls and forces of a moving bed as LIGGGHTS' commands.
//!
//! Atom types are the populations in their order, then the materials in theirs: walls are of the latter.

use std::fmt::Write;

use calcine_coupler::motion::{
    Cohesion, ContactForce, Contacts, LostParticles, Pair, Rolling, Wall, WallMotion, WallShape,
};
use calcine_coupler::periodicity::{PeriodicSpan, Periodicity};
use calcine_coupler::physics::Vec3;

use super::facets;

/// LIGGGHTS refuses softer ones unless told that they are meant, and harder ones than the second.
const USUAL_YOUNG: [f64; 2] = [5e6, 1e9];
/// Restitution below which LIGGGHTS refuses a pair.
const LEAST_RESTITUTION: f64 = 0.05;
/// Characteristic speed in m/s below which LIGGGHTS refuses the linear law.
const LEAST_SPEED: f64 = 1e-2;

/// Number of atom types.
pub fn types(contacts: &Contacts) -> usize {
    contacts.material_of.len() + contacts.materials.len()
}

/// What LIGGGHTS cannot do of a case, with the remedy.
pub fn refusal(contacts: &Contacts) -> Option<String> {
    match contacts.law.force {
        ContactForce::SpringSliderDashpot | ContactForce::OpenfoamSpringSliderDashpot => {
            return Some(
                "it has no contact law \"spring-slider-dashpot\", neither with friction that limits spring and dashpot together \
                 nor with a spring that slip forgets; write motion.contact = { law = \"hertz-mindlin\" }"
                    .into(),
            );
        }
        ContactForce::Linear {
            characteristic_speed,
        } if characteristic_speed < LEAST_SPEED => {
            return Some(format!(
                "its linear law takes no characteristic speed below {LEAST_SPEED} m/s; \
                 `motion.contact.characteristic_speed` is {characteristic_speed} m/s"
            ));
        }
        ContactForce::LinearSprings { .. } => {
            return Some(
                "it has no linear law of a stated stiffness whose damping follows the restitution (\"linear-springs\"); write \
                 motion.contact = { law = \"linear\", characteristic_speed = … }, whose stiffness follows a speed of impact"
                    .into(),
            );
        }
        ContactForce::Linear { .. } | ContactForce::HertzMindlin => {}
    }
    if contacts.law.cohesion == Cohesion::Jkr {
        return Some(
            "it has no cohesion law \"jkr\", whose contacts hold to a pull-off force and tear off at a distance; use native particles, or write \
             motion.cohesion = { law = \"sjkr\" } with `cohesion_energy` of contacts"
                .into(),
        );
    }
    let unknown = contacts
        .walls
        .iter()
        .find_map(|wall| Some((wall, unknown_motion(&wall.motion)?)));
    if let Some((wall, (key, what))) = unknown {
        return Some(format!(
            "it has no walls that {what} (`{key}` of the wall \"{}\"); write `velocity` or `rotating`, or use native particles",
            wall.name
        ));
    }
    for material in &contacts.materials {
        if material.poisson < 0.0 {
            return Some(format!(
                "it takes no negative Poisson's ratio; a material has {}",
                material.poisson
            ));
        }
    }
    let pairs = contacts.pairs.iter();
    let low = pairs.map(|pair| pair.restitution).fold(1.0, f64::min);
    if low < LEAST_RESTITUTION {
        return Some(format!(
            "it takes no restitution below {LEAST_RESTITUTION}; a pair of `contacts` has {low}"
        ));
    }
    None
}

/// How walls are told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WallForm {
    /// Radius of the smallest sphere in m, by which round walls are cut into facets.
    pub smallest: f64,
    /// Whether forces of walls are kept by particle, to be counted; they are not with held particles, whose own
    /// forces LIGGGHTS does not keep.
    pub counted: bool,
}

/// The commands after the particles are read.
pub fn commands(contacts: &Contacts, form: WallForm) -> String {
    laws(contacts)
        + &groups(contacts)
        + &gravity(contacts)
        + &walls(contacts, form)
        + &push()
        + &motion(contacts)
}

/// Materials and the contact law.
pub fn laws(contacts: &Contacts) -> String {
    let mut text = String::new();
    properties(&mut text, contacts);
    let _ = writeln!(
        text,
        "pair_style gran {}{}\npair_coeff * *",
        model(contacts),
        settings(contacts)
    );
    text
}

/// Gravity on all that is free.
pub fn gravity(contacts: &Contacts) -> String {
    let gravity = contacts.gravity.norm();
    if gravity == 0.0 {
        return String::new();
    }
    let [x, y, z] = (contacts.gravity / gravity).into();
    format!("fix calcine_gravity calcine_free gravity {gravity:e} vector {x:e} {y:e} {z:e}\n")
}

/// The force of the gas, which the host writes into the fix `calcine_push` and adds at each step.
pub fn push() -> String {
    "fix calcine_push all property/atom calcine_push vector yes no no 0. 0. 0.\n".into()
}

/// What is held stays, what is free moves.
pub fn motion(contacts: &Contacts) -> String {
    let held = if contacts.held.contains(&true) {
        "fix calcine_hold calcine_held freeze\n"
    } else {
        ""
    };
    format!("{held}fix calcine_move calcine_free nve/sphere\n")
}

/// The material of each atom type.
fn material_of_type(contacts: &Contacts) -> Vec<usize> {
    let walls = 0..contacts.materials.len();
    contacts.material_of.iter().copied().chain(walls).collect()
}

/// LIGGGHTS sets up no particles whose lowest type is not 1, as after the last of the first population has left. A
/// distribution, by which nothing is inserted, counts as a particle of its type. Seeds are primes above 10 000, as
/// LIGGGHTS asks for.
const FIRST_TYPE: &str = "\
fix calcine_first all particletemplate/sphere 10007 atom_type 1 volume_limit 1e-20 density constant 1000 radius constant 1e-6
fix calcine_first_type all particledistribution/discrete 10009 1 calcine_first 1
";

fn properties(text: &mut String, contacts: &Contacts) {
    text.push_str(FIRST_TYPE);
    let types = material_of_type(contacts);
    let young = contacts.materials.iter().map(|material| material.young);
    if young.clone().fold(f64::INFINITY, f64::min) < USUAL_YOUNG[0] {
        text.push_str("soft_particles yes\n");
    }
    if young.fold(0.0, f64::max) > USUAL_YOUNG[1] {
        text.push_str("hard_particles yes\n");
    }
    let mut scalar = |name: &str, value: &dyn Fn(usize) -> f64| {
        let values: Vec<String> = types.iter().map(|&of| format!("{:e}", value(of))).collect();
        let values = values.join(" ");
        let _ = writeln!(
            text,
            "fix {name} all property/global {name} peratomtype {values}"
        );
    };
    scalar("youngsModulus", &|of| contacts.materials[of].young);
    scalar("poissonsRatio", &|of| contacts.materials[of].poisson);
    let mut pairs = |name: &str, value: &dyn Fn(&Pair) -> f64| {
        let rows = types.iter().flat_map(|&a| {
            let pair = move |&b: &usize| contacts.pair(a, b);
            types.iter().map(pair)
        });
        let values: Vec<String> = rows.map(|pair| format!("{:e}", value(pair))).collect();
        let _ = writeln!(
            text,
            "fix {name} all property/global {name} peratomtypepair {} {}",
            types.len(),
            values.join(" ")
        );
    };
    pairs("coefficientRestitution", &|pair| pair.restitution);
    pairs("coefficientFriction", &|pair| pair.friction);
    if contacts.law.rolling != Rolling::None {
        pairs("coefficientRollingFriction", &|pair| pair.rolling_friction);
    }
    if contacts.law.rolling == Rolling::ElasticPlastic {
        pairs("coefficientRollingViscousDamping", &|pair| {
            pair.rolling_damping
        });
    }
    if contacts.law.cohesion == Cohesion::Sjkr {
        pairs("cohesionEnergyDensity", &|pair| pair.cohesion_energy);
    }
    if let ContactForce::Linear {
        characteristic_speed,
    } = contacts.law.force
    {
        let _ = writeln!(
            text,
            "fix characteristicVelocity all property/global characteristicVelocity scalar \
             {characteristic_speed:e}"
        );
    }
}

/// The contact model in LIGGGHTS' order of words. Its `limitForce` cuts the normal force at zero; without
/// it damping may attract (checked by the restitution that comes out).
fn model(contacts: &Contacts) -> String {
    let law = &contacts.law;
    let mut model = match law.force {
        ContactForce::Linear { .. } | ContactForce::LinearSprings { .. } => {
            "model hooke".to_owned()
        }
        ContactForce::HertzMindlin
        | ContactForce::SpringSliderDashpot
        | ContactForce::OpenfoamSpringSliderDashpot => "model hertz".to_owned(),
    };
    model.push_str(" tangential history");
    if law.cohesion == Cohesion::Sjkr {
        model.push_str(" cohesion sjkr");
    }
    match law.rolling {
        Rolling::None => {}
        Rolling::ConstantTorque => model.push_str(" rolling_friction cdt"),
        Rolling::ElasticPlastic => model.push_str(" rolling_friction epsd"),
    }
    model
}

/// Settings of the model, which stand behind everything else.
fn settings(contacts: &Contacts) -> &'static str {
    match contacts.law.attractive_damping {
        true => "",
        false => " limitForce on",
    }
}

/// Groups of what is free and of what is held, by atom types.
pub fn groups(contacts: &Contacts) -> String {
    let mut text = String::new();
    for (group, held) in [("calcine_free", false), ("calcine_held", true)] {
        let of = contacts.held.iter().enumerate();
        let types: Vec<String> = of
            .filter(|(_, is)| **is == held)
            .map(|(index, _)| (index + 1).to_string())
            .collect();
        if !types.is_empty() {
            let _ = writeln!(text, "group {group} type {}", types.join(" "));
        }
    }
    text
}

/// Name of a wall's file of triangles.
fn file(index: usize) -> String {
    format!("wall-{index}.stl")
}

/// Names and contents of the files of walls that are triangles, for spheres of this radius in m at least.
pub fn meshes(contacts: &Contacts, smallest: f64) -> Vec<(String, String)> {
    let walls = contacts.walls.iter().enumerate();
    let meshes = walls.filter(|(_, wall)| !facets::is_primitive(wall));
    let text = |wall: &Wall| stl(&wall.name, &facets::of(wall, contacts, smallest));
    meshes
        .map(|(index, wall)| (file(index), text(wall)))
        .collect()
}

fn stl(name: &str, triangles: &[[Vec3; 3]]) -> String {
    let mut text = format!("solid {name}\n");
    for [a, b, c] in triangles {
        let normal = (b - a).cross(&(c - a));
        let normal = normal.try_normalize(0.0).unwrap_or(Vec3::z());
        let _ = writeln!(
            text,
            "facet normal {:e} {:e} {:e}\nouter loop",
            normal.x, normal.y, normal.z
        );
        for corner in [a, b, c] {
            let _ = writeln!(text, "vertex {:e} {:e} {:e}", corner.x, corner.y, corner.z);
        }
        text.push_str("endloop\nendfacet\n");
    }
    let _ = writeln!(text, "endsolid {name}");
    text
}

/// LIGGGHTS' name of a wall that it has itself, with its parameters: those of a cylinder are the radius and the
/// place of its axis, in the cyclic order of the coordinates.
fn primitive(shape: &WallShape) -> Option<String> {
    const NAMES: [&str; 3] = ["x", "y", "z"];
    match shape {
        WallShape::Plane { point, normal } => {
            let axis = normal.iamax();
            Some(format!("{}plane {:e}", NAMES[axis], point[axis]))
        }
        WallShape::Cylinder {
            point,
            axis,
            radius,
        } => {
            let along = axis.iamax();
            let [first, second] = [1, 2].map(|next| point[(along + next) % 3]);
            Some(format!(
                "{}cylinder {radius:e} {first:e} {second:e}",
                NAMES[along]
            ))
        }
        WallShape::Cone { .. } | WallShape::Mesh { .. } => None,
    }
}

/// Walls, with the contact law of the particles.
pub fn walls(contacts: &Contacts, form: WallForm) -> String {
    let (mut text, model) = (String::new(), model(contacts));
    let end = match form.counted && !contacts.held.contains(&true) {
        true => format!(" store_force yes{}", settings(contacts)),
        false => settings(contacts).to_owned(),
    };
    let mut meshes = Vec::new();
    for (index, wall) in contacts.walls.iter().enumerate() {
        let kind = contacts.material_of.len() + wall.material + 1;
        let own = facets::is_primitive(wall).then(|| primitive(&wall.shape));
        if let Some(primitive) = own.flatten() {
            let _ = writeln!(
                text,
                "fix calcine_wall_{index} all wall/gran {model} primitive type {kind} {primitive}{end}"
            );
            continue;
        }
        let stays = facets::within_itself(wall);
        let _ = writeln!(
            text,
            "fix calcine_mesh_{index} all mesh/surface file {} type {kind}{}{}",
            file(index),
            if stays {
                surface(&wall.motion)
            } else {
                String::new()
            },
            curvature(wall, form.smallest)
        );
        if !stays {
            moving_mesh(&mut text, index, &wall.motion);
        }
        meshes.push(format!("calcine_mesh_{index}"));
    }
    if !meshes.is_empty() {
        let _ = writeln!(
            text,
            "fix calcine_meshes all wall/gran {model} mesh n_meshes {} meshes {}{}",
            meshes.len(),
            meshes.join(" "),
            end
        );
    }
    text
}

/// Facets of a round wall are one surface: a sphere touches them once, and its springs go along. (Without being
/// told, LIGGGHTS takes an angle above 0.26 degrees for an edge.)
fn curvature(wall: &Wall, smallest: f64) -> String {
    facets::bend(wall, smallest).map_or_else(String::new, |bend| {
        format!(" curvature {:e} curvature_tolerant yes", 1.25 * bend)
    })
}

/// The speed of a surface that moves within itself: its triangles stay.
fn surface(motion: &WallMotion) -> String {
    match motion {
        WallMotion::Still
        | WallMotion::Scheduled { .. }
        | WallMotion::Oscillating { .. }
        | WallMotion::Servo { .. } => String::new(),
        WallMotion::Translating(v) => format!(" surface_vel {:e} {:e} {:e}", v.x, v.y, v.z),
        WallMotion::Rotating {
            point,
            angular_velocity,
        } => {
            let speed = angular_velocity.norm();
            if speed == 0.0 {
                return String::new();
            }
            let axis = angular_velocity / speed;
            format!(
                " surface_ang_vel origin {:e} {:e} {:e} axis {:e} {:e} {:e} omega {speed:e}",
                point.x, point.y, point.z, axis.x, axis.y, axis.z
            )
        }
    }
}

fn moving_mesh(text: &mut String, index: usize, motion: &WallMotion) {
    let head = format!("fix calcine_turn_{index} all move/mesh mesh calcine_mesh_{index}");
    match motion {
        WallMotion::Still
        | WallMotion::Scheduled { .. }
        | WallMotion::Oscillating { .. }
        | WallMotion::Servo { .. } => {}
        WallMotion::Translating(v) => {
            let _ = writeln!(text, "{head} linear {:e} {:e} {:e}", v.x, v.y, v.z);
        }
        WallMotion::Rotating {
            point,
            angular_velocity,
        } => {
            let speed = angular_velocity.norm();
            if speed == 0.0 {
                return;
            }
            let axis = angular_velocity / speed;
            let _ = writeln!(
                text,
                "{head} rotate origin {:e} {:e} {:e} axis {:e} {:e} {:e} period {:e}",
                point.x,
                point.y,
                point.z,
                axis.x,
                axis.y,
                axis.z,
                2.0 * std::f64::consts::PI / speed
            );
        }
    }
}

/// LIGGGHTS' words for the sides of its box, which follow the particles where those that leave are taken out later.
pub fn boundary(periodicity: &Periodicity, lost: LostParticles) -> String {
    let side = match lost {
        LostParticles::End => "f",
        LostParticles::TakeOut | LostParticles::Through => "m",
    };
    let word = |span: &Option<PeriodicSpan>| if span.is_some() { "p" } else { side };
    periodicity.axes.each_ref().map(word).join(" ")
}

/// The key of a motion that its walls do not have, and what such a wall does.
fn unknown_motion(motion: &WallMotion) -> Option<(&'static str, &'static str)> {
    match motion {
        WallMotion::Scheduled { .. } => Some(("moved", "move by a schedule")),
        WallMotion::Oscillating { .. } => Some(("oscillating", "oscillate")),
        WallMotion::Servo { .. } => Some(("servo", "hold a force")),
        WallMotion::Still | WallMotion::Translating(_) | WallMotion::Rotating { .. } => None,
    }
}
