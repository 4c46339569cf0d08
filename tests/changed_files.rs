//! A run is resumed with the files that it began with: what changed is named.

use std::fs;
use std::path::Path;

use calcine::simulation::Simulation;

use crate::support::{program, stopped};

fn inputs() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good")
}

#[test]
fn a_wall_a_bed_and_a_template_that_changed_are_named_where_a_run_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let (case, out) = (folder.path().join("moving.toml"), folder.path().join("out"));
    let wall = fs::read_to_string(inputs().join("plate.stl")).unwrap();
    let text = fs::read_to_string(inputs().join("moving.toml")).unwrap();
    let grid = text
        .lines()
        .find(|line| line.starts_with("place = "))
        .unwrap();
    let file = "place = { file = \"bead.csv\" }";
    let text = text.replace(grid, file) + "\n[openfoam]\ntemplate = \"template\"\n";
    fs::write(&case, text).unwrap();
    let scheme = folder.path().join("template/constant/own/data");
    fs::create_dir_all(scheme.parent().unwrap()).unwrap();
    fs::write(&scheme, "FoamFile {}\na 1;\n").unwrap();
    fs::write(folder.path().join("plate.stl"), &wall).unwrap();
    let bed = |x: &str| {
        let rows = format!("x,y,z\n{x},0.005,0.29\n");
        fs::write(folder.path().join("bead.csv"), rows).unwrap();
    };
    bed("0.005");
    let open = || Simulation::open(&case).out(&out);
    let mut run = open().start().unwrap();
    run.step().unwrap();
    run.stop().unwrap();
    drop(run);
    let refused = || {
        let Err(error) = open().resume(true).start() else {
            panic!("taken")
        };
        error.to_string()
    };
    bed("0.006");
    let told = refused();
    assert!(
        told.contains("`particles.bead.place.file` holds something else"),
        "{told}"
    );
    assert!(!told.contains("walls."), "{told}");
    bed("0.005");
    fs::write(
        folder.path().join("plate.stl"),
        wall.replace("10 0 5", "9 0 5"),
    )
    .unwrap();
    let told = refused();
    assert!(
        told.contains("`walls.plate.stl` holds something else"),
        "{told}"
    );
    fs::write(folder.path().join("plate.stl"), &wall).unwrap();
    // Of a template every file counts, in folders within it too.
    fs::write(&scheme, "FoamFile {}\na 2;\n").unwrap();
    let told = refused();
    let place = "`openfoam.template/constant/own/data`";
    assert!(
        told.contains(&format!("{place} holds something else")),
        "{told}"
    );
    fs::remove_file(&scheme).unwrap();
    let told = refused();
    assert!(
        told.contains(&format!("{place} is not there any more")),
        "{told}"
    );
    fs::write(&scheme, "FoamFile {}\na 1;\n").unwrap();
    let more = folder.path().join("template/system/more");
    fs::create_dir_all(more.parent().unwrap()).unwrap();
    fs::write(&more, "FoamFile {}\n").unwrap();
    let told = refused();
    assert!(
        told.contains("`openfoam.template/system/more` was not there"),
        "{told}"
    );
    fs::remove_file(&more).unwrap();
    open().resume(true).start().unwrap();
}

const COMPLETE: [&str; 2] = ["time.end=1 s", "output.every=0.5 s"];

#[test]
fn a_complete_run_whose_results_are_gone_is_not_told_as_complete() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let again = || {
        let case = program::shipped("heated-column");
        let mut command = program::command(&case, &out, &["--resume"], &COMPLETE);
        let ended = command.output().unwrap();
        (
            ended.status.success(),
            String::from_utf8_lossy(&ended.stderr).into_owned(),
        )
    };
    program::run(&program::shipped("heated-column"), &out, &[], &COMPLETE);
    assert!(again().0);
    let spoil = |name: &str, content: Option<&[u8]>, words: &str| {
        let path = out.join(name);
        let before = fs::read(&path).unwrap();
        match content {
            Some(content) => fs::write(&path, content).unwrap(),
            None => fs::remove_file(&path).unwrap(),
        }
        let (done, told) = again();
        assert!(!done && told.contains("the run is complete, but"), "{told}");
        assert!(told.contains(name) && told.contains(words), "{told}");
        fs::write(&path, before).unwrap();
        assert!(again().0);
    };
    let rows = fs::read(out.join("series.csv")).unwrap();
    spoil("series.csv", None, "is missing");
    spoil("series.csv", Some(&[]), "does not reach to its end");
    spoil(
        "series.csv",
        Some(&rows[..rows.len() / 2]),
        "does not reach",
    );
    spoil("particles/particles_0001.vtp", None, "is missing");
    if cfg!(feature = "hdf5") {
        spoil("results.h5", None, "is missing");
        spoil("results.h5", Some(b"mine"), "not an HDF5 file");
    }
}

#[test]
fn a_probe_of_a_run_that_goes_on_is_counted_on() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let set = [
        "time.end=20 s",
        "output.every=0.1 s",
        "output.series_every=0.1 s",
        "probes=[{ name = \"axis\", points = [\"5 5 50 mm\"] }]",
    ];
    let command =
        |words: &[&str]| program::command(&program::shipped("heated-column"), &out, words, &set);
    let stopped = stopped::stop(command(&[]), |_| stopped::rows(&out) >= 5);
    assert_eq!(stopped, stopped::Stopped::Checkpointed);
    let path = out.join("probes/probes_0001.csv");
    let before = fs::read(&path).unwrap();
    for content in [None, Some("mine")] {
        match content {
            Some(content) => fs::write(&path, content).unwrap(),
            None => fs::remove_file(&path).unwrap(),
        }
        let refused = command(&["--resume"]).output().unwrap();
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(told.contains("probes_0001.csv"), "{told}");
        fs::write(&path, &before).unwrap();
    }
    stopped::finish(command(&["--resume"]));
}
