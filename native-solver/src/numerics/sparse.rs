//! General sparse matrices by rows, for the levels of a multigrid.

use rayon::prelude::*;

use super::parallel::CHUNK;

/// Rows of (column, value), stored one after the other.
#[derive(Clone, Debug)]
pub struct Rows {
    start: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

/// One row under construction: a sum of multiples of other rows.
#[derive(Debug, Default)]
pub struct Row {
    columns: Vec<u32>,
    values: Vec<f64>,
    /// One more than the position of each column in this row; zero where it has none.
    position: Vec<u32>,
}

impl Row {
    /// Adds to the entry of a column.
    #[inline]
    pub fn add(&mut self, column: u32, value: f64) {
        let position = &mut self.position[column as usize];
        if *position == 0 {
            self.columns.push(column);
            self.values.push(value);
            *position = self.columns.len() as u32;
        } else {
            self.values[*position as usize - 1] += value;
        }
    }

    fn move_to(&mut self, part: &mut Rows) {
        for &column in &self.columns {
            self.position[column as usize] = 0;
        }
        part.columns.append(&mut self.columns);
        part.values.append(&mut self.values);
        part.start.push(part.columns.len() as u32);
    }
}

impl Default for Rows {
    fn default() -> Self {
        Self {
            start: vec![0],
            columns: Vec::new(),
            values: Vec::new(),
        }
    }
}

impl Rows {
    /// Builds every row by `row(index, entries)`, chunks of rows in parallel. Entries keep the
    /// order in which they were first added, whichever thread does it.
    pub fn build(count: usize, columns: usize, row: impl Fn(usize, &mut Row) + Sync) -> Self {
        let scratch = || Row {
            position: vec![0; columns],
            ..Row::default()
        };
        let chunk = |entries: &mut Row, k: usize| {
            let mut part = Self::default();
            for index in k * CHUNK..count.min((k + 1) * CHUNK) {
                row(index, entries);
                entries.move_to(&mut part);
            }
            part
        };
        if count <= CHUNK {
            return chunk(&mut scratch(), 0);
        }
        let parts: Vec<Self> = (0..count.div_ceil(CHUNK))
            .into_par_iter()
            .map_init(scratch, chunk)
            .collect();
        let mut whole = Self::default();
        for part in parts {
            let before = whole.columns.len() as u32;
            let ends = part.start[1..].iter().map(|end| before + end);
            whole.start.extend(ends);
            whole.columns.extend(part.columns);
            whole.values.extend(part.values);
        }
        whole
    }

    /// Number of rows.
    #[inline]
    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    /// True without any row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of entries.
    pub fn entries(&self) -> usize {
        self.columns.len()
    }

    /// Columns and values of a row.
    #[inline]
    pub fn row(&self, index: usize) -> (&[u32], &[f64]) {
        let range = self.start[index] as usize..self.start[index + 1] as usize;
        (&self.columns[range.clone()], &self.values[range])
    }

    /// Entries of a row.
    #[inline]
    pub fn pairs(&self, index: usize) -> impl Iterator<Item = (u32, f64)> {
        let (columns, values) = self.row(index);
        columns.iter().copied().zip(values.iter().copied())
    }

    /// One row times a vector.
    #[inline]
    pub fn row_times(&self, index: usize, x: &[f64]) -> f64 {
        let (columns, values) = self.row(index);
        let mut sum = 0.0;
        for (&column, value) in columns.iter().zip(values) {
            sum += value * x[column as usize];
        }
        sum
    }

    /// The product A B; `columns` is the number of columns of B.
    pub fn product(&self, other: &Self, columns: usize) -> Self {
        Self::build(self.len(), columns, |index, entries| {
            for (middle, factor) in self.pairs(index) {
                for (column, value) in other.pairs(middle as usize) {
                    entries.add(column, factor * value);
                }
            }
        })
    }

    /// The transpose; `columns` is the number of columns. Columns ascend in each of its rows.
    pub fn transposed(&self, columns: usize) -> Self {
        let mut start = vec![0u32; columns + 1];
        for &column in &self.columns {
            start[column as usize + 1] += 1;
        }
        for column in 0..columns {
            start[column + 1] += start[column];
        }
        let mut next = start.clone();
        let mut transposed = Self {
            start,
            columns: vec![0; self.columns.len()],
            values: vec![0.0; self.values.len()],
        };
        for index in 0..self.len() {
            for (column, value) in self.pairs(index) {
                let at = next[column as usize] as usize;
                next[column as usize] += 1;
                transposed.columns[at] = index as u32;
                transposed.values[at] = value;
            }
        }
        transposed
    }
}
