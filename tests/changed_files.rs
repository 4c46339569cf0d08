//! A run is resumed with the files that it began with: what changed is named.

use std::fs;
use std::path::Path;

use calcine::simulation::Simulation;

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
