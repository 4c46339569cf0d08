//! Particle input of MFiX-DEM, `particle_input.dat`: version 1.0, eight numbers a line, and version 2.0, whose head tells the columns.
//!
//! Lengths are in m, as MFiX has them with `units = 'SI'`. MFiX reads a head by the numbers of its lines, and so does this.

use super::sheet::{Fault, Row, Sheet};
use crate::fortran;

/// Columns of version 1.0.
const PLAIN: [&str; 8] = ["x", "y", "z", "radius", "density", "vx", "vy", "vz"];
/// Lines of the instructions of version 2.0, and of the rule, heading and rule before its options and before its data.
const INSTRUCTIONS: usize = 18;
const HEADING: usize = 3;
/// Options of version 2.0 in their order, with the columns that each has where its values are in the data.
const OPTIONS: [(&str, &[&str]); 6] = [
    ("Coordinates", &["x", "y", "z"]),
    ("Phase_ID", &["type"]),
    ("Diameter", &["diameter"]),
    ("Density", &["density"]),
    ("Velocity", &["vx", "vy", "vz"]),
    ("Temperature", &["temperature"]),
];
/// Options whose columns are not read; how many each has is told by MFiX's own case alone.
const PASSED_OVER: [&str; 2] = ["Species", "User scalar"];

/// A line with its number.
type Line<'t> = (usize, &'t str);

fn at<T>(line: usize, what: String) -> Result<T, Fault> {
    Err((Some(Row::Line(line)), what))
}

pub(super) fn sheet(text: &str) -> Result<Sheet, Fault> {
    let mut lines = (1..).zip(text.lines().map(str::trim));
    match text.trim_start().strip_prefix("Version") {
        None => plain(lines),
        Some(rest) => match rest.split_whitespace().next() {
            Some("2.0") => described(&mut lines),
            other => at(
                1,
                format!(
                    "its version is {}; MFiX's particle input is read in versions 1.0 (eight numbers a line) and 2.0; write it as a `.csv` \
                     with the columns {}",
                    other.unwrap_or("not named"),
                    PLAIN.join(", ")
                ),
            ),
        },
    }
}

/// Version 1.0.
fn plain<'t>(lines: impl Iterator<Item = Line<'t>>) -> Result<Sheet, Fault> {
    let mut sheet = empty(&PLAIN);
    for (line, content) in lines.filter(|line| !line.1.is_empty()) {
        let values = numbers(line, content)?;
        if values.len() != PLAIN.len() {
            let what = format!(
                "there are {} values; version 1.0 of MFiX's particle input has {}: {}, in three dimensions",
                values.len(),
                PLAIN.len(),
                PLAIN.join(" ")
            );
            return at(line, what);
        }
        add(&mut sheet, line, &values);
    }
    Ok(sheet)
}

/// Version 2.0.
fn described<'t>(lines: &mut impl Iterator<Item = Line<'t>>) -> Result<Sheet, Fault> {
    let mut lines = lines.skip(INSTRUCTIONS);
    let whole = |(line, words): (usize, Vec<&str>), name: &str| match words
        .first()
        .map(|word| word.parse::<usize>())
    {
        Some(Ok(value)) => Ok((line, value)),
        _ => at(line, format!("after `{name}:` a whole number is needed")),
    };
    let (line, dimension) = whole(option(lines.next(), "Dimension")?, "Dimension")?;
    if dimension != 3 {
        let what = format!("its dimension is {dimension}; particles of three dimensions are read");
        return at(line, what);
    }
    let (count_line, count) = whole(option(lines.next(), "Particles")?, "Particles")?;
    let mut lines = lines.skip(HEADING);
    let mut names: Vec<&str> = Vec::new();
    let mut uniform: Vec<(&str, f64)> = Vec::new();
    for (name, columns) in OPTIONS {
        let (line, words) = option(lines.next(), name)?;
        if in_data(line, name, &words)? {
            names.extend(columns);
            continue;
        }
        // The value of all particles; a temperature may be left to MFiX's case.
        let values = numbers(line, &words[1..].join(" "))?;
        if values.len() < columns.len() && name != "Temperature" {
            let what = format!(
                "`{name}` is F, so that {} must follow: one value for all particles",
                columns.join(" ")
            );
            return at(line, what);
        }
        uniform.extend(columns.iter().copied().zip(values));
    }
    let mut more = false;
    for name in PASSED_OVER {
        let (line, words) = option(lines.next(), name)?;
        more |= in_data(line, name, &words)?;
    }
    let mut sheet = empty(&names);
    let data = lines.skip(HEADING).filter(|line| !line.1.is_empty());
    for (line, content) in data {
        if sheet.lines.len() == count {
            let what =
                format!("{count} particles are announced in line {count_line}, but there are more");
            return at(line, what);
        }
        let values = numbers(line, content)?;
        if values.len() < names.len() || values.len() > names.len() && !more {
            let what = format!(
                "there are {} values, but {} columns by the head: {}",
                values.len(),
                names.len(),
                names.join(" ")
            );
            return at(line, what);
        }
        add(&mut sheet, line, &values[..names.len()]);
    }
    let found = sheet.lines.len();
    if found < count {
        let what = format!("{count} particles are announced, but the file ends after {found}");
        return at(count_line, what);
    }
    let same = |(name, value): (&str, f64)| (name.to_owned(), vec![value; found]);
    sheet.columns.extend(uniform.into_iter().map(same));
    Ok(sheet)
}

/// The words after the name of an option, which stands at its line.
fn option<'t>(line: Option<Line<'t>>, name: &str) -> Result<(usize, Vec<&'t str>), Fault> {
    let Some((number, content)) = line else {
        let what = format!(
            "it ends before the line `{name}:` of its head, which has 34 lines in version 2.0"
        );
        return Err((None, what));
    };
    let rest = content.split_once(':').filter(|(found, _)| {
        let plain = |text: &str| text.trim().to_lowercase().replace('_', " ");
        plain(found) == plain(name)
    });
    match rest {
        Some((_, rest)) => Ok((number, rest.split_whitespace().collect())),
        None => at(
            number,
            format!(
                "\"{content}\" stands where version 2.0 of MFiX's particle input has `{name}:`; its head has 34 lines, {INSTRUCTIONS} of them \
                 instructions"
            ),
        ),
    }
}

/// True where an option's values are in the data (`T`), false where it has one value for all (`F`).
fn in_data(line: usize, name: &str, words: &[&str]) -> Result<bool, Fault> {
    match words.first().map(|word| word.to_uppercase()).as_deref() {
        Some("T") => Ok(true),
        Some("F") if name != "Coordinates" => Ok(false),
        Some("F") => at(
            line,
            "`Coordinates` is F; each particle needs its own".into(),
        ),
        _ => at(
            line,
            format!("after `{name}:` T (in the data) or F (one value) is needed"),
        ),
    }
}

/// Numbers as Fortran writes them, with exponents after E or D, parted by blanks or commas.
fn numbers(line: usize, content: &str) -> Result<Vec<f64>, Fault> {
    let words = content.split(|letter: char| letter.is_whitespace() || letter == ',');
    let number = |word: &str| match fortran::number(word) {
        Some(value) => Ok(value),
        None => at(line, format!("\"{word}\" is not a number")),
    };
    words.filter(|word| !word.is_empty()).map(number).collect()
}

fn empty(names: &[&str]) -> Sheet {
    let column = |name: &&str| ((*name).to_owned(), Vec::new());
    Sheet {
        columns: names.iter().map(column).collect(),
        lines: Vec::new(),
    }
}

fn add(sheet: &mut Sheet, line: usize, values: &[f64]) {
    for ((_, column), value) in sheet.columns.iter_mut().zip(values) {
        column.push(*value);
    }
    sheet.lines.push(line);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of version 2.0 with two particles: diameters in the data, one density and velocity.
    fn version_2(options: &str, data: &str) -> String {
        let rule = "=".repeat(72);
        let instructions = "Instructions\n".repeat(INSTRUCTIONS - 2);
        format!(
            "Version 2.0\n{rule}\n{instructions}Dimension:    3\nParticles:    2\n{rule}\nVariable  Column\n{rule}\n{options}{rule}\nX Y Z\n{rule}\n{data}"
        )
    }

    const OPTIONS_OF_FILE: &str = "Coordinates:  T\nPhase_ID:  F  1\nDiameter:  T\nDensity:  F  2500.0\nVelocity:  F  0.0 0.0 -1.0\n\
                           Temperature:  F  350.0\nSpecies:  T\nUser scalar:  F\n";

    fn column<'s>(sheet: &'s Sheet, name: &str) -> &'s [f64] {
        &sheet.columns.iter().find(|one| one.0 == name).unwrap().1
    }

    #[test]
    fn version_1_has_radius_density_and_velocity_after_the_centre() {
        let sheet = sheet("0.1 0.2 0.3 5.0D-3 2.5d3 0 0 -1\n\n 1,2,3,4e-3,2500,1,0,0\n").unwrap();
        assert_eq!(column(&sheet, "x"), [0.1, 1.0]);
        assert_eq!(column(&sheet, "radius"), [5e-3, 4e-3]);
        assert_eq!(column(&sheet, "vz"), [-1.0, 0.0]);
        assert_eq!(sheet.lines, [1, 3]);
    }

    #[test]
    fn version_2_takes_columns_and_values_of_all_particles_by_its_head() {
        // Two species stand behind the diameter.
        let text = version_2(
            OPTIONS_OF_FILE,
            "1 2 3 0.004 0.3 0.7\n4 5 6 0.005 0.3 0.7\n",
        );
        let sheet = sheet(&text).unwrap();
        assert_eq!(column(&sheet, "diameter"), [0.004, 0.005]);
        assert_eq!(column(&sheet, "z"), [3.0, 6.0]);
        assert_eq!(column(&sheet, "density"), [2500.0; 2]);
        assert_eq!(column(&sheet, "vz"), [-1.0; 2]);
        assert_eq!(column(&sheet, "temperature"), [350.0; 2]);
        assert_eq!(sheet.lines, [35, 36]);
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let told = |text: &str| {
            let (row, what) = sheet(text).unwrap_err();
            format!(
                "{}: {what}",
                row.map_or(String::new(), |row| row.to_string())
            )
        };
        let cases = [
            (
                "1 2 3 0.1 2500\n".to_owned(),
                "line 1: there are 5 values; version 1.0",
            ),
            (
                "1 2 3 4 5 6 7 8\n1 2 3 x 5 6 7 8\n".into(),
                "line 2: \"x\" is not a number",
            ),
            ("Version 4.0\n".into(), "line 1: its version is 4.0; MFiX's"),
            (
                version_2(OPTIONS_OF_FILE, "1 2 3 0.004\n"),
                "line 20: 2 particles are announced, but the file ends after 1",
            ),
            (
                version_2(OPTIONS_OF_FILE, &"1 2 3 0.004\n".repeat(3)),
                "line 37: 2 particles are announced in line 20, but there are more",
            ),
            (
                version_2(&OPTIONS_OF_FILE.replace("F  2500.0", "F"), ""),
                "line 27: `Density` is F, so that density must follow",
            ),
            (
                version_2(&OPTIONS_OF_FILE.replace("Diameter", "Diametre"), ""),
                "line 26: \"Diametre:  T\" stands where",
            ),
            (
                version_2(&OPTIONS_OF_FILE.replace("s:  T\nPhase", "s:  F\nPhase"), ""),
                "line 24: `Coordinates` is F",
            ),
            (
                version_2(
                    &OPTIONS_OF_FILE.replace("Species:  T", "Species:  F"),
                    "1 2 3 0.004 1\n",
                ),
                "line 35: there are 5 values, but 4 columns",
            ),
            (
                "Version 2.0\n".into(),
                ": it ends before the line `Dimension:`",
            ),
        ];
        for (text, expected) in cases {
            let said = told(&text);
            assert!(said.starts_with(expected), "{said}");
        }
    }
}
