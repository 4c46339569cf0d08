//! Keys of `output` and `probes`.

use super::prelude::*;

#[rustfmt::skip]
const MEANS: &[Key] = &[
    key("from", Number(D::TIME, NotNegative), Without("the start"), "Process time from which means are taken.", "\"1 s\""),
    key("to", Number(D::TIME, Positive), Without("the end"), "Process time up to which they are taken.", "\"5 s\""),
    key("gas", Choices(&["temperature", "velocity", "pressure", "density", "void_fraction", "mass_fractions", "turbulence"]), Default("velocity"), "Gas fields, as in `output.gas`.", "[\"velocity\", \"pressure\"]"),
    key("particles", Choices(&["temperature", "velocity"]), Without("none"), "Quantities of particles, averaged over time and the mass whose centres a cell of the gas holds; with them comes the mean mass of particles per volume of the cell.", "[\"velocity\"]"),
];

#[rustfmt::skip]
pub(super) const OUTPUT: &[Key] = &[
    key("every", Number(D::TIME, Positive), Required, "A snapshot each so much process time, and one at the start and the end.", "\"60 s\""),
    key("series_every", Number(D::TIME, Positive), Without("with every snapshot"), "A row of the time series each so much process time.", "\"1 s\""),
    key("gas", Choices(&["temperature", "velocity", "pressure", "density", "void_fraction", "mass_fractions", "turbulence"]), Default("temperature"), "Gas fields; `mass_fractions` of each species of a mixture, by its name; `turbulence`: `turbulent_energy`, `dissipation` and `eddy_viscosity` of a turbulent gas, the last of which is the void fraction times the eddy viscosity of the gas.", "[\"temperature\", \"velocity\"]"),
    key("particles", Choices(&["temperature", "velocity", "heat", "force", "void_fraction", "slip", "mass", "solids", "inside"]), Default("temperature"), "Particle fields; `force` is that of the gas, `void_fraction` and `slip` what the laws saw, `solids` the mass fractions of what particles that react are made of, `inside` all columns that the models of the particles show.", "[\"temperature\"]"),
    key("means", Table(MEANS), Without("none"), "Time means of fields and the root mean squares of what fluctuates about them, each window with its process time and the fields at its end: `means.vtu` and the group `means` of `results.h5`, written when the interval is over.", "{ from = \"1 s\", to = \"5 s\", gas = [\"velocity\", \"pressure\"] }"),
];

#[rustfmt::skip]
const LINE: &[Key] = &[
    key("from", Vector(D::LENGTH), Required, "First point.", "\"0 0 0 mm\""),
    key("to", Vector(D::LENGTH), Required, "Last point.", "\"0 0 300 mm\""),
    key("points", Whole(2, 1_000_000), Required, "Number of points.", "100"),
];

#[rustfmt::skip]
pub(super) const PROBES: &[Key] = &[
    key("name", Text, Required, "Name; no two alike.", "\"axis\""),
    key("of", Choices(&["gas", "particles"]), Default("gas"), "What is sampled: `gas` (the cell that holds a point), `particles` (the one that holds a point, else the nearest whose surface is within its own diameter).", "[\"gas\", \"particles\"]"),
    key("line", Table(LINE), OneOf, "Points on a line. One of `line`, `point`, `points`.", "{ from = \"0 0 0 mm\", to = \"0 0 300 mm\", points = 100 }"),
    key("point", Vector(D::LENGTH), OneOf, "A single point. One of `line`, `point`, `points`.", "\"0 0 10 mm\""),
    key("points", Vectors(D::LENGTH), OneOf, "Points. One of `line`, `point`, `points`.", "[\"0 0 10 mm\", \"0 0 20 mm\"]"),
];
