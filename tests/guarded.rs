//! What users lose or get wrong without a word: files of theirs in the way, settings without an effect, feeds without room.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use calcine::case::read;
use calcine::results::Summary;
use calcine::valid::ValidCase;

use crate::support::program::{self, shipped};

fn good(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/inputs/good/{name}.toml"))
}

fn calcine(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn warnings(name: &str, set: &[&str]) -> Vec<String> {
    let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
    ValidCase::open(&good(name), &set).unwrap().case.warnings
}

fn warned(name: &str, set: &[&str], words: &str) -> bool {
    warnings(name, set).iter().any(|one| one.contains(words))
}

#[test]
fn files_of_the_users_own_are_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    fs::copy(shipped("heated-column"), at("case.toml")).unwrap();
    let run = [
        "run",
        "case.toml",
        "--quiet",
        "--set",
        "time.end=0.5 s",
        "--out",
    ];
    let within = |out: &str| calcine(&[&run[..], &[out]].concat(), folder.path());
    let before = fs::read_to_string(at("case.toml")).unwrap();
    let refused = within(".");
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2), "{told}");
    assert!(
        told.contains("holds `case.toml`, which a run would write over"),
        "{told}"
    );
    assert_eq!(fs::read_to_string(at("case.toml")).unwrap(), before);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);

    fs::create_dir_all(at("mine/checkpoint")).unwrap();
    fs::write(at("mine/checkpoint/thesis.txt"), "mine").unwrap();
    fs::write(at("mine/series.csv"), "mine").unwrap();
    let told = String::from_utf8_lossy(&within("mine").stderr).into_owned();
    assert!(told.contains("holds `checkpoint`, `series.csv`"), "{told}");
    assert_eq!(fs::read_to_string(at("mine/series.csv")).unwrap(), "mine");
    assert!(at("mine/checkpoint/thesis.txt").is_file());

    // Notes beside the results are in nobody's way; results without their summary are.
    fs::create_dir(at("out")).unwrap();
    fs::write(at("out/notes.txt"), "mine").unwrap();
    assert!(within("out").status.success());
    fs::remove_file(at("out/summary.json")).unwrap();
    let rows = fs::read(at("out/series.csv")).unwrap();
    assert_eq!(within("out").status.code(), Some(2));
    assert_eq!(fs::read(at("out/series.csv")).unwrap(), rows);

    for words in [
        &["schema", "--out", "case.toml"][..],
        &[
            "sweep",
            "case.toml",
            "--set",
            "time.end=0.1 s,0.2 s",
            "--table",
            "case.toml",
        ],
    ] {
        let refused = calcine(words, folder.path());
        assert_eq!(refused.status.code(), Some(2), "{words:?}");
        assert_eq!(fs::read_to_string(at("case.toml")).unwrap(), before);
    }
}

#[test]
fn a_run_whose_lock_was_removed_is_not_joined_by_another() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let set = [
        "time.end=1000 s",
        "time.acceleration=1",
        "time.checkpoint.every=0.1 s",
    ];
    let mut first = program::command(&shipped("heated-column"), &out, &[], &set)
        .spawn()
        .unwrap();
    let lock = out.join("lock");
    while !out.join("checkpoint").is_dir() {
        std::thread::sleep(std::time::Duration::from_millis(20));
        assert!(first.try_wait().unwrap().is_none());
    }
    fs::remove_file(&lock).unwrap();
    let second = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["run", "--quiet", "--resume"])
        .arg(&out)
        .output()
        .unwrap();
    first.kill().unwrap();
    first.wait().unwrap();
    let told = String::from_utf8_lossy(&second.stderr);
    assert!(told.contains("another run is writing into"), "{told}");
}

#[test]
fn columns_under_another_name_are_refused_with_the_name_that_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(good("moving")).unwrap();
    let grid = text
        .lines()
        .find(|line| line.starts_with("place = "))
        .unwrap();
    let text = text.replace(grid, "place = { file = \"bead.csv\" }");
    let case = folder.path().join("moving.toml");
    fs::write(&case, text).unwrap();
    fs::copy(
        good("moving").with_file_name("plate.stl"),
        folder.path().join("plate.stl"),
    )
    .unwrap();
    for (name, meant) in [
        ("diameter [mm]", "name it `diameter`"),
        ("diameter_m", "name it `diameter`"),
        ("d_p", "name it `diameter`"),
        ("particle_diameter", "name it `diameter`"),
        ("Durchmesser", "name it `diameter`"),
        ("rad", "name it `radius`"),
        ("temperature (K)", "name it `temperature`"),
        ("T_p", "name it `temperature`"),
        ("t [C]", "name it `temperature`"),
        ("v_x", "name velocities `vx`"),
        ("velocity", "name velocities `vx`"),
        ("rho [kg/m3]", "name it `density`"),
    ] {
        let rows = format!("x,y,z,{name}\n0.005,0.005,0.29,1\n");
        fs::write(folder.path().join("bead.csv"), rows).unwrap();
        let checked = calcine(&["check", "moving.toml"], folder.path());
        let told = String::from_utf8_lossy(&checked.stderr).into_owned();
        assert_eq!(checked.status.code(), Some(2), "{name}: {told}");
        assert!(told.contains(meant), "{name}: {told}");
    }
    for name in ["pressure", "c_stress[1]", "moisture", "material", "number"] {
        let rows = format!("x,y,z,{name}\n0.005,0.005,0.29,1\n");
        fs::write(folder.path().join("bead.csv"), rows).unwrap();
        let checked = calcine(&["check", "moving.toml"], folder.path());
        let told = String::from_utf8_lossy(&checked.stderr);
        assert!(checked.status.success(), "{name}: {told}");
    }
}

#[test]
fn a_feed_without_room_is_warned_of() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, rate: &str| {
        let out = folder.path().join(name);
        let set = ["time.end=0.02 s", rate];
        program::run(&good("moving"), &out, &[], &set);
        Summary::read(&out).unwrap().warnings
    };
    let met = run("met", "feeds[0].mass_rate=\"1 kg/h\"");
    assert!(!met.contains_key("feeds_wait"), "{met:?}");
    let huge = run("huge", "feeds[0].mass_rate=\"200 kg/s\"");
    assert!(huge["feeds_wait"].worst > 0.5, "{huge:?}");
}

#[test]
fn regions_beside_the_mesh_and_in_walls_are_warned_of() {
    let region = |low: &str, high: &str| {
        format!("feeds[0].region={{ box = {{ from = \"{low} mm\", to = \"{high} mm\" }} }}")
    };
    let words = |low: &str, high: &str, words: &str| warned("moving", &[&region(low, high)], words);
    assert!(words(
        "0 0 350",
        "20 20 380",
        "feed `charge` lies beside the mesh"
    ));
    assert!(words(
        "0 0 250",
        "0.5 20 280",
        "feed `charge` reaches into the wall `container.x-`"
    ));
    assert!(!words("0 0 250", "20 20 280", "feed `charge`"));
    let outlet = r#"outlets[0].region={ box = { from = "0 0 -80 mm", to = "20 20 -60 mm" } }"#;
    let outlets = read(&good("moving"), &[]).unwrap().outlets;
    let beside = format!("outlet `{}` lies beside the mesh", outlets[0].name);
    assert!(warned("moving", &[outlet], &beside));
    assert!(!warned("moving", &[], &beside));
}

#[test]
fn what_is_stated_without_an_effect_and_what_is_left_out_is_warned_of() {
    let inlet =
        r#"gas.patch.bottom={ inlet = { superficial_velocity = "1 m/s", temperature = "400 K" } }"#;
    assert!(warned(
        "moving",
        &[inlet],
        "the inlet `bottom` has no effect"
    ));
    let unseen = "the gas does not see walls within its mesh and flows through `plate`";
    assert!(warned(
        "moving",
        &["gas.held=false", "walls[4].scale=2e-3"],
        unseen
    ));
    assert!(!warned("moving", &[], unseen));
    assert!(warned(
        "moving",
        &["walls[0].temperature=\"500 K\""],
        "has no effect: `laws.conduction`"
    ));

    let plate = read(&good("moving"), &[])
        .unwrap()
        .walls
        .last()
        .unwrap()
        .name
        .clone();
    assert_eq!(plate, "plate");
    let folder = tempfile::tempdir().unwrap();
    let text = fs::read_to_string(good("moving")).unwrap();
    let floor = "plane = { point = \"0 0 1 mm\", normal = \"0 0 2\" }";
    let more = format!(
        "[materials.steel]\ndensity = \"7800 kg/m^3\"\nheat_capacity = \"500 J/kg/K\"\n\n[[walls]]\nname = \"again\"\nmaterial = \"glass\"\n{floor}\n\n[motion]"
    );
    let case = folder.path().join("moving.toml");
    fs::write(&case, text.replace("[motion]", &more)).unwrap();
    fs::copy(
        good("moving").with_file_name("plate.stl"),
        folder.path().join("plate.stl"),
    )
    .unwrap();
    let found = ValidCase::open(&case, &[]).unwrap().case.warnings;
    for words in [
        "no wall are of the material `steel`",
        "the walls `floor` and `again` are one surface",
    ] {
        assert!(found.iter().any(|one| one.contains(words)), "{found:?}");
    }

    let text = fs::read_to_string(shipped("settled-bed")).unwrap();
    let without: String = text
        .lines()
        .filter(|line| !line.starts_with("gravity"))
        .map(|line| format!("{line}\n"))
        .collect();
    let case = folder.path().join("hovering.toml");
    fs::write(&case, without).unwrap();
    let found = ValidCase::open(&case, &[]).unwrap().case.warnings;
    assert!(
        found
            .iter()
            .any(|one| one.contains("`gas.gravity` is not stated")),
        "{found:?}"
    );
}
