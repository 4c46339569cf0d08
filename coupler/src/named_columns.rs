//! Columns of particles by their names, beside those that all solvers of particles have: what a solver takes or reports
//! beyond them is one more column, over the wire too, and never another protocol.

/// One column: a fixed number of values of each particle, interleaved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedColumn<'a> {
    /// Its name.
    pub name: &'a str,
    /// Values of each particle.
    pub components: usize,
    /// All values, interleaved.
    pub values: &'a [f64],
}

#[derive(Clone, Debug, PartialEq)]
struct StoredColumn {
    name: String,
    components: usize,
    values: Vec<f64>,
}

/// Columns by their names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedColumns(Vec<StoredColumn>);

impl NamedColumns {
    /// True where there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Removes all.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// The values of a column with `components` values for each of `count` particles, interleaved; `None` where there is
    /// none of this name and shape.
    pub fn get(&self, name: &str, components: usize, count: usize) -> Option<&[f64]> {
        let found = self.0.iter().find(|one| one.name == name)?;
        let fits = found.components == components && found.values.len() == components * count;
        fits.then_some(&found.values[..])
    }

    /// Sets a column; one of the same name is replaced.
    pub fn set(&mut self, name: &str, components: usize, values: Vec<f64>) {
        self.0.retain(|one| one.name != name);
        self.0.push(StoredColumn {
            name: name.to_owned(),
            components,
            values,
        });
    }

    /// All columns, in the order in which they were set.
    pub fn iter(&self) -> impl Iterator<Item = NamedColumn<'_>> {
        self.0.iter().map(|one| NamedColumn {
            name: &one.name,
            components: one.components,
            values: &one.values,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_is_found_by_name_and_shape_and_replaced_by_another_of_its_name() {
        let mut columns = NamedColumns::default();
        columns.set("film", 1, vec![1.0, 2.0]);
        columns.set("film", 2, vec![1.0, 2.0, 3.0, 4.0]);
        assert_eq!(columns.get("film", 2, 2), Some(&[1.0, 2.0, 3.0, 4.0][..]));
        assert_eq!(columns.get("film", 1, 4), None);
        assert_eq!(columns.get("film", 2, 3), None);
        assert_eq!(columns.get("contacts", 1, 2), None);
        let names: Vec<_> = columns
            .iter()
            .map(|one| (one.name, one.components))
            .collect();
        assert_eq!(names, [("film", 2)]);
    }
}
