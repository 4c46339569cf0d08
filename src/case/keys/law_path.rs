//! Where laws of a family declare a key.

use calcine_coupler::physics::law::LawSummary;

use crate::laws::LawCatalogue;

/// A family of laws.
pub type LawFamily = fn(&LawCatalogue) -> Vec<LawSummary>;

/// How deep the tables of a law lie in each other at most.
const DEEPEST: usize = 4;

/// Where a law declares a key: the tables in which it stands, and its name.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LawPath {
    names: [&'static str; DEEPEST],
    length: usize,
}

impl LawPath {
    /// A key of the table at this path; `None` where it lies deeper than any may.
    pub(super) fn with(mut self, name: &'static str) -> Option<Self> {
        *self.names.get_mut(self.length)? = name;
        self.length += 1;
        Some(self)
    }

    /// The names in it.
    pub(super) fn names(&self) -> &[&'static str] {
        &self.names[..self.length]
    }
}
