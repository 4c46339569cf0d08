//! Comma-separated values; the first line names the columns.

use ::csv::{ReaderBuilder, StringRecord, Trim};

use super::sheet::{Fault, Row, Sheet, is_read, number};

pub(super) fn sheet(text: &str) -> Result<Sheet, Fault> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let mut sheet: Option<Sheet> = None;
    for record in reader.records() {
        let record = record.map_err(|error| (None, error.to_string()))?;
        let blank = record.len() == 1 && record[0].is_empty();
        match &mut sheet {
            _ if blank => {}
            None => sheet = Some(head(&record)?),
            Some(sheet) => row(sheet, &record, line_of(&record, text))?,
        }
    }
    Ok(sheet.unwrap_or_default())
}

/// What a file without names of columns lacks.
const HEADING: &str = "its first line names no column that is read; write a line such as `x,y,z,diameter` above the numbers";

fn head(record: &StringRecord) -> Result<Sheet, Fault> {
    if record.iter().all(|word| word.parse::<f64>().is_ok()) {
        return Err((None, HEADING.into()));
    }
    let column = |name: &str| (name.to_lowercase(), Vec::new());
    Ok(Sheet {
        columns: record.iter().map(column).collect(),
        lines: Vec::new(),
    })
}

/// The line of a record. The reader's position is before the empty lines that it skips.
fn line_of(record: &StringRecord, text: &str) -> usize {
    let Some(position) = record.position() else {
        return 0;
    };
    let (line, byte) = (position.line() as usize, position.byte() as usize);
    let rest = text.as_bytes().get(byte..).unwrap_or_default();
    let empty = rest.iter().take_while(|byte| b"\r\n".contains(byte));
    line + empty.filter(|byte| **byte == b'\n').count()
}

fn row(sheet: &mut Sheet, record: &StringRecord, line: usize) -> Result<(), Fault> {
    let (found, needed) = (record.len(), sheet.columns.len());
    if sheet.lines.is_empty()
        && found != needed
        && sheet.columns.iter().all(|(name, _)| !is_read(name))
    {
        return Err((None, HEADING.into()));
    }
    if found != needed {
        let what = format!(
            "there are {found} values, but {needed} columns; separate them by commas, with a point in decimals"
        );
        return Err((Some(Row::Line(line)), what));
    }
    for ((name, column), word) in sheet.columns.iter_mut().zip(record) {
        let value = number(word, line);
        // Columns that are not read may hold words.
        column.push(match is_read(name) {
            true => value?,
            false => value.unwrap_or(f64::NAN),
        });
    }
    sheet.lines.push(line);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_in_a_column_that_is_not_read_are_passed_over() {
        let sheet = sheet("x,y,z,name\n1,2,3,quartz\n").unwrap();
        assert_eq!(sheet.columns[2], ("z".into(), vec![3.0]));
        assert!(sheet.columns[3].1[0].is_nan());
    }

    #[test]
    fn empty_lines_carriage_returns_quotes_and_a_byte_order_mark_leave_lines_and_values() {
        let text = "\u{feff}\"X\", y\r\n\r\n 1 ,\"2\"\r\n   \n3,4\n";
        let sheet = sheet(text).unwrap();
        let columns = [("x".into(), vec![1.0, 3.0]), ("y".into(), vec![2.0, 4.0])];
        assert_eq!(sheet.columns, columns);
        assert_eq!(sheet.lines, [3, 5]);
    }
}
