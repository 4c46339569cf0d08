//! Tuning of models to curves: `calcine tune`.

pub mod case;
pub mod curves;
pub mod outcome;
pub mod page;
pub mod tune;
pub(crate) mod warn;
pub mod write;
