//! Errors of case files: all of a file at once, each with its place, rule, value and remedy.

use std::fmt;
use std::ops::Range;
use std::path::{Path, PathBuf};

use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteError,
    MietteSpanContents, NamedSource, SourceCode, SourceSpan, SpanContents,
};

/// One error of a case file.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// What is wrong: rule and value, with the dotted key.
    pub message: String,
    /// What to do.
    pub help: String,
    /// Bytes of the text that it is about.
    pub span: Range<usize>,
    /// Line in the file, from 1.
    pub line: usize,
}

/// All errors of a case file.
#[derive(Clone, Debug)]
pub struct CaseErrors {
    path: PathBuf,
    source: NumberedSource,
    problems: Vec<Problem>,
}

/// A text with `--set` applied, whose lines are shown by their numbers in the file: exact of the line that is pointed at, and of those
/// about it but for lines that `--set` adds among them.
#[derive(Clone, Debug)]
struct NumberedSource {
    text: NamedSource<String>,
    /// The line in the file, from 1, of each line of the text; empty where they are the same.
    lines: Vec<usize>,
}

impl NumberedSource {
    /// The line in the file, from 1, of one of the text, from 1.
    fn line(&self, line: usize) -> usize {
        let beyond = |last: &usize| last + line - self.lines.len();
        let known = self.lines.get(line - 1).copied();
        known.unwrap_or_else(|| self.lines.last().map_or(line, beyond))
    }
}

impl SourceCode for NumberedSource {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        let found = self.text.read_span(span, before, after)?;
        let line = line_of(self.text.inner(), span.offset());
        let moved = self.line(line) as isize - line as isize;
        let name = found.name().unwrap_or_default().to_owned();
        Ok(Box::new(MietteSpanContents::new_named(
            name,
            found.data(),
            *found.span(),
            found.line().saturating_add_signed(moved),
            found.column(),
            found.line_count(),
        )))
    }
}

/// The line, from 1, of a byte.
fn line_of(text: &str, byte: usize) -> usize {
    let before = &text.as_bytes()[..byte.min(text.len())];
    1 + before.iter().filter(|&&b| b == b'\n').count()
}

impl CaseErrors {
    pub(super) fn new(path: &Path, text: &str, mut problems: Vec<Problem>) -> Self {
        for problem in &mut problems {
            problem.span.end = problem.span.end.min(text.len());
            problem.span.start = problem.span.start.min(problem.span.end);
            problem.line = line_of(text, problem.span.start);
        }
        problems.sort_by_key(|problem| problem.span.start);
        let text = NamedSource::new(path.display().to_string(), text.to_owned());
        Self {
            path: path.to_owned(),
            source: NumberedSource {
                text,
                lines: Vec::new(),
            },
            problems,
        }
    }

    /// The same with the line in the file, from 1, of each line of the text.
    pub(super) fn numbered(mut self, lines: Vec<usize>) -> Self {
        self.source.lines = lines;
        for problem in &mut self.problems {
            problem.line = self.source.line(problem.line);
        }
        self
    }

    /// The errors in the order of their places.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// So many errors are shown with their lines: each shows its whole line, which may hold them all.
    const SHOWN: usize = 100;

    /// Length in bytes of the longest line that is shown; nobody reads longer ones.
    const LONGEST_LINE: usize = 1000;

    /// The errors with the lines of the file that they are about; of very many the first ones.
    pub fn render(&self) -> String {
        let handler = GraphicalReportHandler::new_themed(GraphicalTheme::unicode_nocolor());
        let mut text = String::new();
        for problem in self.problems.iter().take(Self::SHOWN) {
            let shown = Shown {
                problem,
                source: &self.source,
            };
            let readable = self.longest_line(problem) <= Self::LONGEST_LINE;
            if !readable || handler.render_report(&mut text, &shown).is_err() {
                let (
                    path,
                    Problem {
                        line,
                        message,
                        help,
                        ..
                    },
                ) = (self.path.display(), problem);
                text.push_str(&format!(
                    "  × {message}\n   at {path}:{line}\n  help: {help}\n\n"
                ));
            }
        }
        let count = self.problems.len();
        let plural = if count == 1 { "error" } else { "errors" };
        text.push_str(&format!("{count} {plural} in {}", self.path.display()));
        text.push_str(match count > Self::SHOWN {
            true => ", of which the first 100 are shown\n",
            false => "\n",
        });
        text
    }
}

impl CaseErrors {
    /// Length in bytes of the longest line that a problem is about.
    fn longest_line(&self, problem: &Problem) -> usize {
        let text = self.source.text.inner().as_bytes();
        let end_of_line = |from: usize| {
            let rest = text[from..].iter().position(|&byte| byte == b'\n');
            rest.map_or(text.len(), |length| from + length)
        };
        let before = text[..problem.span.start]
            .iter()
            .rposition(|&byte| byte == b'\n');
        let start = before.map_or(0, |newline| newline + 1);
        let lines = text[start..end_of_line(problem.span.end)].split(|&byte| byte == b'\n');
        lines.map(<[u8]>::len).max().unwrap_or(0)
    }
}

impl fmt::Display for CaseErrors {
    /// One line an error.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for problem in &self.problems {
            let path = self.path.display();
            writeln!(
                f,
                "{path}:{}: {}; {}",
                problem.line, problem.message, problem.help
            )?;
        }
        Ok(())
    }
}

impl std::error::Error for CaseErrors {}

/// One problem with its source, for miette.
struct Shown<'a> {
    problem: &'a Problem,
    source: &'a NumberedSource,
}

impl fmt::Debug for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(self.problem, f)
    }
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem.message)
    }
}

impl std::error::Error for Shown<'_> {}

impl Diagnostic for Shown<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(&self.problem.help))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self.source)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let span = self.problem.span.clone();
        Some(Box::new(std::iter::once(LabeledSpan::at(span, "here"))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_very_many_errors_the_first_are_shown_and_all_counted() {
        let text = "x\n".repeat(5000);
        let problem = |start: usize| Problem {
            message: "`x` is wrong".into(),
            help: "write y".into(),
            span: 2 * start..2 * start + 1,
            line: 0,
        };
        let errors = CaseErrors::new(
            Path::new("case.toml"),
            &text,
            (0..5000).map(problem).collect(),
        );
        let shown = errors.render();
        assert_eq!(shown.matches("help:").count(), 100);
        assert!(shown.ends_with("5000 errors in case.toml, of which the first 100 are shown\n"));
    }
    #[test]
    fn an_error_in_a_line_of_a_hundred_thousand_letters_is_told_without_the_line() {
        let text = format!("ok = 1\nx = \"{}\"\n", "y".repeat(100_000));
        let problem = Problem {
            message: "`x` is too long".into(),
            help: "shorten it".into(),
            span: 90_000..90_001,
            line: 0,
        };
        let errors = CaseErrors::new(Path::new("case.toml"), &text, vec![problem]);
        let shown = errors.render();
        assert!(shown.contains("× `x` is too long\n   at case.toml:2\n  help: shorten it\n"));
        assert!(shown.len() < 200, "{}", shown.len());
    }
}
