//! Particles with shells as a whole.

mod conservation;
mod fast;
mod limits;
mod orders;
mod radiation;
mod steps;
mod support;
mod turning;
mod verification;
