//! Orders of convergence of calcineGasFoam towards a manufactured solution (verification), as of the native gas.
#![allow(clippy::print_stdout)]

use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use calcine_adapters::launch::Launcher;
use calcine_adapters::openfoam::OpenfoamLaunch;
use calcine_adapters::openfoam::stock::StockSolver;
use calcine_coupler::conformance::manufactured::{CellShape, FieldErrors, ManufacturedCase};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::Gas;
use calcine_coupler::setup::GasSetup;
use calcine_coupler::supervisor::Supervisor;

fn errors(case: &ManufacturedCase, cells: usize) -> FieldErrors {
    let folder = tempfile::tempdir().unwrap();
    let mut make =
        |setup: &GasSetup, mesh: &Arc<Mesh>, _: Option<&Path>, supervisor: &mut Supervisor| {
            let launch = OpenfoamLaunch {
                setup,
                mesh: Arc::clone(mesh),
                template: None,
                start: None,
                gas: None,
                solver: StockSolver::default(),
                case_hash: "manufactured".into(),
                folder: folder.path().join("case"),
                log: folder.path().join("log"),
                ranks: 1,
                launcher: Launcher::Mpirun,
                resume: None,
                from: None,
                deadline: Duration::from_secs(60),
            };
            Ok(Box::new(launch.launch(supervisor)?) as Box<dyn Gas>)
        };
    let found = case
        .errors(cells, &mut make)
        .unwrap_or_else(|error| panic!("{error}"));
    println!("{found:?}");
    found
}

/// Velocity and temperature of this order at least, the pressure of the first.
fn converges(degrees: f64, shape: CellShape, cells: &[usize], order: f64) {
    follows(&ManufacturedCase::new(degrees, shape), cells, order);
}

fn follows(case: &ManufacturedCase, cells: &[usize], order: f64) {
    let (shape, degrees) = (case.shape, case.fields.lean.atan().to_degrees());
    let found: Vec<_> = cells.iter().map(|&cells| errors(case, cells)).collect();
    for pair in found.windows(2) {
        let [velocity, temperature, pressure] = pair[1].orders(&pair[0]);
        println!("{shape:?} at {degrees}: orders {velocity:.2}, {temperature:.2}, {pressure:.2}");
        assert!(pair[1].converged, "{found:?}");
        assert!(
            velocity > order && temperature > order && pressure > 1.0,
            "{shape:?} at {degrees} degrees: {velocity} {temperature} {pressure}"
        );
    }
}

#[test]
fn hexahedra_that_lean_by_up_to_45_degrees_have_second_order() {
    for degrees in [0.0, 30.0, 45.0] {
        converges(degrees, CellShape::Hexahedra(0.0), &[6, 9, 13], 1.8);
    }
}

#[test]
fn hexahedra_that_lean_by_70_degrees_converge() {
    converges(70.0, CellShape::Hexahedra(0.0), &[6, 9, 13], 1.6);
}

#[test]
fn tetrahedra_that_lean_by_up_to_45_degrees_have_second_order() {
    for degrees in [0.0, 30.0, 45.0] {
        converges(degrees, CellShape::Tetrahedra(0.0), &[6, 9], 1.8);
    }
}

/// Of the native gas on the same cells (kind agreement; `native-solver/tests/manufactured.rs`).
#[test]
fn errors_on_tetrahedra_that_lean_are_those_of_the_native_gas() {
    let found = errors(&ManufacturedCase::new(45.0, CellShape::Tetrahedra(0.0)), 6);
    for (own, native) in [
        (found.velocity, 0.100_587_7),
        (found.temperature, 1.162_877_4),
        (found.pressure, 0.168_311_8),
    ] {
        assert!((own / native - 1.0).abs() < 1e-4, "{found:?}");
    }
}

#[test]
fn polyhedra_that_lean_by_45_degrees_converge() {
    converges(45.0, CellShape::Polyhedra(0.0), &[9, 12], 1.2);
}

#[test]
fn displaced_points_leave_second_order() {
    converges(0.0, CellShape::Hexahedra(0.2), &[6, 9, 13], 1.8);
}
