//! Units that stand for beds that are computed elsewhere (docs/theory.md, FLS-8), with a bed of a few lines in place of one.

use calcine_flowsheet::units::{
    BedKernel, CoupledBedUnit, Granulator, PlantInlet, PlantOutlet, Splitter,
};
use calcine_flowsheet::{
    BedCharge, BedCoupling, BedExchange, Connection, CoupledBed, Integrator, Plant, PlantError,
    PlantRun, ProcessUnit, SizeGrid, StreamLayout, Timetable, WaveformSettings,
};

use crate::support::{plain, solids};

/// A bed that is stirred and heated: a fifth of what it holds leaves in each interval, and 50 J come in.
#[derive(Clone)]
struct Stirred {
    held: Vec<f64>,
    kernel: Vec<f64>,
}

impl CoupledBed for Stirred {
    fn content(&self, _layout: &StreamLayout, _name: &str) -> Result<Vec<f64>, PlantError> {
        Ok(self.held.clone())
    }

    fn exchange(&mut self, charge: &BedCharge<'_>) -> Result<BedExchange, PlantError> {
        let enthalpy = charge.layout.enthalpy();
        for (held, waits) in self.held.iter_mut().zip(charge.waiting) {
            *held += 0.75 * waits;
        }
        self.held[enthalpy] += 50.0;
        let left: Vec<f64> = self.held.iter().map(|held| 0.2 * held).collect();
        self.held.iter_mut().zip(&left).for_each(|(h, l)| *h -= l);
        Ok(BedExchange {
            waiting: charge.waiting.iter().map(|waits| 0.25 * waits).collect(),
            left,
            held: self.held.clone(),
            heat: 50.0,
            due: vec![0.25 * charge.layout.mass_flow(charge.waiting)],
            kernel: self.kernel.clone(),
        })
    }
}

fn layout() -> StreamLayout {
    plain(SizeGrid::geometric(12, 1e-3, 16e-3).unwrap())
}

fn at_start(layout: &StreamLayout) -> Stirred {
    let mut shares = vec![0.0; 12];
    shares[3] = 1.0;
    Stirred {
        held: solids(layout, &shares, 2.0),
        kernel: vec![3e-6; 4],
    }
}

/// A bed within a recycle, whose kernel a granulator takes.
fn plant(layout: &StreamLayout, efficiency: f64) -> Plant {
    let mut shares = vec![0.0; 12];
    (shares[2], shares[4]) = (0.5, 0.5);
    let stream = solids(layout, &shares, 0.01);
    let factor = Timetable::new(vec![(0.0, 1.0), (37.0, 2.0)], false, "factor").unwrap();
    let nothing = || PlantInlet::new(vec![0.0; layout.width()], Timetable::constant(1.0));
    let content = solids(layout, &shares, 1.0)[..layout.solids()].to_vec();
    let kernel = BedKernel::new("bed".into(), efficiency);
    let coupling = BedCoupling {
        interval: 10.0,
        feeds: 1,
        diameters: vec![1e-3, 16e-3],
    };
    let unit = |name: &str, unit: Box<dyn ProcessUnit>| (name.to_owned(), unit);
    let units = vec![
        unit("in", Box::new(PlantInlet::new(stream, factor))),
        unit(
            "mixer",
            Box::new(calcine_flowsheet::units::Mixer { inlets: 2 }),
        ),
        unit("bed", Box::new(CoupledBedUnit { coupling })),
        unit("split", Box::new(Splitter::new(vec![0.3, 0.7]))),
        unit("spray", Box::new(nothing())),
        unit("gas", Box::new(nothing())),
        unit(
            "granulator",
            Box::new(Granulator::new(content, 1000.0).with_bed_kernel(kernel)),
        ),
        unit("out", Box::new(PlantOutlet)),
        unit("exhaust", Box::new(PlantOutlet)),
    ];
    let streams = [
        Connection::new("fed", ("in", "out"), ("mixer", "in1")),
        Connection::new("all", ("mixer", "out"), ("bed", "feed")),
        Connection::new("left", ("bed", "product"), ("split", "in")),
        Connection::new("back", ("split", "out1"), ("mixer", "in2")),
        Connection::new("on", ("split", "out2"), ("granulator", "feed")),
        Connection::new("s", ("spray", "out"), ("granulator", "spray")),
        Connection::new("g", ("gas", "out"), ("granulator", "gas")),
        Connection::new("product", ("granulator", "product"), ("out", "in")),
        Connection::new("fumes", ("granulator", "exhaust"), ("exhaust", "in")),
    ];
    Plant::new(layout.clone(), units, &streams).unwrap()
}

fn begun<'a>(plant: &'a Plant, bed: &Stirred) -> PlantRun<'a> {
    let mut run = PlantRun::new(plant, Integrator::Explicit, 1e-8).unwrap();
    run.couple(vec![Box::new(bed.clone())]).unwrap();
    run
}

#[test]
fn a_bed_in_a_recycle_closes_and_its_product_is_an_interval_late() {
    let layout = layout();
    let plant = plant(&layout, 0.01);
    let bed = at_start(&layout);
    let mut run = begun(&plant, &bed);
    let left = plant.stream("left").unwrap();
    run.advance(9.9).unwrap();
    assert_eq!(layout.mass_flow(run.stream(left)), 0.0);
    run.advance(10.0).unwrap();
    // 0.1 kg came by then, of which three quarters were fed to 2 kg; a fifth of that leaves over 10 s.
    let flow = layout.mass_flow(run.stream(left));
    assert!(
        (flow / (0.2 * (2.0 + 0.075) / 10.0) - 1.0).abs() < 1e-12,
        "{flow}"
    );
    run.advance(203.0).unwrap();
    let ledger = run.ledger();
    assert!(ledger.worst() < 1e-13, "{:e}", ledger.worst());
    let heat = ledger
        .lines
        .iter()
        .find(|line| line.place == "bed" && line.what == "enthalpy");
    assert_eq!(heat.map(|line| line.heat), Some(20.0 * 50.0));
}

#[test]
fn what_a_bed_returns_decides_how_fast_a_granulator_aggregates() {
    let layout = layout();
    let bed = at_start(&layout);
    let numbers = |efficiency: f64| {
        let plant = plant(&layout, efficiency);
        let mut run = begun(&plant, &bed);
        let unit = plant.unit("granulator").unwrap();
        run.advance(10.0).unwrap();
        let masses = layout.by_size(run.unit(unit));
        let number = |masses: &[f64]| {
            let classes = masses.iter().zip(layout.grid().diameters());
            let each = classes.map(|(m, d)| m / (1000.0 * std::f64::consts::PI / 6.0 * d.powi(3)));
            each.sum::<f64>()
        };
        let before = number(&masses);
        let rate = |span: f64| {
            let mut run = begun(&plant, &bed);
            run.advance(10.0 + span).unwrap();
            (number(&layout.by_size(run.unit(unit))) - before) / span
        };
        [before, rate(1e-3)]
    };
    let [_, still] = numbers(0.0);
    let [count, moved] = numbers(0.5);
    // ½ β N² with β = ψ K/m, m = 1 kg: the kernel is one number.
    let expected = -0.5 * (0.5 * 3e-6) * count * count;
    let found = moved - still;
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn a_plant_with_a_bed_is_resumed_to_the_same_bits_by_both_methods() {
    let layout = layout();
    let plant = plant(&layout, 1.0);
    for windows in [None, Some(WaveformSettings::default())] {
        let advance = |run: &mut PlantRun<'_>, to: f64| match &windows {
            None => run.advance(to).unwrap(),
            Some(settings) => run.advance_by_windows(to, settings).unwrap(),
        };
        let mut whole = begun(&plant, &at_start(&layout));
        advance(&mut whole, 70.0);
        let saved = whole.checkpoint();
        let mut there = at_start(&layout);
        there.held = saved.unknowns[plant.unknowns_of(plant.unit("bed").unwrap())]
            [layout.width()..2 * layout.width()]
            .to_vec();
        advance(&mut whole, 140.0);
        let mut other = begun(&plant, &there);
        other.resume(saved);
        advance(&mut other, 140.0);
        assert_eq!(whole.checkpoint(), other.checkpoint());
        assert!(whole.ledger().closure() <= 1e-12);
    }
}

#[test]
fn what_cannot_be_with_a_bed_is_refused_with_its_name() {
    let layout = layout();
    let plant = plant(&layout, 1.0);
    let steady = plant.steady(&plant.start(), 0.0).unwrap_err().to_string();
    assert!(
        steady.contains("bed \"bed\" exchanges with the plant from time to time"),
        "{steady}"
    );
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-6).unwrap();
    let told = run.advance(20.0).unwrap_err().to_string();
    assert!(told.contains("nothing computes it here"), "{told}");
    let kernel = BedKernel::new("split".into(), 1.0);
    let content = vec![1.0; layout.solids()];
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        (
            "g".into(),
            Box::new(Granulator::new(content, 1000.0).with_bed_kernel(kernel)),
        ),
        ("split".into(), Box::new(Splitter::new(vec![1.0]))),
    ];
    let wrong = Plant::new(layout.clone(), units, &[]).err().unwrap();
    let told: Vec<String> = wrong.iter().map(ToString::to_string).collect();
    let found = told
        .iter()
        .any(|one| one.contains("takes a kernel from unit \"split\", which gives none"));
    assert!(found, "{told:?}");
}
