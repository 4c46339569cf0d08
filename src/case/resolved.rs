//! What `check` says of particles with shells: how far reactions outrun the pores, and what they take of memory.

use std::f64::consts::PI;

use calcine_coupler::interior::reacting::{Rate, Reaction};
use calcine_coupler::physics::gas::GAS_CONSTANT;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::pores::knudsen;
use calcine_coupler::physics::sphere;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::GasPatch;

use super::model::{Case, Inside, Population, SizeLaw};
use super::units::short3;

/// Lines of `check` about a population.
pub(super) fn lines(case: &Case, population: &Population) -> Vec<String> {
    let material = &case.materials[population.material];
    if material.inside == Inside::Thin {
        return Vec::new();
    }
    let (solids, gases) = match (&case.gas.properties, case.chemistry.reactions.is_empty()) {
        (_, true) => (1, 0),
        (GasModel::Mixture(gas), _) if case.chemistry.exchanges() => {
            (case.chemistry.solids.len(), gas.names().len())
        }
        _ => (case.chemistry.solids.len(), 0),
    };
    let shells = material.radial.grid.shells;
    // Its row and that of the attempt, and what it tells.
    let numbers = 2 * (shells * (1 + solids + gases) + 5 + gases) + 20 + 4 * gases;
    let mut all = vec![format!(
        "{shells} shells, {} bytes a particle{}",
        8 * numbers,
        if material.inside == Inside::Auto {
            "; one shell until the difference inside is too large"
        } else {
            ""
        }
    )];
    let GasModel::Mixture(gas) = &case.gas.properties else {
        return all;
    };
    let Ok(diameter) = population.sizes.mean() else {
        return all;
    };
    let exchanging = case.chemistry.reactions.iter();
    for one in exchanging.filter(|one| !one.gases.is_empty()) {
        let found = thiele(case, population, (one, gas), diameter);
        all.extend(found.map(|(number, kelvin)| {
            format!(
                "Thiele number R sqrt(r/(D c)) of {} at {} K {number:.2e}",
                one.name,
                short3(kelvin)
            )
        }));
    }
    all
}

/// Reactions whose solids would fill a particle before what they use up is gone.
pub(super) fn warnings(case: &Case) -> Vec<String> {
    let materials = case.materials.iter().enumerate();
    let resolved = materials.filter(|(_, one)| one.inside != Inside::Thin);
    let reactions = &case.chemistry.reactions;
    let each = resolved.flat_map(|(m, _)| reactions.iter().map(move |one| (m, one)));
    each.filter_map(|(material, reaction)| {
        let full = closing(case, material, reaction)?;
        Some(format!(
            "`{}` makes solids that take more room than what it uses up: in `{}` the pores are full at a conversion of {}, where gas \
             no longer passes and the run ends; check the true densities, lower `density`, or let particles grow (`size`)",
            reaction.name,
            case.materials[material].name,
            short3(full)
        ))
    })
    .collect()
}

/// The conversion at which the solids of a reaction fill the particles of a material, from its start and by the reaction alone; `None`
/// where some room stays.
fn closing(case: &Case, material: usize, reaction: &Reaction) -> Option<f64> {
    let spec = &case.materials[material];
    let start = case.chemistry.compositions.get(material)?;
    let true_density = case.chemistry.true_densities.get(material)?;
    let molar_mass = |s: usize| case.chemistry.solids[s].molar_mass();
    // Per volume of a particle at the start.
    let used = reaction.solids.iter().filter(|one| one.1 < 0.0);
    let lasting = used.map(|&(s, n)| spec.density * start[s] / (molar_mass(s) * -n));
    let all = lasting
        .reduce(f64::min)
        .filter(|moles| *moles > 0.0 && !reaction.gases.is_empty())?;
    let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
        let each = reaction.solids.iter().map(|&(s, n)| n * of(s));
        all * each.sum::<f64>()
    };
    let filled: f64 = start
        .iter()
        .zip(true_density)
        .map(|(y, rho)| spec.density * y / rho)
        .sum();
    let fills = sum(&|s| molar_mass(s) / true_density[s]);
    let grows = match &spec.size {
        SizeLaw::Constant => 0.0,
        SizeLaw::ConstantDensity { .. } => sum(&molar_mass) / spec.density,
        SizeLaw::Densities { .. } => return None,
    };
    // filled + X fills = 1 + X grows.
    let full = (1.0 - filled) / (fills - grows);
    (fills > grows && full < 1.0).then_some(full)
}

/// R √(r/(D c)) of a reaction forwards, nothing having reacted, at the hottest temperature in K of the gas that comes in: r in
/// mol/m³/s by the gas at the start, D the mean diffusivity in its pores, c the moles in a volume of the gas that it uses and would use
/// up first, of all gas where it uses none.
fn thiele(
    case: &Case,
    population: &Population,
    (reaction, gas): (&Reaction, &Mixture),
    diameter: f64,
) -> Option<(f64, f64)> {
    let material = &case.materials[population.material];
    let entering = case
        .gas
        .patches
        .iter()
        .filter_map(|(_, patch)| match patch {
            GasPatch::Inlet { temperature, .. } => Some(temperature.0.iter().map(|entry| entry.1)),
            _ => None,
        });
    let kelvin = entering.flatten().fold(case.gas.temperature, f64::max);
    let moles = case.gas.pressure / (GAS_CONSTANT * kelvin);
    let mut fractions = vec![0.0; gas.names().len()];
    gas.mole_fractions(&case.gas.composition, &mut fractions);
    let start = case.chemistry.compositions.get(population.material)?;
    let of_solid = |s: usize| {
        material.density * start.get(s).copied().unwrap_or_default()
            / case.chemistry.solids[s].molar_mass()
    };
    let (solid, _) = reaction.solids.iter().find(|one| one.1 < 0.0)?;
    let powers = |orders: &[(usize, f64)]| -> f64 {
        let each = orders.iter().map(|&(g, n)| (fractions[g] * moles).powf(n));
        each.product()
    };
    let true_density = case.chemistry.true_densities.get(population.material)?;
    let rate = match &reaction.rate {
        Rate::Conversion {
            rate_constant,
            conversion,
            gases,
        } => rate_constant.at(kelvin) * of_solid(*solid) * conversion.of(1.0)[0] * powers(gases),
        Rate::Power(law) => {
            let solids = law.solids.iter().map(|&(s, n)| of_solid(s).powf(n));
            law.rate_constant.at(kelvin) * solids.product::<f64>() * powers(&law.gases)
        }
        Rate::Grains {
            rate_constant,
            grains,
        } => {
            let volume = material.density * start.get(*solid)? / true_density.get(*solid)?;
            let lacking = 1e5 / reaction.equilibrium.inverse(kelvin).max(f64::MIN_POSITIVE);
            rate_constant.at(kelvin) * grains.at_start(volume) * lacking
        }
        Rate::Core { .. } | Rate::Evaporation(_) | Rate::Devolatilisation(_) => return None,
    };
    let filled: f64 = start.iter().zip(true_density).map(|(y, rho)| y / rho).sum();
    let porosity = 1.0 - material.density * filled;
    let mut diffusivities = vec![0.0; fractions.len()];
    gas.diffusivities(
        case.gas.pressure,
        kelvin,
        &case.gas.composition,
        &mut diffusivities,
    );
    let pores = material.radial.pore_diameter?;
    let each = diffusivities.iter().zip(gas.species()).map(|(free, one)| {
        1.0 / (1.0 / free + 1.0 / knudsen::diffusivity(pores, kelvin, one.molar_mass()))
    });
    let mean = each.sum::<f64>() / fractions.len() as f64;
    let diffusivity = mean * porosity / material.radial.tortuosity?;
    let radius = (sphere::volume_of_diameter(diameter) * 0.75 / PI).cbrt();
    let used = reaction.gases.iter().filter(|one| one.1 < 0.0);
    let lasting = used.map(|&(g, n)| fractions[g] * moles / -n);
    let first = lasting.reduce(f64::min).unwrap_or(moles);
    let number = radius * (rate / (diffusivity * first)).sqrt();
    number.is_finite().then_some((number, kelvin))
}

#[cfg(test)]
mod tests {
    use crate::case::warnings::tests::warned;

    /// Lime of a true density of 1300 kg/m³ takes 1.052 of the volume of the limestone that it is made of, of whose volume 0.1 are
    /// pores: 0.1/(1.0516 − 0.9000) = 0.659.
    #[test]
    fn pores_that_solids_fill_are_told() {
        let told = |density: &str| {
            let set = format!("materials.limestone.radial.true_densities.CaO={density}");
            let all = warned("porous-stones", &[&set]);
            all.into_iter()
                .find(|one| one.contains("the pores are full"))
        };
        assert_eq!(told("3340 kg/m^3"), None);
        assert_eq!(told("1400 kg/m^3"), None);
        let full = told("1300 kg/m^3").unwrap();
        assert!(full.contains("a conversion of 0.659,"), "{full}");
    }
}
