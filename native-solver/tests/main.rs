//! All tests of the native solvers from outside, in one program.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod boxes;
mod burner;
mod column;
mod common;
mod conformance;
mod dem_beds;
mod dem_chute;
mod dem_drag;
mod dem_impacts;
mod dem_momentum;
mod dem_periodic;
mod dem_restart;
mod dem_servo;
mod dem_single;
mod dem_walls;
mod flame;
mod grains;
mod inlets;
mod manufactured;
mod multigrid;
mod numerics;
mod openings;
mod parcel_beds;
mod parcel_fluidised;
mod parcel_friction;
mod parcel_packing;
mod parcel_resistance;
mod parcel_tracking;
mod planted;
mod resume;
mod short_windows;
mod skewed;
mod species;
mod step_errors;
mod stirred;
mod stirred_cells;
mod time_order;
mod turning_walls;
mod verification_bed_eddies;
mod verification_flow;
mod verification_heat;
mod verification_periodic;
mod verification_porous;
mod verification_turbulence;
