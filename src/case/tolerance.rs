//! Bands of values that are expected, or that runs may differ by.

use super::model::ToleranceBand;
use super::table::TableReader;
use super::units::{Dimension, difference};

/// A band such as "5 %" or "0.5 K".
pub(super) fn band(
    table: &TableReader<'_>,
    key: &str,
    dimension: Dimension,
) -> Option<ToleranceBand> {
    let text = table.text(key)?;
    let made = match difference(text) {
        Ok((number, _)) if number >= 0.0 && text.trim_end().ends_with('%') => {
            Some(ToleranceBand::Relative(number))
        }
        Ok((number, found)) if number >= 0.0 && found == dimension => {
            Some(ToleranceBand::Absolute(number))
        }
        _ => None,
    };
    if made.is_none() {
        let help = format!(
            "write a share such as \"5 %\", or {} such as \"{}\"",
            dimension.words(),
            dimension.example()
        );
        table.fail(key, format!("is \"{text}\", which is no band"), help);
    }
    made
}
