//! VTK's old format (`.vtk`), ASCII: polydata or an unstructured grid, its points the particles.

use super::sheet::{Fault, Row, Sheet, add, number};

/// Words of a text, one line after the other.
struct Words<'t> {
    lines: std::str::Lines<'t>,
    rest: &'t str,
    line: usize,
}

impl<'t> Words<'t> {
    /// The rest of the line, if it holds words, else the next line that does.
    fn line(&mut self) -> Option<Vec<&'t str>> {
        loop {
            let words: Vec<_> = self.rest.split_whitespace().collect();
            self.rest = "";
            if !words.is_empty() {
                return Some(words);
            }
            self.rest = self.lines.next()?;
            self.line += 1;
        }
    }

    fn next(&mut self) -> Option<&'t str> {
        loop {
            let rest = self.rest.trim_start();
            let end = rest.find(char::is_whitespace).unwrap_or(rest.len());
            if end > 0 {
                self.rest = &rest[end..];
                return Some(&rest[..end]);
            }
            self.rest = self.lines.next()?;
            self.line += 1;
        }
    }

    /// The first word of the next line that has one.
    fn ahead(&self) -> Option<&'t str> {
        let mut lines = self.lines.clone();
        lines.find_map(|line| line.split_whitespace().next())
    }

    fn fault(&self, what: impl Into<String>) -> Fault {
        (Some(Row::Line(self.line)), what.into())
    }

    fn numbers(&mut self, count: usize) -> Result<Vec<f64>, Fault> {
        // A count out of the file may be nonsense: memory grows with what is there.
        let mut values = Vec::new();
        for _ in 0..count {
            let word = self
                .next()
                .ok_or_else(|| self.fault(format!("the file ends before {count} numbers")))?;
            values.push(number(word, self.line)?);
        }
        Ok(values)
    }

    fn skip(&mut self, count: usize) -> Result<(), Fault> {
        for _ in 0..count {
            self.next()
                .ok_or_else(|| self.fault(format!("the file ends before {count} values")))?;
        }
        Ok(())
    }

    fn skip_to_empty_line(&mut self) {
        self.rest = "";
        for line in self.lines.by_ref() {
            self.line += 1;
            if line.trim().is_empty() {
                return;
            }
        }
    }
}

/// What the arrays that follow belong to.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    Points,
    Others,
}

pub(super) fn sheet(text: &str) -> Result<Sheet, Fault> {
    let mut words = Words {
        lines: text.lines(),
        rest: "",
        line: 0,
    };
    if !text.starts_with("# vtk DataFile") {
        return Err(words.fault("it does not begin with \"# vtk DataFile\""));
    }
    // Version and title.
    words.lines.next();
    words.lines.next();
    words.line = 2;
    match words.line().as_deref() {
        Some(["ASCII"]) => {}
        Some(["BINARY"]) => {
            return Err(words.fault("it is binary; write it as ASCII, or as .vtp or .vtu"));
        }
        _ => return Err(words.fault("it says neither ASCII nor BINARY")),
    }
    let mut sheet = Sheet::default();
    let (mut of, mut tuples) = (Of::Others, 0);
    while let Some(line) = words.line() {
        let whole = |place: usize| -> Result<usize, Fault> {
            let word = line.get(place).copied().unwrap_or("");
            let what = format!("\"{word}\" is not a whole number");
            let number = word.parse().map_err(|_| words.fault(what))?;
            Ok(number)
        };
        match line[0] {
            "DATASET" if matches!(line[1..], ["POLYDATA" | "UNSTRUCTURED_GRID"]) => {}
            "DATASET" => {
                let what = "the particles must be points of POLYDATA or an UNSTRUCTURED_GRID";
                return Err(words.fault(what));
            }
            "POINTS" => {
                let count = whole(1)?;
                let values = words.numbers(count.saturating_mul(3))?;
                let axes = ["x", "y", "z"].into_iter().enumerate();
                for (axis, name) in axes {
                    let one = values.iter().skip(axis).step_by(3).copied().collect();
                    sheet.columns.push((name.into(), one));
                }
            }
            "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" | "CELLS" => {
                let (first, second) = (whole(1)?, whole(2)?);
                // Since version 5.1 two named lists follow, before it one of both.
                let old = words.ahead() != Some("OFFSETS");
                if old {
                    words.skip(second)?;
                } else {
                    words.skip(2)?;
                    words.skip(first)?;
                    words.skip(2)?;
                    words.skip(second)?;
                }
            }
            "CELL_TYPES" => {
                let count = whole(1)?;
                words.skip(count)?;
            }
            "POINT_DATA" => {
                (of, tuples) = (Of::Points, whole(1)?);
                let points = sheet.columns.first().map_or(0, |(_, list)| list.len());
                if tuples != points {
                    let what = format!("{tuples} values for {points} points");
                    return Err(words.fault(what));
                }
            }
            "CELL_DATA" => (of, tuples) = (Of::Others, whole(1)?),
            "SCALARS" => {
                let name = line.get(1).copied().unwrap_or("").to_owned();
                let components = if line.len() > 3 { whole(3)? } else { 1 };
                if words.line().and_then(|line| line.first().copied()) != Some("LOOKUP_TABLE") {
                    return Err(words.fault("SCALARS without a LOOKUP_TABLE"));
                }
                array(&mut words, &mut sheet, of, &name, components, tuples)?;
            }
            "LOOKUP_TABLE" => {
                let count = whole(2)?;
                words.skip(count.saturating_mul(4))?;
            }
            "VECTORS" | "NORMALS" | "TENSORS" => {
                let components = if line[0] == "TENSORS" { 9 } else { 3 };
                let name = line.get(1).copied().unwrap_or("").to_owned();
                array(&mut words, &mut sheet, of, &name, components, tuples)?;
            }
            "FIELD" => {
                for _ in 0..whole(2)? {
                    let head = words.line().unwrap_or_default();
                    if head.first() == Some(&"METADATA") {
                        words.skip_to_empty_line();
                        continue;
                    }
                    let [name, components, count, _] = head[..] else {
                        return Err(words.fault("an array of FIELD has no name, counts and type"));
                    };
                    let parsed = (components.parse::<usize>(), count.parse::<usize>());
                    let (Ok(components), Ok(count)) = parsed else {
                        return Err(words.fault("an array of FIELD has no whole counts"));
                    };
                    let of = if count == tuples { of } else { Of::Others };
                    array(&mut words, &mut sheet, of, name, components, count)?;
                }
            }
            "METADATA" => words.skip_to_empty_line(),
            other => return Err(words.fault(format!("\"{other}\" is not known"))),
        }
    }
    Ok(sheet)
}

fn array(
    words: &mut Words<'_>,
    sheet: &mut Sheet,
    of: Of,
    name: &str,
    components: usize,
    tuples: usize,
) -> Result<(), Fault> {
    let count = tuples.saturating_mul(components);
    if of == Of::Others {
        return words.skip(count);
    }
    let values = words.numbers(count)?;
    add(sheet, name, components.max(1), &values);
    Ok(())
}
