//! All tests of the wire from outside, in one program.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[macro_use]
mod laws;

mod c_abi;
mod conformance;
