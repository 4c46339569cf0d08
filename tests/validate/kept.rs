//! Runs that take long and are kept below the target directory: one that has ended is not repeated, one that was
//! interrupted goes on, by the same program; another one begins anew.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use calcine::results::Summary;
use calcine::results::read::Series;
use sha2::{Digest, Sha256};

/// Turnovers of the bed at the end of a run in which it is asked whether it is steady.
const LAST: f64 = 0.4;
/// Exit code of a run that was interrupted and can go on.
const INTERRUPTED: i32 = 75;

/// A run that ended.
pub struct Kept {
    pub out: PathBuf,
    pub summary: Summary,
    pub series: Series,
}

impl Kept {
    /// The last value of a quantity.
    pub fn last(&self, quantity: &str) -> f64 {
        let column = self.series.column(&format!("quantities.{quantity}"));
        *column.last().unwrap()
    }

    /// By how much in K the mean temperature of the particles moves over the last 0.4 turnovers, each of so many s.
    pub fn moved(&self, turnover: f64) -> f64 {
        let [time, mean] = ["process_time", "quantities.mean_temperature"];
        let (time, mean) = (self.series.column(time), self.series.column(mean));
        let last = mean.len() - 1;
        let before = time.partition_point(|&at| at < time[last] - LAST * turnover);
        mean[last] - mean[before]
    }
}

/// Where the runs of this program are: its SHA-256 names the folder.
fn folder() -> PathBuf {
    let program = fs::read(env!("CARGO_BIN_EXE_calcine")).unwrap();
    let hash = Sha256::digest(program);
    let name: String = hash[..8].iter().map(|byte| format!("{byte:02x}")).collect();
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("kept");
    kept.join(name)
}

/// The native run of a case with settings under a name, from the end of another run where one is given.
pub fn run(name: &str, case: &Path, set: &[String], from: Option<&Path>) -> Kept {
    let out = folder().join(name);
    let begun = out.join("checkpoint").exists();
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command
        .arg("run")
        .arg(case)
        .args(["--quiet", "--out"])
        .arg(&out);
    match from {
        Some(from) if !begun => command.arg("--from").arg(from),
        // Resumed before its first checkpoint it starts again.
        _ if out.exists() => command.arg("--resume"),
        _ => &mut command,
    };
    for setting in set {
        command.args(["--set", setting]);
    }
    println!(
        "  {name}: in {}, which is kept; remove it to repeat the run",
        out.display()
    );
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(
        output.status.code() != Some(INTERRUPTED),
        "{name} was interrupted: the same command goes on"
    );
    assert!(output.status.success(), "{name}: {told}");
    let (summary, series) = (Summary::read(&out).unwrap(), Series::read(&out).unwrap());
    Kept {
        out,
        summary,
        series,
    }
}
