//! The exchange alone, with a gas of uncoupled cells in which the exact answer is a small linear
//! system: conservation whatever the iterate, convergence of the iteration, stability where the
//! particle's own time is short.

#![allow(clippy::unwrap_used)]

use calcine_coupler::closures::CouplingCoefficients;
use calcine_coupler::exchange::{Exchange, ExchangeInputs};
use calcine_coupler::interior::{
    At, GasLines, NetworkHeat, Newcomer, ParticleModel, Surroundings, TEMPERATURE, Thin, Transfer,
};
use calcine_coupler::mapping::{Mapper, Method};
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{CellReceived, GasFields, ParticleFields};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::film::{FilmTemperature, FilmTheory, StefanFlow};
use calcine_coupler::physics::solid::HeatCapacity;
use calcine_coupler::smoother::{Operator, Smoother, SmootherSettings};

/// A gas of cells that only store heat and momentum: c dT/dt = S − H T, m du/dt = S_u − K u.
struct StillGas {
    capacity: f64,
    mass: f64,
    start_temperature: Vec<f64>,
    start_velocity: Vec<Vec3>,
    temperature: Vec<f64>,
    velocity: Vec<Vec3>,
    zero: Vec<f64>,
    zero_vector: Vec<Vec3>,
}

impl StillGas {
    fn new(cells: usize) -> Self {
        let start_temperature: Vec<f64> = (0..cells).map(|c| 300.0 + 7.0 * c as f64).collect();
        let start_velocity: Vec<Vec3> = (0..cells)
            .map(|c| Vec3::new(0.1 * c as f64, 0.5, -0.02 * c as f64))
            .collect();
        Self {
            capacity: 2e-3,
            mass: 1e-3,
            temperature: start_temperature.clone(),
            velocity: start_velocity.clone(),
            start_temperature,
            start_velocity,
            zero: vec![1.0; cells],
            zero_vector: vec![Vec3::zeros(); cells],
        }
    }

    fn fields(&self) -> GasFields<'_> {
        GasFields {
            composition: &[],
            temperature: &self.temperature,
            pressure: &self.zero,
            density: &self.zero,
            velocity: &self.velocity,
            pressure_gradient: &self.zero_vector,
            turbulence: Default::default(),
        }
    }

    /// One implicit step from the start; `beyond` is what a solver's tolerance adds, in W.
    fn attempt(
        &mut self,
        exchange: &Exchange,
        span: f64,
        beyond: f64,
        received: &mut CellReceived,
    ) {
        let cells = &exchange.cells;
        received.heat.clear();
        received.drag.clear();
        for c in 0..self.temperature.len() {
            let (h, k) = (cells.heat_coefficient[c], cells.drag_coefficient[c]);
            self.temperature[c] = (self.capacity * self.start_temperature[c]
                + span * cells.heat_source[c])
                / (self.capacity + span * h);
            self.velocity[c] = (self.mass * self.start_velocity[c] + span * cells.drag_source[c])
                / (self.mass + span * k);
            let extra = if h > 0.0 { beyond } else { 0.0 };
            received
                .heat
                .push(cells.heat_source[c] - h * self.temperature[c] + extra);
            received
                .drag
                .push(cells.drag_source[c] - k * self.velocity[c]);
        }
    }
}

struct Bench {
    operator: Operator,
    ids: Vec<u64>,
    population: Vec<u32>,
    position: Vec<Vec3>,
    velocity: Vec<Vec3>,
    radius: Vec<f64>,
}

impl Bench {
    /// Two overlapping-free spheres that each span several cells of a row.
    fn new() -> Self {
        let mesh: Mesh = box_mesh(&BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(8e-3, 2e-3, 2e-3),
            cells: [8, 1, 1],
            patches: ["a", "b", "side", "side", "side", "side"].map(String::from),
        })
        .unwrap();
        let position = vec![Vec3::new(2.1e-3, 1e-3, 1e-3), Vec3::new(4.3e-3, 1e-3, 1e-3)];
        let radius = vec![0.9e-3, 0.9e-3];
        let weights = Mapper::new(&mesh)
            .fill(Method::Overlap, &position, &radius)
            .unwrap();
        let settings = SmootherSettings {
            max_solid_fraction: 0.9,
            tolerance: 1e-6,
            diffusion_length: None,
        };
        let volume: Vec<f64> = radius
            .iter()
            .map(|r: &f64| 4.0 / 3.0 * std::f64::consts::PI * r.powi(3))
            .collect();
        let operator = Smoother::new(&mesh, settings)
            .unwrap()
            .operator(weights, &volume)
            .unwrap();
        Self {
            operator,
            ids: vec![1, 2],
            population: vec![0, 0],
            position,
            velocity: vec![Vec3::new(0.3, 0.0, 0.0), Vec3::zeros()],
            radius,
        }
    }

    fn fields(&self) -> ParticleFields<'_> {
        ParticleFields {
            id: &self.ids,
            population: &self.population,
            position: &self.position,
            velocity: &self.velocity,
            angular_velocity: &self.velocity,
            radius: &self.radius,
            mass: &self.radius,
            weight: &[],
        }
    }
}

/// Repeats the window and returns the misplaced share after each attempt.
fn attempts(
    conductance: f64,
    span: f64,
    count: usize,
    beyond: f64,
) -> (Vec<f64>, Exchange, CellReceived, Thin, StillGas) {
    attempts_from(
        (StillGas::new(8), [400.0, 350.0]),
        conductance,
        span,
        count,
        beyond,
    )
}

/// The same from a gas and the temperatures of the particles in K.
fn attempts_from(
    (mut gas, particles): (StillGas, [f64; 2]),
    conductance: f64,
    span: f64,
    count: usize,
    beyond: f64,
) -> (Vec<f64>, Exchange, CellReceived, Thin, StillGas) {
    let bench = Bench::new();
    let mut thin = Thin::new(HeatCapacity::constant(1.0));
    for (id, mass, kelvin) in [(1, 5e-3, particles[0]), (2, 8e-3, particles[1])] {
        let state: [(&str, &[f64]); 1] = [(TEMPERATURE, &[kelvin])];
        let radius = bench.radius[0];
        let one = Newcomer {
            id,
            mass,
            radius,
            state: &state,
        };
        thin.change(&[], &[one]).unwrap();
    }
    let coefficients = CouplingCoefficients {
        drag: vec![1e-3, 2e-3],
        conductance: vec![conductance; 2],
        ..CouplingCoefficients::default()
    };
    let mut exchange = Exchange::default();
    let mut lines = GasLines::default();
    let mut received = CellReceived::default();
    let mut shares = Vec::new();
    for _ in 0..count {
        let inputs = ExchangeInputs {
            operator: &bench.operator,
            particles: bench.fields(),
            coefficients: &coefficients,
            acceleration: 3.0,
        };
        exchange.begin(&inputs, &gas.fields());
        let around = Surroundings {
            temperature: exchange.sampled_temperature(),
            pressure: &[],
            composition: &[],
            conductance: &coefficients.conductance,
            film: &[],
            theory: FilmTheory {
                temperature: FilmTemperature::Gas,
                stefan_flow: StefanFlow::None,
            },
            radius: &bench.radius,
            end: 0.0,
        };
        lines.reset(2, 0);
        let alone = [NetworkHeat::default(); 2];
        thin.respond(&around, span, &alone, &mut lines).unwrap();
        exchange.conductance.clone_from(&lines.conductance);
        let temperature = &lines.temperature;
        exchange.linearise(&inputs, temperature);
        gas.attempt(&exchange, span, beyond, &mut received);
        let share = exchange.credit_heat(&inputs, temperature, &gas.fields(), &received, &[]);
        exchange.credit_drag(&inputs, &gas.fields(), &received);
        let took = Transfer {
            heat: &exchange.heat,
            network: &[0.0; 2],
            carried: &[],
            rates: &[],
        };
        thin.settle(&took, span).unwrap();
        shares.push(share);
    }
    (shares, exchange, received, thin, gas)
}

#[test]
fn what_the_gas_gets_the_particles_give_whatever_the_iterate() {
    for count in [1, 2, 7] {
        let (_, exchange, received, ..) = attempts(0.02, 0.5, count, 0.0);
        let heat: f64 = received.heat.iter().chain(&exchange.heat).sum();
        let magnitude: f64 = received.heat.iter().map(|q| q.abs()).sum();
        assert!(heat.abs() < 1e-13 * magnitude, "{heat} of {magnitude}");
        let force = received.drag.iter().sum::<Vec3>() + exchange.drag.iter().sum::<Vec3>();
        let magnitude: f64 = received.drag.iter().map(|f| f.norm()).sum();
        assert!(force.norm() < 1e-13 * magnitude, "{force} of {magnitude}");
    }
}

#[test]
fn what_a_solver_exchanges_beyond_its_formula_is_credited_to_the_particles_of_the_cell() {
    let (_, exchange, received, ..) = attempts(0.02, 0.5, 2, 1e-3);
    let heat: f64 = received.heat.iter().chain(&exchange.heat).sum();
    let magnitude: f64 = received.heat.iter().map(|q| q.abs()).sum();
    assert!(heat.abs() < 1e-13 * magnitude, "{heat} of {magnitude}");
}

#[test]
fn the_iteration_converges_to_the_coupled_system_of_cells_and_particles() {
    let (shares, exchange, _, thin, gas) = attempts(0.02, 0.5, 60, 0.0);
    assert!(shares[59] < 1e-12, "{shares:?}");
    assert!(
        shares[0] > 1e-3,
        "the first attempt must be off for this test to say something"
    );
    // Q_p = h A (T̄_p − T_p) with both temperatures new is the coupled system's definition.
    let mut seen = vec![0.0; 2];
    Bench::new().operator.sample(&gas.temperature, &mut seen);
    for ((seen, own), heat) in seen
        .iter()
        .zip(thin.bodies(At::Attempt).temperature)
        .zip(&exchange.heat)
    {
        let expected = 0.02 * (seen - own);
        assert!((heat - expected).abs() < 1e-10 * expected.abs());
    }
}

#[test]
fn a_bed_within_the_gas_own_tolerance_of_equilibrium_counts_as_settled_and_one_three_millikelvin_off_does_not()
 {
    // The default of `coupling.exchange.tolerance`.
    const TOLERANCE: f64 = 1e-3;
    // The same bed with all differences of temperature scaled down: without a limit the share would be the same.
    let first = |kelvin: f64| {
        let mut gas = StillGas::new(8);
        for c in 0..8 {
            gas.start_temperature[c] = 350.0 + kelvin * (c as f64 - 3.5) / 3.5;
        }
        gas.temperature.clone_from(&gas.start_temperature);
        let particles = [350.0 + kelvin, 350.0];
        attempts_from((gas, particles), 0.02, 0.5, 1, 0.0).0[0]
    };
    // What a gas of 350 K may be off where its outer loop ends at the default residual of 1e-8.
    let noise = first(350.0 * 1e-8);
    assert!(noise < TOLERANCE, "{noise:e}");
    // Three millikelvin are a difference that results show; its heat must come to its cells.
    let shown = first(3e-3);
    assert!(shown > TOLERANCE, "{shown:e}");
}

#[test]
fn no_cell_is_driven_beyond_its_particle_and_its_neighbours() {
    // Gas from 300 to 349 K, particles of 400 and 350 K: nothing may leave 300 to 400 K. A share of
    // each particle's total in each of its cells would cool the coldest ones below 300 K, or heat
    // hot ones by particles that are colder.
    for (conductance, span) in [(1e-3, 0.1), (0.02, 0.5), (0.5, 0.01), (100.0, 0.5)] {
        let (.., thin, gas) = attempts(conductance, span, 3, 0.0);
        for &temperature in thin
            .bodies(At::Attempt)
            .temperature
            .iter()
            .chain(&gas.temperature)
        {
            assert!(
                (300.0 - 1e-9..=400.0 + 1e-9).contains(&temperature),
                "{temperature}"
            );
        }
    }
}

#[test]
fn a_stiff_particle_relaxes_without_overshoot() {
    // h A Δτ/(m c) = 1e4: a lagged particle temperature would diverge (docs/theory.md, TSM-9).
    let (.., thin, gas) = attempts(100.0, 0.5, 200, 0.0);
    for &temperature in thin
        .bodies(At::Attempt)
        .temperature
        .iter()
        .chain(&gas.temperature)
    {
        assert!((290.0..410.0).contains(&temperature), "{temperature}");
    }
}

#[test]
fn stiff_drag_relaxes_a_free_particle_and_leaves_a_held_one_its_full_drag() {
    use calcine_coupler::closures::DragInertia;
    let (mass, drag, span) = (1e-6, 1e-3, 1e-2);
    // One is free under its weight alone, one lies on others that take up its drag, one is frozen.
    let wind = Vec3::new(0.0, 0.0, 0.4);
    let weight = Vec3::new(0.0, 0.0, -9.81e-6);
    let held = -drag * wind;
    let mut coefficients = CouplingCoefficients {
        drag: vec![drag; 3],
        conductance: vec![0.0; 3],
        ..CouplingCoefficients::default()
    };
    coefficients.relax(&DragInertia {
        mass: &[mass; 3],
        free: &[true, true, false],
        other: &[weight, held, weight],
        span,
        acceleration: 1.0,
    });
    // m dv/dt = K (u - v) + F from rest: v(t) = (u + F/K)(1 - exp(-K t/m)), here after ten of its times.
    let exact = (wind + weight / drag) * (1.0 - (-10.0f64).exp());
    let velocity = (coefficients.drag_at(0, wind) + weight) * span / mass;
    assert!((velocity - exact).norm() < 1e-12, "{velocity} {exact}");
    assert!((coefficients.drag_at(1, wind) - drag * wind).norm() < 1e-18);
    assert!((coefficients.drag_at(2, wind) - drag * wind).norm() < 1e-18);
}
