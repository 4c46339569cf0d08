//! A SLURM of its own on this machine: munge, a controller and several nodes, in a folder, with ports of its own.
//! Another one that may run here is not touched.

use std::collections::BTreeSet;
use std::fs;
use std::net::TcpListener;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};

/// Processors that each node says it has.
const PROCESSORS: usize = 4;
/// How long daemons may take to start, or to end.
const PATIENCE: Duration = Duration::from_secs(60);

/// The queue; its daemons end with it.
pub struct Queue {
    folder: PathBuf,
    daemons: Vec<Child>,
}

/// A process of a solver as it was seen at work.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Rank {
    pub program: String,
    pub rank: usize,
    pub node: String,
}

/// The programs that the queue takes which are not there.
pub fn missing() -> Vec<&'static str> {
    let programs = [
        "munged",
        "slurmctld",
        "slurmd",
        "srun",
        "sbatch",
        "scontrol",
    ];
    let there = |name: &&str| {
        let folders = ["/usr/sbin", "/usr/bin", "/usr/local/sbin", "/usr/local/bin"];
        folders
            .iter()
            .any(|folder| Path::new(folder).join(name).is_file())
    };
    programs.into_iter().filter(|name| !there(name)).collect()
}

/// What a command prints; it must succeed.
fn printed(mut command: Command) -> String {
    let output = command.output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {told}");
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

/// Ports that nothing listens at.
fn ports(count: usize) -> Vec<u16> {
    let held = (0..count).map(|_| TcpListener::bind("127.0.0.1:0").unwrap());
    let held: Vec<TcpListener> = held.collect();
    held.iter()
        .map(|one| one.local_addr().unwrap().port())
        .collect()
}

impl Queue {
    /// Starts it with so many nodes, `node1` and so on.
    pub fn start(folder: &Path, nodes: usize) -> Self {
        let folder = folder.canonicalize().unwrap();
        for name in ["state", "log"] {
            fs::create_dir(folder.join(name)).unwrap();
        }
        let place = folder.display();
        let mut shell = Command::new("sh");
        shell.args(["-c", "umask 077; head -c 1024 /dev/urandom > munge.key"]);
        printed({
            shell.current_dir(&folder);
            shell
        });
        let [user, host] = [("id", "-un"), ("hostname", "-s")].map(|(program, option)| {
            let mut command = Command::new(program);
            command.arg(option);
            printed(command)
        });
        let ports = ports(nodes + 1);
        let (controller, others) = ports.split_first().unwrap();
        let mut text = format!(
            "ClusterName=validation
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket={place}/munge.socket,cred_expire=10
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={place}/state
SlurmdSpoolDir={place}/spool-%n
SlurmctldPidFile={place}/slurmctld.pid
SlurmdPidFile={place}/slurmd-%n.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=pmix
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SlurmdParameters=config_overrides
JobRequeue=1
ReturnToService=2
MailProg=/bin/true
PartitionName=all Nodes=ALL Default=YES State=UP
"
        );
        for (number, port) in others.iter().enumerate() {
            text += &format!(
                "NodeName=node{} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={PROCESSORS}\n",
                number + 1
            );
        }
        fs::write(folder.join("slurm.conf"), text).unwrap();
        let mut queue = Self {
            folder,
            daemons: Vec::new(),
        };
        let option = |name: &str, file: &str| format!("--{name}={}/{file}", queue.folder.display());
        let munge = [
            option("key-file", "munge.key"),
            option("socket", "munge.socket"),
            option("pid-file", "munged.pid"),
            option("log-file", "log/munged"),
            option("seed-file", "munge.seed"),
        ];
        let mut words = vec!["--foreground".to_owned(), "--force".to_owned()];
        words.extend(munge);
        queue.daemon("munged", &words);
        let socket = queue.folder.join("munge.socket");
        wait_until("munge answers", || socket.exists());
        queue.daemon("slurmctld", &["-D".into(), "-c".into()]);
        for number in 1..=nodes {
            let name = format!("node{number}");
            queue.daemon("slurmd", &["-D".into(), "-c".into(), "-N".into(), name]);
        }
        wait_until("all nodes are idle", || {
            let mut command = queue.command("sinfo");
            command.args(["-h", "-N", "-o", "%t"]);
            let output = command.output().unwrap();
            let states = String::from_utf8(output.stdout).unwrap();
            states
                .lines()
                .filter(|state| state.trim() == "idle")
                .count()
                == nodes
        });
        queue
    }

    /// A program that knows this queue.
    pub fn command(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.env("SLURM_CONF", self.folder.join("slurm.conf"));
        let path = std::env::var("PATH").unwrap();
        command.env("PATH", format!("{path}:/usr/sbin"));
        command
    }

    fn daemon(&mut self, program: &str, words: &[String]) {
        let log = self.folder.join("log").join(self.daemons.len().to_string());
        let log = fs::File::create(log).unwrap();
        let mut command = self.command(program);
        command.args(words).stdin(Stdio::null());
        command.stdout(log.try_clone().unwrap()).stderr(log);
        self.daemons.push(command.spawn().unwrap());
    }

    /// Hands a script in, in a folder, and gives the job's number.
    pub fn submit(&self, folder: &Path, words: &[&str]) -> u32 {
        let mut command = self.command("sbatch");
        command.arg("--parsable").args(words).current_dir(folder);
        printed(command).parse().unwrap()
    }

    /// What the controller says of a job under a name, of each task of an array.
    pub fn told(&self, job: u32, name: &str) -> Vec<String> {
        let mut command = self.command("scontrol");
        command.args(["show", "job", "-o", &job.to_string()]);
        let text = printed(command);
        let start = format!("{name}=");
        let values = text.lines().filter_map(|line| {
            let word = line.split(' ').find(|word| word.starts_with(&start))?;
            Some(word[start.len()..].to_owned())
        });
        values.collect()
    }

    /// Follows a job to its end; gives the ranks of the solvers that were seen at work.
    pub fn follow(&self, job: u32, limit: Duration) -> BTreeSet<Rank> {
        let begun = Instant::now();
        let mut seen = BTreeSet::new();
        loop {
            seen.extend(ranks(job));
            let states = self.told(job, "JobState");
            let over = |state: &String| {
                ["COMPLETED", "FAILED", "CANCELLED", "TIMEOUT", "NODE_FAIL"].contains(&&state[..])
            };
            if !states.is_empty() && states.iter().all(over) {
                return seen;
            }
            assert!(begun.elapsed() < limit, "job {job}: {states:?}");
            sleep(Duration::from_millis(500));
        }
    }
}

impl Drop for Queue {
    fn drop(&mut self) {
        // Where a validation failed there may be jobs; what cannot be stopped is told by what is left.
        let mut cancel = self.command("scancel");
        let _ = cancel.args(["--state=RUNNING", "--signal=KILL"]).status();
        let mut cancel = self.command("scancel");
        let _ = cancel.arg("--state=PENDING").status();
        // The nodes first, munge last.
        for daemon in self.daemons.iter_mut().rev() {
            let id = i32::try_from(daemon.id()).ok().and_then(Pid::from_raw);
            if let Some(id) = id {
                let _ = kill_process(id, Signal::TERM);
            }
            let begun = Instant::now();
            while matches!(daemon.try_wait(), Ok(None)) && begun.elapsed() < PATIENCE {
                sleep(Duration::from_millis(50));
            }
            let _ = daemon.kill();
            let _ = daemon.wait();
        }
    }
}

fn wait_until(what: &str, holds: impl Fn() -> bool) {
    let begun = Instant::now();
    while !holds() {
        assert!(begun.elapsed() < PATIENCE, "it takes too long until {what}");
        sleep(Duration::from_millis(200));
    }
}

/// The ranks of solvers that a job has on this machine: the nodes are all here.
fn ranks(job: u32) -> Vec<Rank> {
    let processes = fs::read_dir("/proc").unwrap().flatten();
    let rank = |process: fs::DirEntry| {
        let read = |name: &str| fs::read(process.path().join(name)).ok();
        let line = read("cmdline")?;
        let program = String::from_utf8_lossy(line.split(|byte| *byte == 0).next()?).into_owned();
        let program = Path::new(&program).file_name()?.to_str()?.to_owned();
        if !["calcineGasFoam", "calcine-liggghts"].contains(&&program[..]) {
            return None;
        }
        let variables = String::from_utf8_lossy(&read("environ")?).into_owned();
        let value = |name: &str| {
            let start = format!("{name}=");
            let found = variables.split('\0').find(|one| one.starts_with(&start))?;
            Some(found[start.len()..].to_owned())
        };
        if value("SLURM_JOB_ID")? != job.to_string() {
            return None;
        }
        // Open MPI's, where it started the rank, else SLURM's.
        let rank = value("OMPI_COMM_WORLD_RANK").or_else(|| value("SLURM_PROCID"))?;
        Some(Rank {
            program,
            rank: rank.parse().ok()?,
            node: value("SLURMD_NODENAME")?,
        })
    };
    processes.filter_map(rank).collect()
}
