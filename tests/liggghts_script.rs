//! A LIGGGHTS script of the user's own, as docs/how-to/own-liggghts-script.md says, step by step.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use calcine::results::read::Series;

/// The settled bed with a script, in a folder of its own.
fn case(folder: &Path, script: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("cases/settled-bed.toml")).unwrap();
    let own = text.replace("[liggghts]\n", "[liggghts]\ntemplate = \"in.bed\"\n");
    assert_ne!(own, text);
    fs::create_dir_all(folder).unwrap();
    fs::write(folder.join("case.toml"), own).unwrap();
    fs::write(folder.join("in.bed"), script).unwrap();
}

fn calcine(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(words)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn run(folder: &Path, case: &str, out: &str, words: &[&str]) {
    let all = [
        &[
            "run",
            case,
            "--particles",
            "liggghts",
            "--quiet",
            "--out",
            out,
        ],
        words,
    ];
    let output = calcine(folder, &all.concat());
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{text}");
}

fn series(folder: &Path, out: &str) -> String {
    fs::read_to_string(folder.join(out).join("series.csv")).unwrap()
}

const SHORT: [&str; 2] = ["--set", "time.end=0.06 s"];

fn shipped() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    fs::read_to_string(root.join("liggghts-inputs/own-bed.in")).unwrap()
}

/// The script that the docs start from says what Calcine would have written.
#[test]
fn the_script_that_ships_gives_the_bits_of_the_generated_one_on_one_rank_and_two() {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path(), &shipped());
    let plain = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/settled-bed.toml");
    let plain = plain.to_str().unwrap();
    for ranks in ["1", "2"] {
        let words = [&SHORT[..], &["--ranks-particles", ranks]].concat();
        let (own, generated) = (format!("own-{ranks}"), format!("generated-{ranks}"));
        run(folder.path(), "case.toml", &own, &words);
        run(folder.path(), plain, &generated, &words);
        assert_eq!(
            series(folder.path(), &own),
            series(folder.path(), &generated)
        );
    }
}

/// Steps 3 and 4 of the docs: a law that the case file has no words for, resumed after a checkpoint.
#[test]
fn a_law_of_the_script_s_own_acts_and_a_checkpoint_of_it_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    // Drag of a liquid film at all surfaces, in place of air's: what slows is LIGGGHTS' fix viscous.
    case(
        folder.path(),
        &(shipped() + "fix film calcine_free viscous 2e-4\n"),
    );
    let plain = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/settled-bed.toml");
    run(folder.path(), plain.to_str().unwrap(), "plain", &SHORT);
    run(folder.path(), "case.toml", "own", &SHORT);
    let speed = |out: &str| {
        let series = Series::read(&folder.path().join(out)).unwrap();
        *series.column("quantities.mean_speed").last().unwrap()
    };
    // The film takes m/γ = 1.05e-5 kg/2e-4 kg/s = 52 ms to slow a bead that falls for 60 ms: to 60 % of g t.
    let share = speed("own") / speed("plain");
    assert!((0.5..0.8).contains(&share), "{share}");

    let words = [
        "--set",
        "time.end=0.2 s",
        "--set",
        "time.checkpoint.every=0.02 s",
    ];
    run(folder.path(), "case.toml", "whole", &words);
    let mut part = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["run", "case.toml", "--particles", "liggghts", "--quiet"])
        .args(["--out", "part"])
        .args(words)
        .current_dir(folder.path())
        .spawn()
        .unwrap();
    let kept = folder.path().join("part/checkpoint/coordinator.state");
    while !kept.is_file() && part.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    part.kill().unwrap();
    assert!(
        !part.wait().unwrap().success(),
        "it had ended before it was killed"
    );
    run(
        folder.path(),
        "case.toml",
        "part",
        &[&words[..], &["--resume"]].concat(),
    );
    assert_eq!(
        series(folder.path(), "part"),
        series(folder.path(), "whole")
    );
}

/// Step 2 of the docs.
#[test]
fn check_and_prepare_say_what_a_script_is_and_where_it_does_not_go_with_the_case() {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path(), &shipped());
    let said = |words: &[&str]| {
        let output = calcine(folder.path(), words);
        String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned()
    };
    let text = said(&["check", "case.toml"]);
    assert!(text.contains("those of `liggghts.template`"), "{text}");
    assert!(
        !text.contains("LIGGGHTS          not this case: "),
        "{text}"
    );
    said(&[
        "prepare",
        "case.toml",
        "--particles",
        "liggghts",
        "--out",
        "inputs",
    ]);
    let script = fs::read_to_string(folder.path().join("inputs/liggghts/in.liggghts")).unwrap();
    for line in [
        "variable calcine_step string",
        "variable calcine_type_beads string \"1\"",
        "variable calcine_friction_glass_glazed string \"0e0\"",
        "read_data particles.data",
        "group calcine_free type 1",
        "fix calcine_push",
    ] {
        assert!(script.contains(line), "{line} is missing in:\n{script}");
    }
    let wrong = shipped().replace(
        "include calcine.gravity",
        "fix g all gravity 1.62 vector 0 0 -1",
    );
    case(folder.path(), &wrong);
    let text = said(&["check", "case.toml"]);
    assert!(text.contains("LIGGGHTS          not this case: "), "{text}");
    assert!(
        text.contains("gravity of the case is (0 0 -9.81) m/s²"),
        "{text}"
    );
    let output = calcine(
        folder.path(),
        &[
            "run",
            "case.toml",
            "--particles",
            "liggghts",
            "--quiet",
            "--out",
            "refused",
        ],
    );
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{text}");
    assert!(text.contains("line 17, `fix g all gravity 1.62"), "{text}");
}

/// In place of `mpirun`: takes the line by which the host adds the force of the gas out of the script, as in that of another version.
const OTHER_VERSION: &str =
    "#!/bin/sh\nsed -i '/^fix calcine_each_step /d' in.liggghts\nexec \"$@\"\n";

#[test]
fn a_script_in_which_the_force_of_the_gas_would_not_act_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    case(folder.path(), &shipped());
    let launcher = folder.path().join("launch.sh");
    fs::write(&launcher, OTHER_VERSION).unwrap();
    let launcher = format!("sh {}", launcher.display());
    let words = [
        "run",
        "case.toml",
        "--particles",
        "liggghts",
        "--out",
        "out",
    ];
    let words = [&words[..], &["--launch-particles", &launcher]].concat();
    let output = calcine(folder.path(), &words);
    let text = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(4), "{text}");
    for part in [
        "fix calcine_each_step",
        "install `calcine` and `calcine-liggghts` together",
    ] {
        assert!(text.contains(part), "{text}");
    }
}
