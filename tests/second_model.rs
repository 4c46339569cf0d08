//! A model of particles that nothing but this test knows, beside the thin one in one run: columns, channels, contacts,
//! resizing, exhaustion, feeds; resuming, `--from`, results and comparison by its columns' names alone.

#![cfg(feature = "hdf5")]
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod granule;

use std::path::{Path, PathBuf};

use calcine::assembly::{ParticleBackend, SolverStarts};
use calcine::case::model::Case;
use calcine::compare;
use calcine::results::Summary;
use calcine::results::read::arrays;
use calcine::simulation::{Ending, Simulation, SimulationBuilder};
use calcine_coupler::interior::ParticleModel;
use calcine_coupler::physics::gas_model::GasModel;

use crate::support::results_equal;
use granule::Granules;

fn granules(case: &Case, shrinks: bool) -> Box<dyn ParticleModel> {
    let GasModel::Mixture(gas) = &case.gas.properties else {
        panic!("water vapour is a species of a mixture");
    };
    Box::new(Granules::new(gas.clone(), shrinks))
}

fn case() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs/good/two-models.toml")
}

fn moving(out: &Path) -> SimulationBuilder {
    Simulation::open(case())
        .out(out)
        .model("wet", |case| granules(case, true))
}

fn closes(summary: &Summary) {
    for name in [
        "mass",
        "energy",
        "energy_exchange",
        "particle_mass",
        "particle_momentum",
    ] {
        let error = summary.ledger.lines[name].relative_error;
        println!("{name}: {error:.1e}");
        assert!(error < 1e-11, "{name}: {error}");
    }
    for element in ["H", "O"] {
        let line = &summary.ledger.elements[element];
        assert!(line.throughput > 0.0);
        assert!(
            line.relative_error < 1e-11,
            "{element}: {}",
            line.relative_error
        );
    }
}

/// Runs to the end; after so many windows a checkpoint is written, and the run goes on or is resumed from it.
fn to_the_end(out: &Path, checkpoint: u64, resume: bool) -> Simulation {
    let mut simulation = moving(out).start().unwrap();
    loop {
        if simulation.windows() == checkpoint {
            if resume {
                assert!(matches!(simulation.stop(), Ok(Ending::Checkpointed(_))));
                drop(simulation);
                simulation = moving(out).resume(true).start().unwrap();
            } else {
                simulation.checkpoint().unwrap();
            }
        }
        if let Some(ending) = simulation.step().unwrap() {
            assert_eq!(ending, Ending::Finished);
            return simulation;
        }
    }
}

#[test]
fn a_model_of_ones_own_runs_beside_the_thin_one_and_resumes_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let (one, other) = (folder.path().join("whole"), folder.path().join("resumed"));
    let whole = to_the_end(&one, 17, false);
    closes(&Summary::read(&one).unwrap());
    // Granules came in, dried, shrank and were used up; what was left of them stands in the ledger.
    let ledger = whole.ledger();
    let used_up = &ledger.used_up;
    println!("used up: {used_up:?}, fed: {:?}", ledger.fed_and_discharged);
    assert!(used_up.particles > 0 && used_up.mass > 0.0);
    let fresh = 1500.0 * std::f64::consts::PI / 6.0 * 6e-3f64.powi(3);
    let left = used_up.mass / (used_up.particles as f64 * fresh);
    assert!((0.08..0.12).contains(&left), "{left} of a fresh granule");
    assert!(ledger.fed_and_discharged[0].particles > 4);
    let smallest = whole.particles().radius.iter().copied().fold(1.0, f64::min);
    assert!(smallest < 2.9e-3, "{smallest} m");
    let models = whole.state().models;
    let layers = models.column("layer_temperature").unwrap().values;
    let lengths: Vec<usize> = layers.lengths().collect();
    assert!(
        [0, 1, 2].iter().all(|n| lengths.contains(n)),
        "thin ones have no layers, dry ones one, wet ones two: {lengths:?}"
    );
    let ages = models.column("age").unwrap().values;
    let oldest = (0..ages.rows()).flat_map(|row| ages.counts(row)).max();
    // Those of the start are gone; those that are there came in later.
    assert!(oldest.is_some_and(|age| (1..whole.windows()).contains(age)));

    let (case, windows) = (whole.case().clone(), whole.windows());
    drop(whole);

    // The results have what is shown, and not what is private.
    let file = hdf5::File::open(one.join("results.h5")).unwrap();
    let group = file.group("snapshots/0002/particles").unwrap();
    let names = group.member_names().unwrap();
    let has = |name: &str| names.iter().any(|one| one == name);
    assert!(has("layer_temperature") && has("layer_temperature.lengths") && has("surface_water"));
    assert!(!has("age") && !has("bound_water"));
    let shown = arrays(&one.join("particles/particles_0002.vtp")).unwrap();
    assert_eq!(shown["layer_temperature"].components, 2);

    let resumed = to_the_end(&other, 17, true);
    assert_eq!(resumed.windows(), windows);
    drop(resumed);
    let differences = results_equal::differences(&one, &other);
    assert!(differences.is_empty(), "{differences:?}");
    let state = |of: &Path| std::fs::read(of.join("checkpoint/coordinator.state")).unwrap();
    assert_eq!(state(&one), state(&other), "columns of the last checkpoint");

    // A comparison sees the columns by their names.
    let runs = [("whole".to_owned(), one), ("resumed".to_owned(), other)];
    let comparison = compare::compare(&case, &runs).unwrap();
    let field = |name: &str| {
        let found = comparison.fields.iter().find(|one| one.name == name);
        found.unwrap().worst().unwrap().maximum
    };
    assert_eq!(field("particles.layer_temperature"), 0.0);
    assert_eq!(field("particles.surface_water"), 0.0);
}

#[test]
fn another_run_continues_from_its_columns() {
    let folder = tempfile::tempdir().unwrap();
    // The same particles where they are and as large as they are: none move, shrink, come or go.
    let text = std::fs::read_to_string(case()).unwrap();
    let (start, end) = (
        text.find("[[walls]]").unwrap(),
        text.find("[gas]\n").unwrap(),
    );
    let feeds = text.find("[[feeds]]").unwrap()..text.find("[laws]").unwrap();
    let mut frozen = text.clone();
    frozen.replace_range(feeds, "");
    frozen.replace_range(start..end, "");
    let frozen = frozen.replace("\"free\"", "\"frozen\"");
    let path = folder.path().join("frozen.toml");
    std::fs::write(&path, frozen).unwrap();
    let open = |name: &str, end: &str| {
        Simulation::open(&path)
            .out(folder.path().join(name))
            .set(format!("time.end={end}"))
            .model("wet", |case| granules(case, false))
    };
    let mut first = open("first", "4 s").start().unwrap();
    first.finish().unwrap();
    let column = |of: &Simulation, name: &str| of.state().models.column(name).unwrap();
    let next = open("next", "8 s")
        .from(folder.path().join("first"))
        .start()
        .unwrap();
    assert_eq!(next.windows(), 0);
    for name in ["temperature", "layer_temperature", "surface_water", "age"] {
        assert_eq!(column(&first, name), column(&next, name), "{name}");
    }
    let ages = column(&next, "age").values;
    assert_eq!(ages.counts(ages.rows() - 1), [first.windows()]);
}

#[test]
fn the_same_model_beside_liggghts_on_two_ranks() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, ranks: Option<u32>| {
        let out = folder.path().join(name);
        let mut builder = moving(&out).set("time.end=8 s");
        if let Some(ranks) = ranks {
            let mut starts = SolverStarts::default();
            starts.particles.ranks = ranks;
            builder = builder
                .particles(ParticleBackend::Liggghts)
                .starts(starts, "shared-memory");
        }
        let mut simulation = builder.start().unwrap();
        simulation.finish().unwrap();
        closes(&Summary::read(&out).unwrap());
        let water = simulation.state().models.column("bound_water").unwrap();
        let granules = (0..water.values.rows()).flat_map(|row| water.values.reals(row).to_vec());
        granules.collect::<Vec<f64>>()
    };
    let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len() as f64;
    let (own, other) = (run("native", None), run("two ranks", Some(2)));
    let (own, other) = (mean(&own), mean(&other));
    println!("bound water: {own:.4e} {other:.4e} kg");
    // Contacts differ, and with them where granules lie in the gas.
    assert!((own / other - 1.0).abs() < 0.02, "{own} {other}");
}
