//! What a case writes to choose a law by which particles dry or give off volatiles.

use super::arrhenius::{ACTIVATION_ENERGY, Arrhenius, EXPONENT};
use super::devolatilisation::Devolatilisation;
use super::evaporation::Evaporation;
use super::rate_law::RateLaw;
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter, LawTable, LawValues};

/// Entry of [`super::evaporation`] of free water in a case file.
pub static EVAPORATION: LawEntry<RateLaw> = LawEntry {
    name: "evaporation",
    summary: "From the surface of a wet particle, by the vapour pressure of water; condensation with <=>, none with =>.",
    source: "docs/theory.md, DRY-1",
    parameters: &[],
    tables: &[BOUND_WATER],
    make: |values| Box::new(RateLaw::Evaporation(made(values, false))),
};

/// Entry of [`super::evaporation`] of the water of wood in a case file.
pub static WOOD_DRYING: LawEntry<RateLaw> = LawEntry {
    name: "wood-drying",
    summary: "Like evaporation, with the lower vapour pressure over bound water by the isotherm of Hailwood and Horrobin.",
    source: "docs/theory.md, DRY-4",
    parameters: &[],
    tables: &[BOUND_WATER],
    make: |values| Box::new(RateLaw::Evaporation(made(values, true))),
};

const BOUND_WATER: LawTable = LawTable {
    name: "bound_water",
    required: false,
    meaning: "Heat of sorption of the water below fibre saturation, 0.4 (1 - M/M_fsp)^2 of the heat of evaporation; none where it is left out.",
    example: "{ fibre_saturation = 0.3 }",
    by_name: None,
    parameters: &[LawParameter {
        name: "fibre_saturation",
        dimension: Dimension::NONE,
        bound: Bound::UpTo(0.0, 1.0),
        default: Some(0.3),
        needed_with: None,
        meaning: "Moisture up to which water is bound, in kg of water a kg of dry solid; wood has 0.25 to 0.40.",
        example: "0.3",
    }],
    tables: &[],
};

/// From the values of its keys.
fn made(values: &LawValues, isotherm: bool) -> Evaporation {
    Evaporation {
        fibre_saturation: values.table(0).map(|bound| bound[0]),
        isotherm,
    }
}

/// Entry of [`super::devolatilisation`] in a case file.
pub static DEVOLATILISATION: LawEntry<RateLaw> = LawEntry {
    name: "devolatilisation",
    summary: "In the whole particle, by the share of its solid that is left of the particle's start, to a power.",
    source: "docs/theory.md, DEV-2",
    parameters: &[LawParameter {
        name: "order",
        dimension: Dimension::NONE,
        bound: Bound::Between(1.0, 10.0),
        default: None,
        needed_with: None,
        meaning: "Order n of the rate in the share that is left; below 1 the last of it would leave in finite time.",
        example: "1.22",
    }],
    tables: &[RATE],
    make: |values| {
        let rate = values.table(0).cloned().unwrap_or_default();
        Box::new(RateLaw::Devolatilisation(Devolatilisation {
            rate: Arrhenius::from_values(&rate),
            order: values[0],
        }))
    },
};

const RATE: LawTable = LawTable {
    name: "rate",
    required: true,
    meaning: "Rate constant k = factor T^exponent exp(-activation_energy/RT).",
    example: "{ factor = 2.58e11, activation_energy = \"159.2 kJ/mol\" }",
    by_name: None,
    parameters: &[
        LawParameter {
            name: "factor",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "A number in 1/s.",
            example: "2.58e11",
        },
        EXPONENT,
        ACTIVATION_ENERGY,
    ],
    tables: &[],
};
