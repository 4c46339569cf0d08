//! Meshes of files that are folded or too large, and pressures of outlets over time: what `check` says of them.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::blocks::{Block, even};

/// A case of an empty duct in a mesh of a file whose points are moved.
fn duct(folder: &Path, shape: &dyn Fn([f64; 3]) -> [f64; 3]) -> PathBuf {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validate/skewed-meshes.toml");
    let case = folder.join("case.toml");
    fs::copy(source, &case).unwrap();
    let block = Block {
        levels: [even(4), even(2), even(6)],
        patches: ["side", "side", "side", "side", "bottom", "top"],
        hole: None,
        shape,
    };
    block.write(folder);
    case
}

/// Exit code and all that is printed, in one line.
fn calcine(folder: &Path, words: &[&str], set: &[&str]) -> (Option<i32>, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.current_dir(folder).args(words);
    command.args(["--set", "particles[0].place.grid.first=20.1 2.6 10.3 mm"]);
    for setting in set {
        command.args(["--set", setting]);
    }
    let output = command.output().unwrap();
    let text = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    let words = text.split_whitespace().filter(|word| *word != "│");
    (output.status.code(), words.collect::<Vec<_>>().join(" "))
}

/// In m.
const SIZE: [f64; 3] = [0.06, 0.01, 0.1];

fn upright(at: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|axis| at[axis] * SIZE[axis])
}

#[test]
fn a_mesh_that_is_folded_is_refused_with_the_place() {
    let folder = tempfile::tempdir().unwrap();
    // The point in the middle lies two layers and a half too high.
    let folded = |at: [f64; 3]| {
        let middle = at.iter().all(|level| (level - 0.5).abs() < 1e-9);
        let rise = if middle { 2.5 / 6.0 } else { 0.0 };
        upright([at[0], at[1], at[2] + rise])
    };
    duct(folder.path(), &folded);
    let (code, said) = calcine(folder.path(), &["check", "case.toml"], &[]);
    assert_eq!(code, Some(2), "{said}");
    assert!(
        said.contains("folded in cell") && said.contains("checkMesh"),
        "{said}"
    );
}

#[test]
fn check_tells_of_pieces_of_a_mesh_that_no_face_joins() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &upright);
    // Without the third of six layers.
    let layer = |at: [f64; 3]| at[2] > 0.34 && at[2] < 0.49;
    let block = Block {
        levels: [even(4), even(2), even(6)],
        patches: ["side", "side", "side", "side", "bottom", "top"],
        hole: Some(("side", &layer)),
        shape: &upright,
    };
    block.write(folder.path());
    let (_, said) = calcine(folder.path(), &["check", "case.toml"], &[]);
    assert!(
        said.contains("2 pieces that no face joins") && said.contains("16 cells about (0.0075"),
        "{said}"
    );
}

#[test]
fn a_thin_layer_between_thick_ones_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    // The cells above the middle are thinner by a factor of 200.
    duct(folder.path(), &|at| {
        let thin = (at[2] - 0.5).clamp(0.0, 1.0 / 6.0);
        upright([at[0], at[1], at[2] - thin * (1.0 - 1.0 / 200.0)])
    });
    let (_, said) = calcine(folder.path(), &["check", "case.toml"], &[]);
    assert!(
        said.contains("a cell 200 times thinner than its neighbour"),
        "{said}"
    );
}

#[test]
fn a_patch_without_a_condition_is_refused_alike_with_both_gases() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &upright);
    let block = Block {
        levels: [even(4), even(2), even(6)],
        patches: ["west", "side", "side", "side", "bottom", "top"],
        hole: None,
        shape: &upright,
    };
    block.write(folder.path());
    for gas in ["native", "openfoam"] {
        let words = ["run", "case.toml", "--gas", gas, "--out", "out"];
        let (code, said) = calcine(folder.path(), &words, &[]);
        assert_eq!(code, Some(2), "{gas}: {said}");
        assert!(
            said.contains("give it one in `gas.patch.west`"),
            "{gas}: {said}"
        );
    }
}

#[test]
fn check_prints_where_the_mesh_of_a_file_begins_and_ends() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &upright);
    let (code, said) = calcine(folder.path(), &["check", "case.toml"], &[]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("from (0, 0, 0) to (0.06, 0.01, 0.1) m"),
        "{said}"
    );
}

#[test]
fn a_pressure_that_leaves_that_of_the_start_is_warned_of_over_time_too() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &upright);
    let falls = "gas.patch.top.outlet.pressure=[[\"0 s\", \"1 atm\"], [\"1 s\", \"0.5 atm\"]]";
    let (_, said) = calcine(folder.path(), &["check", "case.toml"], &[falls]);
    assert!(
        said.contains("`top` has a pressure of 50662.5 Pa"),
        "{said}"
    );
}

#[test]
fn central_convection_of_fast_gas_in_coarse_cells_that_lean_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &|at| {
        let [x, y, z] = upright(at);
        [x + z, y, z]
    });
    let place = "particles[0].place.grid.first=30.1 2.6 10.3 mm";
    let said = |scheme: &str| {
        let convection = format!("gas.controls.convection={scheme}");
        calcine(
            folder.path(),
            &["check", "case.toml"],
            &[place, &convection],
        )
        .1
    };
    assert!(said("central").contains("lean by up to 45 degrees"));
    assert!(!said("van-leer").contains("central convection"));
}

/// Replaces the first of a text in a file of the mesh.
fn changed(folder: &Path, file: &str, from: &str, to: &str) {
    let path = folder.join("polyMesh").join(file);
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.contains(from), "{text}");
    fs::write(&path, text.replacen(from, to, 1)).unwrap();
}

#[test]
fn damage_of_a_mesh_is_told_with_its_place_and_the_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let fresh = || {
        duct(folder.path(), &upright);
    };
    let said = || {
        let (code, said) = calcine(folder.path(), &["check", "case.toml"], &[]);
        assert_eq!(code, Some(2), "{said}");
        said
    };
    // A point in the middle far above the mesh turns cells around it inside out.
    fresh();
    changed(
        folder.path(),
        "points",
        "(2.9999999999999998890e-2 5.0000000000000001041e-3 5.0000000000000002776e-2)",
        "(0.03 0.005 10)",
    );
    let text = said();
    assert!(
        text.contains("about (0.") && text.contains("has a volume of -"),
        "{text}"
    );
    // Two patches of one name.
    fresh();
    changed(folder.path(), "boundary", "top", "bottom");
    let text = said();
    assert!(
        text.contains("two patches have the name `bottom`") && text.contains("rename one"),
        "{text}"
    );
    // A file that OpenFOAM packed.
    fresh();
    let points = folder.path().join("polyMesh/points");
    fs::rename(&points, points.with_extension("gz")).unwrap();
    let text = said();
    assert!(
        text.contains("points.gz is compressed") && text.contains("gunzip"),
        "{text}"
    );
}

#[test]
fn all_patches_without_a_condition_are_told_at_once() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &upright);
    let block = Block {
        levels: [even(4), even(2), even(6)],
        patches: ["west", "east", "side", "side", "bottom", "lid"],
        hole: None,
        shape: &upright,
    };
    block.write(folder.path());
    let (code, said) = calcine(folder.path(), &["check", "case.toml"], &[]);
    assert_eq!(code, Some(2), "{said}");
    for words in [
        "3 patches of the mesh have no boundary condition: `west`, `east`, `lid`, and",
        "give each one in `gas.patch.west`, `gas.patch.east`, `gas.patch.lid`",
        "`gas.patch.top` names no patch of the mesh, which has west, side, bottom, east, lid",
    ] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_particle_outside_the_mesh_of_a_file_is_told_with_its_key() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &upright);
    let away = "particles[0].place.grid.first=20.1 2.6 150 mm";
    let (code, said) = calcine(folder.path(), &["check", "case.toml"], &[away]);
    assert_eq!(code, Some(2), "{said}");
    for words in [
        "lies outside the mesh, at (0.0201, 0.0026, 0.15) m",
        "place = ",
        "check the units of both",
    ] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_mesh_of_a_file_in_millimetres_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    duct(folder.path(), &|at| upright(at).map(|x| 1000.0 * x));
    let place = "particles[0].place.grid.first=20.1 2.6 10.3 m";
    let (code, said) = calcine(folder.path(), &["check", "case.toml"], &[place]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("the mesh measures 60 x 10 x 100 m") && said.contains("transformPoints"),
        "{said}"
    );
}
