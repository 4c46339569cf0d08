//! Which columns of a sheet are which.

use std::path::Path;

use super::CurveFileError;
use super::curve_column::{CurveColumn, bare, parted};
use super::sheet::Sheet;

/// What a case says of a column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ColumnChoice {
    /// Its heading, or its number from 1; `None`: recognised.
    pub heading: Option<String>,
    /// Its unit; `None`: that of the heading.
    pub unit: Option<String>,
}

/// A column that was found.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FoundColumn {
    /// Place among the columns.
    pub place: usize,
    /// Its unit as written.
    pub unit: String,
    /// SI value = factor · value + offset.
    pub factor: f64,
    /// Offset of the temperature scale.
    pub offset: f64,
}

/// Place of the column of a heading, its unit left out or not, or of a number from 1.
fn named(sheet: &Sheet, wanted: &str) -> Option<usize> {
    let wanted = wanted.trim();
    let same = |name: &String| name.trim() == wanted || parted(name).0 == wanted;
    let number = wanted.parse::<usize>().ok();
    let by_number = number.filter(|k| (1..=sheet.headings.len()).contains(k));
    sheet
        .headings
        .iter()
        .position(same)
        .or(by_number.map(|k| k - 1))
}

/// Unit of a column: that of its heading, else that below it.
fn unit_of(sheet: &Sheet, place: usize) -> Option<String> {
    let below = || sheet.units.get(place).map(|unit| bare(unit).to_owned());
    let unit = parted(&sheet.headings[place]).1.or_else(below);
    unit.filter(|unit| !unit.is_empty())
}

/// True of a heading of Mettler's tables that means a column by itself alone: `t`, and `Value` by its unit.
fn is_plain(sheet: &Sheet, place: usize, column: CurveColumn) -> bool {
    let name = parted(&sheet.headings[place]).0;
    match column {
        CurveColumn::Time => name == "t",
        CurveColumn::Mass | CurveColumn::LossRate => {
            let unit = unit_of(sheet, place).unwrap_or_default();
            name == "Value" && column.units().iter().any(|(known, ..)| *known == unit)
        }
        CurveColumn::Temperature | CurveColumn::Run => false,
    }
}

/// Finds a column: as the case says, or by its heading. `None` where neither does.
pub(super) fn find(
    path: &Path,
    sheet: &Sheet,
    column: CurveColumn,
    choice: &ColumnChoice,
) -> Result<Option<FoundColumn>, CurveFileError> {
    let wrong =
        |fact: String, help: String| Err(CurveFileError::new(path, sheet.heading_line, fact, help));
    let key = column.key();
    let known = || {
        let names = sheet.headings.iter().enumerate();
        let names = names.map(|(k, name)| format!("{} \"{name}\"", k + 1));
        names.collect::<Vec<_>>().join(", ")
    };
    let place = match &choice.heading {
        Some(wanted) => match named(sheet, wanted) {
            Some(place) => place,
            None => {
                let fact = format!("no column is called \"{wanted}\"");
                return wrong(
                    fact,
                    format!(
                        "its columns are {}: name one of them as `columns.{key}`, or its number",
                        known()
                    ),
                );
            }
        },
        None => {
            let small = |k: usize| {
                let name = sheet.headings[k].trim().trim_start_matches('#');
                name.to_lowercase()
            };
            let means = |k: &usize| {
                let begins = column.beginnings().iter();
                let begins = begins.clone().any(|begin| small(*k).starts_with(begin));
                let rate = column == CurveColumn::Mass && small(*k).starts_with("mass loss rate");
                begins && !rate || is_plain(sheet, *k, column)
            };
            let mut found: Vec<usize> = (0..sheet.headings.len()).filter(means).collect();
            // The reference's temperature beside the sample's.
            if column == CurveColumn::Temperature && found.len() > 1 {
                found.retain(|&k| !small(k).starts_with("tr"));
            }
            match found[..] {
                [] => return Ok(None),
                [place] => place,
                _ => {
                    let names = found.iter().map(|&k| format!("\"{}\"", sheet.headings[k]));
                    let names: Vec<String> = names.collect();
                    let fact = format!("several columns may be the {key}: {}", names.join(", "));
                    return wrong(
                        fact,
                        format!("name the one that is meant as `columns.{key}`"),
                    );
                }
            }
        }
    };
    // What tells runs apart is a label, whatever its unit.
    if column == CurveColumn::Run {
        return Ok(Some(FoundColumn {
            place,
            unit: String::new(),
            factor: 1.0,
            offset: 0.0,
        }));
    }
    let Some(unit) = choice.unit.clone().or_else(|| unit_of(sheet, place)) else {
        let fact = format!("the column \"{}\" has no unit", sheet.headings[place]);
        let units = column
            .units()
            .iter()
            .map(|one| one.0)
            .collect::<Vec<_>>()
            .join(", ");
        return wrong(
            fact,
            format!("write it behind the heading, or as `units.{key}` of the target: {units}"),
        );
    };
    let known = column
        .units()
        .iter()
        .find(|(name, ..)| *name == bare(&unit));
    let Some(&(name, factor, offset)) = known else {
        let fact = format!(
            "the unit \"{unit}\" of the column \"{}\" is not known",
            sheet.headings[place]
        );
        let units = column
            .units()
            .iter()
            .map(|one| one.0)
            .collect::<Vec<_>>()
            .join(", ");
        return wrong(fact, format!("state `units.{key}` of the target: {units}"));
    };
    Ok(Some(FoundColumn {
        place,
        unit: name.to_owned(),
        factor,
        offset,
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn headings_of_instruments_are_recognised() {
        for (headings, column) in [
            (
                ["Time (min)", "Unsubtracted Weight (mg)", "T/degC"],
                CurveColumn::Temperature,
            ),
            (
                ["Time (min)", "Unsubtracted Weight (mg)", "T (C)"],
                CurveColumn::Temperature,
            ),
            (
                ["Time (min)", "T (deg C)", "Baseline Weight (mg)"],
                CurveColumn::Temperature,
            ),
            (
                ["Time (min)", "T/degC", "Unsubtracted Weight (mg)"],
                CurveColumn::Mass,
            ),
        ] {
            let sheet = Sheet {
                headings: headings.map(str::to_owned).to_vec(),
                units: Vec::new(),
                rows: Vec::new(),
                lines: Vec::new(),
                heading_line: Some(1),
                labels: None,
                unknown: None,
            };
            let found = find(Path::new("a.csv"), &sheet, column, &ColumnChoice::default());
            let found = found.unwrap().unwrap();
            assert_eq!(
                found.place,
                headings
                    .iter()
                    .position(|name| match column {
                        CurveColumn::Mass => name.starts_with("Unsubtracted"),
                        _ => name.starts_with("T/") || name.starts_with("T ("),
                    })
                    .unwrap(),
                "{headings:?}"
            );
        }
    }

    #[test]
    fn headings_part_into_names_and_units() {
        for (heading, name, unit) in [
            ("Temp./°C", "Temp.", Some("°C")),
            ("Mass (mg)", "Mass", Some("mg")),
            ("Time [min]", "Time", Some("min")),
            ("mass_mg", "mass", Some("mg")),
            ("Weight, %", "Weight", Some("%")),
            ("Time in s", "Time", Some("s")),
            ("DTG/(%/min)", "DTG/", Some("%/min")),
            ("T/degC", "T", Some("degC")),
            ("T (deg C)", "T", Some("deg C")),
            ("T/deg C", "T", Some("deg C")),
            (
                "Unsubtracted Weight (mg)",
                "Unsubtracted Weight",
                Some("mg"),
            ),
            ("Mass", "Mass", None),
            ("dm/dt", "dm/dt", None),
        ] {
            let (found, of) = parted(heading);
            assert_eq!((&found[..], of.as_deref()), (name, unit), "{heading}");
        }
    }
}
