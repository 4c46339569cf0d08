//! Start of natural convection of air in a square between a warm and a cold wall.

use super::case::{ErrorCase, ErrorQuantity, Reference, at};

pub const CASE: ErrorCase = ErrorCase {
    name: "heated-cavity",
    stock: "buoyantPimpleFoam",
    coarsest: [32, 32],
    end: 1.0,
    quantities: &[
        ErrorQuantity {
            name: "velocity",
            calcine: "velocity",
            openfoam: "U",
            level: 0.0,
        },
        ErrorQuantity {
            name: "temperature",
            calcine: "temperature",
            openfoam: "T",
            level: 300.0,
        },
    ],
    runs: &[
        at(1, 40.0),
        at(1, 20.0),
        at(2, 20.0),
        at(2, 10.0),
        at(3, 10.0),
    ],
    large: &[
        at(1, 40.0),
        at(1, 20.0),
        at(1, 10.0),
        at(2, 20.0),
        at(2, 10.0),
        at(2, 5.0),
        at(4, 10.0),
        at(4, 5.0),
        at(4, 2.5),
        at(8, 2.5),
    ],
    reference: Reference::Extrapolated(at(4, 10.0)),
    start: None,
};
