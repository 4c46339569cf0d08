//! Columns that several models share by name.

use calcine_interior::{ParticleModel, StateColumn};

use super::error::ParticleModelError;

/// A column, and where each model has it.
pub(super) struct MergedColumn {
    pub(super) column: StateColumn,
    /// Place in the columns of each model; `None` in one that lacks it.
    pub(super) place: Vec<Option<usize>>,
}

/// Columns of all models by name, in the order in which they first stand.
pub(super) fn merge(
    models: &[Box<dyn ParticleModel>],
) -> Result<Vec<MergedColumn>, ParticleModelError> {
    let mut merged: Vec<MergedColumn> = Vec::new();
    for (k, model) in models.iter().enumerate() {
        for (place, column) in model.columns().iter().enumerate() {
            let found = merged.iter_mut().find(|one| one.column.name == column.name);
            let one = match found {
                Some(one) => one,
                None => {
                    merged.push(MergedColumn {
                        column: column.clone(),
                        place: vec![None; models.len()],
                    });
                    let last = merged.len() - 1;
                    &mut merged[last]
                }
            };
            let says = |of: &StateColumn| format!("{:?} {:?} in {}", of.shape, of.kind, of.unit);
            let units = [says(&one.column), says(column)];
            if units[0] != units[1] || one.place[k].is_some() {
                let name = column.name.clone();
                return Err(ParticleModelError::ColumnClash { name, units });
            }
            one.place[k] = Some(place);
        }
    }
    Ok(merged)
}
