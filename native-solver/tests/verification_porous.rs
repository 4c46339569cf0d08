//! Verification of the whole porous system by a manufactured solution: momentum with convection, friction
//! (transposed and volumetric parts of the stress included), pressure, gravity and drag, and enthalpy with
//! convection, conduction and exchange, in a closed box with walls that the gas sticks to.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use std::f64::consts::PI;

use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{Convection, GasPatch};

use crate::common::*;

/// Density in kg/m³, c_p in J/kg/K, viscosity in Pa s, conductivity in W/m/K.
const FLUID: [f64; 4] = [1.3, 2.0, 0.05, 0.4];
const GRAVITY: [f64; 3] = [0.5, 0.0, -2.0];

/// ∂f/∂x (axis 0) or ∂f/∂z (axis 2) by central differences of sixth order; 1e-11 of fields like these.
fn d(f: &dyn Fn(f64, f64) -> f64, axis: usize, x: f64, z: f64) -> f64 {
    let step = 5e-3;
    let at = |k: f64| {
        if axis == 0 {
            f(x + k * step, z)
        } else {
            f(x, z + k * step)
        }
    };
    let pair = |k: f64| at(k) - at(-k);
    (45.0 * pair(1.0) - 9.0 * pair(2.0) + pair(3.0)) / (60.0 * step)
}

fn pores(x: f64, z: f64) -> f64 {
    0.6 + 0.2 * (2.0 * x + 0.5).sin() * (1.5 * z).cos()
}

/// Superficial velocity: the curl of ψ = 0.3 sin²(πx) sin²(πz), zero on all four walls.
fn superficial(axis: usize, x: f64, z: f64) -> f64 {
    let (p, q) = (PI * x, PI * z);
    match axis {
        0 => 0.3 * PI * p.sin().powi(2) * (2.0 * q).sin(),
        2 => -0.3 * PI * (2.0 * p).sin() * q.sin().powi(2),
        _ => 0.0,
    }
}

fn velocity(axis: usize, x: f64, z: f64) -> f64 {
    superficial(axis, x, z) / pores(x, z)
}

fn pressure(x: f64, z: f64) -> f64 {
    (PI * x).cos() * (1.2 * z + 0.3).sin() + 0.4 * x * z
}

fn temperature(x: f64, z: f64) -> f64 {
    300.0 + 50.0 * (PI * x).cos() * (PI * z).cos()
}

/// K in kg/m³/s.
fn drag(x: f64, z: f64) -> f64 {
    4.0 * (1.0 + 0.5 * (3.0 * x).sin() * (2.0 * z).cos())
}

/// Heat exchanged in W/m³/K.
fn exchange(x: f64, z: f64) -> f64 {
    3.0 * (1.0 + 0.5 * (2.0 * x - z).cos())
}

/// εμ (∂u_i/∂x_j + ∂u_j/∂x_i − ⅔ δ_ij ∇·u).
fn stress(i: usize, j: usize, x: f64, z: f64) -> f64 {
    let slope = |i: usize, j: usize| d(&|x, z| velocity(i, x, z), j, x, z);
    let spread = if i == j {
        2.0 / 3.0 * (slope(0, 0) + slope(2, 2))
    } else {
        0.0
    };
    pores(x, z) * FLUID[2] * (slope(i, j) + slope(j, i) - spread)
}

/// The force on the gas in N/m³, drag coefficient times zero included, that makes these fields a solution:
/// ρ (U·∇)u − ∇·τ + ε∇p − ερg + K u.
fn force(i: usize, x: f64, z: f64) -> f64 {
    let [density, ..] = FLUID;
    let along = |j: usize| superficial(j, x, z) * d(&|x, z| velocity(i, x, z), j, x, z);
    let friction = |j: usize| d(&|x, z| stress(i, j, x, z), j, x, z);
    density * (along(0) + along(2)) - friction(0) - friction(2)
        + pores(x, z) * (d(&pressure, i, x, z) - density * GRAVITY[i])
        + drag(x, z) * velocity(i, x, z)
}

/// The heat into the gas in W/m³ that makes these fields a solution: ρ c_p U·∇T − ∇·(εκ∇T) + k T.
fn heat(x: f64, z: f64) -> f64 {
    let [density, capacity, _, conductivity] = FLUID;
    let along = |j: usize| superficial(j, x, z) * d(&temperature, j, x, z);
    let flux = |j: usize| {
        let flux = move |x: f64, z: f64| pores(x, z) * conductivity * d(&temperature, j, x, z);
        d(&flux, j, x, z)
    };
    density * capacity * (along(0) + along(2)) - flux(0) - flux(2)
        + exchange(x, z) * temperature(x, z)
}

/// RMS errors of velocity in m/s, pressure in Pa and temperature in K on n × n cells.
fn errors(n: usize, convection: Convection) -> [f64; 3] {
    let patches = ["wall", "wall", "side", "side", "wall", "wall"];
    let mesh = named_box([1.0, 1.0, 1.0], [n, 1, n], patches);
    let mut setup = setup(&[("wall", no_slip()), ("side", GasPatch::Symmetry)]);
    let [density, capacity, viscosity, conductivity] = FLUID;
    setup.properties = fluid(density, capacity, viscosity, conductivity);
    setup.gravity = GRAVITY.into();
    setup.controls.convection = convection;
    setup.controls.outer_iterations = 3;
    let mut driver = Driver::new(&mesh, &setup);
    for cell in 0..mesh.cells() {
        let (centre, volume) = (mesh.cell_centre()[cell], mesh.cell_volume()[cell]);
        let (x, z) = (centre.x, centre.z);
        driver.bed.void_fraction[cell] = pores(x, z);
        driver.exchange.drag_coefficient[cell] = volume * drag(x, z);
        driver.exchange.drag_source[cell] = volume * Vec3::new(force(0, x, z), 0.0, force(2, x, z));
        driver.exchange.heat_coefficient[cell] = volume * exchange(x, z);
        driver.exchange.heat_source[cell] = volume * heat(x, z);
    }
    let mut last = f64::INFINITY;
    for _ in 0..400 {
        driver.window(0.05, 2.0);
        let fields = driver.gas.fields();
        let sum: f64 = fields.velocity.iter().map(|u| u.norm_squared()).sum();
        let warmth: f64 = fields.temperature.iter().sum();
        let now = sum + 1e-3 * warmth;
        if (now / last - 1.0).abs() < 1e-9 {
            break;
        }
        last = now;
    }
    let fields = driver.gas.fields();
    let at = |cell: usize| (mesh.cell_centre()[cell].x, mesh.cell_centre()[cell].z);
    let cells = mesh.cells() as f64;
    let offset = (0..mesh.cells())
        .map(|cell| fields.pressure[cell] - pressure(at(cell).0, at(cell).1))
        .sum::<f64>()
        / cells;
    let speed = |cell: usize| {
        let (x, z) = at(cell);
        let exact = Vec3::new(velocity(0, x, z), 0.0, velocity(2, x, z));
        (fields.velocity[cell] - exact).norm()
    };
    let push = |cell: usize| fields.pressure[cell] - offset - pressure(at(cell).0, at(cell).1);
    let warmth = |cell: usize| fields.temperature[cell] - temperature(at(cell).0, at(cell).1);
    [rms(&mesh, speed), rms(&mesh, push), rms(&mesh, warmth)]
}

#[test]
fn the_porous_momentum_and_energy_system_converges_to_a_manufactured_solution() {
    for (convection, least) in [(Convection::VanLeer, 1.7), (Convection::Central(1.0), 1.8)] {
        let found = [16, 32, 64].map(|n| errors(n, convection));
        let of = |k: usize| orders(&found.map(|errors| errors[k]));
        println!("{convection:?}: errors {found:?}");
        println!("orders: u {:.2?}, p {:.2?}, T {:.2?}", of(0), of(1), of(2));
        for k in 0..3 {
            assert!(of(k)[1] > least, "{convection:?}, field {k}: {:?}", of(k));
        }
    }
}
