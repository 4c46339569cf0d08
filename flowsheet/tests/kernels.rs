//! Aggregation and breakage against closed forms (docs/theory.md, PBM-6).

use calcine_flowsheet::population::{
    Aggregation, AggregationKernel, ConstantKernel, ParticleBreakage, PowerBreakage, ProductKernel,
    RandomBinary, SizeProcess, SumKernel, TabulatedKernel,
};
use calcine_flowsheet::units::{BedLevel, Granulator};
use calcine_flowsheet::{Integrator, Plant, PlantError, PlantRun, SizeGrid};
use calcine_physics::sphere::volume_of_diameter;

use crate::growth::{DENSITY, tank};

/// Particles at the start, and their mean volume in m³.
const COUNT: f64 = 1e6;
const MEAN: f64 = 5e-10;
/// How long everything takes in s.
const SPAN: f64 = 100.0;

type Process = Box<dyn Fn() -> Box<dyn SizeProcess>>;

struct Found {
    grid: SizeGrid,
    /// Particles by class.
    numbers: Vec<f64>,
    /// Moments relative to the start's.
    moments: [f64; 3],
    mass_error: f64,
}

/// A bed of an exponential distribution of volumes between 2^low and 2^high mean volumes, and its numbers at the start.
fn filled(
    per_doubling: usize,
    low: i32,
    high: i32,
    spray: f64,
    processes: &[Process],
) -> (Plant, Vec<f64>) {
    let doublings = usize::try_from(high - low).unwrap();
    let diameter = |power: i32| (6.0 / std::f64::consts::PI * MEAN * 2f64.powi(power)).cbrt();
    let grid =
        SizeGrid::geometric(per_doubling * doublings, diameter(low), diameter(high)).unwrap();
    let volumes: Vec<f64> = grid
        .diameters()
        .iter()
        .map(|d| volume_of_diameter(*d))
        .collect();
    let below = |d: f64| -(-volume_of_diameter(d) / MEAN).exp_m1();
    let start: Vec<f64> = grid
        .edges()
        .windows(2)
        .map(|edge| COUNT * (below(edge[1]) - below(edge[0])))
        .collect();
    let mass = |n: &f64, v: &f64| n * v * DENSITY;
    let content: Vec<f64> = start
        .iter()
        .zip(&volumes)
        .map(|(n, v)| mass(n, v))
        .collect();
    let make = |bed: Granulator| {
        let bed = bed.with_level(BedLevel::Residence(1e300));
        processes
            .iter()
            .fold(bed, |bed, process| bed.with_process(process()))
    };
    let none = vec![0.0; grid.classes()];
    (tank(grid.clone(), &none, spray, make, content), start)
}

/// What becomes of it.
fn batch(per_doubling: usize, low: i32, high: i32, spray: f64, processes: &[Process]) -> Found {
    let (plant, start) = filled(per_doubling, low, high, spray, processes);
    let grid = plant.layout().grid().clone();
    let volumes: Vec<f64> = grid
        .diameters()
        .iter()
        .map(|d| volume_of_diameter(*d))
        .collect();
    let before: f64 = start
        .iter()
        .zip(&volumes)
        .map(|(n, v)| n * v * DENSITY)
        .sum();
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-7).unwrap();
    run.advance(SPAN).unwrap();
    let masses = run.unit(plant.unit("bed").unwrap());
    let numbers: Vec<f64> = masses
        .iter()
        .zip(&volumes)
        .map(|(m, v)| m / (v * DENSITY))
        .collect();
    let moment = |numbers: &[f64], power: i32| -> f64 {
        numbers
            .iter()
            .zip(&volumes)
            .map(|(n, v)| n * v.powi(power))
            .sum()
    };
    let after: f64 = masses.iter().sum();
    Found {
        moments: [0, 1, 2].map(|power| moment(&numbers, power) / moment(&start, power)),
        numbers,
        grid,
        mass_error: ((after - before - spray * SPAN) / after).abs(),
    }
}

impl Found {
    /// Σ |N_i − exact| relative to Σ exact, with the exact number of particles below a volume.
    fn off(&self, below: impl Fn(f64) -> f64) -> f64 {
        let edges = self.grid.edges().windows(2);
        let (mut apart, mut sum) = (0.0, 0.0);
        for (number, edge) in self.numbers.iter().zip(edges) {
            let exact = below(volume_of_diameter(edge[1])) - below(volume_of_diameter(edge[0]));
            apart += (number - exact).abs();
            sum += exact;
        }
        apart / sum
    }
}

fn aggregation<K: AggregationKernel + Clone + 'static>(kernel: K) -> Process {
    Box::new(move || Box::new(Aggregation::new(Box::new(kernel.clone()))))
}

fn orders(errors: &[f64]) -> Vec<f64> {
    errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect()
}

/// τ = N₀ β₀ t = 20: N = N₀/11, M₂ = 11 M₂(0), and the distribution stays exponential.
#[test]
fn a_constant_kernel_makes_a_wider_exponential_distribution() {
    let tau = 20.0;
    let (mut second, mut shape) = (Vec::new(), Vec::new());
    for per_doubling in [4, 8, 16] {
        let kernel = ConstantKernel {
            rate: tau / (COUNT * SPAN),
        };
        let found = batch(per_doubling, -14, 10, 0.0, &[aggregation(kernel)]);
        let errors = [
            found.moments[0] * (2.0 + tau) / 2.0 - 1.0,
            found.moments[2] / (1.0 + tau / 2.0) - 1.0,
            found.off(|v| -COUNT * 2.0 / (2.0 + tau) * (-2.0 * v / (MEAN * (2.0 + tau))).exp_m1()),
        ];
        println!(
            "constant, {per_doubling} per doubling: M0 M2 L1 {errors:?}, M1 {:e}",
            found.mass_error
        );
        assert!(found.mass_error < 1e-13);
        if per_doubling == 8 {
            assert!(
                errors[0].abs() <= 3e-3 && errors[1].abs() <= 1e-2,
                "{errors:?}"
            );
            assert!(errors[2] <= 5e-3, "{errors:?}");
        }
        second.push(errors[1].abs());
        shape.push(errors[2]);
    }
    println!(
        "orders of M2 {:?}, of L1 {:?}",
        orders(&second),
        orders(&shape)
    );
    assert!(orders(&second)[1] >= 1.9 && orders(&shape)[1] >= 1.9);
}

/// τ = N₀ v₀ β₀ t = 2: N = N₀ e^(−2), M₂ = M₂(0) e⁴.
#[test]
fn a_sum_kernel_keeps_its_moments() {
    let tau: f64 = 2.0;
    let mut errors = Vec::new();
    for per_doubling in [4, 8, 16] {
        let kernel = SumKernel {
            rate: tau / (COUNT * MEAN * SPAN),
        };
        let found = batch(per_doubling, -14, 13, 0.0, &[aggregation(kernel)]);
        let [zeroth, second] = [
            found.moments[0] * tau.exp() - 1.0,
            found.moments[2] / (2.0 * tau).exp() - 1.0,
        ];
        println!(
            "sum, {per_doubling} per doubling: M0 {zeroth:e}, M2 {second:e}, M1 {:e}",
            found.mass_error
        );
        assert!(found.mass_error < 1e-13);
        if per_doubling == 8 {
            assert!(zeroth.abs() <= 3e-3 && second.abs() <= 1e-2);
        }
        errors.push(zeroth.abs());
    }
    println!("orders of M0 {:?}", orders(&errors));
    assert!(orders(&errors)[1] >= 1.9);
}

/// τ = N₀ v₀² β₀ t = ¼, halfway to gelation: N = 7/8 N₀, M₂ = 2 M₂(0).
#[test]
fn a_product_kernel_keeps_its_moments_before_it_gels() {
    let mut errors = Vec::new();
    for per_doubling in [4, 8, 16] {
        let kernel = ProductKernel {
            rate: 0.25 / (COUNT * MEAN * MEAN * SPAN),
        };
        let found = batch(per_doubling, -18, 9, 0.0, &[aggregation(kernel)]);
        let [zeroth, second] = [found.moments[0] / 0.875 - 1.0, found.moments[2] / 2.0 - 1.0];
        println!(
            "product, {per_doubling} per doubling: M0 {zeroth:e}, M2 {second:e}, M1 {:e}",
            found.mass_error
        );
        assert!(found.mass_error < 1e-13);
        if per_doubling == 8 {
            assert!(zeroth.abs() <= 3e-3 && second.abs() <= 1e-2);
        }
        errors.push(zeroth.abs());
    }
    println!("orders of M0 {:?}", orders(&errors));
    assert!(orders(&errors)[1] >= 1.9);
}

/// N = N₀ (1 + S₀ v₀ t), and the distribution stays exponential.
#[test]
fn random_binary_breakage_makes_a_narrower_exponential_distribution() {
    let process = || -> Box<dyn SizeProcess> {
        Box::new(ParticleBreakage::new(Box::new(RandomBinary {
            rate: 10.0 / (MEAN * SPAN),
        })))
    };
    let found = batch(8, -18, 6, 0.0, &[Box::new(process)]);
    let number = found.moments[0] / 11.0 - 1.0;
    let off = found.off(|v| -COUNT * 11.0 * (-11.0 * v / MEAN).exp_m1());
    println!(
        "breakage: M0 {number:e}, L1 {off:e}, M1 {:e}",
        found.mass_error
    );
    assert!(number.abs() < 1e-2 && off < 1e-2);
    assert!(found.mass_error < 1e-12);
}

/// Three fragments a breakage at a rate in proportion to volume: N = N₀ (1 + 2 S₀ t v₀/v_reference).
#[test]
fn breakage_into_three_makes_two_particles_more_each_time() {
    let law = PowerBreakage {
        rate: 3.0 / SPAN,
        reference: (6.0 / std::f64::consts::PI * MEAN).cbrt(),
        power: 1.0,
        fragments: 1.5,
    };
    let process =
        move || -> Box<dyn SizeProcess> { Box::new(ParticleBreakage::new(Box::new(law))) };
    let found = batch(8, -24, 6, 0.0, &[Box::new(process)]);
    let number = found.moments[0] / 7.0 - 1.0;
    println!(
        "breakage into three: M0 {number:e}, M1 {:e}",
        found.mass_error
    );
    assert!(number.abs() < 1e-2 && found.mass_error < 1e-12);
}

/// A table of the sum kernel does what the sum kernel does.
#[test]
fn a_kernel_by_a_table_does_what_its_law_does() {
    let rate = 1.0 / (COUNT * MEAN * SPAN);
    let ends = [-14, 10].map(|power| (6.0 / std::f64::consts::PI * MEAN * 2f64.powi(power)).cbrt());
    let points = SizeGrid::geometric(200, ends[0], ends[1])
        .unwrap()
        .edges()
        .to_vec();
    let law = SumKernel { rate };
    let volumes: Vec<f64> = points.iter().map(|d| volume_of_diameter(*d)).collect();
    let rates = volumes
        .iter()
        .flat_map(|u| volumes.iter().map(|v| law.rate(*u, *v)));
    let table = TabulatedKernel::new(points.clone(), rates.collect(), "bed").unwrap();
    let by_law = batch(4, -14, 10, 0.0, &[aggregation(law)]);
    let by_table = batch(4, -14, 10, 0.0, &[aggregation(table)]);
    for (a, b) in by_law.moments.iter().zip(&by_table.moments) {
        println!("by law {a}, by table {b}");
        assert!((a / b - 1.0).abs() < 3e-3, "{a} {b}");
    }
}

/// Past τ = ½ a product kernel has no distribution: the run ends with a message that names the kernel's degree.
#[test]
fn a_kernel_that_gels_is_told() {
    let kernel = ProductKernel {
        rate: 1.0 / (COUNT * MEAN * MEAN * SPAN),
    };
    let (plant, _) = filled(4, -14, 9, 0.0, &[aggregation(kernel)]);
    let mut run = PlantRun::new(&plant, Integrator::Explicit, 1e-6).unwrap();
    let told = run.advance(SPAN).unwrap_err();
    println!("at {} s: {told}", run.time());
    assert!((0.4..0.75).contains(&(run.time() / SPAN)), "{}", run.time());
    let PlantError::Gels { degree, .. } = &told else {
        panic!("{told}");
    };
    assert!((degree - 2.0).abs() < 1e-12, "{told}");
}

/// N∞ = √(2 S₀ M₁/β₀).
#[test]
fn aggregation_and_breakage_come_to_rest_at_their_number() {
    let (kernel, rate) = (80.0 / (COUNT * SPAN), 20.0 / (MEAN * SPAN));
    let breakage = move || -> Box<dyn SizeProcess> {
        Box::new(ParticleBreakage::new(Box::new(RandomBinary { rate })))
    };
    let both = [
        aggregation(ConstantKernel { rate: kernel }),
        Box::new(breakage),
    ];
    let found = batch(8, -16, 7, 0.0, &both);
    let expected = (2.0 * rate * COUNT * MEAN / kernel).sqrt();
    let number: f64 = found.numbers.iter().sum();
    println!("aggregation and breakage: N {number}, expected {expected}");
    assert!((number / expected - 1.0).abs() < 1e-2);
    assert!(found.mass_error < 1e-12);
}

/// Growth takes no part in N = 2 N₀/(2 + τ), and brings the spray's mass.
#[test]
fn growth_beside_aggregation_keeps_number_and_mass() {
    let kernel = ConstantKernel {
        rate: 2.0 / (COUNT * SPAN),
    };
    let spray = 0.5 * COUNT * MEAN * DENSITY / SPAN;
    let found = batch(8, -12, 8, spray, &[aggregation(kernel)]);
    println!(
        "growth and aggregation: N {:e}, M1 {:e}",
        found.moments[0] / 0.5 - 1.0,
        found.mass_error
    );
    assert!((found.moments[0] / 0.5 - 1.0).abs() < 1e-2);
    assert!(found.mass_error < 1e-12);
}
