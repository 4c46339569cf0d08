//! What happens inside and between particles.

mod model;
mod network;
pub mod reacting;
mod thin;

pub use model::{Newcomer, ParticleModel};
pub use network::{
    ExchangeAreas, HeatLaws, HeatNetwork, NeighbourPair, NeighbourWall, Neighbours,
    NetworkSurroundings, ThermalProperties,
};
pub use reacting::Reacting;
pub use thin::Thin;

/// Takes rows, in ascending order, out of a list; the others keep their order.
pub fn without<T>(list: &mut Vec<T>, gone: &[usize]) {
    let (mut row, mut next) = (0, 0);
    list.retain(|_| {
        let goes = gone.get(next) == Some(&row);
        next += usize::from(goes);
        row += 1;
        !goes
    });
}
