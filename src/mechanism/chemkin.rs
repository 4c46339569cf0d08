//! CHEMKIN's mechanisms: ELEMENTS, SPECIES, THERMO, REACTIONS; rate constants of Arrhenius, with third bodies, LOW, TROE, FORD.

use calcine_coupler::physics::kinetics::{Broadening, RateConstant, ReactionStatement};
use calcine_coupler::physics::reaction::{Arrhenius, Equation};

use super::chemkin_thermo;
use super::equation::{self, ThirdBody};
use super::fault::{Fault, fault};
use super::file::{self, MechanismFile, ParsedReaction};
use super::units::{self, MechanismUnits};
use crate::fortran::number;

/// Words after a reaction that are known and not read.
const REFUSED: &[&str] = &[
    "REV", "RORD", "PLOG", "CHEB", "TCHEB", "PCHEB", "SRI", "HIGH", "LT", "RLT", "FIT1", "JAN",
    "EXCI", "MOME", "XSMI", "TDEP", "UNITS", "COLLEFF", "USRPROG", "STICK", "COV",
];

/// Sections of a file.
#[derive(Clone, Copy, PartialEq)]
enum Section {
    None,
    Elements,
    Species,
    Thermo,
    Reactions,
}

/// Reads a file.
pub fn parse(text: &str) -> Result<MechanismFile, Fault> {
    let mut file = MechanismFile::default();
    let mut section = Section::None;
    let mut units = MechanismUnits::CHEMKIN;
    let mut thermo = (0, String::new());
    let mut drafts: Vec<Draft> = Vec::new();
    for (k, whole) in text.lines().enumerate() {
        let line = k + 1;
        let bare = whole.split('!').next().unwrap_or("").trim();
        let mut words = bare.split_whitespace();
        let first = words.next().unwrap_or("").to_ascii_uppercase();
        let opened = match first.as_str() {
            "ELEMENTS" | "ELEM" => Some(Section::Elements),
            "SPECIES" | "SPEC" => Some(Section::Species),
            "THERMO" | "THER" => Some(Section::Thermo),
            "REACTIONS" | "REAC" => Some(Section::Reactions),
            "TRANSPORT" | "TRAN" => return fault(line, "a section TRANSPORT is not read"),
            "END" => Some(Section::None),
            _ => None,
        };
        if let Some(opened) = opened {
            section = opened;
            if section == Section::Thermo {
                thermo = (line, String::new());
            }
            if section == Section::Reactions {
                units = self::units(words, line)?;
            }
            continue;
        }
        match section {
            Section::Thermo => {
                thermo.1.push_str(whole);
                thermo.1.push('\n');
            }
            Section::Reactions if !bare.is_empty() => match bare.contains('=') {
                true => drafts.push(draft(bare, line)?),
                false => match drafts.last_mut() {
                    Some(draft) => auxiliary(draft, bare, line)?,
                    None => return fault(line, format!("\"{bare}\" is no reaction")),
                },
            },
            Section::None if !bare.is_empty() => {
                return fault(line, format!("\"{bare}\" is in no section"));
            }
            _ => {}
        }
    }
    for draft in drafts {
        file.reactions.push(draft.finish(&units)?);
    }
    if !thermo.1.is_empty() {
        file.thermo = chemkin_thermo::parse(&thermo.1, Some(thermo.0))?;
    }
    Ok(file)
}

/// Units behind REACTIONS.
fn units<'w>(words: impl Iterator<Item = &'w str>, line: usize) -> Result<MechanismUnits, Fault> {
    let mut made = MechanismUnits::CHEMKIN;
    for word in words {
        if let Some(unit) = units::activation_energy(word) {
            made.activation_energy = unit;
        } else if let Some(unit) = units::quantity(word) {
            made.quantity = unit;
        } else {
            return fault(line, format!("the unit {word} of REACTIONS is not read"));
        }
    }
    Ok(made)
}

/// A reaction whose further lines may follow.
struct Draft {
    name: String,
    line: usize,
    equation: Equation,
    body: ThirdBody,
    rate: [f64; 3],
    low: Option<[f64; 3]>,
    troe: Option<Vec<f64>>,
    orders: Vec<(String, f64)>,
    efficiencies: Vec<(String, f64)>,
    duplicate: bool,
}

fn draft(bare: &str, line: usize) -> Result<Draft, Fault> {
    let words: Vec<&str> = bare.split_whitespace().collect();
    let split = words.len().saturating_sub(3);
    let numbers: Option<Vec<f64>> = words[split..].iter().map(|word| number(word)).collect();
    let rate = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
    let Some(rate) = rate.filter(|_| split > 0) else {
        return fault(
            line,
            format!("\"{bare}\" does not end in three numbers A, b, E"),
        );
    };
    if number(words[split - 1]).is_some() {
        let what = format!("\"{bare}\" has more than three numbers A, b, E behind its equation");
        return fault(line, what);
    }
    let name = words[..split].join(" ");
    let (equation, body) = equation::parse(&name).map_err(|what| (Some(line), what.to_string()))?;
    Ok(Draft {
        name,
        line,
        equation,
        body,
        rate,
        low: None,
        troe: None,
        orders: Vec::new(),
        efficiencies: Vec::new(),
        duplicate: false,
    })
}

/// A line such as `LOW/1E20 -1 5E4/ H2O/6/ CO2/2/ DUP`.
fn auxiliary(draft: &mut Draft, bare: &str, line: usize) -> Result<(), Fault> {
    let mut rest = bare;
    while !rest.trim().is_empty() {
        rest = rest.trim_start();
        let end = rest
            .find(|c: char| c == '/' || c.is_whitespace())
            .unwrap_or(rest.len());
        let (word, tail) = rest.split_at(end);
        let tail = tail.trim_start();
        let upper = word.to_ascii_uppercase();
        if upper.starts_with("DUP") && !tail.starts_with('/') {
            draft.duplicate = true;
            rest = tail;
            continue;
        }
        if REFUSED.contains(&upper.as_str()) {
            return fault(line, format!("{word} of {} is not read", draft.name));
        }
        let inner = tail.strip_prefix('/').and_then(|tail| tail.split_once('/'));
        let Some((inner, after)) = inner else {
            return fault(
                line,
                format!("\"{bare}\" is not read: {word} has no values between /"),
            );
        };
        rest = after;
        let values = || -> Result<Vec<f64>, Fault> {
            let words = inner.split_whitespace();
            let numbers: Option<Vec<f64>> = words.map(number).collect();
            numbers.ok_or_else(|| {
                (
                    Some(line),
                    format!("{word} has \"{inner}\", which are not numbers"),
                )
            })
        };
        match upper.as_str() {
            "LOW" => {
                let Ok(three) = <[f64; 3]>::try_from(values()?) else {
                    return fault(line, "LOW has not three numbers A, b, E");
                };
                if draft.low.replace(three).is_some() {
                    return fault(line, format!("{} has LOW twice", draft.name));
                }
            }
            "TROE" => {
                if draft.troe.replace(values()?).is_some() {
                    return fault(line, format!("{} has TROE twice", draft.name));
                }
            }
            "FORD" => {
                let mut words = inner.split_whitespace();
                let pair = (words.next(), words.next().and_then(number), words.next());
                let (Some(species), Some(order), None) = pair else {
                    return fault(
                        line,
                        format!("FORD has \"{inner}\", not a species and its order"),
                    );
                };
                draft.orders.push((species.to_owned(), order));
            }
            _ => match values()?[..] {
                [efficiency] => draft.efficiencies.push((word.to_owned(), efficiency)),
                _ => return fault(line, format!("{word} has \"{inner}\", not one efficiency")),
            },
        }
    }
    Ok(())
}

impl Draft {
    fn finish(self, units: &MechanismUnits) -> Result<ParsedReaction, Fault> {
        let refuse = |what: &str| fault(self.line, format!("{} {what}", self.name));
        if !self.orders.is_empty() && self.equation.reversible {
            return refuse("goes both ways and has FORD, whose way back is not defined");
        }
        let orders = equation::with_orders(&self.equation, &self.orders);
        let order: f64 = orders.iter().map(|(_, n)| n).sum();
        let law = |[factor, exponent, energy]: [f64; 3], order: f64| Arrhenius {
            factor: units.factor(factor, order),
            exponent,
            activation_energy: energy * units.activation_energy,
        };
        let rate = match (&self.body, self.low, &self.troe) {
            (ThirdBody::Falloff(_), Some(low), troe) => RateConstant::Falloff {
                high: law(self.rate, order),
                low: law(low, order + 1.0),
                broadening: self.broadening(troe.as_deref())?,
            },
            (ThirdBody::Falloff(_), None, _) => return refuse("has (+M) but no LOW"),
            (_, Some(_), _) => return refuse("has LOW but no (+M)"),
            (_, None, Some(_)) => return refuse("has TROE but no (+M)"),
            (_, None, None) => RateConstant::Arrhenius(law(self.rate, order + self.body.bodies())),
        };
        if self.rate[0] < 0.0 && !self.duplicate {
            return refuse("has a negative A and is no DUPLICATE");
        }
        let collider = self.body.collider(self.efficiencies, None);
        let collider =
            collider.map_err(|what| (Some(self.line), format!("{} {what}", self.name)))?;
        Ok(ParsedReaction {
            statement: ReactionStatement {
                name: self.name,
                equation: self.equation,
                orders: (!self.orders.is_empty()).then_some(orders),
                rate,
                collider,
            },
            line: self.line,
            duplicate: self.duplicate,
        })
    }

    fn broadening(&self, troe: Option<&[f64]>) -> Result<Broadening, Fault> {
        match troe {
            None => Ok(Broadening::Lindemann),
            Some(&[share, third, first]) => Ok(file::troe([share, third, first], None)),
            Some(&[share, third, first, second]) => {
                Ok(file::troe([share, third, first], Some(second)))
            }
            Some(_) => fault(
                self.line,
                format!("{}: TROE has not three or four numbers", self.name),
            ),
        }
    }
}
