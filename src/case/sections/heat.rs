//! `laws.conduction` and `laws.radiation`: heat between particles and to walls.

use calcine_coupler::motion::{Wall, WallMotion, WallShape};
use calcine_coupler::setup::Schedule;
use calcine_coupler::view_factors::{RadiationLaw, ViewFactors};

use crate::case::model::{
    ConductionArea, ConductionSpec, Laws, MaterialSpec, Population, RadiationSpec,
};
use crate::case::table::TableReader;
use crate::case::words::{AreaName, InsideName};

/// `laws.conduction`.
pub(super) fn conduction(section: &TableReader<'_>) -> Option<ConductionSpec> {
    let known = section.laws();
    let (law, table) = section.law("conduction", &known.conduction)?;
    let area = area(&table);
    let gap = table.optional_law("gap", &known.gap);
    table.finish();
    Some(ConductionSpec {
        law: law?,
        area: area?,
        gap: gap?,
    })
}

/// `area`, with `load` and `within` where it is a load.
fn area(table: &TableReader<'_>) -> Option<ConductionArea> {
    let chosen: AreaName = table.choice("area")?;
    let force = table.number("load");
    let within = table.number("within");
    if chosen == AreaName::Load {
        table.need("load");
        table.need("within");
        return Some(ConductionArea::Load {
            force: force?,
            within: within?,
        });
    }
    for key in ["load", "within"] {
        if table.has(key) {
            table.fail(key, "goes with area = \"load\" only", "remove it");
        }
    }
    Some(match chosen {
        AreaName::Force => ConductionArea::Force,
        _ => ConductionArea::Overlap,
    })
}

/// `laws.radiation`; `Some(None)` where surfaces do not radiate.
pub(super) fn radiation(section: &TableReader<'_>) -> Option<Option<RadiationSpec>> {
    let (law, table) = section.law("radiation", &section.laws().radiation)?;
    let law = law.map(|law| *law.make());
    let rays = table.whole("rays");
    let range = table.number("range");
    let refresh = match table.has("refresh") {
        true => table.number("refresh"),
        false => Some(0.0),
    };
    let inside: Option<InsideName> = table.choice("inside");
    let surroundings = surroundings(&table, law);
    let own: &[&str] = match law {
        Some(RadiationLaw::Rays) => &["rays", "range", "refresh", "surroundings", "inside"],
        Some(RadiationLaw::Distance | RadiationLaw::Neighbours) => {
            &["range", "refresh", "surroundings", "inside"]
        }
        _ => &[],
    };
    for key in ["rays", "range", "refresh", "surroundings", "inside"] {
        if law.is_some() && table.has(key) && !own.contains(&key) {
            table.fail(key, "does not go with this law of radiation", "remove it");
        }
    }
    table.finish();
    let rays = usize::try_from(rays?).ok()?;
    let range = range?;
    let view_factors = match law? {
        RadiationLaw::Rays => ViewFactors::Rays { rays, range },
        RadiationLaw::Distance => ViewFactors::Distance { range },
        RadiationLaw::Neighbours => ViewFactors::Neighbours { range },
        RadiationLaw::None => return Some(None),
    };
    Some(Some(RadiationSpec {
        view_factors,
        inside: inside? == InsideName::SinghKaviany,
        surroundings: surroundings?,
        refresh: refresh?,
    }))
}

/// `surroundings`: a temperature, or "closed".
fn surroundings(table: &TableReader<'_>, law: Option<RadiationLaw>) -> Option<Option<Schedule>> {
    if !table.has("surroundings") {
        if law.is_some_and(|law| law != RadiationLaw::None) {
            table.missing("surroundings");
        }
        return Some(None);
    }
    let word = table.raw("surroundings").and_then(|item| item.as_str());
    if word == Some("closed") {
        return Some(None);
    }
    let schedule = table.schedule("surroundings")?;
    let blind = match law {
        Some(RadiationLaw::Distance) => Some("distance"),
        Some(RadiationLaw::Neighbours) => Some("neighbours"),
        _ => None,
    };
    if let Some(name) = blind {
        table.fail(
            "surroundings",
            format!("does not go with law = \"{name}\", which does not see where the bed ends"),
            "write \"closed\", or law = \"view-factors\"",
        );
    }
    Some(Some(schedule))
}

/// What the laws need to know of materials, and of walls of a temperature.
pub(super) fn need_properties(
    root: &TableReader<'_>,
    laws: &Laws,
    materials: &[MaterialSpec],
    particles: &[Population],
    walls: &[(Wall, Option<Schedule>)],
) {
    let Some(section) = root.table("materials") else {
        return;
    };
    let conducts = laws.conducts();
    let pressed =
        !matches!(laws.conduction.area, ConductionArea::Overlap) && !laws.conduction.law.is_none();
    for (k, material) in materials.iter().enumerate() {
        let in_bed = particles.iter().any(|population| population.material == k);
        let at_wall = walls
            .iter()
            .any(|(wall, kelvin)| wall.material == k && kelvin.is_some());
        if !in_bed && !at_wall {
            continue;
        }
        let need = |lacks: bool, what: &str, add: &str, off: &str| {
            if lacks {
                let help = format!("add {add}, or write {off}");
                section.fail(&material.name, what, help);
            }
        };
        let inside = laws.radiation.as_ref().is_some_and(|one| one.inside);
        need(
            (conducts || inside) && material.conductivity.is_none(),
            "has no conductivity, which conduction between particles needs",
            "conductivity = \"1.1 W/m/K\"",
            "conduction = { law = \"none\" }",
        );
        need(
            laws.radiation.is_some() && material.emissivity.is_none(),
            "has no emissivity, which radiation between particles needs",
            "emissivity = 0.9",
            "radiation = { law = \"none\" }",
        );
        need(
            conducts && pressed && (material.young.is_none() || material.poisson.is_none()),
            "has no elastic constants, which contact areas of this `laws.conduction.area` need",
            "young = \"10 MPa\", real_young = \"60 GPa\" and poisson = 0.25",
            "area = \"overlap\"",
        );
    }
}

/// Walls of a temperature stay where they are, as the coordinator sees them.
pub(super) fn stays(table: &TableReader<'_>, shape: &WallShape, motion: &WallMotion) {
    let along = match (shape, motion) {
        (_, WallMotion::Still) => true,
        (WallShape::Plane { normal, .. }, WallMotion::Translating(velocity)) => {
            velocity.dot(normal) == 0.0
        }
        (
            WallShape::Cylinder { point, axis, .. },
            WallMotion::Rotating {
                point: about,
                angular_velocity,
            },
        ) => {
            let off = (about - point).cross(axis).norm();
            angular_velocity.cross(axis).norm() == 0.0 && off < 1e-12
        }
        _ => false,
    };
    if !along {
        table.fail(
            "temperature",
            "belongs to a wall that moves out of its place",
            "a wall with a temperature stands still, slides in its plane, or turns about its own axis",
        );
    }
}
