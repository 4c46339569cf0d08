//! Where checkpoints are.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{CWD, RenameFlags, renameat_with};

use super::error::CheckpointError;

/// Where checkpoints are: `checkpoint/` inside the results folder, complete at any moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct CheckpointPaths {
    results: PathBuf,
}

impl CheckpointPaths {
    /// The paths inside a results folder.
    pub fn new(results: &Path) -> Self {
        Self {
            results: results.to_owned(),
        }
    }

    /// The last complete checkpoint, where there is one.
    pub fn committed(&self) -> PathBuf {
        self.results.join("checkpoint")
    }

    /// The one being written.
    pub(super) fn fresh(&self) -> PathBuf {
        self.results.join("checkpoint.part")
    }

    /// Makes the fresh checkpoint the committed one; at no moment is there none.
    pub(super) fn publish(&self) -> Result<(), CheckpointError> {
        let (fresh, committed) = (self.fresh(), self.committed());
        let failed = |doing, cause: io::Error| CheckpointError::Io {
            path: committed.clone(),
            doing,
            cause,
        };
        sync(&fresh).map_err(|cause| failed("flushing it", cause))?;
        if committed.exists() {
            renameat_with(CWD, &fresh, CWD, &committed, RenameFlags::EXCHANGE)
                .map_err(|cause| failed("exchanging it with the last one", cause.into()))?;
            fs::remove_dir_all(&fresh).map_err(|cause| failed("removing the last one", cause))?;
        } else {
            fs::rename(&fresh, &committed).map_err(|cause| failed("renaming it", cause))?;
        }
        sync(&self.results).map_err(|cause| failed("flushing its folder", cause))
    }
}

/// Flushes the entries of a folder to disk.
fn sync(directory: &Path) -> io::Result<()> {
    fs::File::open(directory)?.sync_all()
}
