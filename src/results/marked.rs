//! Tables that grow by rows, and how far they were when a checkpoint was written.

use std::fs::{self, File, OpenOptions};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::ResultsError;
use crate::hex::hex;

/// How far a file was when a checkpoint was written.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct FileMark {
    /// Its length in bytes.
    pub bytes: u64,
    /// SHA-256 of these bytes in hexadecimal digits.
    pub sha256: String,
}

impl FileMark {
    /// Refuses a file that does not begin with what it was.
    pub fn check(&self, path: &Path) -> Result<(), ResultsError> {
        if !path.is_file() {
            let fact = "it is missing, but the checkpoint counts on it";
            return Err(ResultsError::behind(path, fact));
        }
        let text = fs::read(path).map_err(ResultsError::file("read", path))?;
        let begin = usize::try_from(self.bytes)
            .ok()
            .and_then(|bytes| text.get(..bytes))
            .ok_or_else(|| {
                let fact = format!("it has {} bytes in place of {}", text.len(), self.bytes);
                ResultsError::behind(path, fact)
            })?;
        match hex(Sha256::new_with_prefix(begin).finalize()) == self.sha256 {
            true => Ok(()),
            false => Err(ResultsError::behind(path, "what was in it is changed")),
        }
    }

    /// Cuts a file that has gone on back to what it was.
    pub fn cut(&self, path: &Path) -> Result<(), ResultsError> {
        let file = OpenOptions::new().write(true).open(path);
        file.and_then(|file| file.set_len(self.bytes))
            .map_err(ResultsError::file("cut", path))
    }
}

/// A file that is appended to.
pub(crate) struct MarkedFile {
    path: PathBuf,
    file: BufWriter<File>,
    bytes: u64,
    hasher: Sha256,
}

impl MarkedFile {
    /// Begins a file.
    pub fn create(path: PathBuf) -> Result<Self, ResultsError> {
        let file = File::create(&path).map_err(ResultsError::file("create", &path))?;
        Ok(Self {
            path,
            file: BufWriter::new(file),
            bytes: 0,
            hasher: Sha256::new(),
        })
    }

    /// Goes on with a file that holds this.
    pub fn resume(path: PathBuf, text: &str) -> Result<Self, ResultsError> {
        let file = OpenOptions::new()
            .append(true)
            .open(&path)
            .map_err(ResultsError::file("open", &path))?;
        Ok(Self {
            path,
            file: BufWriter::new(file),
            bytes: text.len() as u64,
            hasher: Sha256::new_with_prefix(text),
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Flushes the file to the disk; gives how far it is.
    pub fn mark(&mut self) -> Result<FileMark, ResultsError> {
        self.flush()?;
        let file = self.file.get_ref();
        file.sync_data()
            .map_err(ResultsError::file("flush", &self.path))?;
        Ok(FileMark {
            bytes: self.bytes,
            sha256: hex(self.hasher.clone().finalize()),
        })
    }

    /// Hands what is buffered to the operating system.
    pub fn flush(&mut self) -> Result<(), ResultsError> {
        self.file
            .flush()
            .map_err(ResultsError::file("write", &self.path))
    }

    /// Appends bytes.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), ResultsError> {
        self.bytes += bytes.len() as u64;
        self.hasher.update(bytes);
        self.file
            .write_all(bytes)
            .map_err(ResultsError::file("write", &self.path))
    }
}
