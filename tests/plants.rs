//! Plants by the command: what is refused and how it is told, both methods of recycles against each other, a run that is
//! killed and goes on to the same bits, steady states against long runs, results and their page.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use calcine::case::plant::read_plant;
use calcine::plant::PlantSummary;

use crate::support::program;
use crate::support::stopped::{Stopped, stop};

pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let mut found: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    found.sort();
    found
}

pub fn calcine(words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(words).output().unwrap()
}

pub fn said(output: &Output) -> String {
    let texts = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    texts.concat()
}

/// Runs a case into a folder with these settings; what it said.
pub fn run(case: &Path, out: &Path, settings: &[&str], words: &[&str]) -> Output {
    let mut all = vec!["run", case.to_str().unwrap(), "--quiet"];
    for setting in settings {
        all.extend(["--set", setting]);
    }
    all.extend(["--out", out.to_str().unwrap()]);
    all.extend(words);
    calcine(&all)
}

/// (line, message, remedy) of each `#^`, which stands under its line or under another; `#>` under it is its remedy.
fn expected(text: &str) -> Vec<(usize, String, Option<String>)> {
    let (mut line, mut found) = (0, Vec::new());
    for (number, content) in (1..).zip(text.lines()) {
        let content = content.trim_start();
        if let Some(message) = content.strip_prefix("#^ ") {
            found.push((line, message.to_owned(), None));
        } else if let Some(remedy) = content.strip_prefix("#> ") {
            found.last_mut().unwrap().2 = Some(remedy.to_owned());
        } else {
            line = number;
        }
    }
    found
}

#[test]
fn every_bad_plant_gives_its_messages_all_at_once_each_with_a_remedy() {
    let all = files("tests/inputs/plants/bad");
    assert!(all.len() >= 40, "{} bad plants", all.len());
    for path in all {
        let mut wanted = expected(&fs::read_to_string(&path).unwrap());
        assert!(!wanted.is_empty(), "{} holds no message", path.display());
        let Err(errors) = read_plant(&path, &[]) else {
            panic!("{} was read without an error", path.display());
        };
        let problems = errors.problems().iter();
        let found = problems.map(|one| (one.line, one.message.clone(), Some(one.help.clone())));
        let mut found: Vec<(usize, String, Option<String>)> = found.collect();
        found.sort();
        wanted.sort();
        // A fixture without a remedy leaves it open.
        for (one, own) in wanted.iter_mut().zip(&found) {
            one.2 = one.2.take().or_else(|| own.2.clone());
        }
        assert_eq!(found, wanted, "{}", path.display());
        for problem in errors.problems() {
            let message = &problem.message;
            assert!(!problem.help.is_empty(), "{}: {message}", path.display());
        }
    }
}

/// Every good plant runs with all its balances closed, writes its files, and has a report.
#[test]
fn every_good_plant_closes_and_leaves_its_results() {
    let folder = tempfile::tempdir().unwrap();
    for case in files("tests/inputs/plants/good") {
        let name = case.file_stem().unwrap();
        let out = folder.path().join(name);
        let checked = calcine(&["check", case.to_str().unwrap()]);
        assert!(checked.status.success(), "{}", said(&checked));
        let output = run(&case, &out, &[], &[]);
        assert!(output.status.success(), "{}", said(&output));
        let summary = PlantSummary::read(&out).unwrap();
        let ledger = &summary.ledger;
        assert!(ledger.loop_closure <= 1e-12, "{}", ledger.loop_closure);
        for line in &ledger.lines {
            assert!(line.relative_error < 1e-10, "{name:?}: {line:?}");
        }
        for file in [
            "series.csv",
            "distributions.csv",
            "streams.csv",
            "report.html",
            "status.json",
        ] {
            let text = fs::read_to_string(out.join(file)).unwrap();
            assert!(text.len() > 50, "{name:?}: {file}");
        }
        let page = fs::read_to_string(out.join("report.html")).unwrap();
        assert!(page.contains("aria-label=\"Flowsheet\""));
        let read = read_plant(&case, &[]).unwrap();
        for stream in read.plant.streams() {
            assert!(page.contains(&format!(">{stream}")), "{name:?}: {stream}");
        }
    }
}

/// The shipped plants run for a little while, whatever their bands say of it.
#[test]
fn the_shipped_plants_run_and_close() {
    let folder = tempfile::tempdir().unwrap();
    for (name, settings) in [
        (
            "granulation-plant",
            ["time.end=40 s", "sizes.uniform.classes=100"],
        ),
        (
            "granulation-oscillation",
            ["time.end=40 s", "continuation.values=[\"4\", \"6\"]"],
        ),
    ] {
        let case = root().join(format!("cases/{name}.toml"));
        let out = folder.path().join(name);
        let output = run(&case, &out, &settings, &[]);
        let code = output.status.code();
        assert!([Some(0), Some(5)].contains(&code), "{}", said(&output));
        let summary = PlantSummary::read(&out).unwrap();
        assert!(summary.ledger.largest_relative_error < 1e-12);
        assert!(summary.ledger.loop_closure <= 1e-12);
    }
}

/// A run that ends soon after its first checkpoint, by SIGTERM and by a kill, and goes on: what a whole run left.
fn goes_on_to_the_same_bits(case: &Path, settings: &[&str], whole: &Path) {
    let folder = tempfile::tempdir().unwrap();
    for name in ["stopped", "killed"] {
        let out = folder.path().join(name);
        let mut command = program::command(case, &out, &[], settings);
        let saved = out.join("checkpoint/plant.json");
        if name == "stopped" {
            let ended = stop(command, |_| saved.exists());
            assert_eq!(ended, Stopped::Checkpointed);
        } else {
            let mut child = command.stdout(std::process::Stdio::null()).spawn().unwrap();
            while !saved.exists() && child.try_wait().unwrap().is_none() {
                std::thread::sleep(std::time::Duration::from_millis(2));
            }
            let _ = child.kill();
            child.wait().unwrap();
        }
        let output = calcine(&["run", "--resume", out.to_str().unwrap(), "--quiet"]);
        let code = output.status.code();
        assert!([Some(0), Some(5)].contains(&code), "{}", said(&output));
        for file in ["series.csv", "distributions.csv", "streams.csv"] {
            let read = |folder: &Path| fs::read(folder.join(file)).unwrap();
            assert!(read(&out) == read(whole), "{name}: {file}");
        }
        let [one, other] = [&out, whole].map(|folder| PlantSummary::read(folder).unwrap());
        assert_eq!(one.ledger, other.ledger);
        assert_eq!(one.quantities, other.quantities);
    }
}

#[test]
fn a_run_that_was_stopped_or_killed_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("cases/granulation-plant.toml");
    let settings = [
        "time.end=400 s",
        "sizes.uniform.classes=100",
        "time.checkpoint={ every = \"20 s\" }",
    ];
    let whole = folder.path().join("whole");
    run(&case, &whole, &settings, &[]);
    goes_on_to_the_same_bits(&case, &settings, &whole);
}

/// Compounds and enthalpy of the shipped shaft close in its plant's ledger, where the heat is what the bed's gas gave and
/// what the bed holds is read off its particles; a run that is killed between checkpoints goes on to the same bits.
#[test]
fn a_bed_in_a_plant_closes_and_is_resumed_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("cases/heated-shaft.toml");
    let settings = [
        "time.end=16 s",
        "time.checkpoint={ every = \"4 s\" }",
        "output.distributions=8 s",
    ];
    let whole = folder.path().join("whole");
    let output = run(&case, &whole, &settings, &[]);
    let code = output.status.code();
    assert!([Some(0), Some(5)].contains(&code), "{}", said(&output));
    let summary = PlantSummary::read(&whole).unwrap();
    for line in &summary.ledger.lines {
        assert!(line.relative_error < 1e-10, "{line:?}");
    }
    let heat = |what: &str| {
        let line = summary.ledger.lines.iter();
        line.filter(|line| line.place == "shaft" && line.what == what)
            .map(|line| line.heat)
            .sum::<f64>()
    };
    assert!(heat("enthalpy") > 100.0, "{} J", heat("enthalpy"));
    // What came is half small and half large, within a particle of each.
    let page = fs::read_to_string(whole.join("report.html")).unwrap();
    assert!(page.contains("aria-label=\"Flowsheet\""));
    assert!(whole.join("beds/shaft/summary.json").exists());
    goes_on_to_the_same_bits(&case, &settings, &whole);
    let refused = run(
        &case,
        &folder.path().join("from"),
        &[],
        &["--from", whole.to_str().unwrap()],
    );
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        said(&refused).contains("does not go with the bed \"shaft\""),
        "{}",
        said(&refused)
    );
}

/// The plant's checkpoint and the bed's before it: a run that was killed between the two goes on from that.
#[test]
fn a_bed_that_is_ahead_of_its_plant_goes_back_to_the_checkpoint_that_belongs_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("cases/heated-shaft.toml");
    let settings = ["time.end=12 s", "time.checkpoint={ every = \"4 s\" }"];
    let [whole, part] = ["whole", "part"].map(|name| folder.path().join(name));
    run(&case, &whole, &settings, &[]);
    let mut child = Command::new(env!("CARGO_BIN_EXE_calcine"));
    child.args(["run", case.to_str().unwrap(), "--quiet", "--out"]);
    child.arg(&part);
    for setting in settings {
        child.args(["--set", setting]);
    }
    let mut child = child.stdout(std::process::Stdio::null()).spawn().unwrap();
    let before = part.join("beds/shaft/checkpoint.before");
    let saved = part.join("checkpoint/plant.json");
    let mut first = None;
    while !before.exists() && child.try_wait().unwrap().is_none() {
        first = fs::read(&saved).ok().or(first);
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let _ = child.kill();
    child.wait().unwrap();
    // As if the kill had come before the plant wrote its second checkpoint.
    fs::write(&saved, first.unwrap()).unwrap();
    let output = calcine(&["run", "--resume", part.to_str().unwrap(), "--quiet"]);
    let code = output.status.code();
    assert!([Some(0), Some(5)].contains(&code), "{}", said(&output));
    let read = |folder: &Path| fs::read(folder.join("series.csv")).unwrap();
    assert!(read(&part) == read(&whole));
}

/// By the program, with windows of its own in the case, which the monolithic run leaves idle.
#[test]
fn both_methods_of_recycles_agree_within_a_millionth() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(root().join("cases/granulation-plant.toml")).unwrap();
    let windows =
        "[method]\nrecycles = \"waveform\"\nwaveform = { first = \"0.5 s\", longest = \"8 s\" }\n";
    assert!(text.contains("[method]\n"));
    let case = folder.path().join("windows.toml");
    fs::write(&case, text.replace("[method]\n", windows)).unwrap();
    let out = folder.path().join("compared");
    let words = [
        "compare",
        case.to_str().unwrap(),
        "--quiet",
        "--set",
        "time.end=100 s",
        "--set",
        "sizes.uniform.classes=60",
        "--set",
        "method.tolerance=1e-8",
        "--out",
        out.to_str().unwrap(),
    ];
    let output = calcine(&words);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(0), "{text}");
    // All seven quantities have bands of a millionth.
    assert_eq!(text.matches("agrees within 1.0").count(), 7, "{text}");
    let both = ["monolithic", "waveform"].map(|name| out.join(name));
    for (folder, name) in both.iter().zip(["monolithic", "waveform"]) {
        let summary = PlantSummary::read(folder).unwrap();
        assert_eq!(summary.recycles, name);
        assert!(summary.ledger.loop_closure <= 1e-12);
        assert!(summary.ledger.tears.values().all(|apart| *apart <= 1e-12));
        let again = calcine(&["report", folder.to_str().unwrap()]);
        assert!(again.status.success(), "{}", said(&again));
    }
    let results = format!("{},{}", both[0].display(), both[1].display());
    let words = ["compare", case.to_str().unwrap(), "--results", &results];
    let again = calcine(&words);
    assert!(again.status.success(), "{}", said(&again));
}

/// The plant of every unit by windows at a tolerance of 1e-8, with both accelerations.
#[test]
fn windows_agree_with_closed_recycles_on_every_unit() {
    let folder = tempfile::tempdir().unwrap();
    let windows = root().join("tests/inputs/plants/good/every-unit.toml");
    let text = fs::read_to_string(&windows).unwrap();
    let (head, rest) = text.split_once("[method.waveform]").unwrap();
    let rest = rest.split_once("\n[").unwrap().1;
    let closed = folder.path().join("closed.toml");
    fs::write(&closed, format!("{head}[{rest}")).unwrap();
    let of = |name: &str, settings: &[&str]| {
        let out = folder.path().join(name);
        let all = [&["method.tolerance=1e-8", "time.end=2 s"], settings].concat();
        let case = if name == "monolithic" {
            &closed
        } else {
            &windows
        };
        let output = run(case, &out, &all, &[]);
        let code = output.status.code();
        assert!(
            [Some(0), Some(5)].contains(&code),
            "{name}: {}",
            said(&output)
        );
        let summary = PlantSummary::read(&out).unwrap();
        let tears = &summary.ledger.tears;
        assert!(
            !tears.is_empty() && tears.values().all(|apart| *apart <= 1e-12),
            "{tears:?}"
        );
        let values = summary.quantities.into_values();
        values.map(|one| one.value.unwrap()).collect::<Vec<f64>>()
    };
    let closed = of("monolithic", &["method.recycles=monolithic"]);
    for acceleration in ["anderson", "wegstein"] {
        let setting = format!("method.waveform.acceleration={acceleration}");
        let found = of(acceleration, &["method.recycles=waveform", &setting]);
        for (one, other) in found.iter().zip(&closed) {
            assert!(
                (one / other - 1.0).abs() < 1e-6,
                "{acceleration}: {one} {other}"
            );
        }
    }
}

/// A long run of a screen that is flat enough ends in the steady state that Newton's iteration finds, whose dominant mode
/// decays as published; and `--from` begins there.
#[test]
fn a_long_run_ends_in_the_steady_state_and_another_begins_there() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("cases/granulation-oscillation.toml");
    let text = fs::read_to_string(&case).unwrap();
    let (head, _) = text.split_once("[continuation]").unwrap();
    let own = folder.path().join("flat.toml");
    let steady = "[steady]\n\n[[quantities]]\nname = \"decay\"\nmeasure = { steady = \"growth_rate\" }\n\
                  expect = { value = \"-1.98e-3 1/s\", within = \"2 %\" }\n\n[[quantities]]\nname = \"distance\"\n\
                  measure = { steady = \"distance\" }\nexpect = { value = 0, within = \"1e-8\" }\n";
    fs::write(&own, format!("{head}{steady}")).unwrap();
    let settings = [
        "units.coarse screen.screen.sharpness=8",
        "units.fine screen.screen.sharpness=8",
        "method.tolerance=1e-7",
        "time.end=14000 s",
        "output.every=1000 s",
        "output.distributions=7000 s",
    ];
    let out = folder.path().join("out");
    let output = run(&own, &out, &settings, &[]);
    assert!(output.status.success(), "{}", said(&output));
    let next = folder.path().join("next");
    let from = ["--from", out.to_str().unwrap()];
    let mut short = settings;
    short[3] = "time.end=10 s";
    let output = run(&own, &next, &short, &from);
    assert!(output.status.success(), "{}", said(&output));
    let steady = PlantSummary::read(&next).unwrap().steady.unwrap();
    assert!(steady.distance < 1e-8, "{}", steady.distance);
}

/// Each case of the folder says in its first line what its run ends with.
#[test]
fn what_fails_in_time_is_told_with_its_place_and_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let all = files("tests/inputs/plants/stops");
    assert!(all.len() >= 5);
    for case in all {
        let text = fs::read_to_string(&case).unwrap();
        let wanted = text
            .lines()
            .next()
            .and_then(|line| line.strip_prefix("#! "));
        let wanted = wanted.unwrap_or_else(|| panic!("{} has no message", case.display()));
        let out = folder.path().join(case.file_stem().unwrap());
        let output = run(&case, &out, &[], &[]);
        assert_eq!(
            output.status.code(),
            Some(3),
            "{}: {}",
            case.display(),
            said(&output)
        );
        assert!(
            said(&output).contains(wanted),
            "{}: {}",
            case.display(),
            said(&output)
        );
        // Fact, and what to do.
        assert!(said(&output).contains("; "), "{}", said(&output));
    }
}

#[test]
fn a_plant_is_swept_and_made_anew_and_takes_no_solver_of_beds() {
    let folder = tempfile::tempdir().unwrap();
    let case = root().join("tests/inputs/plants/good/recycle.toml");
    let case = case.to_str().unwrap();
    let out = folder.path().join("swept");
    let words = [
        "sweep",
        case,
        "--quiet",
        "--set",
        "units.screen.screen.cut=2 mm,2.1 mm",
        "--out",
        out.to_str().unwrap(),
    ];
    let output = calcine(&words);
    assert!(output.status.success(), "{}", said(&output));
    assert!(said(&output).contains("| 2.1 mm |"), "{}", said(&output));
    let refused = calcine(&["run", case, "--gas", "openfoam"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(said(&refused).contains("`--gas` goes with beds"));
    let mut new = Command::new(env!("CARGO_BIN_EXE_calcine"));
    new.args(["new", "mine", "--like", "granulation-plant"]);
    let output = new.current_dir(folder.path()).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let made = folder.path().join("mine/mine.toml");
    let checked = calcine(&["check", made.to_str().unwrap()]);
    assert!(checked.status.success(), "{}", said(&checked));
}
