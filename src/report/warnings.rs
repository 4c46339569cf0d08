//! What the case was warned of, what was outside the ranges of laws, or did not converge, and the error with which a run ended.

use super::page::{escape, sentence, table};
use crate::results::Summary;

/// Empty where there is nothing to tell.
pub(super) fn render(summary: &Summary) -> String {
    let mut html = summary
        .failure
        .as_ref()
        .map_or_else(String::new, |failure| {
            format!(
                "<p>The run ended with exit code {}: {}</p>",
                failure.code,
                sentence(&failure.message)
            )
        });
    if !summary.case_warnings.is_empty() {
        let lines = summary.case_warnings.iter();
        let lines: Vec<String> = lines
            .map(|one| format!("<li>{}</li>", sentence(one)))
            .collect();
        html.push_str(&format!(
            "<p>Of the case, as <code>calcine check</code> tells them:</p><ul>{}</ul>",
            lines.concat()
        ));
    }
    let rows: Vec<Vec<String>> = summary
        .warnings
        .iter()
        .map(|(name, warning)| {
            vec![
                escape(name),
                format!("{} of {}", warning.windows, summary.windows),
                warning.count.to_string(),
                sentence(&warning.sentence()),
            ]
        })
        .collect();
    html.push_str(&table(&["kind", "#windows", "#count", "worst"], &rows));
    html
}
