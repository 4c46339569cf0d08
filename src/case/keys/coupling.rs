//! Keys of `coupling`.

use super::prelude::*;
use super::zone::ZONE;

#[rustfmt::skip]
const SMOOTHER: &[Key] = &[
    key("max_solid_fraction", Number(D::NONE, Within(0.0, 1.0)), Default("0.64"), "Largest solid fraction of a cell, between 0 and 1.", "0.64"),
    key("tolerance", Number(D::NONE, Within(0.0, 1.0)), Default("1e-4"), "Excess left at the end, as a share of the solid volume.", "1e-4"),
    key("diffusion_length", Number(D::LENGTH, NotNegative), Without("half the mean diameter where that is above a third of the cell size, else 0 m"), "Length of the diffusion of the solid fraction, zero or above.", "\"0 mm\""),
    key("excluded", Tables(ZONE), Without("none"), "Zones, such as burner ducts, into and out of which the smoother moves nothing: cells whose centres lie there.", "[{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" } }]"),
];

#[rustfmt::skip]
const EXCHANGE: &[Key] = &[
    key("tolerance", Number(D::NONE, Within(0.0, 1.0)), Default("1e-3"), "A window is repeated while the relative mismatch of the exchange is above this.", "1e-3"),
    key("attempts", Whole(1, 1000), Default("10"), "Attempts per window at most.", "10"),
    key(
        "cuts",
        Whole(0, 30),
        Default("12"),
        "How often a window over which particles that react do not settle with their gas is halved, where no particle moves.",
        "0",
    ),
];

#[rustfmt::skip]
pub(super) const COUPLING: &[Key] = &[
    key("mapping", Choice(words::<MappingSpec>), Without("`linear` for parcels; required for others"), "Mapping of a particle onto cells: exact volumes, satellite points, its centre, or linear weights of its centre, whatever its size.", "\"overlap\""),
    key("smoother", Table(SMOOTHER), Without("see its keys"), "Smoother of the solid fraction.", "{ max_solid_fraction = 0.64 }"),
    key("exchange", Table(EXCHANGE), Without("see its keys"), "Repetition of windows.", "{ tolerance = 1e-3, attempts = 10 }"),
    key("window_drag", Choice(words::<WindowDrag>), Default("constant"), "How drag acts on particles that move within a window: as a constant force, the mean over the window, or following each particle's own velocity step by step. External particles must take it so.", "\"following\""),
    key("deadline", Number(D::TIME, Positive), Default("60 s"), "The longest wall time that a solver may stay silent.", "\"60 s\""),
];
