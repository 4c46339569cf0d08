//! Errors of parts: who, in which window, what kind, the end of its log, and the cause.

use std::fmt;

use thiserror::Error;

use crate::time::Window;

/// What kind of failure a part met; decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// The solver's solution left what is physical.
    Diverged,
    /// The solver produced a number that is not finite.
    NotFinite,
    /// An iteration of the solver ended at its limit, and it does not go on with that.
    NotConverged,
    /// Particles left the space in which they may be.
    LostParticles,
    /// What the solver was told is outside its range, or its own inputs are wrong.
    InvalidInput,
    /// There was too little memory.
    OutOfMemory,
    /// Its process ended, with the status as words ("signal 9 (SIGKILL)", "exit code 1").
    Died,
    /// It did not answer within the deadline.
    Silent,
    /// It could not be started or its handshake failed.
    NotStarted,
    /// It answered something that the protocol does not allow.
    Protocol,
    /// It reported an error of its own.
    Reported,
    /// A file could not be read or written.
    Io,
    /// It was asked for something that it cannot do.
    Refused,
    /// The user interrupted the run.
    Interrupted,
}

impl FailureKind {
    /// True where the solver itself said what went wrong, before it ended.
    pub fn is_reported(self) -> bool {
        match self {
            Self::Diverged
            | Self::NotFinite
            | Self::NotConverged
            | Self::LostParticles
            | Self::InvalidInput
            | Self::Refused
            | Self::OutOfMemory
            | Self::Reported
            | Self::Io => true,
            Self::Died | Self::Silent | Self::NotStarted | Self::Protocol | Self::Interrupted => {
                false
            }
        }
    }
}

/// The failure of one part.
#[derive(Debug, Error)]
pub struct PartError {
    /// Who failed, for example "OpenFOAM (gas, rank 0, pid 4711)".
    pub who: String,
    /// In which window; `None` outside windows.
    pub window: Option<Window>,
    /// Which kind of failure.
    pub kind: FailureKind,
    /// What happened, one sentence with figures.
    pub message: String,
    /// What of mesh and flow may be behind it, in sentences of their own; empty where nothing is known.
    pub circumstances: Vec<String>,
    /// The last lines of the part's log; empty for native parts.
    pub log_end: Vec<String>,
    /// The cause, if another error lies below.
    #[source]
    pub cause: Option<Box<dyn std::error::Error + Send + Sync>>,
}

impl PartError {
    /// A failure without log or cause.
    pub fn new(who: impl Into<String>, kind: FailureKind, message: impl Into<String>) -> Self {
        Self {
            who: who.into(),
            window: None,
            kind,
            message: message.into(),
            circumstances: Vec::new(),
            log_end: Vec::new(),
            cause: None,
        }
    }

    /// The same, in a window.
    pub fn in_window(mut self, window: &Window) -> Self {
        self.window = Some(*window);
        self
    }

    /// The same, with what of mesh and flow may be behind it.
    pub fn under(mut self, circumstances: Vec<String>) -> Self {
        self.circumstances = circumstances;
        self
    }

    /// The same, with the error that caused it.
    pub fn caused_by(mut self, cause: impl std::error::Error + Send + Sync + 'static) -> Self {
        self.cause = Some(Box::new(cause));
        self
    }

    /// The same, with the end of the part's log.
    pub fn with_log(mut self, lines: Vec<String>) -> Self {
        self.log_end = lines;
        self
    }
}

impl fmt::Display for PartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.who, self.message)?;
        if let Some(window) = &self.window {
            write!(
                f,
                " (window {}, attempt {}, process time {}, motion time {})",
                window.index, window.attempt, window.start.process, window.start.motion
            )?;
        }
        for line in &self.circumstances {
            write!(f, "\n  {line}")?;
        }
        if !self.log_end.is_empty() {
            write!(f, "\nthe end of its log:")?;
            for line in &self.log_end {
                write!(f, "\n  | {line}")?;
            }
        }
        Ok(())
    }
}
