//! Files of gas reactions: subsets of Cantera's YAML and of CHEMKIN's formats. What a file has beyond them is refused by its
//! name and line.

mod cantera;
mod chemkin;
mod chemkin_thermo;
mod chemkin_transport;
mod equation;
mod fault;
mod file;
mod units;
mod yaml;

use calcine_coupler::regular_file;
use std::path::{Path, PathBuf};

use calcine_coupler::physics::kinetics::{Collider, Mechanism, ReactionStatement};
use calcine_coupler::physics::thermo::Mixture;
use thiserror::Error;

pub use chemkin_transport::Molecule;
use fault::{Fault, fault};
pub use file::{MechanismFile, ParsedReaction, Thermo};

/// A file that cannot be used.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{}{}: {what}", .file.display(), at(.line))]
pub struct MechanismError {
    /// The file.
    pub file: PathBuf,
    /// The line, where there is one.
    pub line: Option<usize>,
    /// What is wrong.
    pub what: String,
}

fn at(line: &Option<usize>) -> String {
    line.map_or(String::new(), |line| format!(":{line}"))
}

/// How far the enthalpy of formation, or the Gibbs energy at 1500 K, of a species in a file may be from that of Calcine's own, in
/// J/mol: tables of different years differ by less.
const CONTRADICTS: f64 = 3e3;

/// Reads a mechanism, Cantera's where the name ends in `.yaml` or `.yml`, else CHEMKIN's, with a CHEMKIN file of
/// thermodynamics beside it where there is one.
pub fn read(path: &Path, thermo: Option<&Path>) -> Result<MechanismFile, MechanismError> {
    let text = contents(path)?;
    let mut file = parse(path, &text)?;
    if let Some(thermo) = thermo {
        let text = contents(thermo)?;
        let found = chemkin_thermo::parse(&text, None).map_err(|fault| placed(thermo, fault))?;
        file.thermo.extend(found);
        file.thermo_path = Some(thermo.to_owned());
    }
    Ok(file)
}

/// Reads the thermodynamics of species: Cantera's where the name ends in `.yaml` or `.yml`, which may have their transport
/// too, else CHEMKIN's cards.
pub fn read_thermo(path: &Path) -> Result<Vec<Thermo>, MechanismError> {
    let text = contents(path)?;
    let parsed = match is_yaml(path) {
        true => cantera::parse_species(&text),
        false => chemkin_thermo::parse(&text, None),
    };
    parsed.map_err(|fault| placed(path, fault))
}

/// Reads the potentials of molecules in a file of CHEMKIN's transport data.
pub fn read_transport(path: &Path) -> Result<Vec<Molecule>, MechanismError> {
    let text = contents(path)?;
    chemkin_transport::parse(&text).map_err(|fault| placed(path, fault))
}

fn is_yaml(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| ["yaml", "yml"].contains(&ending))
}

fn contents(path: &Path) -> Result<String, MechanismError> {
    let bytes = regular_file::read(path)
        .map_err(|cause| placed(path, (None, format!("cannot be read: {cause}"))))?;
    // Old files have comments in Latin letters of one byte.
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Reads the text of a mechanism; `path` says which format it has and places messages.
pub fn parse(path: &Path, text: &str) -> Result<MechanismFile, MechanismError> {
    let parsed = if is_yaml(path) {
        cantera::parse(text)
    } else {
        chemkin::parse(text)
    };
    let mut file = parsed.map_err(|fault| placed(path, fault))?;
    path.clone_into(&mut file.path);
    repeated(&file.reactions).map_err(|fault| placed(path, fault))?;
    Ok(file)
}

fn placed(path: &Path, (line, what): Fault) -> MechanismError {
    MechanismError {
        file: path.to_owned(),
        line,
        what,
    }
}

/// What makes two reactions one: sides in any order, and the third body.
struct Identity<'a> {
    left: Vec<(&'a str, f64)>,
    right: Vec<(&'a str, f64)>,
    reversible: bool,
    body: Option<Option<&'a str>>,
}

impl<'a> Identity<'a> {
    fn of(statement: &'a ReactionStatement) -> Self {
        let sorted = |side: &'a [(f64, String)]| {
            let mut side: Vec<_> = side.iter().map(|(n, name)| (name.as_str(), *n)).collect();
            side.sort_by(|one, other| one.0.cmp(other.0));
            side
        };
        Self {
            left: sorted(&statement.equation.left),
            right: sorted(&statement.equation.right),
            reversible: statement.equation.reversible,
            body: statement.collider.as_ref().map(alone),
        }
    }

    /// True of two equations of which one has a way of the other.
    fn same_way(&self, other: &Self) -> bool {
        let backwards = self.left == other.right && self.right == other.left;
        (self.left == other.left && self.right == other.right)
            || (backwards && (self.reversible || other.reversible))
    }

    /// The same for third bodies that act in both.
    fn same(&self, other: &Self) -> bool {
        self.body == other.body && self.same_way(other)
    }
}

/// The one gas that a third body is; `None` where it is several.
fn alone(collider: &Collider) -> Option<&str> {
    let mut some = collider.efficiencies.iter().filter(|one| one.1 != 0.0);
    match (some.next(), some.next()) {
        (Some((name, _)), None) if collider.others == 0.0 => Some(name),
        _ => None,
    }
}

/// Two reactions of one equation must both say so, and one that says so must have another: else one is a slip.
fn repeated(reactions: &[ParsedReaction]) -> Result<(), Fault> {
    let all: Vec<_> = reactions
        .iter()
        .map(|one| Identity::of(&one.statement))
        .collect();
    for (k, one) in reactions.iter().enumerate() {
        let Some(other) = all[..k].iter().position(|other| other.same(&all[k])) else {
            let mut others = all.iter().enumerate().filter(|other| other.0 != k);
            if one.duplicate && !others.any(|(_, other)| other.same_way(&all[k])) {
                let what = format!(
                    "{} says that it is a duplicate, but no other reaction has its equation",
                    one.statement.name
                );
                return fault(one.line, what);
            }
            continue;
        };
        let other = &reactions[other];
        if !(one.duplicate && other.duplicate) {
            return fault(
                one.line,
                format!(
                    "{} stands in line {} too, and not both say that they are duplicates",
                    one.statement.name, other.line
                ),
            );
        }
    }
    Ok(())
}

impl MechanismFile {
    /// The mechanism over the species of a mixture.
    pub fn over(&self, mixture: &Mixture) -> Result<Mechanism, MechanismError> {
        if self.reactions.is_empty() {
            let what = "has no reactions".into();
            return Err(placed(&self.path, (None, what)));
        }
        for one in &self.reactions {
            let alone = std::slice::from_ref(&one.statement);
            Mechanism::new(mixture, alone)
                .map_err(|error| placed(&self.path, (Some(one.line), error.to_string())))?;
        }
        self.agrees(mixture)?;
        let all: Vec<ReactionStatement> = self
            .reactions
            .iter()
            .map(|one| one.statement.clone())
            .collect();
        Mechanism::new(mixture, &all).map_err(|error| placed(&self.path, (None, error.to_string())))
    }

    /// The mixture's own thermodynamics count; those of the file must be of the same species.
    fn agrees(&self, mixture: &Mixture) -> Result<(), MechanismError> {
        for species in mixture.species() {
            let Some(stated) = self.thermo.iter().find(|one| one.name == species.name()) else {
                continue;
            };
            let path = self.thermo_path.as_ref().unwrap_or(&self.path);
            let fail = |what: String| placed(path, (Some(stated.line), what));
            if stated.atoms != *species.atoms() {
                return Err(fail(format!("{} is made of other atoms", stated.name)));
            }
            let own = species.polynomial();
            for (what, here, there) in [
                (
                    "an enthalpy of formation",
                    stated.polynomial.enthalpy(298.15),
                    own.enthalpy(298.15),
                ),
                (
                    "a Gibbs energy at 1500 K",
                    stated.polynomial.gibbs_energy(1500.0),
                    own.gibbs_energy(1500.0),
                ),
            ] {
                if (here - there).abs() > CONTRADICTS {
                    return Err(fail(format!(
                        "{} has {what} of {:.2} kJ/mol, but Calcine's {} has {:.2} kJ/mol",
                        stated.name,
                        here / 1e3,
                        species.name(),
                        there / 1e3
                    )));
                }
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
