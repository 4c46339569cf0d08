//! What happens inside and between particles.

mod column;
mod error;
mod model;
mod network;
mod prescribed;
pub mod radial;
pub mod reacting;
mod thin;

pub use column::{ColumnKind, ColumnRole, ColumnShape, ColumnValues, Ragged, StateColumn};
pub use error::ModelError;
pub use model::{
    At, Bodies, Channel, GasLines, Inventory, NetworkHeat, Newcomer, ParticleModel, SurfaceLine,
    SurfaceMean, SurfaceNetwork, Surroundings, Tally, Transfer,
};
pub use network::{
    ExchangeAreas, HeatLaws, HeatNetwork, NeighbourPair, NeighbourWall, Neighbours, NetworkBodies,
    NetworkOutcome, NetworkSurroundings, RowImbalance, ThermalProperties,
};
pub use prescribed::PrescribedTemperature;
pub use radial::Radial;
pub use reacting::Reacting;
pub use thin::{TEMPERATURE, Thin};

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
