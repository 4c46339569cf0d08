//! What units tell others.

/// What units tell others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SignalKind {
    /// A table of a kernel: diameters in m, then a rate for each pair of them, row by row.
    Kernel,
    /// A number.
    Setting,
}

impl std::fmt::Display for SignalKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Kernel => "a kernel",
            Self::Setting => "a setting",
        })
    }
}
