//! Case files: TOML to a checked [`model::Case`].

pub mod model;
