//! Tests of the crate from outside.

#![allow(clippy::unwrap_used)]

mod fronts;
mod kinetics;
mod lumped;
mod twin;
