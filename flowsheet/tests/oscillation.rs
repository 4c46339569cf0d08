//! A granulation plant that oscillates (docs/theory.md, FLS-V4).

use calcine_flowsheet::distribution::{mean_diameter, normal_shares};
use calcine_flowsheet::mill::ConstantMill;
use calcine_flowsheet::screen::Plitt;
use calcine_flowsheet::units::{Granulator, Mill, Mixer, PlantInlet, PlantOutlet, Screen};
use calcine_flowsheet::{
    Connection, Continuation, Integrator, Plant, PlantRun, ProcessUnit, SizeGrid, SteadyState,
    Timetable,
};

use crate::support::plain;

const CLASSES: usize = 240;

fn plant(sharpness: f64) -> Plant {
    let grid = SizeGrid::uniform(CLASSES, 0.0, 4e-3).unwrap();
    let layout = plain(grid.clone());
    let mut spray = vec![0.0; layout.width()];
    spray[layout.liquid(0)] = 0.05;
    layout.set_temperature(&mut spray, 300.0);
    let shares = normal_shares(&grid, 1.8e-3, 2.5e-4, "test").unwrap();
    let content = shares.iter().map(|share| 20.0 * share).collect();
    let none = vec![0.0; layout.width()];
    let inlet = |stream| -> Box<dyn ProcessUnit> {
        Box::new(PlantInlet::new(stream, Timetable::constant(1.0)))
    };
    let screen =
        |cut| -> Box<dyn ProcessUnit> { Box::new(Screen::new(Box::new(Plitt { cut, sharpness }))) };
    let mill = ConstantMill::new(1e-3, 1e-4);
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        ("spray".into(), inlet(spray)),
        ("gas".into(), inlet(none)),
        (
            "granulator".into(),
            Box::new(Granulator::new(content, 1320.0)),
        ),
        ("coarse screen".into(), screen(2.2e-3)),
        ("fine screen".into(), screen(1.8e-3)),
        ("mill".into(), Box::new(Mill::new(Box::new(mill)))),
        ("recycle".into(), Box::new(Mixer { inlets: 2 })),
        ("exhaust".into(), Box::new(PlantOutlet)),
        ("product".into(), Box::new(PlantOutlet)),
    ];
    let streams = [
        Connection::new("spray", ("spray", "out"), ("granulator", "spray")),
        Connection::new("gas", ("gas", "out"), ("granulator", "gas")),
        Connection::new("recycle", ("recycle", "out"), ("granulator", "feed")),
        Connection::new(
            "discharge",
            ("granulator", "product"),
            ("coarse screen", "in"),
        ),
        Connection::new("exhaust", ("granulator", "exhaust"), ("exhaust", "in")),
        Connection::new("oversize", ("coarse screen", "coarse"), ("mill", "in")),
        Connection::new("middle", ("coarse screen", "fine"), ("fine screen", "in")),
        Connection::new("product", ("fine screen", "coarse"), ("product", "in")),
        Connection::new("fines", ("fine screen", "fine"), ("recycle", "in1")),
        Connection::new("milled", ("mill", "out"), ("recycle", "in2")),
    ];
    Plant::new(layout, units, &streams).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

/// The steady state of a slope, by continuation from a flat one.
fn steady(sharpness: f64) -> (Plant, SteadyState) {
    let mut guess = plant(4.0).start();
    for step in [4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 17.0, 20.0] {
        if step >= sharpness {
            break;
        }
        guess = plant(step).steady(&guess, 0.0).unwrap().unknowns;
    }
    let plant = plant(sharpness);
    let found = plant.steady(&guess, 0.0).unwrap();
    (plant, found)
}

/// α = 8 decays at 1.98e-3/s.
#[test]
fn a_flat_screen_damps() {
    let started = std::time::Instant::now();
    let (plant, found) = steady(8.0);
    println!(
        "steady in {:?}, {} iterations, residual {:e}",
        started.elapsed(),
        found.iterations,
        found.residual
    );
    let stability = plant.stability(&found, 0.0).unwrap();
    println!("{:?}", &stability.modes[..4]);
    let rate = stability.growth_rate().unwrap();
    assert!((rate / -1.98e-3 - 1.0).abs() < 0.02, "{rate}");
}

/// The steady state loses its stability at α = 11.72 ± 0.05 with a period of 1116 s.
#[test]
fn stability_is_lost_at_the_critical_slope() {
    let slopes = Continuation::new(|slope| Ok(plant(slope)), 0.0);
    let points = slopes.follow(&[4.0, 6.0, 8.0, 10.0, 11.5, 11.9]).unwrap();
    for point in &points {
        println!(
            "slope {}: growth rate {:e} 1/s, period {} s",
            point.value, point.growth_rate, point.period
        );
    }
    let limits = slopes.limits(&points, 1e-4).unwrap();
    assert_eq!(limits.len(), 1);
    let (slope, period) = (limits[0].value, limits[0].period);
    println!("limit {slope}, period {period} s");
    assert!((slope - 11.72).abs() < 0.05, "{slope}");
    assert!((period / 1116.0 - 1.0).abs() < 5e-3, "{period}");
}

/// α = 20: a limit cycle of the bed's mean of 0.832 mm peak to peak, period 1142 s.
#[test]
fn a_sharp_screen_makes_a_limit_cycle() {
    let plant = plant(20.0);
    let grid = plant.layout().grid().clone();
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-5).unwrap();
    run.advance(30_000.0).unwrap();
    println!("30000 s: steps {:?}, rounds {}", run.steps(), run.rounds());
    let mut means = Vec::new();
    for step in 1..=4000 {
        run.advance(30_000.0 + f64::from(step)).unwrap();
        let masses = run.unit(plant.unit("granulator").unwrap());
        means.push(1e3 * mean_diameter(&grid, masses).unwrap());
    }
    let (least, most) = means
        .iter()
        .fold((f64::MAX, 0.0f64), |(a, b), m| (a.min(*m), b.max(*m)));
    let middle = 0.5 * (least + most);
    let crossings: Vec<f64> = means
        .windows(2)
        .enumerate()
        .filter(|(_, m)| m[0] < middle && m[1] >= middle)
        .map(|(k, m)| k as f64 + (middle - m[0]) / (m[1] - m[0]))
        .collect();
    let period = (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64;
    println!(
        "peak to peak {} mm, period {period} s; {:?}",
        most - least,
        run.steps()
    );
    let ledger = run.ledger();
    println!("closure {:e}, ledger {:e}", ledger.closure, ledger.worst());
    assert!(((most - least) / 0.832 - 1.0).abs() < 0.02);
    assert!((period / 1142.0 - 1.0).abs() < 0.02);
    assert!(ledger.closure <= 1e-12);
}

/// A long run ends where Newton's iteration says, by both integrators, and a run that is resumed has the same bits.
#[test]
fn a_long_run_ends_in_the_steady_state_and_resumes_to_the_same_bits() {
    let (plant, found) = steady(8.0);
    for integrator in [Integrator::Explicit, Integrator::Stiff] {
        // A little off: of the deviation exp(−1.98e-3 · 8000) = 1.3e-7 is left.
        let mut start = found.unknowns.clone();
        for (mass, place) in start.iter_mut().zip(0..) {
            *mass *= 1.0 + 1e-3 * f64::from(place % 7 - 3);
        }
        plant.constrain(&mut start);
        let mut run = PlantRun::from(&plant, start, integrator, 1e-8).unwrap();
        run.advance(4000.0).unwrap();
        let saved = run.checkpoint();
        run.advance(8000.0).unwrap();
        let pairs = run.unknowns().iter().zip(&found.unknowns);
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!(
            "{integrator:?}: apart {apart:e} kg of 20, steps {:?}, {} rounds",
            run.steps(),
            run.rounds()
        );
        assert!(apart / 20.0 < 1e-8, "{apart:e}");
        assert!(run.ledger().worst() < 1e-12);
        let mut other = PlantRun::new(&plant, integrator, 1e-8).unwrap();
        other.resume(saved);
        other.advance(8000.0).unwrap();
        assert_eq!(run.checkpoint(), other.checkpoint());
    }
}
