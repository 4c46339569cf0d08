//! Monolithic recycles and waveform relaxation against each other (docs/theory.md, FLS-1, FLS-4).

use calcine_flowsheet::{Integrator, PlantRun, TearAcceleration, WaveformSettings};

use crate::granulation::plant;

#[test]
fn both_methods_of_recycles_agree_and_close() {
    let plant = plant(60, 1.0);
    let (tolerance, end) = (1e-8, 200.0);
    let mut whole = PlantRun::new(&plant, Integrator::Explicit, tolerance).unwrap();
    whole.advance(end).unwrap();
    for acceleration in [TearAcceleration::Anderson, TearAcceleration::Wegstein(-0.5)] {
        let settings = WaveformSettings {
            acceleration,
            ..WaveformSettings::default()
        };
        let mut run = PlantRun::new(&plant, Integrator::Explicit, tolerance).unwrap();
        run.advance_by_windows(end, &settings).unwrap();
        let pairs = run.unknowns().iter().zip(whole.unknowns());
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let ledger = run.ledger();
        println!(
            "{acceleration:?}: apart {apart:e} kg of 20, closure {:e}, ledger {:e}, rounds {} of {}, next window {} s",
            ledger.closure(),
            ledger.worst(),
            run.rounds(),
            whole.rounds(),
            run.checkpoint().window,
        );
        assert!(apart / 20.0 < 1e-6);
        assert!(ledger.closure() <= 1e-12);
    }
}

/// The first window, too, where its iterations are neither few nor many.
#[test]
fn a_window_of_neither_few_nor_many_iterations_is_followed_by_one_of_its_length() {
    let plant = plant(40, 1.0);
    let settings = WaveformSettings {
        first: 1e-3,
        few: 1,
        many: 400,
        ..WaveformSettings::default()
    };
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-7).unwrap();
    run.advance_by_windows(0.01, &settings).unwrap();
    assert_eq!(run.checkpoint().window, 1e-3);
    assert!(run.ledger().closure() <= 1e-12);
}

/// What a checkpoint holds decides all that follows.
#[test]
fn a_resumed_window_has_the_same_bits() {
    let plant = plant(40, 1.0);
    let settings = WaveformSettings::default();
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-7).unwrap();
    run.advance_by_windows(20.0, &settings).unwrap();
    let saved = run.checkpoint();
    run.advance_by_windows(40.0, &settings).unwrap();
    let mut other = PlantRun::new(&plant, Integrator::Explicit, 1e-7).unwrap();
    other.resume(saved);
    other.advance_by_windows(40.0, &settings).unwrap();
    assert_eq!(run.checkpoint(), other.checkpoint());
}

/// The same of a run by stabilised steps, whose number of stages is found anew.
#[test]
fn a_resumed_stabilised_run_has_the_same_bits() {
    let plant = plant(40, 1.0);
    let mut run = PlantRun::new(&plant, Integrator::Stabilised, 1e-4).unwrap();
    run.advance(300.0).unwrap();
    let saved = run.checkpoint();
    run.advance(900.0).unwrap();
    assert!(run.ledger().closure() <= 1e-12 && run.ledger().worst() < 1e-11);
    let mut other = PlantRun::new(&plant, Integrator::Stabilised, 1e-4).unwrap();
    other.resume(saved);
    other.advance(900.0).unwrap();
    assert_eq!(run.checkpoint(), other.checkpoint());
}
