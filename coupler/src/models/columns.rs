//! Columns of all models by their names, for checkpoints and results.

use calcine_interior::{ColumnKind, ColumnShape, ColumnValues, ModelError, Ragged, StateColumn};

use super::ParticleModels;
use super::error::{ParticleModelError, RestoreError, named};
use super::merged_column::MergedColumn;
use crate::checkpoint::StateFile;

/// A column of all particles; rows of particles whose model lacks it are empty.
#[derive(Clone, Debug, PartialEq)]
pub struct ParticleColumn {
    /// What it is.
    pub column: StateColumn,
    /// The committed values.
    pub values: Ragged,
}

impl ParticleColumn {
    /// One number a particle, NaN for one whose model lacks the column; counts are rounded to the nearest number.
    /// `None` for a ragged column.
    pub fn scalars(&self) -> Option<Vec<f64>> {
        (self.column.shape == ColumnShape::Scalar).then(|| self.nth(0))
    }

    /// The value of each particle at a place in its row, NaN where the row is shorter.
    pub fn nth(&self, place: usize) -> Vec<f64> {
        (0..self.values.rows())
            .map(|row| match self.values.kind() {
                ColumnKind::Real => self.values.reals(row).get(place).copied(),
                ColumnKind::Count => self.values.counts(row).get(place).map(|&n| n as f64),
            })
            .map(|value| value.unwrap_or(f64::NAN))
            .collect()
    }
}

/// Names of the arrays of a column in a state file: the values, and how many each particle has.
fn arrays(column: &StateColumn) -> [String; 2] {
    let name = format!("inside.{}", column.name);
    let lengths = format!("{name}.lengths");
    [name, lengths]
}

/// The solids whose amounts stand in arrays of these names, in alphabetical order.
pub(crate) fn amounts<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let solids = names.filter_map(|name| name.strip_prefix("inside.amount."));
    let mut solids: Vec<String> = solids
        .filter(|name| !name.ends_with(".lengths"))
        .map(str::to_owned)
        .collect();
    solids.sort();
    solids
}

impl ParticleModels {
    /// Solids that the particles are made of, by name.
    pub(crate) fn amounts(&self) -> Vec<String> {
        let states = self.columns.iter().filter(|one| one.column.is_state());
        let names: Vec<String> = states
            .map(|one| format!("inside.{}", one.column.name))
            .collect();
        amounts(names.iter().map(String::as_str))
    }

    /// Columns of all models.
    pub fn columns(&self) -> impl Iterator<Item = &StateColumn> {
        self.columns.iter().map(|one| &one.column)
    }

    /// The committed values of a column by its name.
    pub fn column(&self, name: &str) -> Option<ParticleColumn> {
        let found = self.columns.iter().find(|one| one.column.name == name)?;
        Some(self.gathered_column(found))
    }

    /// Columns that are part of the results and of this group, or of any for an empty name.
    pub fn shown(&self, group: &str) -> Vec<ParticleColumn> {
        let wanted = |one: &&MergedColumn| {
            one.column.is_shown() && (group.is_empty() || one.column.group == group)
        };
        let found = self.columns.iter().filter(wanted);
        found.map(|one| self.gathered_column(one)).collect()
    }

    /// The column of a name, be it part of the results or not; none where no model has it.
    pub fn named(&self, name: &str) -> Option<ParticleColumn> {
        let found = self.columns.iter().find(|one| one.column.name == name);
        found.map(|one| self.gathered_column(one))
    }

    fn gathered_column(&self, of: &MergedColumn) -> ParticleColumn {
        let kind = of.column.kind;
        let own: Vec<Option<Ragged>> = self
            .members
            .iter()
            .zip(&of.place)
            .map(|(member, place)| {
                place.map(|place| {
                    let mut out = Ragged::new(kind);
                    member.model.read(place, &mut out);
                    out
                })
            })
            .collect();
        let mut values = Ragged::new(kind);
        for &(model, place) in &self.places {
            match own.get(model) {
                Some(Some(column)) if place < column.rows() => values.push_row(column, place),
                _ => values.push_reals(&[]),
            }
        }
        ParticleColumn {
            column: of.column.clone(),
            values,
        }
    }

    /// Writes the state of all particles.
    pub fn record(&self, state: &mut StateFile) {
        for one in self.columns.iter().filter(|one| one.column.is_state()) {
            let ParticleColumn { column, values } = self.gathered_column(one);
            let [name, lengths] = arrays(&column);
            match values.values() {
                ColumnValues::Real(list) => state.set_f64s(&name, list),
                ColumnValues::Count(list) => state.set_u64s(&name, list),
            }
            if !values.lengths().all(|length| length == 1) {
                let list: Vec<u64> = values.lengths().map(|length| length as u64).collect();
                state.set_u64s(&lengths, &list);
            }
        }
    }

    /// Takes up the state of all particles, which must be those that the models have, by the names of columns.
    pub fn restore(&mut self, state: &StateFile) -> Result<(), RestoreError> {
        let count = self.places.len();
        let mut columns = Vec::new();
        for one in &self.columns {
            columns.push(match one.column.is_state() {
                true => Some(read(&one.column, count, state)?),
                false => None,
            });
        }
        for (k, member) in self.members.iter_mut().enumerate() {
            let own: Vec<Ragged> = member
                .model
                .columns()
                .iter()
                .enumerate()
                .map(|(place, column)| {
                    let merged = self
                        .columns
                        .iter()
                        .position(|one| one.place[k] == Some(place));
                    let mut own = Ragged::new(column.kind);
                    if let Some(Some(from)) = merged.and_then(|at| columns.get(at)) {
                        member.rows.iter().for_each(|row| own.push_row(from, *row));
                    }
                    own
                })
                .collect();
            let done = member.model.load(&own);
            done.map_err(|cause| named(cause, &member.rows, &self.id))?;
        }
        self.note_temperatures();
        Ok(())
    }
}

/// The rows of a column.
fn read(column: &StateColumn, count: usize, state: &StateFile) -> Result<Ragged, RestoreError> {
    let [name, lengths] = arrays(column);
    let values = match column.kind {
        ColumnKind::Real => ColumnValues::Real(state.f64s(&name)?.to_vec()),
        ColumnKind::Count => ColumnValues::Count(state.u64s(&name)?.to_vec()),
    };
    let lengths: Vec<usize> = match state.u64s(&lengths) {
        Ok(list) => list
            .iter()
            .map(|&length| usize::try_from(length).unwrap_or(usize::MAX))
            .collect(),
        Err(_) => vec![1; count],
    };
    let found = lengths.len();
    let rows = Ragged::from_lengths(&lengths, values).filter(|rows| rows.rows() == count);
    rows.ok_or_else(|| {
        let cause = ModelError::Column {
            column: column.name.clone(),
            found: format!("values of {found} particles, or not as many as they say"),
            expected: format!("those of {count} particles"),
        };
        ParticleModelError::Column(cause).into()
    })
}
