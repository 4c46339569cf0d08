//! Keys of `materials` and `solids`.

use super::prelude::*;
use crate::laws;

#[rustfmt::skip]
const COMPOSITION: &[Key] = &[
    key("mole", ByName(D::NONE), OneOf, "Moles by the names of solids, in any ratio. Either this or `mass`.", "{ Fe2O3 = 0.7, Fe3O4 = 0.3 }"),
    key("mass", ByName(D::NONE), OneOf, "Mass fractions by the names of solids. Either this or `mole`.", "{ CaCO3 = 1 }"),
];

#[rustfmt::skip]
const HEAT_CAPACITY: &[Key] = &[
    key("molar_mass", Number(D::MOLAR_MASS, Positive), Required, "Molar mass that the polynomials are of.", "\"55.845 g/mol\""),
    key("ranges", Vector(D::TEMPERATURE), Required, "Lowest, common and highest temperature of the two polynomials; c_p is constant beyond.", "\"200 1000 6000 K\""),
    key("low", Numbers(7), Required, "NASA's coefficients a1 to a7 below the common temperature.", "[2.5, 0, 0, 0, 0, 0, 0]"),
    key("high", Numbers(7), Required, "NASA's coefficients a1 to a7 above it.", "[2.5, 0, 0, 0, 0, 0, 0]"),
];

#[rustfmt::skip]
const SIZE: &[Key] = &[
    key("densities", ByName(D::DENSITY), Without("required with `densities`"), "Density of each solid that the particles hold or come to hold, with the pores that it has in them; together they give the material's density at the start.", "{ CaCO3 = \"2700 kg/m^3\", CaO = \"1600 kg/m^3\" }"),
    key("least_diameter", Number(D::LENGTH, Positive), Without("required but for `constant-diameter`"), "Below it no particle shrinks: from there on its density falls.", "\"1 mm\""),
];

#[rustfmt::skip]
const GRADING: &[Key] = &[
    key("thiele", Number(D::NONE, Between(1.0, 1e5)), Required, "Thiele number R sqrt(k/D) of a layer in which concentrations fall as exp(-thiele s/R) at the depth s: shells get thicker as exp(thiele s/(2 R)), an eleventh of them evenly.", "30"),
];

#[rustfmt::skip]
const RADIAL: &[Key] = &[
    key("shells", Whole(3, 1000), Default("30"), "Number of shells.", "40"),
    key("grading", Either(&Number(D::NONE, Between(1.0, 1000.0)), &Table(GRADING)), Default("4"), "How many times as thick as the outermost shell the innermost one is, or the layer below the surface that shells are to resolve.", "10"),
    key("true_densities", ByName(D::DENSITY), Without("required where reactions exchange gas"), "Density of each solid itself, without pores, that the particles hold or come to hold; what they leave of the volume are the pores.", "{ CaCO3 = \"2711 kg/m^3\", CaO = \"3340 kg/m^3\" }"),
    key("pore_diameter", Number(D::LENGTH, Positive), Without("required where reactions exchange gas"), "Diameter of the pores, by which molecules meet their walls.", "\"1 um\""),
    key("tortuosity", Number(D::NONE, AtLeast(1.0)), Without("required where reactions exchange gas"), "Tortuosity t: gases diffuse by the porosity over t.", "2"),
    key("permeability", Law(laws::permeability, &[]), Without("required where reactions exchange gas"), "Permeability to gas that flows by pressure.", "{ law = \"constant\", value = \"1e-15 m^2\" }"),
    key("conduction", Law(laws::porous_conductivity, &[]), Without("the material's conductivity is that of its particles"), "How the material's conductivity and the pores make that of a particle.", "{ law = \"parallel\" }"),
    key("temperature_error", Number(D::TEMPERATURE, Positive), Default("1 K"), "Error of the mean temperature in a step within a window.", "\"0.1 K\""),
    key("conversion_error", Number(D::NONE, Within(0.0, 1.0)), Default("1e-3"), "Error of what reactions turn over in such a step, as a share of the particle's solids.", "1e-4"),
    key("turn_temperature", Number(D::TEMPERATURE, Positive), Default("5 K"), "With `auto`: difference of temperature between centre and surface from which on a particle has its shells.", "\"1 K\""),
    key("turn_pressure", Number(D::NONE, Positive), Default("0.05"), "With `auto`: the same of the partial pressure of a gas, as a share of its own at the surface where it goes in, and of the pressure where it comes out.", "0.02"),
];

#[rustfmt::skip]
pub(super) const MATERIALS: &[Key] = &[
    key("density", Number(D::DENSITY, Positive), Required, "Density.", "\"2500 kg/m^3\""),
    key("composition", Table(COMPOSITION), OneOf, "What the material is made of, where it reacts: mass fractions of solids, which sum to 1, or moles in any ratio. Either this or `heat_capacity`.", "{ mass = { Fe2O3 = 0.95, Al2O3 = 0.05 } }"),
    key("heat_capacity", Either(&Curve(D::HEAT_CAPACITY, Positive), &Table(HEAT_CAPACITY)), OneOf, "Specific heat capacity; linear between points, constant outside them; or NASA's polynomials as a table.", "[[\"300 K\", \"780 J/kg/K\"], [\"800 K\", \"1150 J/kg/K\"]]"),
    key("size", Law(laws::size, SIZE), Without("diameters stay"), "How particles of the material take up room while they react; goes with `composition`.", "{ law = \"constant-density\", least_diameter = \"1 mm\" }"),
    key("inside", Choice(words::<Inside>), Default("thin"), "What is inside of particles: `thin`, one temperature and the amounts of the solids; `radial`, shells along the radius with gas in their pores; `auto`, one shell, and all of them for good from where the difference inside is too large.", "\"radial\""),
    key("radial", Table(RADIAL), Without("required with `inside` other than `thin` where reactions exchange gas"), "How particles with shells are computed, where `inside` is not `thin`.", "{ shells = 40 }"),
    key("used_up", Number(D::NONE, Between(0.0, 1.0)), Default("1e-6"), "Share of the mass with which a particle came below which it is used up by reactions and goes out of the run; goes with `composition`. Moving particles need one at which they are not yet too light for the time step of contacts.", "0.01"),
    key("conductivity", Curve(D::CONDUCTIVITY, Positive), Without("not known"), "Thermal conductivity; linear between points, constant outside them.", "[[\"300 K\", \"80 W/m/K\"], [\"1000 K\", \"33 W/m/K\"]]"),
    key("emissivity", Number(D::NONE, UpTo(0.0, 1.0)), Without("not known"), "Emissivity of the surface, above 0 and up to 1.", "0.9"),
    key("young", Number(D::PRESSURE, Positive), Without("not known"), "Young's modulus by which contacts are computed.", "\"50 MPa\""),
    key("real_young", Number(D::PRESSURE, Positive), Without("that of `young`"), "Young's modulus of the real material, where `young` is softened; by it contacts conduct where `laws.conduction.area` says so.", "\"210 GPa\""),
    key("poisson", Number(D::NONE, Within(-1.0, 0.5)), Without("not known"), "Poisson's ratio, above -1 and below 0.5.", "0.22"),
];

#[rustfmt::skip]
pub(super) const SOLIDS: &[Key] = &[
    key("formula", Text, Required, "Chemical formula.", "\"SiO2\""),
    key("formation_enthalpy", Number(D::MOLAR_ENERGY, Any), Required, "Enthalpy of formation at 298.15 K.", "\"-910.7 kJ/mol\""),
    key("entropy", Number(D::MOLAR_ENTROPY, Positive), Required, "Entropy at 298.15 K and 1 bar.", "\"41.5 J/mol/K\""),
    key("heat_capacity", Curve(D::HEAT_CAPACITY, Positive), Required, "Specific heat capacity; linear between points, constant outside them.", "[[\"300 K\", \"745 J/kg/K\"], [\"800 K\", \"1230 J/kg/K\"]]"),
];
