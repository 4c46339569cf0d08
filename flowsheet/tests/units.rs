//! Units alone, against closed forms (docs/theory.md, FLS-3, FLS-6, PBM-4).

use calcine_flowsheet::distribution::normal_shares;
use calcine_flowsheet::mill::{BondBimodal, BondLaw, BondLength};
use calcine_flowsheet::population::{Aggregation, ConstantKernel};
use calcine_flowsheet::units::{
    BedHeat, BedLevel, Bunker, Discharge, Dryer, Granulator, Mill, Overspray, PlantInlet,
    PlantOutlet, Splitter, TimeDelay,
};
use calcine_flowsheet::{
    Attribute, Connection, Integrator, Plant, PlantRun, ProcessUnit, SizeGrid, StreamLayout,
    Timetable,
};

use crate::support::{air, plain, solid, solids, water};

/// One unit between inlets and outlets, which are named as its ports.
fn alone(layout: StreamLayout, unit: impl ProcessUnit + 'static, feeds: Vec<PlantInlet>) -> Plant {
    let (inlets, outlets) = (unit.inlets(), unit.outlets());
    let mut units: Vec<(String, Box<dyn ProcessUnit>)> = vec![("unit".into(), Box::new(unit))];
    let mut streams = Vec::new();
    for (port, feed) in inlets.iter().zip(feeds) {
        let name = format!("inlet {port}");
        streams.push(Connection::new(port, (&name, "out"), ("unit", port)));
        units.push((name, Box::new(feed)));
    }
    for port in &outlets {
        let name = format!("outlet {port}");
        streams.push(Connection::new(port, ("unit", port), (&name, "in")));
        units.push((name, Box::new(PlantOutlet)));
    }
    Plant::new(layout, units, &streams).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

fn always(stream: Vec<f64>) -> PlantInlet {
    PlantInlet::new(stream, Timetable::constant(1.0))
}

fn flow(plant: &Plant, run: &PlantRun<'_>, name: &str) -> Vec<f64> {
    run.stream(plant.stream(name).unwrap()).to_vec()
}

/// m = F τ + (m₀ − F τ) exp(−t/τ), through a step of the feed.
#[test]
fn a_bunker_empties_by_its_residence_time() {
    let layout = plain(SizeGrid::uniform(4, 0.0, 4e-3).unwrap());
    let content = solids(&layout, &[0.0, 1.0, 0.0, 0.0], 10.0);
    let feed = solids(&layout, &[0.0, 0.0, 1.0, 0.0], 1.0);
    let steps = Timetable::new(vec![(0.0, 0.5), (50.0, 2.0)], false, "feed").unwrap();
    let bunker = Bunker {
        content,
        discharge: Discharge::Residence(20.0),
    };
    let plant = alone(layout, bunker, vec![PlantInlet::new(feed, steps)]);
    let after = |from: f64, flow: f64| flow * 20.0 + (from - flow * 20.0) * (-2.5f64).exp();
    let expected = after(after(10.0, 0.5), 2.0);
    for integrator in [Integrator::Explicit, Integrator::Stiff] {
        let mut run = PlantRun::new(&plant, integrator, 1e-10).unwrap();
        run.advance(100.0).unwrap();
        let found = plant.layout().mass_flow(run.unit(0));
        assert!(
            (found / expected - 1.0).abs() < 1e-8,
            "{integrator:?}: {found} {expected}"
        );
        assert!(run.ledger().worst() < 1e-12, "{:?}", run.ledger());
    }
    // Of second order an error of a step is as its third power, what a run sums of them as the tolerance to two thirds.
    let [rough, fine] = [1e-5, 1e-8].map(|tolerance| {
        let mut run = PlantRun::new(&plant, Integrator::Stabilised, tolerance).unwrap();
        run.advance(100.0).unwrap();
        assert!(run.ledger().worst() < 1e-12, "{:?}", run.ledger());
        (plant.layout().mass_flow(run.unit(0)) / expected - 1.0).abs()
    });
    println!("stabilised: {rough:e}, {fine:e}");
    assert!(rough < 2e-4 && (50.0..200.0).contains(&(rough / fine)));
}

/// A bunker with a rate holds the integral of feed less rate, and one that is level keeps its mass.
#[test]
fn a_bunker_follows_its_rate_or_stays_level() {
    let layout = plain(SizeGrid::uniform(4, 0.0, 4e-3).unwrap());
    let content = solids(&layout, &[0.0, 1.0, 0.0, 0.0], 100.0);
    let feed = solids(&layout, &[0.0, 0.0, 1.0, 0.0], 2.0);
    let rate = Timetable::new(vec![(0.0, 0.0), (30.0, 5.0)], false, "rate").unwrap();
    let bunker = Bunker {
        content: content.clone(),
        discharge: Discharge::Rate(rate),
    };
    let plant = alone(layout.clone(), bunker, vec![always(feed.clone())]);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    run.advance(60.0).unwrap();
    let found = plant.layout().mass_flow(run.unit(0));
    assert!((found - (100.0 + 120.0 - 150.0)).abs() < 1e-9, "{found}");
    // It is empty after 83.3 s; what is not there cannot be moved.
    assert!(run.advance(100.0).is_err());

    let plant = alone(
        layout,
        Bunker {
            content,
            discharge: Discharge::Level,
        },
        vec![always(feed)],
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    run.advance(60.0).unwrap();
    let found = plant.layout().mass_flow(run.unit(0));
    assert!((found - 100.0).abs() < 1e-9, "{found}");
    let old = run.unit(0)[1] / 100.0;
    assert!((old - (-1.2f64).exp()).abs() < 1e-8, "{old}");
}

/// A step of the feed comes out as 1 − exp(−x) Σ xᵏ/k!, x = n t/τ (Erlang), and nothing of it is lost on the way.
#[test]
fn a_delay_passes_a_step_on_after_its_time() {
    let layout = plain(SizeGrid::uniform(4, 0.0, 4e-3).unwrap());
    let feed = solids(&layout, &[0.0, 0.25, 0.75, 0.0], 2.0);
    let delay = TimeDelay {
        time: 60.0,
        stages: 12,
        content: Vec::new(),
    };
    let plant = alone(layout, delay, vec![always(feed)]);
    for time in [30.0, 60.0, 90.0] {
        let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-10).unwrap();
        run.advance(time).unwrap();
        let x = 12.0 * time / 60.0;
        let terms = (0..12).scan(1.0, |term, k| {
            let own = *term;
            *term *= x / f64::from(k + 1);
            Some(own)
        });
        let expected = 2.0 * (1.0 - f64::exp(-x) * terms.sum::<f64>());
        let out = flow(&plant, &run, "out");
        let found = plant.layout().mass_flow(&out);
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
        assert!((out[2] / out[1] - 3.0).abs() < 1e-12);
        assert!(run.ledger().worst() < 1e-13);
    }
}

#[test]
fn a_splitter_divides_everything_alike() {
    let layout = plain(SizeGrid::uniform(4, 0.0, 4e-3).unwrap());
    let feed = solids(&layout, &[0.1, 0.2, 0.3, 0.4], 2.0);
    let splitter = Splitter::new(vec![0.75, 0.25]);
    let plant = alone(layout, splitter, vec![always(feed.clone())]);
    let run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    for (part, whole) in flow(&plant, &run, "out1").iter().zip(&feed) {
        assert_eq!(*part, 0.75 * whole);
    }
}

/// 1 kg/s of solids with 0.2 kg/s of water, dried to 5 % by 5 kg/s of air of 450 K: both leave at the temperature that closes
/// the enthalpy.
#[test]
fn a_dryer_closes_its_enthalpy() {
    let grid = SizeGrid::uniform(4, 0.0, 4e-3).unwrap();
    let kinds = vec![solid("urea"), water(), air()];
    let layout = StreamLayout::new(grid, Vec::new(), kinds).unwrap();
    let mut feed = vec![0.0; layout.width()];
    feed[3] = 1.0;
    feed[layout.liquid(1)] = 0.2;
    layout.set_temperature(&mut feed, 300.0);
    let mut gas = vec![0.0; layout.width()];
    gas[layout.vapour(2)] = 5.0;
    layout.set_temperature(&mut gas, 450.0);
    let plant = alone(
        layout.clone(),
        Dryer { moisture: 0.05 },
        vec![always(feed), always(gas)],
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    run.advance(10.0).unwrap();
    let (dried, exhaust) = (flow(&plant, &run, "out"), flow(&plant, &run, "exhaust"));
    assert!((dried[layout.liquid(1)] - 0.05).abs() < 1e-15);
    assert!((exhaust[layout.vapour(1)] - 0.15).abs() < 1e-15);
    // (1500 + 840) · 26.85 + 5030 · 176.85 − 375000 over 1500 + 210 + 285 + 5030, above 273.15 K.
    let expected = 273.15 + (2340.0 * 26.85 + 5030.0 * 176.85 - 375e3) / 7025.0;
    for stream in [&dried, &exhaust] {
        let found = layout.temperature(stream).unwrap();
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    assert!(run.ledger().worst() < 1e-13);
}

/// With `balanced` heat the bed cools towards the temperature at which everything leaves that enters.
#[test]
fn a_bed_that_is_not_held_finds_its_temperature() {
    let grid = SizeGrid::uniform(40, 0.0, 4e-3).unwrap();
    let kinds = vec![solid("urea"), water(), air()];
    let layout = StreamLayout::new(grid.clone(), Vec::new(), kinds).unwrap();
    let shares = normal_shares(&grid, 2e-3, 2e-4, "bed").unwrap();
    let mut content = vec![0.0; layout.solids()];
    for (class, share) in shares.iter().enumerate() {
        content[class * 3] = 10.0 * share;
    }
    let feed = solids(&layout, &shares, 0.1);
    let mut spray = vec![0.0; layout.width()];
    spray[layout.liquid(0)] = 0.01;
    spray[layout.liquid(1)] = 0.02;
    layout.set_temperature(&mut spray, 320.0);
    let mut gas = vec![0.0; layout.width()];
    gas[layout.vapour(2)] = 1.0;
    layout.set_temperature(&mut gas, 400.0);
    let bed = Granulator::new(content, 1320.0)
        .with_moisture(0.02)
        .with_heat(BedHeat::Balanced(300.0));
    let entering: f64 = [&feed, &spray, &gas]
        .iter()
        .map(|s| s[layout.enthalpy()])
        .sum();
    let plant = alone(
        layout.clone(),
        bed,
        vec![always(feed), always(spray), always(gas)],
    );
    let mut run = PlantRun::new(&plant, Integrator::Stiff, 1e-8).unwrap();
    run.advance(1000.0).unwrap();
    let (product, exhaust) = (flow(&plant, &run, "product"), flow(&plant, &run, "exhaust"));
    let leaving = product[layout.enthalpy()] + exhaust[layout.enthalpy()];
    assert!(
        (leaving / entering - 1.0).abs() < 1e-6,
        "{leaving} {entering}"
    );
    let temperature = layout.temperature(&exhaust).unwrap();
    assert!((280.0..400.0).contains(&temperature), "{temperature}");
    let worst = run.ledger();
    assert!(worst.worst() < 1e-12, "{:#?}", worst.lines);
}

/// Of 0.1 kg/s sprayed 30 % become dust, of which 40 % stay as nuclei of 0.15 mm.
#[test]
fn overspray_leaves_or_becomes_nuclei() {
    let grid = SizeGrid::uniform(600, 0.0, 4e-3).unwrap();
    let layout = plain(grid.clone());
    let shares = normal_shares(&grid, 2e-3, 2e-4, "bed").unwrap();
    let content: Vec<f64> = shares.iter().map(|share| 10.0 * share).collect();
    let mut sizes = vec![0.0; 600];
    sizes[22] = 1.0;
    let bed = Granulator::new(content, 1320.0).with_overspray(Overspray {
        share: 0.3,
        returned: 0.4,
        sizes,
    });
    let none = vec![0.0; layout.width()];
    let mut spray = none.clone();
    spray[layout.liquid(0)] = 0.1;
    let feeds = vec![always(none.clone()), always(spray), always(none)];
    let plant = alone(layout.clone(), bed, feeds);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    assert!((flow(&plant, &run, "exhaust")[22] - 0.3 * 0.6 * 0.1).abs() < 1e-16);
    let product = layout.solid_flow(&flow(&plant, &run, "product"));
    assert!((product - (0.07 + 0.012)).abs() < 1e-15, "{product}");
    run.advance(5.0).unwrap();
    // Nuclei of 5 s, which all grow on: their number, less what leaves with the product, and their mass by characteristics.
    let small = &run.unit(0)[..120];
    let particle = |d: f64| 1320.0 * std::f64::consts::PI / 6.0 * d.powi(3);
    let pairs = small.iter().zip(grid.diameters());
    let number: f64 = pairs.map(|(mass, d)| mass / particle(*d)).sum();
    let leaves = 0.082 / 10.0;
    let born = 0.012 / particle(0.15e-3);
    let expected = born * (1.0 - (-5.0f64 * leaves).exp()) / leaves;
    assert!((number / expected - 1.0).abs() < 1e-6, "{number}");
    let mass: f64 = small.iter().sum();
    println!("nuclei: {mass} kg of 0.0730");
    assert!((mass / 0.0730 - 1.0).abs() < 0.03, "{mass}");
    assert!(run.ledger().worst() < 1e-13);
}

/// A controller in proportion brings the mass to its set point with its time.
#[test]
fn a_controlled_bed_goes_to_its_set_point() {
    let layout = plain(SizeGrid::uniform(4, 0.0, 4e-3).unwrap());
    let feed = solids(&layout, &[0.0, 1.0, 0.0, 0.0], 1.0);
    let none = vec![0.0; layout.width()];
    let bed = Granulator::new(vec![0.0, 30.0, 0.0, 0.0], 1320.0).with_level(BedLevel::Controlled {
        mass: 20.0,
        time: 50.0,
    });
    let plant = alone(
        layout,
        bed,
        vec![always(feed), always(none.clone()), always(none)],
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    run.advance(100.0).unwrap();
    let found: f64 = run.unit(0).iter().sum();
    let expected = 20.0 + 10.0 * (-2.0f64).exp();
    assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
}

/// A bed that keeps moisture, and whose mass changes by dust that returns and by wear, closes its water.
#[test]
fn a_moist_bed_that_makes_dust_closes_its_water() {
    let grid = SizeGrid::uniform(40, 0.0, 4e-3).unwrap();
    let layout = StreamLayout::new(grid.clone(), Vec::new(), vec![solid("urea"), water()]).unwrap();
    let shares = normal_shares(&grid, 2e-3, 2e-4, "bed").unwrap();
    let mut content = vec![0.0; layout.solids()];
    for (class, share) in shares.iter().enumerate() {
        content[class * layout.inner()] = 10.0 * share;
    }
    let mut sizes = vec![0.0; 40];
    sizes[1] = 1.0;
    let bed = Granulator::new(content, 1320.0)
        .with_moisture(0.01)
        .with_wear(1e-8)
        .with_level(BedLevel::Controlled {
            mass: 12.0,
            time: 50.0,
        })
        .with_overspray(Overspray {
            share: 0.3,
            returned: 0.4,
            sizes,
        });
    let none = vec![0.0; layout.width()];
    let mut spray = none.clone();
    spray[layout.liquid(0)] = 0.1;
    spray[layout.liquid(1)] = 0.1;
    layout.set_temperature(&mut spray, 300.0);
    let feeds = vec![always(none.clone()), always(spray), always(none)];
    let plant = alone(layout, bed, feeds);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    run.advance(20.0).unwrap();
    let ledger = run.ledger();
    assert!(ledger.worst() < 1e-12, "{:#?}", ledger.lines);
}

/// Growth and aggregation leave each colour's mass where its particles are: what is sprayed falls on both alike by number.
#[test]
fn colours_stay_with_their_particles_in_a_granulator() {
    let grid = SizeGrid::uniform(60, 0.0, 6e-3).unwrap();
    let colour = Attribute {
        name: "colour".into(),
        classes: 2,
    };
    let layout = StreamLayout::new(grid.clone(), vec![colour], vec![solid("urea")]).unwrap();
    let mut content = vec![0.0; layout.solids()];
    for (colour, mean) in [(0, 4e-3), (1, 1e-3)] {
        let shares = normal_shares(&grid, mean, 1e-4, "bed").unwrap();
        for (class, share) in shares.iter().enumerate() {
            content[class * 2 + colour] = 5.0 * share;
        }
    }
    let none = vec![0.0; layout.width()];
    let mut spray = none.clone();
    spray[layout.liquid(0)] = 0.02;
    let still = BedLevel::Residence(1e300);
    let bed = Granulator::new(content.clone(), 1320.0).with_level(still);
    let feeds = || {
        vec![
            always(none.clone()),
            always(spray.clone()),
            always(none.clone()),
        ]
    };
    let plant = alone(layout.clone(), bed, feeds());
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    run.advance(100.0).unwrap();
    let sum = |masses: &[f64], colour: usize, classes: std::ops::Range<usize>| -> f64 {
        classes.map(|class| masses[class * 2 + colour]).sum()
    };
    let masses = run.unit(0);
    // Red stays above 2 mm and blue below; together they have the spray.
    assert!(sum(masses, 0, 0..25) < 1e-12);
    assert!(sum(masses, 1, 30..60) < 1e-6);
    assert!((masses.iter().sum::<f64>() - 12.0).abs() < 1e-11);
    let [red, blue] = [sum(masses, 0, 0..60), sum(masses, 1, 0..60)];
    // Areas are as 1/d: blue gets about four fifths.
    assert!((blue - 5.0) / (red - 5.0) > 3.0, "{red} {blue}");

    let kernel = Aggregation::new(Box::new(ConstantKernel { rate: 1e-9 }));
    let bed = Granulator::new(content, 1320.0)
        .with_level(still)
        .with_process(Box::new(kernel));
    let plant = alone(
        layout,
        bed,
        vec![always(none.clone()), always(none.clone()), always(none)],
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    run.advance(100.0).unwrap();
    for colour in [0, 1] {
        let found = sum(run.unit(0), colour, 0..60);
        assert!((found - 5.0).abs() < 1e-12, "{found}");
    }
}

/// Particles break in two until the product has the x₈₀ of Bond's law.
#[test]
fn a_mill_that_breaks_in_two_has_the_size_of_bonds_law() {
    let grid = SizeGrid::uniform(300, 0.0, 30e-3).unwrap();
    let layout = plain(grid.clone());
    let shares = normal_shares(&grid, 20e-3, 2e-3, "feed").unwrap();
    let bond = BondLaw {
        work_index: 36e3,
        power: 3e3,
        length: BondLength::Micrometre,
    };
    let feed = solids(&layout, &shares, 20.0);
    let size =
        |masses: &[f64]| calcine_flowsheet::distribution::quantile(&grid, masses, 0.8).unwrap();
    let expected = bond.product_size(size(&shares), 20.0);
    let mill = Mill::new(Box::new(BondBimodal { bond }));
    let plant = alone(layout.clone(), mill, vec![always(feed)]);
    let run = PlantRun::new(&plant, Integrator::Explicit, 1e-9).unwrap();
    let milled = flow(&plant, &run, "out");
    let found = size(&layout.by_size(&milled));
    println!("x80 {} -> {found}, Bond {expected}", size(&shares));
    assert!((found / expected - 1.0).abs() < 1e-9, "{found} {expected}");
    assert!((layout.solid_flow(&milled) - 20.0).abs() < 1e-12);
}
