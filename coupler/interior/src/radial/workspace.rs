//! Memory of the particles that are computed side by side, one a lane, reused; no result depends on what it was used for before, nor
//! on what the other lanes hold.

use calcine_numerics::LaneTridiagonal;

use super::grid::ShellGeometry;
use super::rates::ShellRate;
use super::side_by_side::{LANES, Wide};

/// The unknowns of a particle: of each shell, from the centre outwards, and of its surface, the last node.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile {
    /// Temperatures of all nodes in K.
    pub temperature: Vec<Wide>,
    /// Partial pressures of all nodes in Pa, gas by gas within each.
    pub pressure: Vec<Wide>,
    /// Amounts of solids in mol, solid by solid within each shell.
    pub amount: Vec<Wide>,
    /// What each reaction turned over in the stage at hand, in mol, reaction by reaction within each shell.
    pub extent: Vec<Wide>,
}

/// What a stage begins from: conserved quantities of each shell.
#[derive(Clone, Debug, Default)]
pub(super) struct StageBase {
    /// Enthalpy with that of formation in J.
    pub enthalpy: Vec<Wide>,
    /// Amounts of solids and gases in mol.
    pub amount: Vec<Wide>,
    pub gas: Vec<Wide>,
    /// Length in s by which rates of reactions count in each shell.
    pub weight: Vec<Wide>,
}

/// Coefficients that are held while the equations of a stage are solved.
#[derive(Clone, Debug, Default)]
pub(super) struct Coefficients {
    pub geometry: ShellGeometry<LANES>,
    /// Of each shell the volume and that of its pores in m³, and their share.
    pub volume: Vec<Wide>,
    pub pores: Vec<Wide>,
    pub porosity: Vec<Wide>,
    /// Of each node the conductivity in W/m/K.
    pub conductivity: Vec<Wide>,
    /// Of the outer face of each shell: W/K; the share of the inner node in the enthalpy that passes.
    pub conductance: Vec<Wide>,
    pub heat_share: Vec<Wide>,
    /// Diffusive flow of each gas by its own pressure in mol/s/Pa; what the others drag along of it, over its mole fraction, by the pressure of
    /// each, matrix by matrix; and flow by pressure in mol/s/Pa².
    pub diffusion: Vec<Wide>,
    pub drag: Vec<Wide>,
    pub flow: Vec<Wide>,
    /// Share of the inner node in the pressure of each gas that is carried.
    pub share: Vec<Wide>,
    /// Of the film: A c β of each gas in mol/s, flow by pressure in mol/s/Pa, heat in W/K.
    pub film: Vec<Wide>,
    pub opening: Wide,
    pub film_heat: Wide,
}

/// Flows outwards at a profile.
#[derive(Clone, Debug, Default)]
pub(super) struct Flows {
    /// Of each gas through the outer face of each shell in mol/s.
    pub gas: Vec<Wide>,
    /// Of each gas through the film in mol/s.
    pub film: Vec<Wide>,
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
    pub start_gas: Vec<Wide>,
    /// Stage one, and the iterate.
    pub first_stage: Profile,
    pub now: Profile,
    pub now_gas: Vec<Wide>,
    pub base: StageBase,
    pub held: Coefficients,
    pub flows: Flows,
    /// What each reaction turned over in the step, in mol, reaction by reaction within each shell.
    pub turned: Vec<Wide>,
    /// What came into each shell in the first stage: gases in mol, enthalpy in J.
    pub came: Vec<Wide>,
    pub warmed: Vec<Wide>,
    /// Amounts that shells have where nothing has reacted, and their volumes then.
    pub unreacted: Vec<Wide>,
    pub first_volume: Vec<Wide>,
    /// Molar enthalpies with those of formation in J/mol, and heat capacities in J/mol/K: of solids in shells, of gases in nodes.
    pub solid_enthalpy: Vec<Wide>,
    pub solid_capacity: Vec<Wide>,
    pub gas_enthalpy: Vec<Wide>,
    pub gas_capacity: Vec<Wide>,
    /// Elimination of the extents: what is left at fixed temperature and pressures, and slopes by these.
    pub extent_rest: Vec<Wide>,
    pub extent_by_temperature: Vec<Wide>,
    pub extent_by_pressure: Vec<Wide>,
    pub rate: ShellRate,
    pub small: Vec<Wide>,
    pub algebra: LaneTridiagonal<LANES>,
    pub entries: Vec<Wide>,
    pub right: Vec<Wide>,
    /// Enthalpy of each shell at the start of a step in J, and as the last stage left it.
    pub start_enthalpy: Vec<Wide>,
    pub now_enthalpy: Vec<Wide>,
    /// Length in s by which flows count in the stage at hand.
    pub length: Wide,
    /// One in the lanes that take coefficients anew in this round, and in those whose enthalpy at the start is not known yet.
    pub updating: Wide,
    pub fresh: Wide,
    /// One in the lanes whose surface is without contacts and views, to find how it follows heat.
    pub alone: Wide,
    /// True where a lane took up a particle since shells were measured.
    pub taken_up: bool,
    /// What the round found: the least volume of pores in m³, zero where coefficients are finite (else NaN), and the largest relative
    /// change that it asked for.
    pub room: Wide,
    pub broken: Wide,
    pub moved: Wide,
    /// Scratch of a face: diffusive flows, gas by gas.
    pub matrix: Vec<Wide>,
}

impl RadialWorkspace {
    /// Memory for so many shells, solids, gases and reactions.
    pub fn new([shells, solids, gases, reactions]: [usize; 4]) -> Self {
        let nodes = shells + 1;
        let block = 1 + gases;
        let algebra = LaneTridiagonal::new(nodes, block);
        let profile = || Profile {
            temperature: vec![Wide::default(); nodes],
            pressure: vec![Wide::default(); nodes * gases],
            amount: vec![Wide::default(); shells * solids],
            extent: vec![Wide::default(); shells * reactions],
        };
        let mut geometry = ShellGeometry::default();
        geometry.resize(shells);
        Self {
            shells,
            solids,
            gases,
            reactions,
            start: profile(),
            start_gas: vec![Wide::default(); shells * gases],
            first_stage: profile(),
            now: profile(),
            now_gas: vec![Wide::default(); shells * gases],
            base: StageBase {
                enthalpy: vec![Wide::default(); shells],
                amount: vec![Wide::default(); shells * solids],
                gas: vec![Wide::default(); shells * gases],
                weight: vec![Wide::default(); shells],
            },
            held: Coefficients {
                geometry,
                volume: vec![Wide::default(); shells],
                pores: vec![Wide::default(); shells],
                porosity: vec![Wide::default(); shells],
                conductivity: vec![Wide::default(); nodes],
                conductance: vec![Wide::default(); shells],
                heat_share: vec![Wide::default(); shells],
                diffusion: vec![Wide::default(); shells * gases],
                drag: vec![Wide::default(); shells * gases * gases],
                flow: vec![Wide::default(); shells],
                share: vec![Wide::default(); shells * gases],
                film: vec![Wide::default(); gases],
                opening: Wide::default(),
                film_heat: Wide::default(),
            },
            flows: Flows {
                gas: vec![Wide::default(); shells * gases],
                film: vec![Wide::default(); gases],
            },
            turned: vec![Wide::default(); shells * reactions],
            came: vec![Wide::default(); shells * gases],
            warmed: vec![Wide::default(); shells],
            unreacted: vec![Wide::default(); shells * solids],
            first_volume: vec![Wide::default(); shells],
            solid_enthalpy: vec![Wide::default(); shells * solids],
            solid_capacity: vec![Wide::default(); shells * solids],
            gas_enthalpy: vec![Wide::default(); nodes * gases],
            gas_capacity: vec![Wide::default(); nodes * gases],
            extent_rest: vec![Wide::default(); shells * reactions],
            extent_by_temperature: vec![Wide::default(); shells * reactions],
            extent_by_pressure: vec![Wide::default(); shells * reactions * gases],
            rate: ShellRate::new(solids, gases),
            small: vec![Wide::default(); reactions * (reactions + 2 + gases)],
            entries: vec![Wide::default(); algebra.entries()],
            right: vec![Wide::default(); nodes * block],
            algebra,
            start_enthalpy: vec![Wide::default(); shells],
            now_enthalpy: vec![Wide::default(); shells],
            length: Wide::default(),
            updating: Wide::default(),
            fresh: Wide::default(),
            alone: Wide::default(),
            taken_up: false,
            room: Wide::default(),
            broken: Wide::default(),
            moved: Wide::default(),
            matrix: vec![Wide::default(); gases * gases],
        }
    }
}

/// Copies the values of a lane.
pub(super) fn copy_lane(to: &mut [Wide], from: &[Wide], lane: usize) {
    for (to, from) in to.iter_mut().zip(from) {
        to[lane] = from[lane];
    }
}

/// Fills a lane with a value.
pub(super) fn fill_lane(to: &mut [Wide], lane: usize, value: f64) {
    to.iter_mut().for_each(|to| to[lane] = value);
}
