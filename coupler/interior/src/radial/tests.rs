//! Particles with shells as a whole.

mod conservation;
mod limits;
mod support;
mod verification;
