//! Numbers that are not finite, or that no gas can have: where they stand, and what they are of.

use std::fmt;

use calcine_physics::Vec3;
use rayon::prelude::*;
use thiserror::Error;

use crate::part::{CellExchange, GasFields};
use crate::time::{Ticks, Window};

/// Values that one thread takes at a time.
const CHUNK: usize = 16_384;
/// What a mass fraction may lie outside 0 to 1 by. Solvers leave traces at their tolerance; beyond this, density and
/// enthalpy are those of no gas, and the next window would begin with them.
const OUTSIDE: f64 = 0.1;
/// Exponent of a number that is infinite or NaN.
const EXPONENT: u64 = 0x7ff0_0000_0000_0000;

/// A number of a window that is not finite, or a mass fraction that no gas can have.
#[derive(Clone, Debug, Error, PartialEq)]
#[error(
    "window {window} (from {start}): {quantity} {place} is {value}; shorter windows may help (`time.motion_window`, or \
     `time.process_step` of a frozen bed); `calcine check` compares the window with what the bed and the gas need"
)]
pub struct NotFinite {
    /// Index of the window.
    pub window: u64,
    /// Process time at which it began.
    pub start: Ticks,
    /// What it is a value of.
    pub quantity: String,
    /// Where it stands.
    pub place: NotFinitePlace,
    /// The value.
    pub value: f64,
}

/// Where such a number stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NotFinitePlace {
    /// In a cell of the gas' mesh.
    Cell {
        /// Its index.
        cell: usize,
        /// Its centre in m.
        centre: Vec3,
    },
    /// Of a particle.
    Particle {
        /// Its id.
        id: u64,
        /// Its centre in m.
        centre: Vec3,
    },
    /// In a line of the ledger.
    Ledger,
}

impl fmt::Display for NotFinitePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let at = |f: &mut fmt::Formatter<'_>, x: &Vec3| {
            write!(f, " at ({:.6}, {:.6}, {:.6}) m", x.x, x.y, x.z)
        };
        match self {
            Self::Cell { cell, centre } => {
                write!(f, "in cell {cell}")?;
                at(f, centre)
            }
            Self::Particle { id, centre } => {
                write!(f, "of particle {id}")?;
                at(f, centre)
            }
            Self::Ledger => f.write_str("in the ledger"),
        }
    }
}

/// What a value may be made of.
pub(crate) trait Numbers: Sync {
    /// False where all of it is finite; without a branch, so that lanes take several at a time.
    fn broken(&self) -> bool;
    /// The number of it that is not finite.
    fn value(&self) -> f64;
}

impl Numbers for f64 {
    fn broken(&self) -> bool {
        self.to_bits() & EXPONENT == EXPONENT
    }

    fn value(&self) -> f64 {
        *self
    }
}

impl Numbers for Vec3 {
    fn broken(&self) -> bool {
        self.x.broken() | self.y.broken() | self.z.broken()
    }

    fn value(&self) -> f64 {
        let mut numbers = self.iter().copied();
        numbers.find(Numbers::broken).unwrap_or_default()
    }
}

/// Place and value of the first of a list that is not finite.
fn first_in<N: Numbers>(values: &[N]) -> Option<(usize, f64)> {
    let parts = values.par_chunks(CHUNK).enumerate();
    let broken = parts.filter(|(_, part)| part.iter().fold(false, |any, one| any | one.broken()));
    let chunk = broken.map(|(chunk, _)| chunk).min()?;
    let first = chunk * CHUNK;
    let row = first + values[first..].iter().position(Numbers::broken)?;
    Some((row, values[row].value()))
}

/// The first of several lists in which a value is not finite: its name, the value's place, the value.
pub(crate) fn first_of<N: Numbers>(
    lists: &[(&'static str, &[N])],
) -> Option<(&'static str, usize, f64)> {
    lists
        .iter()
        .find_map(|(name, values)| first_in(values).map(|(place, value)| (*name, place, value)))
}

/// What a number is of, where it stands, the number.
pub(crate) type Broken = (String, NotFinitePlace, f64);

/// The first number of a gas, of what it is told otherwise, that is not finite.
pub(crate) fn check_told(
    cells: &CellExchange,
    gas: &GasFields<'_>,
    (species, centre): (&[String], &[Vec3]),
    window: &Window,
) -> Result<(), NotFinite> {
    let Some((quantity, cell, value)) = told(cells) else {
        return Ok(());
    };
    // What the gas is told may only follow from what it has.
    let told = || {
        let centre = centre[cell];
        let place = NotFinitePlace::Cell { cell, centre };
        (quantity.to_owned(), place, value)
    };
    Err(refusal(
        window,
        broken_gas(gas, species, centre).unwrap_or_else(told),
    ))
}

/// The refusal of a number of a window.
pub(crate) fn refusal(window: &Window, (quantity, place, value): Broken) -> NotFinite {
    NotFinite {
        window: window.index,
        start: window.start.process,
        quantity,
        place,
        value,
    }
}

/// The first number of what a gas is told that is not finite: what it is, its cell, the number.
fn told(cells: &CellExchange) -> Option<(&'static str, usize, f64)> {
    let species = &cells.species;
    let count = cells.heat_source.len().max(1);
    let of_cells = first_of(&[
        ("the heat from particles", &cells.heat_source[..]),
        ("the heat transfer coefficient", &cells.heat_coefficient),
        ("the drag coefficient", &cells.drag_coefficient),
        ("the heat of the gas from particles", &species.heat),
        ("the energy of eddies from particles", &cells.eddies.energy),
        (
            "the dissipation of eddies from particles",
            &cells.eddies.dissipation,
        ),
        ("the growth of eddies by particles", &cells.eddies.growth),
    ]);
    let drag = || first_of(&[("the drag of particles", &cells.drag_source[..])]);
    let of_species = || {
        let found = first_of(&[
            ("the gas from particles", &species.source[..]),
            (
                "the coefficient of gas from particles",
                &species.coefficient,
            ),
            ("the gas that particles take", &species.taken),
        ])?;
        let each = species.source.len() / count;
        Some((found.0, found.1 / each.max(1), found.2))
    };
    of_cells.or_else(drag).or_else(of_species)
}

/// The first number of a gas that is not finite, or mass fraction that no gas can have.
pub(crate) fn broken_gas(
    gas: &GasFields<'_>,
    species: &[String],
    centre: &[Vec3],
) -> Option<Broken> {
    let cell = |cell: usize| NotFinitePlace::Cell {
        cell,
        centre: centre[cell],
    };
    let scalars = first_of(&[
        ("the temperature of the gas", gas.temperature),
        ("the pressure", gas.pressure),
        ("the density of the gas", gas.density),
        ("the turbulent energy", gas.turbulence.energy),
        ("the dissipation of turbulence", gas.turbulence.dissipation),
        ("the eddy viscosity", gas.turbulence.viscosity),
    ]);
    let vectors = || {
        first_of(&[
            ("the velocity of the gas", gas.velocity),
            ("the pressure gradient", gas.pressure_gradient),
        ])
    };
    if let Some((name, place, value)) = scalars.or_else(vectors) {
        return Some((name.to_owned(), cell(place), value));
    }
    let outside = || {
        let beyond = |one: &f64| *one < -OUTSIDE || *one > 1.0 + OUTSIDE;
        let place = gas.composition.par_iter().position_first(beyond)?;
        Some((place, gas.composition[place]))
    };
    let (place, value) = first_in(gas.composition).or_else(outside)?;
    let each = species.len().max(1);
    let name = species.get(place % each).map_or("", |name| name);
    Some((
        format!("the mass fraction of {name}"),
        cell(place / each),
        value,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_number_that_is_not_finite_is_found_in_its_list() {
        let mut values = vec![1.0; 3 * CHUNK];
        assert_eq!(first_in(&values), None);
        values[2 * CHUNK + 5] = f64::INFINITY;
        values[CHUNK + 7] = f64::NEG_INFINITY;
        assert_eq!(first_in(&values), Some((CHUNK + 7, f64::NEG_INFINITY)));
        let mut vectors = vec![Vec3::zeros(); 4];
        vectors[3].z = f64::NAN;
        let (name, place, value) = first_of(&[("a", &[][..]), ("b", &vectors)]).unwrap();
        assert!(name == "b" && place == 3 && value.is_nan());
    }

    #[test]
    fn a_mass_fraction_that_no_gas_can_have_is_found_and_traces_are_left() {
        let species = ["H2O", "N2"].map(String::from);
        let centre = [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0)];
        let found = |fraction: f64| {
            let gas = GasFields {
                temperature: &[300.0; 2],
                pressure: &[1e5; 2],
                density: &[1.0; 2],
                composition: &[0.5, 0.5, fraction, 1.0 - fraction],
                velocity: &[],
                pressure_gradient: &[],
                turbulence: Default::default(),
            };
            broken_gas(&gas, &species, &centre)
        };
        for trace in [0.2, -1e-7, -0.0999, 1.0999] {
            assert_eq!(found(trace), None);
        }
        for wrong in [-0.1001, 1.1001, f64::NAN] {
            let (name, place, value) = found(wrong).unwrap();
            assert_eq!(name, "the mass fraction of H2O");
            assert!(matches!(place, NotFinitePlace::Cell { cell: 1, .. }));
            assert!(value == wrong || wrong.is_nan());
        }
    }

    #[test]
    fn what_a_gas_is_told_of_species_is_found_with_its_cell() {
        let mut cells = CellExchange {
            heat_source: vec![0.0; 3],
            ..CellExchange::default()
        };
        cells.species.reset(3, 2);
        assert_eq!(told(&cells), None);
        cells.species.source[5] = f64::NAN;
        let (name, cell, value) = told(&cells).unwrap();
        assert!(name == "the gas from particles" && cell == 2 && value.is_nan());
    }
}
