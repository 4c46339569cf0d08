//! `units.granulator`.

use calcine_flowsheet::population::{
    Aggregation, GrowthLaw, LinearGrowth, ParticleBreakage, TabulatedGrowth, TabulatedKernel,
    UniformGrowth,
};
use calcine_flowsheet::units::{BedHeat, BedKernel, BedLevel, Granulator, Overspray};
use calcine_flowsheet::{ProcessUnit, StreamLayout};

use super::layout::refused;
use super::solids::{add_solids, distribution, pairs};
use super::words::{HeatOfBed, SchemeOfGrowth};
use crate::case::table::TableReader;
use crate::case::units::Dimension;

pub(super) fn granulator(
    own: &TableReader<'_>,
    layout: &StreamLayout,
) -> Option<Box<dyn ProcessUnit>> {
    let density = own.number("density");
    let mut content = vec![0.0; layout.solids()];
    let held = add_solids(own, "content", "mass", layout, &mut content);
    let (temperature, heat) = (own.number("temperature"), own.choice("heat"));
    let moisture = own.number("moisture");
    let level = level(own);
    let growth = growth(own);
    let scheme = own.choice::<SchemeOfGrowth>("scheme");
    let overspray = overspray(own, layout);
    let wear = own.number("wear");
    let aggregation = match own.has("aggregation") {
        true => Some(own.plain_law("aggregation", &own.laws().aggregation)?),
        false => None,
    };
    let kernel = kernel(own);
    let collisions = collisions(own);
    let breakage = match own.has("breakage") {
        true => Some(own.plain_law("breakage", &own.laws().breakage)?),
        false => None,
    };
    held?;
    let temperature = temperature?;
    let mut made = Granulator::new(content, density?)
        .with_moisture(moisture?)
        .with_level(level?)
        .with_heat(match heat? {
            HeatOfBed::Held => BedHeat::Held(temperature),
            HeatOfBed::Balanced => BedHeat::Balanced(temperature),
        })
        .with_growth(growth?)
        .with_scheme(scheme?.0)
        .with_wear(wear?);
    if let Some(overspray) = overspray? {
        made = made.with_overspray(overspray);
    }
    if let Some(law) = aggregation {
        made = made.with_process(Box::new(Aggregation::new(law.make())));
    }
    if let Some(kernel) = kernel? {
        made = made.with_process(Box::new(Aggregation::new(Box::new(kernel))));
    }
    if let Some(collisions) = collisions? {
        made = made.with_bed_kernel(collisions);
    }
    if let Some(law) = breakage {
        made = made.with_process(Box::new(ParticleBreakage::new(law.make())));
    }
    Some(Box::new(made))
}

fn level(own: &TableReader<'_>) -> Option<BedLevel> {
    if !own.has("level") {
        return Some(BedLevel::Fixed);
    }
    let table = own.table("level")?;
    let made = match table.exactly_one() {
        Some("residence") => table.number("residence").map(BedLevel::Residence),
        Some(_) => table.table("controlled").and_then(|controlled| {
            let (mass, time) = (controlled.number("mass"), controlled.number("time"));
            controlled.finish();
            Some(BedLevel::Controlled {
                mass: mass?,
                time: time?,
            })
        }),
        None => None,
    };
    table.finish();
    made
}

fn growth(own: &TableReader<'_>) -> Option<Box<dyn GrowthLaw>> {
    if !own.has("growth") {
        return Some(Box::new(UniformGrowth));
    }
    let table = own.table("growth")?;
    let made: Option<Box<dyn GrowthLaw>> = match table.exactly_one() {
        Some("linear") => table
            .number("linear")
            .map(|reference| -> Box<dyn GrowthLaw> { Box::new(LinearGrowth { reference }) }),
        Some(_) => pairs(&table, "table", Dimension::LENGTH).and_then(|points| {
            let law = TabulatedGrowth::new(points, &table.place_of("table"));
            let law = law.map_err(|error| refused(&table, "table", &error));
            law.ok().map(|law| -> Box<dyn GrowthLaw> { Box::new(law) })
        }),
        None => None,
    };
    table.finish();
    made
}

/// A kernel by points; `Some(None)` where the case has none.
fn kernel(own: &TableReader<'_>) -> Option<Option<TabulatedKernel>> {
    if !own.has("kernel") {
        return Some(None);
    }
    let table = own.table("kernel")?;
    let diameters = quantities(&table, "diameters", Dimension::LENGTH);
    let rates = quantities(&table, "rates", Dimension::ANGULAR_VELOCITY);
    table.finish();
    let made = TabulatedKernel::new(diameters?, rates?, &own.place_of("kernel"));
    made.map_err(|error| refused(own, "kernel", &error))
        .ok()
        .map(Some)
}

/// Collisions that a bed counts; `Some(None)` where the case has none.
fn collisions(own: &TableReader<'_>) -> Option<Option<BedKernel>> {
    if !own.has("collisions") {
        return Some(None);
    }
    let table = own.table("collisions")?;
    let (bed, efficiency) = (table.text("bed"), table.number("efficiency"));
    table.finish();
    Some(Some(BedKernel::new(bed?.to_owned(), efficiency?)))
}

/// A list of quantities.
pub(super) fn quantities(
    table: &TableReader<'_>,
    key: &str,
    dimension: Dimension,
) -> Option<Vec<f64>> {
    let texts = table.texts(key)?.into_iter();
    let value = |text: String| table.value(key, &toml_edit::Value::from(text), dimension);
    texts.map(value).collect()
}

/// Dust; `Some(None)` where the case has none.
fn overspray(own: &TableReader<'_>, layout: &StreamLayout) -> Option<Option<Overspray>> {
    if !own.has("overspray") {
        return Some(None);
    }
    let table = own.table("overspray")?;
    let (share, returned) = (table.number("share"), table.number("returned"));
    let sizes = match table.has("sizes") {
        true => distribution(&table, "sizes", layout.grid()),
        false => Some(Vec::new()),
    };
    table.finish();
    Some(Some(Overspray {
        share: share?,
        returned: returned?,
        sizes: sizes?,
    }))
}
