//! All tests of the adapters from outside, in one program, but for those that look at what their whole process has
//! left behind (`liggghts.rs`).

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod conformance;
mod last_words;
mod liggghts_moving;
mod liggghts_periodic;
mod liggghts_ranks;
mod liggghts_support;
mod manufactured;
mod openfoam_burner;
mod openfoam_flame;
mod openfoam_flow;
mod openfoam_inlets;
mod openfoam_life;
mod openfoam_openings;
mod openfoam_parcels;
mod openfoam_pasr;
mod openfoam_periodic;
mod openfoam_ranks;
mod openfoam_stirred_cells;
mod openfoam_support;
mod openfoam_templates;
mod openfoam_trials;
mod openfoam_turning_walls;
