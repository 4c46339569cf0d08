//! State files: named arrays with a checksum, in which every native participant keeps what it
//! needs to go on.
//!
//! Layout, all numbers little-endian: the magic `CALCSTAT`, the version as u32, the number of
//! arrays as u32; per array the length of its name as u32, the name, its type as u32 (0 for f64,
//! 1 for u64), its length as u64 and its values; at the end the SHA-256 of all that precedes.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};
use thiserror::Error;

const MAGIC: &[u8; 8] = b"CALCSTAT";
/// Raised with every change of what participants keep, too: a state that lacks something is refused as a whole.
const VERSION: u32 = 4;
const CHECKSUM: usize = 32;
const REALS: u32 = 0;
const COUNTS: u32 = 1;

/// A state file that cannot be written, read or used.
#[derive(Debug, Error)]
pub enum StateFileError {
    /// The operating system refused.
    #[error("state file {path}: {doing}: {cause}")]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried.
        doing: &'static str,
        /// Why it failed.
        #[source]
        cause: io::Error,
    },
    /// The file is of another kind, of another version, cut short or changed.
    #[error("state file {path} is {what}; {}", what.remedy())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        what: StateDamage,
    },
    /// An array that is not there.
    #[error("the state file holds no array of {kind} named `{name}`")]
    Missing {
        /// Name of the array.
        name: String,
        /// Type of the array: `f64` or `u64`.
        kind: &'static str,
    },
    /// An array of another length than the run needs.
    #[error("array `{name}` of the state file has {found} values, the run needs {expected}")]
    Length {
        /// Name of the array.
        name: String,
        /// Values in the file.
        found: usize,
        /// Values that the run needs.
        expected: usize,
    },
}

/// Why bytes are no state file of this version.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum StateDamage {
    /// They begin otherwise.
    #[error("not a state file of Calcine")]
    Foreign,
    /// They end before the content does.
    #[error("cut short")]
    CutShort,
    /// The checksum is that of another content.
    #[error("damaged: its checksum does not fit its content")]
    Checksum,
    /// Another version of the layout.
    #[error(
        "of version {0}, which another release of Calcine wrote; this one reads version {VERSION}"
    )]
    Version(u32),
    /// A name that is not UTF-8.
    #[error("damaged: an array's name is not text")]
    Name,
    /// An array of a type that there is not.
    #[error("damaged: array `{name}` is of type {kind}")]
    Kind {
        /// Its name.
        name: String,
        /// Number of its type.
        kind: u32,
    },
    /// An array longer than this machine can address.
    #[error("too large")]
    TooLarge,
}

impl StateDamage {
    /// What helps.
    fn remedy(&self) -> &'static str {
        match self {
            Self::Version(_) => "resume with the release that wrote it, or start again",
            _ => "resume from an older checkpoint or start again",
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Array {
    Reals(Vec<f64>),
    Counts(Vec<u64>),
}

/// Named arrays, to be written and read bit for bit.
///
/// ```
/// use calcine_coupler::checkpoint::StateFile;
/// let mut state = StateFile::new();
/// state.set_f64s("temperature", &[300.0, 400.0]);
/// assert_eq!(state.f64s("temperature").unwrap(), [300.0, 400.0]);
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StateFile {
    arrays: BTreeMap<String, Array>,
}

impl StateFile {
    /// A state without arrays.
    pub fn new() -> Self {
        Self::default()
    }

    /// Stores an array of reals under a name.
    pub fn set_f64s(&mut self, name: &str, values: &[f64]) {
        self.arrays
            .insert(name.into(), Array::Reals(values.to_vec()));
    }

    /// Stores an array of counts under a name.
    pub fn set_u64s(&mut self, name: &str, values: &[u64]) {
        self.arrays
            .insert(name.into(), Array::Counts(values.to_vec()));
    }

    /// Names of all arrays, in alphabetical order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.arrays.keys().map(String::as_str)
    }

    /// The array of reals of a name.
    pub fn f64s(&self, name: &str) -> Result<&[f64], StateFileError> {
        match self.arrays.get(name) {
            Some(Array::Reals(values)) => Ok(values),
            _ => Err(missing(name, "f64")),
        }
    }

    /// The array of counts of a name.
    pub fn u64s(&self, name: &str) -> Result<&[u64], StateFileError> {
        match self.arrays.get(name) {
            Some(Array::Counts(values)) => Ok(values),
            _ => Err(missing(name, "u64")),
        }
    }

    /// The array of reals of a name, which must have this many values.
    pub fn f64s_of(&self, name: &str, expected: usize) -> Result<&[f64], StateFileError> {
        let values = self.f64s(name)?;
        if values.len() == expected {
            return Ok(values);
        }
        Err(StateFileError::Length {
            name: name.into(),
            found: values.len(),
            expected,
        })
    }

    /// Writes the file: beside it first, flushed to disk, then renamed, so that a file of this
    /// name is whole at any moment.
    pub fn write(&self, path: &Path) -> Result<(), StateFileError> {
        let failed = |doing, cause| StateFileError::Io {
            path: path.to_owned(),
            doing,
            cause,
        };
        let mut name = path.file_name().unwrap_or_default().to_owned();
        name.push(".part");
        let fresh = path.with_file_name(name);
        let mut file = File::create(&fresh).map_err(|cause| failed("creating it", cause))?;
        file.write_all(&self.encode())
            .and_then(|()| file.sync_all())
            .map_err(|cause| failed("writing it", cause))?;
        fs::rename(&fresh, path).map_err(|cause| failed("renaming it", cause))?;
        let folder = match path.parent() {
            Some(parent) if !parent.as_os_str().is_empty() => parent,
            _ => Path::new("."),
        };
        File::open(folder)
            .and_then(|folder| folder.sync_all())
            .map_err(|cause| failed("flushing its folder", cause))
    }

    /// Reads a file and checks it.
    pub fn read(path: &Path) -> Result<Self, StateFileError> {
        let bytes = fs::read(path).map_err(|cause| StateFileError::Io {
            path: path.to_owned(),
            doing: "reading it",
            cause,
        })?;
        Self::decode(&bytes).map_err(|what| StateFileError::Damaged {
            path: path.to_owned(),
            what,
        })
    }

    fn encode(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((self.arrays.len() as u32).to_le_bytes());
        for (name, array) in &self.arrays {
            bytes.extend((name.len() as u32).to_le_bytes());
            bytes.extend(name.as_bytes());
            match array {
                Array::Reals(values) => {
                    bytes.extend(REALS.to_le_bytes());
                    bytes.extend((values.len() as u64).to_le_bytes());
                    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
                }
                Array::Counts(values) => {
                    bytes.extend(COUNTS.to_le_bytes());
                    bytes.extend((values.len() as u64).to_le_bytes());
                    bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
                }
            }
        }
        let checksum = Sha256::digest(&bytes);
        bytes.extend(checksum);
        bytes
    }

    fn decode(bytes: &[u8]) -> Result<Self, StateDamage> {
        if !bytes.starts_with(MAGIC) {
            return Err(StateDamage::Foreign);
        }
        let Some((content, checksum)) = bytes.split_last_chunk::<CHECKSUM>() else {
            return Err(StateDamage::CutShort);
        };
        if Sha256::digest(content)[..] != checksum[..] {
            return Err(StateDamage::Checksum);
        }
        let mut rest = Reader(&content[MAGIC.len()..]);
        let version = rest.count32()?;
        if version != VERSION {
            return Err(StateDamage::Version(version));
        }
        let mut state = Self::new();
        for _ in 0..rest.count32()? {
            let length = rest.count32()? as usize;
            let name = std::str::from_utf8(rest.take(length)?)
                .map_err(|_| StateDamage::Name)?
                .to_owned();
            let kind = rest.count32()?;
            let values = usize::try_from(rest.count64()?).map_err(|_| StateDamage::TooLarge)?;
            let words = rest.take(values.checked_mul(8).ok_or(StateDamage::TooLarge)?)?;
            let words = words.as_chunks::<8>().0.iter().copied();
            let array = match kind {
                REALS => Array::Reals(words.map(f64::from_le_bytes).collect()),
                COUNTS => Array::Counts(words.map(u64::from_le_bytes).collect()),
                kind => return Err(StateDamage::Kind { name, kind }),
            };
            state.arrays.insert(name, array);
        }
        Ok(state)
    }
}

fn missing(name: &str, kind: &'static str) -> StateFileError {
    StateFileError::Missing {
        name: name.into(),
        kind,
    }
}

/// What is left to read.
struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], StateDamage> {
        let (head, tail) = self
            .0
            .split_at_checked(count)
            .ok_or(StateDamage::CutShort)?;
        self.0 = tail;
        Ok(head)
    }

    fn count32(&mut self) -> Result<u32, StateDamage> {
        let (head, tail) = self.0.split_first_chunk().ok_or(StateDamage::CutShort)?;
        self.0 = tail;
        Ok(u32::from_le_bytes(*head))
    }

    fn count64(&mut self) -> Result<u64, StateDamage> {
        let (head, tail) = self.0.split_first_chunk().ok_or(StateDamage::CutShort)?;
        self.0 = tail;
        Ok(u64::from_le_bytes(*head))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn example() -> StateFile {
        let mut state = StateFile::new();
        state.set_f64s("pressure", &[101_325.0, -0.0, f64::MIN_POSITIVE, 0.1]);
        state.set_f64s("empty", &[]);
        state.set_u64s("id", &[1, u64::MAX]);
        state
    }

    #[test]
    fn a_state_comes_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gas.state");
        example().write(&path).unwrap();
        let back = StateFile::read(&path).unwrap();
        let bits = |state: &StateFile| {
            let values = state.f64s_of("pressure", 4).unwrap();
            values.iter().map(|x| x.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(&back), bits(&example()));
        assert_eq!(back.u64s("id").unwrap(), [1, u64::MAX]);
        assert!(back.f64s("empty").unwrap().is_empty());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn one_changed_bit_and_one_lost_byte_are_noticed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gas.state");
        let bytes = example().encode();
        let mut changed = bytes.clone();
        changed[60] ^= 1;
        for (wrong, why) in [
            (&changed[..], StateDamage::Checksum),
            (&bytes[..bytes.len() - 1], StateDamage::Checksum),
            (&bytes[..20], StateDamage::CutShort),
            (b"x", StateDamage::Foreign),
        ] {
            fs::write(&path, wrong).unwrap();
            let error = StateFile::read(&path).unwrap_err();
            let StateFileError::Damaged { what, .. } = error else {
                panic!("{error}");
            };
            assert_eq!(what, why);
        }
    }

    #[test]
    fn a_state_of_another_release_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("gas.state");
        let mut bytes = example().encode();
        bytes.truncate(bytes.len() - CHECKSUM);
        bytes[MAGIC.len()] = 1;
        let checksum = Sha256::digest(&bytes);
        bytes.extend(checksum);
        fs::write(&path, bytes).unwrap();
        let text = StateFile::read(&path).unwrap_err().to_string();
        let told = "gas.state is of version 1, which another release of Calcine wrote; this one reads version 4; resume \
                    with the release that wrote it, or start again";
        assert!(text.ends_with(told), "{text}");
    }

    #[test]
    fn an_array_that_is_missing_or_of_another_length_or_type_is_named() {
        let state = example();
        let text = state.f64s("velocity").unwrap_err().to_string();
        assert_eq!(
            text,
            "the state file holds no array of f64 named `velocity`"
        );
        assert!(state.u64s("pressure").is_err());
        let text = state.f64s_of("pressure", 12).unwrap_err().to_string();
        assert!(text.contains("4 values, the run needs 12"), "{text}");
    }
}
