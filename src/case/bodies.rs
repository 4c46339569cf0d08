//! What `calcine check` says of bodies that store heat.

use calcine_coupler::bodies::HeatBody;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::physics::radiation::STEFAN_BOLTZMANN;

use super::model::Case;
use super::units::{short, short3};

/// Lines of `check`: a first and further ones about each body.
pub(super) fn lines(case: &Case, mesh: &Mesh) -> Vec<String> {
    case.bodies
        .iter()
        .flat_map(|body| of(case, mesh, body))
        .collect()
}

fn of(case: &Case, mesh: &Mesh, body: &HeatBody) -> Vec<String> {
    let capacity = body.mass * body.heat_capacity.at(body.temperature);
    let conductivity = case
        .gas
        .properties
        .conductivity(body.temperature, &case.gas.composition);
    let [area, conductance] = body.surface(mesh, conductivity);
    let mut lines = vec![format!(
        "`{}`: {} kg, {} J/K at {} K",
        body.name,
        short(body.mass),
        short3(capacity),
        short(body.temperature)
    )];
    if area > 0.0 {
        lines.push(format!(
            "  gas over {} m^2, {} W/K: takes its temperature in {} s of process time",
            short3(area),
            short3(conductance),
            short3(capacity / conductance)
        ));
    }
    if let Some(radiation) = &body.radiation {
        let around = radiation.surroundings.0.iter().map(|entry| entry.1);
        let hottest = around.fold(body.temperature, f64::max);
        let slope =
            4.0 * radiation.emissivity * STEFAN_BOLTZMANN * radiation.area * hottest.powi(3);
        lines.push(format!(
            "  surroundings by radiation over {} m^2, {} W/K at {} K: takes their temperature in {} s",
            short3(radiation.area),
            short3(slope),
            short(hottest),
            short3(capacity / slope)
        ));
    }
    let walls = case.wall_bodies.iter().flatten();
    let walls = walls.filter(|&&one| case.bodies[one].name == body.name);
    let walls = walls.count();
    if walls > 0 {
        lines.push(format!("  particles that touch {walls} of the walls"));
    }
    if area == 0.0 && body.radiation.is_none() && walls == 0 {
        lines.push("  exchanges heat with nothing".into());
    }
    lines
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::valid::ValidCase;

    /// 0.5 g of 150.05 J/kg/K at 960 K; 4 e sigma A T^3 = 4 · 0.15 · 5.6704e-8 · 3e-4 · 1160^3 = 0.01593 W/K.
    #[test]
    fn check_tells_what_a_body_holds_and_exchanges() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/crucible.toml");
        let report = ValidCase::open(&path, &[]).unwrap().report();
        for words in [
            "`crucible`: 0.0005 kg, 0.075 J/K at 960 K",
            "gas over ",
            "over 0.0003 m^2, 0.0159 W/K at 1160 K: takes their temperature in 4.71 s",
            "particles that touch 1 of the walls",
        ] {
            assert!(report.contains(words), "`{words}` is missing in: {report}");
        }
    }
}
