//! Steps: what is done is said, one line a step with its time; what a step prints goes to a log
//! whose end is shown when the step fails.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Why a task stopped: a sentence or several for the user.
#[derive(Debug)]
pub struct Stop(pub String);

impl Stop {
    /// A stop with this message.
    pub fn new(message: impl Into<String>) -> Self {
        Self(message.into())
    }

    /// A file or folder that could not be read or written.
    pub fn io(path: &Path, cause: &io::Error) -> Self {
        Self(format!("{}: {cause}", path.display()))
    }
}

/// The result of a step.
pub type TaskResult<T> = Result<T, Stop>;

/// Writes a line for the user.
pub fn say(text: &str) {
    let _ = writeln!(io::stderr(), "xtask: {text}");
}

/// The command as a shell would take it, for messages.
pub fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(quoted).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &OsStr) -> String {
    let word = word.to_string_lossy();
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.into_owned()
    } else {
        format!("'{}'", word.replace('\'', r"'\''"))
    }
}

/// Starts a log of the step `name` in `folder` and returns its path.
pub fn new_log(folder: &Path, name: &str) -> TaskResult<PathBuf> {
    fs::create_dir_all(folder).map_err(|cause| Stop::io(folder, &cause))?;
    let path = folder.join(format!("{name}.log"));
    File::create(&path).map_err(|cause| Stop::io(&path, &cause))?;
    Ok(path)
}

/// How often a quiet command that takes long tells what it is at.
const TELL_EVERY: Duration = Duration::from_secs(10);
/// How often its end is looked for.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Waits for a command; from time to time tells how long it has taken and the last line of its log.
fn wait(
    child: &mut Child,
    log: &Path,
    every: Duration,
    tell: &mut dyn FnMut(&str),
) -> io::Result<ExitStatus> {
    let (begun, mut told) = (Instant::now(), Instant::now());
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        std::thread::sleep(LOOK_EVERY);
        if told.elapsed() >= every {
            told = Instant::now();
            tell(&format!(
                "{:.0} s: {}",
                begun.elapsed().as_secs_f64(),
                last_line(log).unwrap_or_default()
            ));
        }
    }
}

/// The last line of a log that is not blank, as far as one reads.
fn last_line(log: &Path) -> Option<String> {
    const END: i64 = 4096;
    let mut file = File::open(log).ok()?;
    let length = i64::try_from(file.metadata().ok()?.len()).ok()?;
    file.seek(SeekFrom::End(-length.min(END))).ok()?;
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes).ok()?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let line = text.lines().rfind(|line| !line.trim().is_empty())?;
    Some(line.trim().chars().take(100).collect())
}

/// Runs a command quietly: its output is appended to `log`, whose end is shown if it fails. One that takes long tells
/// the last line of its log from time to time.
pub fn quietly(command: &mut Command, log: &Path) -> TaskResult<()> {
    let file = File::options()
        .append(true)
        .create(true)
        .open(log)
        .map_err(|cause| Stop::io(log, &cause))?;
    let second = file.try_clone().map_err(|cause| Stop::io(log, &cause))?;
    let _ = writeln!(&file, "$ {}", shown(command));
    command.stdin(Stdio::null()).stdout(file).stderr(second);
    let mut child = command
        .spawn()
        .map_err(|cause| not_started(command, &cause))?;
    let status = wait(&mut child, log, TELL_EVERY, &mut |text| {
        let _ = write!(io::stderr(), "\n  {text}");
    });
    let status = status.map_err(|cause| not_started(command, &cause))?;
    if status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&fs::read(log).unwrap_or_default()).into_owned();
    let lines: Vec<&str> = text.lines().collect();
    let end = lines[lines.len().saturating_sub(40)..].join("\n  ");
    Err(Stop(format!(
        "`{}`: {status}\n  {end}\nthe whole log: {}",
        shown(command),
        log.display()
    )))
}

/// Runs a command whose output the user sees.
pub fn visibly(command: &mut Command) -> TaskResult<()> {
    let status = command
        .status()
        .map_err(|cause| not_started(command, &cause))?;
    if status.success() {
        Ok(())
    } else {
        Err(Stop(format!("`{}`: {status}", shown(command))))
    }
}

/// Runs a command and returns what it printed; `None` if it is not there or fails.
pub fn output(command: &mut Command) -> Option<String> {
    let output = command
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output()
        .ok()?;
    output
        .status
        .success()
        .then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

fn not_started(command: &Command, cause: &io::Error) -> Stop {
    Stop(format!(
        "`{}` cannot be started: {cause}",
        command.get_program().to_string_lossy()
    ))
}

/// Does a quiet step and says what it was and how long it took, in one line.
pub fn step<T>(what: &str, work: impl FnOnce() -> TaskResult<T>) -> TaskResult<T> {
    let begun = Instant::now();
    let _ = write!(io::stderr(), "xtask: {what} … ");
    let done = work();
    let verdict = if done.is_ok() { "" } else { " (failed)" };
    let _ = writeln!(
        io::stderr(),
        "{:.1} s{verdict}",
        begun.elapsed().as_secs_f64()
    );
    done
}

/// Does a step that prints by itself; the line with its time comes at the end.
pub fn loud_step<T>(what: &str, work: impl FnOnce() -> TaskResult<T>) -> TaskResult<T> {
    let begun = Instant::now();
    say(&format!("{what} …"));
    let done = work();
    let verdict = if done.is_ok() { "done" } else { "failed" };
    say(&format!(
        "{what}: {verdict} in {:.1} s",
        begun.elapsed().as_secs_f64()
    ));
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_is_shown_as_a_shell_would_take_it() {
        let mut command = Command::new("cp");
        command.args(["a b", "it's", "plain-1.2", ""]);
        assert_eq!(shown(&command), r"cp 'a b' 'it'\''s' plain-1.2 ''");
    }

    #[test]
    fn a_command_that_takes_long_tells_the_last_line_of_its_log() {
        let folder = std::env::temp_dir().join(format!("xtask told {}", std::process::id()));
        let log = new_log(&folder, "long").unwrap();
        let mut command = Command::new("sh");
        command.args(["-c", "echo compile UEqn.C; echo; sleep 1"]);
        command.stdout(File::options().append(true).open(&log).unwrap());
        let mut told = Vec::new();
        let mut child = command.spawn().unwrap();
        let every = Duration::from_millis(200);
        let status = wait(&mut child, &log, every, &mut |text| {
            told.push(text.to_owned())
        });
        fs::remove_dir_all(&folder).unwrap();
        assert!(status.unwrap().success());
        assert!(
            told.iter().any(|text| text.ends_with(" s: compile UEqn.C")),
            "{told:?}"
        );
    }

    #[test]
    fn a_failing_step_shows_the_end_of_its_log() {
        let folder = std::env::temp_dir().join(format!("xtask steps {}", std::process::id()));
        let log = new_log(&folder, "failing").unwrap();
        let mut command = Command::new("sh");
        command.args(["-c", "echo what went wrong >&2; exit 3"]);
        let message = quietly(&mut command, &log).unwrap_err().0;
        fs::remove_dir_all(&folder).unwrap();
        assert!(message.contains("what went wrong"), "{message}");
        assert!(message.contains("exit status: 3"), "{message}");
    }
}
