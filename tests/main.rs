//! All tests of the whole, in one program, but for those with a command line of their own (`fuzz`, `validate`, `torture`,
//! `faults_random`) and those that ask how soon processes end (`faults`).

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod agreement;
mod architecture;
mod beds;
mod burn_out;
mod case_files;
mod check_and_run;
mod command_line;
mod conform;
mod contacts_agree;
mod continuation;
mod docs;
mod drag_ripple;
mod external_gas;
mod external_mistakes;
mod external_particles;
mod films;
mod findings;
mod frank_kamenetskii;
mod heat_paths;
mod heated_column;
mod held_and_free;
mod held_bed;
mod installed_interface;
mod laws;
mod liggghts_script;
mod measures;
mod momentum_models;
mod moving_beds;
mod moving_heat;
mod moving_native;
mod moving_pairings;
mod moving_reactions;
mod moving_single;
mod openfoam_models;
mod reactions;
mod readers;
mod results;
mod results_pages;
mod resume;
mod resume_facets;
mod resume_ranks;
mod schema;
mod second_model;
mod self_heating;
mod shipped_cases;
mod simulation;
mod stock_solver;
mod support;
mod test_programs;
mod time_splitting;
mod verification_beds;
mod weights;
mod window_drag;
