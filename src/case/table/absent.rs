//! Quantities that users of the field would state, which no model takes up.

/// Words for the water that a material holds.
const MOISTURE: [&str; 7] = [
    "moisture",
    "moisture_content",
    "water",
    "water_content",
    "liquid_water",
    "H2O",
    "H2O(l)",
];

/// True for a word that means liquid water in a material.
pub(in crate::case) fn is_moisture(word: &str) -> bool {
    MOISTURE.iter().any(|one| one.eq_ignore_ascii_case(word))
}

/// What is said of moisture in a material.
pub(in crate::case) const NO_DRYING: [&str; 2] = [
    "is refused: water of a material is a part of its composition",
    "write composition = { mass = { ..., \"H2O(l)\" = 0.3 } } with the reaction \"H2O(l) <=> H2O\" of law = \"evaporation\", and H2O in gas.species",
];
