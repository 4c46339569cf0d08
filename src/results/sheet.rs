//! Comma-separated files of results: rows of numbers and names.

use std::path::Path;

use csv::{ReaderBuilder, StringRecord, WriterBuilder};

use super::ResultsError;

/// A number as it reads back to the same bits.
pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A row with the end of its line; words that hold commas or quotes are put in quotes.
pub(crate) fn line(path: &Path, words: &[String]) -> Result<Vec<u8>, ResultsError> {
    let mut writer = WriterBuilder::new().from_writer(Vec::new());
    let written = writer.write_record(words);
    written.map_err(|error| ResultsError::content(path, error.to_string()))?;
    let bytes = writer.into_inner();
    bytes.map_err(|error| ResultsError::content(path, error.to_string()))
}

/// The rows of a file's text, of any length.
pub(crate) fn rows(path: &Path, text: &str) -> Result<Vec<StringRecord>, ResultsError> {
    let reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .from_reader(text.as_bytes());
    let rows = reader.into_records().collect::<Result<_, _>>();
    rows.map_err(|error| ResultsError::content(path, error.to_string()))
}

/// The words of a row as they stand in the file, for messages.
pub(crate) fn words(row: &StringRecord) -> String {
    row.iter().collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_commas_and_numbers_of_any_kind_come_back() {
        let path = Path::new("a.csv");
        let names = ["a, b".to_owned(), "c \"d\"".into(), number(0.1 + 0.2)];
        let numbers = [number(f64::NAN), number(-0.0), number(1e-310)];
        let text = [line(path, &names).unwrap(), line(path, &numbers).unwrap()].concat();
        let text = String::from_utf8(text).unwrap();
        let rows = rows(path, &text).unwrap();
        assert!(rows[0].iter().eq(names.iter()));
        let values: Vec<u64> = rows[1]
            .iter()
            .map(|word| word.parse::<f64>().unwrap().to_bits())
            .collect();
        assert_eq!(values[1..], [(-0.0f64).to_bits(), 1e-310f64.to_bits()]);
    }
}
