//! Hot gas in a duct of which a part is a porous zone with Ergun's drag. Nearly all of the zone is gas, because the stock solver has
//! no void fraction.

use super::case::{ErrorCase, ErrorQuantity, Reference, at};

pub const CASE: ErrorCase = ErrorCase {
    name: "hot-duct",
    stock: "buoyantPimpleFoam",
    coarsest: [32, 32],
    end: 0.2,
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
    runs: &[at(1, 10.0), at(1, 5.0), at(2, 5.0), at(2, 2.5), at(3, 2.5)],
    // Meshes on which the points of the zone fill all cells alike.
    large: &[
        at(1, 10.0),
        at(1, 5.0),
        at(1, 2.5),
        at(2, 5.0),
        at(2, 2.5),
        at(3, 2.5),
        at(3, 1.25),
        at(6, 1.25),
        at(6, 0.625),
    ],
    reference: Reference::Extrapolated(at(4, 2.5)),
    start: None,
};
