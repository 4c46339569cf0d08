//! Orders of convergence towards a manufactured solution on skewed, perturbed, tetrahedral and polyhedral meshes.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::sync::Arc;

use calcine_coupler::conformance::manufactured::{CellShape, FieldErrors, ManufacturedCase};
use calcine_coupler::error::{FailureKind, PartError};
use calcine_native::gas::{NativeError, NativeGas};

fn unmade(error: NativeError) -> PartError {
    PartError::new("native", FailureKind::NotStarted, error.to_string())
}

fn errors(case: &ManufacturedCase, cells: usize) -> FieldErrors {
    let mut make = |setup: &_, mesh: &Arc<_>, _: Option<&_>, _: &mut _| {
        let gas = NativeGas::new(Arc::clone(mesh), setup).map_err(unmade)?;
        Ok(Box::new(gas) as Box<_>)
    };
    let found = case.errors(cells, &mut make).unwrap();
    println!("{found:?}");
    found
}

/// Orders of velocity, temperature and pressure between meshes of growing numbers of cells.
fn orders(case: &ManufacturedCase, cells: &[usize]) -> Vec<[f64; 3]> {
    let found: Vec<_> = cells.iter().map(|&cells| errors(case, cells)).collect();
    assert!(found.iter().all(|one| one.converged), "{found:?}");
    found
        .windows(2)
        .map(|pair| pair[1].orders(&pair[0]))
        .collect()
}

/// Velocity and temperature of this order at least, the pressure of the first.
fn converges(degrees: f64, shape: CellShape, cells: &[usize], order: f64) {
    let case = ManufacturedCase::new(degrees, shape);
    for [velocity, temperature, pressure] in orders(&case, cells) {
        println!("orders {velocity:.2}, {temperature:.2}, {pressure:.2}");
        assert!(
            velocity > order && temperature > order && pressure > 1.0,
            "{shape:?} at {degrees} degrees: {velocity} {temperature} {pressure}"
        );
    }
}

#[test]
fn hexahedra_that_lean_by_up_to_45_degrees_have_second_order() {
    for degrees in [0.0, 15.0, 30.0, 45.0] {
        converges(degrees, CellShape::Hexahedra(0.0), &[6, 9, 13], 1.8);
    }
}

#[test]
fn hexahedra_that_lean_by_60_and_70_degrees_converge() {
    for degrees in [60.0, 70.0] {
        converges(degrees, CellShape::Hexahedra(0.0), &[6, 9, 13], 1.6);
    }
}

#[test]
fn displaced_points_leave_second_order() {
    converges(0.0, CellShape::Hexahedra(0.2), &[6, 9, 13], 1.8);
}

#[test]
fn tetrahedra_that_lean_by_up_to_45_degrees_have_second_order() {
    for degrees in [0.0, 30.0, 45.0] {
        converges(degrees, CellShape::Tetrahedra(0.0), &[6, 9], 1.8);
    }
}

/// Here corrections grow whose gradient follows all of a difference.
#[test]
fn tetrahedra_that_lean_by_60_and_polyhedra_that_lean_by_45_degrees_converge() {
    converges(60.0, CellShape::Tetrahedra(0.0), &[6, 9], 1.2);
    converges(45.0, CellShape::Polyhedra(0.0), &[9, 12], 1.2);
}

#[test]
fn tetrahedra_whose_points_are_displaced_have_second_order() {
    converges(0.0, CellShape::Tetrahedra(0.1), &[6, 9], 1.8);
}

/// On fewer cells the half cells at the walls show: orders of 1.4 on 6 to 8, 1.7 on 12 to 16.
#[test]
fn polyhedra_have_second_order() {
    converges(0.0, CellShape::Polyhedra(0.0), &[16, 20], 1.8);
}
