//! The granulation plant that oscillates (docs/theory.md, FLS-V4), for tests and benchmarks.

use calcine_flowsheet::distribution::normal_shares;
use calcine_flowsheet::mill::ConstantMill;
use calcine_flowsheet::screen::Plitt;
use calcine_flowsheet::units::{Granulator, Mill, Mixer, PlantInlet, PlantOutlet, Screen};
use calcine_flowsheet::{Connection, Plant, ProcessUnit, SizeGrid, Timetable};

use crate::support::plain;

/// Size classes to 4 mm, the slope of both screens, the spray over time relative to 0.05 kg/s, and what else the bed does.
pub fn oscillating(
    classes: usize,
    sharpness: f64,
    sprayed: Timetable,
    bed: impl Fn(Granulator) -> Granulator,
) -> Plant {
    let grid = SizeGrid::uniform(classes, 0.0, 4e-3).unwrap();
    let layout = plain(grid.clone());
    let mut spray = vec![0.0; layout.width()];
    spray[layout.liquid(0)] = 0.05;
    layout.set_temperature(&mut spray, 300.0);
    let shares = normal_shares(&grid, 1.8e-3, 2.5e-4, "test").unwrap();
    let content = shares.iter().map(|share| 20.0 * share).collect();
    let none = vec![0.0; layout.width()];
    let inlet =
        |stream, factor| -> Box<dyn ProcessUnit> { Box::new(PlantInlet::new(stream, factor)) };
    let screen =
        |cut| -> Box<dyn ProcessUnit> { Box::new(Screen::new(Box::new(Plitt { cut, sharpness }))) };
    let mill = ConstantMill::new(1e-3, 1e-4);
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        ("spray".into(), inlet(spray, sprayed)),
        ("gas".into(), inlet(none, Timetable::constant(1.0))),
        (
            "granulator".into(),
            Box::new(bed(Granulator::new(content, 1320.0))),
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

/// A spray that is 10 % more every other hour of a day.
pub fn hourly() -> Timetable {
    let level = |hour: u32| if hour.is_multiple_of(2) { 1.0 } else { 1.1 };
    let points = (0..24).map(|hour| (3600.0 * f64::from(hour), level(hour)));
    Timetable::new(points.collect(), false, "spray").unwrap()
}
