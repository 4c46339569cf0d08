//! What every answer of a solver must satisfy, whichever it is: it belongs to the attempt that was asked for, its columns
//! have the right length, and each of their values is finite.

use calcine_coupler::error::FailureKind;
use calcine_coupler::time::Window;
use calcine_wire::{ColumnSet, Link, MessageKind, WireError};

/// The column in which NaN stands for what a solver does not count.
const MAY_BE_NAN: &str = "support";

/// What is wrong with an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongAnswer {
    /// Of which kind it is.
    pub kind: FailureKind,
    /// Which column or what, and where.
    pub message: String,
}

fn protocol(message: String) -> WrongAnswer {
    WrongAnswer {
        kind: FailureKind::Protocol,
        message,
    }
}

/// An answer to a START that belongs to another attempt.
pub fn of_another_attempt(link: &Link, window: &Window) -> Result<Option<WrongAnswer>, WireError> {
    let header = link.header()?;
    let asked = (window.index, window.attempt);
    let differs =
        header.kind() == Some(MessageKind::Finished) && (header.window, header.attempt) != asked;
    Ok(differs.then(|| {
        protocol(format!(
            "it answers window {}, attempt {}, where window {}, attempt {} was asked for",
            header.window, header.attempt, asked.0, asked.1
        ))
    }))
}

/// Columns of another number of cells than the rank has.
pub fn of_another_length(link: &Link, cells: usize) -> Result<Option<WrongAnswer>, WireError> {
    let header = link.header()?;
    let name = header.kind().map_or("message", MessageKind::name);
    Ok((header.count != cells as u64).then(|| {
        protocol(format!(
            "the columns of its {name} are of {} cells, but it has {cells}",
            header.count
        ))
    }))
}

/// A value in the columns of a state that is not finite; `item` names what its row is, "cell 4" for example.
pub fn not_finite(
    link: &Link,
    item: impl Fn(usize) -> String,
) -> Result<Option<WrongAnswer>, WireError> {
    for field in link.catalogue().of(ColumnSet::State) {
        if field.unit == "u64" || field.name == MAY_BE_NAN {
            continue;
        }
        let values = link.column(&field.name)?;
        let Some(at) = values.iter().position(|value| !value.is_finite()) else {
            continue;
        };
        let place = match field.per_item {
            true => format!(" of {}", item(at / field.components)),
            false => format!("[{at}]"),
        };
        return Ok(Some(WrongAnswer {
            kind: FailureKind::NotFinite,
            message: format!("its column {}{place} is {}", field.name, values[at]),
        }));
    }
    Ok(None)
}
