//! Results of a run: written by the recorder, read by others.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::results::read::Series;
use calcine::results::summary::RunFailure;
use calcine::results::{Recorder, ResultsError, Summary, Verdict};
use calcine_coupler::observer::Observer;

use crate::support::fake;

fn python(script: &str, directory: &Path) -> String {
    let output = Command::new("/usr/bin/python3")
        .args(["-c", script])
        .arg(directory)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}{}",
        String::from_utf8_lossy(&output.stdout),
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn rows_and_snapshots_fall_on_the_first_window_at_or_after_each_multiple() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    fake::run(&fake::case(), &out, 0.0);
    let series = fs::read_to_string(out.join("series.csv")).unwrap();
    let times: Vec<&str> = series
        .lines()
        .skip(1)
        .map(|line| line.split(',').next().unwrap())
        .collect();
    // Windows end at multiples of 0.5 s, rows are wanted each 0.7 s: 0, 0.7, 1.4, 2.1, 2.8 …
    assert_eq!(times[..5], ["0.0", "1.0", "1.5", "2.5", "3.0"]);
    assert_eq!(times.last(), Some(&"20.0"));
    // No pressure is solved before the first window.
    let drop = Series::read(&out).unwrap();
    let drop = drop.column("quantities.pressure_drop");
    assert!(drop[0].is_nan() && drop[1..].iter().all(|value| value.is_finite()));
    let collection = fs::read_to_string(out.join("gas.pvd")).unwrap();
    let steps: Vec<&str> = collection
        .split("timestep=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .collect();
    assert_eq!(steps, ["0.0", "5.0", "10.0", "15.0", "20.0"]);
}

#[test]
fn a_balance_that_is_open_at_the_end_is_warned_of() {
    for (mass, energy, told) in [
        (0.995e-3, 0.995e-3, None),
        (1.005e-3, 0.0, Some(1.005e-3)),
        (1.005e-3, 0.16, Some(0.16)),
    ] {
        let scratch = tempfile::tempdir().unwrap();
        let out = scratch.path().join("out");
        let (case, mut world) = (fake::case(), fake::World::new());
        let mut recorder = Recorder::create(&case, fake::info(), &out, None).unwrap();
        recorder.start(&world.moment()).unwrap();
        while world.clocks.process < case.time.end {
            world.step(&case);
            recorder.window(&world.moment()).unwrap();
        }
        (world.ledger.mass, world.ledger.energy) = Default::default();
        world.ledger.mass.book(-2.0 * mass, 2.0);
        world.ledger.energy.book(3.0 * energy, 3.0);
        recorder.finish(&world.moment()).unwrap();
        let warnings = Summary::read(&out).unwrap().warnings;
        let found = warnings.get("open_balance");
        assert_eq!(found.is_some(), told.is_some(), "{warnings:?}");
        if let (Some(found), Some(told)) = (found, told) {
            assert!((found.worst / told - 1.0).abs() < 1e-12, "{found:?}");
        }
    }
}

#[test]
fn the_summary_has_the_stable_names_of_the_design() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let recorder = fake::run(&fake::case(), &out, 0.0);
    let text = fs::read_to_string(out.join("summary.json")).unwrap();
    let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
    let stages = "total gas particles interior mapping smoother exchange output";
    let mut names = vec![
        "/case/name".to_owned(),
        "/case/hash".into(),
        "/backend/gas".into(),
        "/backend/particles".into(),
        "/transport".into(),
        "/storage".into(),
        "/acceleration".into(),
        "/motion_time_s".into(),
        "/process_time_s".into(),
        "/windows".into(),
        "/particles".into(),
        "/cells".into(),
        "/processor_time_s/gas".into(),
        "/processor_time_s/particles".into(),
        "/gas_phases_s".into(),
        "/ledger/elements".into(),
    ];
    names.extend(
        ["mass", "energy", "momentum"].map(|line| format!("/ledger/{line}/relative_error")),
    );
    names.extend(
        stages
            .split(' ')
            .map(|stage| format!("/wall_time_s/{stage}")),
    );
    names.extend(
        ["value", "unit", "band", "verdict"].map(|key| format!("/quantities/pressure_drop/{key}")),
    );
    for name in names {
        assert!(
            summary.pointer(&name).is_some(),
            "{name} is missing:\n{text}"
        );
    }
    assert_eq!(summary["process_time_s"], 20.0);
    assert_eq!(summary["motion_time_s"], 0.4);
    assert_eq!(summary["windows"], 40);
    // 150 Pa/m over 0.12 m, carried from the cells to the faces by the gradient.
    let drop = summary["quantities"]["pressure_drop"]["value"]
        .as_f64()
        .unwrap();
    assert!((drop - 18.0).abs() < 1e-9, "{drop}");
    assert_eq!(summary["quantities"]["pressure_drop"]["verdict"], "pass");
    assert_eq!(summary["quantities"]["pressure_drop"]["at_s"], 10.0);
    assert_eq!(summary["quantities"]["top_temperature"]["verdict"], "none");
    assert_eq!(summary["quantities"]["mean_temperature"]["verdict"], "fail");
    assert_eq!(recorder.summary().unwrap().verdict, Verdict::Fail);
    assert_eq!(Summary::read(&out).unwrap(), *recorder.summary().unwrap());
    let status = fs::read_to_string(out.join("status.json")).unwrap();
    let status: serde_json::Value = serde_json::from_str(&status).unwrap();
    assert_eq!(status["fraction_done"], 1.0);
    assert_eq!(status["state"], "complete");
}

#[test]
fn results_of_another_run_are_never_written_over() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    fake::run(&fake::case(), &out, 0.0);
    let before = fs::read(out.join("series.csv")).unwrap();
    let error = Recorder::create(&fake::case(), fake::info(), &out, None)
        .err()
        .unwrap();
    assert!(matches!(error, ResultsError::Occupied { .. }));
    assert!(
        error
            .to_string()
            .contains("another run of `heated-column` (complete, process time 20 s)")
    );
    let help = miette::Diagnostic::help(&error).unwrap().to_string();
    assert!(
        help.contains("--out") && !help.contains("--resume"),
        "{help}"
    );
    assert_eq!(fs::read(out.join("series.csv")).unwrap(), before);
}

#[test]
fn after_a_kill_and_a_resume_all_files_are_those_of_the_uninterrupted_run() {
    let case = fake::case();
    let scratch = tempfile::tempdir().unwrap();
    let whole = scratch.path().join("whole");
    fake::run(&case, &whole, 0.0);

    let out = scratch.path().join("out");
    let checkpoint = scratch.path().join("checkpoint");
    let mut world = fake::World::new();
    let mut recorder = Recorder::create(&case, fake::info(), &out, None).unwrap();
    recorder.start(&world.moment()).unwrap();
    for _ in 0..33 {
        world.step(&case);
        recorder.window(&world.moment()).unwrap();
        if world.clocks.process.seconds() == 8.0 {
            recorder.checkpoint(&world.moment(), &checkpoint).unwrap();
        }
    }
    // Killed: nothing of the recorder is closed or flushed.
    std::mem::forget(recorder);
    assert!(out.join("gas/gas_0003.vtu").exists());
    fs::write(out.join("results.h5"), "torn").unwrap();

    let mut world = fake::World::new();
    for _ in 0..16 {
        world.step(&case);
    }
    let mut recorder = Recorder::create(&case, fake::info(), &out, Some(&checkpoint)).unwrap();
    assert!(!out.join("gas/gas_0003.vtu").exists());
    recorder.start(&world.moment()).unwrap();
    while world.clocks.process < case.time.end {
        world.step(&case);
        recorder.window(&world.moment()).unwrap();
    }
    recorder.finish(&world.moment()).unwrap();
    drop(recorder);

    for name in [
        "series.csv",
        "gas.pvd",
        "particles.pvd",
        "gas/gas_0004.vtu",
        "particles/particles_0004.vtp",
    ] {
        assert!(
            fs::read(whole.join(name)).unwrap() == fs::read(out.join(name)).unwrap(),
            "{name} differs"
        );
    }
    let mut once = Summary::read(&whole).unwrap();
    let mut twice = Summary::read(&out).unwrap();
    once.wall_time_s = Default::default();
    twice.wall_time_s = Default::default();
    once.processor_time_s = Default::default();
    twice.processor_time_s = Default::default();
    once.gas_phases_s = Default::default();
    twice.gas_phases_s = Default::default();
    assert_eq!(once, twice);
    #[cfg(feature = "hdf5")]
    assert_eq!(datasets(&whole), datasets(&out));
}

#[test]
fn a_checkpoint_of_another_case_is_refused() {
    let mut case = fake::case();
    let scratch = tempfile::tempdir().unwrap();
    let (out, checkpoint) = (
        scratch.path().join("out"),
        scratch.path().join("checkpoint"),
    );
    let world = fake::World::new();
    let mut recorder = Recorder::create(&case, fake::info(), &out, None).unwrap();
    recorder.start(&world.moment()).unwrap();
    recorder.checkpoint(&world.moment(), &checkpoint).unwrap();
    case.hash = "f".repeat(64);
    let error = Recorder::create(&case, fake::info(), &out, Some(&checkpoint))
        .err()
        .unwrap();
    assert!(matches!(error, ResultsError::OtherCase { .. }), "{error}");
}

/// Every dataset of a result file by its path, as bits.
#[cfg(feature = "hdf5")]
fn datasets(directory: &Path) -> Vec<(String, Vec<u64>)> {
    fn collect(group: &hdf5::Group, list: &mut Vec<(String, Vec<u64>)>) {
        for dataset in group.datasets().unwrap() {
            let values = dataset.read_raw::<f64>().unwrap();
            list.push((
                dataset.name(),
                values.into_iter().map(f64::to_bits).collect(),
            ));
        }
        for child in group.groups().unwrap() {
            collect(&child, list);
        }
    }
    let file = hdf5::File::open(directory.join("results.h5")).unwrap();
    let mut list = Vec::new();
    collect(&file, &mut list);
    list.sort();
    list
}

#[cfg(feature = "hdf5")]
#[test]
fn the_hdf5_file_holds_the_values_of_the_csv_file_bit_for_bit() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    fake::run(&fake::case(), &out, 0.0);
    let text = fs::read_to_string(out.join("series.csv")).unwrap();
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| {
            line.split(',')
                .map(|value| value.parse().unwrap())
                .collect()
        })
        .collect();
    let file = hdf5::File::open(out.join("results.h5")).unwrap();
    let tracks = file.dataset("series/particle_temperature").unwrap();
    assert_eq!(tracks.shape(), [rows.len(), 10]);
    let tracks = tracks.read_raw::<f64>().unwrap();
    for (place, name) in names.iter().enumerate() {
        let (name, unit) = name.trim_end_matches(']').split_once(" [").unwrap();
        let column: Vec<u64> = rows.iter().map(|row| row[place].to_bits()).collect();
        let stored: Vec<u64> = match name.strip_prefix("particle_temperature.") {
            Some(id) => {
                let number: usize = id.parse().unwrap();
                tracks
                    .iter()
                    .skip(number - 1)
                    .step_by(10)
                    .map(|value| value.to_bits())
                    .collect()
            }
            None => {
                let dataset = file
                    .dataset(&format!("series/{}", name.replace('.', "/")))
                    .unwrap();
                let attribute = dataset.attr("unit").unwrap();
                let stored: hdf5::types::VarLenUnicode = attribute.read_scalar().unwrap();
                assert_eq!(stored.as_str(), unit);
                dataset
                    .read_raw::<f64>()
                    .unwrap()
                    .into_iter()
                    .map(f64::to_bits)
                    .collect()
            }
        };
        assert_eq!(stored, column, "{name}");
    }
    let probe = file.dataset("probes/axis/temperature").unwrap();
    assert_eq!(probe.shape(), [5, 25]);
    let probe = file.dataset("probes/axis/particles/temperature").unwrap();
    assert_eq!(probe.shape(), [5, 25]);
    let table = fs::read_to_string(out.join("probes/probes_0004.csv")).unwrap();
    let head = "probe,distance [m],x [m],y [m],z [m],temperature [K],";
    assert!(table.starts_with(head), "{table}");
    assert_eq!(table.lines().count(), 1 + 25);
    let field = file.dataset("snapshots/0004/gas/velocity").unwrap();
    assert_eq!(field.shape(), [48, 3]);
}

/// Reads the last snapshots with VTK and prints what it found.
const READ_BACK: &str = r#"
import sys, vtk
import xml.etree.ElementTree as tree
folder = sys.argv[1]
for name, reader in (("gas", vtk.vtkXMLUnstructuredGridReader()), ("particles", vtk.vtkXMLPolyDataReader())):
    entries = tree.parse(f"{folder}/{name}.pvd").getroot().findall("Collection/DataSet")
    last = entries[-1]
    reader.SetFileName(f"{folder}/" + last.get("file"))
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetCellData() if name == "gas" else grid.GetPointData()
    time = grid.GetFieldData().GetArray("TimeValue").GetValue(0)
    names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    temperature = data.GetArray("temperature")
    print(name, len(entries), last.get("timestep"), time, grid.GetNumberOfCells(), ",".join(names), temperature.GetValue(9))
    if name == "gas":
        sizes = vtk.vtkCellSizeFilter()
        sizes.SetInputData(grid)
        sizes.Update()
        volumes = sizes.GetOutput().GetCellData().GetArray("Volume")
        total = sum(volumes.GetValue(i) for i in range(grid.GetNumberOfCells()))
        print("volume %.12e" % total, grid.GetCellType(0))
"#;

#[test]
fn the_vtk_of_debian_reads_gas_particles_and_their_times() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    fake::run(&fake::case(), &out, 0.0);
    let text = python(READ_BACK, &out);
    let lines: Vec<&str> = text.lines().collect();
    assert!(
        lines[0].starts_with("gas 5 20.0 20.0 48 temperature,velocity,pressure,void_fraction"),
        "{text}"
    );
    // Positive volumes that sum to the duct's show that VTK reads the corners in the right order.
    assert_eq!(lines[1], "volume 1.200000000000e-05 12");
    assert!(
        lines[2].starts_with("particles 5 20.0 20.0 10 id,population,radius,temperature,heat"),
        "{text}"
    );
    let temperature: f64 = lines[2].rsplit(' ').next().unwrap().parse().unwrap();
    let mut world = fake::World::new();
    while world.clocks.process < fake::case().time.end {
        world.step(&fake::case());
    }
    assert_eq!(temperature, world.temperature[9]);
}

#[test]
fn cells_that_are_no_hexahedra_are_polyhedra_for_vtk_and_in_the_picture() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    fake::run_on(fake::meshes::prisms(), &fake::case(), &out, 0.0);
    let text = python(READ_BACK, &out);
    assert!(text.starts_with("gas 5 20.0 20.0 24 "), "{text}");
    assert!(text.contains("\nvolume 1.200000000000e-05 42\n"), "{text}");
    let page = fs::read_to_string(calcine::report::write(&out).unwrap()).unwrap();
    // Each layer's two prisms are cut in five views.
    assert_eq!(page.matches("<polygon").count(), 5 * 24);
}

#[test]
fn a_full_disk_ends_in_an_error_that_names_the_file() {
    let scratch = tempfile::tempdir().unwrap();
    let out = scratch.path().join("out");
    let (case, mut world) = (fake::case(), fake::World::new());
    let mut recorder = Recorder::create(&case, fake::info(), &out, None).unwrap();
    recorder.start(&world.moment()).unwrap();
    // The device that is always full stands in for the next snapshot.
    std::os::unix::fs::symlink("/dev/full", out.join("gas/gas_0001.vtu.new")).unwrap();
    let error = loop {
        world.step(&case);
        if let Err(error) = recorder.window(&world.moment()) {
            break error;
        }
    };
    let text = error.to_string();
    assert!(
        text.contains("gas/gas_0001.vtu") && text.contains("No space left"),
        "{text}"
    );
    // Nothing of the file is left to take up room, and who watches the run is told of its end with no room at all.
    assert!(fs::symlink_metadata(out.join("gas/gas_0001.vtu.new")).is_err());
    for name in ["summary.json.new", "status.json.new"] {
        std::os::unix::fs::symlink("/dev/full", out.join(name)).unwrap();
    }
    let failure = RunFailure {
        code: 1,
        message: text,
    };
    let error = recorder.stopped(Some(failure)).unwrap_err().to_string();
    assert!(error.contains("summary.json"), "{error}");
    let status = fs::read_to_string(out.join("status.json")).unwrap();
    let status: serde_json::Value = serde_json::from_str(&status).unwrap();
    assert_eq!(status["state"], "stopped");
}

#[test]
fn a_probe_outside_the_mesh_and_an_unknown_patch_are_refused_at_the_start() {
    let scratch = tempfile::tempdir().unwrap();
    let world = fake::World::new();
    let refusal = |case: &calcine::case::model::Case, name: &str| {
        let out = scratch.path().join(name);
        let mut recorder = Recorder::create(case, fake::info(), &out, None).unwrap();
        recorder.start(&world.moment()).unwrap_err().to_string()
    };
    let mut case = fake::case();
    for point in &mut case.probes[0].points {
        point.x = 1.0;
    }
    let text = refusal(&case, "probe");
    assert!(
        text.contains("no point of the probe `axis` lies inside the gas mesh"),
        "{text}"
    );
    let mut case = fake::case();
    case.quantities[0].measure = calcine::case::model::Measure::Difference {
        field: "pressure".into(),
        patches: ["bottom".into(), "lid".into()],
    };
    let text = refusal(&case, "patch");
    assert!(
        text.contains("names the patch `lid`, which the mesh lacks"),
        "{text}"
    );
}
