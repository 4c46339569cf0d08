//! The interior of the particles of a case.

use calcine_coupler::interior::reacting::SolidChemistry;
use calcine_coupler::interior::{HeatNetwork, ParticleModel, Reacting, Thin};
use calcine_coupler::part::ParticleFields;
use calcine_coupler::physics::gas_model::GasModel;

use super::error::AssemblyError;
use super::prepared::PreparedCase;
use crate::case::model::{Case, ReactionSpec};
use crate::laws;

/// The interior of the particles that the run starts with; those of a checkpoint may be others than
/// those of the case, and get their temperatures from it.
pub(super) fn interior(
    case: &Case,
    prepared: &PreparedCase,
    particles: &ParticleFields<'_>,
) -> Result<Box<dyn ParticleModel>, AssemblyError> {
    let all = 0..particles.id.len();
    let start = prepared.temperature.iter().copied();
    let density = |p: usize| {
        case.materials[case.particles[particles.population[p] as usize].material].density
    };
    let volume = |p: usize| 4.0 / 3.0 * std::f64::consts::PI * particles.radius[p].powi(3);
    let material = |p: usize| case.particles[particles.population[p] as usize].material;
    let network = laws::heat(case).map(|laws| {
        let walls = case.walls.iter().zip(&case.wall_temperatures);
        let warm = walls.filter(|(_, temperature)| temperature.is_some());
        HeatNetwork::new(
            laws,
            laws::thermal(case),
            all.clone().map(material).collect(),
            warm.map(|(wall, _)| wall.material).collect(),
        )
    });
    let masses: Vec<f64> = all.clone().map(|p| density(p) * volume(p)).collect();
    let materials: Vec<usize> = all.clone().map(material).collect();
    let temperature = start
        .chain(std::iter::repeat(case.gas.temperature))
        .take(all.len())
        .collect();
    if case.chemistry.reactions.is_empty() {
        let laws = case.materials.iter().map(|m| m.heat_capacity.clone());
        let made = Thin::new(masses, materials, laws.collect(), temperature, network);
        return Ok(Box::new(made));
    }
    let made = Reacting::new(
        chemistry(case)?,
        &case.chemistry.compositions,
        &masses,
        materials,
        temperature,
        network,
    );
    Ok(Box::new(made.with_sizes(case.chemistry.sizes.clone())))
}

/// The reactions of a case.
pub fn chemistry(case: &Case) -> Result<SolidChemistry, AssemblyError> {
    let gas = match &case.gas.properties {
        GasModel::Mixture(mixture) => Some(mixture.clone()),
        GasModel::Perfect(_) | GasModel::Constant(_) => None,
    };
    let ReactionSpec {
        solids, reactions, ..
    } = case.chemistry.clone();
    Ok(SolidChemistry::new(solids, gas, reactions)?)
}
