//! The columns of numbers in a text.

use std::path::Path;

use super::CurveFileError;
use crate::fortran;

/// How numbers are written and parted, where a case states it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SheetForm {
    /// What stands between columns; `None`: recognised.
    pub delimiter: Option<Delimiter>,
    /// True: the decimal sign is a comma; `None`: recognised.
    pub decimal_comma: Option<bool>,
}

/// What stands between columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// A semicolon.
    Semicolon,
    /// A tabulator.
    Tab,
    /// A comma.
    Comma,
    /// One space or more.
    Space,
}

impl Delimiter {
    const ALL: [Self; 4] = [Self::Semicolon, Self::Tab, Self::Comma, Self::Space];

    fn split(self, line: &str) -> Vec<&str> {
        let letter = match self {
            Self::Semicolon => ';',
            Self::Tab => '\t',
            Self::Comma => ',',
            Self::Space => return line.split_whitespace().collect(),
        };
        let mut fields: Vec<&str> = line
            .split(letter)
            .map(|one| one.trim().trim_matches('"'))
            .collect();
        // Instruments end lines with a delimiter.
        if fields.len() > 1 && fields.last().is_some_and(|last| last.is_empty()) {
            fields.pop();
        }
        fields
    }

    fn name(self) -> &'static str {
        match self {
            Self::Semicolon => "semicolons",
            Self::Tab => "tabulators",
            Self::Comma => "commas",
            Self::Space => "spaces",
        }
    }
}

/// Columns of numbers with their headings.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sheet {
    /// Heading of each column; empty where there is none.
    pub headings: Vec<String>,
    /// Unit of each column from a line of units below the headings; empty where there is none.
    pub units: Vec<String>,
    /// Rows of values.
    pub rows: Vec<Vec<f64>>,
    /// Line of each row, from 1.
    pub lines: Vec<usize>,
    /// Line of the headings.
    pub heading_line: Option<usize>,
    /// The column that may hold texts, and its field of each row: a number as any other column writes it where all are numbers.
    pub labels: Option<(usize, Vec<String>)>,
    /// The last line above the rows, and its number, where it was not understood as headings.
    pub unknown: Option<(usize, String)>,
}

/// Rows that must be found before columns are believed in.
const LEAST_ROWS: usize = 5;
/// Lines of a file that is too short for a curve.
const SHORT: usize = 10;
/// Columns that are looked at for texts where no table of numbers is found.
const MOST_COLUMNS: usize = 40;
/// Lines in which the heading of the column of runs is looked for.
const HEADING_LINES: usize = 300;
/// Letters of unknown headings that a message shows.
const LONGEST_HEADINGS: usize = 160;
/// Longest file in bytes.
const LONGEST: usize = 200_000_000;

/// The text of a file in UTF-8, UTF-16 with its mark, or Latin-1.
pub(super) fn decode(path: &Path, bytes: &[u8]) -> Result<String, CurveFileError> {
    if bytes.len() > LONGEST {
        let fact = format!("it has {} bytes", bytes.len());
        let help = "export fewer points: a few thousand tell a curve";
        return Err(CurveFileError::new(path, None, fact, help));
    }
    let wide = |little: bool, bytes: &[u8]| {
        let pairs = bytes.chunks_exact(2).map(|pair| {
            let pair = [pair[0], pair[1]];
            if little {
                u16::from_le_bytes(pair)
            } else {
                u16::from_be_bytes(pair)
            }
        });
        String::from_utf16_lossy(&pairs.collect::<Vec<u16>>())
    };
    // Letters of instruments' files are in the lower half of UTF-16, with or without its mark.
    let halves = |from: usize| {
        bytes.len() >= 8
            && bytes
                .iter()
                .skip(from)
                .step_by(2)
                .take(4)
                .all(|one| *one == 0)
    };
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => wide(true, rest),
        [0xfe, 0xff, rest @ ..] => wide(false, rest),
        _ if halves(1) => wide(true, bytes),
        _ if halves(0) => wide(false, bytes),
        [0xef, 0xbb, 0xbf, rest @ ..] => latin_or_utf8(rest),
        _ => latin_or_utf8(bytes),
    };
    if text.contains('\0') || text.starts_with("PK\u{3}\u{4}") {
        let help = "export the curve as text: CSV or TXT";
        return Err(CurveFileError::new(path, None, "it is no text", help));
    }
    Ok(text)
}

fn latin_or_utf8(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        // ° and other signs of instruments' files.
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// A number as the file writes it; not a number where it says so, as in columns of a run that begin later.
fn number(field: &str, decimal_comma: bool) -> Option<f64> {
    if field.eq_ignore_ascii_case("nan") {
        return Some(f64::NAN);
    }
    let plain = match decimal_comma {
        true if field.contains('.') => return None,
        true => field.replace(',', "."),
        false => field.to_owned(),
    };
    let starts = |c: char| c.is_ascii_digit() || "+-.".contains(c);
    if !plain.starts_with(starts) {
        return None;
    }
    fortran::number(&plain)
}

/// One way to read the lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Manner {
    delimiter: Delimiter,
    decimal_comma: bool,
    /// The column that may hold texts, which count as not a number.
    label: Option<usize>,
}

impl Manner {
    fn row(self, line: &str) -> Option<Vec<f64>> {
        let fields = self.delimiter.split(line);
        let numbers = fields.iter().enumerate().map(|(k, field)| {
            let text = (self.label == Some(k)).then_some(f64::NAN);
            number(field, self.decimal_comma).or(text)
        });
        let numbers: Option<Vec<f64>> = numbers.collect();
        numbers.filter(|row| row.len() >= 2)
    }

    /// The first line and the count of the longest stretch of rows of one width, and that width.
    fn stretch(self, lines: &[(usize, &str)]) -> (usize, usize, usize) {
        let (mut best, mut now) = ((0, 0, 0), (0, 0, 0));
        for (place, (_, line)) in lines.iter().enumerate() {
            match self.row(line).map(|row| row.len()) {
                Some(width) if width == now.2 => now.1 += 1,
                Some(width) => now = (place, 1, width),
                None => now = (0, 0, 0),
            }
            if now.1 > best.1 {
                best = now;
            }
        }
        best
    }

    /// Where the first stretch of rows of this width begins that is long enough for a table, so that a line that is no row
    /// is told of rather than taken for a heading of what follows it.
    fn first_row(self, lines: &[(usize, &str)], width: usize) -> Option<usize> {
        let is_row = |line: &str| self.row(line).is_some_and(|row| row.len() == width);
        let mut count = 0;
        for (place, (_, line)) in lines.iter().enumerate() {
            count = if is_row(line) { count + 1 } else { 0 };
            if count == LEAST_ROWS {
                return Some(place + 1 - LEAST_ROWS);
            }
        }
        None
    }
}

/// Finds the columns in a text. `runs` is the heading or the number of the column that tells runs apart, where it is stated: it
/// may hold texts.
pub(super) fn sheet(
    path: &Path,
    text: &str,
    form: SheetForm,
    runs: Option<&str>,
) -> Result<Sheet, CurveFileError> {
    let lines: Vec<(usize, &str)> = text
        .lines()
        .enumerate()
        .map(|(k, line)| (k + 1, line.trim_end()))
        .filter(|(_, line)| !line.trim().is_empty())
        .collect();
    if lines.is_empty() {
        let help = "export the curve again, with time, temperature and mass";
        return Err(CurveFileError::new(path, None, "it is empty", help));
    }
    let manner = manner(path, &lines, form, runs)?;
    let (longest, _, width) = manner.stretch(&lines);
    let start = manner.first_row(&lines, width).unwrap_or(longest);
    let above = &lines[..start];
    let (headings, heading_line, units) = headings(above, manner.delimiter, width);
    let (mut rows, mut numbers, mut labels) = (Vec::new(), Vec::new(), Vec::new());
    for (place, &(line, text)) in lines.iter().enumerate().skip(start) {
        let row = manner.row(text).filter(|row| row.len() == width);
        let fields = manner.delimiter.split(text);
        let Some(row) = row else {
            if closes(manner, &lines[place..]) {
                break;
            }
            let wrong = fields.iter().enumerate().find(|(k, one)| {
                manner.label != Some(*k) && number(one, manner.decimal_comma).is_none()
            });
            let (fact, help) = match wrong {
                Some((k, wrong)) if fields.len() == width => (
                    format!(
                        "\"{}\" is not a number in {}",
                        short(wrong),
                        column_name(k, &headings)
                    ),
                    "correct or remove the line; lines of text belong above the columns",
                ),
                _ => (
                    format!(
                        "it has {} fields where {width} columns begin above",
                        fields.len()
                    ),
                    "remove the line, or export one table to a file",
                ),
            };
            return Err(CurveFileError::new(path, Some(line), fact, help));
        };
        rows.push(row);
        numbers.push(line);
        labels.extend(
            manner
                .label
                .and_then(|k| fields.get(k))
                .map(|one| (*one).to_owned()),
        );
    }
    let plain: Option<Vec<String>> = labels
        .iter()
        .map(|one| Some(number(one, manner.decimal_comma)?.to_string()))
        .collect();
    let unknown = headings.iter().all(String::is_empty).then(|| above.last());
    Ok(Sheet {
        headings,
        units,
        rows,
        lines: numbers,
        heading_line,
        labels: manner.label.map(|k| (k, plain.unwrap_or(labels))),
        unknown: unknown.flatten().map(|(line, text)| {
            let shown = text.trim().chars().take(LONGEST_HEADINGS);
            (*line, shown.collect())
        }),
    })
}

/// A column for messages, by its number and its heading.
fn column_name(place: usize, headings: &[String]) -> String {
    match headings.get(place).filter(|name| !name.is_empty()) {
        Some(name) => format!("column {}, \"{name}\"", place + 1),
        None => format!("column {}", place + 1),
    }
}

/// True of lines that follow the table of an instrument, such as its results: a line without any number, and no row after it.
fn closes(manner: Manner, lines: &[(usize, &str)]) -> bool {
    let is_number = |field: &&str| number(field, manner.decimal_comma).is_some();
    let mut lines = lines.iter().map(|(_, line)| *line);
    let first = lines.next().unwrap_or_default();
    let worded = !manner.delimiter.split(first).iter().any(is_number);
    worded && lines.all(|line| manner.row(line).is_none())
}

/// Place of the column that tells runs apart among the fields of its heading's line, or by its number.
fn place_of_runs(
    lines: &[(usize, &str)],
    delimiter: Delimiter,
    stated: Option<&str>,
) -> Option<usize> {
    let means = |field: &str| match stated {
        Some(wanted) => {
            field.trim() == wanted.trim() || super::curve_column::parted(field).0 == wanted.trim()
        }
        None => field.trim().eq_ignore_ascii_case("run"),
    };
    let is_number = |field: &&str| {
        [false, true]
            .iter()
            .any(|&comma| number(field, comma).is_some())
    };
    let of_line = |(_, line): &(usize, &str)| {
        let fields = delimiter.split(line.trim_start_matches('#').trim());
        // Rows hold numbers, headings do not.
        let headings = fields.len() > 1 && !fields.iter().any(is_number);
        headings.then(|| fields.iter().position(|one| means(one)))?
    };
    let stated = stated.and_then(|wanted| wanted.trim().parse::<usize>().ok()?.checked_sub(1));
    lines
        .iter()
        .take(HEADING_LINES)
        .find_map(of_line)
        .or(stated)
}

/// The beginning of a field, for messages.
fn short(field: &str) -> String {
    field.chars().take(40).collect()
}

/// How the lines are to be read: the manner with the longest stretch of rows; refused where two are as good and differ.
fn manner(
    path: &Path,
    lines: &[(usize, &str)],
    form: SheetForm,
    runs: Option<&str>,
) -> Result<Manner, CurveFileError> {
    let delimiters = Delimiter::ALL.into_iter();
    let delimiters = delimiters.filter(|one| form.delimiter.is_none_or(|stated| stated == *one));
    let manners = delimiters.flat_map(|delimiter| {
        let label = place_of_runs(lines, delimiter, runs);
        [false, true].map(|decimal_comma| Manner {
            delimiter,
            decimal_comma,
            label,
        })
    });
    let stated = |one: &Manner| {
        form.decimal_comma
            .is_none_or(|comma| comma == one.decimal_comma)
    };
    let sound = |one: &Manner| !(one.decimal_comma && one.delimiter == Delimiter::Comma);
    let manners: Vec<Manner> = manners.filter(|one| stated(one) && sound(one)).collect();
    let mut found: Vec<(usize, usize, Manner)> = manners
        .iter()
        .map(|&manner| {
            let (_, count, width) = manner.stretch(lines);
            (count, width, manner)
        })
        .filter(|(count, ..)| *count >= LEAST_ROWS)
        .collect();
    found.sort_by_key(|(count, ..)| std::cmp::Reverse(*count));
    let Some(&(count, width, manner)) = found.first() else {
        if let Some(error) = column_of_texts(path, lines, &manners) {
            return Err(error);
        }
        // A few rows at the end of a short file are a table that lacks the rest.
        let rows = manners.iter().map(|manner| manner.stretch(lines));
        let at_end =
            rows.filter(|(first, count, width)| *width > 1 && first + count == lines.len());
        let count = at_end.map(|one| one.1).max();
        if let Some(count) = count.filter(|_| lines.len() < SHORT) {
            let fact = format!("{count} rows of numbers are no curve");
            let help = "export the whole curve, ten rows or more";
            return Err(CurveFileError::new(path, None, fact, help));
        }
        let (line, text) = lines[lines.len() / 2];
        let fact = format!(
            "no table of numbers was found; this line is \"{}\"",
            short(text)
        );
        let help = "it needs five rows or more of two columns of numbers; state `delimiter` and `decimal` of the target where \
                    they are unusual, and write thousands without a sign between them";
        return Err(CurveFileError::new(path, Some(line), fact, help));
    };
    // A comma that parts columns by one reading is a decimal sign by another: 20,5 83,1 and 20,5;83,1.
    let rival = found
        .iter()
        .find(|(other, _, rival)| *other == count && rival.delimiter != manner.delimiter);
    if let Some((_, other, rival)) = rival {
        let [first, second] = [(manner, width), (*rival, *other)];
        // A tabulator or semicolon between columns leaves spaces and commas no part of their own.
        let strong = |one: Manner| matches!(one.delimiter, Delimiter::Semicolon | Delimiter::Tab);
        if !strong(first.0) {
            let line = lines[lines.len() / 2].0;
            let fact = format!(
                "its columns can be parted by {} ({} columns) and by {} ({} columns)",
                first.0.delimiter.name(),
                first.1,
                second.0.delimiter.name(),
                second.1
            );
            let help = "state `delimiter` and `decimal` of the target";
            return Err(CurveFileError::new(path, Some(line), fact, help));
        }
    }
    if manner.delimiter == Delimiter::Comma {
        doubled_commas(path, lines, manner, width)?;
    }
    Ok(manner)
}

/// What is wrong with a table of which one column holds texts.
fn column_of_texts(
    path: &Path,
    lines: &[(usize, &str)],
    manners: &[Manner],
) -> Option<CurveFileError> {
    let places = (0..MOST_COLUMNS).map(Some);
    let all = places.flat_map(|label| manners.iter().map(move |&one| Manner { label, ..one }));
    // Two columns of numbers at least stand beside the texts.
    let found = all.filter_map(|manner| {
        let (start, count, width) = manner.stretch(lines);
        (count >= LEAST_ROWS && width > 2).then_some((count, start, width, manner))
    });
    let (_, start, width, manner) = found.max_by_key(|one| one.0)?;
    let (names, ..) = headings(&lines[..start], manner.delimiter, width);
    let (line, text) = lines[start];
    let place = manner.label?;
    let field = manner
        .delimiter
        .split(text)
        .get(place)
        .map(|one| short(one))?;
    let fact = format!(
        "\"{field}\" is not a number in {}",
        column_name(place, &names)
    );
    let help = "name the column as `columns.run` where it tells runs apart, else leave it out";
    Some(CurveFileError::new(path, Some(line), fact, help))
}

/// Refuses commas that are both decimal sign and delimiter: twice as many fields as headings.
fn doubled_commas(
    path: &Path,
    lines: &[(usize, &str)],
    manner: Manner,
    width: usize,
) -> Result<(), CurveFileError> {
    let (longest, ..) = manner.stretch(lines);
    let start = manner.first_row(lines, width).unwrap_or(longest);
    let Some((_, heading)) = start.checked_sub(1).map(|above| lines[above]) else {
        return Ok(());
    };
    let names = Delimiter::Comma.split(heading).len();
    let others = [Delimiter::Semicolon, Delimiter::Tab].map(|one| one.split(heading).len());
    let names = others.into_iter().max().unwrap_or(1).max(names);
    if names >= 2 && names < width {
        let fact = format!(
            "it has {width} fields by commas, but {names} headings: the comma is also the decimal sign"
        );
        let help = "export with a decimal point, or with semicolons between columns";
        return Err(CurveFileError::new(path, Some(lines[start].0), fact, help));
    }
    Ok(())
}

/// The headings above the rows, their line, and the units where a line of its own has them.
fn headings(
    above: &[(usize, &str)],
    delimiter: Delimiter,
    width: usize,
) -> (Vec<String>, Option<usize>, Vec<String>) {
    let none = vec![String::new(); width];
    if let Some((names, line)) = signals(above, width) {
        return (names, Some(line), none);
    }
    let fields = |line: &str| -> Option<Vec<String>> {
        let line = line.trim_start_matches('#').trim();
        // Headings may hold spaces: where spaces part columns, those between them are wider or tabulators.
        let split: Vec<String> = delimiter
            .split(line)
            .iter()
            .map(|one| (*one).to_owned())
            .collect();
        if split.len() == width {
            return Some(split);
        }
        let wide: Vec<String> = line
            .split("  ")
            .map(str::trim)
            .filter(|one| !one.is_empty())
            .map(str::to_owned)
            .collect();
        (delimiter == Delimiter::Space && wide.len() == width).then_some(wide)
    };
    let Some((line, last)) = above.last() else {
        return (none.clone(), None, none);
    };
    let before = above.len().checked_sub(2).map(|place| above[place]);
    let Some(last) = fields(last) else {
        // Fewer units than headings: the first columns, such as an index, have none.
        let units = delimiter.split(last.trim());
        let few = units.len() < width && units.iter().all(|one| super::curve_column::is_unit(one));
        let names = before.filter(|_| few);
        let names = names.and_then(|(line, text)| Some((line, fields(text)?)));
        let Some((line, names)) = names else {
            return (none.clone(), None, none);
        };
        let mut below = vec![String::new(); width - units.len()];
        below.extend(units.iter().map(|one| (*one).to_owned()));
        return (names, Some(line), below);
    };
    // A line of units below the headings: all of them short, and the line above has as many fields.
    let is_units = last
        .iter()
        .all(|one| one.is_empty() || super::curve_column::is_unit(one));
    match before.and_then(|(line, text)| Some((line, fields(text)?))) {
        Some((line, names)) if is_units => (names, Some(line), last),
        _ => (last, Some(*line), none),
    }
}

/// Headings of TA Instruments: a line `Sig1 Time (min)` for each column, and the line of the first.
fn signals(above: &[(usize, &str)], width: usize) -> Option<(Vec<String>, usize)> {
    let of = |k: usize| {
        above.iter().find_map(|(line, text)| {
            let name = text.trim().strip_prefix(&format!("Sig{k}"))?;
            let name = name.strip_prefix(|c: char| !c.is_alphanumeric())?;
            Some((*line, name.trim().to_owned()))
        })
    };
    let all: Option<Vec<(usize, String)>> = (1..=width).map(of).collect();
    let all = all?;
    let line = all.first()?.0;
    Some((all.into_iter().map(|one| one.1).collect(), line))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Sheet, CurveFileError> {
        sheet(Path::new("a.csv"), text, SheetForm::default(), None)
    }

    /// Six rows of these fields.
    fn table(head: &str, row: &str) -> String {
        format!("{head}\n{}", format!("{row}\n").repeat(6))
    }

    #[test]
    fn the_forms_of_instruments_are_recognised() {
        for (head, row, names, values) in [
            ("Time,Temp,Mass", "0.5,20.5,99.5", 3, [0.5, 20.5, 99.5]),
            (
                "Time,Temp,Mass",
                "5D-1,2.05d+1,9.95E1",
                3,
                [0.5, 20.5, 99.5],
            ),
            (
                "##Temp./°C;Time/min;Mass/%",
                "20,5;0,5;99,5",
                3,
                [20.5, 0.5, 99.5],
            ),
            ("Time\tTemp\tMass", "0,5\t20,5\t99,5", 3, [0.5, 20.5, 99.5]),
            (
                "Time  Sample temp  Mass",
                " 0.5   20.5  99.5",
                3,
                [0.5, 20.5, 99.5],
            ),
            (
                "\"t\";\"T\";\"m\"",
                "5e-1;2.05e1;99.5;",
                3,
                [0.5, 20.5, 99.5],
            ),
        ] {
            let sheet = read(&table(head, row)).unwrap();
            assert_eq!(
                sheet.headings.iter().filter(|one| !one.is_empty()).count(),
                names,
                "{head}"
            );
            assert_eq!(
                (sheet.rows.len(), &sheet.rows[0][..]),
                (6, &values[..]),
                "{head}"
            );
            assert_eq!((sheet.heading_line, sheet.lines[0]), (Some(1), 2));
        }
    }

    #[test]
    fn a_line_of_units_stands_below_the_headings_and_text_above_them() {
        let text = table(
            "Sample: chalk\nOperator: A\n\nTime;Temperature;Weight\nmin;°C;mg",
            "0,5;20,5;5,01",
        );
        let sheet = read(&text).unwrap();
        assert_eq!(sheet.headings, ["Time", "Temperature", "Weight"]);
        assert_eq!(sheet.units, ["min", "°C", "mg"]);
        assert_eq!((sheet.heading_line, sheet.lines[0]), (Some(4), 6));
    }

    /// As in the series of a run, whose columns may begin later.
    #[test]
    fn other_columns_may_have_no_numbers() {
        let text = "t,T,m,e\n1,2,3,NaN\n2,2,3,nan\n".to_owned() + &"3,2,3,1\n".repeat(6);
        let sheet = read(&text).unwrap();
        assert_eq!((sheet.rows.len(), sheet.lines[0]), (8, 2));
    }

    #[test]
    fn what_is_ambiguous_or_no_table_is_refused_with_its_line() {
        let fact = |text: &str| {
            let error = read(text).unwrap_err();
            (error.line, error.fact)
        };
        let (line, told) = fact(&table("t,T,m", "0,5,20,5,99,5"));
        assert!(
            line == Some(2) && told.contains("also the decimal sign"),
            "{told}"
        );
        assert_eq!(
            read(&table("t m", "0,5 99,5")).unwrap().rows[0],
            [0.5, 99.5]
        );
        let (line, told) = fact(&(table("t;m", "1;2") + "3;x\n"));
        let expected = "\"x\" is not a number in column 2, \"m\"";
        assert_eq!((line, &told[..]), (Some(8), expected));
        let (line, told) = fact(&(table("t;m", "1;2") + "3;4;5\n"));
        assert!(
            line == Some(8) && told.contains("3 fields where 2 columns"),
            "{told}"
        );
        assert!(fact("").1.contains("empty") && fact("a b c\nd e f").1.contains("no table"));
    }

    #[test]
    fn other_encodings_are_read() {
        let of = |bytes: &[u8]| decode(Path::new("a"), bytes);
        assert_eq!(of(b"T/\xb0C").unwrap(), "T/°C");
        assert_eq!(of(b"\xff\xfea\0;\0").unwrap(), "a;");
        assert_eq!(of(b"S\0i\0g\x001\0").unwrap(), "Sig1");
        assert_eq!(of(b"\0S\0i\0g\x001").unwrap(), "Sig1");
        assert_eq!(of("\u{feff}a".as_bytes()).unwrap(), "a");
        assert!(of(b"PK\x03\x04").is_err() && of(b"a\0b").is_err());
    }
}
