//! Chemical formulas.

use thiserror::Error;

use crate::thermo::Element;

/// A text that is no formula.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "{text} is no formula: {why}; write elements with their numbers, such as CaCO3 or Fe0.947O"
)]
pub struct FormulaError {
    /// The text.
    pub text: String,
    /// What is wrong with it.
    pub why: FormulaFault,
}

/// What is wrong with a text that should be a formula.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FormulaFault {
    /// `)` without `(`.
    #[error("a parenthesis closes that was not opened")]
    NotOpened,
    /// `(` without `)`.
    #[error("a parenthesis is not closed")]
    NotClosed,
    /// No atom at all.
    #[error("it has no atom")]
    Empty,
    /// A symbol that is none of a known element.
    #[error("\"{rest}\" begins with none of {}", Element::ALL.map(Element::symbol).join(", "))]
    Element {
        /// The text from there on.
        rest: String,
    },
    /// A number that is none, or not positive.
    #[error("\"{text}\" is not a number of atoms")]
    Number {
        /// The number.
        text: String,
    },
}

/// Atoms of a formula such as CaCO3, Ca(OH)2 or Fe0.947O, in the order of [`Element::ALL`].
pub fn atoms(text: &str) -> Result<[f64; Element::COUNT], FormulaError> {
    let fail = |why: FormulaFault| FormulaError {
        text: text.to_owned(),
        why,
    };
    let mut levels = vec![[0.0; Element::COUNT]];
    let letters: Vec<char> = text.chars().collect();
    let mut at = 0;
    while let Some(&letter) = letters.get(at) {
        match letter {
            '(' => {
                levels.push([0.0; Element::COUNT]);
                at += 1;
            }
            ')' => {
                at += 1;
                let times = number(&letters, &mut at).map_err(fail)?;
                let inner = levels.pop().unwrap_or_default();
                let Some(outer) = levels.last_mut() else {
                    return Err(fail(FormulaFault::NotOpened));
                };
                for (sum, n) in outer.iter_mut().zip(inner) {
                    *sum += times * n;
                }
            }
            _ => {
                let symbol = symbol(&letters, &mut at).map_err(fail)?;
                let times = number(&letters, &mut at).map_err(fail)?;
                if let Some(level) = levels.last_mut() {
                    level[symbol as usize] += times;
                }
            }
        }
    }
    match levels[..] {
        [atoms] if atoms.iter().any(|n| *n > 0.0) => Ok(atoms),
        [_] => Err(fail(FormulaFault::Empty)),
        _ => Err(fail(FormulaFault::NotClosed)),
    }
}

fn symbol(letters: &[char], at: &mut usize) -> Result<Element, FormulaFault> {
    let of = |length: usize| -> Option<Element> {
        let text: String = letters.get(*at..*at + length)?.iter().collect();
        Element::ALL.into_iter().find(|one| one.symbol() == text)
    };
    let (found, length) = match (of(2), of(1)) {
        (Some(element), _) => (element, 2),
        (None, Some(element)) => (element, 1),
        (None, None) => {
            let rest: String = letters[*at..].iter().collect();
            return Err(FormulaFault::Element { rest });
        }
    };
    *at += length;
    Ok(found)
}

fn number(letters: &[char], at: &mut usize) -> Result<f64, FormulaFault> {
    let digits = letters[*at..].iter();
    let text: String = digits
        .take_while(|c| c.is_ascii_digit() || **c == '.')
        .collect();
    *at += text.chars().count();
    if text.is_empty() {
        return Ok(1.0);
    }
    let value = text.parse::<f64>().ok().filter(|value| *value > 0.0);
    value.ok_or(FormulaFault::Number { text })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(text: &str, element: Element) -> f64 {
        atoms(text).unwrap()[element as usize]
    }

    #[test]
    fn atoms_are_counted_with_fractions_and_parentheses() {
        assert_eq!(count("CaCO3", Element::O), 3.0);
        assert_eq!(count("CaCO3", Element::C), 1.0);
        assert_eq!(count("Fe0.947O", Element::Fe), 0.947);
        assert_eq!(count("Ca(OH)2", Element::H), 2.0);
        assert_eq!(count("CO", Element::C), 1.0);
    }

    #[test]
    fn what_is_no_formula_says_why() {
        for (text, why) in [
            ("Xy2", "\"Xy2\" begins with none of H, C"),
            ("", "no atom"),
            ("Ca(OH", "not closed"),
            ("CaO)", "was not opened"),
            ("Fe0", "\"0\" is not a number"),
        ] {
            let message = atoms(text).unwrap_err().to_string();
            assert!(message.contains(why), "{message}");
        }
    }
}
