//! What a case writes to choose a law of conversion, law by law.

use super::choice::Conversion;
use super::contracting_area::ContractingArea;
use super::contracting_volume::ContractingVolume;
use super::equilibrium_pressure::GrainSurface;
use super::first_order::FirstOrder;
use super::nucleation::Nucleation;
use super::random_pore::RandomPore;
use crate::dimension::Dimension;
use crate::law::{Bound, LawEntry, LawParameter, LawTable, LawValues};
use crate::reaction::arrhenius::{ACTIVATION_ENERGY, Arrhenius, EXPONENT};
use crate::reaction::rate_law::RateLaw;

/// The rate constant, and the orders of gases.
const RATE: LawTable = LawTable {
    name: "rate",
    required: true,
    meaning: "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.",
    example: "{ factor = 1.235e15, activation_energy = \"325.1 kJ/mol\" }",
    by_name: None,
    parameters: &[FACTOR, EXPONENT, ACTIVATION_ENERGY],
    tables: &[ORDERS],
};

const FACTOR: LawParameter = LawParameter {
    name: "factor",
    dimension: Dimension::NONE,
    bound: Bound::Positive,
    default: None,
    needed_with: None,
    meaning: "A number in mol, m and s: 1/s where no gas has an order.",
    example: "1.235e15",
};

const ORDERS: LawTable = LawTable {
    name: "orders",
    required: false,
    meaning: "Order of each gas, by its concentration in the pores; of none where it is left out.",
    example: "{ CO2 = 0.5 }",
    by_name: Some(Dimension::NONE),
    parameters: &[],
    tables: &[],
};

/// A law of a case from the values of its tables.
fn made(values: &LawValues, conversion: Conversion) -> RateLaw {
    let rate = values.table(0).cloned().unwrap_or_default();
    let orders = rate.table(0).cloned().unwrap_or_default();
    RateLaw::Conversion {
        rate_constant: Arrhenius::from_values(&rate),
        conversion,
        orders: orders.by_name,
    }
}

/// Entry of [`super::first_order`] in a case file.
pub static FIRST_ORDER: LawEntry<RateLaw> = LawEntry {
    name: "first-order",
    summary: "In the whole particle, in proportion to what is left of the solid.",
    source: "docs/theory.md, XDP-9",
    parameters: &[],
    tables: &[RATE],
    make: |values| Box::new(made(values, Conversion::FirstOrder(FirstOrder))),
};

/// Entry of [`super::contracting_area`] in a case file.
pub static CONTRACTING_AREA: LawEntry<RateLaw> = LawEntry {
    name: "contracting-area",
    summary: "In the whole particle, by grains whose surface shrinks as that of cylinders.",
    source: "docs/theory.md, XDP-9",
    parameters: &[],
    tables: &[RATE],
    make: |values| Box::new(made(values, Conversion::ContractingArea(ContractingArea))),
};

/// Entry of [`super::contracting_volume`] in a case file.
pub static CONTRACTING_VOLUME: LawEntry<RateLaw> = LawEntry {
    name: "contracting-volume",
    summary: "In the whole particle, by grains whose surface shrinks as that of spheres.",
    source: "docs/theory.md, XDP-9",
    parameters: &[],
    tables: &[RATE],
    make: |values| {
        Box::new(made(
            values,
            Conversion::ContractingVolume(ContractingVolume),
        ))
    },
};

/// Entry of [`super::nucleation`] in a case file.
pub static NUCLEATION: LawEntry<RateLaw> = LawEntry {
    name: "nucleation",
    summary: "In the whole particle, by nuclei of the product that grow (Avrami and Erofeev).",
    source: "docs/theory.md, XDP-9",
    parameters: &[
        LawParameter {
            name: "exponent",
            dimension: Dimension::NONE,
            bound: Bound::AtLeast(1.0),
            default: None,
            needed_with: None,
            meaning: "Exponent m of Avrami, 1 to 4.",
            example: "2",
        },
        LawParameter {
            name: "nuclei",
            dimension: Dimension::NONE,
            bound: Bound::Within(0.0, 1.0),
            default: Some(1e-3),
            needed_with: None,
            meaning: "Share of the solid that nuclei hold at the start: without any nothing would begin.",
            example: "1e-3",
        },
    ],
    tables: &[RATE],
    make: |values| {
        let law = Nucleation {
            exponent: values[0],
            nuclei: values[1],
        };
        Box::new(made(values, Conversion::Nucleation(law)))
    },
};

/// Entry of [`super::random_pore`] in a case file.
pub static RANDOM_PORE: LawEntry<RateLaw> = LawEntry {
    name: "random-pore",
    summary: "In the whole particle, by the surface of pores that grow and meet (Bhatia and Perlmutter).",
    source: "docs/theory.md, XDP-9",
    parameters: &[LawParameter {
        name: "structure",
        dimension: Dimension::NONE,
        bound: Bound::NotNegative,
        default: None,
        needed_with: None,
        meaning: "Structural parameter psi = 4 pi L (1 - e)/S^2 of the pores at the start; 0 is first order.",
        example: "4.6",
    }],
    tables: &[RATE],
    make: |values| {
        let law = RandomPore {
            structure: values[0],
        };
        Box::new(made(values, Conversion::RandomPore(law)))
    },
};

/// Entry of [`super::equilibrium_pressure`] in a case file.
pub static EQUILIBRIUM_PRESSURE: LawEntry<RateLaw> = LawEntry {
    name: "equilibrium-pressure",
    summary: "At the surface of the grains of a particle, in proportion to what the pressure of the gas that they give off lacks \
              of its equilibrium.",
    source: "docs/theory.md, XDP-9",
    parameters: &[LawParameter {
        name: "grain_diameter",
        dimension: Dimension::LENGTH,
        bound: Bound::Positive,
        default: None,
        needed_with: None,
        meaning: "Diameter of the grains at the start.",
        example: "\"10 um\"",
    }],
    tables: &[SURFACE_RATE],
    make: |values| {
        let rate = values.table(0).cloned().unwrap_or_default();
        Box::new(RateLaw::EquilibriumPressure {
            rate_constant: Arrhenius::from_values(&rate),
            grains: GrainSurface {
                diameter: values[0],
            },
        })
    },
};

const SURFACE_RATE: LawTable = LawTable {
    name: "rate",
    meaning: "Rate constant k = factor T^exponent exp(-activation_energy/RT), by the surface of the grains and the pressure that lacks.",
    example: "{ factor = 1e-6, activation_energy = \"60 kJ/mol\" }",
    parameters: &[
        LawParameter {
            name: "factor",
            dimension: Dimension::NONE,
            bound: Bound::Positive,
            default: None,
            needed_with: None,
            meaning: "A number in mol/m^2/s/Pa.",
            example: "1e-6",
        },
        EXPONENT,
        ACTIVATION_ENERGY,
    ],
    tables: &[],
    ..RATE
};
