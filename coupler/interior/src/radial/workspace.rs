//! Memory of one particle while it is computed, reused; no result depends on what it was used for before.

use calcine_numerics::BlockTridiagonal;
use calcine_numerics::LinearAlgebra;

use super::grid::ShellGeometry;
use super::rates::ShellRate;

/// The unknowns of a particle: of each shell, from the centre outwards, and of its surface, the last node.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile {
    /// Temperatures of all nodes in K.
    pub temperature: Vec<f64>,
    /// Partial pressures of all nodes in Pa, gas by gas within each.
    pub pressure: Vec<f64>,
    /// Amounts of solids in mol, solid by solid within each shell.
    pub amount: Vec<f64>,
    /// What each reaction turned over in the stage at hand, in mol, reaction by reaction within each shell.
    pub extent: Vec<f64>,
}

/// What a stage begins from: conserved quantities of each shell.
#[derive(Clone, Debug, Default)]
pub(super) struct StageBase {
    /// Enthalpy with that of formation in J.
    pub enthalpy: Vec<f64>,
    /// Amounts of solids and gases in mol.
    pub amount: Vec<f64>,
    pub gas: Vec<f64>,
    /// Length in s by which rates of reactions count in each shell.
    pub weight: Vec<f64>,
}

/// Coefficients that are held while the equations of a stage are solved.
#[derive(Clone, Debug, Default)]
pub(super) struct Coefficients {
    pub geometry: ShellGeometry,
    /// Of each shell the volume and that of its pores in m³.
    pub volume: Vec<f64>,
    pub pores: Vec<f64>,
    /// Of each node the conductivity in W/m/K.
    pub conductivity: Vec<f64>,
    /// Of the outer face of each shell: W/K; the share of the inner node in the enthalpy that passes.
    pub conductance: Vec<f64>,
    pub heat_share: Vec<f64>,
    /// Diffusive flows in mol/s/Pa, matrix by matrix, and those by pressure in mol/s/Pa².
    pub diffusion: Vec<f64>,
    pub flow: Vec<f64>,
    /// Share of the inner node in the pressure of each gas that is carried.
    pub share: Vec<f64>,
    /// Of the film: A c β of each gas in mol/s, flow by pressure in mol/s/Pa, heat in W/K.
    pub film: Vec<f64>,
    pub opening: f64,
    pub film_heat: f64,
}

/// Flows outwards at a profile.
#[derive(Clone, Debug, Default)]
pub(super) struct Flows {
    /// Of each gas through the outer face of each shell in mol/s.
    pub gas: Vec<f64>,
    /// Enthalpy with that of formation through it in W.
    pub enthalpy: Vec<f64>,
    /// Of each gas through the film in mol/s.
    pub film: Vec<f64>,
}

/// All of it.
#[derive(Debug)]
pub(super) struct RadialWorkspace {
    pub shells: usize,
    pub solids: usize,
    pub gases: usize,
    pub reactions: usize,
    /// The state at the start of a step, as amounts and temperatures.
    pub start: Profile,
    /// Amounts of gases in mol in the pores there.
    pub start_gas: Vec<f64>,
    /// Stage one, and the iterate.
    pub first_stage: Profile,
    pub now: Profile,
    pub now_gas: Vec<f64>,
    pub base: StageBase,
    pub held: Coefficients,
    pub flows: Flows,
    /// What each reaction turned over in the step, in mol, reaction by reaction within each shell.
    pub turned: Vec<f64>,
    /// What came into each shell in the first stage: gases in mol, enthalpy in J.
    pub came: Vec<f64>,
    pub warmed: Vec<f64>,
    /// Amounts that shells have where nothing has reacted, and their volumes then.
    pub unreacted: Vec<f64>,
    pub first_volume: Vec<f64>,
    /// Molar enthalpies with those of formation in J/mol, and heat capacities in J/mol/K: of solids in shells, of gases in nodes.
    pub solid_enthalpy: Vec<f64>,
    pub solid_capacity: Vec<f64>,
    pub gas_enthalpy: Vec<f64>,
    pub gas_capacity: Vec<f64>,
    /// Elimination of the extents: what is left at fixed temperature and pressures, and slopes by these.
    pub extent_rest: Vec<f64>,
    pub extent_by_temperature: Vec<f64>,
    pub extent_by_pressure: Vec<f64>,
    pub rate: ShellRate,
    pub small: Vec<f64>,
    pub algebra: BlockTridiagonal,
    pub entries: Vec<f64>,
    pub right: Vec<f64>,
    /// Enthalpy of each shell at the start of a step in J.
    pub start_enthalpy: Vec<f64>,
}

impl RadialWorkspace {
    /// Memory for so many shells, solids, gases and reactions.
    pub fn new([shells, solids, gases, reactions]: [usize; 4]) -> Self {
        let nodes = shells + 1;
        let block = 1 + gases;
        let algebra = BlockTridiagonal::new(nodes, block);
        let profile = || Profile {
            temperature: vec![0.0; nodes],
            pressure: vec![0.0; nodes * gases],
            amount: vec![0.0; shells * solids],
            extent: vec![0.0; shells * reactions],
        };
        let mut geometry = ShellGeometry::default();
        geometry.resize(shells);
        Self {
            shells,
            solids,
            gases,
            reactions,
            start: profile(),
            start_gas: vec![0.0; shells * gases],
            first_stage: profile(),
            now: profile(),
            now_gas: vec![0.0; shells * gases],
            base: StageBase {
                enthalpy: vec![0.0; shells],
                amount: vec![0.0; shells * solids],
                gas: vec![0.0; shells * gases],
                weight: vec![0.0; shells],
            },
            held: Coefficients {
                geometry,
                volume: vec![0.0; shells],
                pores: vec![0.0; shells],
                conductivity: vec![0.0; nodes],
                conductance: vec![0.0; shells],
                heat_share: vec![0.0; shells],
                diffusion: vec![0.0; shells * gases * gases],
                flow: vec![0.0; shells],
                share: vec![0.0; shells * gases],
                film: vec![0.0; gases],
                opening: 0.0,
                film_heat: 0.0,
            },
            flows: Flows {
                gas: vec![0.0; shells * gases],
                enthalpy: vec![0.0; shells],
                film: vec![0.0; gases],
            },
            turned: vec![0.0; shells * reactions],
            came: vec![0.0; shells * gases],
            warmed: vec![0.0; shells],
            unreacted: vec![0.0; shells * solids],
            first_volume: vec![0.0; shells],
            solid_enthalpy: vec![0.0; shells * solids],
            solid_capacity: vec![0.0; shells * solids],
            gas_enthalpy: vec![0.0; nodes * gases],
            gas_capacity: vec![0.0; nodes * gases],
            extent_rest: vec![0.0; shells * reactions],
            extent_by_temperature: vec![0.0; shells * reactions],
            extent_by_pressure: vec![0.0; shells * reactions * gases],
            rate: ShellRate::default(),
            small: vec![0.0; reactions * (reactions + 2 + gases)],
            entries: vec![0.0; algebra.entries()],
            right: vec![0.0; nodes * block],
            algebra,
            start_enthalpy: vec![0.0; shells],
        }
    }
}
