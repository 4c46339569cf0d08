//! What `calcine tune` is told, of a model and of a plant alike.

use std::path::Path;

/// What one tuning needs.
pub(super) struct Tuning<'a> {
    /// The case file.
    pub case: &'a Path,
    /// Changes of its keys.
    pub set: &'a [String],
    /// The results folder, where one is named.
    pub out: Option<&'a Path>,
    /// Goes on with a tuning in it.
    pub resume: bool,
    /// Tells nothing while it runs.
    pub quiet: bool,
}
