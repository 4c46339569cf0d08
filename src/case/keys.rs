//! Every key of a case file in one table; the last part of `docs/case-file.md` is made from it.

/// Whether a key must be there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// It must.
    Required,
    /// One of several that exclude each other; the meaning names them.
    OneOf,
    /// It need not; what holds without it.
    Default(&'static str),
}

/// One key.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Dotted place; `NAME` stands for a name that the user chooses.
    pub key: &'static str,
    /// What the value is: `text`, `table`, a quantity with its SI unit.
    pub value: &'static str,
    /// Whether it must be there.
    pub need: Need,
    /// What it means.
    pub meaning: &'static str,
    /// An example of the value, in TOML.
    pub example: &'static str,
}

const fn key(
    key: &'static str,
    value: &'static str,
    need: Need,
    meaning: &'static str,
    example: &'static str,
) -> Key {
    Key {
        key,
        value,
        need,
        meaning,
        example,
    }
}

use Need::{Default, OneOf, Required};

/// All keys, in the order of a case file.
pub fn keys() -> &'static [Key] {
    KEYS
}

#[rustfmt::skip]
const KEYS: &[Key] = &[
    key("format", "whole number", Required, "Version of the format; 1 is the only one.", "1"),
    key("title", "text", Required, "Title for people.", "\"Hot air heats a column\""),
    key("time", "table", Required, "Clocks. All times are process time, save `motion_window` (motion time).", "[time]"),
    key("time.end", "time, s", Required, "End of the run.", "\"10 min\""),
    key("time.motion_window", "time, s", OneOf, "Length of a coupling window in motion time. Either this or `process_step`.", "\"1 ms\""),
    key("time.process_step", "time, s", OneOf, "Length of a coupling window in process time, for beds that do not move: the motion time and with it the acceleration factor follow from mesh and inlets. Either this or `motion_window`; not with `acceleration` or `accelerated` storage.", "\"0.5 s\""),
    key("time.acceleration", "number or schedule", Default("1"), "Acceleration factor AF, at least 1: process time passes AF times as fast as motion time.", "[[\"0 s\", 1], [\"5 s\", 50]]"),
    key("time.gas_storage", "`process` or `accelerated`", Default("`process`"), "Clock over which the gas stores mass and heat.", "\"process\""),
    key("time.checkpoint", "table", Default("only on interrupt"), "When a checkpoint is written.", "{ every = \"60 s\" }"),
    key("time.checkpoint.every", "time, s", Default("never"), "A checkpoint each so much process time.", "\"60 s\""),
    key("time.checkpoint.wall", "time, s", Default("never"), "A checkpoint each so much wall time.", "\"15 min\""),
    key("mesh", "table", Required, "The gas mesh: exactly one of `box`, `cylinder` and `polymesh`.", "[mesh]"),
    key("mesh.box", "table", OneOf, "A box, generated. Either this or `mesh.polymesh`.", "{ size = \"10 10 110 mm\", cells = [1, 1, 11] }"),
    key("mesh.box.origin", "three lengths, m", Default("0 0 0 m"), "Corner with the smallest coordinates.", "\"-10 -10 0 mm\""),
    key("mesh.box.size", "three lengths, m", Required, "Edge lengths along x, y, z.", "\"10 10 110 mm\""),
    key("mesh.box.cells", "three whole numbers", Required, "Cells along x, y, z; 2e9 in all at most.", "[1, 1, 11]"),
    key("mesh.box.grading", "table", Default("equal cells"), "How cell sizes change along axes.", "{ z = 4 }"),
    key("mesh.box.grading.x", "number, or list", Default("equal cells"), "Ratio of the last cell to the first along x, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
    key("mesh.box.grading.y", "number, or list", Default("equal cells"), "Ratio of the last cell to the first along y, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
    key("mesh.box.grading.z", "number, or list", Default("equal cells"), "Ratio of the last cell to the first along z, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
    key("mesh.box.refine", "list of tables", Default("none"), "Zones in which cells are split 2 x 2 x 2; neighbours differ by one level at most.", "[{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" }, levels = 1 }]"),
    key("mesh.box.refine.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"0 0 0 mm\", to = \"10 10 50 mm\" }"),
    key("mesh.box.refine.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"0 0 0 mm\""),
    key("mesh.box.refine.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"10 10 50 mm\""),
    key("mesh.box.refine.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"0 0 0 mm\", to = \"0 0 50 mm\", radius = \"8 mm\" }"),
    key("mesh.box.refine.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"0 0 0 mm\""),
    key("mesh.box.refine.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"0 0 50 mm\""),
    key("mesh.box.refine.cylinder.radius", "length, m", Required, "Radius.", "\"8 mm\""),
    key("mesh.box.refine.levels", "whole number", Default("1"), "How often cells are split whose centres lie in the zone, 1 to 6.", "2"),
    key("mesh.box.openings", "list of tables", Default("none"), "Parts of the boundary with patches of their own, such as burners: boundary faces whose centres lie in a zone, after refinement. Particles see the side as if it were closed.", "[{ name = \"burners\", box = { from = \"-1 45 195 mm\", to = \"1 55 205 mm\" } }]"),
    key("mesh.box.openings.name", "text", Required, "Name of the patch; openings of one name make one patch.", "\"burners\""),
    key("mesh.box.openings.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"-1 45 195 mm\", to = \"1 55 205 mm\" }"),
    key("mesh.box.openings.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"-1 45 195 mm\""),
    key("mesh.box.openings.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"1 55 205 mm\""),
    key("mesh.box.openings.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"-1 50 200 mm\", to = \"1 50 200 mm\", radius = \"5 mm\" }"),
    key("mesh.box.openings.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"-1 50 200 mm\""),
    key("mesh.box.openings.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"1 50 200 mm\""),
    key("mesh.box.openings.cylinder.radius", "length, m", Required, "Radius.", "\"5 mm\""),
    key("mesh.box.patches", "six texts", Default("four times `side`, `bottom`, `top`"), "Patches of x-, x+, y-, y+, z-, z+; equal names make one patch.", "[\"side\", \"side\", \"side\", \"side\", \"low\", \"high\"]"),
    key("mesh.cylinder", "table", OneOf, "An upright cylinder, generated as an O-grid; patches `side`, `bottom`, `top`.", "{ diameter = \"50 mm\", length = \"300 mm\", cells = [12, 60] }"),
    key("mesh.cylinder.origin", "three lengths, m", Default("0 0 0 m"), "Centre of the bottom.", "\"0 0 10 mm\""),
    key("mesh.cylinder.diameter", "length, m", Required, "Diameter.", "\"50 mm\""),
    key("mesh.cylinder.length", "length, m", Required, "Length along z.", "\"300 mm\""),
    key("mesh.cylinder.cells", "two whole numbers", Required, "Cells across the diameter (3 to 20000) and along z.", "[12, 60]"),
    key("mesh.cylinder.grading", "table", Default("equal cells"), "How cell sizes change along axes.", "{ z = 4 }"),
    key("mesh.cylinder.grading.z", "number, or list", Default("equal cells"), "Ratio of the last cell to the first along z, or regions of [share of the length, share of the cells, ratio] as in blockMesh.", "[[0.4, 0.2, 0.25], [0.6, 0.8, 1]]"),
    key("mesh.cylinder.refine", "list of tables", Default("none"), "Zones in which cells are split 2 x 2 x 2; neighbours differ by one level at most.", "[{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" }, levels = 1 }]"),
    key("mesh.cylinder.refine.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"0 0 0 mm\", to = \"10 10 50 mm\" }"),
    key("mesh.cylinder.refine.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"0 0 0 mm\""),
    key("mesh.cylinder.refine.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"10 10 50 mm\""),
    key("mesh.cylinder.refine.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"0 0 0 mm\", to = \"0 0 50 mm\", radius = \"8 mm\" }"),
    key("mesh.cylinder.refine.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"0 0 0 mm\""),
    key("mesh.cylinder.refine.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"0 0 50 mm\""),
    key("mesh.cylinder.refine.cylinder.radius", "length, m", Required, "Radius.", "\"8 mm\""),
    key("mesh.cylinder.refine.levels", "whole number", Default("1"), "How often cells are split whose centres lie in the zone, 1 to 6.", "2"),
    key("mesh.cylinder.openings", "list of tables", Default("none"), "Parts of the boundary with patches of their own, such as burners: boundary faces whose centres lie in a zone, after refinement. Particles see the side as if it were closed.", "[{ name = \"burners\", box = { from = \"-1 45 195 mm\", to = \"1 55 205 mm\" } }]"),
    key("mesh.cylinder.openings.name", "text", Required, "Name of the patch; openings of one name make one patch.", "\"burners\""),
    key("mesh.cylinder.openings.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"-1 45 195 mm\", to = \"1 55 205 mm\" }"),
    key("mesh.cylinder.openings.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"-1 45 195 mm\""),
    key("mesh.cylinder.openings.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"1 55 205 mm\""),
    key("mesh.cylinder.openings.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"-1 50 200 mm\", to = \"1 50 200 mm\", radius = \"5 mm\" }"),
    key("mesh.cylinder.openings.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"-1 50 200 mm\""),
    key("mesh.cylinder.openings.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"1 50 200 mm\""),
    key("mesh.cylinder.openings.cylinder.radius", "length, m", Required, "Radius.", "\"5 mm\""),
    key("mesh.polymesh", "path", OneOf, "An OpenFOAM polyMesh folder. Either this or `mesh.box`.", "\"constant/polyMesh\""),
    key("materials", "table", Required, "Solid materials by name.", "[materials.glass]"),
    key("materials.NAME.density", "density, kg/m^3", Required, "Density.", "\"2500 kg/m^3\""),
    key("materials.NAME.composition", "table", OneOf, "What the material is made of, where it reacts: mass or mole fractions of solids, which sum to 1. Either this or `heat_capacity`.", "{ mass = { Fe2O3 = 0.95, Al2O3 = 0.05 } }"),
    key("materials.NAME.composition.mass", "table of numbers", OneOf, "Mass fractions by the names of solids. Either this or `mole`.", "{ CaCO3 = 1 }"),
    key("materials.NAME.composition.mole", "table of numbers", OneOf, "Mole fractions by the names of solids. Either this or `mass`.", "{ Fe2O3 = 0.7, Fe3O4 = 0.3 }"),
    key("materials.NAME.heat_capacity", "specific heat capacity, J/kg/K, or points over temperature, or table", OneOf, "Specific heat capacity; linear between points, constant outside them; or NASA's polynomials as a table.", "[[\"300 K\", \"780 J/kg/K\"], [\"800 K\", \"1150 J/kg/K\"]]"),
    key("materials.NAME.heat_capacity.molar_mass", "molar mass, kg/mol", Required, "Molar mass that the polynomials are of.", "\"55.845 g/mol\""),
    key("materials.NAME.heat_capacity.ranges", "three temperatures, K", Required, "Lowest, common and highest temperature of the two polynomials; c_p is constant beyond.", "\"200 1000 6000 K\""),
    key("materials.NAME.heat_capacity.low", "seven numbers", Required, "NASA's coefficients a1 to a7 below the common temperature.", "[2.5, 0, 0, 0, 0, 0, 0]"),
    key("materials.NAME.heat_capacity.high", "seven numbers", Required, "NASA's coefficients a1 to a7 above it.", "[2.5, 0, 0, 0, 0, 0, 0]"),
    key("materials.NAME.size", "table", Default("diameters stay"), "How particles of the material take up room while they react; goes with `composition`.", "{ law = \"constant-density\", least_diameter = \"1 mm\" }"),
    key("materials.NAME.size.law", "`constant-diameter`, `constant-density` or `densities`", Required, "The diameter stays and the density follows the mass; the density stays and particles shrink or grow; or each solid has its own density in the particle.", "\"constant-density\""),
    key("materials.NAME.size.densities", "table of densities, kg/m^3", Default("required with `densities`"), "Density of each solid that the particles hold or come to hold, with the pores that it has in them; together they give the material's density at the start.", "{ CaCO3 = \"2700 kg/m^3\", CaO = \"1600 kg/m^3\" }"),
    key("materials.NAME.size.least_diameter", "length, m", Default("required but for `constant-diameter`"), "Below it no particle shrinks: from there on its density falls.", "\"1 mm\""),
    key("materials.NAME.conductivity", "thermal conductivity, W/m/K, or points over temperature", Default("not known"), "Thermal conductivity; linear between points, constant outside them.", "[[\"300 K\", \"80 W/m/K\"], [\"1000 K\", \"33 W/m/K\"]]"),
    key("materials.NAME.emissivity", "number", Default("not known"), "Emissivity of the surface, above 0 and up to 1.", "0.9"),
    key("materials.NAME.young", "pressure, Pa", Default("not known"), "Young's modulus by which contacts are computed.", "\"50 MPa\""),
    key("materials.NAME.real_young", "pressure, Pa", Default("that of `young`"), "Young's modulus of the real material, where `young` is softened; by it contacts conduct where `laws.conduction.area` says so.", "\"210 GPa\""),
    key("materials.NAME.poisson", "number", Default("not known"), "Poisson's ratio, -1 to 0.5.", "0.22"),
    key("solids", "table", Default("none"), "Pure solids by name, beside the built-in C, Fe, FeO, Fe0.947O, Fe3O4, Fe2O3, CaCO3, CaO and Al2O3.", "[solids.quartz]"),
    key("solids.NAME.formula", "text", Required, "Chemical formula.", "\"SiO2\""),
    key("solids.NAME.formation_enthalpy", "molar energy, J/mol", Required, "Enthalpy of formation at 298.15 K.", "\"-910.7 kJ/mol\""),
    key("solids.NAME.entropy", "molar entropy, J/mol/K", Required, "Entropy at 298.15 K and 1 bar.", "\"41.5 J/mol/K\""),
    key("solids.NAME.heat_capacity", "specific heat capacity, J/kg/K, or points over temperature", Required, "Specific heat capacity; linear between points, constant outside them.", "[[\"300 K\", \"745 J/kg/K\"], [\"800 K\", \"1230 J/kg/K\"]]"),
    key("reactions", "list of tables", Default("none"), "Reactions in particles.", "[[reactions]]"),
    key("reactions.name", "text", Required, "Its name.", "\"calcination\""),
    key("reactions.equation", "text", Required, "Moles of gases of `gas.species` and of solids, with => (one way) or <=> (both ways); balanced. The last species of the gas reacts in none.", "\"CaCO3 <=> CaO + CO2\""),
    key("reactions.law", "`shrinking-core` or `power-law`", Required, "At the surface of a core, with gas film, layers and kinetics in series; or in the whole particle, by powers of concentrations.", "\"shrinking-core\""),
    key("reactions.rate", "table", Required, "Rate constant k = factor T^exponent exp(-activation_energy/RT) of the forward reaction.", "{ factor = \"0.3 m/s\", activation_energy = \"70 kJ/mol\" }"),
    key("reactions.rate.factor", "velocity, m/s, or a number", Required, "Shrinking core: of the rate by area of the interface and concentration of the gas. Power law: a number in mol, m and s, of the rate in mol/m^3/s by concentrations in mol/m^3.", "3e4"),
    key("reactions.rate.exponent", "number", Default("0"), "Exponent of the temperature in K.", "0.5"),
    key("reactions.rate.activation_energy", "molar energy, J/mol", Default("0 J/mol"), "Activation energy.", "\"60 kJ/mol\""),
    key("reactions.rate.orders", "table of numbers", Default("none"), "Power law: order of each gas and solid; required there. A negative one only of a gas that is always there.", "{ Fe = 1, O2 = 1 }"),
    key("reactions.rate.in_series", "table", Default("none"), "Power law: a second rate constant in series, 1/k = 1/k1 + 1/k2, such as that of diffusion in pores.", "{ factor = 0.2, activation_energy = \"18 kJ/mol\" }"),
    key("reactions.rate.in_series.factor", "number", Required, "As that of the first.", "0.2"),
    key("reactions.rate.in_series.exponent", "number", Default("0"), "Exponent of the temperature in K.", "0"),
    key("reactions.rate.in_series.activation_energy", "molar energy, J/mol", Default("0 J/mol"), "Activation energy.", "\"18 kJ/mol\""),
    key("reactions.layer_diffusivity", "table", Default("none"), "Shrinking core: diffusivity of the gas in the pores of the layer that the reaction leaves, value (T/at)^exponent; required there.", "{ value = \"1e-5 m^2/s\", at = \"1100 K\", exponent = 1.75 }"),
    key("reactions.layer_diffusivity.value", "diffusivity, m^2/s", Required, "Its value.", "\"1e-5 m^2/s\""),
    key("reactions.layer_diffusivity.at", "temperature, K", Default("none"), "The temperature of the value; required with an exponent.", "\"1100 K\""),
    key("reactions.layer_diffusivity.exponent", "number", Default("0"), "Exponent of the temperature.", "1.75"),
    key("reactions.equilibrium", "table", Default("from the Gibbs energies of gases and solids"), "Of a reaction with <=>: ln K = constant + over_temperature/T, with partial pressures over 1 bar.", "{ constant = -2.946, over_temperature = \"2744 K\" }"),
    key("reactions.equilibrium.constant", "number", Required, "Its constant.", "-2.946"),
    key("reactions.equilibrium.over_temperature", "temperature, K", Required, "What stands over the temperature; may be negative.", "\"2744 K\""),
    key("reactions.heat", "molar energy, J/mol", Default("not stated"), "Heat that the reaction takes up at 298.15 K, to be compared with that of the enthalpies of formation, which counts; more than 2 % off is an error.", "\"178 kJ/mol\""),
    key("contacts", "list of tables", Default("none"), "Contacts of pairs of materials.", "[[contacts]]"),
    key("contacts.between", "two texts", Required, "The two materials.", "[\"glass\", \"glass\"]"),
    key("contacts.restitution", "number", Default("not known"), "Coefficient of restitution, above 0 and up to 1.", "0.6"),
    key("contacts.friction", "number", Default("not known"), "Coefficient of friction, zero or above.", "0.3"),
    key("contacts.rolling_friction", "number", Default("not known"), "Coefficient of rolling friction, zero or above.", "0.05"),
    key("contacts.rolling_damping", "number", Default("not known"), "Damping of rolling as a share of the critical one, zero or above; for the rolling law `elastic-plastic`.", "0.3"),
    key("contacts.cohesion_energy", "energy density, J/m^3", Default("not known"), "Cohesion energy density, zero or above; for the cohesion law `sjkr`.", "\"2 kJ/m^3\""),
    key("walls", "list of tables", Default("none"), "Walls that free particles touch, and that all particles exchange heat with.", "[[walls]]"),
    key("walls.name", "text", Required, "Name.", "\"container\""),
    key("walls.material", "text", Required, "Its material.", "\"steel\""),
    key("walls.patches", "list of texts", OneOf, "The sides of the generated mesh that carry these patches; the round side of a cylinder is the circle that touches its polygon from inside. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "[\"side\", \"bottom\"]"),
    key("walls.plane", "table", OneOf, "An endless plane. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ point = \"0 0 0 m\", normal = \"0 0 1\" }"),
    key("walls.plane.point", "three lengths, m", Required, "A point of it.", "\"0 0 0 mm\""),
    key("walls.plane.normal", "three numbers", Required, "Direction into the side where particles are; of any length.", "\"0 0 1\""),
    key("walls.cylinder", "table", OneOf, "The inner side of an endless cylinder. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ point = \"0 0 0 m\", axis = \"0 0 1\", radius = \"25 mm\" }"),
    key("walls.cylinder.point", "three lengths, m", Required, "A point of its axis.", "\"0 0 0 mm\""),
    key("walls.cylinder.axis", "three numbers", Required, "Direction of its axis; of any length.", "\"0 0 1\""),
    key("walls.cylinder.radius", "length, m", Required, "Radius.", "\"25 mm\""),
    key("walls.cone", "table", OneOf, "The inner side of the frustum of a cone. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "{ from = \"0 0 0 mm\", to = \"0 0 40 mm\", from_radius = \"5 mm\", to_radius = \"25 mm\" }"),
    key("walls.cone.from", "three lengths, m", Required, "Centre of one end.", "\"0 0 0 mm\""),
    key("walls.cone.to", "three lengths, m", Required, "Centre of the other end.", "\"0 0 40 mm\""),
    key("walls.cone.from_radius", "length, m", Required, "Radius at `from`.", "\"5 mm\""),
    key("walls.cone.to_radius", "length, m", Required, "Radius at `to`.", "\"25 mm\""),
    key("walls.stl", "path", OneOf, "Triangles of an STL file, ASCII or binary; both their sides are wall. One of `patches`, `plane`, `cylinder`, `cone`, `stl`.", "\"wall.stl\""),
    key("walls.scale", "number", Default("1"), "Length in m of a unit of the STL file.", "1e-3"),
    key("walls.velocity", "three velocities, m/s", Default("at rest"), "Velocity of the wall. Not with `rotating`.", "\"0 0 0.1 m/s\""),
    key("walls.rotating", "table", Default("at rest"), "The wall turns about an axis. Not with `velocity`.", "{ point = \"0 0 0 m\", angular_velocity = \"0 0 3 rad/s\" }"),
    key("walls.rotating.point", "three lengths, m", Required, "A point of the axis.", "\"0 0 0 mm\""),
    key("walls.rotating.angular_velocity", "three angular velocities, rad/s", Required, "Angular velocity along the axis.", "\"0 0 3 rad/s\""),
    key("walls.temperature", "temperature, K, or schedule", Default("adiabatic"), "Temperature of the wall, for conduction and radiation between it and particles. A wall without it conducts nothing and reflects radiation as a mirror.", "\"400 K\""),
    key("motion", "table", Default("required where particles are free"), "How free particles move; gravity is that of `gas.gravity`.", "[motion]"),
    key("motion.kind", "`real-time` or `accelerated`", Required, "Fluidised beds, drums and sprays move in real time, and AF is 1; the slow motion of shafts and moving beds is the same at any pace, and may be accelerated.", "\"real-time\""),
    key("motion.motion_step", "time, s", Default("a whole share of the window, at most 15 % of the time of a Rayleigh wave and 5 % of the shortest impact"), "Time step of the contacts in motion time.", "\"5 us\""),
    key("motion.contact", "table", Required, "Force of an elastic contact with damping and friction.", "{ law = \"hertz-mindlin\" }"),
    key("motion.contact.law", "`hertz-mindlin`, `linear` or `spring-slider-dashpot`", Required, "Its law; LIGGGHTS has the first two.", "\"hertz-mindlin\""),
    key("motion.contact.characteristic_speed", "velocity, m/s", Default("required with `linear`"), "Speed of impact at which the linear spring overlaps as much as by the law of Hertz.", "\"1 m/s\""),
    key("motion.attractive_damping", "true or false", Default("true"), "Whether damping may pull separating spheres together: true gives the stated restitution, false cuts the force at zero.", "false"),
    key("motion.rolling", "table", Required, "Resistance to rolling.", "{ law = \"none\" }"),
    key("motion.rolling.law", "`none`, `constant-torque` or `elastic-plastic`", Required, "Its law.", "\"none\""),
    key("motion.cohesion", "table", Required, "Attraction between surfaces.", "{ law = \"none\" }"),
    key("motion.cohesion.law", "`none` or `sjkr`", Required, "Its law.", "\"none\""),
    key("gas", "table", Required, "The gas.", "[gas]"),
    key("gas.mixture", "text", Required, "`air`, or any name together with `gas.properties` or `gas.constant`.", "\"air\""),
    key("gas.initial", "table", Required, "The gas at the start, everywhere.", "{ temperature = \"300 K\", pressure = \"1 atm\" }"),
    key("gas.initial.temperature", "temperature, K", Required, "Temperature.", "\"300 K\""),
    key("gas.initial.pressure", "pressure, Pa", Required, "Absolute pressure.", "\"1 atm\""),
    key("gas.initial.composition", "table", Default("a single gas"), "Composition at the start, by amounts (`mole`) or masses (`mass`).", "{ mole = { N2 = 0.79, O2 = 0.21 } }"),
    key("gas.initial.composition.mole", "table of numbers", OneOf, "Mole fractions by species, which sum to 1; what is not named is 0. Either this or `mass`.", "{ N2 = 0.79, O2 = 0.21 }"),
    key("gas.initial.composition.mass", "table of numbers", OneOf, "Mass fractions by species, which sum to 1. Either this or `mole`.", "{ N2 = 1 }"),
    key("gas.initial.velocity", "three velocities, m/s", Default("0 0 0 m/s"), "Velocity.", "\"0 0 0.5 m/s\""),
    key("gas.gravity", "three accelerations, m/s^2", Default("0 0 0 m/s^2"), "Gravity on gas and free particles.", "\"0 0 -9.81 m/s^2\""),
    key("gas.held", "true or false", Default("false"), "The gas stays as it is at the start, at any exchange: superficial velocity, temperature, and a pressure gradient of its own weight. No gas solver runs.", "true"),
    key("gas.species", "list of `N2`, `O2`, `Ar`, `CO2`, `H2O`, `CO`, `H2`, `CH4`", Default("a single gas"), "Species of a mixture of ideal gases; with `gas.schmidt`, and a composition wherever gas stands at the start or flows in.", "[\"N2\", \"O2\"]"),
    key("gas.schmidt", "number", Default("goes with `species`"), "Schmidt number of all species: they diffuse alike, with viscosity over density over this.", "0.7"),
    key("gas.constant", "table", Default("an ideal gas"), "A fluid of constant properties; not with `gas.properties`. Its enthalpy is c_p (T - 298.15 K).", "[gas.constant]"),
    key("gas.constant.density", "density, kg/m^3", Required, "Density.", "\"1.2 kg/m^3\""),
    key("gas.constant.heat_capacity", "specific heat capacity, J/kg/K", Required, "Specific heat capacity c_p.", "\"1005 J/kg/K\""),
    key("gas.constant.viscosity", "dynamic viscosity, Pa s", Required, "Viscosity.", "\"18.5e-6 Pa s\""),
    key("gas.constant.conductivity", "thermal conductivity, W/m/K", Required, "Thermal conductivity.", "\"0.026 W/m/K\""),
    key("gas.properties", "table", Default("those of `gas.mixture`"), "An ideal gas by its properties.", "[gas.properties]"),
    key("gas.properties.molar_mass", "molar mass, kg/mol", Required, "Molar mass.", "\"28.96 g/mol\""),
    key("gas.properties.heat_capacity", "specific heat capacity, J/kg/K", Required, "Specific heat capacity c_p; above R/M.", "\"1005 J/kg/K\""),
    key("gas.properties.viscosity", "dynamic viscosity, Pa s", Required, "Viscosity at `viscosity_at`.", "\"18.5e-6 Pa s\""),
    key("gas.properties.viscosity_at", "temperature, K", Required, "Temperature of `viscosity`.", "\"300 K\""),
    key("gas.properties.sutherland_temperature", "temperature, K", Required, "Temperature of Sutherland's law.", "\"120 K\""),
    key("gas.patch", "table", Required, "Boundary condition of every patch by its name. Without an outlet the domain is closed: an ideal gas then takes the pressure at which it fills the pores.", "[gas.patch.bottom]"),
    key("gas.patch.NAME.inlet", "table", OneOf, "Gas flows in. One of `inlet`, `outlet`, `wall`, `symmetry`.", "{ superficial_velocity = \"0.5 m/s\", temperature = \"400 K\" }"),
    key("gas.patch.NAME.inlet.superficial_velocity", "velocity, m/s, or schedule", OneOf, "Superficial velocity into the domain, zero or above, of gas at the pressure of `gas.initial`. Either this or `mass_flow`.", "\"0.5 m/s\""),
    key("gas.patch.NAME.inlet.mass_flow", "mass flow, kg/s, or schedule", OneOf, "Mass flow through the whole patch, zero or above, evenly spread. Either this or `superficial_velocity`.", "\"2 kg/h\""),
    key("gas.patch.NAME.inlet.composition", "table, or schedule of tables", Default("a single gas"), "Composition of the gas that enters, as `gas.initial.composition`.", "[[\"0 s\", { mole = { N2 = 1 } }], [\"10 s\", { mole = { CO2 = 1 } }]]"),
    key("gas.patch.NAME.inlet.composition.mole", "table of numbers", OneOf, "Mole fractions by species. Either this or `mass`.", "{ CO2 = 1 }"),
    key("gas.patch.NAME.inlet.composition.mass", "table of numbers", OneOf, "Mass fractions by species. Either this or `mole`.", "{ CO2 = 1 }"),
    key("gas.patch.NAME.inlet.temperature", "temperature, K, or schedule", Required, "Temperature of the gas that enters.", "[[\"0 s\", \"300 K\"], [\"10 s\", \"400 K\"]]"),
    key("gas.patch.NAME.outlet", "table", OneOf, "Gas flows out. One of `inlet`, `outlet`, `wall`, `symmetry`.", "{ pressure = \"1 atm\" }"),
    key("gas.patch.NAME.outlet.pressure", "pressure, Pa, or schedule", Required, "Absolute pressure.", "\"1 atm\""),
    key("gas.patch.NAME.wall", "table", OneOf, "A wall. One of `inlet`, `outlet`, `wall`, `symmetry`.", "{ velocity = \"slip\", heat = \"adiabatic\" }"),
    key("gas.patch.NAME.wall.velocity", "`no-slip`, `slip` or table", Required, "Gas velocity at the wall.", "\"no-slip\""),
    key("gas.patch.NAME.wall.velocity.moving", "three velocities, m/s", Required, "Velocity of a wall that slides in its own plane; gas sticks to it.", "\"0.1 0 0 m/s\""),
    key("gas.patch.NAME.wall.heat", "`adiabatic` or table", Required, "Heat through the wall.", "\"adiabatic\""),
    key("gas.patch.NAME.wall.heat.temperature", "temperature, K, or schedule", OneOf, "Temperature of the wall. One of `temperature`, `flux`, `coefficient`.", "\"350 K\""),
    key("gas.patch.NAME.wall.heat.flux", "heat flux, W/m^2, or schedule", OneOf, "Heat flux into the gas per area of wall. One of `temperature`, `flux`, `coefficient`.", "\"1 kW/m^2\""),
    key("gas.patch.NAME.wall.heat.coefficient", "heat transfer coefficient, W/m^2/K, or schedule", OneOf, "Overall coefficient between the inner face of the wall and surroundings of `ambient`. One of `temperature`, `flux`, `coefficient`.", "\"10 W/m^2/K\""),
    key("gas.patch.NAME.wall.heat.ambient", "temperature, K, or schedule", Default("goes with `coefficient`"), "Temperature of the surroundings.", "\"300 K\""),
    key("gas.patch.NAME.symmetry", "table", OneOf, "A plane of symmetry. One of `inlet`, `outlet`, `wall`, `symmetry`.", "{}"),
    key("gas.controls", "table", Default("see its keys"), "Accuracy of the gas solver.", "{ outer_tolerance = 1e-8 }"),
    key("gas.controls.outer_iterations", "whole number", Default("20"), "Outer iterations per window at most, 1 to 10000.", "20"),
    key("gas.controls.convection", "`van-leer` or `upwind`", Default("`van-leer`"), "How velocity, enthalpy and composition are carried to faces: second order with van Leer's limiter, or first-order upwind.", "\"upwind\""),
    key("gas.controls.pressure_corrections", "whole number", Default("2"), "Pressure corrections per outer iteration, 1 to 10000.", "2"),
    key("gas.controls.outer_tolerance", "number", Default("1e-8"), "The outer iterations end below this scaled residual.", "1e-8"),
    key("gas.controls.linear_tolerance", "number", Default("1e-13"), "Tolerance of the linear solvers.", "1e-13"),
    key("particles", "list of tables", Required, "Populations.", "[[particles]]"),
    key("particles.name", "text", Required, "Name; no two alike.", "\"beads\""),
    key("particles.material", "text", Required, "One of `materials`.", "\"glass\""),
    key("particles.diameter", "length, m, or table", Required, "Diameter, or a distribution: exactly one of `normal`, `log_normal`, `uniform` and `table`. Where a file of particles states diameters, those count.", "\"10 mm\""),
    key("particles.diameter.normal", "table", OneOf, "A normal distribution, cut off.", "{ mean = \"4 mm\", deviation = \"0.4 mm\", min = \"3 mm\", max = \"5 mm\" }"),
    key("particles.diameter.normal.mean", "length, m", Required, "Mean before it is cut off; between `min` and `max`.", "\"4 mm\""),
    key("particles.diameter.normal.deviation", "length, m", Required, "Standard deviation before it is cut off.", "\"0.4 mm\""),
    key("particles.diameter.normal.min", "length, m", Required, "Smallest diameter.", "\"3 mm\""),
    key("particles.diameter.normal.max", "length, m", Required, "Largest diameter.", "\"5 mm\""),
    key("particles.diameter.log_normal", "table", OneOf, "A log-normal distribution, cut off.", "{ median = \"4 mm\", deviation = 1.3, min = \"2 mm\", max = \"8 mm\" }"),
    key("particles.diameter.log_normal.median", "length, m", Required, "Median before it is cut off; between `min` and `max`.", "\"4 mm\""),
    key("particles.diameter.log_normal.deviation", "number", Required, "Geometric standard deviation, above 1.", "1.3"),
    key("particles.diameter.log_normal.min", "length, m", Required, "Smallest diameter.", "\"2 mm\""),
    key("particles.diameter.log_normal.max", "length, m", Required, "Largest diameter.", "\"8 mm\""),
    key("particles.diameter.uniform", "table", OneOf, "All diameters of a range alike.", "{ min = \"3 mm\", max = \"5 mm\" }"),
    key("particles.diameter.uniform.min", "length, m", Required, "Smallest diameter.", "\"3 mm\""),
    key("particles.diameter.uniform.max", "length, m", Required, "Largest diameter.", "\"5 mm\""),
    key("particles.diameter.table", "list of pairs", OneOf, "Diameters, each with its share; shares are scaled to sum to 1.", "[[\"4 mm\", 0.3], [\"6 mm\", 0.7]]"),
    key("particles.diameter.share", "`number` or `mass`", Required, "What the distribution is of.", "\"number\""),
    key("particles.diameter.seed", "whole number", Required, "Equal seeds draw equal diameters.", "1"),
    key("particles.motion", "`frozen` or `free`", Required, "How the particles move: not at all, or by gravity, contacts and the force of the gas (then with a section `[motion]`).", "\"frozen\""),
    key("particles.velocity", "three velocities, m/s", Default("at rest"), "Velocity at the start; of free particles.", "\"0 0 -0.1 m/s\""),
    key("particles.temperature", "temperature, K", Required, "Temperature at the start.", "\"300 K\""),
    key("particles.place", "table", Required, "Where the particles are: exactly one of `grid`, `file` and `packing`. Spheres may overlap by 5 % of their diameter, as where they are pressed together.", "{ file = \"bed.csv\" }"),
    key("particles.place.grid", "table", OneOf, "A regular stacking. Either this or `file`.", "{ first = \"5 5 5 mm\", spacing = \"10 10 10 mm\", counts = [1, 1, 10] }"),
    key("particles.place.grid.first", "three lengths, m", Required, "Centre of the first particle.", "\"5 5 5 mm\""),
    key("particles.place.grid.spacing", "three lengths, m", Required, "Distances of centres along x, y, z; at least the diameter.", "\"10 10 10 mm\""),
    key("particles.place.grid.counts", "three whole numbers", Required, "Particles along x, y, z; 1e9 in all at most.", "[1, 1, 10]"),
    key("particles.place.packing", "`random`, `simple-cubic`, `hexagonal` or `face-centred`", OneOf, "A packing from wall to wall of a box or cylinder mesh: random by geometry alone, without gravity, or a regular stacking of whole spheres from the bottom on.", "\"random\""),
    key("particles.place.height", "length, m", Default("with `packing`, either this or `region`"), "Height of the packing above the bottom of the mesh.", "\"145 mm\""),
    key("particles.place.region", "table", Default("with `packing`, either this or `height`"), "Layer of the packing, so that populations lie one above the other.", "{ from = \"60 mm\", to = \"90 mm\" }"),
    key("particles.place.region.from", "length, m", Required, "Lowest z.", "\"60 mm\""),
    key("particles.place.region.to", "length, m", Required, "Highest z.", "\"90 mm\""),
    key("particles.place.solid_fraction", "plain number", Default("required with `random`"), "Volume of spheres over the filled space, layers at the walls included; up to about 0.59 with equal spheres.", "0.58"),
    key("particles.place.seed", "whole number", Default("required with `random`"), "Equal seeds give equal packings, bit for bit.", "1"),
    key("particles.place.file", "path", OneOf, "Particles of a file: `.csv`, a LIGGGHTS text dump, `.vtk` (ASCII), `.vtp` or `.vtu` (ASCII or raw). Lengths in m; diameter or radius and temperature where it has them.", "\"bed.csv\""),
    key("particles.place.timestep", "whole number", Default("the last one"), "The snapshot of a dump.", "20000"),
    key("particles.place.type", "whole number", Default("all"), "Only particles whose column `type` says so.", "1"),
    key("feeds", "list of tables", Default("none"), "Particles that come in.", "[[feeds]]"),
    key("feeds.name", "text", Required, "Name.", "\"charge\""),
    key("feeds.population", "text", Required, "Of which population they are: it gives material and diameters.", "\"beads\""),
    key("feeds.region", "table", Required, "Where: a box or a cylinder.", "{ box = { from = \"0 0 80 mm\", to = \"50 50 100 mm\" } }"),
    key("feeds.region.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"0 0 80 mm\", to = \"50 50 100 mm\" }"),
    key("feeds.region.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"0 0 80 mm\""),
    key("feeds.region.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"50 50 100 mm\""),
    key("feeds.region.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"0 0 80 mm\", to = \"0 0 100 mm\", radius = \"20 mm\" }"),
    key("feeds.region.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"0 0 80 mm\""),
    key("feeds.region.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"0 0 100 mm\""),
    key("feeds.region.cylinder.radius", "length, m", Required, "Radius.", "\"20 mm\""),
    key("feeds.mass_rate", "mass flow, kg/s", Default("none"), "Mass flow; particles wait where there is no room. This or `batch`, or both.", "\"1 kg/h\""),
    key("feeds.batch", "mass, kg", Default("none"), "Mass that comes before the first window; what finds no room follows. This or `mass_rate`, or both.", "\"20 g\""),
    key("feeds.velocity", "three velocities, m/s", Default("at rest"), "Velocity at which they come.", "\"0 0 -0.01 m/s\""),
    key("feeds.temperature", "temperature, K", Default("that of the population"), "Their temperature.", "\"300 K\""),
    key("feeds.seed", "whole number", Required, "Equal seeds give equal particles at equal places.", "1"),
    key("outlets", "list of tables", Default("none"), "Where particles go out.", "[[outlets]]"),
    key("outlets.name", "text", Required, "Name.", "\"discharge\""),
    key("outlets.region", "table", Required, "Where: a box or a cylinder.", "{ box = { from = \"0 0 80 mm\", to = \"50 50 100 mm\" } }"),
    key("outlets.region.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"0 0 80 mm\", to = \"50 50 100 mm\" }"),
    key("outlets.region.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"0 0 80 mm\""),
    key("outlets.region.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"50 50 100 mm\""),
    key("outlets.region.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"0 0 80 mm\", to = \"0 0 100 mm\", radius = \"20 mm\" }"),
    key("outlets.region.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"0 0 80 mm\""),
    key("outlets.region.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"0 0 100 mm\""),
    key("outlets.region.cylinder.radius", "length, m", Required, "Radius.", "\"20 mm\""),
    key("outlets.mass_rate", "mass flow, kg/s", Default("all that come there"), "Mass flow at most, the lowest along gravity first.", "\"1 kg/h\""),
    key("laws", "table", Required, "Laws; each is stated, none has a default.", "[laws]"),
    key("laws.drag", "table", Required, "Drag on a particle.", "{ law = \"ergun-wen-yu\" }"),
    key("laws.drag.law", "`ergun-wen-yu`, `ergun`, `wen-yu`, `gidaspow`, `di-felice`, `koch-hill`, `beetstra` or `none`", Required, "Its law.", "\"ergun-wen-yu\""),
    key("laws.drag.model", "`a` or `b`", Default("`a`"), "How gas and particles share the pressure gradient: `a`, each by its share of the volume; `b`, the gas takes all, and a particle is as much lighter as the gas it displaces. The same for a bed at rest or in steady flow.", "\"b\""),
    key("laws.heat_transfer", "table", Required, "Heat transfer between gas and particle.", "{ law = \"gunn\" }"),
    key("laws.heat_transfer.law", "`gunn`, `wakao`, `gnielinski`, `ranz-marshall` or `none`", Required, "Its law.", "\"gunn\""),
    key("laws.mass_transfer", "table", Default("none"), "Mass transfer between gas and particles that react, by a law of heat transfer with the Schmidt number in place of the Prandtl number; required where reactions exchange gas.", "{ law = \"gunn\" }"),
    key("laws.mass_transfer.law", "`gunn`, `wakao`, `gnielinski`, `ranz-marshall` or `none`", Required, "Its law.", "\"gunn\""),
    key("laws.conduction", "table", Required, "Heat conduction between particles and to walls of a temperature.", "{ law = \"none\" }"),
    key("laws.conduction.law", "`batchelor-obrien`, `lens` or `none`", Required, "Law of contacts; the materials then need a conductivity.", "\"none\""),
    key("laws.conduction.area", "`overlap`, `force` or `load`", Default("`overlap`"), "By which overlap contacts conduct: the computed one; that of the real materials (`real_young`) under the computed elastic force; or that under `load`.", "\"force\""),
    key("laws.conduction.load", "force, N", Default("required with `load`"), "Force on every contact, where area is `load`.", "\"50 mN\""),
    key("laws.conduction.within", "length, m", Default("required with `load`"), "Widest gap that counts as a contact, where area is `load`.", "\"20 um\""),
    key("laws.conduction.gap", "table", Default("none"), "Conduction through the gas between surfaces that are near.", "{ law = \"cheng\" }"),
    key("laws.conduction.gap.law", "`rong-horio`, `cheng` or `none`", Required, "Its law: surfaces of one temperature each, or paths through solid, gas and solid.", "\"cheng\""),
    key("laws.conduction.gap.lens", "number", Default("0.2"), "Thickness of the film of gas over the radius; of `rong-horio`.", "0.2"),
    key("laws.conduction.gap.least_width", "length, m", Default("required with `rong-horio`"), "Least width of a gap (roughness); of `rong-horio`.", "\"1 um\""),
    key("laws.conduction.gap.cone", "number", Default("0.66"), "Radius of the cone of paths between two neighbours over the smaller radius, 0.56 (1 - eps)^(-1/3); of `cheng`.", "0.66"),
    key("laws.conduction.gap.widest", "number", Default("1"), "Widest gap over the smaller radius; of `cheng`.", "1"),
    key("laws.radiation", "table", Required, "Radiation between particles, to walls and surroundings; the gas is transparent.", "{ law = \"none\" }"),
    key("laws.radiation.law", "`view-factors`, `distance` or `none`", Required, "View factors by rays, with what stands between; by the distance alone, fitted to rays in random beds; or no radiation.", "\"view-factors\""),
    key("laws.radiation.surroundings", "temperature, K, or schedule, or `closed`", Default("required with a law"), "Temperature of what rays reach that meet no wall; `closed`: nothing leaves.", "\"300 K\""),
    key("laws.radiation.inside", "`isothermal` or `singh-kaviany`", Default("`isothermal`"), "Spheres of one temperature, or less radiation through the bed where they conduct so badly that their warm side cannot pass on what it receives; the materials then need a conductivity.", "\"singh-kaviany\""),
    key("laws.radiation.rays", "whole number", Default("1024"), "Rays a particle, 16 to 1000000; of `view-factors`.", "1024"),
    key("laws.radiation.range", "number", Default("3"), "Distance of centres in largest diameters up to which particles see each other, 1 or more.", "3"),
    key("laws.radiation.refresh", "time, s", Default("with every window"), "Views of moving particles hold for so much process time.", "\"10 s\""),
    key("coupling", "table", Required, "How gas and particles are coupled.", "[coupling]"),
    key("coupling.mapping", "`overlap`, `divided` or `centroid`", Required, "Mapping of a particle onto cells: exact volumes, satellite points, or its centre.", "\"overlap\""),
    key("coupling.smoother", "table", Default("see its keys"), "Smoother of the solid fraction.", "{ max_solid_fraction = 0.64 }"),
    key("coupling.smoother.max_solid_fraction", "number", Default("0.64"), "Largest solid fraction of a cell, between 0 and 1.", "0.64"),
    key("coupling.smoother.tolerance", "number", Default("1e-4"), "Excess left at the end, as a share of the solid volume.", "1e-4"),
    key("coupling.smoother.diffusion_length", "length, m", Default("half the mean diameter where that is above a third of the cell size, else 0 m"), "Length of the diffusion of the solid fraction, zero or above.", "\"0 mm\""),
    key("coupling.smoother.excluded", "list of tables", Default("none"), "Zones, such as burner ducts, into and out of which the smoother moves nothing: cells whose centres lie there.", "[{ box = { from = \"0 0 0 mm\", to = \"10 10 50 mm\" } }]"),
    key("coupling.smoother.excluded.box", "table", OneOf, "A box along the axes. Either this or `cylinder`.", "{ from = \"0 0 0 mm\", to = \"10 10 50 mm\" }"),
    key("coupling.smoother.excluded.box.from", "three lengths, m", Required, "Corner with the smallest coordinates.", "\"0 0 0 mm\""),
    key("coupling.smoother.excluded.box.to", "three lengths, m", Required, "Corner with the largest coordinates.", "\"10 10 50 mm\""),
    key("coupling.smoother.excluded.cylinder", "table", OneOf, "A cylinder of any direction. Either this or `box`.", "{ from = \"0 0 0 mm\", to = \"0 0 50 mm\", radius = \"8 mm\" }"),
    key("coupling.smoother.excluded.cylinder.from", "three lengths, m", Required, "Centre of one end.", "\"0 0 0 mm\""),
    key("coupling.smoother.excluded.cylinder.to", "three lengths, m", Required, "Centre of the other end.", "\"0 0 50 mm\""),
    key("coupling.smoother.excluded.cylinder.radius", "length, m", Required, "Radius.", "\"8 mm\""),
    key("coupling.exchange", "table", Default("see its keys"), "Repetition of windows.", "{ tolerance = 1e-3, attempts = 4 }"),
    key("coupling.exchange.tolerance", "number", Default("1e-3"), "A window is repeated while the relative mismatch of the exchange is above this.", "1e-3"),
    key("coupling.exchange.attempts", "whole number", Default("4"), "Attempts per window at most, 1 to 1000.", "4"),
    key("coupling.deadline", "time, s", Default("60 s"), "The longest wall time that a solver may stay silent.", "\"60 s\""),
    key("openfoam", "table", Default("all inputs are generated"), "What only an OpenFOAM gas needs; a native gas ignores it.", "[openfoam]"),
    key("openfoam.template", "path", Default("none"), "Folder of OpenFOAM files to start from.", "\"foam\""),
    key("openfoam.solver", "`calcineGasFoam`, `buoyantPimpleFoam`, `rhoPimpleFoam`, `reactingFoam`", Default("`calcineGasFoam`"), "Program of an OpenFOAM gas: Calcine's own, or a stock solver with Calcine's sources in it, which is approximate (docs/stock-solvers.md).", "\"buoyantPimpleFoam\""),
    key("openfoam.start", "path", Default("`gas.initial`"), "Time directory that OpenFOAM wrote on the same mesh, of a whole (reconstructed) case: its T, p (absolute), U (superficial) and mass fractions, as far as they are there, are the start of the gas.", "\"foam/0.5\""),
    key("openfoam.ranks", "whole number", Default("1"), "MPI ranks; `--ranks-gas` goes before it.", "4"),
    key("liggghts", "table", Default("all inputs are generated"), "What only LIGGGHTS particles need; native particles ignore it.", "[liggghts]"),
    key("liggghts.template", "path", Default("none"), "LIGGGHTS script of the user's own for particles that move, in place of the generated one (docs/own-liggghts-script.md).", "\"in.bed\""),
    key("liggghts.wall_impulse", "true or false", Default("false"), "Whether LIGGGHTS counts the impulse of walls, for the line `particle_momentum` of the ledger; it then goes step by step. Native particles always count it.", "true"),
    key("liggghts.ranks", "whole number", Default("1"), "MPI ranks; `--ranks-particles` goes before it.", "2"),
    key("output", "table", Required, "What is written.", "[output]"),
    key("output.every", "time, s", Required, "A snapshot each so much process time, and one at the start and the end.", "\"60 s\""),
    key("output.series_every", "time, s", Default("with every snapshot"), "A row of the time series each so much process time.", "\"1 s\""),
    key("output.gas", "list of `temperature`, `velocity`, `pressure`, `density`, `void_fraction`, `mass_fractions`", Default("`temperature`"), "Gas fields; `mass_fractions` of each species of a mixture, by its name.", "[\"temperature\", \"velocity\"]"),
    key("output.particles", "list of `temperature`, `velocity`, `heat`, `force`, `void_fraction`, `slip`, `mass`, `solids`", Default("`temperature`"), "Particle fields; `force` is that of the gas, `void_fraction` and `slip` what the laws saw, `solids` the mass fractions of what particles that react are made of.", "[\"temperature\"]"),
    key("probes", "list of tables", Default("none"), "Points at which fields are sampled with every snapshot, into `results.h5` and `probes/`.", "[[probes]]"),
    key("probes.name", "text", Required, "Name; no two alike.", "\"axis\""),
    key("probes.of", "list of `gas`, `particles`", Default("`gas`"), "What is sampled: `gas` (the cell that holds a point), `particles` (the one that holds a point, else the nearest whose surface is within its own diameter).", "[\"gas\", \"particles\"]"),
    key("probes.point", "three lengths, m", OneOf, "A single point. One of `line`, `point`, `points`.", "\"0 0 10 mm\""),
    key("probes.points", "list of three lengths, m", OneOf, "Points. One of `line`, `point`, `points`.", "[\"0 0 10 mm\", \"0 0 20 mm\"]"),
    key("probes.line", "table", OneOf, "Points on a line. One of `line`, `point`, `points`.", "{ from = \"0 0 0 mm\", to = \"0 0 300 mm\", points = 100 }"),
    key("probes.line.from", "three lengths, m", Required, "First point.", "\"0 0 0 mm\""),
    key("probes.line.to", "three lengths, m", Required, "Last point.", "\"0 0 300 mm\""),
    key("probes.line.points", "whole number", Required, "Number of points, 2 to 1000000.", "100"),
    key("quantities", "list of tables", Default("none"), "Quantities of interest.", "[[quantities]]"),
    key("quantities.name", "text", Required, "Name; no two alike.", "\"pressure_drop\""),
    key("quantities.measure", "table", Required, "Exactly one of `difference`, `gas`, `particles`, `particle`, `wall_heat` and `surface_angle`.", "{ particles = \"temperature\", statistic = \"mean\" }"),
    key("quantities.measure.difference", "`pressure` or `temperature`", OneOf, "Area mean on the first of `patches` minus that on the second.", "\"pressure\""),
    key("quantities.measure.patches", "two texts", Default("none"), "The two patches; required with `difference`.", "[\"bottom\", \"top\"]"),
    key("quantities.measure.gas", "`temperature`, `pressure`, `density`, `speed`, `void_fraction` or `mass_fraction`", OneOf, "A statistic of the gas: over all cells (the mean over the volume of gas), over `patch` or over `probe`.", "\"temperature\""),
    key("quantities.measure.patch", "text", Default("all cells"), "The patch, with `gas`; the mean is over its area.", "\"top\""),
    key("quantities.measure.probe", "text", Default("everywhere"), "The probe, with `gas` or `particles`.", "\"axis\""),
    key("quantities.measure.of", "text", Default("none"), "The species of the gas, or the solid of particles that react, of which a `mass_fraction` is; required with it.", "\"CO2\""),
    key("quantities.measure.particles", "`temperature`, `speed`, `height`, `mass`, `diameter` or `mass_fraction`", OneOf, "A statistic (of the height, z, of the centre, or of the speed in process time, too) over all particles, over those of `population` or over those at `probe`.", "\"temperature\""),
    key("quantities.measure.population", "text", Default("all"), "The population, with `particles`.", "\"beads\""),
    key("quantities.measure.statistic", "`mean`, `min` or `max`", Default("with `probe` the mean"), "The statistic; required with `gas` and `particles`.", "\"mean\""),
    key("quantities.measure.particle", "`temperature`, `speed`, `height`, `mass`, `diameter` or `mass_fraction`", OneOf, "The value of one particle.", "\"temperature\""),
    key("quantities.measure.number", "whole number", Default("none"), "Which particle, counted from 1; required with `particle`.", "10"),
    key("quantities.measure.wall_heat", "text", OneOf, "Heat in W from a wall of a temperature, or from `surroundings`, into the particles.", "\"hot\""),
    key("quantities.measure.surface_angle", "table", OneOf, "Slope of the bed in a drum, in rad: the angle by which the centre of mass of all particles has turned about an axis from straight below it; a flat surface stands across the line between them.", "{ point = \"0 0 0 mm\", axis = \"0 1 0\" }"),
    key("quantities.measure.surface_angle.point", "three lengths, m", Required, "A point of the axis.", "\"0 0 0 mm\""),
    key("quantities.measure.surface_angle.axis", "three numbers", Required, "Direction of the axis; angles count as rotations about it do.", "\"0 1 0\""),
    key("quantities.agree", "band", Default("not compared"), "Largest difference between pairings: a share, or in the unit of the quantity.", "\"1 %\""),
    key("quantities.agree_from", "time, s", Default("the start"), "Process time from which `agree` holds: before it the quantity may depend on how single particles collide.", "\"0.3 s\""),
    key("quantities.agree_over", "time, s", Default("values as they are"), "Process time over which recorded values are averaged before pairings are compared; for what fluctuates. With `agree`.", "\"1 s\""),
    key("quantities.expect", "table", Default("none"), "Expected value.", "{ at = \"10 min\", value = \"180 Pa\", within = \"5 %\" }"),
    key("quantities.expect.at", "time, s", Default("the end"), "Process time at which it holds.", "\"10 min\""),
    key("quantities.expect.value", "as the field measured", Required, "The value.", "\"180 Pa\""),
    key("quantities.expect.within", "band", Required, "How far off it may be.", "\"5 %\""),
];

/// Where the part of `docs/case-file.md` that is made from the table begins.
pub const BEGIN: &str = "## All keys\n";

const HEAD: &str = "
Made from the table of the reader. A required key is so where its table is there; `NAME` is a name
that you choose; entries of lists count from 0: `--set \"particles[0].diameter=9 mm\"`.
";

/// The last part of `docs/case-file.md`, from [`BEGIN`] on.
pub fn markdown() -> String {
    let mut text = format!("{BEGIN}{HEAD}");
    let mut section = "";
    text.push_str("\n### The file\n\n");
    text.push_str(TABLE);
    for key in KEYS {
        let head = key.key.split('.').next().unwrap_or(key.key);
        if key.key == head && (key.value == "table" || key.value == "list of tables") {
            section = head;
            text.push_str(&format!("\n### `{section}`\n\n"));
            text.push_str(TABLE);
        }
        debug_assert!(section.is_empty() || section == head, "{}", key.key);
        let need = match key.need {
            Required => "required".to_owned(),
            OneOf => "one of".to_owned(),
            Default(without) => without.to_owned(),
        };
        text.push_str(&format!(
            "| `{}` | {} | {need} | {} | `{}` |\n",
            key.key, key.value, key.meaning, key.example
        ));
    }
    text
}

const TABLE: &str =
    "| Key | Value | Required, or default | Meaning | Example |\n|---|---|---|---|---|\n";

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;
    use crate::case::table::{Problems, Reader};

    #[test]
    fn the_table_holds_exactly_the_keys_that_the_reader_asks_for() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let mut asked = BTreeSet::new();
        for folder in ["cases", "tests/inputs/good"] {
            for entry in std::fs::read_dir(root.join(folder)).unwrap() {
                let path = entry.unwrap().path();
                if path.extension().is_none_or(|extension| extension != "toml") {
                    continue;
                }
                let text = std::fs::read_to_string(&path).unwrap();
                let document = toml_edit::Document::parse(text.as_str()).unwrap();
                let problems = Problems::default();
                let reader = Reader::root(&problems, document.as_table());
                crate::case::sections::case(&reader, &path, &text, String::new());
                asked.append(&mut problems.asked());
            }
        }
        let known: BTreeSet<String> = KEYS.iter().map(|key| key.key.to_owned()).collect();
        assert_eq!(known.len(), KEYS.len(), "a key stands twice");
        let missing: Vec<_> = asked.difference(&known).collect();
        let never: Vec<_> = known.difference(&asked).collect();
        assert!(missing.is_empty(), "not in the table: {missing:?}");
        assert!(never.is_empty(), "the reader never asks for: {never:?}");
    }

    #[test]
    fn every_example_is_toml() {
        for key in KEYS
            .iter()
            .filter(|key| !key.example.starts_with("[[") || key.example.contains('"'))
        {
            let text = if key.value == "table" && key.example.starts_with('[') {
                key.example.to_owned()
            } else {
                format!("x = {}", key.example)
            };
            assert!(toml_edit::Document::parse(text.as_str()).is_ok(), "{text}");
        }
    }

    #[test]
    fn the_page_of_the_docs_is_made_from_the_table() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/case-file.md");
        let mut written = std::fs::read_to_string(&page).unwrap();
        let begin = written.find(BEGIN).unwrap_or(written.len());
        if std::env::var_os("CALCINE_WRITE_DOCS").is_some() {
            let prose = written[..begin].trim_end();
            std::fs::write(&page, format!("{prose}\n\n{}", markdown())).unwrap();
            written = std::fs::read_to_string(&page).unwrap();
        }
        let begin = written.find(BEGIN).unwrap_or(written.len());
        assert_eq!(
            &written[begin..],
            markdown(),
            "set CALCINE_WRITE_DOCS=1 and run this test again to write docs/case-file.md"
        );
    }
}
