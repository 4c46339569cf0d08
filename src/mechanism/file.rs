//! What files say.

use std::path::PathBuf;

use calcine_coupler::physics::kinetics::{Broadening, ReactionStatement};
use calcine_coupler::physics::thermo::{Element, LennardJones, Nasa7};

/// A reaction of a file.
#[derive(Clone, Debug)]
pub struct ParsedReaction {
    /// The reaction.
    pub statement: ReactionStatement,
    /// Its line.
    pub line: usize,
    /// True where it says that another has its equation.
    pub duplicate: bool,
}

/// Thermodynamics of a species of a file.
#[derive(Clone, Debug)]
pub struct Thermo {
    /// Its name.
    pub name: String,
    /// Its line.
    pub line: usize,
    /// Atoms in the order of [`Element::ALL`].
    pub atoms: [f64; Element::COUNT],
    /// Its polynomials, molar, at 1 bar.
    pub polynomial: Nasa7,
    /// How its molecules meet, where the file says so.
    pub potential: Option<LennardJones>,
}

/// What files say: reactions in mol, m³, s, J and the species' thermodynamics.
#[derive(Clone, Debug, Default)]
pub struct MechanismFile {
    /// Where it stands.
    pub path: PathBuf,
    /// Its reactions.
    pub reactions: Vec<ParsedReaction>,
    /// Species with their thermodynamics; those with elements that Calcine does not have are left out.
    pub thermo: Vec<Thermo>,
    /// Where the thermodynamics stand, if in a file of their own.
    pub thermo_path: Option<PathBuf>,
}

/// Troe's form of the numbers a, T₃, T₁ and T₂ of a file, in K. T₂ of zero leaves its term out, as it does in Cantera: the
/// term would be one.
pub(super) fn troe([share, third, first]: [f64; 3], second: Option<f64>) -> Broadening {
    Broadening::Troe {
        share,
        third,
        first,
        second: second.filter(|second| *second != 0.0),
    }
}
