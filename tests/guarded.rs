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
    fs::write(at("out/lock"), "mine").unwrap();
    assert!(within("out").status.success());
    assert_eq!(fs::read_to_string(at("out/lock")).unwrap(), "mine");
    fs::create_dir(at("locked")).unwrap();
    for name in ["locked/lock", "locked/case.toml"] {
        fs::write(at(name), "mine").unwrap();
    }
    assert_eq!(within("locked").status.code(), Some(2));
    assert_eq!(fs::read_to_string(at("locked/case.toml")).unwrap(), "mine");
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
        ("Diamètre", "name it `diameter`"),
        ("sphere size (mm)", "name it `diameter`"),
        ("rho [kg/m3]", "name it `density`"),
    ] {
        let rows = format!("x,y,z,{name}\n0.005,0.005,0.29,1\n");
        let (code, told) = checked(folder.path(), "bead.csv", &rows);
        assert_eq!(code, Some(2), "{name}: {told}");
        assert!(told.contains(meant), "{name}: {told}");
    }
    for name in [
        "pressure",
        "c_stress[1]",
        "moisture",
        "weight",
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
        let (code, told) = checked(folder.path(), "bead.csv", &rows);
        assert_eq!(code, Some(0), "{name}: {told}");
    }
}

/// A case whose bead is placed by a file, in a folder with its STL.
fn of_file(folder: &Path, file: &str) -> PathBuf {
    let text = fs::read_to_string(good("moving")).unwrap();
    let mut lines = text.lines();
    let grid = lines.find(|line| line.starts_with("place = ")).unwrap();
    let text = text.replace(grid, &format!("place = {{ file = \"{file}\" }}"));
    let case = folder.join("of-file.toml");
    fs::write(&case, text).unwrap();
    let plate = good("moving").with_file_name("plate.stl");
    fs::copy(plate, folder.join("plate.stl")).unwrap();
    case
}

fn checked(folder: &Path, file: &str, content: &str) -> (Option<i32>, String) {
    of_file(folder, file);
    fs::write(folder.join(file), content).unwrap();
    let output = calcine(&["check", "of-file.toml"], folder);
    let told = [&output.stdout[..], &output.stderr[..]].concat();
    (output.status.code(), String::from_utf8(told).unwrap())
}

#[test]
fn check_tells_what_is_read_of_a_file_and_what_is_not() {
    let folder = tempfile::tempdir().unwrap();
    let rows = "x,y,z,volume,Temperature\n0.005,0.005,0.29,1,310\n";
    let (code, told) = checked(folder.path(), "bed.csv", rows);
    assert_eq!(code, Some(0), "{told}");
    assert!(
        told.contains("`bead` from bed.csv: x, y, z, temperature; not read: volume"),
        "{told}"
    );
    assert!(!told.contains("degrees Celsius"), "{told}");
    let rows = "x,y,z,temperature\n0.005,0.005,0.29,77\n";
    let (code, told) = checked(folder.path(), "bed.csv", rows);
    assert_eq!(code, Some(0), "{told}");
    assert!(
        told.contains("line 2 has a temperature of 77 K in a gas of 300 K"),
        "{told}"
    );
}

#[test]
fn dumps_are_known_by_their_content_and_one_that_is_cut_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = |step: u64, names: &str| {
        format!(
            "ITEM: TIMESTEP\n{step}\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS {names}\n1 0.005 0.005 0.29 0.001\n"
        )
    };
    let whole = snapshot(0, "id x y z radius");
    let (code, told) = checked(folder.path(), "bed.txt", &whole);
    assert_eq!(code, Some(0), "{told}");
    let cut = format!("{whole}ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n1\n");
    let (code, told) = checked(folder.path(), "bed.dump", &cut);
    assert_eq!(code, Some(2), "{told}");
    assert!(
        told.contains("timestep 100 ends before its atoms"),
        "{told}"
    );
    for name in ["r", "c_radius", "c_Temp"] {
        let named = snapshot(0, &format!("id x y z {name}"));
        let (code, told) = checked(folder.path(), "bed.dump", &named);
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains("is not read"), "{told}");
    }
}

#[test]
fn frozen_spheres_in_one_place_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("bed.csv"),
        "x,y,z\n0.01,0.01,0.02\n0.01,0.01,0.02\n",
    )
    .unwrap();
    let text = fs::read_to_string(shipped("heated-column")).unwrap();
    let grid = text
        .lines()
        .find(|line| line.starts_with("place = "))
        .unwrap();
    let text = text.replace(grid, "place = { file = \"bed.csv\" }");
    fs::write(folder.path().join("case.toml"), text).unwrap();
    let output = calcine(&["check", "case.toml"], folder.path());
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{told}");
    assert!(told.contains("overlap"), "{told}");
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

/// Without slip there is no drag, whatever the law.
#[test]
fn a_sphere_at_rest_is_in_the_range_of_a_law_of_drag() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    let set = [
        "time.end=0.01 s",
        "laws.drag.law=di-felice",
        "particles[0].velocity=\"0 0 0 m/s\"",
    ];
    program::run(&shipped("settling-sphere"), &out, &[], &set);
    let warnings = Summary::read(&out).unwrap().warnings;
    assert!(!warnings.contains_key("drag.reynolds"), "{warnings:?}");
    let case = ValidCase::open(&shipped("settling-sphere"), &set.map(str::to_owned));
    let told = case.unwrap().case.warnings;
    assert!(
        !told.iter().any(|one| one.contains("law of drag")),
        "{told:?}"
    );
}

#[test]
fn names_that_results_cannot_hold_are_refused_by_check() {
    for name in ["", ".", "a/b", "a,b"] {
        let quantity = format!("quantities[0].name=\"{name}\"");
        let refused = read(&good("moving"), &[quantity]).unwrap_err().render();
        assert!(refused.contains("results have it as a name"), "{refused}");
    }
}

#[test]
fn a_pressure_of_a_patch_off_that_of_the_gas_is_warned_of() {
    let top = |pressure: &str| format!("gas.patch.top.outlet.pressure=\"{pressure}\"");
    let words = "which its density follows";
    assert!(warned("moving", &[&top("0.7 atm")], words));
    assert!(!warned("moving", &[&top("0.99 atm")], words));
}

/// A sphere that cools by radiation: a step is off by up to 0.031 times the square of its rate times the step.
#[test]
fn the_error_of_radiation_over_a_window_is_told() {
    let set = [
        "laws.radiation={ law = \"view-factors\", surroundings = \"300 K\" }",
        "materials.glass.emissivity=0.8",
        "gas.initial.temperature=\"1000 K\"",
    ];
    let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
    let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["check"])
        .arg(good("moving"))
        .args(set.iter().flat_map(|one| ["--set", one]))
        .output()
        .unwrap();
    let told = String::from_utf8(output.stdout).unwrap();
    // h_r A/(m c) = 6 h_r/(d rho c), h_r = 4 0.8 sigma 1000^3 W/(m^2 K), at windows of 2 ms.
    let rate = 6.0 * 4.0 * 0.8 * 5.670_374_419e-8 * 1e9 / (2e-3 * 2500.0 * 840.0);
    let error = 0.031 * f64::powi(rate * 2e-3, 2);
    let line = format!("error of radiation       {error:.2e}");
    assert!(
        told.contains(&line),
        "{line}: {told}{}",
        String::from_utf8_lossy(&output.stderr)
    );
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

#[test]
fn pipes_are_no_input_files_and_are_not_waited_for() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    of_file(folder.path(), "bead.csv");
    let rows = "x,y,z\n0.005,0.005,0.29\n";
    let plate = fs::read(at("plate.stl")).unwrap();
    fs::write(at("bead.csv"), rows).unwrap();
    let text = fs::read(at("of-file.toml")).unwrap();
    for (name, content) in [
        ("bead.csv", rows.as_bytes()),
        ("plate.stl", &plate),
        ("of-file.toml", &text),
    ] {
        fs::remove_file(at(name)).unwrap();
        let made = Command::new("mkfifo").arg(at(name)).status().unwrap();
        assert!(made.success());
        let refused = calcine(&["check", "of-file.toml"], folder.path());
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(!refused.status.success());
        assert!(
            told.contains(name) && told.contains("a pipe or a device"),
            "{told}"
        );
        fs::remove_file(at(name)).unwrap();
        fs::write(at(name), content).unwrap();
    }
}

#[test]
fn csv_without_names_of_columns_is_told_as_such() {
    let folder = tempfile::tempdir().unwrap();
    for rows in ["0.005,0.005,0.29\n", "# my bed\n0.005,0.005,0.29\n"] {
        let (code, told) = checked(folder.path(), "bead.csv", rows);
        assert_eq!(code, Some(2), "{told}");
        assert!(told.contains("names no column that is read"), "{told}");
    }
    let (code, told) = checked(
        folder.path(),
        "bead.csv",
        "x,y,z,d\n0.005,0.005,0.29,1e-12\n"
            .replace(",d\n", ",diameter\n")
            .as_str(),
    );
    assert_eq!(code, Some(2), "{told}");
    assert!(told.contains("below a nanometre"), "{told}");
}

#[test]
fn typeset_signs_are_read_and_keys_that_no_case_has_are_refused() {
    let with = |set: &str| read(&shipped("heated-column"), &[set.to_owned()]);
    let minus = with("gas.gravity=0 0 \u{2212}9.81 m/s^2").unwrap();
    assert_eq!(minus.gas.gravity.z, -9.81);
    let micro = with("particles[0].diameter=900 \u{3bc}m").unwrap();
    assert_eq!(micro.particles[0].sizes.largest(), 9e-4);
    assert!(with("particles[0].diameter=1e-300 m").is_err());
    assert!(with(&format!("{}=1", vec!["a"; 60_000].join("."))).is_err());
    for name in ["top [K]", "a\\nb", "a\\u0000b"] {
        let set = format!("quantities[0].name=\"{name}\"");
        let errors = with(&set).unwrap_err();
        assert!(errors.render().contains("brackets and control"), "{name}");
    }
    let errors = with("quantities[2].expect={ value = \"0 K\", within = \"5 %\" }").unwrap_err();
    assert!(errors.render().contains("has no width"));
}

#[test]
fn tables_of_one_name_and_walls_without_patches_are_refused() {
    let with = |set: &str| {
        read(&shipped("moving-bed"), &[set.to_owned()])
            .unwrap_err()
            .render()
    };
    let text = fs::read_to_string(shipped("moving-bed")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for what in ["feeds", "outlets"] {
        let from = text.find(&format!("[[{what}]]")).unwrap();
        let rest = &text[from..];
        let end = rest.find("\n\n").map_or(rest.len(), |end| end + 2);
        let case = folder.path().join(format!("{what}.toml"));
        fs::write(&case, format!("{text}\n{}", &rest[..end])).unwrap();
        let told = read(&case, &[]).unwrap_err().render();
        assert!(told.contains("a second time"), "{told}");
    }
    let told = with("walls[0].patches=[]");
    assert!(told.contains("names no patch"), "{told}");
}

/// The error of steps between spheres that touch: 1/(12 e) of the square of their rate times the step.
#[test]
fn the_error_of_steps_through_contacts_is_told() {
    let line = |set: &str| {
        let folder = tempfile::tempdir().unwrap();
        let case = good("conducting-column");
        let told = calcine(
            &["check", case.to_str().unwrap(), "--set", set],
            folder.path(),
        );
        let told = String::from_utf8(told.stdout).unwrap();
        let line = told
            .lines()
            .find(|line| line.contains("error through contacts"));
        let line = line.unwrap_or_else(|| panic!("{told}"));
        let words = line.split_whitespace();
        let number = words
            .filter_map(|word| word.parse::<f64>().ok())
            .next_back();
        number.unwrap()
    };
    let [one, ten] = ["0.1 s", "1 s"].map(|step| line(&format!("time.motion_window={step}")));
    assert!(one > 0.0 && (ten / one - 100.0).abs() < 1.0, "{one} {ten}");
}

/// A limit on the size of files is an error of the write, and the run can go on.
#[test]
fn a_limit_on_the_size_of_files_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let program = env!("CARGO_BIN_EXE_calcine");
    let case = shipped("heated-column");
    let line = format!(
        "ulimit -f 20; exec {program} run {} --quiet --out out --set 'output.every=1 s'",
        case.display()
    );
    let shell = Command::new("bash")
        .args(["-c", &line])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&shell.stderr).into_owned();
    assert_eq!(shell.status.code(), Some(1), "{told}");
    assert!(told.contains("File too large"), "{told}");
}

#[test]
fn hot_water_a_mesh_in_millimetres_and_a_cut_snapshot_are_told() {
    let told = |name: &str, set: &[&str], words: &str| {
        let set: Vec<String> = set.iter().map(|one| (*one).to_owned()).collect();
        let case = ValidCase::open(&shipped(name), &set).unwrap().case;
        case.warnings.iter().any(|one| one.contains(words))
    };
    let boils = "at which its water boils";
    assert!(told(
        "wood-drying",
        &["particles[0].temperature=400 K"],
        boils
    ));
    assert!(!told("wood-drying", &[], boils));
    let wide = "times as wide as its bed";
    let large = ["mesh.box.size=\"24 24 64 m\"", "time.end=10 s"];
    assert!(told("wood-drying", &large, wide));
    assert!(!told("wood-drying", &[], wide));
    let folder = tempfile::tempdir().unwrap();
    let vtp = |stated: usize| {
        format!(
            "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"{stated}\"><Points><DataArray \
             type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0.005 0.005 0.29</DataArray></Points></Piece></PolyData></VTKFile>"
        )
    };
    let (code, said) = checked(folder.path(), "bead.vtp", &vtp(1));
    assert_eq!(code, Some(0), "{said}");
    let (code, said) = checked(folder.path(), "bead.vtp", &vtp(3));
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("states 3 points, but holds 1"), "{said}");
}

/// Cells that are a million times as long as they are wide: their bins are as long, and `check` ends at once.
#[test]
fn a_mesh_of_long_cells_is_checked() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("packed-column");
    let line = format!(
        "ulimit -v 4000000; exec {} check {} --set 'mesh.cylinder.length=1e6 m'",
        env!("CARGO_BIN_EXE_calcine"),
        case.display()
    );
    let mut shell = Command::new("timeout");
    shell.args(["100", "bash", "-c", &line]);
    let output = shell.current_dir(folder.path()).output().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{told}");
}
