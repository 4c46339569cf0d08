//! A run in the hands of a program: the same bits as `calcine run`, and what is set while it goes on.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::Path;
use std::process::Command;

use calcine::assembly::GasBackend;
use calcine::simulation::{BoundaryQuantity, Control, Ending, Simulation, SimulationBuilder};

use crate::support::program::{self, shipped};
use crate::support::results_equal;

/// Forty windows of 0.05 s, with snapshots and rows among them.
const SET: [&str; 3] = [
    "time.end=2 s",
    "output.every=0.7 s",
    "output.series_every=0.1 s",
];

fn column(out: &Path) -> SimulationBuilder {
    let builder = Simulation::open(shipped("heated-column")).out(out);
    SET.into_iter()
        .fold(builder, |builder, one| builder.set(one))
}

/// Raises the inlet's temperature by how cold the hottest particle is, each tenth window.
fn control(simulation: &mut Simulation) {
    if simulation.windows().is_multiple_of(10) {
        let hottest = simulation
            .particle_temperature()
            .iter()
            .copied()
            .fold(0.0, f64::max);
        let inlet = BoundaryQuantity::Temperature(400.0 + 10.0 * (310.0 - hottest));
        simulation.set_boundary("bottom", inlet).unwrap();
    }
}

/// Controls a run to its end; stops and resumes it after so many windows where told.
fn controlled(out: &Path, gas: GasBackend, stop_after: Option<u64>) -> f64 {
    let mut simulation = column(out).gas(gas).start().unwrap();
    loop {
        control(&mut simulation);
        if Some(simulation.windows()) == stop_after {
            assert!(matches!(simulation.stop(), Ok(Ending::Checkpointed(_))));
            drop(simulation);
            simulation = column(out).gas(gas).resume(true).start().unwrap();
            assert_eq!(Some(simulation.windows()), stop_after);
        }
        if let Some(ending) = simulation.step().unwrap() {
            assert_eq!(ending, Ending::Finished);
            return simulation.particle_temperature()[0];
        }
    }
}

#[test]
fn steps_give_the_same_bits_as_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let (command, steps) = (folder.path().join("command"), folder.path().join("steps"));
    program::run(&shipped("heated-column"), &command, &[], &SET);
    let mut simulation = column(&steps).start().unwrap();
    assert_eq!(simulation.advance_to(0.5).unwrap(), None);
    assert!(
        (simulation.time() - 0.5).abs() < 1e-9,
        "{}",
        simulation.time()
    );
    assert_eq!(simulation.windows(), 10);
    assert_eq!(simulation.finish().unwrap(), Ending::Finished);
    assert!(simulation.step().is_err());
    drop(simulation);
    assert_eq!(results_equal::differences(&command, &steps), [""; 0]);
}

#[test]
fn what_was_set_is_part_of_the_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let (whole, parts) = (folder.path().join("whole"), folder.path().join("parts"));
    controlled(&whole, GasBackend::Native, None);
    controlled(&parts, GasBackend::Native, Some(17));
    assert_eq!(results_equal::differences(&whole, &parts), [""; 0]);
}

#[test]
fn openfoam_takes_the_temperature_that_the_program_sets() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let native = controlled(&at("native"), GasBackend::Native, None);
    let openfoam = controlled(&at("openfoam"), GasBackend::Openfoam, None);
    let left = controlled(&at("resumed"), GasBackend::Openfoam, Some(17));
    // The first sphere has warmed by some 10 K; `compare` allows the pairings of this case 0.1 K.
    assert!((native - openfoam).abs() < 0.1, "{native} K, {openfoam} K");
    assert!((left - openfoam).abs() < 1e-6, "{left} K, {openfoam} K");
    // Without control the inlet stays at 400 K: the test would fail if nothing were set.
    let mut free = column(&at("free")).start().unwrap();
    free.finish().unwrap();
    assert!((native - free.particle_temperature()[0]).abs() > 0.5);
}

#[test]
fn what_cannot_be_set_is_refused_and_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (free, asked) = (folder.path().join("free"), folder.path().join("asked"));
    column(&free).start().unwrap().finish().unwrap();
    let mut simulation = column(&asked).start().unwrap();
    for (patch, quantity, words) in [
        (
            "lid",
            BoundaryQuantity::Temperature(300.0),
            "no patch `lid`",
        ),
        (
            "side",
            BoundaryQuantity::HeatFlux(1.0),
            "`side` has no heat flux",
        ),
        (
            "bottom",
            BoundaryQuantity::Temperature(-3.0),
            "-3 K; it must be positive",
        ),
        (
            "top",
            BoundaryQuantity::MassFlow(1.0),
            "`top` has no mass flow",
        ),
    ] {
        let error = simulation
            .set_boundary(patch, quantity)
            .unwrap_err()
            .to_string();
        assert!(error.contains(words), "{error}");
    }
    let error = simulation
        .set_feed_rate("ore", 1.0)
        .unwrap_err()
        .to_string();
    assert!(error.contains("no feed `ore`"), "{error}");
    simulation.finish().unwrap();
    drop(simulation);
    assert_eq!(results_equal::differences(&free, &asked), [""; 0]);
}

#[test]
fn a_feed_follows_the_rate_that_is_set() {
    let folder = tempfile::tempdir().unwrap();
    let set = ["time.end=2 s", "output.every=10 s"];
    let builder = Simulation::open(shipped("moving-bed")).out(folder.path().join("out"));
    let builder = set
        .into_iter()
        .fold(builder, |builder, one| builder.set(one));
    let mut simulation = builder.start().unwrap();
    simulation.set_feed_rate("charge", 0.0).unwrap();
    simulation.set_outlet_rate("discharge", 0.0).unwrap();
    let before = simulation.particles().id.to_vec();
    simulation.advance_to(1.0).unwrap();
    assert_eq!(simulation.particles().id, before);
    let before = before.len();
    simulation
        .set(Control::FeedRate {
            feed: "charge".into(),
            rate: 0.01,
        })
        .unwrap();
    assert_eq!(simulation.controls().len(), 2);
    simulation.advance_to(2.0).unwrap();
    // 10 g/s instead of the case's 1 g/s for a second.
    let beads = &simulation.particles();
    let came: f64 = beads.mass[before..].iter().sum();
    assert!((came - 0.01).abs() < 5e-4, "{came} kg");
}

#[test]
fn a_simulation_goes_on_in_another_thread_and_ends_on_an_interrupt() {
    let folder = tempfile::tempdir().unwrap();
    let mut simulation = column(&folder.path().join("out")).start().unwrap();
    simulation.step().unwrap();
    let interrupts = simulation.interrupts();
    interrupts.raise();
    let (ending, windows) = std::thread::spawn(move || (simulation.finish(), simulation.windows()))
        .join()
        .unwrap();
    assert!(matches!(ending, Ok(Ending::Checkpointed(_))));
    assert_eq!(windows, 2);
}

/// Cargo builds examples with the tests, beside the folder of the test programs.
#[test]
fn the_program_of_the_docs_holds_its_inlet_as_it_stands() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let page = fs::read_to_string(root.join("docs/how-to/drive-from-a-program.md")).unwrap();
    let program = page
        .split("```rust\n")
        .nth(1)
        .and_then(|rest| rest.split("```").next());
    let source = fs::read_to_string(root.join("examples/keep_warm.rs")).unwrap();
    assert!(
        source.ends_with(program.unwrap()),
        "the page and examples/keep_warm.rs differ"
    );

    let folder = tempfile::tempdir().unwrap();
    let case = fs::read_to_string(shipped("heated-column")).unwrap();
    let short = case.replace("\nend = \"10 min\"", "\nend = \"1 s\"");
    assert_ne!(short, case);
    fs::write(folder.path().join("bed.toml"), short).unwrap();
    let tests = std::env::current_exe().unwrap();
    let built = tests.parent().and_then(Path::parent).unwrap();
    let output = Command::new(built.join("examples/keep_warm"))
        .current_dir(folder.path())
        .output()
        .expect("built by `cargo build --example keep_warm`");
    let (text, told) = (output.stdout, String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{told}");
    let text = String::from_utf8(text).unwrap();
    let columns = |line: &str| -> Vec<f64> {
        line.split_whitespace()
            .filter_map(|word| word.parse().ok())
            .collect()
    };
    let rows: Vec<Vec<f64>> = text.lines().map(columns).collect();
    assert!(rows.len() > 10, "{text}");
    let mut inlet = 400.0;
    for row in &rows {
        inlet += 0.1 * (450.0 - row[2]);
        assert!((row[1] - inlet).abs() < 0.02, "{row:?}, {inlet} K");
        inlet = row[1];
    }
    let hottest = rows[rows.len() - 1][2];
    assert!(hottest > 380.0, "{text}");
}
