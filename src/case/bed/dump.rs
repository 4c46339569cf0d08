//! Text dumps of LIGGGHTS and LAMMPS: one snapshot after the other, each with `ITEM: ATOMS` and the
//! names of its columns.

use super::sheet::{Fault, Row, Sheet, number};

/// Lines with their numbers.
type Lines<'t> = std::iter::Zip<std::ops::RangeFrom<usize>, std::str::Lines<'t>>;

/// The snapshot of a timestep; the last one where none is asked for.
pub(super) fn sheet(text: &str, timestep: Option<u64>) -> Result<Sheet, Fault> {
    let mut lines = (1..).zip(text.lines());
    let mut found: Option<Sheet> = None;
    let (mut step, mut count) = (0u64, None);
    let mut steps = Vec::new();
    // The number of atoms, where all that were announced were read and no other item began.
    let mut complete: Option<u64> = None;
    while let Some((line, content)) = lines.next() {
        let Some(item) = content.trim().strip_prefix("ITEM:") else {
            // The lines of items that do not matter here, such as BOX BOUNDS.
            match complete.filter(|_| !content.trim().is_empty()) {
                Some(count) => {
                    let what = format!(
                        "{count} atoms are announced by \"ITEM: NUMBER OF ATOMS\", but there are more"
                    );
                    return Err((Some(Row::Line(line)), what));
                }
                None => continue,
            }
        };
        complete = None;
        let item = item.trim();
        if item == "TIMESTEP" {
            step = whole(&mut lines, line)?;
            steps.push(step);
        } else if item == "NUMBER OF ATOMS" {
            count = Some(whole(&mut lines, line)?);
        } else if let Some(names) = item.strip_prefix("ATOMS") {
            let Some(count) = count.take() else {
                let what = "atoms before the line \"ITEM: NUMBER OF ATOMS\"".into();
                return Err((Some(Row::Line(line)), what));
            };
            let snapshot = atoms(&mut lines, names, count, line)?;
            complete = Some(count);
            if timestep.is_none_or(|wanted| wanted == step) {
                found = Some(snapshot);
            }
        }
    }
    if count.is_some() && timestep.is_none_or(|wanted| wanted == step) {
        let what = format!(
            "its snapshot of timestep {step} ends before its atoms, as where a run was killed; name another one by `place.timestep`"
        );
        return Err((None, what));
    }
    found.ok_or_else(|| {
        let held: Vec<String> = steps.iter().map(u64::to_string).collect();
        let what = match timestep {
            Some(wanted) => format!("it has no timestep {wanted}; it holds {}", held.join(", ")),
            None => "it has no \"ITEM: ATOMS\"".into(),
        };
        (None, what)
    })
}

fn atoms(lines: &mut Lines<'_>, names: &str, count: u64, head: usize) -> Result<Sheet, Fault> {
    let mut sheet = Sheet {
        columns: names
            .split_whitespace()
            .map(|name| (name.to_lowercase(), Vec::new()))
            .collect(),
        lines: Vec::new(),
    };
    for done in 0..count {
        let Some((line, content)) = lines.next() else {
            let what = format!("{count} atoms are announced, but the file ends after {done}");
            return Err((Some(Row::Line(head)), what));
        };
        let words: Vec<&str> = content.split_whitespace().collect();
        if words.len() != sheet.columns.len() {
            let what = format!(
                "there are {} values, but {} columns in \"ITEM: ATOMS\"",
                words.len(),
                sheet.columns.len()
            );
            return Err((Some(Row::Line(line)), what));
        }
        for ((name, column), word) in sheet.columns.iter_mut().zip(words) {
            // Columns such as `element` hold words; only those that are read must be numbers.
            let value = match name.as_str() {
                "element" => f64::NAN,
                _ => number(word, line)?,
            };
            column.push(value);
        }
        sheet.lines.push(line);
    }
    Ok(sheet)
}

fn whole(lines: &mut Lines<'_>, head: usize) -> Result<u64, Fault> {
    let (line, content) = lines.next().unwrap_or((head, ""));
    content.trim().parse().map_err(|_| {
        let what = format!("\"{}\" is not a whole number", content.trim());
        (Some(Row::Line(line)), what)
    })
}
