//! The coordinator of Calcine: three parts, two clocks, one loop.

pub mod boundary_value;
pub mod checkpoint;
pub mod closures;
pub mod conformance;
pub mod contacts;
pub mod coordinator;
pub mod error;
pub mod exchange;
pub mod excursion;
pub mod feeds;
pub mod findings;
pub mod gas_chemistry;
pub mod held;
pub mod hold;
pub mod ledger;
pub mod mapping;
pub mod mesh;
pub mod models;
pub mod momentum_model;
pub mod motion;
pub mod named_columns;
pub mod observer;
pub mod packing;
pub mod part;
pub mod paths;
pub mod setup;
pub mod smoother;
pub mod species_coupling;
pub mod supervisor;
pub mod time;
pub mod turbulence;
pub mod view_factors;
pub mod window_drag;

pub use calcine_interior as interior;
pub use calcine_numerics as numerics;
pub use calcine_physics as physics;
