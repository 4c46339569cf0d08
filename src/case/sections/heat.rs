//! `laws.conduction` and `laws.radiation`: heat between particles and to walls.

use calcine_coupler::motion::{Wall, WallMotion, WallShape};
use calcine_coupler::setup::Schedule;
use calcine_coupler::view_factors::ViewFactors;

use crate::case::model::{
    ConductionArea, ConductionLaw, ConductionSpec, GapSpec, Laws, MaterialSpec, Population,
    RadiationSpec,
};
use crate::case::table::TableReader;
use crate::case::units::Dimension;

/// `laws.conduction`.
pub(super) fn conduction(section: &TableReader<'_>) -> Option<ConductionSpec> {
    let table = section.required_table("conduction", "conduction = { law = \"none\" }")?;
    let laws = [
        ("batchelor-obrien", ConductionLaw::BatchelorObrien),
        ("lens", ConductionLaw::Lens),
        ("none", ConductionLaw::None),
    ];
    let law = table.required_choice("law", &laws);
    let area = area(&table);
    let gap = match table.table("gap") {
        Some(table) => gap(&table),
        None => Some(GapSpec::None),
    };
    table.finish();
    Some(ConductionSpec {
        law: law?,
        area: area?,
        gap: gap?,
    })
}

/// `area`, with `load` and `within` where it is a load.
fn area(table: &TableReader<'_>) -> Option<ConductionArea> {
    let areas = [("overlap", 0), ("force", 1), ("load", 2)];
    let chosen = match table.has("area") {
        true => table.choice("area", &areas)?,
        false => 0,
    };
    let force = table.positive("load", Dimension::FORCE);
    let within = table.positive("within", Dimension::LENGTH);
    if chosen == 2 {
        for (key, example) in [("load", "\"50 mN\""), ("within", "\"20 um\"")] {
            if !table.has(key) {
                table.missing(key, example);
            }
        }
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
        1 => ConductionArea::Force,
        _ => ConductionArea::Overlap,
    })
}

/// `gap`: conduction through the gas between surfaces.
fn gap(table: &TableReader<'_>) -> Option<GapSpec> {
    let laws = [("rong-horio", 1), ("cheng", 2), ("none", 0)];
    let law = table.required_choice("law", &laws);
    let number = |key, usual: f64| match table.has(key) {
        true => table.positive(key, Dimension::NONE),
        false => Some(usual),
    };
    let (lens, cone, widest) = (
        number("lens", 0.2),
        number("cone", 0.66),
        number("widest", 1.0),
    );
    let least = table.positive("least_width", Dimension::LENGTH);
    let own: &[&str] = match law {
        Some(1) => &["lens", "least_width"],
        Some(2) => &["cone", "widest"],
        _ => &[],
    };
    for key in ["lens", "least_width", "cone", "widest"] {
        if law.is_some() && table.has(key) && !own.contains(&key) {
            table.fail(key, "belongs to another law of the gap", "remove it");
        }
    }
    if law == Some(1) && !table.has("least_width") {
        table.missing("least_width", "\"1 um\"");
    }
    table.finish();
    Some(match law? {
        1 => GapSpec::RongHorio {
            lens: lens?,
            least_width: least?,
        },
        2 => GapSpec::Cheng {
            cone: cone?,
            widest: widest?,
        },
        _ => GapSpec::None,
    })
}

/// `laws.radiation`; `Some(None)` where surfaces do not radiate.
pub(super) fn radiation(section: &TableReader<'_>) -> Option<Option<RadiationSpec>> {
    let table = section.required_table("radiation", "radiation = { law = \"none\" }")?;
    let laws = [("view-factors", 1), ("distance", 2), ("none", 0)];
    let law = table.required_choice("law", &laws);
    let rays = match table.has("rays") {
        true => table.whole("rays", 16..=1_000_000),
        false => Some(1024),
    };
    let range = match table.has("range") {
        true => table.positive("range", Dimension::NONE),
        false => Some(3.0),
    };
    let refresh = match table.has("refresh") {
        true => table.positive("refresh", Dimension::TIME),
        false => Some(0.0),
    };
    let insides = [("isothermal", false), ("singh-kaviany", true)];
    let inside = match table.has("inside") {
        true => table.choice("inside", &insides),
        false => Some(false),
    };
    let surroundings = surroundings(&table, law);
    let own: &[&str] = match law {
        Some(1) => &["rays", "range", "refresh", "surroundings", "inside"],
        Some(2) => &["range", "refresh", "surroundings", "inside"],
        _ => &[],
    };
    for key in ["rays", "range", "refresh", "surroundings", "inside"] {
        if law.is_some() && table.has(key) && !own.contains(&key) {
            table.fail(key, "does not go with this law of radiation", "remove it");
        }
    }
    if range.is_some_and(|range| range < 1.0) {
        let help = "neighbours that touch are 1 apart; write 3, or more where it is to be exact";
        table.fail("range", "is below 1 diameter", help);
    }
    table.finish();
    let rays = usize::try_from(rays?).ok()?;
    let range = range?;
    let view_factors = match law? {
        1 => ViewFactors::Rays { rays, range },
        2 => ViewFactors::Distance { range },
        _ => return Some(None),
    };
    Some(Some(RadiationSpec {
        view_factors,
        inside: inside?,
        surroundings: surroundings?,
        refresh: refresh?,
    }))
}

/// `surroundings`: a temperature, or "closed".
fn surroundings(table: &TableReader<'_>, law: Option<i32>) -> Option<Option<Schedule>> {
    if !table.has("surroundings") {
        if matches!(law, Some(1 | 2)) {
            table.missing("surroundings", "\"300 K\", or \"closed\"");
        }
        return Some(None);
    }
    let closed = table.raw("surroundings").and_then(|item| item.as_str()) == Some("closed");
    if closed {
        return Some(None);
    }
    let schedule = table.temperatures("surroundings")?;
    if law == Some(2) {
        table.fail(
            "surroundings",
            "does not go with law = \"distance\", which does not see where the bed ends",
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
    let pressed = !matches!(laws.conduction.area, ConductionArea::Overlap)
        && laws.conduction.law != ConductionLaw::None;
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
