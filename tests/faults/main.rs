//! Faults of coupled runs, in a program of their own: what they ask is how soon processes end, and no other test
//! shall run beside them.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/processes.rs"]
mod processes;

mod deaths;
mod kinds;
mod ranks;
