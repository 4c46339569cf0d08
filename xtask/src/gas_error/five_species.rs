//! Two dilute streams of five species side by side in a duct, whose mass fractions rise with time; none reacts. Dilute,
//! because the solvers mix viscosities by different rules.

use super::case::{ErrorCase, ErrorQuantity, Reference, at};

pub const CASE: ErrorCase = ErrorCase {
    name: "five-species",
    stock: "reactingFoam",
    coarsest: [32, 32],
    end: 0.2,
    quantities: &[
        ErrorQuantity {
            name: "CO2",
            calcine: "CO2",
            openfoam: "CO2",
            level: 0.0,
        },
        ErrorQuantity {
            name: "CH4",
            calcine: "CH4",
            openfoam: "CH4",
            level: 0.0,
        },
    ],
    runs: &[
        at(1, 10.0),
        at(1, 5.0),
        at(1, 2.5),
        at(2, 5.0),
        at(2, 2.5),
        at(3, 2.5),
    ],
    large: &[
        at(1, 10.0),
        at(1, 5.0),
        at(1, 2.5),
        at(2, 5.0),
        at(2, 2.5),
        at(2, 1.25),
        at(4, 2.5),
        at(4, 1.25),
        at(8, 1.25),
        at(8, 0.625),
    ],
    reference: Reference::Extrapolated(at(4, 2.5)),
    start: None,
};
