//! A run as it is read.

use std::path::PathBuf;

use crate::results::Summary;
use crate::results::read::Series;

/// A run as read.
pub(super) struct Source {
    pub(super) name: String,
    pub(super) directory: PathBuf,
    pub(super) summary: Summary,
    pub(super) series: Series,
}
