//! What removes the files of a run whose coordinator was killed while it had no solver yet to do it, and what processes that end later
//! than the coordinator still make.

use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::error::WireError;

/// Waits for the end of a pipe that only the coordinator holds. Then it removes a folder, and what begins with a name, and looks
/// again as often as it is told.
const LINE: &str = "read -r nothing; n=$2; while [ \"$n\" -gt 0 ]; do \
                    rm -rf -- \"$0\" \"$1\"_*; sleep 0.2; n=$((n-1)); done";
/// How often it looks: what MPI starts may make files for a second after those it works for have ended.
const LOOKS: u32 = 7;

/// A process that may outlive the coordinator.
#[derive(Debug)]
pub(crate) struct Guard(Child);

impl Guard {
    /// A guard over a folder and over files whose names begin with a path and an underscore.
    pub fn start(folder: &Path, names: &Path) -> Result<Self, WireError> {
        let child = Command::new("/bin/sh")
            .args(["-c", LINE])
            .args([folder, names])
            .arg(LOOKS.to_string())
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            // An interrupt from the terminal is for the others.
            .process_group(0)
            .spawn();
        child.map(Self).map_err(|source| WireError::File {
            path: "/bin/sh".into(),
            source,
        })
    }

    /// Ends it: there is nothing to be afraid of.
    pub fn dismiss(&mut self) {
        // One that has ended is what is wanted.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::time::{Duration, Instant};

    #[test]
    fn a_guard_removes_a_dead_coordinators_files_and_no_others() {
        let folder = tempfile::tempdir().unwrap();
        // Blanks are no ends of words.
        let place = |name: &str| folder.path().join(name);
        for name in ["a b-1-0", "a b-1-1"] {
            fs::create_dir(place(name)).unwrap();
            fs::write(place(name).join("socket"), b"x").unwrap();
        }
        fs::write(place("memory-1-0_alive"), b"x").unwrap();
        let mut guard = Guard::start(&place("a b-1-0"), &place("memory-1-0")).unwrap();
        assert!(place("a b-1-0").exists());
        // As the coordinator's end closes it.
        drop(guard.0.stdin.take());
        let begun = Instant::now();
        while place("a b-1-0").exists() && begun.elapsed() < Duration::from_secs(30) {
            std::thread::sleep(Duration::from_millis(1));
        }
        // As a daemon that outlives its rank does.
        fs::create_dir(place("a b-1-0")).unwrap();
        guard.0.wait().unwrap();
        let left: Vec<_> = fs::read_dir(folder.path()).unwrap().flatten().collect();
        assert_eq!(left.len(), 1);
        assert!(place("a b-1-1/socket").exists());
    }

    #[test]
    fn a_guard_that_is_dismissed_ends_at_once() {
        let mut guard = Guard::start(Path::new("/none/a"), Path::new("/none/b")).unwrap();
        guard.dismiss();
        assert!(!Path::new(&format!("/proc/{}", guard.0.id())).exists());
    }
}
