//! Controllers, and recycles that are torn where they are told.

use std::sync::Arc;

use calcine_flowsheet::units::{
    Bunker, Controller, Discharge, MeasuredField, Mixer, PlantInlet, PlantOutlet, Splitter,
};
use calcine_flowsheet::{
    Connection, Integrator, MeasuredPlace, Plant, PlantRun, ProcessUnit, SizeGrid, StreamLayout,
    Timetable, WaveformSettings,
};

use crate::support::{plain, solids};

fn layout() -> StreamLayout {
    plain(SizeGrid::uniform(2, 0.0, 2e-3).unwrap())
}

fn mass() -> MeasuredField {
    Arc::new(|layout: &StreamLayout, row: &[f64]| layout.mass_flow(row))
}

fn controller(place: MeasuredPlace, gain: f64, bounds: [f64; 2]) -> Controller {
    Controller {
        place,
        field: mass(),
        set_point: 30.0,
        gain,
        integral_time: 200.0,
        filter_time: 1.0,
        start: 0.5,
        bounds,
    }
}

fn far_set_point() -> Plant {
    level_at(60.0, 0.02, [0.0, 0.5], false)
}

fn level(gain: f64, bounds: [f64; 2], disturbed: bool) -> Plant {
    level_at(30.0, gain, bounds, disturbed)
}

/// A bunker of 10 kg whose inlet a controller sets; 0.1 kg/s go in at a factor of 1, and the mass over 100 s goes out.
fn level_at(set_point: f64, gain: f64, bounds: [f64; 2], disturbed: bool) -> Plant {
    let layout = layout();
    let stream = solids(&layout, &[1.0, 0.0], 1.0);
    let points = match disturbed {
        true => vec![(0.0, 1.0), (3000.0, 0.5)],
        false => vec![(0.0, 1.0)],
    };
    let factor = Timetable::new(points, false, "factor").unwrap();
    let inlet = PlantInlet::new(stream, factor).with_controller("level".into());
    let content = solids(&layout, &[1.0, 0.0], 10.0);
    let discharge = Discharge::Residence(100.0);
    let place = MeasuredPlace::Unit("bunker".into());
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        ("in".into(), Box::new(inlet)),
        ("bunker".into(), Box::new(Bunker { content, discharge })),
        ("out".into(), Box::new(PlantOutlet)),
        (
            "level".into(),
            Box::new(Controller {
                set_point,
                ..controller(place, gain, bounds)
            }),
        ),
    ];
    let streams = [
        Connection::new("fed", ("in", "out"), ("bunker", "in")),
        Connection::new("left", ("bunker", "out"), ("out", "in")),
    ];
    Plant::new(layout, units, &streams).unwrap()
}

fn held(run: &PlantRun<'_>, plant: &Plant) -> f64 {
    plant
        .layout()
        .mass_flow(&run.held_by(plant.unit("bunker").unwrap()))
}

/// dm/dt = u − m/100, filter and integral: three linear equations whose matrix exponential is the exact answer.
#[test]
fn a_level_follows_the_exact_answer_of_its_linear_loop_and_comes_back_after_a_disturbance() {
    let plant = level(0.02, [-1e3, 1e3], true);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    let (gain, t, tau, set) = (0.02, 200.0, 1.0, 30.0);
    // Unknowns m, x, I: y' = A y + b.
    let a = nalgebra::Matrix3::new(
        -0.01,
        -gain,
        1.0,
        1.0 / tau,
        -1.0 / tau,
        0.0,
        0.0,
        -gain / t,
        0.0,
    );
    let b = nalgebra::Vector3::new(0.5 + gain * set, 0.0, gain * set / t);
    let start = nalgebra::Vector3::new(10.0, set, 0.0);
    let rest = -a.lu().solve(&b).unwrap();
    for time in [20.0, 100.0, 400.0] {
        run.advance(time).unwrap();
        let exact = rest + (a * time).exp() * (start - rest);
        let found = held(&run, &plant);
        assert!(
            (found - exact[0]).abs() < 1e-5,
            "{time}: {found} {}",
            exact[0]
        );
    }
    run.advance(3000.0).unwrap();
    assert!((held(&run, &plant) - 30.0).abs() < 1e-3);
    run.advance(3100.0).unwrap();
    assert!((held(&run, &plant) - 30.0).abs() > 0.5);
    run.advance(9000.0).unwrap();
    assert!((held(&run, &plant) - 30.0).abs() < 1e-3);
    assert!(run.ledger().worst() < 1e-12);
    let steady = plant.steady(run.unknowns(), 9000.0).unwrap();
    let mass = plant.held_by(1, &steady.unknowns);
    assert!((plant.layout().mass_flow(&mass) - 30.0).abs() < 1e-9);
}

/// At its bound the output gives 50 kg of the 60 kg that are asked for; the integral stays, and does not run away with time.
#[test]
fn an_integral_does_not_wind_up_at_a_bound_and_is_part_of_the_checkpoint() {
    let plant = level(0.02, [0.0, 0.5], false);
    let unit = plant.unit("level").unwrap();
    let far = far_set_point();
    let mut run = PlantRun::new(&far, Integrator::Explicit, 1e-8).unwrap();
    let mut integrals = Vec::new();
    for time in [2000.0, 8000.0] {
        run.advance(time).unwrap();
        integrals.push(run.unit(unit)[1]);
        assert!((held(&run, &far) - 50.0).abs() < 1e-3);
    }
    // v settles where K e/T + (u − v)/T = 0: v = u + K e, so that I = u − u₀ = 0.
    assert!(
        integrals.iter().all(|one| one.abs() < 1e-3),
        "{integrals:?}"
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    run.advance(500.0).unwrap();
    let saved = run.checkpoint();
    run.advance(900.0).unwrap();
    let mut other = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    other.resume(saved);
    other.advance(900.0).unwrap();
    assert_eq!(run.checkpoint(), other.checkpoint());
}

#[test]
fn a_controller_of_what_is_not_there_is_refused_with_what_is() {
    let wrong = |place, bounds| {
        let units: Vec<(String, Box<dyn ProcessUnit>)> =
            vec![("c".into(), Box::new(controller(place, 1.0, bounds)))];
        let wrong = Plant::new(layout(), units, &[]).err().unwrap();
        wrong[0].to_string()
    };
    let told = wrong(MeasuredPlace::Unit("no".into()), [0.0, 1.0]);
    assert!(
        told.contains("no unit is named \"no\"; the units are c"),
        "{told}"
    );
    let told = wrong(MeasuredPlace::Stream("no".into()), [0.0, 1.0]);
    assert!(told.contains("no stream is named \"no\""), "{told}");
    let told = wrong(MeasuredPlace::Unit("c".into()), [0.6, 1.0]);
    assert!(
        told.contains("output at the start is 0.5; it is between the bounds"),
        "{told}"
    );
}

/// Two loops within each other: feed -> a -> b -> split, back to a and to b.
fn loops() -> Plant {
    let layout = layout();
    let stream = solids(&layout, &[0.5, 0.5], 1.0);
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        (
            "in".into(),
            Box::new(PlantInlet::new(stream, Timetable::constant(1.0))),
        ),
        ("a".into(), Box::new(Mixer { inlets: 2 })),
        ("b".into(), Box::new(Mixer { inlets: 2 })),
        ("split".into(), Box::new(Splitter::new(vec![0.5, 0.3, 0.2]))),
        ("out".into(), Box::new(PlantOutlet)),
    ];
    let streams = [
        Connection::new("feed", ("in", "out"), ("a", "in1")),
        Connection::new("on", ("a", "out"), ("b", "in1")),
        Connection::new("all", ("b", "out"), ("split", "in")),
        Connection::new("product", ("split", "out1"), ("out", "in")),
        Connection::new("far", ("split", "out2"), ("a", "in2")),
        Connection::new("near", ("split", "out3"), ("b", "in2")),
    ];
    Plant::new(layout, units, &streams).unwrap()
}

#[test]
fn recycles_are_torn_where_they_are_told_with_the_same_streams() {
    let plant = loops();
    let at = |plant: &Plant| {
        let run = PlantRun::new(plant, Integrator::Explicit, 1e-6).unwrap();
        let ledger = run.ledger();
        assert!(ledger.closure() <= 1e-12);
        let names: Vec<String> = ledger.tears.into_iter().map(|tear| tear.0).collect();
        (
            plant
                .layout()
                .mass_flow(run.stream(plant.stream("all").unwrap())),
            names,
        )
    };
    let (own, _) = at(&plant);
    assert!((own - 2.0).abs() < 1e-11, "{own}");
    let one = loops().torn_at(&["all"]).unwrap();
    let (flow, names) = at(&one);
    assert_eq!(names, ["all"]);
    assert!((flow - 2.0).abs() < 1e-11);
    for (streams, words) in [
        (vec!["far"], "is not opened by the streams that are named"),
        (vec!["all", "feed"], "no recycle needs to be torn there"),
        (vec!["nothing"], "no stream is named \"nothing\""),
    ] {
        let told = loops().torn_at(&streams).err().unwrap().to_string();
        assert!(told.contains(words), "{told}");
    }
    let windows = WaveformSettings::default();
    let mut run = PlantRun::new(&one, Integrator::Explicit, 1e-8).unwrap();
    run.advance_by_windows(10.0, &windows).unwrap();
    assert!(run.ledger().closure() <= 1e-12);
}
