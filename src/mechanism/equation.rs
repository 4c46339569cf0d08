//! Equations as mechanisms write them: with third bodies, with or without spaces.

use calcine_coupler::physics::reaction::Equation;

/// The third body of an equation.
#[derive(Clone, Debug, PartialEq)]
pub enum Body {
    /// None.
    None,
    /// `+ M`: the rate is proportional to it.
    Three,
    /// `(+M)`: between two limits of pressure; with a name, that species alone.
    Falloff(Option<String>),
}

/// Reads `CH4+0.5O2=>CO+2H2`, `2 O + M <=> O2 + M`, `H+CH3(+M)=CH4(+M)`; `=` goes both ways.
pub fn parse(text: &str) -> Result<(Equation, Body), String> {
    let bare: String = text.chars().filter(|c| !c.is_whitespace()).collect();
    let arrow = ["<=>", "=>", "="]
        .into_iter()
        .find(|arrow| bare.contains(arrow));
    let arrow = arrow.ok_or_else(|| format!("\"{text}\" is no equation: it has no arrow"))?;
    let sides: Vec<&str> = bare.split(arrow).collect();
    let [left, right] = sides[..] else {
        return Err(format!("\"{text}\" is no equation: it has not one arrow"));
    };
    let (left, left_body) = side(left);
    let (right, right_body) = side(right);
    if left_body != right_body {
        return Err(format!(
            "\"{text}\" has not the same third body on both sides"
        ));
    }
    let arrow = if arrow == "=>" { "=>" } else { "<=>" };
    let equation = Equation::parse_adding(&format!("{left} {arrow} {right}"))
        .map_err(|error| format!("\"{text}\" is no equation: {error}"))?;
    Ok((equation, left_body))
}

/// A side without its third body.
fn side(text: &str) -> (String, Body) {
    let mut body = Body::None;
    let mut rest = text.to_owned();
    if let Some(start) = text.find("(+")
        && let Some(length) = text[start..].find(')')
    {
        let name = &text[start + 2..start + length];
        body = Body::Falloff((!name.eq_ignore_ascii_case("m")).then(|| name.to_owned()));
        rest.replace_range(start..=start + length, "");
    }
    let mut terms: Vec<&str> = rest.split('+').collect();
    if let Some(k) = terms.iter().position(|term| term.eq_ignore_ascii_case("m"))
        && terms.len() > 1
    {
        terms.remove(k);
        body = Body::Three;
    }
    (terms.join(" + "), body)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn third_bodies_are_taken_out_and_equal_species_added() {
        let (equation, body) = parse("H + H + M <=> H2 + M").unwrap();
        assert_eq!((equation.left[0].0, body), (2.0, Body::Three));
        let (equation, body) = parse("CH3+H(+M)=CH4(+M)").unwrap();
        assert!(equation.reversible && equation.right == [(1.0, "CH4".into())]);
        assert_eq!(body, Body::Falloff(None));
        let (_, body) = parse("CO + O (+ H2O) => CO2 (+ H2O)").unwrap();
        assert_eq!(body, Body::Falloff(Some("H2O".into())));
        let (equation, body) = parse("CH4+.5O2=>CO+2H2").unwrap();
        assert_eq!((equation.left[1].0, body), (0.5, Body::None));
    }

    #[test]
    fn what_is_no_equation_says_why() {
        for (text, why) in [
            ("CH4 + O2", "no arrow"),
            ("A => B => C", "not one arrow"),
            ("O + O + M <=> O2", "not the same third body"),
            ("O2 + + H2 => H2O", "is no term"),
        ] {
            let message = parse(text).unwrap_err();
            assert!(message.contains(why), "{message}");
        }
    }
}
