//! The granulation plant of Dyssol, converged (docs/theory.md, FLS-V2, FLS-V3).

use std::fmt::Display;

use calcine_flowsheet::distribution::{mean_diameter, normal_shares, quantile};
use calcine_flowsheet::mill::{BondLaw, BondLength, BondNormal, MillLaw};
use calcine_flowsheet::population::GrowthScheme;
use calcine_flowsheet::screen::Plitt;
use calcine_flowsheet::units::{Granulator, Mill, Mixer, PlantInlet, PlantOutlet, Screen};
use calcine_flowsheet::{
    Connection, Integrator, Plant, PlantError, PlantRun, ProcessUnit, SizeGrid, StreamLayout,
    Timetable, Transformation, UnitView,
};

use crate::support::{air, solid, solids, water};

/// Dyssol's mill: Bond's law with the feed's x80 half a class lower, as its cumulative shares stand at the middles of classes.
struct HalfAClassLower(BondNormal);

impl MillLaw for HalfAClassLower {
    fn transformation(
        &self,
        grid: &SizeGrid,
        feed: &[f64],
        place: &dyn Display,
    ) -> Result<Transformation, PlantError> {
        let size = quantile(grid, feed, 0.8).unwrap() - 0.5 * grid.width(0);
        let made = self.0.bond.product_size(size, feed.iter().sum());
        let mean = made - 0.83 * self.0.deviation;
        let row = normal_shares(grid, mean, self.0.deviation, place)?;
        Ok(Transformation::Uniform(row))
    }

    fn power(&self) -> f64 {
        self.0.bond.power
    }
}

/// Solids of the bed in kg, and of a second of the spray, which has as much liquid.
const HELD: f64 = 20.0;
const SPRAYED: f64 = 0.05;

/// Dyssol's granulator: one second of what enters is mixed into the bed, and its mass put back to what it was, before the
/// product takes its distribution; the next step begins with that bed.
struct WithASecondOfFeed {
    granulator: Granulator,
    keeps_liquid: bool,
}

impl ProcessUnit for WithASecondOfFeed {
    fn inlets(&self) -> Vec<String> {
        self.granulator.inlets()
    }
    fn outlets(&self) -> Vec<String> {
        self.granulator.outlets()
    }
    fn prepare(&mut self, layout: &StreamLayout, name: &str) -> Result<(), PlantError> {
        self.granulator.prepare(layout, name)
    }
    fn unknowns(&self, layout: &StreamLayout) -> usize {
        self.granulator.unknowns(layout)
    }
    fn start(&self, layout: &StreamLayout, state: &mut [f64]) {
        self.granulator.start(layout, state);
    }
    fn produce(&self, view: &UnitView<'_>, out: &mut [f64]) -> Result<(), PlantError> {
        self.granulator.produce(view, out)?;
        let solids = view.layout.solids();
        let feed = &view.inlet(0)[..solids];
        let (leaves, enters): (f64, f64) = (out[..solids].iter().sum(), feed.iter().sum());
        // Liquid pushes solids out, step by step, until there is as much of it in the bed as in what enters.
        let solid = match self.keeps_liquid && view.time > 0.0 {
            true => (enters + SPRAYED) / (enters + 2.0 * SPRAYED),
            false => 1.0,
        };
        let held = HELD * solid + SPRAYED;
        for (out, feed) in out[..solids].iter_mut().zip(feed) {
            *out = (*out * held + leaves * feed) / (held + enters);
        }
        Ok(())
    }
    fn rates(&self, view: &UnitView<'_>, out: &[f64], rates: &mut [f64]) -> Result<(), PlantError> {
        let mut own = vec![0.0; out.len()];
        self.granulator.produce(view, &mut own)?;
        self.granulator.rates(view, &own, rates)
    }
    fn held(&self, layout: &StreamLayout, state: &[f64], held: &mut [f64]) {
        self.granulator.held(layout, state, held);
    }
    fn scales(&self, layout: &StreamLayout, scales: &mut [f64]) {
        self.granulator.scales(layout, scales);
    }
    fn fastest(&self, view: &UnitView<'_>, out: &[f64]) -> f64 {
        self.granulator.fastest(view, out)
    }
}

/// Time of the figures in s.
const END: f64 = 3500.0;

pub fn plant(classes: usize, scale: f64) -> Plant {
    plant_by(classes, scale, GrowthScheme::VanLeer)
}

/// All flows and the mill's power times `scale`.
pub fn plant_by(classes: usize, scale: f64, scheme: GrowthScheme) -> Plant {
    plant_as_dyssols(classes, scale, scheme, AsDyssol::default())
}

/// What of Dyssol's units a plant has beside its scheme of growth.
#[derive(Clone, Copy, Debug, Default)]
pub struct AsDyssol {
    /// One second of what enters is mixed into the bed before the product takes its distribution.
    pub second: bool,
    /// The liquid of that second stays in the bed.
    pub liquid: bool,
    /// The mill finds the feed's x80 half a class lower.
    pub mill: bool,
}

/// The same with units as Dyssol has them.
pub fn plant_as_dyssols(
    classes: usize,
    scale: f64,
    scheme: GrowthScheme,
    as_dyssol: AsDyssol,
) -> Plant {
    let grid = SizeGrid::uniform(classes, 0.0, 4e-3).unwrap();
    let layout = StreamLayout::new(
        grid.clone(),
        Vec::new(),
        vec![solid("urea"), water(), air()],
    )
    .unwrap();
    let normal = |mean, deviation| normal_shares(&grid, mean, deviation, "test").unwrap();
    let nuclei = solids(&layout, &normal(1.5e-3, 1e-4), 0.1 * scale);
    let mut spray = vec![0.0; layout.width()];
    spray[layout.liquid(0)] = 0.05 * scale;
    spray[layout.liquid(1)] = 0.05 * scale;
    layout.set_temperature(&mut spray, 300.0);
    let mut gas = vec![0.0; layout.width()];
    gas[layout.vapour(2)] = 0.01 * scale;
    layout.set_temperature(&mut gas, 300.0);
    let mut content = vec![0.0; layout.solids()];
    for (class, share) in normal(2e-3, 1e-4).iter().enumerate() {
        content[class * layout.inner()] = 20.0 * share;
    }
    let bond = BondLaw {
        work_index: 7.5 * 3600.0,
        power: 800.0 * scale,
        length: BondLength::Millimetre,
    };
    let bond = BondNormal {
        bond,
        deviation: 1e-4,
    };
    let granulator = Granulator::new(content, 1320.0)
        .with_moisture(0.01)
        .with_scheme(scheme);
    let inlet = |stream| -> Box<dyn ProcessUnit> {
        Box::new(PlantInlet::new(stream, Timetable::constant(1.0)))
    };
    let screen = |cut| -> Box<dyn ProcessUnit> {
        Box::new(Screen::new(Box::new(Plitt {
            cut,
            sharpness: 4.0,
        })))
    };
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        ("FeedSusp".into(), inlet(spray)),
        ("FeedNucl".into(), inlet(nuclei)),
        ("FeedGas".into(), inlet(gas)),
        ("Mixer1".into(), Box::new(Mixer { inlets: 2 })),
        (
            "Granulator".into(),
            match as_dyssol.second {
                true => Box::new(WithASecondOfFeed {
                    granulator,
                    keeps_liquid: as_dyssol.liquid,
                }),
                false => Box::new(granulator),
            },
        ),
        ("Screen1".into(), screen(2.5e-3)),
        ("Screen2".into(), screen(1e-3)),
        (
            "Crusher".into(),
            Box::new(Mill::new(match as_dyssol.mill {
                true => Box::new(HalfAClassLower(bond)),
                false => Box::new(bond),
            })),
        ),
        ("Mixer2".into(), Box::new(Mixer { inlets: 2 })),
        ("OutDust".into(), Box::new(PlantOutlet)),
        ("Product".into(), Box::new(PlantOutlet)),
    ];
    let streams = [
        Connection::new("InSusp", ("FeedSusp", "out"), ("Granulator", "spray")),
        Connection::new("InNucl", ("FeedNucl", "out"), ("Mixer1", "in1")),
        Connection::new("InGas", ("FeedGas", "out"), ("Granulator", "gas")),
        Connection::new("Mixed", ("Mixer2", "out"), ("Mixer1", "in2")),
        Connection::new("MixNucl", ("Mixer1", "out"), ("Granulator", "feed")),
        Connection::new("GranProd", ("Granulator", "product"), ("Screen1", "in")),
        Connection::new("GranDust", ("Granulator", "exhaust"), ("OutDust", "in")),
        Connection::new("Coarse1", ("Screen1", "coarse"), ("Crusher", "in")),
        Connection::new("Fines1", ("Screen1", "fine"), ("Screen2", "in")),
        Connection::new("Coarse2", ("Screen2", "coarse"), ("Product", "in")),
        Connection::new("Fines2", ("Screen2", "fine"), ("Mixer2", "in1")),
        Connection::new("Milled", ("Crusher", "out"), ("Mixer2", "in2")),
    ];
    Plant::new(layout, units, &streams).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

/// Flows in kg/s, mean of the product and of the hold-up in mm.
pub fn figures(plant: &Plant, run: &PlantRun<'_>) -> [f64; 7] {
    let layout = plant.layout();
    let stream = |name: &str| run.stream(plant.stream(name).unwrap());
    let flow = |name: &str| layout.mass_flow(stream(name));
    let mean = |masses: &[f64]| 1e3 * mean_diameter(layout.grid(), masses).unwrap();
    let bed = run.unit(plant.unit("Granulator").unwrap());
    [
        flow("GranProd"),
        flow("Coarse1"),
        flow("Fines1"),
        flow("Fines2"),
        flow("Mixed"),
        mean(&layout.by_size(stream("Coarse2"))),
        mean(&layout.by_size(bed)),
    ]
}

/// FLS-V2 on three grids: what they lack of the third falls with second order, and that has the figures.
#[test]
fn the_granulation_plant_has_its_converged_figures() {
    let expected = [0.18023, 0.02578, 0.15445, 0.002950, 0.02873, 1.6668, 1.6833];
    let mut all = Vec::new();
    for classes in [100, 200, 400] {
        let plant = plant(classes, 1.0);
        assert_eq!(plant.tears().len(), 1, "{:?}", plant.tears());
        let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-6).unwrap();
        run.advance(END).unwrap();
        let found = figures(&plant, &run);
        println!(
            "{classes} classes: {found:?}, steps {:?}, rounds {}",
            run.steps(),
            run.rounds()
        );
        let ledger = run.ledger();
        assert!(ledger.closure() <= 1e-12);
        assert!(ledger.worst() < 1e-11, "{:#?}", ledger.lines);
        all.push(found);
    }
    for (k, expected) in expected.into_iter().enumerate() {
        let [coarse, middle, fine] = [0, 1, 2].map(|grid: usize| all[grid][k]);
        let order = ((coarse - middle) / (middle - fine)).abs().log2();
        println!("{expected}: {fine}, order {order}");
        assert!(order > 1.5, "{order}");
        assert!((fine / expected - 1.0).abs() < 2e-3, "{fine} {expected}");
    }
}

/// FLS-V3: a twentieth of every flow and of the power, at 20 t.
#[test]
fn a_plant_of_a_twentieth_does_the_same_in_twenty_times_the_time() {
    let (whole, slow) = (plant(100, 1.0), plant(100, 0.05));
    let mut run = PlantRun::new(&whole, Integrator::Explicit, 1e-9).unwrap();
    run.advance(1000.0).unwrap();
    let mut other = PlantRun::new(&slow, Integrator::Explicit, 1e-9).unwrap();
    other.advance(20_000.0).unwrap();
    for (a, b) in run.unknowns().iter().zip(other.unknowns()) {
        assert!((a - b).abs() < 1e-6 * 20.0 / 100.0, "{a} {b}");
    }
}
