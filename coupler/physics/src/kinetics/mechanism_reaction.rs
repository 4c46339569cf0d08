//! One reaction of a mechanism, by indices of species.

use super::error::KineticsError;
use super::falloff::{Broadening, RateConstant};
use super::statement::ReactionStatement;
use crate::reaction::{Arrhenius, imbalance};
use crate::thermo::Mixture;

/// An efficiency of a third body in messages.
const EFFICIENCY: &str = "an efficiency";

/// A reaction of a mechanism; species by their index in the mixture, numbers of moles as in its equation.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismReaction {
    /// Its name.
    pub name: String,
    /// Left side of its equation.
    pub left: Vec<(usize, f64)>,
    /// Right side of its equation.
    pub right: Vec<(usize, f64)>,
    /// Orders of the rate forth.
    pub orders: Vec<(usize, f64)>,
    /// Orders of the rate back; `None` where the reaction goes one way.
    pub back: Option<Vec<(usize, f64)>>,
    /// Right side less left side, without zeros.
    pub net: Vec<(usize, f64)>,
    /// Moles that it makes in all.
    pub growth: f64,
    /// Its rate constant, in mol, m³, s.
    pub rate: RateConstant,
    /// Efficiency of every species as third body.
    pub collider: Option<Vec<f64>>,
}

impl MechanismReaction {
    pub(super) fn new(
        mixture: &Mixture,
        stated: &ReactionStatement,
    ) -> Result<Self, KineticsError> {
        let index = |name: &str| -> Result<usize, KineticsError> {
            let found = mixture.names().iter().position(|one| one == name);
            found.ok_or_else(|| KineticsError::UnknownSpecies {
                reaction: stated.name.clone(),
                species: name.to_owned(),
                known: mixture.names().join(", "),
            })
        };
        let net = stated
            .equation
            .net()
            .iter()
            .map(|(name, n)| Ok((index(name)?, *n)))
            .collect::<Result<Vec<_>, _>>()?;
        balanced(mixture, &stated.name, &net)?;
        let net: Vec<(usize, f64)> = net.into_iter().filter(|(_, n)| *n != 0.0).collect();
        let side = |terms: &[(f64, String)]| -> Result<Vec<(usize, f64)>, KineticsError> {
            let indexed = terms.iter().map(|(n, name)| Ok((index(name)?, *n)));
            indexed.collect()
        };
        let left = side(&stated.equation.left)?;
        let right = side(&stated.equation.right)?;
        let orders = match &stated.orders {
            Some(orders) => orders
                .iter()
                .map(|(name, order)| Ok((index(name)?, *order)))
                .collect::<Result<Vec<_>, _>>()?,
            None => left.clone(),
        };
        let back = stated
            .equation
            .reversible
            .then(|| orders_back(&orders, &net));
        let collider = match &stated.collider {
            None => None,
            Some(collider) => {
                let mut efficiencies = vec![collider.others; mixture.names().len()];
                for (name, efficiency) in &collider.efficiencies {
                    // Mechanisms list bodies that a case leaves out.
                    if let Ok(k) = index(name) {
                        efficiencies[k] = *efficiency;
                    }
                }
                Some(efficiencies)
            }
        };
        let falloff = matches!(stated.rate, RateConstant::Falloff { .. });
        let nobody = match &collider {
            None => falloff,
            Some(efficiencies) => efficiencies.iter().all(|one| *one == 0.0),
        };
        if nobody {
            return Err(KineticsError::NoCollider {
                reaction: stated.name.clone(),
            });
        }
        finite(stated)?;
        Ok(Self {
            name: stated.name.clone(),
            rate: stated.rate,
            growth: net.iter().map(|(_, n)| n).sum(),
            left,
            right,
            orders,
            back,
            net,
            collider,
        })
    }
}

/// a + ν.
fn orders_back(forth: &[(usize, f64)], net: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let mut back = forth.to_vec();
    for &(k, n) in net {
        match back.iter_mut().find(|(i, _)| *i == k) {
            Some((_, order)) => *order += n,
            None => back.push((k, n)),
        }
    }
    back.retain(|(_, order)| *order != 0.0);
    back
}

fn balanced(mixture: &Mixture, name: &str, net: &[(usize, f64)]) -> Result<(), KineticsError> {
    let off = imbalance(|element| {
        let atoms = |k: usize| mixture.species()[k].atoms()[element as usize];
        net.iter().map(|&(k, n)| n * atoms(k)).sum()
    });
    off.map_or(Ok(()), |off| {
        Err(KineticsError::Unbalanced {
            reaction: name.to_owned(),
            off,
        })
    })
}

/// Every number of a reaction is finite; factors of a falloff are positive, and efficiencies not negative.
fn finite(stated: &ReactionStatement) -> Result<(), KineticsError> {
    let refuse = |(quantity, value): (&'static str, f64)| KineticsError::Value {
        reaction: stated.name.clone(),
        quantity,
        value,
    };
    let mut numbers = Vec::new();
    let mut law = |law: &Arrhenius| {
        numbers.push(("a factor A", law.factor));
        numbers.push(("an exponent b", law.exponent));
        numbers.push(("an activation energy E in J/mol", law.activation_energy));
    };
    match &stated.rate {
        RateConstant::Arrhenius(one) => law(one),
        RateConstant::Falloff {
            high,
            low,
            broadening,
        } => {
            for one in [high, low] {
                law(one);
                if one.factor <= 0.0 {
                    return Err(refuse(("a factor A of a falloff", one.factor)));
                }
            }
            numbers.extend(troe(broadening));
        }
    }
    let orders = stated.orders.iter().flatten();
    numbers.extend(orders.map(|(_, order)| ("an order", *order)));
    if let Some(collider) = &stated.collider {
        let named = collider.efficiencies.iter().map(|one| one.1);
        for value in named.chain([collider.others]) {
            numbers.push((EFFICIENCY, value));
            if value < 0.0 {
                return Err(refuse((EFFICIENCY, value)));
            }
        }
    }
    let none = numbers.into_iter().find(|(_, value)| !value.is_finite());
    none.map_or(Ok(()), |one| Err(refuse(one)))
}

/// Troe's numbers.
fn troe(broadening: &Broadening) -> Vec<(&'static str, f64)> {
    let Broadening::Troe {
        share,
        third,
        first,
        second,
    } = *broadening
    else {
        return Vec::new();
    };
    vec![
        ("Troe's a", share),
        ("Troe's T3 in K", third),
        ("Troe's T1 in K", first),
        ("Troe's T2 in K", second.unwrap_or(0.0)),
    ]
}
