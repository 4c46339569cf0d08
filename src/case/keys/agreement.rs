//! Keys of `agreement`.

use super::prelude::*;

#[rustfmt::skip]
const FIELDS: &[Key] = &[
    key("field", Text, Required, "A field that `output` writes, as `compare` names it; no two alike.", "\"gas.temperature\""),
    key("largest", Band, Without("not judged"), "Largest difference of a cell or a particle between pairings in any snapshot: in the unit of the field, or a share of its span over all of them.", "\"2 K\""),
    key("root_mean_square", Band, Without("not judged"), "The same of the root of the mean square over all cells or particles and snapshots.", "\"1 %\""),
];

#[rustfmt::skip]
pub(super) const AGREEMENT: &[Key] = &[
    key("unconverged", Number(D::NONE, NotNegative), Default("0"), "Share of the windows of a run that may end at a limit of iterations; where more do, its pairing does not agree.", "0.05"),
    key("fields", Tables(FIELDS), Without("none"), "Bands of fields.", "[[agreement.fields]]"),
];
