//! A run is resumed with the files that it began with: what changed is named.

use std::fs;
use std::path::Path;

use calcine::simulation::Simulation;

fn inputs() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good")
}

#[test]
fn a_wall_and_a_bed_that_changed_are_named_where_a_run_is_resumed() {
    let folder = tempfile::tempdir().unwrap();
    let (case, out) = (folder.path().join("moving.toml"), folder.path().join("out"));
    let wall = fs::read_to_string(inputs().join("plate.stl")).unwrap();
    let text = fs::read_to_string(inputs().join("moving.toml")).unwrap();
    let grid = text
        .lines()
        .find(|line| line.starts_with("place = "))
        .unwrap();
    let file = "place = { file = \"bead.csv\" }";
    fs::write(&case, text.replace(grid, file)).unwrap();
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
    assert!(told.contains("`bead.csv` holds something else"), "{told}");
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
    open().resume(true).start().unwrap();
}
