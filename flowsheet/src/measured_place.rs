//! Where something is measured.

/// Where something is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MeasuredPlace {
    /// Stream of this name.
    Stream(String),
    /// Content of the unit of this name.
    Unit(String),
}
