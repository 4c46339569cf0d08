//! What several files of tests share. Test programs of their own take single files of it by their path.

pub mod blocks;
pub mod c_solver;
#[cfg(feature = "hdf5")]
pub mod checkpoint_harm;
pub mod column;
pub mod fake;
#[cfg(feature = "hdf5")]
pub mod fluidised;
pub mod hopper;
#[cfg(feature = "hdf5")]
pub mod killed;
pub mod lattice;
pub mod moving;
pub mod program;
#[cfg(feature = "hdf5")]
pub mod results_equal;
pub mod schiller_naumann;
pub mod schumann;
#[cfg(feature = "hdf5")]
pub mod stopped;
