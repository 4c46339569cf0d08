//! External solvers as parts of a run: OpenFOAM for the gas, LIGGGHTS for the particles.
//!
//! [`launch`] starts and ends processes, [`solver`] speaks with them; an adapter only says what its
//! columns mean.

pub mod launch;
pub mod liggghts;
pub mod openfoam;
pub mod solver;
