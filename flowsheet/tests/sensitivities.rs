//! How plants depend on parameters, and parameters from measured distributions (docs/theory.md, FLS-7).

use calcine_flowsheet::distribution::normal_shares;
use calcine_flowsheet::units::{BedLevel, Bunker, Discharge, PlantInlet, PlantOutlet};
use calcine_flowsheet::{
    Connection, Integrator, MeasuredDistribution, MeasuredPlace, MeasuredState, Plant,
    PlantEstimation, PlantFamily, PlantResiduals, PlantRun, ProcessUnit, SizeGrid, Timetable,
};

use crate::growth::tank;
use crate::plants::oscillating;
use crate::support::{plain, solids};

/// A store that empties by its residence time, fed with 2 kg/s.
fn store(time: f64, start: f64) -> Plant {
    let layout = plain(SizeGrid::uniform(4, 0.0, 4e-3).unwrap());
    let content = solids(&layout, &[0.0, 1.0, 0.0, 0.0], start);
    let feed = solids(&layout, &[0.0, 1.0, 0.0, 0.0], 2.0);
    let discharge = Discharge::Residence(time);
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        (
            "feed".into(),
            Box::new(PlantInlet::new(feed, Timetable::constant(1.0))),
        ),
        ("store".into(), Box::new(Bunker { content, discharge })),
        ("product".into(), Box::new(PlantOutlet)),
    ];
    let streams = [
        Connection::new("feed", ("feed", "out"), ("store", "in")),
        Connection::new("product", ("store", "out"), ("product", "in")),
    ];
    Plant::new(layout, units, &streams).unwrap()
}

/// m = F τ + (m₀ − F τ) e^(−t/τ): derivatives by τ and by m₀, at two times and at rest.
#[test]
fn a_stores_derivatives_are_those_of_its_closed_form() {
    let family = PlantFamily::new(|p: &[f64]| Ok(store(p[0], p[1])), vec![2e-3, 1e-3]).unwrap();
    let (tau, start, feed) = (20.0, 10.0, 2.0);
    let times = [15.0, 40.0];
    let found = family
        .observe_run(
            &[tau, start],
            Integrator::Explicit,
            1e-9,
            &times,
            |_, run| vec![run.unit(1)[1]],
        )
        .unwrap();
    for (k, t) in times.iter().enumerate() {
        let fade = f64::exp(-t / tau);
        let by_time = feed * (1.0 - fade) + (start - feed * tau) * fade * t / (tau * tau);
        for (column, expected) in found.columns.iter().zip([by_time, fade]) {
            assert!(
                (column[k] / expected - 1.0).abs() < 1e-6,
                "{} {expected}",
                column[k]
            );
        }
    }
    let guess = store(tau, start).start();
    let (_, steady) = family.steady(&[tau, start], &guess, 0.0).unwrap();
    assert!((steady.columns[0][1] / feed - 1.0).abs() < 1e-6);
    assert!(steady.columns[1][1].abs() < 1e-9);
}

/// Of the plant that oscillates at a slope of 8, whose hold-up is fixed: by the spray and by the slope, against differences of two
/// steady states.
#[test]
fn a_steady_states_derivatives_are_those_of_steady_states() {
    let make = |p: &[f64]| Ok(oscillating(60, p[1], Timetable::constant(p[0]), |bed| bed));
    let family = PlantFamily::new(make, vec![1e-4, 1e-3]).unwrap();
    let at = [1.0, 8.0];
    let mut guess = make(&at).unwrap().start();
    for slope in [4.0, 6.0] {
        guess = make(&[1.0, slope])
            .unwrap()
            .steady(&guess, 0.0)
            .unwrap()
            .unknowns;
    }
    let (state, found) = family.steady(&at, &guess, 0.0).unwrap();
    for (k, step) in [1e-4, 1e-3].into_iter().enumerate() {
        let side = |sign: f64| {
            let mut place = at;
            place[k] += sign * step;
            make(&place)
                .unwrap()
                .steady(&state.unknowns, 0.0)
                .unwrap()
                .unknowns
        };
        let (above, below) = (side(1.0), side(-1.0));
        let size = found.columns[k].iter().fold(0.0f64, |a, s| a.max(s.abs()));
        let mut worst = 0.0f64;
        for (slope, (a, b)) in found.columns[k].iter().zip(above.iter().zip(&below)) {
            worst = worst.max((slope - (a - b) / (2.0 * step)).abs());
        }
        println!("parameter {k}: largest derivative {size:e}, apart {worst:e}");
        // With all flows the same share of the hold-up, the spray alone changes nothing but the speed.
        assert!(worst < 1e-4 * size.max(1e-3), "{worst:e} {size:e}");
    }
}

/// A granulator in which the spray, the residence time and the mean of the nuclei are asked for.
fn granulator(p: &[f64]) -> Plant {
    let grid = SizeGrid::uniform(80, 0.0, 4e-3).unwrap();
    let feed = normal_shares(&grid, 1e-3 * p[2], 2e-4, "feed").unwrap();
    let content = normal_shares(&grid, 1e-3, 2e-4, "bed").unwrap();
    let content = content.iter().map(|share| 100.0 * share).collect();
    let level = |time| {
        move |bed: calcine_flowsheet::units::Granulator| bed.with_level(BedLevel::Residence(time))
    };
    tank(grid, &feed, p[0], level(p[1]), content)
}

/// Gauss–Newton from sieve analyses that the plant itself made: it finds the parameters again.
#[test]
fn parameters_come_back_from_distributions_of_a_twin() {
    let truth = [0.5, 100.0, 1.0];
    let plant = granulator(&truth);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    let edges: Vec<f64> = (0..=16).map(|k| 0.25e-3 * f64::from(k)).collect();
    let mut measured = Vec::new();
    for time in [60.0, 200.0] {
        run.advance(time).unwrap();
        let masses = run.unit(plant.unit("bed").unwrap());
        // 80 classes of 50 µm: five between two sieves.
        let shares = masses
            .chunks_exact(5)
            .map(|own| own.iter().sum::<f64>() / masses.iter().sum::<f64>());
        measured.push(MeasuredDistribution {
            place: MeasuredPlace::Unit("bed".into()),
            time,
            edges: edges.clone(),
            shares: shares.map(|share| share.clamp(0.0, 1.0)).collect(),
            deviation: 0.01,
        });
    }
    let family = PlantFamily::new(|p: &[f64]| Ok(granulator(p)), vec![1e-4, 1e-2, 1e-4]).unwrap();
    let state = MeasuredState::Run {
        integrator: Integrator::Explicit,
        tolerance: 1e-9,
    };
    let estimation = PlantEstimation::new(family, measured, state).unwrap();
    let mut at = vec![0.4, 120.0, 1.05];
    for round in 0..8 {
        let found = estimation.jacobian(&at).unwrap();
        let (rows, columns) = (found.values.len(), found.columns.len());
        let matrix =
            nalgebra::DMatrix::from_fn(rows, columns, |row, column| found.columns[column][row]);
        let right = nalgebra::DVector::from_vec(found.values.clone());
        let step = (matrix.transpose() * &matrix)
            .lu()
            .solve(&(matrix.transpose() * right))
            .unwrap();
        at.iter_mut().zip(step.iter()).for_each(|(p, s)| *p -= s);
        println!("{round}: {at:?}");
    }
    for (found, truth) in at.iter().zip(truth) {
        assert!((found / truth - 1.0).abs() < 1e-6, "{found} {truth}");
    }
    let left = estimation.residuals(&at).unwrap();
    assert_eq!(left.len(), 32);
    assert!(left.iter().all(|r| r.abs() < 1e-5));
}

#[test]
fn measured_distributions_that_are_none_are_refused() {
    let good = MeasuredDistribution {
        place: MeasuredPlace::Stream("product".into()),
        time: 0.0,
        edges: vec![0.0, 1e-3, 2e-3],
        shares: vec![0.4, 0.6],
        deviation: 0.01,
    };
    let made = |measured: MeasuredDistribution| {
        let family = PlantFamily::new(|p: &[f64]| Ok(granulator(p)), vec![1e-4; 3]).unwrap();
        let state = MeasuredState::Run {
            integrator: Integrator::Explicit,
            tolerance: 1e-6,
        };
        PlantEstimation::new(family, vec![measured], state)
    };
    assert!(made(good.clone()).is_ok());
    for bad in [
        MeasuredDistribution {
            edges: vec![0.0, 2e-3, 1e-3],
            ..good.clone()
        },
        MeasuredDistribution {
            shares: vec![0.4],
            ..good.clone()
        },
        MeasuredDistribution {
            shares: vec![f64::NAN, 0.5],
            ..good.clone()
        },
        MeasuredDistribution {
            deviation: 0.0,
            ..good.clone()
        },
    ] {
        assert!(made(bad).is_err());
    }
    let place = MeasuredPlace::Stream("nowhere".into());
    let told = made(MeasuredDistribution { place, ..good })
        .unwrap()
        .residuals(&[0.5, 100.0, 1.0]);
    assert!(told.unwrap_err().to_string().contains("nowhere"));
}
