//! Tuning of plants by the command: known values are found, trials that fail are counted, and what was stopped goes on to the same bits.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use calcine::plant::PlantSummary;

use crate::plants::{calcine, root, run, said};
use crate::support::stopped::{Stopped, stop};

/// Twin data of the shipped case, made here: the growth and the kernel that they were made with are found, and the
/// derivatives are those between runs on both sides.
#[test]
fn a_tuning_finds_a_known_growth_and_kernel_from_twin_data() {
    let folder = tempfile::tempdir().unwrap();
    let shipped = root().join("cases/granulation-tuning.toml");
    let keys = [
        "units.granulator.granulator.growth.linear",
        "units.granulator.granulator.aggregation.rate",
    ];
    let truth = folder.path().join("truth");
    let at = [
        format!("{}=2 mm", keys[0]),
        format!("{}=1e-11 1/s", keys[1]),
    ];
    let settings = [at[0].as_str(), &at[1], "method.tolerance=1e-9"];
    let output = run(&shipped, &truth, &settings, &[]);
    assert!(output.status.success(), "{}", said(&output));
    let table = fs::read_to_string(truth.join("distributions.csv")).unwrap();
    let mut rows = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let head = rows.next().unwrap();
    let edges = head[2..]
        .iter()
        .map(|edge| edge[3..edge.len() - 2].to_owned());
    // Every tenth edge of the size classes is a sieve.
    let picked: Vec<usize> = (9..edges.len()).step_by(10).collect();
    let edges: Vec<String> = edges.collect();
    let mut data = String::from("time_s");
    picked
        .iter()
        .for_each(|k| data.push_str(&format!(", {} m", edges[*k])));
    data.push('\n');
    for row in rows.filter(|row| row[1] == "streams.discharge" && row[0] != "0.0") {
        let masses: Vec<f64> = row[2..].iter().map(|m| m.parse().unwrap()).collect();
        let all: f64 = masses.iter().sum();
        data.push_str(row[0]);
        for k in &picked {
            let below: f64 = masses[..=*k].iter().sum();
            data.push_str(&format!(", {:.4}", below / all));
        }
        data.push('\n');
    }
    fs::write(folder.path().join("granulation-tuning.csv"), data).unwrap();
    let text = fs::read_to_string(&shipped).unwrap();
    let text = text.replace("samples = 8", "samples = 3");
    let case = folder.path().join("twin.toml");
    fs::write(&case, text).unwrap();
    let out = folder.path().join("tuned");
    let words = [
        "tune",
        case.to_str().unwrap(),
        "--quiet",
        "--out",
        out.to_str().unwrap(),
    ];
    let output = calcine(&words);
    assert!(output.status.success(), "{}", said(&output));
    let summary = PlantSummary::read(&out).unwrap();
    let found = summary.tuning.unwrap();
    for (one, truth) in found.parameters.iter().zip([2.0, 1e-11]) {
        assert!((one.value / truth - 1.0).abs() < 1e-2, "{one:?}");
        assert!(one.interval[0] < one.value && one.value < one.interval[1]);
    }
    let mean = |value: &str, name: &str| {
        let own = folder.path().join(name);
        let growth = format!("{}={value} mm", keys[0]);
        let settings = [growth.as_str(), &at[1], "method.tolerance=1e-9"];
        run(&shipped, &own, &settings, &[]);
        PlantSummary::read(&own).unwrap().quantities["discharge_mean"]
            .value
            .unwrap()
    };
    let slope = (mean("2.02", "above") - mean("1.98", "below")) / 0.04;
    let told = found
        .sensitivities
        .iter()
        .find(|one| one.quantity == "discharge_mean")
        .unwrap();
    assert!(
        (told.by[0] / slope - 1.0).abs() < 5e-3,
        "{} {slope}",
        told.by[0]
    );
    assert!(
        said(&output).contains("d discharge_mean / d units.granulator"),
        "{}",
        said(&output)
    );
}

/// A plant with a mill of 50 W, its case beside what the milled mean was, tuned between 10 W and 1 kW, of which the mill's law holds
/// for less than half; `more` stands in its table.
fn milled(folder: &Path, more: &str) -> PathBuf {
    let text = fs::read_to_string(root().join("tests/inputs/plants/good/tuned.toml")).unwrap();
    let (plant, _) = text.split_once("[tuning]").unwrap();
    let mill = "mill = { law = \"constant\", mean = \"1 mm\", deviation = \"0.1 mm\" }";
    assert!(plant.contains(mill));
    let bond = "mill = { law = \"bond-normal\", work_index = \"10 kWh/t\", power = \"50 W\", deviation = \"0.1 mm\" }";
    let plant = plant.replace(mill, bond);
    let twin = folder.join("twin.toml");
    fs::write(&twin, &plant).unwrap();
    let out = folder.join("twin");
    let output = run(&twin, &out, &["method.tolerance=1e-8"], &[]);
    assert!(output.status.success(), "{}", said(&output));
    let series = fs::read_to_string(out.join("series.csv")).unwrap();
    let mut rows = series.lines().map(|row| row.split(',').collect::<Vec<_>>());
    let head = rows.next().unwrap();
    let column = head
        .iter()
        .position(|name| *name == "streams.milled.mean_diameter");
    let mut data = String::from("time_s,mean\n");
    for row in rows.skip(1) {
        data += &format!("{},{}\n", row[0], row[column.unwrap()]);
    }
    fs::write(folder.join("means.csv"), data).unwrap();
    let tuning = format!(
        "[tuning]\nstate = \"run\"\nseed = 3\n{more}\n[[tuning.parameters]]\nkey = \"units.mill.mill.power\"\nlow = \"10 W\"\n\
         high = \"1000 W\"\nlogarithmic = true\n[[tuning.values]]\nstream = \"milled\"\nfield = \"mean_diameter\"\n\
         file = \"means.csv\"\ndeviation = \"5 um\"\n"
    );
    let case = folder.join("milled.toml");
    fs::write(&case, plant + &tuning).unwrap();
    case
}

fn tune(case: &Path, out: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_calcine"));
    command.arg("tune").args(words).arg(case).arg("--quiet");
    command.arg("--out").arg(out);
    command
}

/// A trial with more power than the mill's law holds for is a failed candidate.
#[test]
fn trials_that_fail_are_counted_and_the_tuning_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let case = milled(folder.path(), "samples = 12\nstarts = 2");
    let out = folder.path().join("tuned");
    let output = tune(&case, &out, &[]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let found = PlantSummary::read(&out).unwrap().tuning.unwrap();
    assert!(
        (found.parameters[0].value / 50.0 - 1.0).abs() < 1e-3,
        "{found:?}"
    );
    // A third of the samples and more are above what the law holds for.
    assert!(
        found.failed >= 4 && found.failed < found.trials,
        "{found:?}"
    );
    let told = format!(
        "{} of {} trials failed, as mill \"mill\" at ",
        found.failed, found.trials
    );
    assert!(said(&output).contains(&told), "{}", said(&output));
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    assert!(page.contains("trials failed"));
    // Between bounds where all fail there is nothing to find.
    let text = fs::read_to_string(&case).unwrap();
    fs::write(&case, text.replace("low = \"10 W\"", "low = \"800 W\"")).unwrap();
    let output = tune(&case, &folder.path().join("none"), &[])
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", said(&output));
    assert!(
        said(&output).contains("none of 12 sets"),
        "{}",
        said(&output)
    );
}

#[test]
fn a_tuning_that_was_stopped_or_killed_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = milled(folder.path(), "samples = 20\nstarts = 2");
    let whole = folder.path().join("whole");
    let output = tune(&case, &whole, &[]).output().unwrap();
    assert!(output.status.success(), "{}", said(&output));
    let trials = |out: &Path| {
        let text = fs::read_to_string(out.join("trials.csv"));
        text.map_or(0, |text| text.lines().count().saturating_sub(1))
    };
    let all = trials(&whole);
    for name in ["stopped", "killed"] {
        let out = folder.path().join(name);
        if name == "stopped" {
            let ended = stop(tune(&case, &out, &[]), |_| trials(&out) >= 6);
            assert_eq!(ended, Stopped::Checkpointed);
        } else {
            let mut child = tune(&case, &out, &[]);
            let mut child = child
                .stdout(Stdio::null())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            while trials(&out) < 25 && child.try_wait().unwrap().is_none() {
                std::thread::sleep(std::time::Duration::from_millis(1));
            }
            let _ = child.kill();
            child.wait().unwrap();
        }
        let before = trials(&out);
        assert!(before < all, "{name}: all {all} trials were done");
        let refused = tune(&case, &out, &[]).output().unwrap();
        assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
        assert!(said(&refused).contains("--resume"), "{}", said(&refused));
        let output = calcine(&["tune", "--quiet", "--resume", out.to_str().unwrap()]);
        assert!(output.status.success(), "{}", said(&output));
        // None was computed again.
        assert_eq!(trials(&out), all, "{name} after {before}");
        for file in ["sensitivities.csv", "series.csv", "distributions.csv"] {
            let read = |folder: &Path| fs::read(folder.join(file)).unwrap();
            assert!(read(&out) == read(&whole), "{name}: {file}");
        }
        let [one, other] = [&out, &whole].map(|folder| PlantSummary::read(folder).unwrap());
        assert_eq!(one.tuning, other.tuning);
        assert_eq!(one.quantities, other.quantities);
        let again = calcine(&["tune", "--resume", out.to_str().unwrap()]);
        assert!(said(&again).contains("is complete"), "{}", said(&again));
    }
    // Other measurements are another tuning.
    let means = folder.path().join("means.csv");
    let text = fs::read_to_string(&means).unwrap();
    fs::write(&means, text.replacen("30.0,", "31.0,", 1)).unwrap();
    let refused = calcine(&["tune", "--resume", whole.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(2), "{}", said(&refused));
}
