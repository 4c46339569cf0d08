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

#[test]
fn an_upright_box_has_second_order() {
    let case = ManufacturedCase::new(0.0, CellShape::Hexahedra(0.0));
    for [velocity, temperature, pressure] in orders(&case, &[6, 9, 13]) {
        assert!(velocity > 1.8 && temperature > 1.8 && pressure > 1.0);
    }
}
