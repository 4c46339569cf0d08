//! Equations as mechanisms write them, with or without spaces; their third bodies and orders.

use calcine_coupler::physics::kinetics::Collider;
use calcine_coupler::physics::reaction::{Equation, EquationError};
use thiserror::Error;

/// The third body of an equation.
#[derive(Clone, Debug, PartialEq)]
pub enum ThirdBody {
    /// None.
    None,
    /// `+ M`: the rate is proportional to it.
    Three,
    /// `(+M)`: between two limits of pressure; with a name, that species alone.
    Falloff(Option<String>),
}

/// An equation of a mechanism, or the efficiencies of its third body, that cannot be.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum MechanismEquationError {
    /// No arrow.
    #[error("\"{0}\" is no equation: it has no arrow")]
    NoArrow(String),
    /// Several arrows.
    #[error("\"{0}\" is no equation: it has not one arrow")]
    Arrows(String),
    /// M on one side only, or another M.
    #[error("\"{0}\" has not the same third body on both sides")]
    ThirdBodies(String),
    /// A side that is none.
    #[error("\"{text}\" is no equation: {cause}")]
    Sides {
        /// The equation.
        text: String,
        /// What is wrong with it.
        cause: EquationError,
    },
    /// Efficiencies without a third body; the reaction's name stands before.
    #[error("has efficiencies but no M")]
    NoThirdBody,
    /// Efficiencies beside a third body that is one species.
    #[error("has efficiencies beside (+{0})")]
    OneSpecies(String),
}

impl ThirdBody {
    /// What it adds to the order of the rate constant.
    pub fn bodies(&self) -> f64 {
        match self {
            Self::Three => 1.0,
            Self::None | Self::Falloff(_) => 0.0,
        }
    }

    /// The gases that it is, by the efficiencies that a file states; `others`: that of all the rest, where the file
    /// states it. The error is of efficiencies that nothing would use.
    pub fn collider(
        self,
        efficiencies: Vec<(String, f64)>,
        others: Option<f64>,
    ) -> Result<Option<Collider>, MechanismEquationError> {
        let stated = others.is_some() || !efficiencies.is_empty();
        match self {
            Self::None if stated => Err(MechanismEquationError::NoThirdBody),
            Self::None => Ok(None),
            Self::Falloff(Some(species)) if stated => {
                Err(MechanismEquationError::OneSpecies(species))
            }
            Self::Falloff(Some(species)) => Ok(Some(Collider {
                efficiencies: vec![(species, 1.0)],
                others: 0.0,
            })),
            Self::Three | Self::Falloff(None) => Ok(Some(Collider {
                efficiencies,
                others: others.unwrap_or(1.0),
            })),
        }
    }
}

/// Orders of an equation where a file states some; the others keep their numbers of the left side.
pub fn with_orders(equation: &Equation, stated: &[(String, f64)]) -> Vec<(String, f64)> {
    let left = equation.left.iter();
    let mut orders: Vec<(String, f64)> = left.map(|(n, species)| (species.clone(), *n)).collect();
    for (species, order) in stated {
        match orders.iter_mut().find(|(other, _)| other == species) {
            Some((_, own)) => *own = *order,
            None => orders.push((species.clone(), *order)),
        }
    }
    orders
}

/// Reads `CH4+0.5O2=>CO+2H2`, `2 O + M <=> O2 + M`, `H+CH3(+M)=CH4(+M)`; `=` goes both ways.
pub fn parse(text: &str) -> Result<(Equation, ThirdBody), MechanismEquationError> {
    let bare: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let arrow = ["<=>", "=>", "="]
        .into_iter()
        .find(|arrow| bare.contains(arrow));
    let arrow = arrow.ok_or_else(|| MechanismEquationError::NoArrow(text.into()))?;
    let sides: Vec<&str> = bare.split(arrow).collect();
    let [left, right] = sides[..] else {
        return Err(MechanismEquationError::Arrows(text.into()));
    };
    let (left, left_body) = side(left);
    let (right, right_body) = side(right);
    if left_body != right_body {
        return Err(MechanismEquationError::ThirdBodies(text.into()));
    }
    let arrow = if arrow == "=>" { "=>" } else { "<=>" };
    let equation = Equation::parse_adding(&format!("{left} {arrow} {right}")).map_err(|cause| {
        MechanismEquationError::Sides {
            text: text.into(),
            cause,
        }
    })?;
    Ok((equation, left_body))
}

/// A side without its third body.
fn side(text: &str) -> (String, ThirdBody) {
    let mut body = ThirdBody::None;
    let mut rest = text.to_owned();
    if let Some(start) = text.find("(+")
        && let Some(length) = text[start..].find(')')
    {
        let name = &text[start + 2..start + length];
        body = ThirdBody::Falloff((!name.eq_ignore_ascii_case("m")).then(|| name.to_owned()));
        rest.replace_range(start..=start + length, "");
    }
    let mut terms: Vec<&str> = rest.split('+').collect();
    if let Some(k) = terms.iter().position(|term| term.eq_ignore_ascii_case("m"))
        && terms.len() > 1
    {
        terms.remove(k);
        body = ThirdBody::Three;
    }
    (terms.join(" + "), body)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn third_bodies_are_taken_out_and_equal_species_added() {
        let (equation, body) = parse("H + H + M <=> H2 + M").unwrap();
        assert_eq!((equation.left[0].0, body), (2.0, ThirdBody::Three));
        let (equation, body) = parse("CH3+H(+M)=CH4(+M)").unwrap();
        assert!(equation.reversible && equation.right == [(1.0, "CH4".into())]);
        assert_eq!(body, ThirdBody::Falloff(None));
        let (_, body) = parse("CO + O (+ H2O) => CO2 (+ H2O)").unwrap();
        assert_eq!(body, ThirdBody::Falloff(Some("H2O".into())));
        let (equation, body) = parse("CH4+.5O2=>CO+2H2").unwrap();
        assert_eq!((equation.left[1].0, body), (0.5, ThirdBody::None));
    }

    #[test]
    fn orders_that_are_not_stated_are_the_numbers_of_the_left_side() {
        let (equation, _) = parse("2A+B=>C").unwrap();
        let name = |list: &[(&str, f64)]| -> Vec<(String, f64)> {
            list.iter().map(|(name, n)| ((*name).into(), *n)).collect()
        };
        let stated = name(&[("B", 0.5), ("C", -1.0)]);
        let wanted = name(&[("A", 2.0), ("B", 0.5), ("C", -1.0)]);
        assert_eq!(with_orders(&equation, &stated), wanted);
    }

    #[test]
    fn what_is_no_equation_says_why() {
        for (text, why) in [
            ("CH4 + O2", "no arrow"),
            ("A => B => C", "not one arrow"),
            ("O + O + M <=> O2", "not the same third body"),
            ("O2 + + H2 => H2O", "is no term"),
        ] {
            let message = parse(text).unwrap_err().to_string();
            assert!(message.contains(why), "{message}");
        }
    }
}
