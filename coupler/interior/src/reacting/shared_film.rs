//! Which reactions of a particle share the gas at its surface (docs/theory.md, RXN-3).

use calcine_physics::reaction::Equilibrium;

use super::layers::Layers;
use super::reaction::{Rate, Reaction};

/// Reactions whose rates depend on gases at the surface that others use or make too, or on more than one.
///
/// Alone stay shrinking cores whose gases no other reaction has, which their ladders bring through the film, and power laws
/// that go one way by one gas that no other reaction has, whose surface is known in closed form or by one equation.
#[derive(Clone, Debug, Default)]
pub(super) struct SharedFilm {
    /// Gases on whose concentrations at the surface rates depend.
    pub gases: Vec<usize>,
    /// The reactions, and the place of each of all among them.
    pub reactions: Vec<usize>,
    places: Vec<Option<usize>>,
    /// Moles that each makes of the gases, by their places.
    pub moles: Vec<Vec<(usize, f64)>>,
}

/// Gases that a reaction depends on, and those that it uses or makes.
struct Reach {
    depends: Vec<usize>,
    moves: Vec<usize>,
    /// True where it may go by a film of its own.
    simple: bool,
    /// Layers of the core and path in them, of a shrinking core.
    path: Option<(usize, usize)>,
}

impl SharedFilm {
    /// Of these reactions, of which some make layers.
    pub fn new(reactions: &[Reaction], layers: &[Layers]) -> Self {
        let reaches: Vec<_> = (0..reactions.len())
            .map(|index| reach((index, &reactions[index]), layers))
            .collect();
        let meets =
            |one: &Reach, other: &Reach| one.depends.iter().any(|g| other.moves.contains(g));
        let alone = |index: usize| {
            let own = &reaches[index];
            let others = reaches.iter().enumerate().filter(|(other, reach)| {
                *other != index && (own.path.is_none() || reach.path != own.path)
            });
            let mut others = others.map(|(_, reach)| reach);
            own.simple && !others.any(|other| meets(own, other) || meets(other, own))
        };
        let mut made = Self {
            places: vec![None; reactions.len()],
            ..Self::default()
        };
        for index in (0..reactions.len()).filter(|index| !alone(*index)) {
            made.places[index] = Some(made.reactions.len());
            made.reactions.push(index);
            for &gas in &reaches[index].depends {
                if !made.gases.contains(&gas) {
                    made.gases.push(gas);
                }
            }
        }
        for &index in &made.reactions {
            let each = reactions[index].gases.iter();
            let known = |&(g, n): &(usize, f64)| Some((made.place_of(g)?, n));
            made.moles.push(each.filter_map(known).collect());
        }
        made
    }

    /// The place of a reaction among those that share.
    pub fn place(&self, reaction: usize) -> Option<usize> {
        self.places[reaction]
    }

    /// The place of a gas among those that rates depend on.
    pub fn place_of(&self, gas: usize) -> Option<usize> {
        self.gases.iter().position(|one| *one == gas)
    }
}

/// True where the rate of a power law does not follow a gas that it uses, as long as that is there: what goes both ways
/// is held back by its equilibrium.
pub(super) fn zeroth(reaction: &Reaction, gas: usize) -> bool {
    let Rate::Power(law) = &reaction.rate else {
        return false;
    };
    let used = reaction.gases.iter().any(|one| one.0 == gas && one.1 < 0.0);
    let by_order = law.gases.iter().any(|one| one.0 == gas && one.1 != 0.0);
    reaction.equilibrium == Equilibrium::OneWay && used && !by_order
}

fn reach((index, reaction): (usize, &Reaction), layers: &[Layers]) -> Reach {
    let gases = |wanted: &dyn Fn(f64) -> bool| {
        let kept = reaction.gases.iter().filter(|one| wanted(one.1));
        kept.map(|one| one.0).collect::<Vec<_>>()
    };
    let moves = gases(&|n| n != 0.0);
    if let Rate::Devolatilisation(_) = &reaction.rate {
        return Reach {
            depends: Vec::new(),
            moves,
            simple: true,
            path: None,
        };
    }
    let Rate::Power(law) = &reaction.rate else {
        let mut paths = layers.iter().enumerate().flat_map(|(k, layers)| {
            let each = layers.paths.iter().enumerate();
            each.map(move |(p, path)| ((k, p), path))
        });
        let path = paths.find(|(_, path)| path.reactions.contains(&Some(index)));
        return Reach {
            depends: moves.clone(),
            moves,
            simple: true,
            path: path.map(|one| one.0),
        };
    };
    let one_way = reaction.equilibrium == Equilibrium::OneWay;
    let mut depends = gases(&|n| n < 0.0 || (n > 0.0 && !one_way));
    for &(gas, order) in &law.gases {
        if order != 0.0 && !depends.contains(&gas) {
            depends.push(gas);
        }
    }
    let used = |gas: usize| reaction.gases.iter().any(|one| one.0 == gas && one.1 < 0.0);
    let of_its_key = match depends[..] {
        [] => true,
        [one] => one_way && used(one),
        _ => false,
    };
    Reach {
        depends,
        moves,
        simple: of_its_key,
        path: None,
    }
}
