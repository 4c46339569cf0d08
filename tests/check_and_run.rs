//! What `calcine check` refuses `calcine run` refuses, in the same words and with the same exit code.

#![allow(clippy::unwrap_used)]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn calcine(words: &[&str], case: &Path, set: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.args(words).arg(case);
    for setting in set {
        command.args(["--set", setting]);
    }
    command.output().unwrap()
}

/// Exit code and words of `check`, which must be those of `run`, of which no folder is left.
fn refused(case: &Path, set: &[&str]) -> (i32, String) {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let check = calcine(&["check"], case, set);
    let run = calcine(
        &["run", "--quiet", "--out", out.to_str().unwrap()],
        case,
        set,
    );
    let said = |output: &Output| {
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code().unwrap(), text)
    };
    assert_eq!(said(&check), said(&run), "{} {set:?}", case.display());
    assert!(!out.exists(), "{} {set:?}", case.display());
    said(&check)
}

#[test]
fn a_wrong_file_is_refused_alike_by_check_and_run() {
    let folder = root().join("tests/inputs/bad");
    let entries = std::fs::read_dir(folder).unwrap();
    let paths = entries.map(|entry| entry.unwrap().path());
    let paths: Vec<PathBuf> = paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .collect();
    assert!(paths.len() > 100, "{}", paths.len());
    for path in paths {
        let (code, text) = refused(&path, &[]);
        assert_eq!(code, 2, "{}: {text}", path.display());
        assert!(text.contains("help:"), "{}: {text}", path.display());
    }
}

#[test]
fn what_only_mesh_and_particles_show_is_refused_alike_by_check_and_run() {
    let good = |name: &str| root().join("tests/inputs/good").join(name);
    for (case, set, words) in [
        (
            good("two-populations.toml"),
            "particles[0].place.grid.first=\"5 5 9 mm\"",
            "overlap: their centres are",
        ),
        (
            good("refined-box.toml"),
            "coupling.smoother.excluded[0].box={ from = \"0 0 200 mm\", to = \"10 10 210 mm\" }",
            "holds no centre of a cell",
        ),
        (
            root().join("cases/heated-column.toml"),
            "probes=[{ name = \"far\", point = \"9 9 9 m\" }]",
            "no point of the probe `far` lies inside the gas mesh",
        ),
        (
            root().join("cases/heated-bed.toml"),
            "coupling.smoother.max_solid_fraction=0.3",
            "",
        ),
    ] {
        let (code, text) = refused(&case, &[set]);
        assert_ne!(code, 0, "{}", case.display());
        assert!(text.contains(words), "{}: {text}", case.display());
    }
}
