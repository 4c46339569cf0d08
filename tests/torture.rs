//! `kill -9` at random moments and `--resume`: `cargo xtask torture --kills 50`; three kills in
//! `cargo test`. Each kill has a run of its own, which is resumed to its end and compared with the
//! uninterrupted run. The moments are drawn from a printed seed; half of them over the whole
//! run, the others where it hurts: while a checkpoint is written, right after `results.h5` grew,
//! and a second time while the run resumes.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

#[path = "support/by_name.rs"]
mod by_name;
#[path = "fuzz/random.rs"]
#[allow(dead_code)]
mod random;
#[path = "support/results_equal.rs"]
mod results_equal;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::time::{Duration, Instant};

use by_name::{Orders, orders};
use random::Random;
use results_equal::differences;

/// The seed, unless another is given.
const SEED: u64 = 20_261_121;
/// Kills in the default suite: one of each kind.
const FEW: u64 = 4;
/// A watchdog: a run takes seconds.
const PATIENCE: Duration = Duration::from_secs(300);

fn main() -> ExitCode {
    let Some(orders) = orders("torture", FEW, SEED) else {
        return ExitCode::SUCCESS;
    };
    let Orders { kills, seed, .. } = orders;
    let scratch = tempfile::tempdir().unwrap();
    let bed = Bed::new(scratch.path());
    let whole = scratch.path().join("whole");
    let begun = Instant::now();
    let ended = finish(bed.start(&whole, false));
    assert!(ended.is_ok(), "{ended:?}");
    let length = begun.elapsed();
    println!(
        "torture: seed {seed}, {kills} kills; the uninterrupted run takes {:.2} s",
        length.as_secs_f64()
    );
    let mut failed = 0;
    let mut counts = Counts::default();
    for number in orders.numbers() {
        let out = scratch.path().join(format!("killed-{number}"));
        let mut random = Random::of(seed, number);
        let story = kill(&bed, &out, length, number, &mut random, &mut counts);
        let verdict = match finish(bed.start(&out, begun_there(&out))) {
            Err(message) => Err(message),
            Ok(()) => match differences(&whole, &out) {
                different if different.is_empty() => Ok(()),
                different => Err(format!("different: {}", different.join(", "))),
            },
        };
        match verdict {
            Ok(()) => println!("  {number:3} {story}: the same bits"),
            Err(message) => {
                failed += 1;
                println!("  {number:3} {story}: FAILED: {message}");
            }
        }
        fs::remove_dir_all(&out).unwrap();
    }
    println!(
        "torture: {kills} kills, {failed} failed; {} before the first checkpoint, {} while one \
         was written, {} after the end, {} twice",
        counts.early, counts.within, counts.late, counts.twice
    );
    if failed == 0 {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

/// Where the kills fell.
#[derive(Debug, Default)]
struct Counts {
    early: u32,
    within: u32,
    late: u32,
    twice: u32,
}

/// The program and the case, copied, so that a build or an edit meanwhile changes nothing.
struct Bed {
    program: PathBuf,
    case: PathBuf,
}

impl Bed {
    fn new(scratch: &Path) -> Self {
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/heated-bed.toml");
        let (copy, program) = (scratch.join("heated-bed.toml"), scratch.join("calcine"));
        fs::copy(case, &copy).unwrap();
        fs::copy(env!("CARGO_BIN_EXE_calcine"), &program).unwrap();
        Self {
            program,
            case: copy,
        }
    }

    /// A small bed with a checkpoint each 4 s and a snapshot each 3 s of process time.
    fn start(&self, out: &Path, resume: bool) -> Child {
        let mut command = Command::new(&self.program);
        command.arg("run").arg(&self.case).arg("--quiet");
        for setting in [
            "mesh.cylinder.cells=[8, 12]",
            "particles[0].place.height=20 mm",
            "particles[0].place.solid_fraction=0.5",
            "time.end=40 s",
            "time.motion_window=2 ms",
            "time.acceleration=200",
            "time.checkpoint.every=4 s",
            "output.every=3 s",
            "output.series_every=0.4 s",
        ] {
            command.args(["--set", setting]);
        }
        command.arg("--out").arg(out);
        if resume {
            command.arg("--resume");
        }
        command
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    }
}

/// Waits for a run's end; what it said if that was no good one.
fn finish(mut run: Child) -> Result<(), String> {
    let begun = Instant::now();
    while run.try_wait().unwrap().is_none() {
        if begun.elapsed() > PATIENCE {
            run.kill().unwrap();
            return Err("no end".into());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = run.wait_with_output().unwrap();
    match output.status.success() {
        true => Ok(()),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}

/// Starts a run and kills it; says when.
fn kill(
    bed: &Bed,
    out: &Path,
    length: Duration,
    number: u64,
    random: &mut Random,
    counts: &mut Counts,
) -> String {
    let mut run = bed.start(out, false);
    let begun = Instant::now();
    let share = random.below(1_000_000) as f64 / 1e6;
    let later = Duration::from_micros(random.below(3000) as u64);
    let kind = match number % 8 {
        1 | 5 => {
            // While the n-th checkpoint is being written.
            let wanted = 1 + random.below(8);
            let mut seen = (0, false);
            wait(&mut run, begun, || {
                let now = out.join("checkpoint.part").exists();
                seen = (seen.0 + usize::from(now && !seen.1), now);
                seen.0 >= wanted
            });
            std::thread::sleep(later);
            format!("checkpoint {wanted}")
        }
        3 => {
            let wanted = 1 + random.below(40);
            let mut seen = (0, 0);
            wait(&mut run, begun, || {
                let size = fs::metadata(out.join("results.h5")).map_or(0, |data| data.len());
                seen = (seen.0 + usize::from(size != seen.1), size);
                seen.0 >= wanted
            });
            std::thread::sleep(later);
            format!("growth {wanted} of results.h5")
        }
        _ => {
            let moment = length.mul_f64(share);
            wait(&mut run, begun, || begun.elapsed() >= moment);
            "moment".into()
        }
    };
    let moment = begun.elapsed();
    run.kill().unwrap();
    let status = run.wait().unwrap();
    counts.late += u32::from(status.success());
    counts.early += u32::from(!out.join("checkpoint/coordinator.state").is_file());
    counts.within += u32::from(out.join("checkpoint.part").exists());
    let mut story = format!("{kind}, after {:.4} s", moment.as_secs_f64());
    if number % 8 == 2 && begun_there(out) {
        let mut run = bed.start(out, true);
        let begun = Instant::now();
        let moment = length.mul_f64(random.below(1000) as f64 / 1e3 * (1.0 - share));
        wait(&mut run, begun, || begun.elapsed() >= moment);
        run.kill().unwrap();
        run.wait().unwrap();
        counts.twice += 1;
        story.push_str(&format!(" and {:.4} s", moment.as_secs_f64()));
    }
    story
}

/// Waits until something is so, or the run has ended.
fn wait(run: &mut Child, begun: Instant, mut ready: impl FnMut() -> bool) {
    while !ready() && run.try_wait().unwrap().is_none() {
        assert!(begun.elapsed() < PATIENCE, "the run stands still");
        std::thread::sleep(Duration::from_micros(100));
    }
}

/// True if the killed run came far enough to leave anything.
fn begun_there(out: &Path) -> bool {
    out.join("lock").exists()
}
