//! What of a case that is in order is likely not meant.

use calcine_coupler::interior::reacting::Rate;
use calcine_coupler::physics::kinetics::RateConstant;
use calcine_coupler::physics::reaction::Arrhenius;

use super::model::Case;
use super::units::listed;
use super::{
    accuracy_cautions, expectations, idle_cautions, patch_cautions, reach_cautions, schedules,
    size_cautions, temperature_cautions, time_cautions, used_up, wall_cautions,
};

/// Energies in J/mol that bonds have, no activation energy is above: that of carbon monoxide is 1072 kJ/mol.
const STRONGEST_BOND: f64 = 1.1e6;
/// Energy in J/mol below which a rate of particles hardly changes with temperature: at 300 K by 0.1 % a kelvin.
const SLIGHT: f64 = 1e3;

/// Warnings about a case, in a fixed order.
pub fn cautions(case: &Case) -> Vec<String> {
    let mut all = expectations::beyond_the_end(case);
    all.extend(energies(case));
    all.extend(wrong_units(case));
    all.extend(orders_left_out(case));
    all.extend(reach_cautions::all(case));
    all.extend(used_up::all(case));
    all.extend(temperature_cautions::all(case));
    all.extend(size_cautions::all(case));
    all.extend(schedules::cautions(case));
    all.extend(patch_cautions::all(case));
    all.extend(wall_cautions::all(case));
    all.extend(time_cautions::all(case));
    all.extend(accuracy_cautions::tolerances(case));
    all.extend(idle_cautions::all(case));
    all
}

/// Names of the reactions of particles, and where `of_gas` of the gas, that have an activation energy in J/mol which is so.
fn with_energy(case: &Case, of_gas: bool, is: impl Fn(f64) -> bool) -> Vec<&str> {
    let so = |constant: &Arrhenius| is(constant.activation_energy);
    let solid = |rate: &Rate| match rate {
        Rate::Power(law) => so(&law.rate_constant) || law.in_series.as_ref().is_some_and(so),
        Rate::Evaporation(_) => false,
        Rate::Devolatilisation(law) => so(&law.rate),
        Rate::Core { rate_constant, .. }
        | Rate::Conversion { rate_constant, .. }
        | Rate::Grains { rate_constant, .. } => so(rate_constant),
    };
    let gas = |rate: &RateConstant| match rate {
        RateConstant::Arrhenius(constant) => so(constant),
        RateConstant::Falloff { high, low, .. } => so(high) || so(low),
    };
    let of_particles = case.chemistry.reactions.iter();
    let of_particles = of_particles.filter(|one| solid(&one.rate));
    let reacting = case.gas.chemistry.reacting().filter(|_| of_gas);
    let of_gas = reacting
        .into_iter()
        .flat_map(|reacting| reacting.mechanism.steps());
    let of_gas = of_gas.filter(|one| gas(&one.rate));
    of_particles
        .map(|one| one.name.as_str())
        .chain(of_gas.map(|one| one.name.as_str()))
        .collect()
}

/// Reactions that slow down as they get hotter.
fn energies(case: &Case) -> Option<String> {
    let list = listed(&with_energy(case, true, |energy| energy < 0.0))?;
    Some(format!(
        "negative activation energy of {list}: the rate falls as it gets hotter, which fits of recombinations and of adsorption \
         do; write it positive if that is not meant"
    ))
}

/// Activation energies in kJ/mol that look like numbers of J/mol, and the other way round.
fn wrong_units(case: &Case) -> Vec<String> {
    let high = listed(&with_energy(case, true, |energy| energy > STRONGEST_BOND));
    let high = high.map(|list| {
        format!(
            "activation energy of {list} above 1100 kJ/mol, which no bond has: it never reacts; J/mol may be meant where kJ/mol is \
             written"
        )
    });
    let low = |energy: f64| energy > 0.0 && energy < SLIGHT;
    let low = listed(&with_energy(case, false, low)).map(|list| {
        format!(
            "activation energy of {list} below 1 kJ/mol: its rate hardly follows temperature; kJ/mol may be meant where J/mol is \
             written, and 0 says that it does not follow"
        )
    });
    high.into_iter().chain(low).collect()
}

/// Power laws whose rate does not fall as something that they use is used up.
fn orders_left_out(case: &Case) -> Vec<String> {
    let chemistry = &case.chemistry;
    let species = case.gas.properties.species();
    let mut told = Vec::new();
    for one in &chemistry.reactions {
        let Rate::Power(law) = &one.rate else {
            continue;
        };
        let without = |parts: &[(usize, f64)], orders: &[(usize, f64)]| -> Vec<usize> {
            let used = parts.iter().filter(|(_, moles)| *moles < 0.0);
            let used = used.map(|(index, _)| *index);
            used.filter(|index| orders.iter().all(|(of, _)| of != index))
                .collect()
        };
        let solids = without(&one.solids, &law.solids);
        let solids = solids.into_iter().map(|s| chemistry.solids[s].name());
        let gases = without(&one.gases, &law.gases);
        let gases = gases.into_iter().map(|g| species[g].as_str());
        let names: Vec<&str> = solids.chain(gases).collect();
        told.extend(listed(&names).map(|list| {
            format!(
                "`{}` uses {list}, which its `orders` leave out: it goes on at the same rate until there is none left; add the \
                 order, 0 if that is meant",
                one.name
            )
        }));
    }
    told
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// The warnings about a good case with keys set.
    pub(in crate::case) fn said(name: &str, set: &[&str]) -> Vec<String> {
        let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let path = folder.join(format!("tests/inputs/good/{name}.toml"));
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        cautions(&crate::case::read(&path, &set).unwrap())
    }

    /// The only one of them.
    pub(in crate::case) fn one(name: &str, set: &[&str]) -> String {
        let all = said(name, set);
        assert_eq!(all.len(), 1, "{all:?}");
        all.concat()
    }

    #[test]
    fn cases_that_say_what_they_mean_are_not_warned_of() {
        for name in [
            "reactions",
            "gas-reactions",
            "turbulent-duct",
            "open-box",
            "held-bed",
        ] {
            assert_eq!(said(name, &[]), Vec::<String>::new(), "{name}");
        }
    }

    #[test]
    fn negative_activation_energies_of_particles_and_gas_are_told_by_name() {
        let text = one(
            "reactions",
            &["reactions.rust.rate.activation_energy=-3 kJ/mol"],
        );
        assert!(text.contains("of `rust`: the rate falls"), "{text}");
        let text = one(
            "reactions",
            &["reactions.rust.rate.in_series.activation_energy=-3 kJ/mol"],
        );
        assert!(text.contains("of `rust`:"), "{text}");
        let set = "gas.chemistry.reactions.fuel.rate.activation_energy=-3 kJ/mol";
        let text = one("gas-reactions", &[set]);
        assert!(text.contains("of `fuel`:"), "{text}");
    }

    #[test]
    fn activation_energies_of_another_unit_are_told() {
        let key = |energy: &str| format!("reactions.rust.rate.activation_energy={energy}");
        let text = one("reactions", &[&key("30000 kJ/mol")]);
        assert!(text.contains("of `rust` above 1100 kJ/mol"), "{text}");
        let text = one("reactions", &[&key("30 J/mol")]);
        assert!(text.contains("of `rust` below 1 kJ/mol"), "{text}");
        assert!(said("reactions", &[&key("0 J/mol")]).is_empty());
        let set = "gas.chemistry.reactions.fuel.rate.activation_energy=130000 kJ/mol";
        let text = one("gas-reactions", &[set]);
        assert!(text.contains("of `fuel` above"), "{text}");
    }

    #[test]
    fn what_a_power_law_uses_without_an_order_is_told() {
        let text = one("reactions", &["reactions.rust.rate.orders={ O2 = 0.5 }"]);
        assert!(text.starts_with("`rust` uses `Fe`, which"), "{text}");
        let text = one("reactions", &["reactions.rust.rate.orders={ Fe = 1 }"]);
        assert!(text.starts_with("`rust` uses `O2`, which"), "{text}");
        let set = "reactions.rust.rate.orders={ Fe = 1, O2 = 0 }";
        assert!(said("reactions", &[set]).is_empty());
    }
}
