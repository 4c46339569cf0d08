//! Which message carries a column.

use crate::record::MessageKind;

/// Which message carries a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnSet {
    /// `Start`, from the coordinator.
    Start,
    /// `State`, `Finished`, `Checkpointed`, from the solver.
    State,
    /// `Owned`, from a gas.
    Owned,
    /// `Committed`, from a gas that answers commits.
    Committed,
}

impl ColumnSet {
    /// The record that a kind of message carries, if it carries columns.
    pub fn of(kind: MessageKind) -> Option<ColumnSet> {
        match kind {
            MessageKind::Start => Some(ColumnSet::Start),
            MessageKind::State
            | MessageKind::Finished
            | MessageKind::Checkpointed
            | MessageKind::Changed => Some(ColumnSet::State),
            MessageKind::Owned => Some(ColumnSet::Owned),
            MessageKind::Committed => Some(ColumnSet::Committed),
            MessageKind::Hello
            | MessageKind::Commit
            | MessageKind::Checkpoint
            | MessageKind::Change
            | MessageKind::Boundary
            | MessageKind::Failed
            | MessageKind::Bye => None,
        }
    }

    /// Its name in a line of the catalogue.
    pub fn name(self) -> &'static str {
        match self {
            ColumnSet::Start => "start",
            ColumnSet::State => "state",
            ColumnSet::Owned => "owned",
            ColumnSet::Committed => "committed",
        }
    }
}
