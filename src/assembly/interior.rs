//! The inside of the particles of a case: a model for each material and each prescribed temperature, and the network between them.

use calcine_coupler::coordinator::RunError;
use calcine_coupler::interior::radial::{
    PoreGas, PorousSolid, RadialError, RadialNumerics, ShellResolution, StandingGas,
};
use calcine_coupler::interior::reacting::{SizeChange, SolidChemistry};
use calcine_coupler::interior::{
    HeatNetwork, ParticleModel, PrescribedTemperature, Radial, Reacting, Thin,
};
use calcine_coupler::models::ParticleModels;
use calcine_coupler::part::ParticleFields;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::pores::Permeability;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::physics::sphere;

use super::error::AssemblyError;
use super::prepared::PreparedCase;
use crate::case::model::{Case, Inside, ReactionSpec};
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
    let own = &case.materials[material];
    if own.inside != Inside::Thin {
        return radial(case, material);
    }
    if case.chemistry.reactions.is_empty() {
        return Ok(Box::new(Thin::new(own.heat_capacity.clone())));
    }
    let mut chemistry = case.chemistry.clone();
    chemistry.reactions.retain(|one| !one.rate.needs_shells());
    let chemistry = with_gas(case, chemistry, true)?;
    let made = Reacting::new(chemistry, &case.chemistry.compositions[material]);
    let size = case.chemistry.sizes[material].clone();
    Ok(Box::new(made.with_size(size).with_used_up(own.used_up)))
}

/// The model of particles with shells.
fn radial(case: &Case, material: usize) -> Result<Box<dyn ParticleModel>, AssemblyError> {
    let own = &case.materials[material];
    let spec = &own.radial;
    let reacts = !case.chemistry.reactions.is_empty();
    let (chemistry, fractions, true_densities, size) = if reacts {
        let chemistry = match own.composition {
            Some(_) => of_shells(case)?,
            None => SolidChemistry::new(case.chemistry.solids.clone(), None, Vec::new())?,
        };
        (
            chemistry,
            case.chemistry.compositions[material].clone(),
            case.chemistry.true_densities[material].clone(),
            case.chemistry.sizes[material].clone(),
        )
    } else {
        let solid = SolidSpecies::inert(&own.name, own.heat_capacity.clone());
        let chemistry = SolidChemistry::new(vec![solid], None, Vec::new())?;
        (
            chemistry,
            vec![1.0],
            vec![own.true_density().unwrap_or(f64::INFINITY)],
            SizeChange::Constant,
        )
    };
    let standing = || StandingGas {
        model: case.gas.properties.clone(),
        composition: case.gas.composition.clone(),
    };
    let pores = match &chemistry.gas {
        Some(gas) => {
            let mut fractions = vec![0.0; gas.names().len()];
            gas.mole_fractions(&case.gas.composition, &mut fractions);
            PoreGas {
                pressure: case.gas.pressure,
                fractions,
            }
        }
        None => PoreGas::default(),
    };
    let missing = || AssemblyError::Radial(RadialError::Shells { shells: 0 });
    let solid = PorousSolid {
        true_densities,
        conductivity: own.conductivity.clone().ok_or_else(missing)?,
        conduction: spec.conduction,
        // Without gas there are no pores to speak of.
        pore_diameter: spec.pore_diameter.unwrap_or(1.0),
        tortuosity: spec.tortuosity.unwrap_or(1.0),
        permeability: spec.permeability.unwrap_or(Permeability::Constant(1.0)),
        size,
        standing_gas: chemistry.gas.is_none().then(standing),
    };
    let numerics = RadialNumerics {
        grid: spec.grid,
        resolution: match own.inside {
            Inside::Auto => ShellResolution::Beyond {
                temperature: spec.turns[0],
                pressure: spec.turns[1],
            },
            _ => ShellResolution::All,
        },
        temperature: spec.errors[0],
        conversion: spec.errors[1],
    };
    let made = Radial::new(chemistry, &fractions, solid, pores, numerics);
    let made = made.map_err(AssemblyError::Radial)?;
    Ok(Box::new(made.with_used_up(own.used_up)))
}

/// The reactions of particles with shells: those by laws that leave layers to the shells.
fn of_shells(case: &Case) -> Result<SolidChemistry, AssemblyError> {
    let mut own = case.chemistry.clone();
    own.reactions.retain(|one| !one.rate.needs_thin());
    with_gas(case, own, case.chemistry.exchanges())
}

/// Reactions with the gas of a case, where they have one.
fn with_gas(
    case: &Case,
    own: ReactionSpec,
    exchanges: bool,
) -> Result<SolidChemistry, AssemblyError> {
    let gas = match &case.gas.properties {
        GasModel::Mixture(mixture) if exchanges => Some(mixture.clone()),
        _ => None,
    };
    Ok(SolidChemistry::new(own.solids, gas, own.reactions)?)
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
    with_gas(case, case.chemistry.clone(), true)
}
