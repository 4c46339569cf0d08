//! Bands of values that are expected, or that runs may differ by.

use super::model::ToleranceBand;
use super::table::TableReader;
use super::units::{Dimension, difference};

/// A band about a value; a share of nothing is none.
pub(super) fn band_about(
    table: &TableReader<'_>,
    value: Option<f64>,
    dimension: Dimension,
) -> Option<ToleranceBand> {
    let band = band(table, "within", dimension)?;
    if value == Some(0.0) && matches!(band, ToleranceBand::Relative(_)) {
        let help = format!(
            "write a width, {}, such as \"{}\"",
            dimension.words(),
            dimension.example()
        );
        table.fail(
            "within",
            "is a share of a value of 0, which has no width",
            help,
        );
        return None;
    }
    Some(band)
}

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
