//! The thermogravimetric furnace of `cases/tg-furnace.toml` at 15 K/min with 1000 grains and at 6 K/min with 2000: the lumped model of
//! `cases/tg-tuning.toml` tuned to the first and used unchanged at the second (requirements DEC-V1, DEC-V2, DEC-T12).

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::case::parse_tuning;
use calcine::results::Summary;
use calcine::tuning::tune;
use calcine_coupler::ledger::STORAGE_CLOCK;
use calcine_tuning::{ComparedQuantity, SampleProblem, TuningProblem};
use serde_json::Value;

use crate::shipped;

/// Before tuning, in W/m²/K and 1/s: the paper's, and the film that `cases/tg-tuning.toml` assumes.
const UNTUNED: [(&str, f64); 3] = [
    ("contact_transfer", 100.0),
    ("pre_exponential", 1.235e15),
    ("gas_transfer", 20.0),
];
/// A furnace: heating rate in K/min, number of grains, and the share of the times of a run at 6 K/min.
struct Furnace {
    name: &'static str,
    rate: f64,
    grains: u32,
    share: f64,
}

const FURNACES: [Furnace; 2] = [
    Furnace {
        name: "fast",
        rate: 15.0,
        grains: 1000,
        share: 0.4,
    },
    Furnace {
        name: "slow",
        rate: 6.0,
        grains: 2000,
        share: 1.0,
    },
];

/// Mean relative errors of temperature and mass over the run, and the largest of the mass over its loss where it reacts.
struct Errors([f64; 3]);

pub fn run() {
    let folder = tempfile::tempdir().unwrap();
    let case = shipped("tg-furnace");
    for furnace in &FURNACES {
        let seconds = |at: f64| format!("{} s", at * furnace.share);
        let ramp = format!(
            "[[\"0 s\", \"293.15 K\"], [\"{}\", \"1293.15 K\"]]",
            seconds(1e4)
        );
        let mut set = vec![
            format!("particles.grains.place.type={}", furnace.grains),
            format!("time.end={}", seconds(9800.0)),
            format!(
                "time.process_step=[[\"0 s\", \"{}\"], [\"{}\", \"{}\"]]",
                seconds(60.0),
                seconds(5200.0),
                seconds(10.0)
            ),
            format!("output.series_every={}", seconds(10.0)),
        ];
        for key in [
            "gas.patch.side.wall.heat.temperature",
            "gas.patch.bottom.inlet.temperature",
            "bodies.crucible.radiation.surroundings",
            "laws.radiation.surroundings",
        ] {
            set.push(format!("{key}={ramp}"));
        }
        let (out, series) = crate::run(&case, folder.path(), furnace.name, &set);
        let summary = Summary::read(&out).unwrap();
        for (name, line) in &summary.ledger.lines {
            if name != STORAGE_CLOCK && name != "gas_momentum" {
                assert!(line.relative_error < 1e-10, "{name}: {line:?}");
            }
        }
        told_of_order(furnace, &series);
    }
    // The paper's parameters and bounds; and the crucible's film with them, without a bound that is met at the other contact.
    let free = "high = \"150 W/m^2/K\"";
    let three = [
        (free, "high = \"2000 W/m^2/K\""),
        (
            "[[targets]]",
            "[parameters.gas_transfer]\nlow = \"5 W/m^2/K\"\nhigh = \"100 W/m^2/K\"\n\n[[targets]]",
        ),
    ];
    told(folder.path(), &[], false);
    told(folder.path(), &three, true);
}

/// Tunes with changes of the text of the tuning, and prints the errors before and after; asks for the requirement where it reacts.
fn told(folder: &Path, changes: &[(&str, &str)], holds: bool) {
    let [untuned, tuned] = errors(folder, changes);
    for (k, (furnace, whole)) in FURNACES.iter().zip([0.02, 0.01]).enumerate() {
        let (before, after) = (&untuned[k].0, &tuned[k].0);
        println!(
            "  {} parameters, {} K/min, {} grains: mean relative error of temperature {:.2} % (untuned {:.2}), of mass {:.2} % ({:.2}), largest of the loss \
             where it reacts {:.2} % ({:.2})",
            2 + changes.len() / 2,
            furnace.rate,
            furnace.grains,
            100.0 * after[0],
            100.0 * before[0],
            100.0 * after[1],
            100.0 * before[1],
            100.0 * after[2],
            100.0 * before[2]
        );
        assert!(after[0] < whole && after[1] < whole, "{}", furnace.name);
        assert!(
            !holds || (after[2] < 0.01 && after[2] < 0.5 * before[2]),
            "{}",
            furnace.name
        );
    }
}

/// Times of 1, 50 and 99 % of the conversion, in this order, and of the most carbon dioxide in the crucible.
fn told_of_order(furnace: &Furnace, series: &calcine::results::read::Series) {
    let times = series.column("process_time");
    let mass = series.column("quantities.sample_mass");
    let [first, last] = [mass[0], mass[mass.len() - 1]];
    let at = |share: f64| {
        let left = first - share * (first - last);
        times[mass.partition_point(|own| *own > left)]
    };
    let gas = series.column("quantities.crucible_co2");
    let peak = (0..gas.len())
        .max_by(|&a, &b| gas[a].total_cmp(&gas[b]))
        .unwrap();
    let slope = |k: usize| (mass[k - 1] - mass[k]) / (times[k] - times[k - 1]);
    let steepest = (1..mass.len())
        .max_by(|&a, &b| slope(a).total_cmp(&slope(b)))
        .unwrap();
    println!(
        "  {} K/min: 1, 50, 99 % at {:.0}, {:.0}, {:.0} s; fastest at {:.0} s, most carbon dioxide in the crucible at {:.0} s",
        furnace.rate,
        at(0.01),
        at(0.5),
        at(0.99),
        times[steepest],
        times[peak]
    );
    assert!(at(0.01) < times[steepest] && times[steepest] < at(0.99));
    assert!(steepest.abs_diff(peak) <= 2, "{steepest} {peak}");
}

/// Errors of the untuned model and of the tuned one, at each rate.
fn errors(folder: &Path, changes: &[(&str, &str)]) -> [Vec<Errors>; 2] {
    let shipped = fs::read_to_string(shipped("tg-tuning")).unwrap();
    let (head, rest) = shipped.split_once("[[targets]]").unwrap();
    let (_, method) = rest.split_once("[method]").unwrap();
    let mut text = head.to_owned();
    for furnace in &FURNACES {
        text += &format!(
            "[[targets]]\nname = \"{0}\"\nfile = \"{0}/series.csv\"\nfit = {1}\nheating_rate = \"{2} K/min\"\nstart_temperature = \"293.15 K\"\n\
             compare = [\"temperature\", \"mass\"]\ncolumns = {{ time = \"process_time [s]\", temperature = \"quantities.sample_temperature [K]\", \
             mass = \"quantities.sample_mass [kg]\" }}\n\n",
            furnace.name,
            furnace.name == "fast",
            furnace.rate
        );
    }
    text += &format!("[method]{method}");
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    let path = folder.join("tuning.toml");
    fs::write(&path, &text).unwrap();
    let out = folder.join(format!("tuned-{}", changes.len()));
    let output = Command::new(env!("CARGO_BIN_EXE_calcine"))
        .args(["tune", "--quiet", "--out"])
        .args([&out, &path])
        .output()
        .unwrap();
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{told}");
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let found = &summary["tuning"]["parameters"];
    for (name, value) in found.as_object().unwrap() {
        println!("  {name} {} {}", value["value"], value["unit"]);
    }
    let row = |target: &str, quantity: &str| {
        let rows = summary["tuning"]["curves"].as_array().unwrap().iter();
        let mut rows = rows.filter(|row| row["target"] == target && row["quantity"] == quantity);
        rows.next().unwrap().clone()
    };
    let tuned = FURNACES.iter().map(|furnace| {
        let mean = |quantity: &str| row(furnace.name, quantity)["mean_relative_error"].as_f64();
        let largest = row(furnace.name, "mass")["largest_error_of_loss"].as_f64();
        Errors([mean("temperature"), mean("mass"), largest].map(Option::unwrap))
    });
    let tuned = tuned.collect();
    // The untuned model, by the library.
    let case = parse_tuning(&path, &text, &[]).unwrap();
    let candidate = &case.model.laws[0];
    let model = case.model.model(candidate);
    let curves = case
        .targets
        .iter()
        .chain(&case.kept_back)
        .cloned()
        .collect();
    let space = case.space_of(&*model).unwrap();
    let problem = SampleProblem::new(&*model, space, curves, case.method.differences).unwrap();
    let names = problem.space().parameters().iter().enumerate();
    let places: Vec<f64> = names
        .map(|(k, one)| {
            let stated = UNTUNED.iter().find(|(name, _)| *name == one.name).unwrap();
            problem.space().place(k, stated.1)
        })
        .collect();
    let curves = tune::curves(&problem, &places, false).unwrap();
    let of = |target: &str, quantity| {
        let mut own = curves.iter();
        let own = own.find(|one| one.target == target && one.quantity == quantity);
        own.unwrap().errors(case.loss)
    };
    let untuned = FURNACES.iter().map(|furnace| {
        let mass = of(furnace.name, ComparedQuantity::Mass);
        let temperature = of(furnace.name, ComparedQuantity::Temperature);
        let all = [
            temperature.mean_relative,
            mass.mean_relative,
            mass.largest_of_loss,
        ];
        Errors(all.map(Option::unwrap))
    });
    [untuned.collect(), tuned]
}
