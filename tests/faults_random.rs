//! Random processes of coupled runs are killed or stopped at random moments: `cargo xtask faults --kills 500`;
//! twenty in `cargo test`. Each time the message must name the solver and show the end of its log, everything must
//! end within 5 s (of a stopped one: after the deadline), and nothing may stay: no process, no file in /dev/shm, none
//! in the folder for scratch. Every run is the next run after the one before it; the last one runs to its end.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

#[path = "support/by_name.rs"]
mod by_name;
#[path = "support/processes.rs"]
mod processes;
#[path = "fuzz/random.rs"]
#[allow(dead_code)]
mod random;

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use by_name::{Orders, orders};
use processes::{alive, belonging, command_line, descendants, is_solver, leftovers, wait_until};
use random::Random;
use rustix::process::{Pid, Signal, kill_process};

/// The seed, unless another is given.
const SEED: u64 = 20_261_121;
/// Trials in the default suite.
const FEW: u64 = 20;
/// `coupling.deadline` where a process is to be stopped: time enough to start on a busy machine.
const DEADLINE: Duration = Duration::from_secs(6);
/// Within which everything must have ended.
const LIMIT: Duration = Duration::from_secs(5);
/// After which a run counts as hanging.
const PATIENCE: Duration = Duration::from_secs(60);

/// Ranks of the gas and of the particles, the transport, and the latest moment of a signal in ms.
type Kind = (u32, u32, &'static str, usize);

/// One rank each half of the times.
const KINDS: [Kind; 10] = [
    (1, 1, "shared-memory", 1500),
    (1, 1, "shared-memory", 1500),
    (2, 1, "shared-memory", 3000),
    (1, 1, "shared-memory", 1500),
    (1, 2, "shared-memory", 2500),
    (1, 1, "shared-memory", 1500),
    (2, 2, "shared-memory", 4000),
    (1, 1, "mpi", 3000),
    (1, 1, "shared-memory", 1500),
    (2, 2, "mpi", 5000),
];

fn main() -> ExitCode {
    let Some(orders) = orders("faults_random", FEW, SEED) else {
        return ExitCode::SUCCESS;
    };
    let Orders { kills, seed, .. } = orders;
    println!("faults: seed {seed}, {kills} trials");
    // A short path: the wire's sockets lie in it. Nothing else is in it, so that whatever stays is seen.
    let scratch = tempfile::Builder::new().prefix("c").rand_bytes(4).tempdir();
    let scratch = scratch.unwrap();
    let results = tempfile::tempdir().unwrap();
    let mut tally = Tally::default();
    for number in orders.numbers() {
        let mut random = Random::of(seed, number);
        let kind = KINDS[number as usize % KINDS.len()];
        let out = results.path().join(format!("run-{number}"));
        let story = strike(&out, scratch.path(), kind, &mut random);
        match &story.fault {
            None => println!("  {number:3} {}", story.text),
            Some(fault) => println!("  {number:3} {}: FAILED: {fault}", story.text),
        }
        tally.book(&story);
        // One that was struck at once may not have made it.
        let _ = fs::remove_dir_all(&out);
    }
    // And a run that nobody strikes.
    let out = results.path().join("last");
    let mut last = start(
        &out,
        scratch.path(),
        KINDS[0],
        &["--set", "time.end=0.05 s"],
    );
    let clean = last.wait().unwrap().success();
    if !clean {
        println!(
            "the last run, which nothing struck, failed: {}",
            said(&mut last)
        );
    }
    println!("{tally}");
    if tally.failed == 0 && clean {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// What became of a run.
struct Story {
    text: String,
    victim: String,
    /// From the signal to the end of the last process.
    taken: Duration,
    fault: Option<String>,
}

#[derive(Default)]
struct Tally {
    victims: BTreeMap<String, (u32, Duration)>,
    failed: u32,
}

impl Tally {
    fn book(&mut self, story: &Story) {
        let entry = self.victims.entry(story.victim.clone()).or_default();
        entry.0 += 1;
        entry.1 = entry.1.max(story.taken);
        self.failed += u32::from(story.fault.is_some());
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (victim, (times, longest)) in &self.victims {
            let longest = longest.as_secs_f64();
            writeln!(
                f,
                "  {victim:40} {times:4} times, ended after {longest:.2} s at most"
            )?;
        }
        write!(f, "faults: {} failed", self.failed)
    }
}

/// A run that would take minutes and writes often, so that moments fall into output and checkpoints too.
fn start(out: &Path, scratch: &Path, kind: Kind, words: &[&str]) -> Child {
    let (gas, particles, transport, _) = kind;
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("run")
        .arg(processes::case())
        .args(["--gas", "openfoam", "--particles", "liggghts", "--quiet"])
        .args(["--ranks-gas", &gas.to_string()])
        .args(["--ranks-particles", &particles.to_string()])
        .args(["--transport", transport])
        .args(["--set", "time.acceleration=1"])
        .args(["--set", "output.series_every=0.01 s"])
        .args(["--set", "output.every=0.05 s"])
        .args(["--set", "time.checkpoint.every=0.07 s"])
        .args(words)
        .arg("--out")
        .arg(out)
        .env("TMPDIR", scratch)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn said(run: &mut Child) -> String {
    let mut text = String::new();
    run.stderr
        .take()
        .unwrap()
        .read_to_string(&mut text)
        .unwrap();
    text
}

/// Whose process a command line is: what the message must name.
fn owner(line: &str) -> Option<&'static str> {
    [
        ("calcineGasFoam", "OpenFOAM"),
        ("decomposePar", "OpenFOAM"),
        ("calcine-liggghts", "LIGGGHTS"),
    ]
    .into_iter()
    .find(|(mark, _)| line.contains(mark))
    .map(|(_, name)| name)
}

/// Where a run stood, as its files tell.
fn stage(out: &Path) -> String {
    if out.join("checkpoint.part").exists() {
        return "in a checkpoint".into();
    }
    let rows = fs::read_to_string(out.join("series.csv")).map_or(0, |text| text.lines().count());
    match (rows, out.join("log/liggghts.log").exists()) {
        (0..2, false) => "as OpenFOAM starts".into(),
        (0..2, true) => "as LIGGGHTS starts".into(),
        (rows, _) => format!("after {rows} rows"),
    }
}

/// One run and one signal.
fn strike(out: &Path, scratch: &Path, kind: Kind, random: &mut Random) -> Story {
    let stops = random.once_in(6);
    let deadline = format!("coupling.deadline={} s", DEADLINE.as_secs());
    let words = ["--set", &*deadline];
    let mut run = start(out, scratch, kind, if stops { &words } else { &[] });
    let coordinator = run.id();
    let moment = Duration::from_millis(random.below(kind.3) as u64);
    std::thread::sleep(moment);
    let began = Instant::now();
    let (victim, line, peers) = loop {
        let peers = descendants(coordinator);
        let mut all = peers.clone();
        if !stops {
            all.push(coordinator);
        }
        // What guards the start of MPI is missed by nobody.
        all.retain(|&pid| !command_line(pid).contains("read -r nothing"));
        all.retain(|&pid| !stops || is_solver(pid));
        assert!(began.elapsed() < PATIENCE, "there is nothing to strike");
        if all.is_empty() {
            // Not started yet.
            std::thread::sleep(Duration::from_millis(20));
            continue;
        }
        let victim = *random.one(&all);
        let line = command_line(victim);
        let sent = if stops { Signal::STOP } else { Signal::KILL };
        let pid = Pid::from_raw(i32::try_from(victim).unwrap()).unwrap();
        // It may have ended by itself meanwhile, as tools that only start others do.
        if kill_process(pid, sent).is_ok() {
            break (victim, line, peers);
        }
    };
    let struck = Instant::now();
    let stage = stage(out);
    let silence = if stops { DEADLINE } else { Duration::ZERO };
    wait_until(PATIENCE, || run.try_wait().unwrap().is_some());
    let ended = run.try_wait().unwrap();
    if ended.is_none() {
        run.kill().unwrap();
        run.wait().unwrap();
    }
    let coordinator_took = struck.elapsed().saturating_sub(silence);
    let code = ended.and_then(|status| status.code());
    let text = said(&mut run);
    // A coordinator that was killed says nothing; its solvers end by themselves.
    let rest = || {
        let living = peers.iter().copied().chain(belonging(coordinator));
        let living = living.filter(|&pid| alive(pid));
        let mut rest: Vec<_> = living.map(command_line).collect();
        rest.extend(litter(coordinator, scratch));
        rest
    };
    wait_until(LIMIT, || rest().is_empty());
    let late = rest();
    wait_until(PATIENCE, || rest().is_empty());
    let taken = struck.elapsed().saturating_sub(silence);
    let name = if victim == coordinator {
        "calcine".to_owned()
    } else {
        line.split(' ')
            .next()
            .unwrap_or_default()
            .rsplit('/')
            .next()
            .unwrap_or_default()
            .to_owned()
    };
    let mut faults = Vec::new();
    if ended.is_none() {
        faults.push("the run hangs".to_owned());
    }
    if taken > LIMIT {
        faults.push(format!("it took {:.2} s", taken.as_secs_f64()));
    }
    faults.extend(
        late.into_iter()
            .map(|name| format!("there after 5 s: {name}")),
    );
    faults.extend(rest().into_iter().map(|name| format!("left: {name}")));
    if victim != coordinator {
        if code != Some(4) {
            faults.push(format!("exit code {code:?}"));
        }
        let who = owner(&line);
        let is_named = text.contains(&format!("pid {victim}"))
            || who.is_some_and(|who| text.contains(who))
            || who.is_none() && (text.contains("pid ") || text.contains("MPI"));
        if !is_named {
            faults.push("the message does not name it".into());
        }
        // One that is struck as it starts has not written any.
        let written = |name: &str| {
            let mark = if name == "OpenFOAM" {
                "openfoam"
            } else {
                "liggghts"
            };
            let data = fs::metadata(out.join(format!("log/{mark}.log")));
            data.is_ok_and(|data| data.len() > 0)
        };
        if stage.starts_with("after")
            && who.is_some_and(written)
            && !text.contains("the end of its log")
        {
            faults.push("no end of a log".into());
        }
        if !faults.is_empty() {
            faults.push(format!("its words: {}", text.trim()));
        }
    }
    let (gas, particles, transport, _) = kind;
    let verb = if stops { "stopped" } else { "killed" };
    Story {
        text: format!(
            "{gas}+{particles} {transport}, {:.2} s, {stage}: {name} {verb}, ended after {:.2} s (calcine \
             after {:.2} s), load {}",
            moment.as_secs_f64(),
            taken.as_secs_f64(),
            coordinator_took.as_secs_f64(),
            load()
        ),
        victim: format!("{name} {verb}"),
        taken,
        fault: (!faults.is_empty()).then(|| faults.join("; ")),
    }
}

/// Processes that wanted to run, in the mean of the last minute: a limit of seconds means less where they are many.
fn load() -> String {
    let text = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    text.split(' ').next().unwrap_or_default().to_owned()
}

/// Files of a run, and whatever lies in its own folder for scratch.
fn litter(coordinator: u32, scratch: &Path) -> Vec<String> {
    let mut names = leftovers(coordinator);
    let entries = fs::read_dir(scratch).unwrap().flatten();
    names.extend(entries.map(|entry| PathBuf::from(entry.file_name()).display().to_string()));
    names
}
