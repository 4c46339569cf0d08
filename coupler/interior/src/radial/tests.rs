//! What particles with shells are as a whole. Exact solutions are in `verification.rs`.

mod conservation;
mod support;
mod verification;
