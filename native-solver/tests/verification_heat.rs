//! Verification of the enthalpy equation against exact solutions, with observed orders: advection
//! and diffusion, conduction in time, heat through walls, a closed box.
#![allow(clippy::unwrap_used, clippy::print_stdout, clippy::needless_range_loop)]

use std::f64::consts::PI;

use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GAS_CONSTANT;
use calcine_coupler::setup::{Convection, InletFlow, InletScalars, Schedule, TimeScheme, WallHeat};

use crate::common::*;

/// RMS error in K of a steady profile T = 300 + 100 sin(π z/2L), made by a heat source, in a duct
/// of L = 1 m at a Péclet number of 20, void fraction 0.7.
fn advection_error(cells: usize, convection: Convection) -> f64 {
    let mesh = duct([0.1, 0.1, 1.0], [1, 1, cells]);
    let (density, capacity, conductivity) = (2.0, 500.0, 10.0);
    let mut setup = setup(&[
        ("bottom", holding_inlet(0.2, 300.0)),
        ("top", outlet()),
        ("side", slip()),
    ]);
    setup.properties = fluid(density, capacity, 1e-3, conductivity);
    setup.controls.convection = convection;
    setup.controls.outer_iterations = 200;
    let mut driver = Driver::new(&mesh, &setup);
    driver.bed.void_fraction.fill(0.7);
    let k = PI / 2.0;
    let exact = |z: f64| 300.0 + 100.0 * (k * z).sin();
    // Flow of heat in W/m² along z: ρ U c_p T − ε κ dT/dz; the source of a cell is its rise.
    let flow = |z: f64| {
        density * 0.2 * capacity * exact(z) - 0.7 * conductivity * 100.0 * k * (k * z).cos()
    };
    let h = 1.0 / cells as f64;
    for cell in 0..cells {
        let z = mesh.cell_centre()[cell].z;
        driver.exchange.heat_source[cell] = 0.01 * (flow(z + 0.5 * h) - flow(z - 0.5 * h));
    }
    for _ in 0..4 {
        driver.window(1.0, 1e6);
    }
    let temperature = driver.gas.fields().temperature;
    rms(&mesh, |cell| {
        temperature[cell] - exact(mesh.cell_centre()[cell].z)
    })
}

#[test]
fn advection_with_diffusion_converges_with_second_order_by_van_leer_and_first_by_upwind() {
    for (convection, order, close) in [
        (Convection::VanLeer, 2.0, 0.1),
        (Convection::LimitedLinear(1.0), 2.0, 0.1),
        (Convection::Upwind, 1.0, 0.1),
    ] {
        let errors = [40, 80, 160, 320].map(|cells| advection_error(cells, convection));
        let found = orders(&errors);
        println!("{convection:?}: errors {errors:?} K, orders {found:?}");
        assert!((found[2] - order).abs() < close, "{convection:?} {found:?}");
    }
}

/// Lowest and highest temperature in K at any time of a front of 400 K that pushes 300 K out of a duct, its conduction small.
fn front(convection: Convection) -> (f64, f64) {
    let mesh = duct([0.1, 0.1, 1.0], [1, 1, 40]);
    let mut setup = setup(&[
        ("bottom", holding_inlet(0.5, 400.0)),
        ("top", outlet()),
        ("side", slip()),
    ]);
    setup.properties = fluid(2.0, 500.0, 1e-3, 1e-6);
    setup.controls.convection = convection;
    setup.controls.outer_iterations = 200;
    setup.controls.outer_tolerance = 1e-10;
    let mut driver = Driver::new(&mesh, &setup);
    let (mut lowest, mut highest) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..60 {
        driver.window(0.02, 1.0);
        for temperature in driver.gas.fields().temperature {
            (lowest, highest) = (lowest.min(*temperature), highest.max(*temperature));
        }
    }
    (lowest, highest)
}

#[test]
fn a_front_makes_no_new_extrema_by_van_leer_and_limited_linear_and_does_by_central() {
    for convection in [Convection::VanLeer, Convection::LimitedLinear(1.0)] {
        let (lowest, highest) = front(convection);
        println!("{convection:?}: {lowest} to {highest} K");
        assert!(
            lowest > 300.0 - 1e-6 && highest < 400.0 + 1e-6,
            "{convection:?}: {lowest} to {highest} K"
        );
    }
    let (lowest, highest) = front(Convection::Central(1.0));
    println!("central: {lowest} to {highest} K");
    assert!(lowest < 299.0 || highest > 401.0, "{lowest} to {highest}");
}

/// Error in K at t = 1 s of a box heated by a source A(T − 300)-shaped as the first mode between
/// walls of 300 K, in so many windows.
///
/// On n cells the first mode sin(π x/L) is an eigenvector of the discrete operator with
/// λ = 4 κ/h² sin²(π h/2L), so that what is left is the error in time alone:
/// T − 300 = q/λ (1 − exp(−λ t/ρ c)) sin(π x/L).
fn conduction_in_time(windows: usize) -> f64 {
    let n = 10;
    let patches = ["cold", "cold", "side", "side", "bottom", "top"];
    let mesh = named_box([0.1, 0.1, 0.1], [n, 1, 1], patches);
    let walls = warm_wall(300.0);
    let mut setup = setup(&[
        ("cold", walls),
        ("side", slip()),
        ("bottom", slip()),
        ("top", slip()),
    ]);
    let (pores, density, capacity, conductivity) = (0.6, 10.0, 100.0, 2.0);
    setup.properties = fluid(density, capacity, 1e-3, conductivity);
    let mut driver = Driver::new(&mesh, &setup);
    driver.bed.void_fraction.fill(pores);
    let mode = |cell: usize| (PI * mesh.cell_centre()[cell].x / 0.1).sin();
    let (source, h) = (1e5, 0.1 / n as f64);
    for cell in 0..n {
        driver.exchange.heat_source[cell] = source * mode(cell) * mesh.cell_volume()[cell];
    }
    for _ in 0..windows {
        driver.window(0.1 / windows as f64, 10.0);
    }
    let eigenvalue = pores * conductivity * 4.0 / (h * h) * (0.5 * PI / n as f64).sin().powi(2);
    let exact = source / eigenvalue * -(-eigenvalue / (pores * density * capacity)).exp_m1();
    let temperature = driver.gas.fields().temperature;
    let worst = (0..n).map(|cell| (temperature[cell] - 300.0 - exact * mode(cell)).abs());
    worst.fold(0.0, f64::max)
}

#[test]
fn conduction_in_time_converges_with_first_order() {
    let errors = [10, 20, 40, 80].map(conduction_in_time);
    let found = orders(&errors);
    println!("errors {errors:?} K, orders {found:?}");
    for order in found {
        assert!((order - 1.0).abs() < 0.06, "order {order}, {errors:?}");
    }
}

/// Heat through a wall at the far side of the gas from a wall of 400 K, in W.
fn slab(heat: WallHeat) -> (Vec<f64>, f64) {
    let patches = ["hot", "other", "side", "side", "side", "side"];
    let mesh = named_box([0.02, 0.1, 0.1], [8, 1, 1], patches);
    let mut setup = setup(&[
        ("hot", warm_wall(400.0)),
        ("other", slip_wall(heat)),
        ("side", slip()),
    ]);
    setup.properties = fluid(1.0, 1000.0, 1e-5, 0.05);
    let mut driver = Driver::new(&mesh, &setup);
    driver.bed.void_fraction.fill(0.5);
    for _ in 0..4 {
        driver.window(1.0, 1e6);
    }
    let heat = driver.received.energy.boundary_magnitude / 2.0 / 1e6;
    (driver.gas.fields().temperature.to_vec(), heat)
}

#[test]
fn a_convective_loss_is_a_resistance_in_series_with_the_gas() {
    // 100 K over 1/h + L/(ε κ), 0.01 m².
    let (temperature, heat) = slab(WallHeat::Convective {
        coefficient: Schedule::constant(3.0),
        ambient: Schedule::constant(300.0),
    });
    let exact = 0.01 * 100.0 / (1.0 / 3.0 + 0.02 / 0.025);
    assert!((heat / exact - 1.0).abs() < 1e-9, "{heat} of {exact} W");
    for cell in 0..8 {
        let depth = (cell as f64 + 0.5) / 8.0 * 0.02;
        let expected = 400.0 - exact / 0.01 * depth / 0.025;
        assert!((temperature[cell] - expected).abs() < 1e-7);
    }
}

#[test]
fn a_wall_heat_flux_is_conducted_to_the_other_wall() {
    let (temperature, heat) = slab(WallHeat::Flux(Schedule::constant(50.0)));
    assert!((heat / 0.5 - 1.0).abs() < 1e-9, "{heat} W");
    for cell in 0..8 {
        let depth = (cell as f64 + 0.5) / 8.0 * 0.02;
        let expected = 400.0 + 50.0 * depth / 0.025;
        assert!((temperature[cell] - expected).abs() < 1e-7);
    }
}

/// RMS error in K of plug flow between plates with a heat flux, far from the inlet, and the
/// mean temperature at the outlet in K.
fn heated_plates(across: usize) -> [f64; 2] {
    let patches = ["plate", "plate", "side", "side", "bottom", "top"];
    let mesh = named_box([0.02, 0.01, 1.0], [across, 1, 25], patches);
    let mut setup = setup(&[
        ("plate", slip_wall(WallHeat::Flux(Schedule::constant(50.0)))),
        ("side", slip()),
        ("bottom", inlet(0.1, 300.0)),
        ("top", outlet()),
    ]);
    setup.properties = fluid(1.0, 1000.0, 1e-5, 0.25);
    setup.velocity = Vec3::new(0.0, 0.0, 0.1);
    setup.controls.convection = Convection::VanLeer;
    let mut driver = Driver::new(&mesh, &setup);
    driver.bed.void_fraction.fill(0.8);
    for _ in 0..3 {
        driver.window(1.0, 1e5);
    }
    let temperature = driver.gas.fields().temperature;
    let mean = |row: usize| {
        let row = &temperature[row * across..(row + 1) * across];
        row.iter().sum::<f64>() / across as f64
    };
    // T − T_mean = q/(ε κ b) (x²/2 − b²/6), b half the gap, x from its middle, upstream of the end.
    let first = 20 * across;
    let square: f64 = (0..across)
        .map(|i| {
            let x = mesh.cell_centre()[first + i].x - 0.01;
            let exact = mean(20) + 50.0 / (0.2 * 0.01) * (0.5 * x * x - 1e-4 / 6.0);
            (temperature[first + i] - exact).powi(2)
        })
        .sum();
    [(square / across as f64).sqrt(), mean(24)]
}

#[test]
fn a_duct_with_heated_walls_gains_the_heat_and_has_the_developed_profile_with_second_order() {
    let found = [6, 12, 24].map(heated_plates);
    // ρ U c_p T′ = 2 q/b + ε κ T″ with ρ U c_p (T − 300 K) = ε κ T′ at the inlet and T′ = 0 at the outlet: all 50 K from
    // the walls.
    for [_, outlet] in found {
        assert!((outlet - 350.0).abs() < 1e-9, "{outlet} K at the outlet");
    }
    let errors = found.map(|found| found[0]);
    println!("errors {errors:?} K, orders {:?}", orders(&errors));
    for order in orders(&errors) {
        assert!((order - 2.0).abs() < 0.1, "order {order}, {errors:?}");
    }
}

/// RMS error in K of gas that cools through the wall of a duct one cell wide.
fn losing_duct(cells: usize, scalars: InletScalars) -> f64 {
    let mesh = duct([0.02, 0.02, 1.0], [1, 1, cells]);
    let coefficient = 8.0;
    let mut setup = setup(&[
        (
            "side",
            slip_wall(WallHeat::Convective {
                coefficient: Schedule::constant(coefficient),
                ambient: Schedule::constant(300.0),
            }),
        ),
        (
            "bottom",
            match scalars {
                InletScalars::Flux => inlet(0.2, 500.0),
                InletScalars::Value => holding_inlet(0.2, 500.0),
            },
        ),
        ("top", outlet()),
    ]);
    setup.properties = fluid(1.0, 1000.0, 1e-5, 20.0);
    setup.velocity = Vec3::new(0.0, 0.0, 0.2);
    setup.controls.convection = Convection::VanLeer;
    setup.controls.outer_iterations = 200;
    let mut driver = Driver::new(&mesh, &setup);
    for _ in 0..3 {
        driver.window(1.0, 1e6);
    }
    // κ T″ − ρ U c_p T′ − (P/A) T/(1/h + w/2κ) = 0 above ambient, T′ = 0 at the outlet; the wall
    // sees the cell through its own half.
    let overall = 1.0 / (1.0 / coefficient + 0.01 / 20.0);
    let (flow, loss) = (200.0 / 20.0, overall * 0.08 / 4e-4 / 20.0);
    let root = (0.25 * flow * flow + loss).sqrt();
    let (up, down) = (0.5 * flow + root, 0.5 * flow - root);
    let share = -down / up * (down - up).exp();
    // C e^{down z} + C share e^{up z}, at the inlet 200 K or, by the flux, 200 K + T′/flow.
    let conducted = match scalars {
        InletScalars::Flux => (down + share * up) / flow,
        InletScalars::Value => 0.0,
    };
    let scale = 200.0 / (1.0 + share - conducted);
    let exact = |z: f64| 300.0 + scale * ((down * z).exp() + share * (up * z).exp());
    let temperature = driver.gas.fields().temperature;
    rms(&mesh, |cell| {
        temperature[cell] - exact(mesh.cell_centre()[cell].z)
    })
}

#[test]
fn a_duct_that_loses_heat_cools_as_the_closed_form_with_second_order() {
    for scalars in [InletScalars::Flux, InletScalars::Value] {
        let errors = [40, 80, 160].map(|cells| losing_duct(cells, scalars));
        println!(
            "{scalars:?}: errors {errors:?} K, orders {:?}",
            orders(&errors)
        );
        for order in orders(&errors) {
            assert!((order - 2.0).abs() < 0.25, "order {order}, {errors:?}");
        }
        assert!(errors[2] < 0.05);
    }
}

#[test]
fn a_mass_flow_inlet_feeds_its_mass_whatever_its_temperature_and_area() {
    use calcine_coupler::setup::GasPatch;
    for (temperature, width) in [(300.0, 0.02), (600.0, 0.02), (600.0, 0.05)] {
        let mesh = duct([width, width, 0.1], [3, 2, 5]);
        let setup = setup(&[
            (
                "bottom",
                GasPatch::Inlet {
                    flow: InletFlow::MassFlow(Schedule(vec![(0.0, 0.0), (2.0, 2e-4)])),
                    temperature: Schedule::constant(temperature),
                    composition: None,
                    turbulence: None,
                    scalars: Default::default(),
                },
            ),
            ("top", outlet()),
            ("side", slip()),
        ]);
        let mut driver = Driver::new(&mesh, &setup);
        driver.bed.void_fraction.fill(0.5);
        driver.window(1e-3, 1.0);
        for _ in 0..20 {
            driver.window(1e-2, 100.0);
        }
        let flow = driver.received.mass.boundary_magnitude / 2.0;
        assert!((flow / 2e-4 - 1.0).abs() < 1e-9, "{flow} kg/s");
        // u = ṁ/(ε ρ A), ρ at the temperature of the inlet.
        let exact = 2e-4 / (0.5 * AIR.density(ATMOSPHERE, temperature) * width * width);
        for velocity in driver.gas.fields().velocity {
            assert!((velocity.z / exact - 1.0).abs() < 1e-5, "{velocity:?}");
        }
    }
}

#[test]
fn a_mass_flow_that_grows_counts_with_its_value_at_the_end_of_a_window() {
    use calcine_coupler::setup::GasPatch;
    let mesh = duct([0.02, 0.02, 0.1], [1, 1, 5]);
    let mut setup = setup(&[
        (
            "bottom",
            GasPatch::Inlet {
                flow: InletFlow::MassFlow(Schedule(vec![(0.0, 0.0), (2.0, 2e-4)])),
                temperature: Schedule::constant(300.0),
                composition: None,
                turbulence: None,
                scalars: Default::default(),
            },
        ),
        ("top", outlet()),
        ("side", slip()),
    ]);
    setup.properties = water();
    let mut driver = Driver::new(&mesh, &setup);
    driver.window(1.0, 1.0);
    let flow = driver.received.mass.boundary_magnitude / 2.0;
    assert!((flow / 1e-4 - 1.0).abs() < 1e-12, "{flow} kg");
}

#[test]
fn a_closed_box_of_ideal_gas_heats_at_constant_volume() {
    let patches = ["hot", "side", "side", "side", "side", "side"];
    let mesh = named_box([0.1, 0.08, 0.06], [5, 4, 3], patches);
    let mut setup = setup(&[
        ("hot", wall(WallHeat::Flux(Schedule::constant(40.0)))),
        ("side", no_slip()),
    ]);
    setup.controls.outer_tolerance = 1e-11;
    setup.controls.outer_iterations = 200;
    let mut driver = Driver::new(&mesh, &setup);
    for (cell, share) in scatter(mesh.cells(), 5).into_iter().enumerate() {
        driver.bed.void_fraction[cell] = 0.5 + 0.4 * share;
    }
    let pores = |driver: &Driver| -> f64 {
        let volume = mesh.cell_volume();
        let pairs = driver.bed.void_fraction.iter().zip(volume);
        pairs.map(|(pores, volume)| pores * volume).sum()
    };
    let volume = pores(&driver);
    let mass = volume * AIR.density(ATMOSPHERE, 300.0);
    let isochoric = AIR.heat_capacity - GAS_CONSTANT / AIR.molar_mass;
    for window in 1..=50 {
        driver.window(1e-2, 10.0);
        assert!(closure(&driver.received.energy) < 1e-9);
        let heat = 40.0 * 0.08 * 0.06 * 0.1 * f64::from(window);
        // m c_v ΔT = Q, and p₀ V = m R T with the mean of T over the mass.
        let exact = ATMOSPHERE * (1.0 + heat / (mass * isochoric * 300.0));
        let fields = driver.gas.fields();
        let weights = (0..mesh.cells()).map(|cell| {
            let held = driver.bed.void_fraction[cell] * mesh.cell_volume()[cell];
            held * fields.density[cell]
        });
        let held: f64 = weights.sum();
        let gas_constant = AIR.specific_gas_constant();
        let pressure = fields.density[0] * gas_constant * fields.temperature[0];
        let rise = (pressure - ATMOSPHERE) / (exact - ATMOSPHERE);
        assert!((rise - 1.0).abs() < 1e-6, "{rise} after window {window}");
        assert!((held / mass - 1.0).abs() < 1e-9, "{held} kg of {mass}");
    }
    let warmest = driver
        .gas
        .fields()
        .temperature
        .iter()
        .fold(0.0f64, |a, &b| a.max(b));
    println!(
        "p₀ {} Pa, warmest cell {warmest} K",
        driver.gas.fields().pressure[0]
    );
    assert!(warmest > 310.0);
}

/// Hot gas displaces cold between walls that heat it, a bed that takes heat, solved to 1e-5 only.
#[test]
fn energy_closes_to_round_off_however_loosely_it_is_solved() {
    let mut setup = setup(&[
        ("bottom", inlet(0.5, 400.0)),
        ("top", outlet()),
        ("side", warm_wall(350.0)),
    ]);
    setup.controls.outer_tolerance = 1e-3;
    setup.controls.linear_tolerance = Some(1e-5);
    for scheme in [TimeScheme::ImplicitEuler, TimeScheme::Sdirk2] {
        setup.controls.time_scheme = scheme;
        let mut duct = Driver::new(&duct([0.02, 0.02, 0.1], [4, 4, 20]), &setup);
        for cell in 160..320 {
            duct.exchange.heat_coefficient[cell] = 1e-3;
            duct.exchange.heat_source[cell] = 0.3;
        }
        let (mut open, mut moved) = (0.0, 0.0);
        for _ in 0..20 {
            duct.window(5e-3, 1.0);
            let balance = &duct.received.energy;
            let error = balance.stored - balance.boundary - balance.exchange - balance.source;
            open += error;
            moved += balance.stored_magnitude + balance.boundary_magnitude;
            assert!(closure(balance) < 1e-12, "{scheme:?}: {balance:?}");
        }
        println!("{scheme:?}: {open} J of {moved} J");
        assert!(
            open.abs() < 1e-13 * moved,
            "{scheme:?}: {open} J of {moved} J"
        );
    }
}

/// The same duct at accelerations at which its gas is renewed up to a thousand times in a window.
#[test]
fn linear_solves_that_follow_the_outer_loop_fill_the_cells_and_close_the_energy() {
    let mut setup = setup(&[
        ("bottom", inlet(0.5, 400.0)),
        ("top", outlet()),
        ("side", warm_wall(350.0)),
    ]);
    let run = |setup: &GasSetup, acceleration: f64| {
        let mut duct = Driver::new(&duct([0.02, 0.02, 0.1], [4, 4, 20]), setup);
        for cell in 160..320 {
            duct.exchange.heat_coefficient[cell] = 1e-3;
            duct.exchange.heat_source[cell] = 0.3;
        }
        for _ in 0..10 {
            let convergence = duct.window(5e-3, acceleration);
            let balance = &duct.received.energy;
            assert!(closure(balance) < 1e-12, "{acceleration}: {balance:?}");
            assert!(convergence.converged, "{acceleration}: {convergence:?}");
            let full = 1000.0 * setup.controls.outer_tolerance;
            assert!(
                convergence.volume_residual <= full,
                "{acceleration}: {convergence:?}"
            );
        }
        duct.gas.fields().temperature.to_vec()
    };
    for acceleration in [1.0, 30.0, 678.0] {
        (
            setup.controls.outer_tolerance,
            setup.controls.linear_tolerance,
        ) = (1e-5, None);
        let found = run(&setup, acceleration);
        (
            setup.controls.outer_tolerance,
            setup.controls.linear_tolerance,
        ) = (1e-9, Some(1e-13));
        let tight = run(&setup, acceleration);
        let pairs = found.iter().zip(&tight);
        let apart = pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        println!("{acceleration}: {apart} K apart");
        // A thousandth of the difference between the temperatures of inlet and gas.
        assert!(apart < 0.1, "{acceleration}: {apart} K");
    }
}
