//! Drag that comes with a push as coefficients and gas velocities, for particles and parcels alike.

use calcine_coupler::named_columns::NamedColumns;
use calcine_coupler::part::{DRAG_COEFFICIENT, GAS_VELOCITY};

/// Drag K (u − v) of each particle, constant over a window.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PushedDrag<'a> {
    /// K in kg/s.
    pub coefficient: &'a [f64],
    /// u in m/s of motion time.
    pub gas: &'a [[f64; 3]],
}

/// True for the columns of a push that the native particles take.
pub(crate) fn takes(column: &str) -> bool {
    [DRAG_COEFFICIENT, GAS_VELOCITY].contains(&column)
}

/// The two columns of drag of so many particles, which come together and with no others; `None` without any column. The
/// error says which column is wrong.
pub(crate) fn pushed_drag(
    columns: &NamedColumns,
    count: usize,
) -> Result<Option<PushedDrag<'_>>, String> {
    if columns.is_empty() {
        return Ok(None);
    }
    if let Some(other) = columns.iter().find(|column| !takes(column.name)) {
        return Err(format!("it takes no column `{}`", other.name));
    }
    let column = |name: &str, components: usize| {
        let found = columns.get(name, components, count);
        found.ok_or_else(|| {
            format!(
                "the column `{name}` does not have {components} values for each of {count} particles"
            )
        })
    };
    Ok(Some(PushedDrag {
        coefficient: column(DRAG_COEFFICIENT, 1)?,
        gas: column(GAS_VELOCITY, 3)?.as_chunks::<3>().0,
    }))
}
