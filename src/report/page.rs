//! The shell of a page: styles, headings, tables, tiles. Nothing is loaded from elsewhere.

use std::fmt::Write as _;

use crate::results::Verdict;

const STYLE: &str = include_str!("style.css");
/// Rows of a table as blocks.
const STACKED: &str = include_str!("stacked.css");

/// Width in px below which rows of every table with three columns and more are blocks.
const NARROW: usize = 700;

/// Text made safe for HTML and SVG.
pub(crate) fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            _ => safe.push(c),
        }
    }
    safe
}

/// A sentence made safe for HTML, with what stands between backticks as code.
pub(crate) fn sentence(text: &str) -> String {
    let mut html = String::with_capacity(text.len());
    let mut parts = text.split('`').peekable();
    let mut code = false;
    while let Some(part) = parts.next() {
        // A backtick without a second one is itself.
        let closed = parts.peek().is_some();
        match code {
            true if closed => html.push_str(&format!("<code>{}</code>", escape(part))),
            true => html.push_str(&format!("`{}", escape(part))),
            false => html.push_str(&escape(part)),
        }
        code = !code;
    }
    html
}

/// A page in the making.
pub(crate) struct Page {
    body: String,
    title: String,
    styles: String,
    scripts: String,
}

impl Page {
    /// A page with its title, a line above it, and a badge.
    pub fn new(kicker: &str, title: &str, badge: &str) -> Self {
        let body = format!(
            "<header><p class=\"kicker\">{}</p><h1>{}{badge}</h1></header>",
            escape(kicker),
            escape(title)
        );
        Self {
            body,
            title: title.into(),
            styles: STYLE.into(),
            scripts: String::new(),
        }
    }

    /// A section with a heading and a sentence (both plain text) over its content (HTML).
    pub fn section(&mut self, heading: &str, sentence: &str, content: &str) {
        if content.is_empty() {
            return;
        }
        // Writing to a String cannot fail.
        let _ = write!(self.body, "<section><h2>{}</h2>", escape(heading));
        if !sentence.is_empty() {
            let _ = write!(self.body, "<p class=\"note\">{}</p>", escape(sentence));
        }
        let _ = write!(self.body, "{content}</section>");
    }

    /// Content outside sections, as HTML.
    pub fn raw(&mut self, content: &str) {
        self.body.push_str(content);
    }

    /// Styles and a script of what the page holds.
    pub fn adds(&mut self, styles: &str, script: &str) {
        self.styles.push_str(styles);
        // Writing to a String cannot fail.
        let _ = write!(self.scripts, "<script>{script}</script>");
    }

    /// The whole page.
    pub fn finish(self, footer: &str) -> String {
        format!(
            "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\
             <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
             <title>{}</title><style>{}@media(max-width:{NARROW}px){{{STACKED}}}</style></head><body><main>{}\
             <footer>{}</footer></main>{}</body></html>\n",
            escape(&self.title),
            self.styles,
            self.body,
            escape(footer),
            self.scripts
        )
    }
}

/// A coloured word.
pub(crate) fn badge(verdict: Verdict) -> String {
    let text = match verdict {
        Verdict::Running => "running",
        Verdict::Stopped => "stopped early",
        Verdict::Pass => "inside its bands",
        Verdict::Fail => "outside its bands",
        Verdict::None => "finished",
    };
    format!("<span class=\"badge {}\">{text}</span>", verdict.word())
}

/// Large figures with a word each.
pub(crate) fn tiles(entries: &[(&str, String, String)]) -> String {
    let tiles: String = entries
        .iter()
        .map(|(label, value, detail)| {
            format!(
                "<div class=\"tile\"><span>{}</span><b>{}</b><small>{}</small></div>",
                escape(label),
                escape(value),
                escape(detail)
            )
        })
        .collect();
    format!("<div class=\"tiles\">{tiles}</div>")
}

/// A table; columns whose heading begins with `#` hold figures and are set to the right. Cells are
/// HTML. On narrow screens each row of three columns and more is a block with a line for each cell.
pub(crate) fn table(head: &[&str], rows: &[Vec<String>]) -> String {
    match head.len() {
        _ if rows.is_empty() => String::new(),
        0..=2 => labelled_table(head, rows, false),
        _ => format!(
            "<div class=\"stack\">{}</div>",
            labelled_table(head, rows, true)
        ),
    }
}

/// Width of a column of a table that is not stacked, about, in px.
const COLUMN: usize = 112;

/// The same; where it is wider than the screen or the paper, each row is a block with a line for each cell.
pub(crate) fn stacked_table(head: &[&str], rows: &[Vec<String>]) -> String {
    let width = COLUMN * head.len();
    format!(
        "<style>@media(max-width:{width}px){{{STACKED}}}</style><div class=\"stack\">{}</div>",
        labelled_table(head, rows, true)
    )
}

/// A table, and with labels each cell knows its heading.
fn labelled_table(head: &[&str], rows: &[Vec<String>], labels: bool) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let class = |place: usize| match head.get(place) {
        Some(name) if name.starts_with('#') => " class=\"n\"",
        _ => "",
    };
    let mut html = String::from("<div class=\"scroll\"><table>");
    if head.iter().any(|name| !name.is_empty()) {
        html.push_str("<thead><tr>");
        for (place, name) in head.iter().enumerate() {
            let _ = write!(
                html,
                "<th{}>{}</th>",
                class(place),
                escape(name.trim_start_matches('#'))
            );
        }
        html.push_str("</tr></thead>");
    }
    html.push_str("<tbody>");
    for row in rows {
        html.push_str("<tr>");
        for (place, cell) in row.iter().enumerate() {
            let label = match head.get(place) {
                Some(name) if labels => {
                    format!(" data-label=\"{}\"", escape(name.trim_start_matches('#')))
                }
                _ => String::new(),
            };
            let _ = write!(html, "<td{}{label}>{cell}</td>", class(place));
        }
        html.push_str("</tr>");
    }
    html.push_str("</tbody></table></div>");
    html
}

/// Horizontal bars: name, value, text beside it.
pub(crate) fn bars(entries: &[(&str, f64, String)]) -> String {
    let longest = entries
        .iter()
        .map(|entry| entry.1)
        .fold(f64::MIN_POSITIVE, f64::max);
    let rows: String = entries
        .iter()
        .map(|(name, value, text)| {
            format!(
                "<div class=\"bar\"><span>{}</span><div><i style=\"width:{:.2}%\"></i></div>\
                 <em>{}</em></div>",
                escape(name),
                100.0 * value / longest,
                escape(text)
            )
        })
        .collect();
    format!("<div class=\"bars\">{rows}</div>")
}

#[cfg(test)]
mod tests {
    use super::sentence;

    #[test]
    fn words_between_backticks_are_code() {
        assert_eq!(
            sentence("a < b of `x & y`; `z`"),
            "a &lt; b of <code>x &amp; y</code>; <code>z</code>"
        );
        assert_eq!(sentence("a lone ` stays"), "a lone ` stays");
        assert_eq!(sentence("`a` and `b"), "<code>a</code> and `b");
    }
}
