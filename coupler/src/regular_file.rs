//! Input files are read several times: what can be read once is none.

use std::fs;
use std::io;
use std::path::Path;

/// Reads a file that is no pipe and no device. To wait for a pipe would be to wait for ever.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let kind = fs::metadata(path)?.file_type();
    if kind.is_file() || kind.is_dir() {
        return fs::read(path);
    }
    Err(io::Error::other(
        "it is a pipe or a device, and input files are read more than once; write it to a file",
    ))
}

/// The same of a text in UTF-8.
pub fn read_to_string(path: &Path) -> io::Result<String> {
    String::from_utf8(read(path)?)
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}
