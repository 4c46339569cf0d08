//! The coordinator of Calcine: three parts, two clocks, one loop.

pub mod error;
pub mod ledger;
pub mod mesh;
pub mod observer;
pub mod part;
pub mod setup;
pub mod supervisor;
pub mod time;

pub use calcine_interior as interior;
pub use calcine_physics as physics;
