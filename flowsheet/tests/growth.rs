//! Growth of populations against characteristics (docs/theory.md, PBM-1 to PBM-5, PBM-V1).

use calcine_flowsheet::population::{GrowthScheme, LinearGrowth, dyssol_growth};
use calcine_flowsheet::units::{BedLevel, Granulator, PlantInlet, PlantOutlet};
use calcine_flowsheet::{
    Connection, Integrator, Plant, PlantRun, ProcessUnit, SizeGrid, Timetable,
};

use crate::support::{plain, solids};

pub const DENSITY: f64 = 1320.0;

/// A granulator with a feed, a spray of solids and no gas.
pub fn tank(
    grid: SizeGrid,
    feed: &[f64],
    spray: f64,
    make: impl Fn(Granulator) -> Granulator,
    content: Vec<f64>,
) -> Plant {
    let layout = plain(grid);
    let mut sprayed = vec![0.0; layout.width()];
    sprayed[layout.liquid(0)] = spray;
    let feed = solids(&layout, feed, 1.0);
    let none = vec![0.0; layout.width()];
    let inlet = |stream| -> Box<dyn ProcessUnit> {
        Box::new(PlantInlet::new(stream, Timetable::constant(1.0)))
    };
    let bed = make(Granulator::new(content, DENSITY));
    let units: Vec<(String, Box<dyn ProcessUnit>)> = vec![
        ("feed".into(), inlet(feed)),
        ("spray".into(), inlet(sprayed)),
        ("gas".into(), inlet(none)),
        ("bed".into(), Box::new(bed)),
        ("product".into(), Box::new(PlantOutlet)),
        ("exhaust".into(), Box::new(PlantOutlet)),
    ];
    let streams = [
        Connection::new("feed", ("feed", "out"), ("bed", "feed")),
        Connection::new("spray", ("spray", "out"), ("bed", "spray")),
        Connection::new("gas", ("gas", "out"), ("bed", "gas")),
        Connection::new("product", ("bed", "product"), ("product", "in")),
        Connection::new("exhaust", ("bed", "exhaust"), ("exhaust", "in")),
    ];
    Plant::new(layout, units, &streams).unwrap_or_else(|wrong| panic!("{wrong:?}"))
}

/// Nothing leaves: a residence time beyond all bounds.
fn batch(bed: Granulator) -> Granulator {
    bed.with_level(BedLevel::Residence(1e300))
}

/// A_tot in m² and mean growth in m/s of masses.
fn area(grid: &SizeGrid, masses: &[f64]) -> f64 {
    let sum: f64 = masses
        .iter()
        .zip(grid.diameters())
        .map(|(m, d)| m / d)
        .sum();
    6.0 * sum / DENSITY
}

/// The batch of Dyssol's test: 17 classes, of which each is divided into `parts` (odd) and the mass lies in the middle.
fn dyssols_batch(parts: usize) -> (SizeGrid, Vec<f64>) {
    let grid = SizeGrid::uniform(17 * parts, 0.875e-3, 5.125e-3).unwrap();
    let mut masses = vec![0.0; grid.classes()];
    for (class, share) in [(1, 0.3), (2, 0.4), (3, 0.2), (4, 0.1)] {
        masses[class * parts + parts / 2] = 1000.0 * share;
    }
    (grid, masses)
}

/// PBM-V1: all particles grow by 278.643 µm; A_tot 4328.850 m², G 8.75031e-7 m/s by the method of characteristics.
#[test]
fn a_batch_grows_as_characteristics_say() {
    let mut errors = Vec::new();
    for parts in [11, 33] {
        let (grid, content) = dyssols_batch(parts);
        assert!((area(&grid, &content) - 3049.78).abs() < 0.005);
        let none = vec![0.0; grid.classes()];
        let plant = tank(grid.clone(), &none, 2.5, batch, content);
        let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-7).unwrap();
        run.advance(270.0).unwrap();
        let masses = run.unit(plant.unit("bed").unwrap());
        let all: f64 = masses.iter().sum();
        assert!((all - 1675.0).abs() < 1e-9, "{all}");
        let found = area(&grid, masses);
        let growth = 2.0 * 2.5 / (DENSITY * found);
        println!(
            "{} classes: A {found} m², G {growth:e} m/s, steps {:?}",
            17 * parts,
            run.steps()
        );
        errors.push((found / 4328.850 - 1.0).abs());
        assert!((growth / 8.75031e-7 - 1.0).abs() < 1e-3);
        assert!(run.ledger().worst() < 1e-12);
    }
    assert!(errors[0] < 1e-3 && errors[1] < errors[0], "{errors:?}");
}

/// Dyssol's own figures by its scheme, with the drift of 6.6 % that its normalisation hides.
#[test]
fn dyssols_scheme_gives_dyssols_figures_and_its_drift() {
    let (grid, mut masses) = dyssols_batch(1);
    let count = grid.classes();
    let growth = |masses: &[f64]| 2.0 * 2.5 / (DENSITY * area(&grid, masses));
    assert!((growth(&masses) / 1.24202e-6 - 1.0).abs() < 1e-5);
    // The classical Runge-Kutta method, 270 steps.
    let rate = |masses: &[f64]| {
        let mut rates = vec![0.0; count];
        dyssol_growth(&grid, growth(masses), masses, true, &mut rates);
        rates
    };
    let moved = |masses: &[f64], h: f64, rates: &[f64]| -> Vec<f64> {
        masses.iter().zip(rates).map(|(m, r)| m + h * r).collect()
    };
    for _ in 0..270 {
        let a = rate(&masses);
        let b = rate(&moved(&masses, 0.5, &a));
        let c = rate(&moved(&masses, 0.5, &b));
        let d = rate(&moved(&masses, 1.0, &c));
        for k in 0..count {
            masses[k] += (a[k] + 2.0 * b[k] + 2.0 * c[k] + d[k]) / 6.0;
        }
    }
    let all: f64 = masses.iter().sum();
    let found = area(&grid, &masses);
    println!(
        "sum {all} kg of 1675, A {found} m², G {:e} m/s",
        growth(&masses)
    );
    assert!((found / 4413.58 - 1.0).abs() < 1e-5);
    assert!((growth(&masses) / 8.58234e-7 - 1.0).abs() < 1e-5);
    assert!((all - 1784.7).abs() < 0.05);
    // Dyssol's distribution after 270 s.
    let known = [
        0.0558562, 0.180813, 0.260551, 0.237989, 0.153258, 0.0734771, 0.0273431, 0.00817679,
    ];
    for (mass, share) in masses[1..].iter().zip(known) {
        assert!((mass / all - share).abs() < 1e-6, "{} {share}", mass / all);
    }
}

/// A smooth distribution of numbers keeps its shape under uniform growth and moves by the shift that the mass asks for.
#[test]
fn growth_converges_with_second_order_where_smooth() {
    let (mean, width) = (1.0e-3, 0.12e-3);
    // Mass density ∝ d³ exp(−½((d − mean)/width)²): moments of a normal distribution of numbers.
    let third = |m: f64| m.powi(3) + 3.0 * m * width * width;
    // The bed's mass doubles: the mean that has twice the third moment.
    let mut shifted = mean;
    for _ in 0..60 {
        let slope = 3.0 * shifted * shifted + 3.0 * width * width;
        shifted -= (third(shifted) - 2.0 * third(mean)) / slope;
    }
    let error = |classes: usize, scheme: GrowthScheme| {
        let grid = SizeGrid::uniform(classes, 0.0, 3e-3).unwrap();
        let shape = |d: &f64, m: f64| d.powi(3) * (-0.5 * ((d - m) / width).powi(2)).exp();
        let start: Vec<f64> = grid.diameters().iter().map(|d| shape(d, mean)).collect();
        let sum: f64 = start.iter().sum();
        let content: Vec<f64> = start.iter().map(|m| m / sum).collect();
        let none = vec![0.0; classes];
        let plant = tank(
            grid.clone(),
            &none,
            1e-2,
            |bed| batch(bed).with_scheme(scheme),
            content,
        );
        let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
        run.advance(100.0).unwrap();
        let masses = run.unit(plant.unit("bed").unwrap());
        let off = |(mass, d): (&f64, &f64)| (mass - shape(d, shifted) / sum).abs();
        masses.iter().zip(grid.diameters()).map(off).sum::<f64>() / 2.0
    };
    for (scheme, least) in [(GrowthScheme::VanLeer, 1.8), (GrowthScheme::Upwind, 0.6)] {
        let errors = [100, 200, 400, 800].map(|classes| error(classes, scheme));
        let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
        println!("{scheme:?}: errors {errors:?}, orders {orders:?}");
        assert!(orders[2] > least, "{orders:?}");
    }
}

/// Masses of a stirred tank after ten residence times of 1000 s, with seeds of 0.01 kg/s in the class above 0.5 mm, and the
/// diameter of these.
fn seeded(grid: &SizeGrid, spray: f64, grow: impl Fn(Granulator) -> Granulator) -> (Vec<f64>, f64) {
    let seeds = grid.diameters().iter().position(|d| *d > 0.5e-3).unwrap();
    let mut feed = vec![0.0; grid.classes()];
    feed[seeds] = 0.01;
    let mut content = vec![0.0; grid.classes()];
    content[seeds] = 10.0;
    let make = |bed| grow(Granulator::with_level(bed, BedLevel::Residence(1000.0)));
    let plant = tank(grid.clone(), &feed, spray, make, content);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-6).unwrap();
    run.advance(10_000.0).unwrap();
    assert!(run.ledger().worst() < 1e-12);
    let masses = run.unit(plant.unit("bed").unwrap()).to_vec();
    (masses, grid.diameters()[seeds])
}

fn numbers(grid: &SizeGrid, masses: &[f64]) -> Vec<f64> {
    let pairs = masses.iter().zip(grid.diameters());
    pairs.map(|(m, d)| m / d.powi(3)).collect()
}

/// PBM-V2: what a stirred tank grows from seeds of one size, n ∝ exp(−(d − d₀)/(G τ)), in its steady state; to second order,
/// though the seeds come into one class.
#[test]
fn a_stirred_tank_has_an_exponential_distribution_of_numbers() {
    // Error of the mean size above the seeds, and the largest one of the shares of the number above some sizes.
    let errors = |grid: &SizeGrid| {
        let (masses, start) = seeded(grid, 0.03, |bed| bed);
        // Mass of n ∝ exp(−x/L), x = d − d₀: 4 times the seeds' mass gives L.
        let volume = |l: f64| {
            start.powi(3) + 3.0 * start * start * l + 6.0 * start * l * l + 6.0 * l.powi(3)
        };
        let mut length = 1e-4;
        for _ in 0..200 {
            length *= (4.0 * start.powi(3) / volume(length)).powf(0.2);
        }
        let number = numbers(grid, &masses);
        let all: f64 = number.iter().sum();
        let pairs = number.iter().zip(grid.diameters());
        let first: f64 = pairs.map(|(n, d)| n * (d - start)).sum();
        let off = |d: f64| {
            let class = grid.edges().partition_point(|edge| *edge <= d) - 1;
            let above: f64 = number[class..].iter().sum::<f64>() / all;
            let expected = (-(grid.edges()[class] - start) / length).exp();
            (above / expected - 1.0).abs()
        };
        let shares = [0.6e-3, 0.8e-3, 1.2e-3, 1.6e-3].map(off);
        let largest = shares.into_iter().fold(0.0, f64::max);
        [(first / all / length - 1.0).abs(), largest]
    };
    let uniform = [100, 200, 400].map(|classes| {
        let grid = SizeGrid::uniform(classes, 0.4e-3, 3.2e-3).unwrap();
        errors(&grid)
    });
    let geometric = errors(&SizeGrid::geometric(400, 0.4e-3, 3.2e-3).unwrap());
    println!("mean and shares: uniform {uniform:?}, geometric {geometric:?}");
    let order = (uniform[1][0] / uniform[2][0]).log2();
    assert!(order > 1.8, "{order}");
    for error in uniform[2].into_iter().chain(geometric) {
        assert!(error < 2e-3, "{error}");
    }
}

/// With G ∝ 1 + d/d₀ the steady numbers are n ∝ (1 + d/d₀)^(−1 − d₀/(G₀ τ)).
#[test]
fn linear_growth_gives_a_power_law() {
    let grid = SizeGrid::uniform(400, 0.4e-3, 3.2e-3).unwrap();
    let reference = 2e-3;
    let (masses, start) = seeded(&grid, 0.01, |bed| {
        bed.with_growth(Box::new(LinearGrowth { reference }))
    });
    let number = numbers(&grid, &masses);
    let all: f64 = number.iter().sum();
    // The share above d is ((1 + d/d₀)/(1 + d_s/d₀))^(−p): mass twice the seeds' gives p, by a fine sum of the cube.
    let ratio = |d: f64| (1.0 + d / reference) / (1.0 + start / reference);
    let mass = |p: f64| {
        let steps = 200_000;
        let width = (3.2e-3 - start) / f64::from(steps);
        let cube = |k: i32| {
            let d = start + (f64::from(k) + 0.5) * width;
            // −d(share)/dd by the middle of a step.
            (ratio(d - 0.5 * width).powf(-p) - ratio(d + 0.5 * width).powf(-p)) * d.powi(3)
        };
        (0..steps).map(cube).sum::<f64>() / start.powi(3)
    };
    let (mut low, mut high) = (5.0, 100.0);
    while high - low > 1e-6 {
        let middle = 0.5 * (low + high);
        if mass(middle) > 2.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    // Larger sizes still see the bed of the start, of which exp(−10) is left.
    for d in [0.65e-3, 0.8e-3, 0.9e-3, 1.0e-3, 1.1e-3] {
        let class = grid.edges().partition_point(|edge| *edge <= d) - 1;
        let share = number[class..].iter().sum::<f64>() / all;
        let p = -share.ln() / ratio(grid.edges()[class]).ln();
        println!("{d}: p {p} of {low}");
        assert!((p / low - 1.0).abs() < 2e-3, "{d}: {p} {low}");
    }
}

/// PBM-V3: without growth the distribution relaxes to the feed's, exp(−t/τ).
#[test]
fn without_growth_a_tank_relaxes_to_its_feed() {
    let grid = SizeGrid::uniform(50, 0.0, 5e-3).unwrap();
    let mut feed = vec![0.0; 50];
    feed[30] = 0.1;
    let mut content = vec![0.0; 50];
    content[10] = 20.0;
    for integrator in [Integrator::Explicit, Integrator::Stiff] {
        let plant = tank(grid.clone(), &feed, 0.0, |bed| bed, content.clone());
        let mut run = PlantRun::new(&plant, integrator, 1e-9).unwrap();
        run.advance(300.0).unwrap();
        let masses = run.unit(plant.unit("bed").unwrap());
        let expected = 20.0 * (-300.0f64 * 0.1 / 20.0).exp();
        assert!(
            (masses[10] / expected - 1.0).abs() < 1e-7,
            "{integrator:?} {}",
            masses[10]
        );
        let all = masses[10] + masses[30];
        println!("{integrator:?}: {all} kg");
        assert!((all - 20.0).abs() < 2e-11, "{all}");
        assert!(run.ledger().worst() < 1e-12, "{:#?}", run.ledger());
    }
}

/// What wears off is dust, and the balance closes.
#[test]
fn wear_makes_dust_and_closes() {
    let grid = SizeGrid::uniform(800, 0.0, 4e-3).unwrap();
    let feed = vec![0.0; 800];
    let mut content = vec![0.0; 800];
    content[400] = 10.0;
    let make = |bed: Granulator| batch(bed).with_wear(1e-7);
    let plant = tank(grid.clone(), &feed, 0.0, make, content);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-8).unwrap();
    run.advance(2000.0).unwrap();
    let masses = run.unit(plant.unit("bed").unwrap());
    let start = grid.diameters()[400];
    // All shrink by 0.2 mm; the scheme widens the peak, which changes the mean cube by 3 σ²/d².
    let expected = 10.0 * ((start - 2e-4) / start).powi(3);
    let all: f64 = masses.iter().sum();
    assert!((all / expected - 1.0).abs() < 5e-3, "{all} {expected}");
    assert!(run.ledger().worst() < 1e-12);
}
