//! The trait behind which particles are thermally thin or resolved along the radius.

use crate::network::{Neighbours, NetworkSurroundings};
use crate::reacting::Reacting;

/// A particle that comes in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Newcomer {
    /// Its mass in kg.
    pub mass: f64,
    /// Index of its material.
    pub material: usize,
    /// Its temperature in K.
    pub temperature: f64,
}

/// Inside of all particles. An attempt always starts from the last commit.
pub trait ParticleModel: Send {
    /// Surface temperature of each particle in K after the last attempt.
    fn temperature(&self) -> &[f64];

    /// Surface temperature of each particle in K at the last commit.
    fn committed_temperature(&self) -> &[f64];

    /// The particles as ones that react; `None` where none does.
    fn reacting(&mut self) -> Option<&mut Reacting> {
        None
    }

    /// The same to look at.
    fn reactions(&self) -> Option<&Reacting> {
        None
    }

    /// True where particles exchange heat with each other and with walls, so that `set_neighbours` and `conduct` matter.
    fn conducts(&self) -> bool;

    /// Takes up which particles and walls meet at the present places.
    fn set_neighbours(&mut self, neighbours: &Neighbours<'_>);

    /// Fixes the heat that particles exchange with each other and with walls in the coming attempt: that
    /// of an implicit step over a process span in s in which each particle also exchanges heat with the
    /// gas beside it.
    fn conduct(&mut self, surroundings: &NetworkSurroundings<'_>, span: f64);

    /// Heat in W that each reservoir, a wall or the surroundings, gives to the particles in the attempt.
    fn reservoir_heat(&self) -> &[f64];

    /// Temperature in K of each particle from which the exchange with the gas starts: the committed
    /// one, moved by what the particles conduct and radiate over the span.
    fn start_temperature(&self) -> &[f64];

    /// Conductances with the particles' own new temperatures eliminated (requirements TSM-9):
    /// from h A in W/K over a process span in s to K, such that K (T_gas − T_start) is the
    /// heat flow of the implicit step.
    fn eliminated(&self, conductance: &[f64], span: f64, out: &mut [f64]);

    /// One attempt over a process span in s, with the mean heat flow from the gas into each particle in
    /// W; what the particles exchange with each other and with walls is added.
    fn advance(&mut self, heat: &[f64], span: f64);

    /// Takes the last attempt as the new start.
    fn commit(&mut self);

    /// Energy stored by the last attempt in J: the sum over particles, and the sum of magnitudes.
    fn stored_change(&self) -> (f64, f64);

    /// Takes particles out, by their rows in ascending order, and appends new ones; after a commit.
    fn change(&mut self, gone: &[usize], new: &[Newcomer]);

    /// Enthalpy of each particle at its committed temperature in J, from 0 K of its heat capacity's law on.
    fn enthalpy(&self, row: usize) -> f64;

    /// Takes up temperatures in K from a checkpoint, as committed.
    fn restore(&mut self, temperature: &[f64]);
}
