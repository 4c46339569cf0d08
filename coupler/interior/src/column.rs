//! Columns of state: what the coordinator, its checkpoints and its outputs know of a model of particles.

use crate::error::ModelError;
use crate::without;

/// Of what a column's values are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// `f64`.
    Real,
    /// `u64`.
    Count,
}

/// How many values a particle has in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnShape {
    /// One.
    Scalar,
    /// Any number, which may differ from particle to particle and change.
    Ragged,
}

/// Who reads and writes a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnRole {
    /// State: checkpointed, loaded and part of the results.
    Shown,
    /// State that is checkpointed and loaded, but not part of the results.
    Private,
    /// Follows from the state: part of the results, neither checkpointed nor loaded.
    Derived,
}

/// A column of a model's state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StateColumn {
    /// Its name, by which checkpoints and results have it; unique within a model. Models of one run that give the same
    /// name to a column agree in all else but its role.
    pub name: String,
    /// Unit, `1` for pure numbers.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub description: String,
    /// Type of its values.
    pub kind: ColumnKind,
    /// One value a particle, or any number.
    pub shape: ColumnShape,
    /// Who reads and writes it.
    pub role: ColumnRole,
    /// Name by which outputs ask for several columns at once, `solids` for example; empty for none.
    pub group: &'static str,
}

impl StateColumn {
    /// A column of one real number a particle that is part of the results.
    pub fn shown(name: &str, unit: &'static str, description: &str) -> Self {
        Self {
            name: name.to_owned(),
            unit,
            description: description.to_owned(),
            kind: ColumnKind::Real,
            shape: ColumnShape::Scalar,
            role: ColumnRole::Shown,
            group: "",
        }
    }

    /// The same column in another role.
    pub fn with_role(self, role: ColumnRole) -> Self {
        Self { role, ..self }
    }

    /// The same column with any number of values a particle.
    pub fn ragged(self) -> Self {
        let shape = ColumnShape::Ragged;
        Self { shape, ..self }
    }

    /// The same column of whole numbers.
    pub fn counts(self) -> Self {
        let kind = ColumnKind::Count;
        Self { kind, ..self }
    }

    /// The same column as a member of a group.
    pub fn in_group(self, group: &'static str) -> Self {
        Self { group, ..self }
    }

    /// True where it is part of a checkpoint.
    pub fn is_state(&self) -> bool {
        self.role != ColumnRole::Derived
    }

    /// True where it is part of the results.
    pub fn is_shown(&self) -> bool {
        self.role != ColumnRole::Private
    }
}

/// Values of a column of either type.
#[derive(Clone, Debug, PartialEq)]
pub enum ColumnValues {
    /// Of [`ColumnKind::Real`].
    Real(Vec<f64>),
    /// Of [`ColumnKind::Count`].
    Count(Vec<u64>),
}

/// Rows of any number of values each, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct Ragged {
    /// Where each row begins, and the end of the last one.
    offsets: Vec<usize>,
    values: ColumnValues,
}

impl Ragged {
    /// No rows yet.
    pub fn new(kind: ColumnKind) -> Self {
        Self {
            offsets: vec![0],
            values: match kind {
                ColumnKind::Real => ColumnValues::Real(Vec::new()),
                ColumnKind::Count => ColumnValues::Count(Vec::new()),
            },
        }
    }

    /// One real number a row.
    pub fn scalars(values: Vec<f64>) -> Self {
        Self {
            offsets: (0..=values.len()).collect(),
            values: ColumnValues::Real(values),
        }
    }

    /// Rows of these lengths out of all values one after the other; `None` where their sum is not that of the values.
    pub fn from_lengths(lengths: &[usize], values: ColumnValues) -> Option<Self> {
        let mut offsets = Vec::with_capacity(lengths.len() + 1);
        let mut end = 0usize;
        offsets.push(end);
        for length in lengths {
            end = end.checked_add(*length)?;
            offsets.push(end);
        }
        let made = Self { offsets, values };
        (made.len() == end).then_some(made)
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Number of all values.
    pub fn len(&self) -> usize {
        match &self.values {
            ColumnValues::Real(list) => list.len(),
            ColumnValues::Count(list) => list.len(),
        }
    }

    /// True where there is no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Type of the values.
    pub fn kind(&self) -> ColumnKind {
        match self.values {
            ColumnValues::Real(_) => ColumnKind::Real,
            ColumnValues::Count(_) => ColumnKind::Count,
        }
    }

    /// All values, row after row.
    pub fn values(&self) -> &ColumnValues {
        &self.values
    }

    /// Number of values of each row.
    pub fn lengths(&self) -> impl Iterator<Item = usize> {
        self.offsets.windows(2).map(|ends| ends[1] - ends[0])
    }

    /// The real numbers of a row; none where the values are counts.
    pub fn reals(&self, row: usize) -> &[f64] {
        match &self.values {
            ColumnValues::Real(list) => &list[self.offsets[row]..self.offsets[row + 1]],
            ColumnValues::Count(_) => &[],
        }
    }

    /// The counts of a row; none where the values are real numbers.
    pub fn counts(&self, row: usize) -> &[u64] {
        match &self.values {
            ColumnValues::Count(list) => &list[self.offsets[row]..self.offsets[row + 1]],
            ColumnValues::Real(_) => &[],
        }
    }

    /// Empties it for values of a type.
    pub fn reset(&mut self, kind: ColumnKind) {
        *self = Self::new(kind);
    }

    /// Appends a row of real numbers; of none where the values are counts.
    pub fn push_reals(&mut self, row: &[f64]) {
        if let ColumnValues::Real(list) = &mut self.values {
            list.extend_from_slice(row);
        }
        self.offsets.push(self.len());
    }

    /// Appends a row of counts; of none where the values are real numbers.
    pub fn push_counts(&mut self, row: &[u64]) {
        if let ColumnValues::Count(list) = &mut self.values {
            list.extend_from_slice(row);
        }
        self.offsets.push(self.len());
    }

    /// Appends a row of another column of the same type.
    pub fn push_row(&mut self, of: &Self, row: usize) {
        match of.kind() {
            ColumnKind::Real => self.push_reals(of.reals(row)),
            ColumnKind::Count => self.push_counts(of.counts(row)),
        }
    }

    /// Takes rows out, in ascending order; the others keep their order.
    pub fn remove(&mut self, gone: &[usize]) {
        let ends = &self.offsets;
        let places: Vec<usize> = gone
            .iter()
            .flat_map(|&row| ends[row]..ends[row + 1])
            .collect();
        match &mut self.values {
            ColumnValues::Real(list) => without(list, &places),
            ColumnValues::Count(list) => without(list, &places),
        }
        let mut lengths: Vec<usize> = self.lengths().collect();
        without(&mut lengths, gone);
        let mut end = 0;
        self.offsets.clear();
        self.offsets.push(end);
        for length in lengths {
            end += length;
            self.offsets.push(end);
        }
    }

    /// One real number of each of so many rows, or an error that names the column.
    pub fn to_scalars(&self, column: &str, rows: usize) -> Result<&[f64], ModelError> {
        let wrong = |found: String| ModelError::Column {
            column: column.to_owned(),
            found,
            expected: format!("one real number for each of {rows} particles"),
        };
        match &self.values {
            ColumnValues::Real(list) if list.len() == rows && self.lengths().all(|n| n == 1) => {
                Ok(list)
            }
            ColumnValues::Real(list) => Err(wrong(format!(
                "{} values in {} rows",
                list.len(),
                self.rows()
            ))),
            ColumnValues::Count(_) => Err(wrong("whole numbers".to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_keep_their_values_when_others_go() {
        let mut column = Ragged::new(ColumnKind::Count);
        for row in [&[1, 2][..], &[], &[3], &[4, 5, 6]] {
            column.push_counts(row);
        }
        column.remove(&[0, 2]);
        assert_eq!(column.rows(), 2);
        assert_eq!(
            (column.counts(0), column.counts(1)),
            (&[][..], &[4, 5, 6][..])
        );
        assert!(column.reals(1).is_empty());
        let lengths: Vec<usize> = column.lengths().collect();
        assert_eq!(
            Ragged::from_lengths(&lengths, column.values().clone()),
            Some(column)
        );
    }

    #[test]
    fn values_that_are_not_one_a_row_are_no_scalars() {
        let column = Ragged::scalars(vec![300.0, 400.0]);
        assert_eq!(column.to_scalars("temperature", 2).unwrap(), [300.0, 400.0]);
        let error = column.to_scalars("temperature", 3).unwrap_err().to_string();
        assert!(
            error.contains("`temperature`") && error.contains("2 values"),
            "{error}"
        );
        assert!(Ragged::from_lengths(&[2, 1], ColumnValues::Real(vec![0.0; 4])).is_none());
    }
}
