//! Keys of `mesh`.

use super::prelude::*;
use super::zone::{ZONE, ZONE_BOX, ZONE_CYLINDER};
use calcine_coupler::mesh::refine::MOST_LEVELS;

#[rustfmt::skip]
const AXES: &[Key] = &[
    key("x", Grading, Without("equal cells"), "Ratio of the last cell to the first along x, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
    key("y", Grading, Without("equal cells"), "Ratio of the last cell to the first along y, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
    key("z", Grading, Without("equal cells"), "Ratio of the last cell to the first along z, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
];

#[rustfmt::skip]
const AXIS: &[Key] = &[
    key("z", Grading, Without("equal cells"), "Ratio of the last cell to the first along z, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
];

#[rustfmt::skip]
const REFINE: &[Key] = &[
    ZONE_BOX,
    ZONE_CYLINDER,
    key("levels", Whole(1, MOST_LEVELS as i64), Default("1"), "How often cells are split whose centres lie in the zone.", "2"),
];

#[rustfmt::skip]
const CUT: &[Key] = &[
    key("name", Text, Required, "Name of the patch of its surface; bodies of one name make one patch.", "\"crucible\""),
    ZONE_BOX,
    ZONE_CYLINDER,
    key("hollow", Table(ZONE), Without("the whole zone is cut out"), "Cells whose centres lie here stay: the inside of a cup.", "{ cylinder = { from = \"0 0 9 mm\", to = \"0 0 12 mm\", radius = \"2.9 mm\" } }"),
];

#[rustfmt::skip]
const OPENINGS: &[Key] = &[
    key("name", Text, Required, "Name of the patch; openings of one name make one patch.", "\"burners\""),
    ZONE_BOX,
    ZONE_CYLINDER,
];

#[rustfmt::skip]
const BOX: &[Key] = &[
    key("origin", Vector(D::LENGTH), Default("0 0 0 m"), "Corner with the smallest coordinates.", "\"-10 -10 0 mm\""),
    key("size", Vector(D::LENGTH), Required, "Edge lengths along x, y, z.", "\"10 10 110 mm\""),
    key("cells", Wholes(3), Required, "Cells along x, y, z; 2e9 in all at most.", "[1, 1, 11]"),
    key("grading", Table(AXES), Without("equal cells"), "How cell sizes change along axes.", "{ z = 4 }"),
    key("refine", Tables(REFINE), Without("none"), "Zones in which cells are split 2 x 2 x 2; neighbours differ by one level at most.", "[{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" }, levels = 1 }]"),
    key("cut", Tables(CUT), Without("none"), "Bodies in the gas, such as crucibles: cells whose centres lie in a zone are taken out, after refinement, and the faces laid bare are a patch.", "[{ name = \"crucible\", box = { from = \"1 1 4 mm\", to = \"5 5 7 mm\" } }]"),
    key("openings", Tables(OPENINGS), Without("none"), "Parts of the boundary with patches of their own, such as burners: boundary faces whose centres lie in a zone, after refinement. Particles see the side as if it were closed.", "[{ name = \"burners\", box = { from = \"-1 45 195 mm\", to = \"1 55 205 mm\" } }]"),
    key("patches", Texts(6), Without("four times `side`, `bottom`, `top`"), "Patches of x-, x+, y-, y+, z-, z+; equal names make one patch.", "[\"side\", \"side\", \"side\", \"side\", \"low\", \"high\"]"),
];

#[rustfmt::skip]
const CYLINDER: &[Key] = &[
    key("origin", Vector(D::LENGTH), Default("0 0 0 m"), "Centre of the bottom.", "\"0 0 10 mm\""),
    key("diameter", Number(D::LENGTH, Positive), Required, "Diameter.", "\"50 mm\""),
    key("length", Number(D::LENGTH, Positive), Required, "Length along z.", "\"300 mm\""),
    key("cells", Wholes(2), Required, "Cells across the diameter (3 to 20000) and along z.", "[12, 60]"),
    key("grading", Table(AXIS), Without("equal cells"), "How cell sizes change along axes.", "{ z = 4 }"),
    key("refine", Tables(REFINE), Without("none"), "Zones in which cells are split 2 x 2 x 2; neighbours differ by one level at most.", "[{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" }, levels = 1 }]"),
    key("cut", Tables(CUT), Without("none"), "Bodies in the gas, such as crucibles: cells whose centres lie in a zone are taken out, after refinement, and the faces laid bare are a patch.", "[{ name = \"crucible\", box = { from = \"1 1 4 mm\", to = \"5 5 7 mm\" } }]"),
    key("openings", Tables(OPENINGS), Without("none"), "Parts of the boundary with patches of their own, such as burners: boundary faces whose centres lie in a zone, after refinement. Particles see the side as if it were closed.", "[{ name = \"burners\", box = { from = \"-1 45 195 mm\", to = \"1 55 205 mm\" } }]"),
];

#[rustfmt::skip]
pub(super) const MESH: &[Key] = &[
    key("box", Table(BOX), OneOf, "A box, generated. Either this or `mesh.polymesh`.", "{ size = \"10 10 110 mm\", cells = [1, 1, 11] }"),
    key("cylinder", Table(CYLINDER), OneOf, "An upright cylinder, generated as an O-grid; patches `side`, `bottom`, `top`.", "{ diameter = \"50 mm\", length = \"300 mm\", cells = [12, 60] }"),
    key("polymesh", Path, OneOf, "An OpenFOAM polyMesh folder. Either this or `mesh.box`.", "\"constant/polyMesh\""),
];
