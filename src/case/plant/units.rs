//! `[[units]]`.

use std::path::Path;

use calcine_flowsheet::cyclone::MuschelknautzCyclone;
use calcine_flowsheet::units::{
    Bunker, Cyclone, Discharge, Dryer, Mill, Mixer, PlantInlet, PlantOutlet, Screen, Splitter,
    TimeDelay,
};
use calcine_flowsheet::{ProcessUnit, StreamLayout, Timetable};

use super::bed::{PlantBedSpec, bed};
use super::controller::controller;
use super::granulator::granulator;
use super::layout::refused;
use super::solids::{add_solids, by_compound, numbers};
use super::words::InBetween;
use crate::case::table::TableReader;

/// A unit of the case, with its table for errors that are about it.
pub(super) struct ReadUnit<'a> {
    /// Name.
    pub name: String,
    /// Its kind: the key of its table; empty where that is not known.
    pub kind: &'static str,
    /// The unit; `None` where it could not be read.
    pub unit: Option<Box<dyn ProcessUnit>>,
    /// Its table.
    pub table: TableReader<'a>,
    /// Of a bed: what its run needs.
    pub bed: Option<PlantBedSpec>,
}

/// All units; cases of beds lie relative to `folder`, and are not read without one.
pub(super) fn units<'a>(
    root: &TableReader<'a>,
    layout: &StreamLayout,
    folder: Option<&Path>,
) -> Vec<ReadUnit<'a>> {
    let mut all: Vec<ReadUnit<'a>> = Vec::new();
    for table in root.tables("units") {
        let name = table.text("name").unwrap_or_default().to_owned();
        if table.has("name") && (name.is_empty() || name.contains('.')) {
            let help = "give it a name without a point: what stands behind one is a port";
            table.fail("name", format!("is \"{name}\""), help);
        }
        if all.iter().any(|one| one.name == name && !name.is_empty()) {
            let rule = format!("is \"{name}\" a second time");
            table.fail("name", rule, "names of units must differ");
        }
        let kind = table.exactly_one();
        let mut spec = None;
        let made = match kind {
            Some("bed") => table.table("bed").and_then(|own| {
                let made = bed(&own, &name, layout, folder);
                own.finish();
                let (unit, read) = made?;
                spec = Some(read);
                Some(unit)
            }),
            Some(kind) => unit(&table, kind, layout),
            None => None,
        };
        table.finish();
        let kind = kind.unwrap_or_default();
        let prepared = made.and_then(|mut unit| {
            let done = unit.prepare(layout, &name);
            done.map_err(|error| refused(&table, kind, &error)).ok()?;
            Some(unit)
        });
        all.push(ReadUnit {
            name,
            kind,
            unit: prepared,
            table,
            bed: spec,
        });
    }
    all
}

/// The unit of one kind.
fn unit(
    table: &TableReader<'_>,
    kind: &str,
    layout: &StreamLayout,
) -> Option<Box<dyn ProcessUnit>> {
    match kind {
        "screen" => {
            let law = table.plain_law("screen", &table.laws().screen)?;
            return Some(Box::new(Screen::new(law.make())));
        }
        "mill" => {
            let law = table.plain_law("mill", &table.laws().mill)?;
            return Some(Box::new(Mill::new(law.make())));
        }
        _ => {}
    }
    let own = table.table(kind)?;
    let made: Option<Box<dyn ProcessUnit>> = match kind {
        "inlet" => inlet(&own, layout),
        "outlet" => Some(Box::new(PlantOutlet)),
        "mixer" => own
            .whole("inlets")
            .and_then(|count| usize::try_from(count).ok())
            .map(|inlets| -> Box<dyn ProcessUnit> { Box::new(Mixer { inlets }) }),
        "splitter" => {
            let controller = own.text("controller").map(str::to_owned);
            numbers(&own, "shares")
                .map(|shares| -> Box<dyn ProcessUnit> { Box::new(Splitter { shares, controller }) })
        }
        "controller" => controller(&own, layout),
        "granulator" => granulator(&own, layout),
        "dryer" => own
            .number("moisture")
            .map(|moisture| -> Box<dyn ProcessUnit> { Box::new(Dryer { moisture }) }),
        "cyclone" => cyclone(&own),
        "delay" => delay(&own),
        _ => bunker(&own, layout),
    };
    own.finish();
    made
}

/// A schedule with what runs between its points.
fn timetable(table: &TableReader<'_>, key: &str) -> Option<Timetable> {
    let between = table.choice::<InBetween>("between");
    let points = table.schedule(key)?.0;
    let linear = between? == InBetween::Line;
    let made = Timetable::new(points, linear, &table.place_of(key));
    made.map_err(|error| refused(table, key, &error)).ok()
}

/// Solids, liquids, vapours and temperature of a table, as a row of the layout.
fn row(table: &TableReader<'_>, amount: &str, layout: &StreamLayout) -> Option<Vec<f64>> {
    let mut row = vec![0.0; layout.width()];
    let solids = add_solids(table, "solids", amount, layout, &mut row);
    let liquids = by_compound(table, "liquids", layout);
    let vapours = by_compound(table, "vapours", layout);
    let temperature = table.number("temperature");
    solids?;
    for (k, (liquid, vapour)) in liquids?.iter().zip(&vapours?).enumerate() {
        row[layout.liquid(k)] = *liquid;
        row[layout.vapour(k)] = *vapour;
    }
    layout.set_temperature(&mut row, temperature?);
    Some(row)
}

fn inlet(own: &TableReader<'_>, layout: &StreamLayout) -> Option<Box<dyn ProcessUnit>> {
    let stream = row(own, "flow", layout);
    let factor = timetable(own, "factor");
    let made = PlantInlet::new(stream?, factor?);
    Some(Box::new(match own.text("controller") {
        Some(name) => made.with_controller(name.to_owned()),
        None => made,
    }))
}

fn bunker(own: &TableReader<'_>, layout: &StreamLayout) -> Option<Box<dyn ProcessUnit>> {
    let content = own.table("content").and_then(|table| {
        let row = row(&table, "mass", layout);
        table.finish();
        row
    });
    let discharge = match own.has("discharge") {
        false => Some(Discharge::Level),
        true => own.table("discharge").and_then(|table| {
            let made = match table.exactly_one() {
                Some("residence") => table.number("residence").map(Discharge::Residence),
                Some("adaptive") => table.number("adaptive").map(Discharge::Adaptive),
                Some("controller") => {
                    let name = table.text("controller");
                    name.map(|name| Discharge::Controlled(name.to_owned()))
                }
                Some(_) => timetable(&table, "rate").map(Discharge::Rate),
                None => None,
            };
            table.finish();
            made
        }),
    };
    Some(Box::new(Bunker {
        content: content?,
        discharge: discharge?,
    }))
}

fn delay(own: &TableReader<'_>) -> Option<Box<dyn ProcessUnit>> {
    let (time, stages) = (own.number("time"), own.whole("stages"));
    Some(Box::new(TimeDelay {
        time: time?,
        stages: usize::try_from(stages?).ok()?,
        content: Vec::new(),
    }))
}

fn cyclone(own: &TableReader<'_>) -> Option<Box<dyn ProcessUnit>> {
    let names = [
        "diameter",
        "height",
        "cylinder_height",
        "finder_diameter",
        "finder_depth",
        "exit_diameter",
        "slot_width",
        "slot_height",
        "wall_friction",
        "curve_width",
        "load_constant",
        "gas_density",
        "viscosity",
        "solid_density",
    ];
    let values = names.map(|name| own.number(name));
    let values: Option<Vec<f64>> = values.into_iter().collect();
    let values: [f64; 14] = values?.try_into().ok()?;
    let [
        diameter,
        height,
        cylinder_height,
        finder_diameter,
        finder_depth,
        exit_diameter,
        slot_width,
        slot_height,
        wall_friction,
        curve_width,
        load_constant,
        gas_density,
        viscosity,
        solid_density,
    ] = values;
    Some(Box::new(Cyclone {
        law: MuschelknautzCyclone {
            diameter,
            height,
            cylinder_height,
            finder_diameter,
            finder_depth,
            exit_diameter,
            slot_width,
            slot_height,
            wall_friction,
            curve_width,
            load_constant,
        },
        gas_density,
        viscosity,
        solid_density,
    }))
}
