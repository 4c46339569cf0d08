//! Reactions that never happen, because what they take is nowhere.

use std::collections::BTreeSet;

use calcine_coupler::physics::reaction::Equilibrium;

use super::model::Case;

/// Of a mechanism with more steps only one that cannot begin at all is told.
const FEW_STEPS: usize = 20;

/// What there is: solids and gases by their indices.
#[derive(Clone, Debug, Default, PartialEq)]
struct There {
    solids: BTreeSet<usize>,
    gases: BTreeSet<usize>,
}

/// Parts with their moles, below zero where they are taken.
type Parts<'a> = &'a [(usize, f64)];

fn missing(parts: Parts<'_>, there: &BTreeSet<usize>, way: f64) -> Option<usize> {
    let taken = parts.iter().filter(|(_, moles)| way * moles < 0.0);
    let mut missing = taken.filter(|(index, _)| !there.contains(index));
    missing.next().map(|(index, _)| *index)
}

impl There {
    /// What is there before anything reacts.
    fn at_first(case: &Case) -> Self {
        let chemistry = &case.chemistry;
        let held = case.particles.iter().flat_map(|population| {
            let own = chemistry.compositions.get(population.material);
            own.into_iter().flatten().enumerate()
        });
        let mut gases = present(&case.gas.composition);
        for (_, patch) in &case.gas.patches {
            let Some((_, Some(compositions))) = patch.entering() else {
                continue;
            };
            for (_, fractions) in &compositions.0 {
                gases.extend(present(fractions));
            }
        }
        // What fields of another program hold is not known.
        let external = case.external_gas.is_some();
        if external || case.openfoam.start.is_some() || case.openfoam.template.is_some() {
            gases.extend(0..case.gas.properties.species().len());
        }
        Self {
            solids: held.filter(|(_, y)| **y > 0.0).map(|(s, _)| s).collect(),
            gases,
        }
    }

    fn take(&mut self, solids: Parts<'_>, gases: Parts<'_>) {
        self.solids.extend(solids.iter().map(|part| part.0));
        self.gases.extend(gases.iter().map(|part| part.0));
    }

    fn has(&self, solids: Parts<'_>, gases: Parts<'_>, way: f64) -> bool {
        missing(solids, &self.solids, way).is_none() && missing(gases, &self.gases, way).is_none()
    }

    /// What comes to be there.
    fn reached(mut self, case: &Case) -> Self {
        loop {
            let before = self.clone();
            for one in &case.chemistry.reactions {
                let back = one.equilibrium != Equilibrium::OneWay;
                if self.has(&one.solids, &one.gases, 1.0)
                    || back && self.has(&one.solids, &one.gases, -1.0)
                {
                    self.take(&one.solids, &one.gases);
                }
            }
            for (_, net, back) in steps(case) {
                if self.has(&[], net, 1.0) || back && self.has(&[], net, -1.0) {
                    self.take(&[], net);
                }
            }
            if self == before {
                return self;
            }
        }
    }
}

fn present(fractions: &[f64]) -> BTreeSet<usize> {
    let held = fractions.iter().enumerate().filter(|(_, y)| **y > 0.0);
    held.map(|(index, _)| index).collect()
}

/// Reactions of the gas: name, net moles, and whether they go both ways.
fn steps(case: &Case) -> impl Iterator<Item = (&str, Parts<'_>, bool)> {
    let reacting = case.gas.chemistry.reacting().into_iter();
    reacting
        .flat_map(|gas| gas.mechanism.steps())
        .map(|one| (one.name.as_str(), &one.net[..], one.back.is_some()))
}

/// Warnings about reactions of particles and of the gas, in the order of the file.
pub(super) fn all(case: &Case) -> Vec<String> {
    let there = There::at_first(case).reached(case);
    let gas_name = |index: usize| &case.gas.properties.species()[index];
    let mut all = Vec::new();
    for one in &case.chemistry.reactions {
        let back = one.equilibrium != Equilibrium::OneWay;
        if back && there.has(&one.solids, &one.gases, -1.0) {
            continue;
        }
        if let Some(solid) = missing(&one.solids, &there.solids, 1.0) {
            all.push(format!(
                "`{}` never happens: it takes {}, which no particles are made of and no reaction that happens makes; state it in the \
                 `composition` of their material, or remove the reaction",
                one.name,
                case.chemistry.solids[solid].name()
            ));
        } else if let Some(gas) = missing(&one.gases, &there.gases, 1.0) {
            all.push(lacks_gas(&one.name, gas_name(gas)));
        }
    }
    let idle = steps(case).filter_map(|(name, net, back)| {
        let idle = !(back && there.has(&[], net, -1.0));
        let gas = missing(net, &there.gases, 1.0).filter(|_| idle)?;
        Some((name, gas))
    });
    let idle: Vec<(&str, usize)> = idle.collect();
    let count = steps(case).count();
    if count <= FEW_STEPS {
        all.extend(
            idle.iter()
                .map(|(name, gas)| lacks_gas(name, gas_name(*gas))),
        );
    } else if idle.len() == count {
        all.push(
            "no reaction of `gas.chemistry` ever happens: what they take is in the gas neither at the start nor where it comes in; \
             state it in a composition"
                .to_owned(),
        );
    }
    all
}

fn lacks_gas(name: &str, gas: &str) -> String {
    format!(
        "`{name}` never happens: it takes {gas}, which is not in the gas at the start, comes in through no patch, and is made by no \
         reaction that happens; state it in a composition of the gas, or remove the reaction"
    )
}

#[cfg(test)]
mod tests {
    use crate::case::cautions::tests::{one, said};

    #[test]
    fn a_reaction_whose_solids_are_nowhere_never_happens() {
        let text = one(
            "reactions",
            &["materials.ore.composition={ mole = { Fe3O4 = 1 } }"],
        );
        assert!(
            text.starts_with("`magnetite` never happens: it takes Fe2O3"),
            "{text}"
        );
    }

    #[test]
    fn a_reaction_whose_gas_is_nowhere_never_happens() {
        let nitrogen = "composition={ mole = { N2 = 1 } }";
        let set = [
            format!("gas.initial.{nitrogen}"),
            format!("gas.patch.bottom.inlet.{nitrogen}"),
        ];
        let told = said("carbon-film", &[&set[0]]);
        assert!(
            told.iter().any(|one| one
                .contains("never happens: it takes O2, which is not in the gas at the start")),
            "{told:?}"
        );
        let told = said("gas-reactions", &[&set[0], &set[1]]);
        assert!(
            told[0].starts_with("`fuel` never happens: it takes"),
            "{told:?}"
        );
    }
}
