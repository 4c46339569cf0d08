//! Screens, mills and recycles without hold-up (docs/theory.md, FLS-2, FLS-3, FLS-4).

use calcine_flowsheet::distribution::normal_shares;
use calcine_flowsheet::mill::{BondLaw, BondLength, BondNormal, ConstantMill};
use calcine_flowsheet::screen::{MolerusHoffmann, Plitt, ScreenLaw, TeipelHennig};
use calcine_flowsheet::units::{Mill, Mixer, PlantInlet, PlantOutlet, Screen};
use calcine_flowsheet::{
    Attribute, Connection, Integrator, Plant, PlantError, PlantRun, ProcessUnit, SizeGrid,
    StreamLayout, Timetable,
};

use crate::plants::oscillating;
use crate::support::{plain, solid, solids};

fn unit(name: &str, unit: impl ProcessUnit + 'static) -> (String, Box<dyn ProcessUnit>) {
    (name.into(), Box::new(unit))
}

fn inlet(stream: Vec<f64>) -> PlantInlet {
    PlantInlet::new(stream, Timetable::constant(1.0))
}

/// Feed and recycle through a screen, its coarse side through a mill and back.
fn circuit(layout: StreamLayout, feed: Vec<f64>, mill: Mill, screen: Plitt) -> Plant {
    let units = vec![
        unit("feed", inlet(feed)),
        unit("mixer", Mixer { inlets: 2 }),
        unit("screen", Screen::new(Box::new(screen))),
        unit("mill", mill),
        unit("product", PlantOutlet),
    ];
    let streams = [
        Connection::new("feed", ("feed", "out"), ("mixer", "in1")),
        Connection::new("milled", ("mill", "out"), ("mixer", "in2")),
        Connection::new("mixed", ("mixer", "out"), ("screen", "in")),
        Connection::new("coarse", ("screen", "coarse"), ("mill", "in")),
        Connection::new("fines", ("screen", "fine"), ("product", "in")),
    ];
    Plant::new(layout, units, &streams).unwrap()
}

#[test]
fn every_class_of_a_screen_follows_its_law() {
    let grid = SizeGrid::uniform(250, 0.0, 5e-3).unwrap();
    let shares = normal_shares(&grid, 2e-3, 3e-4, "feed").unwrap();
    let laws: [fn() -> Box<dyn ScreenLaw>; 3] = [
        || {
            Box::new(Plitt {
                cut: 2e-3,
                sharpness: 10.0,
            })
        },
        || {
            Box::new(MolerusHoffmann {
                cut: 2e-3,
                sharpness: 10.0,
            })
        },
        || {
            Box::new(TeipelHennig {
                cut: 2e-3,
                sharpness: 10.0,
                second_sharpness: 3.0,
                offset: 0.5,
            })
        },
    ];
    for law in laws {
        let layout = plain(grid.clone());
        let feed = solids(&layout, &shares, 10.0);
        let units = vec![
            unit("feed", inlet(feed.clone())),
            unit("screen", Screen::new(law())),
            unit("coarse", PlantOutlet),
            unit("fine", PlantOutlet),
        ];
        let streams = [
            Connection::new("feed", ("feed", "out"), ("screen", "in")),
            Connection::new("coarse", ("screen", "coarse"), ("coarse", "in")),
            Connection::new("fine", ("screen", "fine"), ("fine", "in")),
        ];
        let plant = Plant::new(layout, units, &streams).unwrap();
        let run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
        let (coarse, fine) = (run.stream(1), run.stream(2));
        for (class, d) in grid.diameters().iter().enumerate() {
            let expected = feed[class] * law().coarse_share(*d);
            assert!((coarse[class] - expected).abs() <= 1e-12 * feed[class]);
            assert!((coarse[class] + fine[class] - feed[class]).abs() <= 1e-15 * feed[class]);
        }
    }
}

/// Of the feed a share c_F is coarse, of what the mill makes c_m: R = F c_F/(1 − c_m) goes round.
#[test]
fn a_screen_and_a_mill_recycle_what_a_geometric_series_says() {
    let grid = SizeGrid::uniform(200, 0.0, 4e-3).unwrap();
    let layout = plain(grid.clone());
    let shares = normal_shares(&grid, 2e-3, 2e-4, "feed").unwrap();
    let milled = normal_shares(&grid, 1.4e-3, 1e-4, "mill").unwrap();
    let screen = Plitt {
        cut: 1.5e-3,
        sharpness: 6.0,
    };
    let coarse = |shares: &[f64]| -> f64 {
        let each = shares.iter().zip(grid.diameters());
        each.map(|(share, d)| share * screen.coarse_share(*d)).sum()
    };
    let expected = 3.0 * coarse(&shares) / (1.0 - coarse(&milled));
    let feed = solids(&layout, &shares, 3.0);
    let mill = Mill::new(Box::new(ConstantMill::new(1.4e-3, 1e-4)));
    let plant = circuit(layout, feed, mill, screen.clone());
    let run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    let found = plant
        .layout()
        .solid_flow(run.stream(plant.stream("milled").unwrap()));
    println!(
        "recycle {found} kg/s, expected {expected}, {} rounds",
        run.rounds()
    );
    assert!((found / expected - 1.0).abs() < 1e-10, "{found} {expected}");
    assert!(run.ledger().closure() <= 1e-12);
    assert!(run.rounds() < 20, "{}", run.rounds());
}

/// What is milled depends on the flow: the recycle is not linear.
#[test]
fn a_recycle_through_bonds_law_closes_and_conserves() {
    let grid = SizeGrid::uniform(200, 0.0, 4e-3).unwrap();
    let layout = plain(grid.clone());
    let shares = normal_shares(&grid, 2e-3, 2e-4, "feed").unwrap();
    let feed = solids(&layout, &shares, 1.0);
    let bond = BondLaw {
        work_index: 27000.0,
        power: 20e3,
        length: BondLength::Millimetre,
    };
    let mill = Mill::new(Box::new(BondNormal {
        bond,
        deviation: 1e-4,
    }));
    let plant = circuit(
        layout,
        feed,
        mill,
        Plitt {
            cut: 1.5e-3,
            sharpness: 6.0,
        },
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    assert!(run.ledger().closure() <= 1e-12);
    run.advance(100.0).unwrap();
    let ledger = run.ledger();
    assert!(ledger.worst() < 1e-12, "{:#?}", ledger.lines);
    // 20 kW heat 1 kg/s of 1500 J/kg/K by 13.33 K.
    let product = run.stream(plant.stream("fines").unwrap());
    let temperature = plant.layout().temperature(product).unwrap();
    assert!(
        (temperature - 300.0 - 20e3 / 1500.0).abs() < 1e-9,
        "{temperature}"
    );
}

#[test]
fn a_recycle_that_gains_is_told_with_its_stream() {
    let grid = SizeGrid::uniform(200, 0.0, 4e-3).unwrap();
    let layout = plain(grid.clone());
    let shares = normal_shares(&grid, 2.5e-3, 1e-4, "feed").unwrap();
    let feed = solids(&layout, &shares, 1.0);
    // The mill makes nothing that passes the screen.
    let mill = Mill::new(Box::new(ConstantMill::new(2.5e-3, 1e-4)));
    let plant = circuit(
        layout,
        feed,
        mill,
        Plitt {
            cut: 1e-3,
            sharpness: 20.0,
        },
    );
    let told = PlantRun::new(&plant, Integrator::Explicit, 1e-8)
        .err()
        .unwrap();
    let PlantError::Recycle { stream, .. } = &told else {
        panic!("{told}")
    };
    assert_eq!(stream, "\"milled\"");
}

#[test]
fn an_idle_mill_is_an_error_with_its_name() {
    let grid = SizeGrid::uniform(100, 0.0, 4e-3).unwrap();
    let layout = plain(grid);
    let bond = BondLaw {
        work_index: 27000.0,
        power: 1e3,
        length: BondLength::Millimetre,
    };
    let mill = Mill::new(Box::new(BondNormal {
        bond,
        deviation: 1e-4,
    }));
    let feed = vec![0.0; layout.width()];
    let plant = circuit(
        layout,
        feed,
        mill,
        Plitt {
            cut: 1e-3,
            sharpness: 20.0,
        },
    );
    let told = PlantRun::new(&plant, Integrator::Explicit, 1e-8)
        .err()
        .unwrap();
    assert!(
        matches!(&told, PlantError::IdleMill { unit, .. } if unit == "mill"),
        "{told}"
    );
}

/// What is red and large, and blue and small, stays so through screen, mill and mixer.
#[test]
fn colours_stay_with_their_particles() {
    let grid = SizeGrid::uniform(100, 0.0, 4e-3).unwrap();
    let colour = Attribute {
        name: "colour".into(),
        classes: 2,
    };
    let layout = StreamLayout::new(grid.clone(), vec![colour], vec![solid("urea")]).unwrap();
    let mut feed = vec![0.0; layout.width()];
    for (colour, mean) in [(0, 3e-3), (1, 1e-3)] {
        for (class, share) in normal_shares(&grid, mean, 1e-4, "feed")
            .unwrap()
            .iter()
            .enumerate()
        {
            feed[class * 2 + colour] = *share;
        }
    }
    let mill = Mill::new(Box::new(ConstantMill::new(1.5e-3, 1e-4)));
    let plant = circuit(
        layout,
        feed,
        mill,
        Plitt {
            cut: 2e-3,
            sharpness: 60.0,
        },
    );
    let run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    let part = |stream: &str, colour: usize, from: f64, to: f64| -> f64 {
        let stream = run.stream(plant.stream(stream).unwrap());
        let inside = |class: &usize| (from..to).contains(&grid.diameters()[*class]);
        (0..100)
            .filter(inside)
            .map(|class| stream[class * 2 + colour])
            .sum()
    };
    // Red is coarse and is milled to 1.5 mm; blue passes as it is.
    assert!((part("coarse", 0, 2.4e-3, 4e-3) - 1.0).abs() < 1e-8);
    assert!(part("coarse", 1, 0.0, 4e-3) < 1e-8);
    assert!((part("fines", 0, 1.0e-3, 2.0e-3) - 1.0).abs() < 1e-6);
    assert!((part("fines", 1, 0.4e-3, 1.6e-3) - 1.0).abs() < 1e-6);
    assert!(part("fines", 0, 2.2e-3, 4e-3) < 1e-12);
}

#[test]
fn all_that_is_wrong_with_a_plant_is_told_at_once() {
    let layout = plain(SizeGrid::uniform(10, 0.0, 4e-3).unwrap());
    let units = vec![
        unit("a", Mixer { inlets: 2 }),
        unit("a", PlantOutlet),
        unit(
            "screen",
            Screen::new(Box::new(Plitt {
                cut: -1.0,
                sharpness: 2.0,
            })),
        ),
    ];
    let streams = [
        Connection::new("one", ("a", "out"), ("nowhere", "in")),
        Connection::new("two", ("screen", "middle"), ("a", "in1")),
    ];
    let wrong = Plant::new(layout, units, &streams).err().unwrap();
    let text: Vec<String> = wrong.iter().map(ToString::to_string).collect();
    for part in [
        "two units are named \"a\"",
        "cut size is -1",
        "no unit is named \"nowhere\"",
        "no port \"middle\"",
        "is not connected",
    ] {
        assert!(
            text.iter().any(|line| line.contains(part)),
            "{part}: {text:#?}"
        );
    }
}

/// A bed that loses its spray at 100 s and has it again at 200 s: what its recycle carries dies out, and comes back.
#[test]
fn a_recycle_that_nothing_feeds_has_no_flow() {
    let sprayed = vec![(0.0, 1.0), (100.0, 0.0), (200.0, 1.0)];
    let sprayed = Timetable::new(sprayed, false, "spray").unwrap();
    let plant = oscillating(60, 8.0, sprayed, |bed| bed);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-6).unwrap();
    let flow = |run: &PlantRun, name: &str| {
        let (_, masses) = run
            .stream(plant.stream(name).unwrap())
            .split_last()
            .unwrap();
        masses.iter().sum::<f64>()
    };
    run.advance(90.0).unwrap();
    let before = flow(&run, "recycle");
    assert!(before > 0.0);
    run.advance(150.0).unwrap();
    assert_eq!(flow(&run, "recycle"), 0.0);
    assert_eq!(flow(&run, "product"), 0.0);
    run.advance(210.0).unwrap();
    assert!((flow(&run, "recycle") / before - 1.0).abs() < 0.2);
}
