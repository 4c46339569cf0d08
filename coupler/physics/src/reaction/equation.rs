//! Equations of reactions as text.

use thiserror::Error;

use crate::thermo::Element;

/// An equation such as `3 Fe2O3 + CO => 2 Fe3O4 + CO2`, or with `<=>` where it goes both ways.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Coefficients, positive, and names on the left.
    pub left: Vec<(f64, String)>,
    /// The same on the right.
    pub right: Vec<(f64, String)>,
    /// True with `<=>`.
    pub reversible: bool,
}

/// A text that is no equation.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EquationError {
    /// No arrow, or more than one.
    #[error("\"{text}\" has not one arrow: write => (one way) or <=> (both ways)")]
    Arrow {
        /// The text.
        text: String,
    },
    /// A term that is none.
    #[error("\"{term}\" is no term: write a number and a species, such as 2 CO or 0.947 Fe")]
    Term {
        /// The term.
        term: String,
    },
    /// A species that stands twice on one side.
    #[error("{name} stands twice on one side")]
    Twice {
        /// The species.
        name: String,
    },
}

impl Equation {
    /// Reads an equation.
    pub fn parse(text: &str) -> Result<Self, EquationError> {
        Self::read(text, false)
    }

    /// Reads an equation in which a species may stand twice on one side, such as `H + H => H2`: its numbers
    /// are added.
    pub fn parse_adding(text: &str) -> Result<Self, EquationError> {
        Self::read(text, true)
    }

    fn read(text: &str, adding: bool) -> Result<Self, EquationError> {
        let (arrow, reversible) = if text.contains("<=>") {
            ("<=>", true)
        } else {
            ("=>", false)
        };
        let sides: Vec<&str> = text.split(arrow).collect();
        let [left, right] = sides[..] else {
            return Err(EquationError::Arrow { text: text.into() });
        };
        if left.contains("=>") || right.contains("=>") {
            return Err(EquationError::Arrow { text: text.into() });
        }
        Ok(Self {
            left: side(left, adding)?,
            right: side(right, adding)?,
            reversible,
        })
    }

    /// All names, each with what a run of the reaction makes (+) or uses up (−) of it.
    pub fn net(&self) -> Vec<(String, f64)> {
        let mut net: Vec<(String, f64)> = Vec::new();
        let used = self.left.iter().map(|(n, name)| (-n, name));
        let made = self.right.iter().map(|(n, name)| (*n, name));
        for (n, name) in used.chain(made) {
            match net.iter_mut().find(|(other, _)| other == name) {
                Some((_, sum)) => *sum += n,
                None => net.push((name.clone(), n)),
            }
        }
        net
    }
}

/// Atoms that a mole of a balanced reaction may lose: printed coefficients have few digits.
const BALANCED: f64 = 1e-9;

/// Says of each element how many atoms more one side has, from what the right side has more than the left; `None` of a
/// balanced reaction.
pub fn imbalance(more_on_the_right: impl Fn(Element) -> f64) -> Option<String> {
    let off = Element::ALL.into_iter().filter_map(|element| {
        let sum = more_on_the_right(element);
        let side = if sum > 0.0 { "right" } else { "left" };
        (sum.abs() > BALANCED)
            .then(|| format!("{:.6} {} more on the {side}", sum.abs(), element.symbol()))
    });
    let off: Vec<String> = off.collect();
    (!off.is_empty()).then(|| off.join(", "))
}

fn side(text: &str, adding: bool) -> Result<Vec<(f64, String)>, EquationError> {
    let mut terms: Vec<(f64, String)> = Vec::new();
    for term in text.split(" + ") {
        let (n, name) = self::term(term)?;
        match terms.iter_mut().find(|(_, other)| *other == name) {
            Some((sum, _)) if adding => *sum += n,
            Some(_) => return Err(EquationError::Twice { name }),
            None => terms.push((n, name)),
        }
    }
    Ok(terms)
}

fn term(text: &str) -> Result<(f64, String), EquationError> {
    let text = text.trim();
    let fail = || EquationError::Term { term: text.into() };
    let start = text
        .find(|c: char| !(c.is_ascii_digit() || c == '.'))
        .ok_or_else(fail)?;
    let (number, name) = text.split_at(start);
    let n = match number {
        "" => 1.0,
        digits => digits.parse::<f64>().map_err(|_| fail())?,
    };
    let name = name.trim();
    let first = name.chars().next().is_some_and(char::is_alphabetic);
    if !(first && n > 0.0) || name.contains(char::is_whitespace) {
        return Err(fail());
    }
    Ok((n, name.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_equation_is_read_with_numbers_and_direction() {
        let one = Equation::parse("3 Fe2O3 + CO <=> 2 Fe3O4 + CO2").unwrap();
        assert!(one.reversible);
        assert_eq!(one.left, [(3.0, "Fe2O3".into()), (1.0, "CO".into())]);
        assert_eq!(one.right[0], (2.0, "Fe3O4".into()));
        let other = Equation::parse("Fe0.947O + H2 => 0.947 Fe + H2O").unwrap();
        assert_eq!(other.left[0], (1.0, "Fe0.947O".into()));
        assert_eq!(other.right[0], (0.947, "Fe".into()));
        assert!(!other.reversible);
    }

    #[test]
    fn the_net_of_a_species_on_both_sides_is_its_difference() {
        let net = Equation::parse("C + 2 CO => 3 CO").unwrap().net();
        assert_eq!(net, [("C".into(), -1.0), ("CO".into(), 1.0)]);
    }

    #[test]
    fn numbers_are_added_where_a_species_may_stand_twice() {
        let one = Equation::parse_adding("H + H + 2 O => H2 + O2").unwrap();
        assert_eq!(one.left, [(2.0, "H".into()), (2.0, "O".into())]);
    }

    #[test]
    fn what_is_no_equation_says_why() {
        for (text, why) in [
            ("CaCO3", "has not one arrow"),
            ("A => B => C", "has not one arrow"),
            ("A <=> B => C", "has not one arrow"),
            ("=> CO", "\"\" is no term"),
            ("2 => CO", "\"2\" is no term"),
            ("C + C => C2", "C stands twice"),
            ("CO O2 => CO2", "is no term"),
        ] {
            let message = Equation::parse(text).unwrap_err().to_string();
            assert!(message.contains(why), "{text}: {message}");
        }
    }
}
