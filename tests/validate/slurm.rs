//! A queue for real: Debian's slurm-wlm and munge with three nodes on this machine. The scripts are those of
//! docs/how-to/parallel.md, as they stand there but for the case and the numbers: a sweep as an array, a coupled run over 2 + 2
//! ranks over MPI and through shared memory, and a job that meets its limit of time again and again and goes on.

use std::collections::BTreeSet;
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use calcine::results::Summary;

use crate::external_restarts::{FROZEN, largest_difference};
use crate::results_equal::values_that_differ;
use crate::shipped;
use crate::slurm_queue::{Queue, Rank, missing};
use crate::stopped::rows;

/// Nodes of the queue.
const NODES: usize = 3;
/// How long a job may take, on a machine with much else to do.
const LIMIT: Duration = Duration::from_secs(1800);
/// Process time of the run over MPI, in s.
const SHORT: u32 = 20;
/// Wall time in s that the others would take at its pace; through shared memory between a half of that, beside other work, and a
/// fifth: more than a job with a limit of one minute has.
const LONG: f64 = 320.0;

pub fn run() {
    let missing = missing();
    if !missing.is_empty() {
        let told = format!(
            "not there: {}; apt-get install -y slurm-wlm munge",
            missing.join(", ")
        );
        assert!(!std::env::args().any(|word| word == "slurm"), "{told}");
        return println!("  not run: {told}");
    }
    let folder = tempfile::tempdir().unwrap();
    let daemons = folder.path().join("queue");
    fs::create_dir(&daemons).unwrap();
    let queue = Queue::start(&daemons, NODES);
    println!("  munged, slurmctld and {NODES} slurmd are up, all nodes idle");
    let work = Work::new(folder.path());
    array(&queue, &work);
    let (short, pace) = over_mpi(&queue, &work);
    let end = (LONG / pace / 10.0).ceil() as u32 * 10;
    let whole = coupled(&queue, &work, end);
    // The last row is that of the end.
    let count = rows(&short) - 1;
    let apart = largest_difference(&whole, &short, 0, count);
    println!(
        "    first {count} rows of the series against MPI: largest relative difference {apart:.1e}"
    );
    assert_eq!(apart, 0.0);
    requeued(&queue, &work, &whole, end);
    drop(queue);
    println!("  the daemons have ended");
}

/// Where jobs run, with `calcine` on the path.
struct Work {
    folder: PathBuf,
    path: String,
}

impl Work {
    fn new(folder: &Path) -> Self {
        let folder = folder.canonicalize().unwrap();
        let bin = Path::new(env!("CARGO_BIN_EXE_calcine")).parent().unwrap();
        Self {
            path: format!("{}:{}", bin.display(), std::env::var("PATH").unwrap()),
            folder,
        }
    }

    /// Writes a script of the docs: the case, what else is replaced, and where its output goes.
    fn script(&self, name: &str, text: &str, end: u32, replaced: &[(&str, &str)]) -> String {
        let case = format!(
            "'{}' --quiet --set 'time.end={end} s'",
            shipped("heated-column").display()
        );
        let mut text = text.replace("CASE", &case);
        for (from, to) in replaced {
            assert!(
                text.contains(from),
                "`{from}` is not in the script of the docs"
            );
            text = text.replace(from, to);
        }
        let head = "#!/bin/bash\n";
        let text = text.replacen(head, &format!("{head}#SBATCH --output=%x.log\n"), 1);
        let export = format!("export PATH='{}'", self.path);
        // It comes after the last line that sbatch reads.
        let mut lines: Vec<&str> = text.lines().collect();
        let last = lines.iter().rposition(|line| line.starts_with("#SBATCH"));
        lines.insert(last.unwrap() + 1, &export);
        let path = self.folder.join(name);
        fs::write(&path, lines.join("\n") + "\n").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
        name.to_owned()
    }

    fn log(&self, name: &str) -> String {
        fs::read_to_string(self.folder.join(format!("{name}.log"))).unwrap_or_default()
    }

    fn out(&self, name: &str) -> PathBuf {
        self.folder.join("results").join(name)
    }
}

/// A block of docs/how-to/parallel.md with some words in it.
fn documented(words: &str) -> String {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/how-to/parallel.md");
    let docs = fs::read_to_string(docs).unwrap();
    let blocks = docs.split("```sh\n").skip(1);
    let mut blocks = blocks.filter_map(|block| block.split("```").next());
    let found = blocks.find(|block| block.contains(words));
    found
        .unwrap_or_else(|| panic!("no block with `{words}`"))
        .to_owned()
}

/// Two ranks of each solver, with where they ran.
fn assert_two_and_two(seen: &BTreeSet<Rank>, log: &str) {
    for Rank {
        program,
        rank,
        node,
    } in seen
    {
        println!("    {program}, rank {rank}: {node}");
    }
    for program in ["calcineGasFoam", "calcine-liggghts"] {
        let own = seen.iter().filter(|one| one.program == program);
        let numbers: BTreeSet<usize> = own.map(|one| one.rank).collect();
        assert_eq!(numbers, BTreeSet::from([0, 1]), "{program}: {log}");
    }
}

/// That a job ended well.
fn assert_complete(queue: &Queue, job: u32, log: &str) {
    assert_eq!(queue.told(job, "JobState"), ["COMPLETED"], "{log}");
    assert_eq!(queue.told(job, "ExitCode"), ["0:0"], "{log}");
}

const TWO_AND_TWO: [(&str, &str); 5] = [
    ("--ntasks=16", "--ntasks=4"),
    ("--ranks-gas 12", "--ranks-gas 2"),
    ("-n 12", "-n 2"),
    ("--ranks-particles 4", "--ranks-particles 2"),
    ("-n 4", "-n 2"),
];

/// The script for one node, within its limit of time; gives its results.
fn coupled(queue: &Queue, work: &Work, end: u32) -> PathBuf {
    let text = documented("--launch-gas \"srun --overlap");
    let replaced = [&TWO_AND_TWO[..], &[("results/bed", "results/whole")]].concat();
    let job = queue.submit(
        &work.folder,
        &[&work.script("whole", &text, end, &replaced)],
    );
    println!("  job {job}: 2 + 2 ranks by srun, shared memory");
    let seen = queue.follow(job, LIMIT);
    let log = work.log("whole");
    assert_two_and_two(&seen, &log);
    assert_complete(queue, job, &log);
    let out = work.out("whole");
    let summary = Summary::read(&out).unwrap();
    assert_eq!(
        [summary.solver.gas.ranks, summary.solver.particles.ranks],
        [2, 2]
    );
    println!(
        "    {} windows to {} s, {:.0} s of wall time",
        summary.windows, summary.process_time_s, summary.wall_time_s.total
    );
    out
}

/// The script for several nodes: MPI_Comm_spawn on the nodes that SLURM gives. Gives its results, and its wall time a second of
/// process time.
fn over_mpi(queue: &Queue, work: &Work) -> (PathBuf, f64) {
    let text = documented("--transport mpi");
    let replaced = [
        ("--nodes=4 --ntasks=64", "--nodes=2 --ntasks-per-node=4"),
        ("--ranks-gas 48", "--ranks-gas 2"),
        ("--ranks-particles 15", "--ranks-particles 2"),
        ("results/bed", "results/mpi"),
        // All nodes are this machine.
        (
            "mpirun",
            "export OMPI_MCA_btl_tcp_if_include=lo OMPI_MCA_oob_tcp_if_include=lo\n\
             export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1\nmpirun",
        ),
    ];
    let job = queue.submit(
        &work.folder,
        &[&work.script("mpi", &text, SHORT, &replaced)],
    );
    println!("  job {job}: 2 + 2 ranks by MPI_Comm_spawn on two nodes, transport mpi");
    let seen = queue.follow(job, LIMIT);
    let log = work.log("mpi");
    println!("    nodes: {}", queue.told(job, "NodeList").join(" "));
    assert_two_and_two(&seen, &log);
    assert_complete(queue, job, &log);
    let out = work.out("mpi");
    let summary = Summary::read(&out).unwrap();
    assert_eq!(summary.transport, "mpi");
    (out, summary.wall_time_s.total / f64::from(SHORT))
}

/// The script for one node with a limit that the run exceeds.
fn requeued(queue: &Queue, work: &Work, whole: &Path, end: u32) {
    let text = documented("--launch-gas \"srun --overlap");
    // SLURM looks every 30 s at what has a limit of time, and signals up to that much early.
    let limit = [
        ("--time=24:00:00", "--time=1"),
        ("TERM@600", "TERM@15"),
        ("calcine run", "echo \"start $(date +%T)\"\ncalcine run"),
        (
            "exit $code",
            "echo \"exit code $code $(date +%T)\"\nexit $code",
        ),
    ];
    let replaced = [&TWO_AND_TWO[..], &limit].concat();
    let job = queue.submit(
        &work.folder,
        &[&work.script("limited", &text, end, &replaced)],
    );
    println!(
        "  job {job}: the same with one minute of wall time, SIGTERM before it, scontrol requeue"
    );
    queue.follow(job, LIMIT);
    let log = work.log("limited");
    let own = log.lines().filter(|line| {
        ["start", "exit code", "stopped with a checkpoint"]
            .iter()
            .any(|word| line.starts_with(word))
    });
    for line in own {
        println!("    {}", line.split(';').next().unwrap());
    }
    assert_complete(queue, job, &log);
    let restarts: usize = queue.told(job, "Restarts")[0].parse().unwrap();
    println!("    restarts: {restarts}");
    assert!(restarts > 0, "{log}");
    assert_eq!(log.matches("exit code 75").count(), restarts, "{log}");
    let out = work.out("bed");
    let apart = largest_difference(whole, &out, 0, usize::MAX);
    let differing = values_that_differ(whole, &out).len();
    println!(
        "    largest relative difference from the whole run: {apart:.1e}; {differing} datasets differ"
    );
    assert!(apart <= FROZEN, "{apart}");
    assert_eq!(rows(whole), rows(&out));
}

/// A sweep as an array, and what is gathered from it.
fn array(queue: &Queue, work: &Work) {
    let text = documented("sbatch --array");
    let case = format!("'{}'", shipped("heated-column").display());
    let text = text
        .replace("CASE", &case)
        .replace(
            "KEY=A,B,C,D",
            "time.acceleration=4,5,6,7,8,9,10,11 --set time.end=100s --quiet",
        )
        .replace(
            "--array=1-4",
            "--array=1-8 --parsable --output=array-%a.log",
        )
        .replace("results/bed-sweep", "results/swept");
    let (sbatch, gather) = text.split_once("\n\n").unwrap();
    let shell = |line: &str| {
        let mut command = queue.command("bash");
        command.args(["-c", line]).current_dir(&work.folder);
        command.env("PATH", &work.path);
        command.output().unwrap()
    };
    let submitted = shell(sbatch);
    let told = String::from_utf8_lossy(&submitted.stderr);
    let number = String::from_utf8_lossy(&submitted.stdout);
    let job = number
        .trim()
        .parse()
        .unwrap_or_else(|_| panic!("{sbatch}: {told}"));
    println!("  job {job}: a sweep of eight runs as an array");
    queue.follow(job, LIMIT);
    let tasks = queue.told(job, "ArrayTaskId").into_iter();
    let states = queue.told(job, "JobState");
    let nodes = queue.told(job, "NodeList");
    for ((task, state), node) in tasks.zip(&states).zip(&nodes) {
        println!("    task {task}: {node}, {state}");
    }
    assert_eq!(states, ["COMPLETED"; 8], "{}", work.log("array-1"));
    let gathered = shell(gather);
    let told = String::from_utf8_lossy(&gathered.stderr);
    assert!(gathered.status.success(), "{gather}: {told}");
    let out = work.out("swept");
    let table = fs::read_to_string(out.join("sweep.csv")).unwrap();
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    let reports = page.matches("/report.html\">report</a>").count();
    println!(
        "    sweep.csv: {} rows; index.html: {reports} reports",
        table.lines().count() - 1
    );
    assert_eq!((table.lines().count(), reports), (9, 8), "{table}");
}
