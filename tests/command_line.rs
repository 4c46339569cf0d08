//! What the command line says of mistakes, and that nothing is left of what it refuses.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use crate::support::program::shipped;

fn calcine(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(words)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn column() -> PathBuf {
    shipped("heated-column")
}

/// Standard error of a command that fails with this exit code.
fn refused(folder: &Path, code: i32, words: &[&str]) -> String {
    let output = calcine(folder, words);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{words:?}: {text}");
    text
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

#[test]
fn a_run_that_is_refused_leaves_no_folder_and_is_refused_again() {
    let folder = tempfile::tempdir().unwrap();
    let case = column();
    let run = |more: &[&str]| {
        let words = ["run", case.to_str().unwrap(), "--quiet"];
        refused(folder.path(), 2, &[&words, more].concat())
    };
    for _ in 0..2 {
        let text = run(&["--resume", "--out", "deep/out"]);
        assert!(
            text.contains("there is no checkpoint in deep/out"),
            "{text}"
        );
        assert_eq!(names(folder.path()), [""; 0]);
    }
    let text = run(&["--from", "nosuch", "--out", "deep/out"]);
    let said = "nosuch is not the results folder of a run: there is no such folder";
    assert!(text.contains(said), "{text}");
    assert!(
        text.contains("help: name the folder that a run wrote"),
        "{text}"
    );
    assert_eq!(names(folder.path()), [""; 0]);
    // What was in the folder before stays; nothing is added to it.
    fs::create_dir_all(folder.path().join("own/log")).unwrap();
    fs::write(folder.path().join("own/notes.txt"), "mine").unwrap();
    for words in [["--resume"].as_slice(), &["--from", "own"]] {
        run(&[words, &["--out", "own"]].concat());
        assert_eq!(names(&folder.path().join("own")), ["log", "notes.txt"]);
        assert_eq!(names(&folder.path().join("own/log")), [""; 0]);
    }
}

#[test]
fn a_run_that_its_solver_refuses_leaves_what_was_there() {
    let folder = tempfile::tempdir().unwrap();
    let column = column();
    let words = [
        "run",
        column.to_str().unwrap(),
        "--quiet",
        "--out",
        "out",
        "--gas",
        "external",
    ];
    let text = refused(folder.path(), 2, &words);
    assert!(text.contains("add [external.gas]"), "{text}");
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_place_that_cannot_be_written_is_named_with_the_option_that_names_another() {
    let folder = tempfile::tempdir().unwrap();
    let case = column();
    let case = case.to_str().unwrap();
    let text = refused(
        folder.path(),
        2,
        &["run", case, "--quiet", "--out", "/dev/null/x"],
    );
    assert!(
        text.contains("no results can be written to /dev/null/x"),
        "{text}"
    );
    assert!(text.contains("another folder with `--out`"), "{text}");
    for (words, option) in [
        (["schema", "--out", "/dev/null/x"].as_slice(), "--out"),
        (&["new", "/dev/null/x"], "NAME"),
        (
            &[
                "sweep",
                case,
                "--set",
                "time.end=1 s,2 s",
                "--table",
                "/dev/null/x",
            ],
            "--table",
        ),
        (
            &["conform", "--gas", "native", "--out", "/dev/null/x"],
            "--out",
        ),
        (&["prepare", case, "--out", "/dev/null/x"], "--out"),
    ] {
        let text = refused(folder.path(), 2, words);
        assert!(text.contains("/dev/null/x"), "{text}");
        assert!(
            text.contains(&format!("name another with `{option}`")),
            "{text}"
        );
    }
    assert_eq!(names(folder.path()), [""; 0]);
}

#[test]
fn a_report_of_what_is_no_results_folder_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let text = refused(folder.path(), 2, &["report", "nosuch"]);
    assert!(text.contains("there is no such folder"), "{text}");
    assert!(
        text.contains("help: name the folder that a run wrote"),
        "{text}"
    );
    fs::create_dir(folder.path().join("empty")).unwrap();
    let text = refused(folder.path(), 2, &["report", "empty"]);
    assert!(text.contains("it holds no summary.json"), "{text}");
}

#[test]
fn conform_removes_only_what_it_wrote_itself() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.tex"), "years of work").unwrap();
    let text = refused(
        folder.path(),
        2,
        &["conform", "--gas", "native", "--out", "."],
    );
    assert!(
        text.contains("thesis.tex, which is not of this command"),
        "{text}"
    );
    assert_eq!(names(folder.path()), ["thesis.tex"]);
}

/// A shipped case with two expectations: one that is missed, one after the end of the run.
fn expecting(folder: &Path) -> PathBuf {
    let quantity = |name: &str, at: &str| {
        format!(
            "\n[[quantities]]\nname = \"{name}\"\nmeasure = {{ particle = \"temperature\", number = 1 }}\n\
             expect = {{ at = \"{at}\", value = \"900 K\", within = \"1 %\" }}\n"
        )
    };
    let text = fs::read_to_string(column()).unwrap();
    let path = folder.join("case.toml");
    let text = text + &quantity("missed", "0.5 s") + &quantity("late", "1 h");
    fs::write(&path, text).unwrap();
    path
}

#[test]
fn an_expectation_that_fails_says_what_was_expected_and_when() {
    let folder = tempfile::tempdir().unwrap();
    expecting(folder.path());
    let set = ["case.toml", "--set", "time.end=1 s"];
    let late = "`late` is expected to have its value at 3600 s, but the run ends at 1 s";
    let output = calcine(folder.path(), &[&["check"], &set[..]].concat());
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(text.contains(&format!("warning: {late}")), "{text}");
    assert!(!text.contains("`missed` is expected"), "{text}");

    let output = calcine(
        folder.path(),
        &[&["run", "--quiet"], &set[..], &["--out", "out"]].concat(),
    );
    assert_eq!(output.status.code(), Some(5));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(text.contains(late), "{text}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = |name: &str| text.lines().find(|line| line.trim().starts_with(name));
    let missed = line("missed").unwrap();
    assert!(
        missed.contains("fail: expected 891 to 909 K at 0.5 s"),
        "{missed}"
    );
    let late = line("late").unwrap();
    assert!(
        late.contains("unknown")
            && late.contains("at 3600 s, but the run ended at 1 s: raise `time.end`"),
        "{late}"
    );
}

#[test]
fn a_comparison_of_all_pairings_leaves_out_those_that_cannot_run_before_anything_runs() {
    let folder = tempfile::tempdir().unwrap();
    let compare = |variables: &[(&str, &str)], more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
        command
            .current_dir(folder.path())
            .args(["compare", "--quiet"]);
        command.arg(column()).args(["--set", "time.end=0.1 s"]);
        command.args(["--out", "out"]).args(more);
        for (name, value) in variables {
            command.env(name, value);
        }
        command.output().unwrap()
    };
    let gas = ("CALCINE_GASFOAM", "/nowhere/calcineGasFoam");
    let host = ("CALCINE_LIGGGHTS_HOST", "/nowhere/calcine-liggghts");
    let none = compare(&[gas, host], &[]);
    let text = String::from_utf8_lossy(&none.stderr).into_owned();
    assert_eq!(none.status.code(), Some(4), "{text}");
    assert!(
        text.contains("a comparison needs two pairings at least"),
        "{text}"
    );
    let why = "/nowhere/calcineGasFoam, which the variable CALCINE_GASFOAM names, is no file";
    assert!(
        text.contains("openfoam+native cannot run: ") && text.contains(why),
        "{text}"
    );
    let named = compare(&[gas], &["--pairings", "native+native,openfoam+native"]);
    assert_eq!(named.status.code(), Some(4));
    assert_eq!(names(folder.path()), [""; 0]);
}

/// What `check` says of a shipped bed with a key set.
fn checked(folder: &Path, set: &str) -> String {
    let case = shipped("heated-bed");
    refused(folder, 2, &["check", case.to_str().unwrap(), "--set", set])
}

#[test]
fn particles_that_cannot_be_placed_are_told_with_the_line_of_the_case() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str, text: &str| {
        let path = folder.path().join(name);
        fs::write(&path, text).unwrap();
        format!("particles[0].place={{ file = \"{}\" }}", path.display())
    };
    for (set, line, fact, help) in [
        (
            "particles=[]".to_owned(),
            "particles= []",
            "`particles` is an empty list",
            "add one: [[particles]]",
        ),
        (
            file("none.csv", ""),
            "place = { file",
            "none.csv: it is empty",
            "its first line names the columns: x, y and z (in m)",
        ),
        (
            file("head.csv", "x,y,z\n"),
            "[[particles]]",
            "the case has no particles: \"beads\" (",
            "a run needs one particle at least",
        ),
        (
            "particles[0].diameter=60 mm".into(),
            "diameter = \"60 mm\"",
            "spheres of 0.06 m do not fit between walls that are 0.0500 m apart",
            "take smaller spheres or a wider vessel",
        ),
        (
            "particles[0].diameter={ uniform = { min = \"5 mm\", max = \"4 mm\" }, share = \"number\", seed = 1 }"
                .into(),
            "diameter = { uniform",
            "uniform.min` is 0.005 m, not below `max` of 0.004 m",
            "write the smaller diameter as min",
        ),
    ] {
        let text = checked(folder.path(), &set);
        let shown = text.lines().find(|text| text.contains(" │ ") && text.contains(line));
        assert!(shown.is_some(), "{set}: {text}");
        assert!(text.contains(fact), "{set}: {text}");
        assert!(text.contains(&format!("help: {help}")), "{set}: {text}");
    }
}

#[test]
fn a_unit_that_is_not_known_and_a_law_in_words_say_what_is_meant() {
    let folder = tempfile::tempdir().unwrap();
    let text = checked(folder.path(), "particles[0].temperature=700 C");
    assert!(text.contains("did you mean \"degC\"?"), "{text}");
    let text = checked(folder.path(), "laws.mass_transfer=\"none\"");
    assert!(
        text.contains("help: write a table such as { law = \"none\" }"),
        "{text}"
    );
}

#[test]
fn a_case_that_is_not_there_is_answered_with_those_of_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let check = |name: &str| refused(folder.path(), 2, &["check", name]);
    assert!(
        check("bed.toml")
            .contains("help: name a case that exists, or make one with `calcine new NAME`")
    );
    fs::write(folder.path().join("my-bed.toml"), "").unwrap();
    assert!(check("my-bad.toml").contains("help: did you mean my-bed.toml?"));
    assert!(check("column").contains("help: name a case; there are my-bed.toml"));
    assert!(check(".").contains("help: name a case; there are my-bed.toml"));
}

/// A native run in `out` that stops with a checkpoint, long before its end; standard output.
fn stopped(folder: &Path) -> String {
    fs::copy(column(), folder.join("my case.toml")).unwrap();
    let words = ["run", "my case.toml", "--out", "out", "--quiet", "--strict"];
    let more = ["--threads", "1", "--set", "time.end=1000000 s"];
    let output = calcine(
        folder,
        &[&words[..], &more, &["--stop-after", "0.2s"]].concat(),
    );
    assert_eq!(output.status.code(), Some(75), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_line_that_a_stopped_run_prints_continues_it() {
    let folder = tempfile::tempdir().unwrap();
    let told = stopped(folder.path());
    let line = told.trim_end().lines().last().unwrap().trim();
    assert_eq!(
        line,
        "calcine run 'my case.toml' --out out --resume --set 'time.end=1000000 s' --threads 1 --strict --quiet"
    );
    let rest = line.strip_prefix("calcine").unwrap();
    let program = env!("CARGO_BIN_EXE_calcine");
    let output = Command::new("sh")
        .args(["-c", &format!("'{program}' {rest} --stop-after 0.2s")])
        .current_dir(folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(75), "{output:?}");
    assert!(String::from_utf8(output.stdout).unwrap().contains(line));
}

#[test]
fn the_results_folder_alone_suffices_to_resume() {
    let folder = tempfile::tempdir().unwrap();
    let told = stopped(folder.path());
    assert!(
        told.contains("`calcine run --resume out` goes on"),
        "{told}"
    );
    // From elsewhere, after the folder has moved, and again from what that run keeps.
    let elsewhere = folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    fs::rename(folder.path().join("out"), elsewhere.join("moved")).unwrap();
    for _ in 0..2 {
        let words = ["run", "--resume", "moved", "--stop-after", "0.2s"];
        let output = calcine(&elsewhere, &words);
        assert_eq!(output.status.code(), Some(75), "{output:?}");
        let told = String::from_utf8(output.stdout).unwrap();
        let kept = "--out moved --resume --set 'time.end=1000000 s' --threads 1 --strict --quiet";
        assert!(told.contains(kept), "{told}");
    }
    let set = ["run", "--resume", "moved", "--set", "time.end=2 s"];
    let text = refused(&elsewhere, 2, &set);
    assert!(
        text.contains(
            "`--set` beside `--resume moved`, which takes it from the run in moved: leave it out"
        ),
        "{text}"
    );
    let text = refused(&elsewhere, 2, &["run", "--resume", "nosuch"]);
    assert!(
        text.contains("nosuch/command.json cannot be read") && text.contains("or the case as well"),
        "{text}"
    );
}

#[test]
fn of_a_key_that_is_set_twice_the_line_repeats_the_value_that_holds() {
    let folder = tempfile::tempdir().unwrap();
    fs::copy(column(), folder.path().join("a.toml")).unwrap();
    let set = ["--set", "time.end=3 s", "--set", "time.end=1000000 s"];
    let words = [
        "run",
        "a.toml",
        "--out",
        "out",
        "--quiet",
        "--stop-after",
        "0.2s",
    ];
    let output = calcine(folder.path(), &[&words[..], &set].concat());
    assert_eq!(output.status.code(), Some(75), "{output:?}");
    let told = String::from_utf8(output.stdout).unwrap();
    assert!(
        told.ends_with("--resume --set 'time.end=1000000 s' --quiet\n"),
        "{told}"
    );
}

#[test]
fn swept_quantities_have_a_column_each() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, number: u32| {
        format!("{{name=\"{name}\", measure={{ particle = \"temperature\", number = {number} }}}}")
    };
    let set = format!("quantities[0]={},{}", of("first", 1), of("last", 10));
    let case = column();
    let words = ["sweep", case.to_str().unwrap(), "--quiet", "--out", "out"];
    let more = ["--set", "time.end=1 s", "--set", &set];
    let output = calcine(folder.path(), &[&words[..], &more].concat());
    let told = String::from_utf8(output.stdout).unwrap();
    let cells = |line: &str| -> Vec<String> {
        line.split('|').map(|cell| cell.trim().to_owned()).collect()
    };
    let table: Vec<Vec<String>> = told
        .lines()
        .filter(|line| line.starts_with('|'))
        .map(cells)
        .collect();
    let column = |name: &str| table[0].iter().position(|cell| cell == name).unwrap();
    let (first, last) = (column("first K"), column("last K"));
    let filled = |row: &[String]| (!row[first].is_empty(), !row[last].is_empty());
    assert_eq!(
        (filled(&table[2]), filled(&table[3])),
        ((true, false), (false, true)),
        "{told}"
    );
}

#[test]
fn a_sweep_that_is_stopped_does_not_print_a_line_that_resumes_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let case = column();
    let child = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .arg("sweep")
        .arg(&case)
        .args(["--quiet", "--out", "out"])
        .args(["--set", "time.end=1000000 s,2000000 s"])
        .current_dir(folder.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let series = folder.path().join("out/end=1000000s/series.csv");
    let begun = Instant::now();
    while !series.is_file() && begun.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    let id = child.id().to_string();
    assert!(Command::new("kill").arg(&id).status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(75), "{text}");
    let said = "0 of 2 runs have ended; the same command keeps them and goes on with the others";
    assert!(text.contains(said) && !text.contains("--resume"), "{text}");
}

#[test]
fn a_run_is_not_resumed_by_other_solvers_and_its_own_are_named() {
    let folder = tempfile::tempdir().unwrap();
    stopped(folder.path());
    let words = ["run", "my case.toml", "--out", "out", "--quiet", "--resume"];
    let set = ["--set", "time.end=1000000 s"];
    for other in [["--gas", "openfoam"], ["--particles", "liggghts"]] {
        let text = refused(folder.path(), 2, &[&words[..], &set, &other].concat());
        assert!(
            text.contains(
                "the run in out has native gas and native particles, this command asks for"
            ) && text.contains("resume with `--gas native --particles native`"),
            "{text}"
        );
    }
}

#[test]
fn doctor_looks_for_solvers_where_runs_look() {
    let folder = tempfile::tempdir().unwrap();
    let own = folder.path().canonicalize().unwrap().join("my-gas");
    fs::write(&own, "").unwrap();
    let doctor = |gas: &Path| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
        let command = command.arg("doctor").env("CALCINE_GASFOAM", gas);
        let command = command.env("CALCINE_LIGGGHTS_HOST", "/nowhere/host");
        String::from_utf8(command.output().unwrap().stdout).unwrap()
    };
    let text = doctor(&own);
    let found = format!("calcineGasFoam    {}\n", own.display());
    assert!(text.contains(&found), "{text}");
    let why = "calcine-liggghts  /nowhere/host, which the variable CALCINE_LIGGGHTS_HOST names, is no file";
    assert!(text.contains(why), "{text}");
    assert!(!text.contains("native+liggghts"), "{text}");
}

#[test]
fn a_command_without_its_adapters_says_what_installs_them_in_runs_and_in_doctor() {
    let folder = tempfile::tempdir().unwrap();
    let program = folder.path().join("calcine");
    fs::copy(env!("CARGO_BIN_EXE_calcine"), &program).unwrap();
    let case = column();
    let run = ["run", case.to_str().unwrap(), "--gas", "openfoam"];
    for words in [&run[..], &["doctor"]] {
        let mut command = Command::new(&program);
        let command = command.args(words).current_dir(folder.path());
        let command = command.env_remove("CALCINE_GASFOAM");
        let output = command.output().unwrap();
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains(calcine_adapters::find::REMEDY), "{text}");
    }
}

#[test]
fn a_case_that_is_not_utf_8_is_refused_with_the_place_of_the_byte() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("latin.toml"), b"# a bed\n# caf\xe9\n").unwrap();
    let text = refused(folder.path(), 2, &["check", "latin.toml"]);
    for words in [
        "the case file is not UTF-8: byte 6 of line 2 is 0xE9",
        "# caf\u{fffd}",
        "help: save the file as UTF-8",
    ] {
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn what_cannot_be_printed_fails_and_what_nobody_reads_does_not() {
    let case = column();
    let words = ["check", case.to_str().unwrap()];
    let to = |out: Stdio| {
        let command = Command::new(env!("CARGO_BIN_EXE_calcine"))
            .args(words)
            .stdout(out)
            .output();
        command.unwrap()
    };
    let full = fs::OpenOptions::new().write(true).open("/dev/full");
    let output = to(full.unwrap().into());
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("standard output cannot be written: No space left"),
        "{text}"
    );
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    assert_eq!(to(writer.into()).status.code(), Some(0));
}

#[test]
fn particles_far_wider_than_the_mesh_are_refused_at_their_diameter() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("heated-bed");
    // A file of particles in mm where m is meant.
    fs::write(
        folder.path().join("bed.csv"),
        "x,y,z,diameter\n0,0,0.01,4\n",
    )
    .unwrap();
    let place = format!(
        "particles.beads.place={{ file = \"{}\" }}",
        folder.path().join("bed.csv").display()
    );
    let words = ["check", case.to_str().unwrap(), "--set", &*place];
    let text = refused(folder.path(), 2, &words);
    assert!(
        text.contains("particle 1 of \"beads\" has a diameter of 4 m, but the mesh is 0.0"),
        "{text}"
    );
    assert!(text.contains("check the unit of the diameter"), "{text}");
}

#[test]
fn a_particle_that_no_tube_has_room_for_is_refused_with_what_to_do() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("heated-bed");
    let bed = folder.path().join("bed.csv");
    fs::write(&bed, "x,y,z,diameter\n0,0,0.05,0.08\n").unwrap();
    let place = format!("particles.beads.place={{ file = \"{}\" }}", bed.display());
    let words = ["check", case.to_str().unwrap(), "--set", &*place];
    let text = refused(folder.path(), 2, &words);
    assert!(text.contains("the bed does not fit"), "{text}");
    assert!(
        text.contains("help: place fewer or smaller particles there"),
        "{text}"
    );
}

#[test]
fn an_adhesive_law_is_refused_in_the_pairing_whose_particles_have_none() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("settling-sphere");
    let words = [
        "check",
        case.to_str().unwrap(),
        "--set",
        "motion.cohesion={ law = \"jkr\" }",
        "--set",
        "contacts[0].work_of_adhesion=50 mJ/m^2",
    ];
    let native = calcine(folder.path(), &words);
    assert!(native.status.success(), "{native:?}");
    let words = [&words[..], &["--particles", "liggghts"]].concat();
    let text = refused(folder.path(), 4, &words);
    assert!(text.contains("no cohesion law \"jkr\""), "{text}");
    assert!(text.contains("use native particles"), "{text}");
}

/// `calcine … 2>&1 | head -1` closes standard error while the command still writes.
#[test]
fn a_closed_standard_error_changes_no_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let closed = |words: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
        command.args(words).current_dir(folder.path());
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stderr.take());
        child.wait().unwrap().code()
    };
    let file = column();
    let case = file.to_str().unwrap();
    assert_eq!(closed(&["run", case, "--set", "gas.nonsense=1"]), Some(2));
    let short = ["run", case, "--out", "out", "--set", "time.end=\"1 s\""];
    assert_eq!(closed(&short), Some(0));
    let curves = shipped("tg-laws");
    let tune = ["tune", curves.to_str().unwrap(), "--out", "tuned"];
    assert_eq!(closed(&tune), Some(0));
}
