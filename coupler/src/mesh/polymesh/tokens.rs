//! The lexical side of OpenFOAM's files: blanks, comments, words, numbers, the header, raw blocks.

use std::path::Path;

use super::error::PolyMeshError;

/// A place in a file's bytes.
pub(super) struct Scanner<'a> {
    file: &'a Path,
    bytes: &'a [u8],
    at: usize,
}

/// What a file's header says about the rest.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Header {
    /// Class of the object, for example `faceCompactList`.
    pub class: String,
    /// Whether lists are raw bytes.
    pub binary: bool,
    /// Bytes of a label, 4 or 8.
    pub label: usize,
    /// Bytes of a scalar, 4 or 8.
    pub scalar: usize,
}

impl<'a> Scanner<'a> {
    pub fn new(file: &'a Path, bytes: &'a [u8]) -> Self {
        Self { file, bytes, at: 0 }
    }

    /// Bytes not yet read: a bound for every list that stores its entries.
    pub fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    /// An error at the current line.
    pub fn error(&self, message: impl Into<String>) -> PolyMeshError {
        let before = &self.bytes[..self.at];
        PolyMeshError::Syntax {
            file: self.file.to_path_buf(),
            line: 1 + before.iter().filter(|&&byte| byte == b'\n').count(),
            message: message.into(),
        }
    }

    /// Skips blanks and comments; the next byte, if there is one.
    pub fn peek(&mut self) -> Result<Option<u8>, PolyMeshError> {
        loop {
            match self.bytes[self.at..] {
                [b'/', b'/', ref rest @ ..] => {
                    let line = rest.iter().position(|&byte| byte == b'\n');
                    self.at += 2 + line.unwrap_or(rest.len());
                }
                [b'/', b'*', ref rest @ ..] => {
                    let Some(end) = rest.windows(2).position(|pair| pair == b"*/") else {
                        return Err(self.error("a comment `/*` without its end `*/`"));
                    };
                    self.at += 4 + end;
                }
                [byte, ..] if byte.is_ascii_whitespace() => self.at += 1,
                [byte, ..] => return Ok(Some(byte)),
                [] => return Ok(None),
            }
        }
    }

    /// Whether the next byte is this one; it is then consumed.
    pub fn take(&mut self, wanted: u8) -> Result<bool, PolyMeshError> {
        let found = self.peek()? == Some(wanted);
        self.at += usize::from(found);
        Ok(found)
    }

    /// Consumes this byte or fails.
    pub fn expect(&mut self, wanted: u8) -> Result<(), PolyMeshError> {
        if self.take(wanted)? {
            return Ok(());
        }
        let found = self.describe_next();
        Err(self.error(format!("expected `{}`, found {found}", wanted as char)))
    }

    fn describe_next(&self) -> String {
        match self.bytes.get(self.at) {
            Some(&byte) => format!("`{}`", byte.escape_ascii()),
            None => "the end of the file".into(),
        }
    }

    /// A word: a run of bytes up to a blank or punctuation, or a quoted string.
    pub fn word(&mut self, what: &str) -> Result<String, PolyMeshError> {
        if self.take(b'"')? {
            let rest = &self.bytes[self.at..];
            let Some(end) = rest.iter().position(|&byte| byte == b'"') else {
                return Err(self.error("a string without its closing quote"));
            };
            self.at += end + 1;
            return Ok(String::from_utf8_lossy(&rest[..end]).into_owned());
        }
        let rest = &self.bytes[self.at..];
        let ends = |byte: &u8| byte.is_ascii_whitespace() || b"(){};\"".contains(byte);
        let length = rest.iter().position(ends).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.error(format!("expected {what}, found {}", self.describe_next())));
        }
        self.at += length;
        Ok(String::from_utf8_lossy(&rest[..length]).into_owned())
    }

    /// A number of the type asked for.
    pub fn number<T: std::str::FromStr>(&mut self, what: &str) -> Result<T, PolyMeshError> {
        self.peek()?;
        let start = self.at;
        let word = self.word(what)?;
        word.parse().map_err(|_| {
            self.at = start;
            self.error(format!("expected {what}, found `{word}`"))
        })
    }

    /// `count` raw bytes between parentheses, the opening one already consumed.
    pub fn raw(&mut self, count: Option<usize>) -> Result<&'a [u8], PolyMeshError> {
        let block = count.and_then(|count| self.bytes[self.at..].get(..count));
        let Some(block) = block else {
            return Err(self.error("the file ends within a binary list"));
        };
        self.at += block.len();
        self.expect(b')')?;
        Ok(block)
    }

    /// A dictionary's entry after its key: the first word of its value, up to and with `;`, or a
    /// nested dictionary, which is passed over.
    pub fn entry(&mut self) -> Result<Option<String>, PolyMeshError> {
        let first = match self.peek()? {
            Some(b'{' | b'(' | b';') => None,
            _ => Some(self.word("a value")?),
        };
        let mut depth = 0usize;
        loop {
            match self.peek()? {
                None => return Err(self.error("the file ends within an entry")),
                Some(b'{' | b'(') => depth += 1,
                Some(b')') => depth = depth.saturating_sub(1),
                Some(b'}') if depth <= 1 => {
                    if depth == 1 {
                        self.at += 1;
                        return Ok(first);
                    }
                    return Err(self.error("an entry without its `;`"));
                }
                Some(b'}') => depth -= 1,
                Some(b';') if depth == 0 => {
                    self.at += 1;
                    return Ok(first);
                }
                Some(b';') => {}
                Some(_) => {
                    self.word("a value")?;
                    continue;
                }
            }
            self.at += 1;
        }
    }

    /// The `FoamFile` dictionary at the beginning.
    pub fn header(&mut self) -> Result<Header, PolyMeshError> {
        let word = self.word("the header `FoamFile`")?;
        if word != "FoamFile" {
            return Err(self.error(format!("expected the header `FoamFile`, found `{word}`")));
        }
        self.expect(b'{')?;
        let mut header = Header {
            class: String::new(),
            binary: false,
            label: 4,
            scalar: 8,
        };
        while !self.take(b'}')? {
            let key = self.word("a key of the header")?;
            let value = self.entry()?.unwrap_or_default();
            match key.as_str() {
                "class" => header.class = value,
                "format" if value == "binary" => header.binary = true,
                "format" if value != "ascii" => {
                    return Err(self.error(format!(
                        "the format is `{value}`; only `ascii` and `binary` are known"
                    )));
                }
                "arch" => self.architecture(&value, &mut header)?,
                _ => {}
            }
        }
        Ok(header)
    }

    /// Sizes from a header's `arch`, for example `LSB;label=32;scalar=64`.
    fn architecture(&self, text: &str, header: &mut Header) -> Result<(), PolyMeshError> {
        for part in text.split(';') {
            match part.trim() {
                "LSB" => {}
                "label=32" => header.label = 4,
                "label=64" => header.label = 8,
                "scalar=32" => header.scalar = 4,
                "scalar=64" => header.scalar = 8,
                other => {
                    return Err(self.error(format!(
                        "the architecture has `{other}`; LSB with labels and scalars of 32 or 64 \
                         bit can be read"
                    )));
                }
            }
        }
        Ok(())
    }
}
