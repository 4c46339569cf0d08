//! Comma-separated values; the first line names the columns.

use super::{Fault, Row, Sheet, number};

pub(super) fn sheet(text: &str) -> Result<Sheet, Fault> {
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let bare = |word: &str| word.trim().trim_matches('"').to_owned();
    let head: Vec<String> = lines.next().map_or(Vec::new(), |(_, line)| {
        line.trim_start_matches('\u{feff}')
            .split(',')
            .map(|word| bare(word).to_lowercase())
            .collect()
    });
    let mut sheet = Sheet {
        columns: head.into_iter().map(|name| (name, Vec::new())).collect(),
        lines: Vec::new(),
    };
    for (line, content) in lines {
        let words: Vec<&str> = content.split(',').collect();
        if words.len() != sheet.columns.len() {
            let what = format!(
                "there are {} values, but {} columns",
                words.len(),
                sheet.columns.len()
            );
            return Err((Some(Row::Line(line)), what));
        }
        for ((_, column), word) in sheet.columns.iter_mut().zip(words) {
            column.push(number(&bare(word), line)?);
        }
        sheet.lines.push(line);
    }
    Ok(sheet)
}
