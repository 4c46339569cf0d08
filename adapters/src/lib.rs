//! External solvers as parts of a run: OpenFOAM for the gas, LIGGGHTS for the particles, and those of users.
//!
//! [`launch`] starts and ends processes, [`solver`] speaks with them; an adapter only says what its
//! columns mean.

pub mod answer;
mod checkpoint;
pub mod external;
pub mod find;
pub mod gas;
mod gas_columns;
pub mod last_words;
pub mod launch;
pub mod liggghts;
pub mod openfoam;
pub mod particles;
pub mod solver;
