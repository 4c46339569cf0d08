//! What a process and those it starts cost: processor time and peak memory.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::steps::{Stop, TaskResult, shown};

/// How often the memory of a process is looked at. The kernel keeps each process' peak, so that only what
/// comes in its last moment is missed.
const LOOK_EVERY: Duration = Duration::from_millis(10);

/// What a command cost with all processes that it started and waited for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cost {
    /// Processor time in s, user's and system's.
    pub processor: f64,
    /// Wall time in s.
    pub wall: f64,
    /// Peak of the resident memory in bytes, summed over processes.
    pub memory: f64,
}

/// Runs a command, its output to a new `log`; its cost, whether or not it succeeds, and its success.
///
/// Bash's `time` reads what `getrusage` tells of its children, to a millisecond; the standard library has no such call.
pub fn measured(command: &Command, log: &Path) -> TaskResult<(Cost, bool)> {
    let file = File::create(log).map_err(|cause| Stop::io(log, &cause))?;
    let copy = file.try_clone().map_err(|cause| Stop::io(log, &cause))?;
    let told = log.with_extension("time");
    let mut outer = Command::new("bash");
    // The third descriptor is bash's own standard error, so that what the command prints stays apart.
    let script = r#"TIMEFORMAT="%3U %3S"; told=$1; shift; { time "$@" 2>&3; } 3>&2 2>"$told""#;
    outer.args(["-c", script, "bash"]).arg(&told);
    outer.arg(command.get_program()).args(command.get_args());
    for (name, value) in command.get_envs() {
        match value {
            Some(value) => outer.env(name, value),
            None => outer.env_remove(name),
        };
    }
    if let Some(folder) = command.get_current_dir() {
        outer.current_dir(folder);
    }
    outer.stdin(Stdio::null()).stdout(file).stderr(copy);
    let not_run = |cause| Stop(format!("`{}` cannot be run: {cause}", shown(command)));
    let begun = Instant::now();
    let mut child = outer.spawn().map_err(not_run)?;
    let mut peaks = Peaks::default();
    let status = loop {
        if let Some(status) = child.try_wait().map_err(not_run)? {
            break status;
        }
        peaks.look(child.id());
        thread::sleep(LOOK_EVERY);
    };
    let wall = begun.elapsed().as_secs_f64();
    let text = fs::read_to_string(&told).map_err(|cause| Stop::io(&told, &cause))?;
    let processor = sum(&text).ok_or_else(|| Stop(format!("{}: no times", told.display())))?;
    let _ = fs::remove_file(&told);
    let memory = peaks.sum();
    Ok((
        Cost {
            processor,
            wall,
            memory,
        },
        status.success(),
    ))
}

/// The sum of the numbers of the last line.
fn sum(text: &str) -> Option<f64> {
    let numbers = text.lines().last()?.split_whitespace();
    let numbers: Result<Vec<f64>, _> = numbers.map(str::parse).collect();
    Some(numbers.ok()?.iter().sum())
}

/// Peaks of processes, by their numbers.
#[derive(Default)]
struct Peaks(Vec<(u32, f64)>);

impl Peaks {
    /// Looks at the processes below one.
    fn look(&mut self, above: u32) {
        let path = format!("/proc/{above}/task/{above}/children");
        for word in fs::read_to_string(path)
            .unwrap_or_default()
            .split_whitespace()
        {
            let Ok(process) = word.parse() else { continue };
            if let Some(peak) = peak(process) {
                self.0.retain(|(other, _)| *other != process);
                self.0.push((process, peak));
            }
            self.look(process);
        }
    }

    fn sum(&self) -> f64 {
        self.0.iter().map(|(_, peak)| peak).sum()
    }
}

/// Peak of the resident memory of a process in bytes.
fn peak(process: u32) -> Option<f64> {
    peak_of(&fs::read_to_string(format!("/proc/{process}/status")).ok()?)
}

fn peak_of(status: &str) -> Option<f64> {
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(1024.0 * kilobytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peaks_and_times_are_read_as_kernel_and_shell_write_them() {
        let status = "Name:\tcat\nVmPeak:\t    9000 kB\nVmHWM:\t    2048 kB\n";
        assert_eq!(peak_of(status), Some(2_097_152.0));
        assert_eq!(peak_of("Name:\tcat\n"), None);
        assert_eq!(sum("1.250 0.500\n"), Some(1.75));
        assert_eq!(sum("warning\n"), None);
    }

    #[test]
    fn a_command_costs_what_its_children_take_and_its_output_goes_to_the_log() {
        let folder = std::env::temp_dir().join(format!("xtask measured {}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let log = folder.join("log");
        let mut command = Command::new("sh");
        let work = "echo out; echo err >&2; sh -c 'i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done'; exit 3";
        command.args(["-c", work]);
        let (cost, success) = measured(&command, &log).unwrap();
        let text = fs::read_to_string(&log).unwrap();
        fs::remove_dir_all(&folder).unwrap();
        assert!(
            !success && text.contains("out") && text.contains("err"),
            "{text}"
        );
        assert!(cost.processor > 0.01 && cost.memory > 1e5, "{cost:?}");
    }
}
