//! Tests of the crate from outside.

#![allow(clippy::unwrap_used)]

mod fronts;
mod grains;
mod kinetics;
mod lumped;
mod shipped;
mod twin;
