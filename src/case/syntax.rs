//! The text of a case as TOML.

use std::path::Path;

use toml_edit::Document;

use super::problem::{CaseErrors, Problem};

/// One error about a case.
pub(super) fn one(
    path: &Path,
    text: &str,
    span: std::ops::Range<usize>,
    message: String,
    help: &str,
) -> CaseErrors {
    let problem = Problem {
        message,
        help: help.into(),
        span,
        line: 0,
    };
    CaseErrors::new(path, text, vec![problem])
}

/// The document of a text, if it is TOML.
pub(super) fn syntax<'t>(path: &Path, text: &'t str) -> Result<Document<&'t str>, CaseErrors> {
    Document::parse(text).map_err(|error| {
        let message = format!("not TOML: {}", error.message().replace('\n', ", "));
        one(
            path,
            text,
            error.span().unwrap_or(0..0),
            message,
            "see toml.io for the syntax",
        )
    })
}
