//! Set-up, run, test, benchmarks and installation of Calcine, from a clone:
//! `cargo xtask …`. The standard library alone, so that it builds in seconds.

mod adapters;
mod bench;
mod gallery;
mod gas_error;
mod headers;
mod json;
mod measure;
mod openfoam;
mod packages;
mod parcels;
mod python;
mod runs;
mod snapshots;
mod sources;
mod steps;
mod stock;
mod table;
mod tasks;
mod workspace;

use std::env;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::ExitCode;

use packages::Needs;
use steps::{Stop, TaskResult, say};
use workspace::Workspace;

const USAGE: &str = "\
usage: cargo xtask TASK

  run CASE …              install and build what the run needs, then `calcine run CASE …`
  calcine SUBCOMMAND …    the same for any other subcommand, for example `compare CASE`
  test [--native] …       install and build everything and run all tests; further arguments go
                          to `cargo test`
  setup [--native|--all]  install packages, prepare headers, build (default: --all)
        [--no-build]      without building
  install --prefix DIR    build, then copy to DIR/bin and DIR/libexec/calcine, and what solvers in C
                          are compiled against to DIR/include, DIR/lib, DIR/share/calcine
        [--native]        without the adapters for OpenFOAM and LIGGGHTS
  wheel                   build the Python package's wheel into target/wheels
  gallery [CASE …]        run the shipped cases, or those named, and write docs/gallery.md with a
                          picture of each, drawn by Chromium
        [--longest S]     leave out runs of more than S seconds (default: 60)
        [--no-build]      with the program that was built last
  bench …                 run the benchmarks and print one table; further arguments go to
                          `cargo bench`
        [--native]        without OpenFOAM, LIGGGHTS and MPI
        [--runs]          whole runs only
        [--table]         print the table of the last measurement only
  bench gas-error         error against processor time of the native gas, calcineGasFoam and
        [CASE …]          OpenFOAM's own solvers: cavity, taylor-green, heated-cavity,
                          hot-duct, five-species
        [--no-build]      with the programs that were built last
  bench parcels           what parcels cost by phase
        [--no-build]      with the programs that were built last
  bench stock             a simulated second beside programs that are in use, on one core: DPMFoam,
        [TABLE …]         MPPICFoam, LIGGGHTS and pimpleFoam: beads, fluidised, still,
                          parcels, parcels-fine, particles, gas
        [--no-build]      with the programs that were built last
  bench python-overhead   processor time of runs from Python beyond that of `calcine run`, with
        [ROUNDS [CASE …]] the same bits: 5 rounds of moving-bed by default; KEY=VALUE changes it
  fuzz [--minutes N]      fuzz the readers of users' files, ten minutes each by default
        [--seed S]        of case, polymesh, stl, csv, curves, vtk, foam, set, checkpoint
        [TARGET …]
  torture [--kills N]     kill runs at random moments, resume, compare every bit (default: 50)
        [--seed S]        the seed of the random numbers
        [--from K]        begin with the K-th kill, to repeat one
  faults [--kills N]      random fault injection: kill or stop a process of a coupled run at a
        [--seed S]        random moment and check that it is named, that everything ends and
        [--from K]        that nothing is left (default: 500 trials)
  validate [NAME …]       long validations, all by default: agreement, backward-step,
                          checkpoint-faults, drum-restarts, elastic-box, external-restarts, flame,
                          fluidised-bed, heated-cavity, hopper, load, moving-bed, moving-resolved-bed, paraview,
                          parcel-beds, repose, report-pages, restarts, shaft-choices, shaft-flames,
                          shaft-furnace, skewed-cavity, skewed-cavity-1000, skewed-meshes, slurm,
                          spouted-bed, square-cylinder, tg-furnace, voids";

/// Exit code of a wrong command line, as `calcine` has it.
const USAGE_CODE: u8 = 2;

fn main() -> ExitCode {
    let words: Vec<OsString> = env::args_os().skip(1).collect();
    let Some(task) = read(&words) else {
        say(USAGE);
        let asked = words.first().is_some_and(|word| word == "help")
            || words.iter().any(|word| word == "--help" || word == "-h");
        return if asked {
            ExitCode::SUCCESS
        } else {
            ExitCode::from(USAGE_CODE)
        };
    };
    match perform(task) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Stop(message)) => {
            say(&message);
            ExitCode::FAILURE
        }
    }
}

/// What the user asks for.
#[derive(Debug, PartialEq)]
enum Task {
    SetUp {
        needs: Needs,
        build: bool,
    },
    Calcine(Vec<OsString>),
    Test {
        native: bool,
        words: Vec<OsString>,
    },
    Wheel,
    Gallery(gallery::GalleryChoice),
    Bench(bench::Choice),
    GasError(gas_error::ErrorChoice),
    Stock(stock::StockChoice),
    /// Whether to measure the programs that were built last.
    Parcels {
        built: bool,
    },
    PythonOverhead(Vec<OsString>),
    /// A test program of its own, with its words.
    Program {
        name: &'static str,
        needs: Needs,
        words: Vec<OsString>,
    },
    Install {
        prefix: PathBuf,
        needs: Needs,
    },
}

fn read(words: &[OsString]) -> Option<Task> {
    let (task, rest) = words.split_first()?;
    match task.to_str()? {
        "setup" => set_up(rest),
        "run" => Some(Task::Calcine(words.to_vec())),
        "calcine" if !rest.is_empty() => Some(Task::Calcine(rest.to_vec())),
        "test" => {
            let native = rest.first().is_some_and(|word| word == "--native");
            Some(Task::Test {
                native,
                words: rest[usize::from(native)..].to_vec(),
            })
        }
        "wheel" if rest.is_empty() => Some(Task::Wheel),
        "gallery" => gallery::GalleryChoice::read(rest).map(Task::Gallery),
        "bench" if rest.first().is_some_and(|word| word == "gas-error") => {
            let words = rest[1..].iter().map(|word| word.to_str());
            gas_error::ErrorChoice::read(words).map(Task::GasError)
        }
        "bench" if rest.first().is_some_and(|word| word == "parcels") => match &rest[1..] {
            [] => Some(Task::Parcels { built: false }),
            [word] if word == "--no-build" => Some(Task::Parcels { built: true }),
            _ => None,
        },
        "bench" if rest.first().is_some_and(|word| word == "stock") => {
            let words = rest[1..].iter().map(|word| word.to_str());
            stock::StockChoice::read(words).map(Task::Stock)
        }
        "bench" if rest.first().is_some_and(|word| word == "python-overhead") => {
            let rounds = rest.get(1).map(|word| word.to_str()?.parse::<u32>().ok());
            rounds
                .unwrap_or(Some(1))
                .filter(|rounds| *rounds > 0)
                .map(|_| Task::PythonOverhead(rest[1..].to_vec()))
        }
        "bench" => {
            let first = |name: &str| rest.first().is_some_and(|word| word == name);
            let (table_only, native) = (first("--table"), first("--native"));
            let runs_only = first("--runs");
            Some(Task::Bench(bench::Choice {
                table_only,
                native,
                runs_only,
                words: rest[usize::from(table_only || native || runs_only)..].to_vec(),
            }))
        }
        "fuzz" => program("fuzz", Needs::NATIVE, ["--minutes", "10"], rest),
        "torture" => program("torture", Needs::NATIVE, ["--kills", "50"], rest),
        "faults" => program("faults_random", Needs::ALL, ["--kills", "500"], rest),
        "validate" => Some(Task::Program {
            name: "validate",
            needs: Needs::ALL,
            words: [&[OsString::from("--validate")], rest].concat(),
        }),
        "install" => install(rest),
        _ => None,
    }
}

/// A test program; unless the words hold its option, with the option's usual value. Nothing where a word is neither a name nor
/// an option of theirs, or an option's value is not a number.
fn program(name: &'static str, needs: Needs, usual: [&str; 2], words: &[OsString]) -> Option<Task> {
    let mut texts = words.iter();
    while let Some(word) = texts.next() {
        let word = word.to_str()?;
        if word == usual[0] || word == "--seed" || word == "--from" {
            texts.next()?.to_str()?.parse::<u64>().ok()?;
        } else if word.starts_with('-') {
            return None;
        }
    }
    let mut words = words.to_vec();
    if !words.iter().any(|word| word == usual[0]) {
        words.extend(usual.map(OsString::from));
    }
    Some(Task::Program { name, needs, words })
}

fn set_up(words: &[OsString]) -> Option<Task> {
    let (mut needs, mut build) = (Needs::ALL, true);
    for word in words {
        match word.to_str()? {
            "--native" => needs = Needs::NATIVE,
            "--all" => needs = Needs::ALL,
            "--no-build" => build = false,
            _ => return None,
        }
    }
    Some(Task::SetUp { needs, build })
}

fn install(words: &[OsString]) -> Option<Task> {
    let mut needs = Needs {
        tests: false,
        python: false,
        ..Needs::ALL
    };
    let mut prefix = None;
    let mut words = words.iter();
    while let Some(word) = words.next() {
        match word.to_str() {
            Some("--native") => needs = Needs::NATIVE,
            Some("--prefix") => prefix = Some(PathBuf::from(words.next()?)),
            Some(text) => prefix = Some(PathBuf::from(text.strip_prefix("--prefix=")?)),
            None => return None,
        }
    }
    Some(Task::Install {
        prefix: prefix?,
        needs,
    })
}

fn perform(task: Task) -> TaskResult<()> {
    let workspace = Workspace::find()?;
    match task {
        Task::SetUp { needs, build } => tasks::set_up(&workspace, needs, build),
        Task::Calcine(words) => tasks::run(&workspace, &words),
        Task::Test { native, words } => tasks::test(&workspace, native, &words),
        Task::Wheel => tasks::wheel(&workspace),
        Task::Gallery(choice) => gallery::run(&workspace, &choice),
        Task::Bench(choice) => bench::run(&workspace, &choice),
        Task::GasError(choice) => gas_error::run(&workspace, &choice),
        Task::Stock(choice) => stock::run(&workspace, &choice),
        Task::Parcels { built } => parcels::run(&workspace, built),
        Task::PythonOverhead(words) => python::overhead(&workspace, &words),
        Task::Program { name, needs, words } => tasks::program(&workspace, name, needs, &words),
        Task::Install { prefix, needs } => tasks::install(&workspace, &prefix, needs),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;

    fn words(line: &str) -> Vec<OsString> {
        line.split_whitespace().map(OsString::from).collect()
    }

    #[test]
    fn run_and_calcine_hand_their_words_on() {
        assert_eq!(
            read(&words("run a.toml")),
            Some(Task::Calcine(words("run a.toml")))
        );
        assert_eq!(
            read(&words("calcine check a")),
            Some(Task::Calcine(words("check a")))
        );
        assert_eq!(read(&words("calcine")), None);
    }

    #[test]
    fn set_up_is_of_everything_unless_told() {
        let task = |needs, build| Some(Task::SetUp { needs, build });
        assert_eq!(read(&words("setup")), task(Needs::ALL, true));
        assert_eq!(
            read(&words("setup --native --no-build")),
            task(Needs::NATIVE, false)
        );
        assert_eq!(read(&words("setup --everything")), None);
    }

    #[test]
    fn fuzzing_and_torture_have_their_usual_length_unless_told() {
        let task = |name, needs, line: &str| {
            let words = words(line);
            Some(Task::Program { name, needs, words })
        };
        let fuzz = |line| task("fuzz", Needs::NATIVE, line);
        assert_eq!(read(&words("fuzz case")), fuzz("case --minutes 10"));
        let given = fuzz("--minutes 1 polymesh");
        assert_eq!(read(&words("fuzz --minutes 1 polymesh")), given);
        let torture = task("torture", Needs::NATIVE, "--kills 50");
        assert_eq!(read(&words("torture")), torture);
        let faults = task("faults_random", Needs::ALL, "--kills 500");
        assert_eq!(read(&words("faults")), faults);
        for line in [
            "faults --help",
            "faults --kill 3",
            "torture --kills",
            "fuzz --seed x",
        ] {
            assert_eq!(read(&words(line)), None, "{line}");
        }
        let validate = task("validate", Needs::ALL, "--validate hopper");
        assert_eq!(read(&words("validate hopper")), validate);
    }

    #[test]
    fn the_benchmark_of_errors_takes_names_of_its_cases() {
        let choice = gas_error::ErrorChoice {
            names: vec!["cavity".into()],
            built: true,
        };
        let task = read(&words("bench gas-error cavity --no-build"));
        assert_eq!(task, Some(Task::GasError(choice)));
        assert_eq!(read(&words("bench gas-error cavities")), None);
    }

    #[test]
    fn the_overhead_of_python_takes_a_number_of_rounds_and_a_case() {
        let overhead = |line: &str| Some(Task::PythonOverhead(words(line)));
        assert_eq!(read(&words("bench python-overhead")), overhead(""));
        let line = "3 cases/hopper.toml time.end=1s";
        let task = read(&words(&format!("bench python-overhead {line}")));
        assert_eq!(task, overhead(line));
        assert_eq!(read(&words("bench python-overhead often")), None);
    }

    #[test]
    fn an_installation_needs_a_prefix() {
        let needs = Needs {
            tests: false,
            python: false,
            ..Needs::ALL
        };
        let prefix = PathBuf::from("/opt/calcine");
        let task = Some(Task::Install { prefix, needs });
        assert_eq!(read(&words("install --prefix /opt/calcine")), task);
        assert_eq!(read(&words("install --prefix=/opt/calcine")), task);
        assert_eq!(read(&words("install")), None);
        assert_eq!(read(&words("install /opt/calcine")), None);
    }

    /// Tasks in the lines of the docs that begin with `cargo xtask`, without comments.
    fn tasks_of_the_docs() -> Vec<String> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
        let mut folders = vec![root.join("docs")];
        let mut pages = vec![root.join("README.md"), root.join("CONTRIBUTING.md")];
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    folders.push(path);
                } else if path.extension().is_some_and(|ending| ending == "md") {
                    pages.push(path);
                }
            }
        }
        let texts = pages
            .iter()
            .map(|page| std::fs::read_to_string(page).unwrap());
        let text: String = texts.collect();
        let lines = text.lines().map(str::trim_start);
        let tasks = lines.filter_map(|line| line.strip_prefix("cargo xtask "));
        tasks
            .map(|task| task.split(" #").next().unwrap().to_owned())
            .collect()
    }

    #[test]
    fn every_task_of_the_docs_is_one() {
        let tasks = tasks_of_the_docs();
        assert!(tasks.len() > 15, "{tasks:?}");
        for task in tasks {
            assert!(read(&words(&task)).is_some(), "cargo xtask {task}");
        }
    }
}
