//! Parts of space: zones of a mesh that are refined, or excluded from the smoother.

use calcine_coupler::mesh::cut::Cut;
use calcine_coupler::mesh::openings::Opening;
use calcine_coupler::mesh::refine::Refinement;
use calcine_coupler::mesh::zone::Zone;
use calcine_coupler::physics::Vec3;

use crate::case::table::TableReader;
use crate::case::units::shown;

/// A zone from the keys of its own table: `box` or `cylinder`.
pub(super) fn zone(table: &TableReader<'_>) -> Option<Zone> {
    zone_of(table, table.exactly_one()?)
}

/// The zone of one kind, `box` or `cylinder`.
pub(super) fn zone_of(table: &TableReader<'_>, kind: &str) -> Option<Zone> {
    let shape = table.table(kind)?;
    let from = shape.vector("from");
    let to = shape.vector("to");
    let round = kind == "cylinder";
    let radius = if round { shape.number("radius") } else { None };
    shape.finish();
    let (from, to) = (Vec3::from(from?), Vec3::from(to?));
    if round {
        if from == to {
            shape.fail("to", "is equal to `from`", "the ends of a cylinder differ");
            return None;
        }
        return Some(Zone::Cylinder {
            from,
            to,
            radius: radius?,
        });
    }
    if (0..3).any(|axis| to[axis] <= from[axis]) {
        let rule = format!("is {} {} {} m", shown(to.x), shown(to.y), shown(to.z));
        shape.fail("to", rule, "each coordinate must be above that of `from`");
        return None;
    }
    Some(Zone::Box {
        low: from,
        high: to,
    })
}

/// Zones of a list.
pub(super) fn zones(above: &TableReader<'_>, key: &str) -> Vec<Zone> {
    let tables = above.tables(key);
    let one = |table: &TableReader<'_>| {
        let zone = zone(table);
        table.finish();
        zone
    };
    tables.iter().filter_map(one).collect()
}

/// The regions of a generated mesh that are refined.
pub(super) fn refinements(mesh: &TableReader<'_>) -> Vec<Refinement> {
    let tables = mesh.tables("refine");
    let one = |table: &TableReader<'_>| {
        let levels = table.small_whole("levels");
        let zone = zone(table);
        table.finish();
        Some(Refinement {
            zone: zone?,
            levels: levels?,
        })
    };
    tables.iter().filter_map(one).collect()
}

/// The parts of a generated mesh's boundary that have patches of their own, beside those of its sides.
pub(super) fn openings(mesh: &TableReader<'_>, sides: &[String]) -> Vec<Opening> {
    let tables = mesh.tables("openings");
    let one = |table: &TableReader<'_>| {
        let name = table.text("name");
        let zone = zone(table);
        table.finish();
        let name = own_name(table, name?, sides, "an opening needs a name of its own")?;
        Some(Opening { name, zone: zone? })
    };
    tables.iter().filter_map(one).collect()
}

/// The bodies that are cut out of a generated mesh, with patches beside those of its sides.
pub(super) fn cuts(mesh: &TableReader<'_>, sides: &[String]) -> Vec<Cut> {
    let tables = mesh.tables("cut");
    let one = |table: &TableReader<'_>| {
        let name = table.text("name");
        let zone = zone(table);
        let hollow = table.table("hollow").map(|hollow| {
            let zone = self::zone(&hollow);
            hollow.finish();
            zone
        });
        table.finish();
        let name = own_name(table, name?, sides, "a body needs a name of its own")?;
        let hollow = match hollow {
            Some(hollow) => Some(hollow?),
            None => None,
        };
        Some(Cut {
            name,
            zone: zone?,
            hollow,
        })
    };
    tables.iter().filter_map(one).collect()
}

/// A name of a patch that no side of the mesh has.
fn own_name(table: &TableReader<'_>, name: &str, sides: &[String], help: &str) -> Option<String> {
    if sides.iter().any(|side| side == name) {
        let rule = format!("is \"{name}\", a side of the mesh");
        table.fail("name", rule, help);
        return None;
    }
    Some(name.to_owned())
}
