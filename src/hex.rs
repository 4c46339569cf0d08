//! Bytes in words.

/// Bytes in hexadecimal digits, as SHA-256 sums are written.
pub(crate) fn hex(bytes: impl AsRef<[u8]>) -> String {
    let digits = bytes.as_ref().iter().map(|byte| format!("{byte:02x}"));
    digits.collect()
}
