//! All tests of the coupler from outside, in one program.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bed_eddies;
mod cylinder;
mod exchange;
mod mapping;
mod mesh;
mod packing;
mod refine;
mod smoother;
mod smoother_periodic;
mod smoother_refusals;
mod smoother_tall;
mod species_coupling;
