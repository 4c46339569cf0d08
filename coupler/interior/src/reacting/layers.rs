//! Layers of a shrinking core: which solid lies within which, and which gas makes one of the other.

use calcine_physics::reaction::shrinking_core::MOST_INTERFACES;
use thiserror::Error;

use super::reaction::{LayerDiffusivity, Rate, Reaction};

/// Solids that lie within each other, innermost first, and the gases that turn each into the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Layers {
    /// Indices of the solids, the core first.
    pub solids: Vec<usize>,
    /// How many moles of the core's solid one mole of each solid was made of.
    pub weights: Vec<f64>,
    /// The gases.
    pub paths: Vec<GasPath>,
}

/// What one gas does in the layers.
#[derive(Clone, Debug, PartialEq)]
pub struct GasPath {
    /// Index of the gas that diffuses in (or out, where a reaction sets it free).
    pub key: usize,
    /// Index of the gas that diffuses back, mole for mole.
    pub product: Option<usize>,
    /// At each interface the reaction that takes place there, if this gas has one.
    pub reactions: Vec<Option<usize>>,
    /// Diffusivity in the layer outside each interface.
    pub diffusivity: Vec<LayerDiffusivity>,
}

/// Shrinking-core reactions that make no layers.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum LayersError {
    /// Not one solid in and one out.
    #[error(
        "{reaction} needs one solid on each side, of which the one becomes a layer about the other"
    )]
    Solids {
        /// The reaction.
        reaction: String,
    },
    /// Gases that do not counter-diffuse one for one.
    #[error(
        "{reaction} needs one gas that diffuses to the core or away from it, and at most one that \
         diffuses back with the same number of moles"
    )]
    Gases {
        /// The reaction.
        reaction: String,
    },
    /// More than one layer of the same solid, or a circle.
    #[error(
        "{reaction} makes no chain of layers with the other reactions: each solid becomes one other, and none becomes itself"
    )]
    Chain {
        /// The reaction.
        reaction: String,
    },
    /// Two reactions of a gas at one interface, or one with other products elsewhere.
    #[error(
        "{reaction} meets another reaction of the same gas, with which it does not go together"
    )]
    Path {
        /// The reaction.
        reaction: String,
    },
    /// Too many.
    #[error("more than {MOST_INTERFACES} interfaces")]
    Many,
}

/// The key gas of a core reaction and the one that diffuses back.
pub fn gases(reaction: &Reaction) -> Result<(usize, Option<usize>), LayersError> {
    let fail = || LayersError::Gases {
        reaction: reaction.name.clone(),
    };
    let used: Vec<_> = reaction.gases.iter().filter(|gas| gas.1 < 0.0).collect();
    let made: Vec<_> = reaction.gases.iter().filter(|gas| gas.1 > 0.0).collect();
    match (&used[..], &made[..]) {
        ([key], []) | ([], [key]) => Ok((key.0, None)),
        ([key], [product]) if (key.1 + product.1).abs() < 1e-9 * product.1 => {
            Ok((key.0, Some(product.0)))
        }
        _ => Err(fail()),
    }
}

/// Puts the shrinking-core reactions together to layers.
pub fn layers(reactions: &[Reaction]) -> Result<Vec<Layers>, LayersError> {
    let mut links: Vec<Link> = Vec::new();
    for (index, reaction) in reactions.iter().enumerate() {
        if let Rate::Core { diffusivity, .. } = &reaction.rate {
            links.push(link(index, reaction, *diffusivity)?);
        }
    }
    let mut made = Vec::new();
    while let Some(first) = links.first() {
        // The core's solid is made of none.
        let mut core = first.from;
        for _ in 0..=links.len() {
            match links.iter().find(|link| link.to == core) {
                Some(inner) => core = inner.from,
                None => break,
            }
        }
        let fail = |link: &Link| LayersError::Chain {
            reaction: reactions[link.reaction].name.clone(),
        };
        let mut chain = Layers {
            solids: vec![core],
            weights: vec![1.0],
            paths: Vec::new(),
        };
        let mut steps: Vec<Vec<Link>> = Vec::new();
        loop {
            let last = chain.solids[chain.solids.len() - 1];
            let (here, rest): (Vec<Link>, Vec<Link>) =
                links.into_iter().partition(|link| link.from == last);
            links = rest;
            let Some(step) = here.first() else { break };
            let to = step.to;
            let alike =
                |link: &&Link| link.to != to || (link.ratio / step.ratio - 1.0).abs() > 1e-6;
            if let Some(other) = here.iter().find(alike) {
                return Err(fail(other));
            }
            if chain.solids.contains(&to) {
                return Err(fail(step));
            }
            let weight = chain.weights[chain.weights.len() - 1] / step.ratio;
            chain.solids.push(to);
            chain.weights.push(weight);
            steps.push(here);
        }
        if steps.is_empty() {
            return Err(fail(&links[0]));
        }
        if let Some(stray) = links.iter().find(|link| chain.solids.contains(&link.to)) {
            return Err(fail(stray));
        }
        if steps.len() > MOST_INTERFACES {
            return Err(LayersError::Many);
        }
        chain.paths = paths(&steps, reactions)?;
        made.push(chain);
    }
    Ok(made)
}

/// A reaction that makes one solid of another.
struct Link {
    reaction: usize,
    from: usize,
    to: usize,
    /// Moles of the new solid by mole of the old one.
    ratio: f64,
    gases: (usize, Option<usize>),
    diffusivity: LayerDiffusivity,
}

fn link(
    index: usize,
    reaction: &Reaction,
    diffusivity: LayerDiffusivity,
) -> Result<Link, LayersError> {
    let used: Vec<_> = reaction.solids.iter().filter(|one| one.1 < 0.0).collect();
    let made: Vec<_> = reaction.solids.iter().filter(|one| one.1 > 0.0).collect();
    let ([from], [to]) = (&used[..], &made[..]) else {
        return Err(LayersError::Solids {
            reaction: reaction.name.clone(),
        });
    };
    Ok(Link {
        reaction: index,
        from: from.0,
        to: to.0,
        ratio: -to.1 / from.1,
        gases: gases(reaction)?,
        diffusivity,
    })
}

/// What each gas does at each interface.
fn paths(steps: &[Vec<Link>], reactions: &[Reaction]) -> Result<Vec<GasPath>, LayersError> {
    let mut paths: Vec<GasPath> = Vec::new();
    for (place, step) in steps.iter().enumerate() {
        for link in step {
            let fail = || LayersError::Path {
                reaction: reactions[link.reaction].name.clone(),
            };
            let (key, product) = link.gases;
            let found = paths.iter().position(|path| path.key == key);
            let path = match found {
                Some(found) => &mut paths[found],
                None => {
                    // Until its own are known, the diffusivities of whoever makes the layers.
                    let diffusivity = steps.iter().map(|step| step[0].diffusivity).collect();
                    paths.push(GasPath {
                        key,
                        product,
                        reactions: vec![None; steps.len()],
                        diffusivity,
                    });
                    let last = paths.len() - 1;
                    &mut paths[last]
                }
            };
            if path.product != product || path.reactions[place].is_some() {
                return Err(fail());
            }
            path.reactions[place] = Some(link.reaction);
            path.diffusivity[place] = link.diffusivity;
        }
    }
    Ok(paths)
}
