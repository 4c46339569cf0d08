//! Harm to the files of a checkpoint, as a failing disk or a careless hand does it.

#![allow(clippy::unwrap_used)]

use std::fs::{self, OpenOptions};
use std::os::unix::fs::FileExt as _;
use std::path::{Path, PathBuf};

/// What is done to one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Harm {
    /// Cut to this share of its length, in thousandths.
    Truncated(u64),
    /// One bit of the byte at this share of its length changed, in thousandths.
    Flipped(u64),
    /// Removed.
    Removed,
}

impl Harm {
    /// Does it to the n-th file of a folder, counted around; which that is.
    pub fn to_one_of(self, folder: &Path, number: u64) -> PathBuf {
        let mut files = Vec::new();
        let mut folders = vec![folder.to_owned()];
        while let Some(inner) = folders.pop() {
            for entry in fs::read_dir(inner).unwrap() {
                let path = entry.unwrap().path();
                match path.is_dir() {
                    true => folders.push(path),
                    // An empty file has nothing to lose but itself.
                    false if fs::metadata(&path).unwrap().len() == 0 => {}
                    false => files.push(path),
                }
            }
        }
        files.sort();
        let path = files.swap_remove(usize::try_from(number).unwrap() % files.len());
        let length = fs::metadata(&path).unwrap().len();
        let at = |share: u64| length * share.min(999) / 1000;
        match self {
            Self::Removed => fs::remove_file(&path).unwrap(),
            Self::Truncated(share) => {
                let file = OpenOptions::new().write(true).open(&path).unwrap();
                file.set_len(at(share)).unwrap();
            }
            Self::Flipped(share) => {
                let file = OpenOptions::new().read(true).write(true).open(&path);
                let (file, mut byte) = (file.unwrap(), [0]);
                file.read_exact_at(&mut byte, at(share)).unwrap();
                byte[0] ^= 1 << (share % 8);
                file.write_all_at(&byte, at(share)).unwrap();
            }
        }
        path
    }
}
