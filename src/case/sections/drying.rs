//! Water in particles: what a reaction that dries them may say, and what goes with it.

use calcine_coupler::interior::reacting::{Rate, Reaction};
use calcine_coupler::physics::film::StefanFlow;
use calcine_coupler::physics::solids::SolidSpecies;
use calcine_coupler::physics::thermo::Element;

use crate::case::model::{Laws, MaterialSpec, ReactionSpec};
use crate::case::table::{NO_DRYING, TableReader, is_moisture};

/// Refuses water of a material that no reaction takes up: nothing else would dry it. Of reactions that could all be read.
pub(super) fn no_drying(
    root: &TableReader<'_>,
    solids: &[SolidSpecies],
    materials: &[MaterialSpec],
    reactions: &[Reaction],
) {
    let tables = root.table("materials").map(|section| section.named());
    let tables = tables.unwrap_or_default();
    for (s, solid) in solids.iter().enumerate() {
        let holds = |one: &&MaterialSpec| {
            let own = one.composition.as_ref().and_then(|own| own.get(s));
            own.is_some_and(|y| *y > 0.0)
        };
        let Some(held) = materials.iter().find(holds) else {
            continue;
        };
        let mut parts = reactions.iter().flat_map(|one| &one.solids);
        let leaves = parts.any(|&(k, moles)| k == s && moles < 0.0);
        if leaves || !(is_moisture(solid.name()) || is_water(solid)) {
            continue;
        }
        if let Some((_, table)) = tables.iter().find(|(name, _)| *name == held.name) {
            let rule = format!(
                "holds {}, water that no reaction takes up, so that it would stay in the particles",
                solid.name()
            );
            table.fail("composition", rule, NO_DRYING[1]);
        }
    }
}

/// Whether a solid is water whatever its name.
fn is_water(solid: &SolidSpecies) -> bool {
    let of = |element: Element| solid.atoms()[element as usize];
    let others: f64 = solid.atoms().iter().sum::<f64>() - of(Element::H) - of(Element::O);
    others == 0.0 && of(Element::O) > 0.0 && of(Element::H) == 2.0 * of(Element::O)
}

/// True where a reaction by such a law is one: water to its vapour, mole for mole; volatiles of one solid, one way.
pub(super) fn suits(
    table: &TableReader<'_>,
    reaction: &Reaction,
    solids: &[SolidSpecies],
    gases: &[String],
) -> bool {
    match &reaction.rate {
        Rate::Evaporation(_) => {
            if table.has("equilibrium") {
                let help = "remove it: the vapour pressure of water is the law's";
                table.fail("equilibrium", "stands beside a law that has its own", help);
                return false;
            }
            let of_water = match (&reaction.solids[..], &reaction.gases[..]) {
                ([(s, used)], [(g, made)]) => {
                    *used == -1.0 && *made == 1.0 && is_water(&solids[*s]) && gases[*g] == "H2O"
                }
                _ => false,
            };
            if !of_water {
                let help = "write \"H2O(l) <=> H2O\", or \"H2O(l) => H2O\" where no vapour shall condense; H2O(l) is built in";
                table.fail(
                    "equation",
                    "does not turn liquid water into its vapour",
                    help,
                );
            }
            of_water
        }
        Rate::Devolatilisation(_) => {
            let used = reaction.solids.iter().filter(|one| one.1 < 0.0).count();
            let made_only = reaction.gases.iter().all(|gas| gas.1 > 0.0);
            let one_way =
                reaction.equilibrium == calcine_coupler::physics::reaction::Equilibrium::OneWay;
            if used == 1 && made_only && one_way {
                return true;
            }
            let help =
                "write one solid on the left, and => : what is left of it is what the rate goes by";
            table.fail("equation", "is no devolatilisation of one solid", help);
            false
        }
        _ => true,
    }
}

/// Errors where reactions that dry, or take the volatiles of a start, do not go with the rest of the case.
pub(super) fn fits(root: &TableReader<'_>, chemistry: &ReactionSpec, laws: Option<&Laws>) {
    let reactions = || {
        root.tables("reactions")
            .into_iter()
            .zip(&chemistry.reactions)
    };
    let mut drying = reactions().filter(|(_, one)| matches!(one.rate, Rate::Evaporation(_)));
    let (first, second) = (drying.next(), drying.next());
    if let (Some((_, first)), Some((table, _))) = (&first, &second) {
        let rule = format!("dries particles a second time, beside \"{}\"", first.name);
        table.fail("law", rule, "remove one of both");
    }
    let still = laws.is_some_and(|laws| laws.film.stefan_flow == StefanFlow::None);
    if let Some((table, _)) = first.filter(|_| still) {
        let rule = "needs the net flow through the film, without which water does not boil";
        let help = "write stefan_flow = \"mass\" in laws.mass_transfer, or leave it out";
        table.fail("law", rule, help);
    }
    for (table, reaction) in reactions() {
        let Rate::Devolatilisation(_) = reaction.rate else {
            continue;
        };
        let used = reaction.solids.iter().find(|one| one.1 < 0.0);
        let held = |s: usize| {
            let mut all = chemistry.compositions.iter();
            all.any(|own| own.get(s).is_some_and(|y| *y > 0.0))
        };
        if let Some(&(s, _)) = used.filter(|one| !held(one.0)) {
            let name = chemistry.solids[s].name();
            let rule = format!(
                "goes by the share of {name} that is left of the start, and no material holds it"
            );
            let help = "give a material a composition with it, or choose law = \"power-law\"";
            table.fail("law", rule, help);
        }
    }
}
