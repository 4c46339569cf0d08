//! Where checkpoints are, and which of them is whole.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{CWD, RenameFlags, renameat_with};

use super::checkpoint_sums::{OWN, damage, seal};
use super::error::CheckpointError;

/// Where checkpoints are: `checkpoint` inside the results folder, and the one before it as `checkpoint.before`; complete at any
/// moment.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CheckpointPaths {
    results: PathBuf,
    /// Name of the file that every checkpoint has.
    own: &'static str,
}

impl Default for CheckpointPaths {
    fn default() -> Self {
        Self::new(Path::new(""))
    }
}

/// A checkpoint that a run may go on from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WholeCheckpoint {
    /// Its folder.
    pub path: PathBuf,
    /// What is wrong with the newer one, where this is the one before.
    pub damage: Option<String>,
}

impl CheckpointPaths {
    /// The paths inside a results folder.
    pub fn new(results: &Path) -> Self {
        Self::of(results, OWN)
    }

    /// The same of checkpoints that have another file in place of the coordinator's state.
    pub fn of(results: &Path, own: &'static str) -> Self {
        Self {
            results: results.to_owned(),
            own,
        }
    }

    /// The last complete checkpoint, where there is one.
    pub fn committed(&self) -> PathBuf {
        self.results.join("checkpoint")
    }

    /// The one before the last.
    pub fn before(&self) -> PathBuf {
        self.results.join("checkpoint.before")
    }

    /// The last one, set aside because it was damaged.
    pub fn damaged(&self) -> PathBuf {
        self.results.join("checkpoint.damaged")
    }

    /// The one being written.
    pub fn fresh(&self) -> PathBuf {
        self.results.join("checkpoint.part")
    }

    /// True where a run left a checkpoint, whole or not.
    pub fn exists(&self) -> bool {
        let left = [self.committed(), self.before()];
        left.iter().any(|path| path.join(self.own).is_file())
    }

    /// The newest checkpoint whose files are as they were written; `None` where there is no checkpoint at all.
    pub fn newest_whole(&self) -> Result<Option<WholeCheckpoint>, CheckpointError> {
        if !self.exists() {
            return Ok(None);
        }
        let mut newest = None;
        for path in self.candidates().filter(|path| path.is_dir()) {
            let Some(what) = damage(&path, self.own) else {
                return Ok(Some(WholeCheckpoint {
                    path,
                    damage: newest,
                }));
            };
            newest.get_or_insert_with(|| format!("{} is damaged: {what}", path.display()));
        }
        Err(CheckpointError::Damaged {
            path: self.committed(),
            what: newest.unwrap_or_default(),
        })
    }

    /// Makes the newest whole checkpoint the committed one; a damaged one is kept beside. What was wrong, if anything was.
    pub fn recover(&self) -> Result<Option<String>, CheckpointError> {
        let Some(whole) = self.newest_whole()? else {
            return Ok(None);
        };
        let committed = self.committed();
        if whole.path == committed {
            return Ok(None);
        }
        let failed = |doing, cause: io::Error| CheckpointError::Io {
            path: committed.clone(),
            doing,
            cause,
        };
        if committed.exists() {
            let aside = self.damaged();
            remove(&aside).map_err(|cause| failed("removing an older damaged one", cause))?;
            fs::rename(&committed, &aside).map_err(|cause| failed("setting it aside", cause))?;
        }
        fs::rename(&whole.path, &committed)
            .map_err(|cause| failed("taking the one before", cause))?;
        sync(&self.results).map_err(|cause| failed("flushing its folder", cause))?;
        Ok(whole.damage)
    }

    /// Makes the fresh checkpoint the committed one and that the one before; at no moment is there none.
    pub fn publish(&self) -> Result<(), CheckpointError> {
        let (fresh, committed, before) = (self.fresh(), self.committed(), self.before());
        let failed = |doing, cause: io::Error| CheckpointError::Io {
            path: committed.clone(),
            doing,
            cause,
        };
        seal(&fresh, self.own).map_err(|cause| failed("flushing its files", cause))?;
        sync(&fresh).map_err(|cause| failed("flushing it", cause))?;
        if committed.exists() {
            exchange(&fresh, &committed)
                .map_err(|cause| failed("exchanging it with the last one", cause))?;
            if before.exists() {
                exchange(&fresh, &before)
                    .map_err(|cause| failed("keeping the one before", cause))?;
                remove(&fresh).map_err(|cause| failed("removing the oldest", cause))?;
            } else {
                fs::rename(&fresh, &before)
                    .map_err(|cause| failed("keeping the one before", cause))?;
            }
        } else {
            fs::rename(&fresh, &committed).map_err(|cause| failed("renaming it", cause))?;
        }
        sync(&self.results).map_err(|cause| failed("flushing its folder", cause))
    }

    /// Folders that may hold a checkpoint, the newest first. Where a run was killed while it published one, the fresh one is
    /// that before the last.
    fn candidates(&self) -> impl Iterator<Item = PathBuf> + use<> {
        [self.committed(), self.fresh(), self.before()].into_iter()
    }
}

fn exchange(one: &Path, other: &Path) -> io::Result<()> {
    Ok(renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)?)
}

/// Removes a folder if it is there.
fn remove(folder: &Path) -> io::Result<()> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

/// Flushes the entries of a folder to disk.
fn sync(directory: &Path) -> io::Result<()> {
    fs::File::open(directory)?.sync_all()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A results folder whose checkpoints hold the numbers of their publication.
    struct Folder {
        _folder: tempfile::TempDir,
        paths: CheckpointPaths,
    }

    impl Folder {
        fn new() -> Self {
            let folder = tempfile::tempdir().unwrap();
            let paths = CheckpointPaths::new(folder.path());
            Self {
                _folder: folder,
                paths,
            }
        }

        fn write(&self, number: u32) {
            let fresh = self.paths.fresh();
            let _ = fs::remove_dir_all(&fresh);
            fs::create_dir_all(fresh.join("gas")).unwrap();
            fs::write(fresh.join("gas/state"), format!("gas {number}")).unwrap();
            fs::write(fresh.join(OWN), format!("{number}")).unwrap();
        }

        fn publish(&self, number: u32) {
            self.write(number);
            self.paths.publish().unwrap();
        }

        fn number(path: &Path) -> String {
            fs::read_to_string(path.join(OWN)).unwrap()
        }
    }

    #[test]
    fn the_last_two_are_kept() {
        let folder = Folder::new();
        let paths = &folder.paths;
        assert_eq!(paths.newest_whole().unwrap(), None);
        assert!(!paths.exists());
        folder.publish(1);
        assert!(!paths.before().exists());
        for number in 2..5 {
            folder.publish(number);
            assert_eq!(Folder::number(&paths.committed()), number.to_string());
            assert_eq!(Folder::number(&paths.before()), (number - 1).to_string());
            assert!(!paths.fresh().exists());
            assert_eq!(paths.recover().unwrap(), None);
        }
    }

    #[test]
    fn any_damage_leads_back_to_the_one_before() {
        type Harm = fn(&Path);
        let harms: [(Harm, &str); 6] = [
            (
                |path| fs::write(path.join("gas/state"), "gaz 2").unwrap(),
                "gas/state has another content than was written",
            ),
            (
                |path| fs::remove_file(path.join("gas/state")).unwrap(),
                "gas/state cannot be read: No such file",
            ),
            (
                |path| fs::write(path.join(OWN), "").unwrap(),
                "coordinator.state has another content",
            ),
            (
                |path| {
                    let list = fs::read_to_string(path.join("SHA256SUMS")).unwrap();
                    let first = list.lines().next().unwrap();
                    fs::write(path.join("SHA256SUMS"), format!("{first}\n")).unwrap();
                },
                "SHA256SUMS is cut short",
            ),
            (
                |path| {
                    let list = fs::read_to_string(path.join("SHA256SUMS")).unwrap();
                    let (_, rest) = list.split_once('\n').unwrap();
                    fs::write(path.join("SHA256SUMS"), rest).unwrap();
                },
                "SHA256SUMS does not list gas/state",
            ),
            (
                |path| fs::remove_file(path.join("SHA256SUMS")).unwrap(),
                "it has no SHA256SUMS",
            ),
        ];
        for (harm, expected) in harms {
            let folder = Folder::new();
            let paths = &folder.paths;
            folder.publish(1);
            folder.publish(2);
            harm(&paths.committed());
            let whole = paths.newest_whole().unwrap().unwrap();
            assert_eq!(whole.path, paths.before());
            let told = paths.recover().unwrap().unwrap();
            assert!(told.contains(expected), "{told}");
            assert_eq!(Folder::number(&paths.committed()), "1");
            assert!(paths.damaged().is_dir() && !paths.before().exists());
            // The run goes on, and has two again.
            folder.publish(3);
            assert_eq!(Folder::number(&paths.before()), "1");
            // A second time, too.
            harm(&paths.committed());
            assert!(paths.recover().unwrap().is_some());
            assert_eq!(Folder::number(&paths.committed()), "1");
        }
    }

    #[test]
    fn where_none_is_whole_that_is_said() {
        let folder = Folder::new();
        folder.publish(1);
        folder.publish(2);
        for path in [folder.paths.committed(), folder.paths.before()] {
            fs::write(path.join("gas/state"), "").unwrap();
        }
        let error = folder.paths.recover().unwrap_err().to_string();
        assert!(error.contains("gas/state has another content"), "{error}");
        assert!(error.contains("no older one is whole"), "{error}");
    }

    #[test]
    fn a_kill_between_any_two_steps_of_publishing_leaves_a_whole_one() {
        // Before the first exchange: the fresh one is whole, the committed one counts.
        let folder = Folder::new();
        let paths = &folder.paths;
        folder.publish(1);
        folder.publish(2);
        folder.write(3);
        seal(&paths.fresh(), OWN).unwrap();
        assert_eq!(paths.recover().unwrap(), None);
        // After it: the one before the last is still the fresh one.
        exchange(&paths.fresh(), &paths.committed()).unwrap();
        assert_eq!(paths.recover().unwrap(), None);
        fs::write(paths.committed().join(OWN), "?").unwrap();
        assert!(paths.recover().unwrap().is_some());
        assert_eq!(Folder::number(&paths.committed()), "2");
        // Half removed: no checkpoint.
        fs::create_dir_all(paths.fresh()).unwrap();
        fs::write(paths.committed().join(OWN), "?").unwrap();
        assert!(paths.recover().unwrap().is_some());
        assert_eq!(Folder::number(&paths.committed()), "1");
    }
}
