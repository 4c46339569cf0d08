//! `[motion]`: how particles that are free move, and what their contacts need to be told.

use calcine_coupler::motion::{Cohesion, ContactForce, ContactLaw, Rolling, Wall};

use super::hold;
use crate::case::model::{
    ContactSpec, FreeMotion, MaterialSpec, MotionKind, MotionSpec, Population, TimeSpec,
};
use crate::case::table::TableReader;
use crate::case::units::Dimension;

const EXAMPLE: &str =
    "[motion] with kind = \"real-time\" and contact = { law = \"hertz-mindlin\" }";

/// The laws that `contact.law` chooses from.
#[derive(Clone, Copy)]
enum Law {
    Hertz,
    SpringSliderDashpot,
    Linear,
}

pub(super) fn motion(root: &TableReader<'_>, time: Option<&TimeSpec>) -> Option<FreeMotion> {
    let section = root.table("motion")?;
    let kinds = [
        ("real-time", MotionKind::RealTime),
        ("accelerated", MotionKind::Accelerated),
    ];
    let kind = section.required_choice("kind", &kinds);
    let step = section.positive("motion_step", Dimension::TIME);
    let force = force(&section);
    let attractive = section.truth("attractive_damping").unwrap_or(true);
    let rollings = [
        ("none", Rolling::None),
        ("constant-torque", Rolling::ConstantTorque),
        ("elastic-plastic", Rolling::ElasticPlastic),
    ];
    let rolling = law(&section, "rolling", &rollings);
    let cohesions = [("none", Cohesion::None), ("sjkr", Cohesion::Sjkr)];
    let cohesion = law(&section, "cohesion", &cohesions);
    let held = hold::holds(&section, time);
    section.finish();
    Some(FreeMotion {
        kind: kind?,
        step,
        law: ContactLaw {
            force: force?,
            attractive_damping: attractive,
            rolling: rolling?,
            cohesion: cohesion?,
        },
        held,
    })
}

fn law<T: Copy>(section: &TableReader<'_>, key: &str, choices: &[(&str, T)]) -> Option<T> {
    let table = section.required_table(key, &format!("{key} = {{ law = \"none\" }}"))?;
    let law = table.required_choice("law", choices);
    table.finish();
    law
}

fn force(section: &TableReader<'_>) -> Option<ContactForce> {
    let table = section.required_table("contact", "contact = { law = \"hertz-mindlin\" }")?;
    let laws = [
        ("hertz-mindlin", Law::Hertz),
        ("spring-slider-dashpot", Law::SpringSliderDashpot),
        ("linear", Law::Linear),
    ];
    let law = table.required_choice("law", &laws);
    let speed = table.positive("characteristic_speed", Dimension::VELOCITY);
    let linear = matches!(law, Some(Law::Linear));
    if linear && !table.has("characteristic_speed") {
        table.missing("characteristic_speed", "\"1 m/s\"");
    }
    if law.is_some() && !linear && table.has("characteristic_speed") {
        let help = "remove it: only the linear law derives its stiffness from a speed";
        table.fail(
            "characteristic_speed",
            "belongs to the law \"linear\"",
            help,
        );
    }
    table.finish();
    Some(match law? {
        Law::Hertz => ContactForce::HertzMindlin,
        Law::SpringSliderDashpot => ContactForce::SpringSliderDashpot,
        Law::Linear => ContactForce::Linear {
            characteristic_speed: speed?,
        },
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
    if !root.has("motion") {
        root.missing("motion", EXAMPLE);
    }
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
    let window = time.motion_window.seconds();
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
