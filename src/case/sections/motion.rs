//! `[motion]`: how particles that are free move, and what their contacts need to be told.

use calcine_coupler::motion::{Cohesion, ContactForce, ContactLaw, LostParticles, Rolling, Wall};

use super::{hold, parcels};
use crate::case::model::{
    ContactSpec, FreeMotion, MaterialSpec, MotionKind, MotionSpec, Population, TimeSpec,
};
use crate::case::table::TableReader;

pub(super) fn motion(root: &TableReader<'_>, time: Option<&TimeSpec>) -> Option<FreeMotion> {
    let section = root.table("motion")?;
    let known = section.laws();
    let kind = section.choice("kind");
    let step = section.number("motion_step");
    let long_step = section.truth("long_step");
    let attractive = section.truth("attractive_damping");
    let lost = section.choice::<LostParticles>("lost");
    let held = hold::holds(&section, time);
    if section.has("parcels") {
        let parcels = parcels::parcels(&section);
        section.finish();
        return Some(FreeMotion {
            kind: kind?,
            step: None,
            long_step: false,
            law: ContactLaw {
                force: ContactForce::HertzMindlin,
                attractive_damping: true,
                rolling: Rolling::None,
                cohesion: Cohesion::None,
            },
            parcels: Some(parcels?),
            held,
            lost: lost?,
        });
    }
    for key in ["contact", "rolling", "cohesion"] {
        section.need(key);
    }
    let force = section.plain_law("contact", &known.contact);
    let rolling = section.plain_law("rolling", &known.rolling);
    let cohesion = section.plain_law("cohesion", &known.cohesion);
    section.finish();
    let (force, cohesion) = (*force?.make(), *cohesion?.make());
    if cohesion == Cohesion::Jkr && !force.is_hertz() {
        let rule = "is \"jkr\", which adds adhesion to elastic spheres of Hertz, but `motion.contact` is linear";
        let help = "write motion.contact = { law = \"hertz-mindlin\" }";
        section.fail("cohesion", rule, help);
        return None;
    }
    Some(FreeMotion {
        kind: kind?,
        step,
        long_step: long_step?,
        law: ContactLaw {
            force,
            attractive_damping: attractive?,
            rolling: *rolling?.make(),
            cohesion,
        },
        parcels: None,
        held,
        lost: lost?,
    })
}

/// Checks that clocks and motion go together.
pub(super) fn fits(
    root: &TableReader<'_>,
    motion: Option<&FreeMotion>,
    time: &TimeSpec,
    particles: &[Population],
) {
    let frozen = particles.iter().all(|one| one.motion == MotionSpec::Frozen);
    hold::fits(root, motion, time, frozen);
    if frozen {
        return;
    }
    if let (true, Some(clock)) = (time.process_step.is_some(), root.table("time")) {
        let rule = "is for beds that do not move, but a population has motion = \"free\"";
        let help = "write `motion_window`, and `acceleration` where the motion is slow";
        clock.fail("process_step", rule, help);
    }
    root.need("motion");
    let (Some(motion), Some(section)) = (motion, root.table("motion")) else {
        return;
    };
    let moving = motion.held.moving(&time.acceleration, time.end);
    let factor = moving.iter().map(|one| one.1).fold(1.0, f64::max);
    if motion.kind == MotionKind::RealTime && factor > 1.0 && time.process_step.is_none() {
        let rule = format!(
            "is \"real-time\", but `time.acceleration` reaches {factor}: a bed that moves in process \
             time cannot be moved {factor} times faster than its gas"
        );
        let help = "leave `time.acceleration` at 1, or write kind = \"accelerated\" for a shaft or \
                    a moving bed whose motion is the same at any pace";
        section.fail("kind", rule, help);
    }
    let window = time.window_bounds.map_or(time.motion_window, |it| it.min);
    let window = window.seconds();
    if let Some(step) = motion.step.filter(|step| *step > window) {
        let rule = format!("is {step} s, longer than the window of {window} s");
        section.fail(
            "motion_step",
            rule,
            "lower it, or raise `time.motion_window`",
        );
    }
}

/// What meets what.
pub(super) struct Meeting<'a> {
    pub motion: &'a FreeMotion,
    pub materials: &'a [MaterialSpec],
    pub contacts: &'a [ContactSpec],
    pub particles: &'a [Population],
    pub walls: &'a [Wall],
}

/// Every material that touches a free particle needs elastic constants, and every such pair its
/// properties; all that is missing is told.
pub(super) fn need_properties(root: &TableReader<'_>, meeting: &Meeting<'_>) {
    let Meeting {
        motion,
        materials,
        contacts,
        particles,
        walls,
    } = meeting;
    let free = |population: &&Population| population.motion == MotionSpec::Free;
    let movers: Vec<usize> = particles
        .iter()
        .filter(free)
        .map(|one| one.material)
        .collect();
    let others = particles.iter().map(|one| one.material);
    let mut all: Vec<usize> = others
        .chain(walls.iter().map(|wall| wall.material))
        .collect();
    all.sort_unstable();
    all.dedup();
    if movers.is_empty() {
        return;
    }
    for &index in &all {
        let material = &materials[index];
        let Some(tables) = root.table("materials") else {
            continue;
        };
        for (key, there, example) in [
            ("young", material.young.is_some(), "\"50 MPa\""),
            ("poisson", material.poisson.is_some(), "0.22"),
        ] {
            if !there {
                let rule = format!("has no `{key}`, which contacts of free particles need");
                tables.fail(&material.name, &rule, format!("add {key} = {example}"));
            }
        }
    }
    let mut pairs: Vec<[usize; 2]> = Vec::new();
    for &a in &movers {
        for &b in &all {
            pairs.push([a.min(b), a.max(b)]);
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    let tables = root.tables("contacts");
    for pair in pairs {
        let [a, b] = pair.map(|index| materials[index].name.as_str());
        let found = contacts
            .iter()
            .position(|contact| same(contact.between, pair));
        let Some(at) = found else {
            let rule =
                format!("has no entry between \"{a}\" and \"{b}\", whose particles may touch");
            let help = format!(
                "add [[contacts]] with between = [\"{a}\", \"{b}\"], restitution and friction"
            );
            root.fail("contacts", rule, help);
            continue;
        };
        let contact = &contacts[at];
        let wanted = [
            ("restitution", contact.restitution, true),
            ("friction", contact.friction, true),
            (
                "rolling_friction",
                contact.rolling_friction,
                motion.law.rolling != Rolling::None,
            ),
            (
                "rolling_damping",
                contact.rolling_damping,
                motion.law.rolling == Rolling::ElasticPlastic,
            ),
            (
                "cohesion_energy",
                contact.cohesion_energy,
                motion.law.cohesion == Cohesion::Sjkr,
            ),
            (
                "work_of_adhesion",
                contact.work_of_adhesion,
                motion.law.cohesion == Cohesion::Jkr,
            ),
        ];
        for (key, value, needed) in wanted {
            if let (true, None, Some(table)) = (needed, value, tables.get(at)) {
                let rule =
                    format!("has no `{key}`, which the contact of \"{a}\" and \"{b}\" needs");
                table.fail_whole(&rule, &format!("add {key}, or choose a law without it"));
            }
        }
    }
}

fn same(between: [usize; 2], pair: [usize; 2]) -> bool {
    between == pair || between == [pair[1], pair[0]]
}
