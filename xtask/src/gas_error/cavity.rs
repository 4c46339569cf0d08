//! Start of a lid-driven cavity at Re 100.

use super::case::{ErrorCase, ErrorQuantity, Reference, at};

pub const CASE: ErrorCase = ErrorCase {
    name: "cavity",
    stock: "icoFoam",
    coarsest: [32, 32],
    end: 0.5,
    quantities: &[ErrorQuantity {
        name: "velocity",
        calcine: "velocity",
        openfoam: "U",
        level: 0.0,
    }],
    runs: &[
        at(1, 20.0),
        at(2, 20.0),
        at(2, 10.0),
        at(3, 10.0),
        at(3, 5.0),
    ],
    large: &[
        at(1, 20.0),
        at(1, 10.0),
        at(2, 20.0),
        at(2, 10.0),
        at(2, 5.0),
        at(4, 10.0),
        at(4, 5.0),
        at(4, 2.5),
        at(8, 5.0),
        at(8, 2.5),
        at(8, 1.25),
        at(16, 1.25),
    ],
    reference: Reference::Extrapolated(at(4, 2.5)),
    start: None,
};
