//! The columns that the protocol knows, with what each holds: catalogues and the reference in the C header come
//! from these two tables.

use crate::column_set::ColumnSet;

/// How many numbers an item has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnComponents {
    /// So many.
    Fixed(usize),
    /// One of each species.
    Species,
    /// Balances: seven numbers each of mass, energy, three of momentum, and each species.
    Balances,
    /// Of each patch one flow of heat, of mass, three of momentum, and one of each species; the number of one patch.
    PatchFlow,
}

/// Which links have a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnPresence {
    /// All of the role.
    Always,
    /// Those of a solver whose inputs Calcine does not write.
    ForeignInputs,
    /// Those of a gas with species.
    Species,
    /// Those of a turbulent gas.
    Turbulent,
    /// Those of a gas whose eddies go on in the bed.
    BedEddies,
    /// Those of a gas that says what comes back in through outlets.
    BackflowReport,
    /// Those of a gas that says what passes its patches.
    PatchReport,
    /// Those of a gas that answers commits with how its equations of turbulence were solved.
    TurbulenceReport,
    /// Those of particles that feel drag as they move.
    MovingDrag,
    /// Those of rows that stand for several real particles.
    Weights,
}

/// A column of the protocol.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ProtocolColumn {
    /// Which message carries it.
    pub record: ColumnSet,
    /// Its name.
    pub name: &'static str,
    /// How many numbers an item has.
    pub components: ColumnComponents,
    /// Unit in SI; "u64" for integers.
    pub unit: &'static str,
    /// One item per cell or particle, or one for the whole rank.
    pub per_item: bool,
    /// Which links have it.
    pub presence: ColumnPresence,
    /// What it holds.
    pub about: &'static str,
}

impl ColumnComponents {
    /// The number for a gas of so many species.
    pub fn count(self, species: usize) -> usize {
        match self {
            ColumnComponents::Fixed(count) => count,
            ColumnComponents::Species => species,
            ColumnComponents::Balances => NUMBERS_OF_BALANCE * (5 + species),
            ColumnComponents::PatchFlow => 5 + species,
        }
    }
}

/// Numbers of one balance.
pub const NUMBERS_OF_BALANCE: usize = 7;

const fn column(
    record: ColumnSet,
    name: &'static str,
    components: usize,
    unit: &'static str,
    about: &'static str,
) -> ProtocolColumn {
    ProtocolColumn {
        record,
        name,
        components: ColumnComponents::Fixed(components),
        unit,
        per_item: true,
        presence: ColumnPresence::Always,
        about,
    }
}

impl ProtocolColumn {
    const fn per_rank(mut self) -> Self {
        self.per_item = false;
        self
    }

    const fn only(mut self, presence: ColumnPresence) -> Self {
        self.presence = presence;
        self
    }

    const fn of_species(mut self) -> Self {
        self.components = ColumnComponents::Species;
        self.only(ColumnPresence::Species)
    }

    const fn of_patch_flows(mut self) -> Self {
        self.components = ColumnComponents::PatchFlow;
        self.per_rank().only(ColumnPresence::PatchReport)
    }

    const fn of_balances(mut self) -> Self {
        self.components = ColumnComponents::Balances;
        self.per_rank()
    }
}

use ColumnSet::{Committed, Owned, Start, State};

/// Columns of the role "gas"; an item is a cell.
#[rustfmt::skip]
pub const GAS: &[ProtocolColumn] = &[
    column(Owned, "cell", 1, "u64",
        "numbers in the whole mesh of this rank's cells, in the order of all other columns"),
    column(Owned, "centre", 3, "m",
        "centres of the cells; the coordinator compares them with its own").only(ColumnPresence::ForeignInputs),
    column(Owned, "volume", 1, "m^3",
        "volumes of the cells; the coordinator compares them with its own").only(ColumnPresence::ForeignInputs),
    column(Start, "void_fraction", 1, "1",
        "void fraction eps at the end of the window, above 0 and at most 1"),
    column(Start, "drag_coefficient", 1, "kg/s",
        "D: the drag on the gas of the cell is drag_source - D u, with u at the end of the window"),
    column(Start, "drag_source", 3, "N",
        "explicit part of the drag on the gas of the cell"),
    column(Start, "heat_coefficient", 1, "W/K",
        "K: the heat to the gas of the cell is heat_source - K T, with T at the end of the window"),
    column(Start, "heat_source", 1, "W",
        "explicit part of the heat to the gas of the cell"),
    column(State, "heat", 1, "W",
        "heat to the gas of the cell as the enthalpy equation took it, that of exchanged species included"),
    column(State, "drag", 3, "N",
        "drag on the gas of the cell as the momentum equation took it"),
    column(State, "temperature", 1, "K", "temperature"),
    column(State, "pressure", 1, "Pa", "absolute pressure, hydrostatic part included"),
    column(State, "density", 1, "kg/m^3", "density of the gas itself, not times eps"),
    column(State, "velocity", 3, "m/s",
        "interstitial velocity; before the first window, when nothing is known of the bed, superficial"),
    column(State, "pressure_gradient", 3, "Pa/m",
        "gradient of the pressure as the momentum equation has it"),
    column(State, "balances", 35, "kg,J,Ns",
        "of all ranks: mass, enthalpy, momentum along x, y, z, then each species; each as stored, stored_magnitude, \
         boundary, boundary_magnitude, exchange, source, source_magnitude").of_balances(),
    column(State, "storage_clock", 3, "Ns",
        "of all ranks: what momentum, which moves on the motion clock, gets because mass is stored over another span: \
         the sum of u (1 - span_motion/storage_span) times the gas mass gained; a part of the momentum's sources")
        .per_rank(),
    column(State, "convergence", 5, "1",
        "outer_iterations, linear_iterations, residual, volume_residual (largest mismatch of the mass with the \
         equation of state, relative), converged (1 or 0)").per_rank(),
    column(State, "composition", 1, "1",
        "mass fractions, species by species within each cell").of_species(),
    column(State, "backflow", 3, "1,m/s,1",
        "gas that comes in through outlets in the state of the cell behind: faces of the rank with it, the largest \
         superficial velocity inwards, the number of the cell there in the whole mesh; 0 0 0 where there is none")
        .per_rank().only(ColumnPresence::BackflowReport),
    column(State, "patch_flows", 5, "W,kg/s,N,kg/s",
        "of all ranks, patch by patch in the order of the mesh, means over the window and + into the gas: heat (sensible \
         enthalpy from 298.15 K on, with conduction), mass, momentum along x, y, z without pressure, then each species")
        .of_patch_flows(),
    column(Start, "species_source", 1, "kg/s",
        "S: mass of a species to the gas of the cell is S - C Y, with Y at the end of the window").of_species(),
    column(Start, "species_coefficient", 1, "kg/s",
        "C, 0 or more; the last species has none").of_species(),
    column(Start, "species_taken", 1, "kg/s",
        "mass of a species that leaves with the gas' own temperature").of_species(),
    column(Start, "species_heat", 1, "W",
        "sensible enthalpy that comes with species: species_heat less the sum of species_taken times h(T)")
        .only(ColumnPresence::Species),
    column(State, "turbulent_energy", 1, "m^2/s^2", "k").only(ColumnPresence::Turbulent),
    column(State, "dissipation", 1, "m^2/s^3", "epsilon").only(ColumnPresence::Turbulent),
    column(State, "eddy_viscosity", 1, "Pas",
        "void fraction times eddy viscosity; 0 in a bed at which eddies end").only(ColumnPresence::Turbulent),
    column(Start, "eddy_energy", 1, "m^2/s^3",
        "a: the particles of the cell add a + b k to the production of k, per mass of gas; 0 outside the bed")
        .only(ColumnPresence::BedEddies),
    column(Start, "eddy_dissipation", 1, "m^2/s^4",
        "e: the particles of the cell add e + C2 b epsilon to the production of epsilon, per mass of gas")
        .only(ColumnPresence::BedEddies),
    column(Start, "eddy_growth", 1, "1/s", "b").only(ColumnPresence::BedEddies),
    column(Committed, "turbulence_residual", 1, "1",
        "largest relative residual of an equation of turbulence that its linear solver left above its tolerance; 0 where \
         it left none").per_rank().only(ColumnPresence::TurbulenceReport),
];

/// Columns of the role "particles"; an item is a particle of the rank, in ascending id.
#[rustfmt::skip]
pub const PARTICLES: &[ProtocolColumn] = &[
    column(Start, "id", 1, "u64", "ids of the particles that the rank sent last, in its order"),
    column(Start, "force", 3, "N",
        "force of the gas; its impulse over the window is force times span_motion, whatever the steps"),
    column(State, "id", 1, "u64", "ids, ascending, never used twice"),
    column(State, "population", 1, "u64", "index of the population in the case file, from 0"),
    column(State, "position", 3, "m", "centre"),
    column(State, "velocity", 3, "m/s", "velocity, in motion time"),
    column(State, "angular_velocity", 3, "rad/s", "angular velocity, in motion time"),
    column(State, "radius", 1, "m", "radius"),
    column(State, "mass", 1, "kg", "mass"),
    column(State, "weight", 1, "1",
        "statistical weight: how many real particles the row stands for; force, impulse and mass are of one of them")
        .only(ColumnPresence::Weights),
    column(State, "impulse", 3, "Ns",
        "impulse that what was pushed gave the particle; of one that is held, what its support took up"),
    column(State, "support", 4, "s,Ns",
        "motion time that the steps of the window cover; impulse x, y, z that walls and held particles gave this \
         rank's free ones, NaN where it is not counted").per_rank(),
    column(Start, "drag_coefficient", 1, "kg/s",
        "K: beside the force a drag K (gas_velocity - v) acts, with the velocity v of the particle as it moves; its \
         impulse over the window is that of K over span_motion, whatever the steps; 0 where drag is in the force")
        .only(ColumnPresence::MovingDrag),
    column(Start, "gas_velocity", 3, "m/s",
        "velocity of the gas at the particle, in motion time").only(ColumnPresence::MovingDrag),
    column(State, "drag_impulse", 3, "Ns",
        "impulse of that drag, a part of the column impulse; of a particle that is held K gas_velocity span_motion")
        .only(ColumnPresence::MovingDrag),
];
