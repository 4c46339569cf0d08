//! Setups that the native particles cannot take.

use calcine_coupler::motion::{
    Cohesion, ContactForce, Contacts, Motion, ParticleChanges, Resized, Wall, WallShape,
};
use calcine_coupler::parcels::ParcelMotion;
use calcine_coupler::periodic_motion;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::ParticleSetup;

use crate::gas::NativeError;

/// Checks a setup.
pub fn check(setup: &ParticleSetup) -> Result<(), NativeError> {
    let count = setup.id.len();
    for (field, found) in [
        ("the list of populations", setup.population.len()),
        ("the list of positions", setup.position.len()),
        ("the list of radii", setup.radius.len()),
        ("the list of densities", setup.density.len()),
    ] {
        if found != count {
            return Err(length(field, found, count));
        }
    }
    if !setup.velocity.is_empty() && setup.velocity.len() != count {
        return Err(length(
            "the list of velocities",
            setup.velocity.len(),
            count,
        ));
    }
    if !setup.angular_velocity.is_empty() && setup.angular_velocity.len() != count {
        return Err(length(
            "the list of angular velocities",
            setup.angular_velocity.len(),
            count,
        ));
    }
    if !setup.weight.is_empty() && setup.weight.len() != count {
        return Err(length("the list of weights", setup.weight.len(), count));
    }
    for i in 0..count {
        let place = || format!("particle {}", setup.id[i]);
        positive("the weight", setup.weight_of(i), "", place)?;
        positive("the radius", setup.radius[i], "m", place)?;
        positive("the density", setup.density[i], "kg/m^3", place)?;
    }
    match &setup.motion {
        Motion::Frozen => Ok(()),
        Motion::Parcels(motion) => parcels(motion, &setup.population),
        Motion::Free(contacts) => {
            contact(contacts, &setup.population)?;
            let largest = setup.radius.iter().copied().fold(0.0, f64::max);
            periodic_motion::check(contacts, largest)?;
            (0..count).try_for_each(|i| {
                let held = contacts.held.get(setup.population[i] as usize);
                let place = || format!("particle {}", setup.id[i]);
                match held {
                    Some(true) => Ok(()),
                    _ => alone(setup.weight_of(i), place),
                }
            })
        }
    }
}

/// The error of particles that are no parcels.
pub fn not_parcels() -> NativeError {
    NativeError::OtherMotion {
        takes: "parcels",
        given: "frozen or free particles",
    }
}

fn parcels(motion: &ParcelMotion, population: &[u32]) -> Result<(), NativeError> {
    let of = || "the motion of parcels".to_owned();
    let share = |value: f64| (0.0..=1.0).contains(&value);
    let rule = "above 0 and at most 1";
    within(
        "the Courant number",
        motion.courant,
        "",
        of,
        rule,
        |value| value > 0.0 && value <= 1.0,
    )?;
    let needed = population.iter().max().map_or(0, |&most| most as usize + 1);
    for wall in &motion.walls {
        if wall.impact.len() < needed {
            return Err(length("the list of impacts", wall.impact.len(), needed));
        }
        for impact in &wall.impact {
            let place = || format!("wall `{}`", wall.patch);
            let (e, rule) = (impact.restitution, "0 to 1");
            within("the restitution", e, "", place, rule, share)?;
            let rule = "0 or above";
            within("the friction", impact.friction, "", place, rule, |value| {
                value >= 0.0
            })?;
        }
    }
    Ok(())
}

/// AllowedWeights that particles that come may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AllowedWeights {
    /// Each stands for itself alone.
    One,
    /// Any positive number.
    Any,
}

/// A particle that moves touches others one by one, so that it stands for itself alone.
fn alone(weight: f64, place: impl Fn() -> String) -> Result<(), NativeError> {
    let rule = "1 for a particle that moves and touches others";
    within("the weight", weight, "", place, rule, |value| value == 1.0)
}

/// A list of a wrong length.
pub fn length(field: &'static str, found: usize, expected: usize) -> NativeError {
    NativeError::Length {
        field,
        found,
        expected,
        of: "particles",
    }
}

fn contact(contacts: &Contacts, population: &[u32]) -> Result<(), NativeError> {
    let motion = || "the motion of particles".to_owned();
    positive("the time step", contacts.step, "s", motion)?;
    let (low, high) = contacts.bounds;
    for axis in 0..3 {
        positive(
            "the extent of the bounds",
            high[axis] - low[axis],
            "m",
            motion,
        )?;
    }
    if let ContactForce::Linear {
        characteristic_speed: speed,
    } = contacts.law.force
    {
        positive("the characteristic speed", speed, "m/s", motion)?;
    }
    if let ContactForce::LinearSprings {
        stiffness,
        tangential_ratio,
    } = contacts.law.force
    {
        positive("the stiffness", stiffness, "N/m", motion)?;
        positive("the ratio of stiffnesses", tangential_ratio, "", motion)?;
    }
    let adhesive = contacts.law.cohesion == Cohesion::Jkr && !contacts.law.force.is_hertz();
    let materials = contacts.materials.len();
    for (k, material) in contacts.materials.iter().enumerate() {
        let place = || format!("material {k}");
        positive("Young's modulus", material.young, "Pa", place)?;
        let rule = |value: f64| value > -1.0 && value < 0.5;
        within(
            "Poisson's ratio",
            material.poisson,
            "",
            place,
            "between -1 and 0.5",
            rule,
        )?;
    }
    if contacts.pairs.len() != materials * materials {
        return Err(NativeError::Length {
            field: "the table of pairs of materials",
            found: contacts.pairs.len(),
            expected: materials * materials,
            of: "pairs",
        });
    }
    for (k, pair) in contacts.pairs.iter().enumerate() {
        let place = || format!("materials {} and {}", k / materials, k % materials);
        let rule = |value: f64| value > 0.0 && value <= 1.0;
        within(
            "the restitution",
            pair.restitution,
            "",
            place,
            "above 0 and at most 1",
            rule,
        )?;
        for (field, value, unit) in [
            ("the friction", pair.friction, ""),
            ("the rolling friction", pair.rolling_friction, ""),
            ("the rolling damping", pair.rolling_damping, ""),
            ("the cohesion energy density", pair.cohesion_energy, "J/m^3"),
            ("the work of adhesion", pair.work_of_adhesion, "J/m^2"),
        ] {
            within(field, value, unit, place, "0 or more", |value| value >= 0.0)?;
        }
        if adhesive {
            let work = pair.work_of_adhesion;
            let rule = "0 with a linear contact law";
            let field = "the work of adhesion";
            within(field, work, "J/m^2", place, rule, |value| value == 0.0)?;
        }
        if *pair != contacts.pairs[k % materials * materials + k / materials] {
            return Err(NativeError::Value {
                field: "the restitution",
                place: place(),
                value: pair.restitution,
                unit: "",
                rule: "given, like all of the pair, for both orders alike",
            });
        }
    }
    let populations = population
        .iter()
        .map(|&p| p as usize + 1)
        .max()
        .unwrap_or(0);
    for (field, found) in [
        (
            "the list of populations' materials",
            contacts.material_of.len(),
        ),
        ("the list of held populations", contacts.held.len()),
    ] {
        if found < populations {
            return Err(NativeError::Length {
                field,
                found,
                expected: populations,
                of: "populations",
            });
        }
    }
    let mut used = contacts.material_of.iter().copied();
    if let Some(index) = used.find(|&index| index >= materials) {
        return Err(no_material("a population".into(), index));
    }
    contacts
        .walls
        .iter()
        .try_for_each(|one| wall(one, materials))
}

fn wall(wall: &Wall, materials: usize) -> Result<(), NativeError> {
    let place = || format!("wall `{}`", wall.name);
    if wall.material >= materials {
        return Err(no_material(place(), wall.material));
    }
    let unit = |field, vector: &Vec3| {
        let rule = |length: f64| (length - 1.0).abs() < 1e-6;
        within(field, vector.norm(), "", place, "1", rule)
    };
    match &wall.shape {
        WallShape::Plane { normal, .. } => unit("the length of the normal", normal),
        WallShape::Cylinder { axis, radius, .. } => {
            positive("the radius", *radius, "m", place)?;
            unit("the length of the axis' direction", axis)
        }
        WallShape::Cone { ends, radii } => {
            positive("the length", (ends[1] - ends[0]).norm(), "m", place)?;
            for radius in radii {
                within("the radius", *radius, "m", place, "0 or more", |value| {
                    value >= 0.0
                })?;
            }
            positive("the larger radius", radii[0].max(radii[1]), "m", place)
        }
        WallShape::Mesh { triangles } => {
            triangles.iter().enumerate().try_for_each(|(k, [a, b, c])| {
                let place = || format!("triangle {k} of wall `{}`", wall.name);
                positive(
                    "the area",
                    0.5 * (b - a).cross(&(c - a)).norm(),
                    "m^2",
                    place,
                )
            })
        }
    }
}

fn no_material(place: String, index: usize) -> NativeError {
    NativeError::Value {
        field: "the index of the material",
        place,
        value: index as f64,
        unit: "",
        rule: "that of a material in the list",
    }
}

fn positive(
    field: &'static str,
    value: f64,
    unit: &'static str,
    place: impl Fn() -> String,
) -> Result<(), NativeError> {
    within(field, value, unit, place, "positive", |value| value > 0.0)
}

fn within(
    field: &'static str,
    value: f64,
    unit: &'static str,
    place: impl Fn() -> String,
    rule: &'static str,
    allowed: impl Fn(f64) -> bool,
) -> Result<(), NativeError> {
    if value.is_finite() && allowed(value) {
        return Ok(());
    }
    Err(NativeError::Value {
        field,
        place: place(),
        value,
        unit,
        rule,
    })
}

/// Checks a change of particles; returns the rows of those that go, ascending.
pub fn change(
    change: &ParticleChanges,
    id: &[u64],
    populations: usize,
    weights: AllowedWeights,
) -> Result<Vec<usize>, NativeError> {
    let mut rows = Vec::with_capacity(change.remove.len());
    for &gone in &change.remove {
        rows.push(
            id.binary_search(&gone)
                .map_err(|_| NativeError::NoParticle { id: gone })?,
        );
    }
    rows.sort_unstable();
    if let Some(twice) = rows.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(NativeError::NoParticle { id: id[twice[0]] });
    }
    let mut last = id.last().copied().unwrap_or(0);
    for new in &change.insert {
        let place = || format!("new particle {}", new.id);
        if new.id <= last {
            return Err(NativeError::Value {
                field: "the id",
                place: place(),
                value: new.id as f64,
                unit: "",
                rule: "above all ids before it",
            });
        }
        last = new.id;
        positive("the radius", new.radius, "m", place)?;
        positive("the density", new.density, "kg/m^3", place)?;
        match weights {
            AllowedWeights::One => alone(new.weight, place)?,
            AllowedWeights::Any => positive("the weight", new.weight, "", place)?,
        }
        let rule = |value: f64| value < populations as f64;
        let known = "that of a population with a material";
        within(
            "the population",
            f64::from(new.population),
            "",
            place,
            known,
            rule,
        )?;
    }
    Ok(rows)
}

/// Checks the particles that get another size; their rows with what they become.
pub fn resized<'a>(
    change: &'a ParticleChanges,
    id: &[u64],
) -> Result<Vec<(usize, &'a Resized)>, NativeError> {
    let row = |new: &'a Resized| {
        let place = || format!("particle {}", new.id);
        positive("the radius", new.radius, "m", place)?;
        positive("the mass", new.mass, "kg", place)?;
        let row = id.binary_search(&new.id);
        let row = row.map_err(|_| NativeError::NoParticle { id: new.id })?;
        Ok((row, new))
    };
    change.resize.iter().map(row).collect()
}
