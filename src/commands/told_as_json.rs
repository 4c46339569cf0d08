//! The end of a run as one line of JSON.

use std::fs;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use super::failure::Failure;
use crate::exit;
use crate::results::files;

/// What `calcine run --json` prints.
#[derive(Debug, Serialize)]
struct End<'a> {
    exit_code: u8,
    /// None of a run whose case or command line was refused.
    out: Option<&'a Path>,
    /// Of a complete run.
    report: Option<&'a Path>,
    /// `summary.json`, where the run wrote one.
    summary: Value,
    /// What standard error tells of a run that failed.
    error: Option<&'a str>,
}

/// The line of a run in a results folder that ends with an exit code.
pub(super) fn line(code: u8, out: &Path, report: Option<&Path>) -> Result<String, Failure> {
    let path = out.join(files::SUMMARY);
    let unread = |cause: &dyn std::fmt::Display| {
        let message = format!("{} cannot be read: {cause}", path.display());
        Failure::new(exit::OTHER, message)
    };
    let text = fs::read_to_string(&path).map_err(|cause| unread(&cause))?;
    let end = End {
        exit_code: code,
        out: Some(out),
        report,
        summary: serde_json::from_str(&text).map_err(|cause| unread(&cause))?,
        error: None,
    };
    serde_json::to_string(&end).map_err(|cause| unread(&cause))
}

/// The line of a run that failed.
pub(super) fn failed(failure: &Failure) -> Result<String, Failure> {
    let out = failure.out.as_deref();
    // The folder of a run that was refused may have the summary of another one.
    let own = out.filter(|_| failure.code != exit::CASE);
    let text = own.and_then(|out| fs::read_to_string(out.join(files::SUMMARY)).ok());
    let summary = text.and_then(|text| serde_json::from_str(&text).ok());
    let end = End {
        exit_code: failure.code,
        out,
        report: None,
        summary: summary.unwrap_or_default(),
        error: Some(failure.message.trim_end()),
    };
    serde_json::to_string(&end)
        .map_err(|cause| Failure::new(failure.code, format!("the end of the run: {cause}")))
}
