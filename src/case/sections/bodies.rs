//! `[bodies.NAME]`: bodies that store heat.

use calcine_coupler::bodies::{BodyRadiation, HeatBody};

use super::gas_patch::BodySurface;
use super::particles::material_of;
use crate::case::model::{ExternalSpec, MaterialSpec};
use crate::case::table::TableReader;

/// All bodies, still without the patches that are their surfaces, with their materials.
pub(super) fn bodies(root: &TableReader<'_>, materials: &[MaterialSpec]) -> Vec<(HeatBody, usize)> {
    if !root.has("bodies") {
        return Vec::new();
    }
    let Some(section) = root.table("bodies") else {
        return Vec::new();
    };
    let named = section.named();
    let one = |(name, table): &(String, TableReader<'_>)| {
        let material = material_of(table, materials);
        let (mass, temperature) = (table.number("mass"), table.number("temperature"));
        let radiation = radiation(table);
        table.finish();
        let material = material?;
        let body = HeatBody {
            name: name.clone(),
            mass: mass?,
            heat_capacity: materials[material].heat_capacity.clone(),
            temperature: temperature?,
            patches: Vec::new(),
            radiation: radiation?,
        };
        Some((body, material))
    };
    named.iter().filter_map(one).collect()
}

/// Radiation to surroundings, nothing where none is stated; `None` where something is wrong.
#[allow(
    clippy::option_option,
    reason = "none stated, and none that can be read"
)]
fn radiation(table: &TableReader<'_>) -> Option<Option<BodyRadiation>> {
    if !table.has("radiation") {
        return Some(None);
    }
    let inner = table.table("radiation")?;
    let (area, emissivity) = (inner.number("area"), inner.number("emissivity"));
    let surroundings = inner.schedule("surroundings");
    inner.finish();
    Some(Some(BodyRadiation {
        area: area?,
        emissivity: emissivity?,
        surroundings: surroundings?,
    }))
}

/// The place of the body that a table names under `body`; an error where there is none of that name.
pub(super) fn of_name(table: &TableReader<'_>, name: &str, bodies: &[HeatBody]) -> Option<usize> {
    let found = bodies.iter().position(|body| body.name == name);
    if found.is_none() {
        let known: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
        let help = match known[..] {
            [] => format!("the case has no bodies; write a table [bodies.{name}]"),
            _ => format!("the bodies are {}", known.join(", ")),
        };
        table.fail("body", format!("is \"{name}\""), help);
    }
    found
}

/// Gives bodies the patches that are their surfaces, and checks that each exchanges heat with something; of walls the body
/// of each, where it has one.
pub(super) fn join(
    root: &TableReader<'_>,
    bodies: &mut [HeatBody],
    surfaces: &[BodySurface],
    walls: &[Option<usize>],
    openfoam: &ExternalSpec,
) {
    let section = || root.table("bodies").filter(|_| root.has("bodies"));
    for surface in surfaces {
        let stated = section().is_some_and(|section| section.has_named(&surface.body));
        if stated && !bodies.iter().any(|body| body.name == surface.body) {
            // What is wrong of it has been told.
            continue;
        }
        let Some(heat) = wall_heat(root, &surface.patch.name) else {
            continue;
        };
        if let Some(place) = of_name(&heat, &surface.body, bodies) {
            bodies[place].patches.push(surface.patch.clone());
        }
    }
    let Some(section) = section().filter(|_| !bodies.is_empty()) else {
        return;
    };
    for (place, body) in bodies.iter().enumerate() {
        let alone = body.patches.is_empty() && body.radiation.is_none();
        if alone && !walls.contains(&Some(place)) {
            let name = &body.name;
            let help = format!(
                "give it a surface with heat = {{ body = \"{name}\" }} of a wall in gas.patch, a wall of [[walls]] with body = \"{name}\", \
                 or `radiation`"
            );
            section.fail(name, "exchanges heat with nothing", help);
        }
    }
    if openfoam.solver.is_stock()
        && let Some(foam) = root.table("openfoam")
    {
        let rule = format!(
            "names {}, which cannot go back to the start of a time step, as bodies that store heat need it",
            openfoam.solver.name()
        );
        foam.fail(
            "solver",
            rule,
            "leave `openfoam.solver` out, or remove `bodies`",
        );
    }
}

/// The table of the heat through a wall of the gas.
fn wall_heat<'a>(root: &TableReader<'a>, patch: &str) -> Option<TableReader<'a>> {
    let patches = root.table("gas")?.table("patch")?.named();
    let own = patches.into_iter().find(|(name, _)| name == patch)?.1;
    own.table("wall")?.table("heat")
}
