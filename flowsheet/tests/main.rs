//! Tests of plants from outside.
#![allow(missing_docs, clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

mod controllers;
mod coupled_beds;
mod dyssol;
mod dyssol_units;
mod granulation;
mod growth;
mod kernels;
mod loops;
mod methods;
mod oscillation;
mod plants;
mod sensitivities;
mod support;
mod units;
