//! Is the gas of a case that is computed as laminar likely turbulent?

use std::collections::BTreeMap;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::setup::{GasPatch, Schedule};

use super::model::Case;
use super::step;
use super::units::short3;

/// Reynolds number by the hydraulic diameter above which flow in ducts is turbulent; it may be laminar up to there, and is below 2300.
const TURBULENT: f64 = 4000.0;

/// An inlet as the mouth of a duct.
struct DuctInlet<'a> {
    name: &'a str,
    /// In m/s.
    speed: f64,
    /// 4 A/P in m, by the edges that the inlet shares with walls.
    diameter: f64,
    reynolds: f64,
}

/// Particles from which a bed, not a duct, decides on the flow.
const BED: usize = 20;

/// A warning about the inlet of the largest Reynolds number, where so many particles are in a gas that is computed as laminar.
pub(super) fn turbulent_inlet(case: &Case, mesh: &Mesh, particles: usize) -> Option<String> {
    if particles >= BED {
        return None;
    }
    if case.gas_held || !case.gas.turbulence.is_laminar() || case.gas.properties.is_vacuum() {
        return None;
    }
    let patches = case.gas.patches.iter();
    let inlets = patches.filter_map(|(name, patch)| inlet(case, mesh, name, patch));
    let fastest = inlets.max_by(|one, other| one.reynolds.total_cmp(&other.reynolds))?;
    (fastest.reynolds > TURBULENT).then(|| {
        format!(
            "the gas is laminar, but flows in through `{}` at a Reynolds number of {} ({} m/s, hydraulic diameter {} m): above {TURBULENT} \
             flow in ducts is turbulent, with several times the friction and heat transfer at walls; add [gas.turbulence], or lower the \
             flow",
            fastest.name,
            short3(fastest.reynolds),
            short3(fastest.speed),
            short3(fastest.diameter)
        )
    })
}

fn inlet<'a>(case: &Case, mesh: &Mesh, name: &'a str, patch: &GasPatch) -> Option<DuctInlet<'a>> {
    let GasPatch::Inlet { temperature, .. } = patch else {
        return None;
    };
    let largest = |schedule: &Schedule| schedule.0.iter().map(|entry| entry.1).fold(0.0, f64::max);
    let (gas, speed) = (&case.gas, step::fastest_in(case, mesh, name, patch));
    let diameter = hydraulic_diameter(case, mesh, name)?;
    let temperature = largest(temperature);
    let properties = &gas.properties;
    let density = properties.density(gas.pressure, temperature, &gas.composition);
    let viscosity = properties.viscosity(temperature, &gas.composition);
    Some(DuctInlet {
        name,
        speed,
        diameter,
        reynolds: density * speed * diameter / viscosity,
    })
}

/// 4 A/P of a patch in m, with the perimeter P of the edges that it shares with walls; `None` without such edges.
fn hydraulic_diameter(case: &Case, mesh: &Mesh, name: &str) -> Option<f64> {
    let mut edges = BTreeMap::new();
    for face in mesh.patch(name)?.faces() {
        for edge in edges_of(mesh, face) {
            *edges.entry(edge).or_insert(0) += 1;
        }
    }
    // Edges within the patch belong to two of its faces.
    edges.retain(|_, count| *count == 1);
    let is_wall = |name: &str| {
        let mut conditions = case.gas.patches.iter();
        conditions.any(|(own, patch)| own == name && matches!(patch, GasPatch::Wall { .. }))
    };
    let points = &mesh.topology().points;
    let mut perimeter = 0.0;
    for patch in mesh.patches().iter().filter(|patch| is_wall(&patch.name)) {
        for edge in patch.faces().flat_map(|face| edges_of(mesh, face)) {
            if edges.remove(&edge).is_some() {
                let [one, other] = edge.map(|point| points[point as usize]);
                perimeter += (one - other).norm();
            }
        }
    }
    (perimeter > 0.0).then(|| 4.0 * step::area(mesh, name) / perimeter)
}

/// Edges of a face by their points, the smaller first.
fn edges_of(mesh: &Mesh, face: usize) -> impl Iterator<Item = [u32; 2]> + '_ {
    let points = mesh.face_points(face);
    let next = points.iter().cycle().skip(1);
    points
        .iter()
        .zip(next)
        .map(|(&one, &other)| [one.min(other), one.max(other)])
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::case::{mesh_of, read};

    fn open(name: &str, set: &[&str]) -> (Case, Mesh) {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        let case = read(&folder.join(name), &set).unwrap();
        let mesh = mesh_of(&case).unwrap();
        (case, mesh)
    }

    #[test]
    fn the_hydraulic_diameter_of_a_round_inlet_is_its_diameter() {
        let (case, mesh) = open("cases/heated-bed.toml", &[]);
        let found = hydraulic_diameter(&case, &mesh, "bottom").unwrap();
        // Of a polygon that encloses the circle's area: its perimeter is longer.
        assert!((found / 0.05 - 1.0).abs() < 0.02, "{found}");
    }

    #[test]
    fn laminar_flow_at_a_reynolds_number_of_turbulent_ducts_is_told() {
        let told = |speed: &str| {
            let inlet = format!("gas.patch.bottom.inlet.superficial_velocity={speed}");
            let (case, mesh) = open("cases/heated-bed.toml", &[&inlet]);
            turbulent_inlet(&case, &mesh, 0)
        };
        assert_eq!(told("0.4 m/s"), None);
        let text = told("5 m/s").unwrap();
        assert!(
            text.contains("through `bottom` at a Reynolds number of"),
            "{text}"
        );
    }
}
