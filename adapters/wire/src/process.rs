//! Which process stands at the other end of a link, so that each rank's life can be watched, whatever
//! launched it.

use std::fs;
use std::path::Path;
use std::time::Duration;

/// The key of a process in an introduction.
const KEY: &str = "process ";

/// A process as it introduces itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Process {
    /// Its process id.
    pub pid: u32,
    /// When it started, in clock ticks since boot: tells it from a later process of the same id.
    started: u64,
    /// The boot and the process-id namespace that the id is of.
    machine: String,
    /// Name of the host, for messages.
    pub host: String,
}

impl Process {
    /// This process.
    pub fn own() -> Self {
        let pid = std::process::id();
        Self {
            pid,
            started: started(pid).unwrap_or_default(),
            machine: machine(),
            host: word("/proc/sys/kernel/hostname"),
        }
    }

    /// True where the id is one of this machine's, and still the same process.
    pub fn is_here(&self) -> bool {
        self.machine == machine() && started(self.pid) == Some(self.started)
    }

    /// Processor time that its threads have used so far (first number of /proc/PID/task/TID/schedstat, in ns);
    /// zero where this machine does not tell.
    pub fn processor_time(&self) -> Duration {
        let threads = fs::read_dir(format!("/proc/{}/task", self.pid));
        let threads = threads.into_iter().flatten().flatten();
        let used = threads.filter_map(|thread| {
            let text = fs::read_to_string(thread.path().join("schedstat")).ok()?;
            text.split_ascii_whitespace().next()?.parse::<u64>().ok()
        });
        Duration::from_nanos(used.sum())
    }

    /// The line of an introduction.
    pub(crate) fn line(&self) -> String {
        let Self {
            pid,
            started,
            machine,
            host,
        } = self;
        format!("{KEY}{pid} {started} {machine} {host}\n")
    }

    /// The process in an introduction, if it names one.
    pub(crate) fn in_text(text: &str) -> Option<Self> {
        let line = text.lines().find_map(|line| line.strip_prefix(KEY))?;
        let mut words = line.split_ascii_whitespace();
        Some(Self {
            pid: words.next()?.parse().ok()?,
            started: words.next()?.parse().ok()?,
            machine: words.next()?.to_owned(),
            host: words.next().unwrap_or_default().to_owned(),
        })
    }
}

/// When a process started, in clock ticks since boot (field 22 of /proc/PID/stat).
pub(crate) fn started(pid: u32) -> Option<u64> {
    field(pid, 22)?.parse().ok()
}

/// The process that started another, or that took it over (field 4).
pub fn parent(pid: u32) -> Option<u32> {
    field(pid, 4)?.parse().ok()
}

/// A field of /proc/PID/stat behind the name, which may have blanks, counted from 1 as in proc(5).
fn field(pid: u32, number: usize) -> Option<String> {
    let text = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    let after_name = text.rsplit_once(')')?.1;
    let mut fields = after_name.split_ascii_whitespace();
    fields.nth(number.checked_sub(3)?).map(str::to_owned)
}

/// A file of one word.
fn word(path: &str) -> String {
    fs::read_to_string(path)
        .map(|text| text.trim().replace(' ', "-"))
        .unwrap_or_default()
}

/// The boot and the process-id namespace of this process: where its process ids mean something.
pub(crate) fn machine() -> String {
    let space = fs::read_link(Path::new("/proc/self/ns/pid")).unwrap_or_default();
    let boot = word("/proc/sys/kernel/random/boot_id");
    format!("{boot}/{}", space.display())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_survives_its_line_and_is_here() {
        let own = Process::own();
        assert_eq!(Process::in_text(&own.line()), Some(own.clone()));
        assert!(own.is_here());
        assert_eq!(own.pid, std::process::id());
    }

    #[test]
    fn the_processor_time_of_a_process_grows_as_it_works() {
        let own = Process::own();
        let before = own.processor_time();
        let begun = std::time::Instant::now();
        // Its own thread and, meanwhile, perhaps others.
        while begun.elapsed() < Duration::from_millis(50) || own.processor_time() == before {
            std::hint::black_box(());
            assert!(begun.elapsed() < Duration::from_secs(20), "it stands still");
        }
        assert!(own.processor_time() > before);
    }

    #[test]
    fn the_parent_of_a_child_is_this_process() {
        let mut child = std::process::Command::new("sleep")
            .arg("60")
            .spawn()
            .unwrap();
        assert_eq!(parent(child.id()), Some(std::process::id()));
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(parent(u32::MAX), None);
    }

    #[test]
    fn another_machine_s_process_and_a_later_one_are_not_here() {
        let mut other = Process::own();
        other.machine = "elsewhere/pid:[1]".into();
        assert!(!other.is_here());
        let mut later = Process::own();
        later.started += 1;
        assert!(!later.is_here());
        assert_eq!(Process::in_text("role gas\n"), None);
    }
}
