//! Kinds of failure that a solver reports with its last message.

/// Why a solver cannot go on; `calcine_failure` in C.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u32)]
pub enum SolverFailure {
    /// None of the others; the text says what.
    #[default]
    Other = 0,
    /// The solution left what is physical: a negative temperature, a speed without bound.
    Diverged = 1,
    /// An iteration ended at its limit above its tolerance, and the solver does not go on with that.
    NotConverged = 2,
    /// What the solver was told is outside its range, or its own inputs are wrong.
    InvalidInput = 3,
    /// Particles left the space in which they may be.
    LostParticles = 4,
    /// There is too little memory.
    OutOfMemory = 5,
    /// A value is not finite.
    NotFinite = 6,
    /// A file cannot be read or written.
    File = 7,
    /// The request, or a column, is none that this solver serves.
    Unsupported = 8,
}

impl SolverFailure {
    /// All kinds.
    pub const ALL: [SolverFailure; 9] = [
        SolverFailure::Other,
        SolverFailure::Diverged,
        SolverFailure::NotConverged,
        SolverFailure::InvalidInput,
        SolverFailure::LostParticles,
        SolverFailure::OutOfMemory,
        SolverFailure::NotFinite,
        SolverFailure::File,
        SolverFailure::Unsupported,
    ];

    /// The kind of a number on the wire; numbers of other versions are [`SolverFailure::Other`].
    pub fn from_number(number: u64) -> Self {
        let same = |kind: &SolverFailure| *kind as u64 == number;
        Self::ALL.into_iter().find(same).unwrap_or_default()
    }

    /// Its name in C behind `CALCINE_FAILURE_`, and what it means.
    pub fn about(self) -> (&'static str, &'static str) {
        match self {
            SolverFailure::Other => ("OTHER", "none of the others"),
            SolverFailure::Diverged => ("DIVERGED", "the solution left what is physical"),
            SolverFailure::NotConverged => (
                "NOT_CONVERGED",
                "an iteration ended at its limit, above its tolerance",
            ),
            SolverFailure::InvalidInput => (
                "INPUT",
                "what the solver was told, or its own inputs, are outside its range",
            ),
            SolverFailure::LostParticles => (
                "LOST_PARTICLES",
                "particles left the space in which they may be",
            ),
            SolverFailure::OutOfMemory => ("MEMORY", "too little memory"),
            SolverFailure::NotFinite => ("NOT_FINITE", "a value is not finite"),
            SolverFailure::File => ("FILE", "a file cannot be read or written"),
            SolverFailure::Unsupported => (
                "UNSUPPORTED",
                "a request or a column that this solver does not serve",
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_survives_its_number_and_an_unknown_one_is_other() {
        for kind in SolverFailure::ALL {
            assert_eq!(SolverFailure::from_number(kind as u64), kind);
        }
        assert_eq!(SolverFailure::from_number(99), SolverFailure::Other);
    }
}
