//! Particles resolved along their radius: shells of enthalpy, solids and gas in pores (docs/theory.md, XDP-1 to XDP-18).
//!
//! A particle is a sphere of concentric shells that keep their solids while they shrink or swell. Heat is conducted between them, gases
//! diffuse (Fick, Knudsen) and flow by pressure (Darcy) through their pores, and reactions go by the temperature and the gas of each
//! shell. What gas and particle exchange passes the surface, a node of its own that stores nothing, at which film, contacts and
//! radiation meet. Gas that flows carries its enthalpy, all gases of the mixture flow, and what a reaction takes of a solid it makes of
//! gas: mass, elements and energy close in each particle by construction.
//!
//! Over a window a particle is followed with the gas about it held, as [`crate::Reacting`], and with what its contacts and views lead to
//! at its mean: heat from these follows the surface within the particle's own steps. What the exchange then books otherwise
//! than the particle said is owed to it: gas with the next window's flow, heat at its surface.

mod attempt;
mod book;
mod columns;
mod equations;
mod grid;
mod instant;
pub mod material;
mod model;
mod onwards;
mod physics;
mod rates;
mod react;
mod resolve;
mod side_by_side;
mod stage;
mod state;
mod step_error;
mod transport;
mod workspace;

pub use attempt::RadialStalled;
pub use grid::{ShellGrading, ShellGrid, node_of_shell};
pub use material::{PoreGas, PorousSolid, RadialNumerics, ShellResolution, StandingGas};
pub use physics::RadialError;

use self::physics::RadialPhysics;
use self::state::{RowLayout, TellLayout};
use crate::column::StateColumn;
use crate::model::Channel;
use crate::reacting::SolidChemistry;

/// Particles of one material with shells.
#[derive(Debug)]
pub struct Radial {
    physics: RadialPhysics,
    columns: Vec<StateColumn>,
    channels: Vec<Channel>,
    /// Amounts in mol of each solid in a kilogram as it comes in.
    composition: Vec<f64>,
    /// Share of its first mass below which a particle is used up.
    used_up: f64,
    layout: RowLayout,
    tell: TellLayout,
    /// Rows of the last commit, and of the last attempt with what it said.
    committed: Vec<f64>,
    attempt: Vec<f64>,
    /// Particles that got their shells since the last commit, with the rows that they had.
    resolved: Vec<(usize, Vec<f64>)>,
    /// True where this window has an attempt, and the span in s of the last one.
    tried: bool,
    /// True where the last attempt followed what surfaces are beside.
    follows_network: bool,
    last_span: f64,
    bodies: [RadialBodies; 2],
    /// Steps and shells times steps of all attempts, those that went by the end of a step alone, and rounds of Newton's method.
    work: [u64; 4],
}

/// What others see of the particles.
#[derive(Clone, Debug, Default)]
struct RadialBodies {
    temperature: Vec<f64>,
    mass: Vec<f64>,
    radius: Vec<f64>,
}

impl Radial {
    /// No particles yet, of a material that is at first made of these mass fractions of the chemistry's solids.
    pub fn new(
        chemistry: SolidChemistry,
        fractions: &[f64],
        solid: PorousSolid,
        pores: PoreGas,
        numerics: RadialNumerics,
    ) -> Result<Self, RadialError> {
        let parts = chemistry.solids.iter().zip(fractions);
        let composition: Vec<f64> = parts
            .map(|(solid, share)| share / solid.molar_mass())
            .collect();
        let physics = RadialPhysics::new(chemistry, solid, pores, numerics)?;
        let shells = match numerics.resolution {
            ShellResolution::One => 1,
            _ => numerics.grid.shells,
        };
        let layout = RowLayout {
            shells,
            solids: physics.solids(),
            gases: physics.gases(),
        };
        Ok(Self {
            columns: columns::columns(&physics),
            channels: channels(&physics),
            tell: TellLayout {
                from: layout.width(),
                gases: layout.gases,
            },
            layout,
            physics,
            composition,
            used_up: 0.0,
            committed: Vec::new(),
            attempt: Vec::new(),
            resolved: Vec::new(),
            tried: false,
            follows_network: false,
            last_span: 0.0,
            bodies: Default::default(),
            work: [0; 4],
        })
    }

    /// The same particles, which are used up where no more than this share of their first mass is left.
    pub fn with_used_up(mut self, share: f64) -> Self {
        self.used_up = share;
        self
    }

    /// Bytes that a particle takes.
    pub fn bytes(&self) -> usize {
        let bodies = 6;
        8 * (self.layout.width() + self.tell.end() + self.channels.len() + bodies)
    }

    /// Steps of all attempts so far, shells times steps, and how many of these went by the end of a step alone, which keeps amounts
    /// positive and is of first order; rounds of Newton's method.
    pub fn work(&self) -> [u64; 4] {
        self.work
    }

    fn count(&self) -> usize {
        self.committed.len() / self.layout.width()
    }

    /// The committed row of a particle.
    fn row(&self, p: usize) -> &[f64] {
        let width = self.layout.width();
        &self.committed[p * width..(p + 1) * width]
    }

    /// The row of the last attempt, with what it said.
    fn attempted(&self, p: usize) -> &[f64] {
        let width = self.tell.end();
        &self.attempt[p * width..(p + 1) * width]
    }

    /// Number of shells that a row has.
    fn shells_of(&self, row: &[f64]) -> usize {
        row[self.layout.count()] as usize
    }
}

/// One channel a gas; the rate of the last, which is what the others leave, does not follow the gas.
fn channels(physics: &RadialPhysics) -> Vec<Channel> {
    let Some(gas) = &physics.chemistry.gas else {
        return Vec::new();
    };
    let count = gas.names().len();
    let one = |(k, name): (usize, &String)| {
        let mut mass = vec![0.0; count];
        mass[k] = physics.gas_mass[k];
        Channel {
            name: format!("{name} of pores"),
            key: (k + 1 < count).then_some(k),
            mass,
        }
    };
    gas.names().iter().enumerate().map(one).collect()
}

#[cfg(test)]
mod tests;
