//! Keys of `gas`.

use super::prelude::*;
use super::walls::ROTATING;
use crate::laws;

#[rustfmt::skip]
const INITIAL_COMPOSITION: &[Key] = &[
    key("mole", ByName(D::NONE), OneOf, "Moles by species, in any ratio; what is not named is 0. Either this or `mass`.", "{ N2 = 0.79, O2 = 0.21 }"),
    key("mass", ByName(D::NONE), OneOf, "Mass fractions by species, which sum to 1. Either this or `mole`.", "{ N2 = 1 }"),
];

#[rustfmt::skip]
const INITIAL: &[Key] = &[
    key("temperature", Number(D::TEMPERATURE, Positive), Required, "Temperature.", "\"300 K\""),
    key("pressure", Number(D::PRESSURE, Positive), Required, "Absolute pressure.", "\"1 atm\""),
    key("composition", Table(INITIAL_COMPOSITION), Without("a single gas"), "Composition at the start, by amounts (`mole`) or masses (`mass`).", "{ mole = { N2 = 0.79, O2 = 0.21 } }"),
    key("velocity", Vector(D::VELOCITY), Default("0 0 0 m/s"), "Velocity.", "\"0 0 0.5 m/s\""),
];

#[rustfmt::skip]
const SPECIES_DATA_TRANSPORT: &[Key] = &[
    key("diameter", Number(D::LENGTH, Positive), Without("that of the file"), "Collision diameter of Lennard and Jones' potential.", "\"3.971e-10 m\""),
    key("well_depth", Number(D::TEMPERATURE, Positive), Without("that of the file"), "Depth of the potential over Boltzmann's constant.", "\"280.8 K\""),
    key("diffusion_volume", Number(D::NONE, Positive), Without("the sum of its atoms' (C, H, O, N, S)"), "Diffusion volume of Fuller, Schettler and Giddings.", "41.04"),
];

#[rustfmt::skip]
const SPECIES_DATA: &[Key] = &[
    key("thermo", Path, Required, "Their thermodynamics: NASA's seven coefficients in a file of Cantera (.yaml), which may have the transport data too, or of CHEMKIN (any other name).", "\"ethene.yaml\""),
    key("transport_file", Path, Without("none"), "CHEMKIN's transport data (`tran.dat`) of the species in `thermo`: their well depths and diameters count in place of those of that file.", "\"tran.dat\""),
    key("transport", Named(SPECIES_DATA_TRANSPORT), Without("that of the file"), "What the file does not say of the molecules, or what counts in its place; by species.", "{ C2H4 = { diameter = \"3.971e-10 m\", well_depth = \"280.8 K\" } }"),
];

#[rustfmt::skip]
const CHEMISTRY_REACTIONS_RATE: &[Key] = &[
    key("factor", Number(D::NONE, Positive), Required, "In mol, m and s, of the rate in mol/m^3/s by concentrations in mol/m^3.", "2.75e6"),
    key("exponent", Number(D::NONE, Any), Default("0"), "Exponent of the temperature in K.", "-1"),
    key("activation_energy", Number(D::MOLAR_ENERGY, Any), Default("0 J/mol"), "Activation energy.", "\"83.6 kJ/mol\""),
    key("orders", ByName(D::NONE), Without("the numbers of the left side"), "Order of each gas, of all of them. Below 1e-6 mol/m^3 a power of an order below one goes on as a straight line; a negative one only of a gas that is always there.", "{ CH4 = 0.5, O2 = 1.25 }"),
];

#[rustfmt::skip]
const CHEMISTRY_REACTIONS_THIRD_BODY: &[Key] = &[
    key("efficiencies", ByName(D::NONE), Without("`others` for all"), "Efficiencies by species.", "{ H2O = 6, CO2 = 2 }"),
    key("others", Number(D::NONE, Any), Default("1"), "Efficiency of all others.", "1"),
];

#[rustfmt::skip]
const CHEMISTRY_REACTIONS: &[Key] = &[
    key("name", Text, Required, "Its name.", "\"shift\""),
    key("equation", Text, Required, "Moles of gases of `gas.species`, with => (one way) or <=> (both ways, by the Gibbs energies); balanced. The last species of the gas reacts in none.", "\"CO + H2O <=> CO2 + H2\""),
    key("rate", Table(CHEMISTRY_REACTIONS_RATE), Required, "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.", "{ factor = 2.75e6, activation_energy = \"83.6 kJ/mol\" }"),
    key("third_body", Table(CHEMISTRY_REACTIONS_THIRD_BODY), Without("none"), "The rate is also proportional to the concentration of all gases, each by its efficiency.", "{ efficiencies = { H2O = 6 } }"),
    key("heat", Number(D::MOLAR_ENERGY, Any), Without("not stated"), "Heat that the reaction takes up at 298.15 K, to be compared with that of the enthalpies of formation, which counts; more than 2 % off is an error.", "\"-41.2 kJ/mol\""),
];

#[rustfmt::skip]
const CHEMISTRY: &[Key] = &[
    key("mechanism", Text, OneOf, "`jones-lindstedt` (refined), `jones-lindstedt-original`, or a file of Cantera (.yaml) or CHEMKIN (any other name). Either this or `reactions`.", "\"jones-lindstedt\""),
    key("thermo", Path, Without("that of the mechanism's file"), "A CHEMKIN file of thermodynamics; those of `gas.species` count, the file's must agree.", "\"therm.dat\""),
    key("reactions", Tables(CHEMISTRY_REACTIONS), OneOf, "Reactions of the case's own. Either this or `mechanism`.", "[{ name = \"shift\", equation = \"CO + H2O <=> CO2 + H2\", rate = { factor = 2.75e6, activation_energy = \"83.6 kJ/mol\" } }]"),
    key("model", Choice(words::<CombustionModel>), Default("laminar"), "A cell is mixed; or the partially stirred reactor: only what turbulence mixes reacts.", "\"laminar\""),
    key("mixing_constant", Number(D::NONE, Positive), Default("1"), "C_mix of the partially stirred reactor.", "1"),
    key("tolerance", Number(D::NONE, UpTo(0.0, 0.1)), Default("1e-6"), "Error of a step of the integration, relative to temperature and each mass fraction.", "1e-6"),
    key("fraction_tolerance", Number(D::NONE, UpTo(0.0, 0.1)), Default("1e-10"), "Error of a step in a mass fraction that counts as none.", "1e-10"),
    key("negligible", Number(D::NONE, UpTo(0.0, 1e-3)), Default("1e-12"), "Change of a mass fraction, up to 1e-3, over a step of the gas below which reactions are not integrated.", "1e-12"),
];

#[rustfmt::skip]
const CONSTANT: &[Key] = &[
    key("density", Number(D::DENSITY, Positive), Required, "Density.", "\"1.2 kg/m^3\""),
    key("heat_capacity", Number(D::HEAT_CAPACITY, Positive), Required, "Specific heat capacity c_p.", "\"1005 J/kg/K\""),
    key("viscosity", Number(D::VISCOSITY, Positive), Required, "Viscosity.", "\"18.5e-6 Pa s\""),
    key("conductivity", Number(D::CONDUCTIVITY, Positive), Required, "Thermal conductivity.", "\"0.026 W/m/K\""),
];

#[rustfmt::skip]
const PROPERTIES: &[Key] = &[
    key("molar_mass", Number(D::MOLAR_MASS, Positive), Required, "Molar mass.", "\"28.96 g/mol\""),
    key("heat_capacity", Number(D::HEAT_CAPACITY, Positive), Required, "Specific heat capacity c_p; above R/M.", "\"1005 J/kg/K\""),
    key("viscosity", Number(D::VISCOSITY, Positive), Required, "Viscosity at `viscosity_at`.", "\"18.5e-6 Pa s\""),
    key("viscosity_at", Number(D::TEMPERATURE, Positive), Required, "Temperature of `viscosity`.", "\"300 K\""),
    key("sutherland_temperature", Number(D::TEMPERATURE, Positive), Required, "Temperature of Sutherland's law.", "\"120 K\""),
];

#[rustfmt::skip]
const TURBULENCE_INITIAL: &[Key] = &[
    key("energy", Number(D::ENERGY_OF_MASS, Positive), Required, "Turbulent energy k, above 0.", "\"0.01 m^2/s^2\""),
    key("length_scale", Number(D::LENGTH, Positive), Required, "Length scale L; the dissipation is 0.09^0.75 k^1.5/L.", "\"5 mm\""),
];

#[rustfmt::skip]
const TURBULENCE: &[Key] = &[
    key("model", Choice(words::<TurbulenceModel>), Required, "The standard k-epsilon model with wall functions (on walls with `no-slip` or `moving`, outside the bed), or none.", "\"k-epsilon\""),
    key("initial", Table(TURBULENCE_INITIAL), Without("none; `k-epsilon` needs it"), "Eddies at the start, everywhere.", "{ energy = \"0.01 m^2/s^2\", length_scale = \"5 mm\" }"),
    key("prandtl", Number(D::NONE, Positive), Default("0.85"), "Turbulent Prandtl number: eddies carry heat with c_p times their viscosity over this.", "0.9"),
    key("schmidt", Number(D::NONE, Positive), Default("0.7"), "Turbulent Schmidt number of all species.", "0.7"),
    key("bed", Law(laws::bed_eddies, &[]), Without("none: they end at the bed"), "Eddies in the bed, that is, where the solid fraction is above 0.1: what the flow through its pores makes of them. With a law they carry momentum, heat and species there as outside, and mix what `gas.chemistry.model = \"pasr\"` lets react; there are no wall functions in the bed. Without one none are made, none carry anything, and gas that burns in the bed counts as mixed.", "{ law = \"nakayama-kuwahara\" }"),
    key("iterations", Whole(1, 1_000_000), Default("1000"), "Iterations of the linear solvers of k and epsilon at most. Windows in which they end above their tolerance are counted as `turbulence_solver`.", "200"),
];

#[rustfmt::skip]
const PATCH_INLET_COMPOSITION: &[Key] = &[
    key("mole", ByName(D::NONE), OneOf, "Mole fractions by species. Either this or `mass`.", "{ CO2 = 1 }"),
    key("mass", ByName(D::NONE), OneOf, "Mass fractions by species. Either this or `mole`.", "{ CO2 = 1 }"),
];

#[rustfmt::skip]
const PATCH_INLET_TURBULENCE: &[Key] = &[
    key("intensity", Number(D::NONE, Positive), Required, "Root mean square of one component of the fluctuation over the interstitial speed.", "0.05"),
    key("length_scale", Number(D::LENGTH, Positive), Required, "Length scale, see `gas.turbulence.initial`; some 0.07 of the diameter of a long pipe.", "\"5 mm\""),
];

#[rustfmt::skip]
const PATCH_INLET: &[Key] = &[
    key("superficial_velocity", Schedule(D::VELOCITY, NotNegative), OneOf, "Superficial velocity into the domain, zero or above, of gas at the pressure of `gas.initial`. Either this or `mass_flow`.", "\"0.5 m/s\""),
    key("mass_flow", Schedule(D::MASS_FLOW, NotNegative), OneOf, "Mass flow through the whole patch, zero or above, evenly spread. Either this or `superficial_velocity`.", "\"2 kg/h\""),
    key("composition", Dated(PATCH_INLET_COMPOSITION), Without("a single gas"), "Composition of the gas that enters, as `gas.initial.composition`.", "[[\"0 s\", { mole = { N2 = 1 } }], [\"10 s\", { mole = { CO2 = 1 } }]]"),
    key("temperature", Schedule(D::TEMPERATURE, Positive), Required, "Temperature of the gas that enters.", "[[\"0 s\", \"300 K\"], [\"10 s\", \"400 K\"]]"),
    key("scalars", Choice(words::<InletScalars>), Default("flux"), "How temperature and composition are given: `flux`, exactly the flow of the stated gas enters, and nothing diffuses or is conducted beside it; `value`, the face has the stated values, and species diffuse and heat is conducted through it.", "\"value\""),
    key("turbulence", Table(PATCH_INLET_TURBULENCE), Without("none; a turbulent gas needs it"), "Eddies of the gas that enters.", "{ intensity = 0.05, length_scale = \"5 mm\" }"),
];

#[rustfmt::skip]
const PATCH_BACKFLOW: &[Key] = &[
    key("temperature", Schedule(D::TEMPERATURE, Positive), Required, "Temperature of the gas that comes back in.", "\"300 K\""),
    key("composition", Dated(PATCH_INLET_COMPOSITION), Without("a single gas"), "Composition of the gas that comes back in, as `gas.initial.composition`.", "{ mole = { N2 = 0.79, O2 = 0.21 } }"),
];

#[rustfmt::skip]
const PATCH_OUTLET: &[Key] = &[
    key("pressure", Schedule(D::PRESSURE, Positive), Required, "Absolute pressure.", "\"1 atm\""),
    key("backflow", Table(PATCH_BACKFLOW), Without("the gas of the cell behind the face"), "Gas that comes back in where the flow turns round, with the flow alone.", "{ temperature = \"300 K\" }"),
];

#[rustfmt::skip]
const PATCH_OPENING: &[Key] = &[
    key("pressure", Schedule(D::PRESSURE, Positive), Required, "Absolute pressure of the surroundings, at rest, at the height of `pressure_at`.", "\"1 atm\""),
    key("pressure_at", Vector(D::LENGTH), Default("0 0 0 m"), "Point at whose height along gravity the surroundings have `pressure`; above and below it they have that of their own weight. Openings of one point, one pressure and one gas open to one atmosphere.", "\"0 0 1 m\""),
    key("temperature", Schedule(D::TEMPERATURE, Positive), Required, "Temperature of the surroundings.", "\"300 K\""),
    key("composition", Dated(PATCH_INLET_COMPOSITION), Without("a single gas"), "Composition of the surroundings, as `gas.initial.composition`.", "{ mole = { N2 = 0.79, O2 = 0.21 } }"),
];

#[rustfmt::skip]
const PATCH_WALL_VELOCITY: &[Key] = &[
    key("moving", Vector(D::VELOCITY), OneOf, "Velocity of a wall that slides in its own plane; gas sticks to it. Either this or `rotating`.", "\"0.1 0 0 m/s\""),
    key("rotating", Table(ROTATING), OneOf, "The wall turns within itself about an axis, as a drum or its ends do; gas sticks to it. Either this or `moving`.", "{ point = \"0 0 0 m\", angular_velocity = \"0 0 15 rpm\" }"),
];

#[rustfmt::skip]
const STATION: &[Key] = &[
    key("at", Number(D::LENGTH, Any), Required, "Coordinate along the axis, measured from the origin.", "\"200 mm\""),
    key("temperature", Schedule(D::TEMPERATURE, Positive), Required, "Temperature of the wall there.", "[[\"0 s\", \"300 K\"], [\"10 min\", \"600 K\"]]"),
];

#[rustfmt::skip]
const ALONG: &[Key] = &[
    key("axis", Vector(D::NONE), Required, "Direction of the axis; of any length.", "\"0 0 1\""),
    key("stations", Tables(STATION), Required, "Places along the axis, in ascending order, two at least: the temperature is linear between them and constant beyond the first and the last.", "[{ at = \"0 mm\", temperature = \"300 K\" }, { at = \"200 mm\", temperature = \"600 K\" }]"),
];

#[rustfmt::skip]
const PATCH_WALL_HEAT: &[Key] = &[
    key("temperature", Schedule(D::TEMPERATURE, Positive), OneOf, "Temperature of the wall. One of `temperature`, `along`, `flux`, `coefficient`, `body`.", "\"350 K\""),
    key("along", Table(ALONG), OneOf, "Temperature of the wall along an axis, and over time. One of `temperature`, `along`, `flux`, `coefficient`, `body`.", "{ axis = \"0 0 1\", stations = [{ at = \"0 mm\", temperature = \"300 K\" }, { at = \"200 mm\", temperature = \"600 K\" }] }"),
    key("flux", Schedule(D::HEAT_FLUX, Any), OneOf, "Heat flux into the gas per area of wall. One of `temperature`, `along`, `flux`, `coefficient`, `body`.", "\"1 kW/m^2\""),
    key("coefficient", Schedule(D::HEAT_TRANSFER, NotNegative), OneOf, "Overall coefficient between the inner face of the wall and surroundings of `ambient`. One of `temperature`, `along`, `flux`, `coefficient`, `body`.", "\"10 W/m^2/K\""),
    key("ambient", Schedule(D::TEMPERATURE, Positive), With("coefficient"), "Temperature of the surroundings.", "\"300 K\""),
    key("body", Text, OneOf, "One of `bodies`, which stores the heat that the wall takes from the gas. One of `temperature`, `along`, `flux`, `coefficient`, `body`.", "\"crucible\""),
    key("film", Number(D::HEAT_TRANSFER, Positive), Without("gas conducts up to the surface; with `body`"), "Coefficient of a film between the surface of the body and the gas, beside the gas of half a cell.", "\"50 W/m^2/K\""),
];

#[rustfmt::skip]
const PATCH_WALL: &[Key] = &[
    key("velocity", Either(&Choice(words::<WallVelocity>), &Table(PATCH_WALL_VELOCITY)), Required, "Gas velocity at the wall.", "\"no-slip\""),
    key("heat", Either(&Choice(words::<Adiabatic>), &Table(PATCH_WALL_HEAT)), Required, "Heat through the wall.", "\"adiabatic\""),
];

#[rustfmt::skip]
const PATCH_PERIODIC: &[Key] = &[
    key("with", Text, Required, "Name of the partner. It may state this patch as its own partner, and needs no condition otherwise.", "\"right\""),
];

#[rustfmt::skip]
const PATCH: &[Key] = &[
    key("inlet", Table(PATCH_INLET), OneOf, "Gas flows in. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{ superficial_velocity = \"0.5 m/s\", temperature = \"400 K\" }"),
    key("outlet", Table(PATCH_OUTLET), OneOf, "Gas flows out. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{ pressure = \"1 atm\" }"),
    key("opening", Table(PATCH_OPENING), OneOf, "Gas flows out to surroundings at rest, or in from them with their total pressure, as the pressures have it. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{ pressure = \"1 atm\", temperature = \"300 K\" }"),
    key("wall", Table(PATCH_WALL), OneOf, "A wall. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{ velocity = \"slip\", heat = \"adiabatic\" }"),
    key("symmetry", Table(&[]), OneOf, "A plane of symmetry. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{}"),
    key("periodic", Table(PATCH_PERIODIC), OneOf, "What leaves through it comes in through its partner; both are planes normal to the same coordinate axis, at the ends of the mesh, with the same faces. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{ with = \"right\" }"),
    key("empty", Table(&[]), OneOf, "Both sides of a plane flow, one cell apart: gas does not flow from one to the other. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{}"),
    key("wedge", Table(&[]), OneOf, "One of the two sides of a slice of an axisymmetric flow without swirl, one cell apart. One of `inlet`, `outlet`, `opening`, `wall`, `symmetry`, `periodic`, `empty`, `wedge`.", "{}"),
];

#[rustfmt::skip]
const SCHEMES: &[Key] = &[
    key("central", Number(D::NONE, Between(0.0, 1.0)), OneOf, "Share of central differences; the rest is upwind. Either this or `limited_linear`.", "0.9"),
    key("limited_linear", Number(D::NONE, Between(0.0, 1.0)), OneOf, "Central differences limited with this coefficient, OpenFOAM's `limitedLinear`: bounded at 1, less limited below it. Either this or `central`.", "1"),
];

#[rustfmt::skip]
const CONTROLS: &[Key] = &[
    key("outer_iterations", Whole(1, 10_000), Default("30"), "Outer iterations per window at most.", "30"),
    key("convection", Either(&Choice(words::<Convection>), &Table(SCHEMES)), Default("van-leer"), "How velocity, enthalpy and composition are carried to faces: second order with van Leer's limiter; first-order upwind; or central differences of velocity and enthalpy, which no limiter bounds, and of composition van Leer's limiter; `{ central = 0.9 }` mixes them with upwind, `{ limited_linear = 1 }` limits them.", "\"upwind\""),
    key("time_scheme", Choice(words::<TimeScheme>), Default("euler"), "How velocity, enthalpy and composition are stepped over a window at an acceleration of 1: implicit Euler, first order; or two implicit stages, second order (SDIRK2). Implicit Euler under time splitting, where the gas reacts, and where particles give or take species.", "\"sdirk2\""),
    key("pressure_corrections", Whole(1, 10_000), Default("2"), "Pressure corrections per outer iteration; twice as many where friction exceeds the inertia and drag of a cell with an oblique line to a neighbour.", "2"),
    key("most_pressure_corrections", Whole(1, 10_000), Default("16"), "Where at the pace of momentum and continuity so far `outer_iterations` would not reach `outer_tolerance`, not even accelerated (Anderson), the pressure corrections are doubled, up to this many; with that of `pressure_corrections` or less they stay as they are.", "16"),
    key("outer_tolerance", Number(D::NONE, UpTo(0.0, 0.1)), Default("1e-6"), "The outer iterations end below this scaled residual.", "1e-6"),
    key("linear_tolerance", Number(D::NONE, Positive), Without("natively as close as the outer loop can make use of, in calcineGasFoam 1e-13"), "Tolerance of the linear solvers, relative to what moves.", "1e-13"),
];

#[rustfmt::skip]
pub(super) const GAS: &[Key] = &[
    key("mixture", Text, Required, "`air`, any name together with `gas.properties` or `gas.constant`, or `vacuum`: no gas, no `initial`, no `patch`, and laws `none` of drag and heat transfer.", "\"air\""),
    key("initial", Table(INITIAL), Without("none in a vacuum; else required"), "The gas at the start, everywhere.", "{ temperature = \"300 K\", pressure = \"1 atm\" }"),
    key("gravity", Vector(D::ACCELERATION), Default("0 0 0 m/s^2"), "Gravity on gas and free particles.", "\"0 0 -9.81 m/s^2\""),
    key("pressure_gradient", Vector(D::PRESSURE_GRADIENT), Default("0 0 0 Pa/m"), "Mean pressure gradient beside that of the pressure field: it drives gas along periodic directions, towards where it falls.", "\"-1.2 0 0 Pa/m\""),
    key("held", Truth, Default("false"), "The gas stays as it is at the start, at any exchange: superficial velocity, temperature, and a pressure gradient of its own weight. No gas solver runs.", "true"),
    key("species", Texts(0), Without("a single gas"), "Species of a mixture of ideal gases: N2, O2, Ar, CO2, H2O, CO, H2, CH4 are built in, others are of `species_data`; with `gas.schmidt`, and a composition wherever gas stands at the start or flows in.", "[\"N2\", \"O2\"]"),
    key("schmidt", Number(D::NONE, Positive), With("species"), "Schmidt number of all species: they diffuse alike, with viscosity over density over this.", "0.7"),
    key("species_data", Table(SPECIES_DATA), Without("built-in species alone"), "Where the species come from that are not built in.", "{ thermo = \"ethene.yaml\" }"),
    key("chemistry", Table(CHEMISTRY), Without("the gas does not react with itself"), "Reactions of the gas with itself; of a mixture of `gas.species`.", "{ mechanism = \"jones-lindstedt\" }"),
    key("constant", Table(CONSTANT), Without("an ideal gas"), "A fluid of constant properties; not with `gas.properties`. Its enthalpy is c_p (T - 298.15 K).", "[gas.constant]"),
    key("properties", Table(PROPERTIES), Without("those of `gas.mixture`"), "An ideal gas by its properties.", "[gas.properties]"),
    key("turbulence", Table(TURBULENCE), Without("a laminar gas"), "Eddies, outside the bed (where the solid fraction is 0.1 or less), and in it by `bed`.", "[gas.turbulence]"),
    key("patch", Named(PATCH), Without("none in a vacuum; else required"), "Boundary condition of every patch by its name. Without an outlet or an opening the domain is closed: an ideal gas then takes the pressure at which it fills the pores.", "[gas.patch.bottom]"),
    key("controls", Table(CONTROLS), Without("see its keys"), "Accuracy of the gas solver.", "{ outer_tolerance = 1e-6 }"),
];
