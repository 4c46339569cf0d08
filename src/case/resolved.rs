//! What `check` says of particles with shells: how far reactions outrun the pores, whether these are likely, and what they take of memory.

use std::f64::consts::PI;

use calcine_coupler::interior::radial::ShellGrading;
use calcine_coupler::interior::reacting::{Rate, Reaction, SizeChange};
use calcine_coupler::physics::gas::GAS_CONSTANT;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::pores::{Permeability, knudsen};
use calcine_coupler::physics::sphere;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::GasPatch;

use super::model::{Case, Inside, MaterialSpec, Population};
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
        all.extend(found.into_iter().flat_map(|(number, kelvin)| {
            let share = material.radial.grid.share_of_layer(number);
            [
                format!(
                    "Thiele number R sqrt(r/(D c)) of {} at {} K {number:.2e}",
                    one.name,
                    short3(kelvin)
                ),
                format!("share that these shells take of a first-order layer of it {share:.3}"),
            ]
        }));
    }
    all
}

/// Reactions whose solids would fill a particle before what they use up is gone, and pores that are not likely meant.
pub(super) fn warnings(case: &Case) -> Vec<String> {
    let materials = case.materials.iter().enumerate();
    let resolved = materials.filter(|(_, one)| one.inside != Inside::Thin);
    let reactions = &case.chemistry.reactions;
    let mut all = unlikely_pores(case);
    all.extend(unresolved_layers(case));
    let each = resolved.flat_map(|(m, _)| reactions.iter().map(move |one| (m, one)));
    all.extend(each.filter_map(|(material, reaction)| {
        let full = closing(case, material, reaction)?;
        Some(format!(
            "`{}` makes solids that take more room than what it uses up: in `{}` the pores are full at a conversion of {}, where gas \
             no longer passes and the run ends; check the true densities, lower `density`, or let particles grow (`size`)",
            reaction.name,
            case.materials[material].name,
            short3(full)
        ))
    }));
    all
}

/// Pores as wide as particles, and permeabilities far from those of such pores.
fn unlikely_pores(case: &Case) -> Vec<String> {
    let mut all = Vec::new();
    for population in &case.particles {
        let material = &case.materials[population.material];
        let Some(pores) = material.radial.pore_diameter else {
            continue;
        };
        if material.inside == Inside::Thin {
            continue;
        }
        let smallest = population.sizes.smallest();
        if pores > WIDE * smallest {
            all.push(format!(
                "`pore_diameter` of `{}` is {} m, where the smallest particle of `{}` has {} m: pores are far narrower than the particle they                  are in, 0.01 to 100 um as a rule; check its unit",
                material.name,
                short3(pores),
                population.name,
                short3(smallest)
            ));
        }
        all.extend(unlikely_permeability(material, pores));
    }
    all.dedup();
    all
}

/// Straight pores of a diameter d have a permeability of d²/32 at most.
fn unlikely_permeability(material: &MaterialSpec, pores: f64) -> Option<String> {
    let (key, value, found) = match material.radial.permeability? {
        Permeability::Constant(value) => ("permeability.value", value, value),
        law @ Permeability::KozenyCarman(grains) => {
            ("permeability.grain_diameter", grains, law.of(HALF_OPEN))
        }
    };
    let straight = pores * pores / 32.0;
    let [low, high] = [TIGHT, OPEN].map(|by| by * straight);
    let (place, other) = if found > high {
        ("above", high)
    } else if found < low {
        ("below", low)
    } else {
        return None;
    };
    let unit = match material.radial.permeability? {
        Permeability::Constant(_) => "m^2",
        Permeability::KozenyCarman(_) => "m",
    };
    Some(format!(
        "`{key}` of `{}` is {value:.1e} {unit}, a permeability of {found:.1e} m^2, {place} {other:.1e} m^2: straight pores of the stated          `pore_diameter` of {} m have d^2/32 = {straight:.1e} m^2; check both",
        material.name,
        short3(pores)
    ))
}

/// Diameter of pores over that of a particle above which it is not likely meant.
const WIDE: f64 = 0.1;
/// Permeability over that of straight pores: below and above it is not likely meant.
const TIGHT: f64 = 1e-6;
const OPEN: f64 = 100.0;
/// Share of a lasting layer below the surface that shells take at least without a warning.
const RESOLVED: f64 = 0.95;
/// Porosity at which a law of grains is looked at.
const HALF_OPEN: f64 = 0.5;

/// Layers of gas below the surface that last and that the shells do not resolve, and shells for a layer that burns away with the first of them.
fn unresolved_layers(case: &Case) -> Vec<String> {
    let GasModel::Mixture(gas) = &case.gas.properties else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for population in &case.particles {
        let material = &case.materials[population.material];
        let size = case.chemistry.sizes.get(population.material);
        let shrinks = size.is_some_and(|size| size.volumes().is_some());
        let grid = &material.radial.grid;
        let Ok(diameter) = population.sizes.mean() else {
            continue;
        };
        if material.inside == Inside::Thin {
            continue;
        }
        if shrinks && matches!(grid.grading, ShellGrading::Thiele(_)) {
            all.push(format!(
                "`materials.{}.radial.grading` makes thin shells at the surface, which are used up first where particles shrink (`size`): coarse \
                 ones then come to the surface; write a ratio, such as grading = 4, and more shells",
                material.name
            ));
        }
        for one in &case.chemistry.reactions {
            let uses_gas = one.gases.iter().any(|gas| gas.1 < 0.0);
            // The layer of a solid that is used up in place moves on as a front.
            let lasts = shrinks || one.solids.iter().all(|solid| solid.1 >= 0.0);
            let found = thiele(case, population, (one, gas), diameter);
            let Some((number, kelvin)) = found.filter(|_| uses_gas && lasts) else {
                continue;
            };
            let share = grid.share_of_layer(number);
            if share < RESOLVED {
                let remedy = if shrinks {
                    "more shells".to_owned()
                } else {
                    format!(
                        "grading = {{ thiele = {} }}, or more shells",
                        short3(number)
                    )
                };
                all.push(format!(
                    "`{}` takes place in a layer below the surface of `{}` that {} shells do not resolve: at {} K its Thiele number is {}, and they \
                     take {share:.2} of what it takes by first order; write {remedy}",
                    one.name,
                    population.name,
                    grid.shells,
                    short3(kelvin),
                    short3(number),
                ));
            }
        }
    }
    all
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
    let volumes = case.chemistry.sizes.get(material);
    let grows = match volumes.and_then(SizeChange::volumes) {
        None => 0.0,
        Some(each) => sum(&|s| each[s]),
    };
    // filled + X fills = 1 + X grows.
    let full = (1.0 - filled) / (fills - grows);
    (fills > grows && full < 1.0).then_some(full)
}

/// R √(r/(D c)) of a reaction forwards, nothing having reacted, at the hottest temperature in K of the gas that comes in: r in
/// mol/m³/s by the gas at the start, D the mean diffusivity in its pores, c the moles in a volume of the gas that it uses and would use
/// up first, of all gas where it uses none. `None` where nothing reacts at the start.
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
    let solid = reaction.solids.iter().find(|one| one.1 < 0.0);
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
        } => rate_constant.at(kelvin) * of_solid(solid?.0) * conversion.of(1.0)[0] * powers(gases),
        Rate::Power(law) => {
            let solids = law.solids.iter().map(|&(s, n)| of_solid(s).powf(n));
            law.rate_constant.at(kelvin) * solids.product::<f64>() * powers(&law.gases)
        }
        Rate::Grains {
            rate_constant,
            grains,
        } => {
            let &(s, _) = solid?;
            let volume = material.density * start.get(s)? / true_density.get(s)?;
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
    (number.is_finite() && number > 0.0).then_some((number, kelvin))
}

#[cfg(test)]
mod tests {
    use crate::case::warnings::tests::warned;

    /// Lime of a true density of 1300 kg/m³ takes 1.052 of the volume of the limestone that it is made of, of whose volume 0.1 are
    /// pores: 0.1/(1.0516 − 0.9000) = 0.659.
    #[test]
    fn pores_that_are_not_likely_meant_are_told() {
        let told = |key: &str, value: &str| {
            let set = format!("materials.limestone.radial.{key}={value}");
            let all = warned("porous-stones", &[&set]);
            let about =
                |one: &String| one.contains("pore_diameter") || one.contains("permeability");
            all.into_iter().filter(about).collect::<Vec<String>>()
        };
        assert_eq!(told("pore_diameter", "2 um"), Vec::<String>::new());
        let wide = told("pore_diameter", "1 m");
        assert!(wide[0].contains("is 1 m, where the smallest"), "{wide:?}");
        assert!(wide[1].contains("below"), "{wide:?}");
        let open = told("permeability.grain_diameter", "1 m");
        assert!(open[0].contains("above"), "{open:?}");
    }

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
