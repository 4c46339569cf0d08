//! Reads dictionaries of OpenFOAM as far as their structure goes: keywords, values, dictionaries within, and lines.
//!
//! Directives (`#include`, `#calc` …) and variables stay as they stand; what they bring is not known here.

use std::iter::Peekable;
use std::vec::IntoIter;

/// A dictionary, or a file of one.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Dictionary {
    entries: Vec<Entry>,
    /// True where a directive may bring entries that do not stand in the text.
    open: bool,
}

/// An entry of a dictionary.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// Its keyword.
    pub keyword: String,
    /// The line of the keyword, from 1.
    pub line: usize,
    /// What it states.
    pub value: Value,
}

/// What an entry states.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// Words up to the semicolon.
    Words(Vec<String>),
    /// A dictionary.
    Dictionary(Dictionary),
}

/// Dictionaries within each other at most.
const DEEPEST: usize = 64;

/// Where a text is no dictionary, and why.
pub(super) type Fault = (usize, String);

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Open(char),
    Close(char),
    Semicolon,
    Word(String),
    /// `#include`, `#eval` … without what follows.
    Directive,
}

impl Dictionary {
    /// Reads a text.
    pub fn parse(text: &str) -> Result<Self, Fault> {
        let mut tokens = tokens(text)?.into_iter().peekable();
        dictionary(&mut tokens, None, 0)
    }

    /// The entry of a keyword: the last one, as OpenFOAM takes it.
    pub fn entry(&self, keyword: &str) -> Option<&Entry> {
        self.entries.iter().rfind(|entry| entry.keyword == keyword)
    }

    /// The dictionary of a keyword, with its line.
    pub fn dictionary(&self, keyword: &str) -> Option<(&Dictionary, usize)> {
        let entry = self.entry(keyword)?;
        match &entry.value {
            Value::Dictionary(inner) => Some((inner, entry.line)),
            Value::Words(_) => None,
        }
    }

    /// Its entries.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// True where a keyword is neither there nor brought by a directive.
    pub fn lacks(&self, keyword: &str) -> bool {
        !self.open && self.entry(keyword).is_none()
    }
}

/// Entries up to the brace that closes them, or the end of the file; `opened`: the line of the
/// brace that is open, one of `depth`.
fn dictionary(
    tokens: &mut Peekable<IntoIter<(usize, Token)>>,
    opened: Option<usize>,
    depth: usize,
) -> Result<Dictionary, Fault> {
    let mut found = Dictionary::default();
    if let Some(line) = opened.filter(|_| depth > DEEPEST) {
        let what = format!("dictionaries are nested more than {DEEPEST} deep");
        return Err((line, what));
    }
    loop {
        let Some((line, token)) = tokens.next() else {
            return match opened {
                None => Ok(found),
                Some(line) => Err((line, "the brace that opens here is never closed".into())),
            };
        };
        match token {
            Token::Close('}') if opened.is_some() => return Ok(found),
            Token::Close(bracket) => {
                return Err((line, format!("`{bracket}` closes nothing")));
            }
            Token::Directive => {
                found.open = true;
                pass_over(tokens, line)?;
            }
            // OpenFOAM passes over it.
            Token::Semicolon => {}
            // A list or a dictionary without a keyword, as files of lists have them.
            Token::Open(bracket) => {
                list(tokens, bracket, line)?;
            }
            Token::Word(keyword) => {
                let value = value(tokens, &keyword, line, depth)?;
                // A variable alone brings what it stands for.
                found.open |= keyword.starts_with('$');
                found.entries.push(Entry {
                    keyword,
                    line,
                    value,
                });
            }
        }
    }
}

/// What a directive in the place of a keyword takes: the rest of its line, with the lists that begin there.
fn pass_over(tokens: &mut Peekable<IntoIter<(usize, Token)>>, line: usize) -> Result<(), Fault> {
    while let Some((at, token)) = tokens.peek() {
        if *at != line || matches!(token, Token::Close(_)) {
            break;
        }
        let opened = match token {
            Token::Open(bracket) => Some(*bracket),
            _ => None,
        };
        tokens.next();
        if let Some(bracket) = opened {
            list(tokens, bracket, line)?;
        }
    }
    Ok(())
}

fn value(
    tokens: &mut Peekable<IntoIter<(usize, Token)>>,
    keyword: &str,
    line: usize,
    depth: usize,
) -> Result<Value, Fault> {
    let mut words = Vec::new();
    loop {
        let unended = || (line, format!("`{keyword}` is not ended by a semicolon"));
        match tokens.peek() {
            None | Some((_, Token::Close(_))) => return Err(unended()),
            Some(_) => {}
        }
        let Some((at, token)) = tokens.next() else {
            return Err(unended());
        };
        match token {
            Token::Semicolon => return Ok(Value::Words(words)),
            Token::Open('{') if words.is_empty() => {
                return dictionary(tokens, Some(at), depth + 1).map(Value::Dictionary);
            }
            Token::Open(bracket) => words.extend(list(tokens, bracket, at)?),
            Token::Word(word) => words.push(word),
            Token::Directive => words.push("#".into()),
            Token::Close(_) => return Err(unended()),
        }
    }
}

/// The words of a list, whatever is nested in it.
fn list(
    tokens: &mut Peekable<IntoIter<(usize, Token)>>,
    bracket: char,
    line: usize,
) -> Result<Vec<String>, Fault> {
    let mut open = vec![(bracket, line)];
    let mut words = Vec::new();
    while let Some(&(bracket, line)) = open.last() {
        let Some((at, token)) = tokens.next() else {
            return Err((
                line,
                format!("the `{bracket}` that opens here is never closed"),
            ));
        };
        match token {
            Token::Open(bracket) => open.push((bracket, at)),
            Token::Close(closing) if closing == partner(bracket) => {
                open.pop();
            }
            Token::Close(closing) => {
                let what = format!("`{closing}` does not close the `{bracket}` of line {line}");
                return Err((at, what));
            }
            Token::Word(word) => words.push(word),
            Token::Semicolon | Token::Directive => {}
        }
    }
    Ok(words)
}

fn partner(bracket: char) -> char {
    match bracket {
        '{' => '}',
        '(' => ')',
        _ => ']',
    }
}

fn tokens(text: &str) -> Result<Vec<(usize, Token)>, Fault> {
    let mut found = Vec::new();
    let (mut rest, mut line) = (text, 1);
    while let Some(first) = rest.chars().next() {
        let (length, token) = match first {
            _ if rest.starts_with("//") => (rest.find('\n').unwrap_or(rest.len()), None),
            _ if rest.starts_with("/*") => (until(rest, "*/", line, "comment")?, None),
            _ if rest.starts_with("#{") => (
                until(rest, "#}", line, "code")?,
                Some(Token::Word("#{".into())),
            ),
            '#' => {
                let name = rest[1..].find(|letter: char| !letter.is_ascii_alphanumeric());
                (1 + name.unwrap_or(rest.len() - 1), Some(Token::Directive))
            }
            _ if rest.starts_with("${") => {
                let length = rest.find('}').map(|at| at + 1);
                let length = length.ok_or((line, "a `${` is never closed".to_owned()))?;
                (length, Some(Token::Word(rest[..length].into())))
            }
            '"' => {
                let length = quoted(rest).ok_or((line, "a quote is never closed".to_owned()))?;
                (
                    length,
                    Some(Token::Word(rest[..length].trim_matches('"').into())),
                )
            }
            '{' | '(' | '[' => (1, Some(Token::Open(first))),
            '}' | ')' | ']' => (1, Some(Token::Close(first))),
            ';' => (1, Some(Token::Semicolon)),
            _ if first.is_whitespace() => (first.len_utf8(), None),
            _ => {
                let length = word(rest);
                (length, Some(Token::Word(rest[..length].into())))
            }
        };
        if let Some(token) = token {
            found.push((line, token));
        }
        line += rest[..length].matches('\n').count();
        rest = &rest[length..];
    }
    Ok(found)
}

fn until(rest: &str, end: &str, line: usize, what: &str) -> Result<usize, Fault> {
    let found = rest[2..].find(end);
    let fault = || (line, format!("the {what} that begins here is never closed"));
    found.map(|length| length + 2 + end.len()).ok_or_else(fault)
}

/// Length of a text in quotes, quotes included.
fn quoted(rest: &str) -> Option<usize> {
    let mut escaped = false;
    for (at, letter) in rest.char_indices().skip(1) {
        match letter {
            '"' if !escaped => return Some(at + 1),
            _ => escaped = letter == '\\' && !escaped,
        }
    }
    None
}

/// Length of a word: names such as `div(phi,U)` and `interpolate(HbyA)` have parentheses in balance.
fn word(rest: &str) -> usize {
    let mut depth = 0;
    for (at, letter) in rest.char_indices() {
        match letter {
            '(' if at > 0 => depth += 1,
            ')' if depth > 0 => depth -= 1,
            '(' | ')' | '[' | ']' | '{' | '}' | ';' | '"' => return at,
            _ if letter.is_whitespace() && depth == 0 => return at,
            // A list that follows a word, as in `List<vector> 3((0 0 0) …)`.
            _ if letter.is_whitespace() => return rest.find('(').unwrap_or(at),
            _ => {}
        }
    }
    rest.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_openfoam_writes_is_read() {
        let inline = "a uniform #eval \"0.002*2\";\nb #eval{ 0.002*2 };\nc #calc \"$a\";\nd { ${U}; relTol 0; }\n#ifeq 1 2\ne 1;\n#endif\n\
                      #remove (a b)\n#inputMode merge;\n";
        let read = Dictionary::parse(inline).unwrap();
        let keywords: Vec<&str> = read.entries().iter().map(|entry| &*entry.keyword).collect();
        assert_eq!(keywords, ["a", "b", "c", "d", "e"]);
        let text = "/* head\n */\nFoamFile { version 2.0; }\n#include \"more\"\nsolvers\n{\n    \"(U|h).*\" { tolerance 1e-6; }\n}\n\
                    dimensions [0 1 -1 0 0 0 0];\ninternalField nonuniform List<vector> 2((0 0 0) (1 2 3));\n\
                    div(phi,U) Gauss linear; // end\ncode #{ if (a) { b; } #};\nA (x { y 1; } z);\n";
        let read = Dictionary::parse(text).unwrap();
        let (solvers, line) = read.dictionary("solvers").unwrap();
        assert_eq!(
            (line, solvers.entries()[0].keyword.as_str()),
            (5, "(U|h).*")
        );
        let entry = read.entry("div(phi,U)").unwrap();
        assert_eq!(
            entry.value,
            Value::Words(vec!["Gauss".into(), "linear".into()])
        );
        assert_eq!(entry.line, 11);
        assert!(!read.lacks("anything"), "an include may bring it");
        assert!(solvers.lacks("p"));
    }

    #[test]
    fn faults_have_their_lines() {
        for (text, line, told) in [
            ("a { b 1;\n", 1, "never closed"),
            ("a 1;\n}\n", 2, "closes nothing"),
            ("a { b 1 }\n", 1, "`b` is not ended by a semicolon"),
            ("a\n1", 1, "`a` is not ended by a semicolon"),
            ("a (1 2;\nb 3;\n", 1, "never closed"),
            ("a (1 2};\n", 1, "does not close"),
            ("\n/* a", 2, "never closed"),
            (&"a{".repeat(5000), 1, "more than 64 deep"),
            ("a \"b;\n", 1, "quote is never closed"),
        ] {
            let (at, what) = Dictionary::parse(text).unwrap_err();
            assert!(at == line && what.contains(told), "{text}: {at} {what}");
        }
    }
}
