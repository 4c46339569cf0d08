//! The inside of the particles of a case: a model for each material and each prescribed temperature, and the network between them.

use calcine_coupler::coordinator::RunError;
use calcine_coupler::interior::reacting::SolidChemistry;
use calcine_coupler::interior::{
    HeatNetwork, ParticleModel, PrescribedTemperature, Reacting, Thin,
};
use calcine_coupler::models::ParticleModels;
use calcine_coupler::part::ParticleFields;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::sphere;

use super::error::AssemblyError;
use super::prepared::PreparedCase;
use crate::case::model::{Case, ReactionSpec};
use crate::laws;

/// Makes the model of the particles of a material by its name, without particles yet; `None` for the one that the case
/// asks for.
pub type ModelFactory<'a> = dyn Fn(&str) -> Option<Box<dyn ParticleModel>> + 'a;

/// The models of all materials that have particles, with the particles that the run starts with; those of a
/// checkpoint may be others than those of the case, and get their state from it.
pub(super) fn models(
    case: &Case,
    prepared: &PreparedCase,
    particles: &ParticleFields<'_>,
    own: &ModelFactory<'_>,
) -> Result<ParticleModels, AssemblyError> {
    let mut made: Vec<Box<dyn ParticleModel>> = Vec::new();
    let mut place = vec![None; case.materials.len()];
    let mut model_of = Vec::new();
    for population in &case.particles {
        let material = population.material;
        if let Some(schedule) = &population.prescribed_temperature {
            let law = case.materials[material].heat_capacity.clone();
            made.push(Box::new(PrescribedTemperature::new(
                law,
                schedule.0.clone(),
            )));
            model_of.push(made.len() - 1);
            continue;
        }
        let index = match place[material] {
            Some(index) => index,
            None => {
                let given = own(&case.materials[material].name);
                made.push(match given {
                    Some(model) => model,
                    None => model(case, material)?,
                });
                made.len() - 1
            }
        };
        place[material] = Some(index);
        model_of.push(index);
    }
    let mut models = ParticleModels::new(made, model_of).map_err(RunError::from)?;
    let density = |p: usize| {
        case.materials[case.particles[particles.population[p] as usize].material].density
    };
    let masses: Vec<f64> = (0..particles.len())
        .map(|p| sphere::mass(particles.radius[p], density(p)))
        .collect();
    let start = prepared.temperature.iter().copied();
    let temperature: Vec<f64> = start
        .chain(std::iter::repeat(case.gas.temperature))
        .take(particles.len())
        .collect();
    let filled = models.fill(particles, &masses, &temperature);
    filled.map_err(RunError::from)?;
    Ok(models)
}

/// The model that the case asks for.
fn model(case: &Case, material: usize) -> Result<Box<dyn ParticleModel>, AssemblyError> {
    if case.chemistry.reactions.is_empty() {
        let law = case.materials[material].heat_capacity.clone();
        return Ok(Box::new(Thin::new(law)));
    }
    let made = Reacting::new(chemistry(case)?, &case.chemistry.compositions[material]);
    let size = case.chemistry.sizes[material].clone();
    let used_up = case.materials[material].used_up;
    Ok(Box::new(made.with_size(size).with_used_up(used_up)))
}

/// Heat between particles and to walls, without particles yet; `None` where there is none.
pub(super) fn network(case: &Case) -> Option<HeatNetwork> {
    let laws = laws::heat(case)?;
    let walls = case.walls.iter().zip(&case.wall_temperatures);
    let warm = walls.filter(|(_, temperature)| temperature.is_some());
    let materials = warm.map(|(wall, _)| wall.material).collect();
    Some(HeatNetwork::new(laws, laws::thermal(case), materials))
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
