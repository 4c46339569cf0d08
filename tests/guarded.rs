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

/// Every entry that a finished run leaves, alone in a folder, keeps another run out of it.
fn refuses_each_entry(case: &Path, set: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let first = folder.path().join("first");
    let first_run = program::command(case, &first, &[], set).output().unwrap();
    // Short of its end, quantities may be outside of their bands.
    assert!([Some(0), Some(5)].contains(&first_run.status.code()));
    let report = calcine(&["report", "first"], folder.path());
    assert!(report.status.success());
    // The lock and the log are added to, and of the summary results are told as such.
    let others = ["lock", "log", "summary.json"];
    let entries = fs::read_dir(&first).unwrap().map(|one| one.unwrap().path());
    let names = entries.map(|path| path.file_name().unwrap().to_str().unwrap().to_owned());
    let names: Vec<String> = names
        .filter(|name| !others.contains(&name.as_str()))
        .collect();
    assert!(names.len() > 5, "{names:?}");
    for name in names {
        let mine = folder.path().join("mine");
        fs::create_dir(&mine).unwrap();
        let entry = mine.join(&name);
        match first.join(&name).is_dir() {
            true => fs::create_dir(&entry).unwrap(),
            false => fs::write(&entry, "mine").unwrap(),
        }
        let output = program::command(case, &mine, &[], set).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(
            told.contains(&format!("holds `{name}`, which")),
            "{name}: {told}"
        );
        assert_eq!(fs::read_dir(&mine).unwrap().count(), 1, "{name}");
        fs::remove_dir_all(&mine).unwrap();
    }
}

#[test]
fn whatever_a_run_of_a_bed_writes_is_not_written_over() {
    let set = ["time.end=0.05 s", "time.checkpoint.every=0.02 s"];
    refuses_each_entry(&good("moving"), &set);
}

#[test]
fn whatever_a_run_of_a_plant_writes_is_not_written_over() {
    refuses_each_entry(&shipped("granulation-plant"), &["time.end=60 s"]);
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
        ("velocity_x [m/s]", "name velocities `vx`"),
        ("angular velocity", "name angular velocities `omegax`"),
        ("initial particle mass [g]", "name it `mass`"),
        ("dp", "name it `diameter`"),
        ("rho [kg/m3]", "name it `density`"),
    ] {
        let rows = format!("x,y,z,{name}\n0.005,0.005,0.29,1\n");
        fs::write(folder.path().join("bead.csv"), rows).unwrap();
        let checked = calcine(&["check", "moving.toml"], folder.path());
        let told = String::from_utf8_lossy(&checked.stderr).into_owned();
        assert_eq!(checked.status.code(), Some(2), "{name}: {told}");
        assert!(told.contains(meant), "{name}: {told}");
    }
    for name in [
        "pressure",
        "c_stress[1]",
        "moisture",
        "material",
        "number",
        "mass_fraction_H2O",
        "surface_temperature",
        "velocity_Magnitude",
        "gas_temperature",
        "d50",
        "p",
    ] {
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
    // Feeds stand while the bed is held.
    let held = run("held", "motion.held=[[\"0.5 ms\", \"20 ms\"]]");
    assert!(!held.contains_key("feeds_wait"), "{held:?}");
    assert!(huge["feeds_wait"].worst > 0.5, "{huge:?}");
}

/// Round-off, most of what moves where all have one temperature, is no open balance.
#[test]
fn a_bed_at_the_temperature_of_a_gas_that_is_held_closes() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let set = [
        "time.end=1 s",
        "gas.held=true",
        "gas.initial.temperature=\"300 K\"",
        "particles[0].temperature=\"300 K\"",
    ];
    program::run(&shipped("heated-bed"), &out, &[], &set);
    let summary = Summary::read(&out).unwrap();
    let energy = &summary.ledger.lines["energy"];
    assert!(energy.relative_error > 1e-3, "{energy:?}");
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
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
    // A region as wide as its drum holds spheres that touch the wall and none in it.
    let round = |radius: &str| {
        let region = format!(
            r#"feeds[1].region={{ cylinder = {{ from = "10 10 200 mm", to = "10 10 220 mm", radius = "{radius}" }} }}"#
        );
        let set = [&region, r#"walls[2].cylinder.radius="9 mm""#];
        warned("moving", &set, "feed `second` reaches into the wall `drum`")
    };
    assert!(!round("9 mm"));
    assert!(round("9.5 mm"));
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

    for (law, key) in [
        ("rolling", "rolling_friction"),
        ("cohesion", "cohesion_energy"),
    ] {
        let none = format!("motion.{law}={{ law = \"none\" }}");
        let words = format!("`contacts[0].{key}` has no effect: the law of `motion.{law}`");
        assert!(warned("moving", &[&none], &words), "{law}");
        assert!(!warned("moving", &[], &words), "{law}");
    }

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
