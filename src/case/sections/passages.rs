//! Measures of what passes patches of the gas and outlets of particles.

use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::GasPatch;

use super::common::direction;
use super::known::{Known, check_patch};
use super::time::ticks;
use crate::case::model::{Discharged, ForcePart, Measure, Passing};
use crate::case::table::TableReader;

/// What the gas of a case must be to say what passes its patches: one that is solved, and by which program.
fn tells(reader: &TableReader<'_>, key: &str, known: &Known<'_>) {
    if known.held {
        let help = "write gas.held = false; a gas that is held has no patches";
        reader.fail(key, "asks a gas that is held what passes a patch", help);
    } else if known.solver.is_stock() {
        let name = known.solver.name();
        let rule = format!("asks {name}, which does not tell what passes a patch");
        let help = "leave `openfoam.solver` out: calcineGasFoam tells it, and the native gas";
        reader.fail(key, rule, help);
    }
}

/// The patch that is asked about, with its condition where that could be read.
fn patch<'a>(
    reader: &TableReader<'a>,
    known: &'a Known<'_>,
) -> Option<(&'a str, Option<&'a GasPatch>)> {
    reader.need("patch");
    let name = reader.text("patch")?;
    check_patch(reader, "patch", name, known.mesh);
    let mut patches = known.patches.iter();
    let condition = patches.find(|(own, _)| own == name);
    let condition = condition.map(|(_, condition)| condition);
    if let Some(GasPatch::Periodic { .. }) = condition {
        let help = "name a patch of the boundary; the gas of the domain goes on beyond this one";
        reader.fail("patch", format!("is \"{name}\", which is periodic"), help);
    }
    Some((name, condition))
}

/// Checks a mean by mass flow: of a temperature or a mass fraction on a patch through which gas flows.
pub(super) fn flow_mean(
    reader: &TableReader<'_>,
    (field, name): (Option<&'static str>, Option<&str>),
    known: &Known<'_>,
) {
    tells(reader, "statistic", known);
    if field.is_some_and(|field| !["temperature", "mass_fraction"].contains(&field)) {
        let help = "write \"mean\", or measure the temperature or a mass_fraction";
        reader.fail("statistic", "is of what gas carries with it", help);
    }
    let Some(name) = name else {
        let help = "name the patch, for example patch = \"top\", or write \"mean\"";
        reader.fail("statistic", "is of a patch through which gas flows", help);
        return;
    };
    let mut patches = known.patches.iter();
    let condition = patches.find(|(own, _)| own == name).map(|(_, one)| one);
    if condition.is_some_and(|one| !one.is_open() && !matches!(one, GasPatch::Inlet { .. })) {
        let help = "name an inlet, an outlet or an opening, or write \"mean\"";
        let rule = format!("is of a patch through which gas flows, which `{name}` is not");
        reader.fail("statistic", rule, help);
    }
}

/// Heat, mass or a species that flows through a patch into the gas.
pub(super) fn flow(reader: &TableReader<'_>, known: &Known<'_>) -> Option<(Measure, &'static str)> {
    tells(reader, "flow", known);
    let what: Option<Passing> = reader.choice("flow");
    let (patch, _) = patch(reader, known)?;
    let what = what?;
    let field = match what {
        Passing::Heat => "heat_flow",
        Passing::Mass => "mass_flow",
        Passing::Species => "species_flow",
    };
    let patch = patch.into();
    Some((Measure::Flow { what, patch }, field))
}

/// Force of the gas on a wall.
pub(super) fn force(
    reader: &TableReader<'_>,
    known: &Known<'_>,
) -> Option<(Measure, &'static str)> {
    let part: Option<ForcePart> = reader.choice("force");
    // The pressure is that of the cells.
    if part.is_none_or(|part| part != ForcePart::Pressure) {
        tells(reader, "force", known);
    }
    reader.need("along");
    let along = reader.has("along").then(|| direction(reader, "along"));
    let (patch, condition) = patch(reader, known)?;
    if let Some(condition) = condition
        && !matches!(condition, GasPatch::Wall { .. } | GasPatch::Periodic { .. })
    {
        let help = "name a wall; what flows through other patches is `flow`";
        reader.fail("patch", format!("is \"{patch}\", which is no wall"), help);
    }
    let along: Vec3 = along??;
    let (part, patch) = (part?, patch.into());
    Some((Measure::Force { part, patch, along }, "force"))
}

/// Particles that leave through outlets.
pub(super) fn discharge(
    reader: &TableReader<'_>,
    known: &Known<'_>,
) -> Option<(Measure, &'static str)> {
    let what: Option<Discharged> = reader.choice("discharge");
    let over = reader.has("over").then(|| ticks(reader, "over"));
    let name = reader.text("outlet");
    let names: Vec<&str> = known.outlets.iter().map(|one| one.name.as_str()).collect();
    if names.is_empty() {
        let help = "add [[outlets]] with a name and a zone";
        reader.fail("discharge", "needs an outlet, and the case has none", help);
        return None;
    }
    let outlet = name.and_then(|name| names.iter().position(|own| *own == name));
    if let (Some(name), None) = (name, outlet) {
        let help = format!("the outlets are {}", names.join(", "));
        reader.fail("outlet", format!("is \"{name}\""), help);
        return None;
    }
    let population = match reader.text("population") {
        Some(name) => Some(population(reader, name, known)?),
        None => None,
    };
    let what = what?;
    let ages = [Discharged::ResidenceTime, Discharged::ResidenceDeviation];
    if ages.contains(&what) && !known.feeds {
        let rule = "is the residence time, which is known of particles that a feed brings";
        let help = "add [[feeds]]: when the particles of the start came is not known";
        reader.fail("discharge", rule, help);
    }
    let over = match over {
        Some(over) => Some(over?),
        None => None,
    };
    let field = match what {
        Discharged::MassFlow => "mass_flow",
        Discharged::Mass => "mass",
        Discharged::Count => "count",
        Discharged::ResidenceTime | Discharged::ResidenceDeviation => "residence_time",
    };
    let measure = Measure::Discharge {
        what,
        outlet,
        population,
        over,
    };
    Some((measure, field))
}

/// Index of the population of a name.
fn population(reader: &TableReader<'_>, name: &str, known: &Known<'_>) -> Option<usize> {
    let all = known.populations?;
    let found = all.iter().position(|one| one.name == name);
    if found.is_none() {
        let names: Vec<&str> = all.iter().map(|one| one.name.as_str()).collect();
        let help = format!("the populations are {}", names.join(", "));
        reader.fail("population", format!("is \"{name}\""), help);
    }
    found
}
