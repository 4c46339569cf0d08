//! Errors that show only when mesh and particles are made of a case, at the key that they are about.

use std::fmt;
use std::ops::Range;

use toml_edit::{Document, TableLike};

use super::model::Case;
use super::problem::{CaseErrors, Problem};

/// An error at a dotted key of the case, such as `particles[0].place`, or at the nearest one above it that the file
/// has. What follows the last semicolon of the error is what to do about it.
pub fn located(case: &Case, key: &str, error: &dyn fmt::Display) -> CaseErrors {
    let text = &case.effective;
    let document = Document::parse(text.as_str()).ok();
    let span = document.and_then(|document| span(document.as_table(), key));
    let error = error.to_string();
    let (message, help) = error
        .rsplit_once("; ")
        .unwrap_or((&error, "correct what is stated here, or what it names"));
    let problem = Problem {
        message: message.into(),
        help: help.into(),
        span: span.unwrap_or(0..0),
        line: 0,
    };
    CaseErrors::new(&case.path, text, vec![problem]).numbered(case.lines.clone())
}

/// Where the value of a dotted key stands, or the nearest one above it.
fn span(table: &dyn TableLike, key: &str) -> Option<Range<usize>> {
    let (first, rest) = match key.split_once('.') {
        Some((first, rest)) => (first, Some(rest)),
        None => (key, None),
    };
    let below = |table: Option<&dyn TableLike>| span(table?, rest?);
    let Some((name, index)) = first.strip_suffix(']').and_then(|one| one.split_once('[')) else {
        let item = table.get(first)?;
        return below(item.as_table_like()).or(item.span());
    };
    let (item, index) = (table.get(name)?, index.parse::<usize>().ok()?);
    if let Some(one) = item.as_array_of_tables().and_then(|list| list.get(index)) {
        return below(Some(one)).or(one.span());
    }
    let value = item.as_array().and_then(|list| list.get(index));
    let Some(value) = value else {
        return item.span();
    };
    let inner = value.as_inline_table().map(|table| table as &dyn TableLike);
    below(inner).or(value.span())
}
