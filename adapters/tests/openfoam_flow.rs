//! Flow, heat and balances of calcineGasFoam against exact solutions (verification).

use calcine_coupler::conformance::manufactured::prisms::prism_box;
use calcine_coupler::conformance::manufactured::tetrahedra::tetrahedron_box;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::{Balance, Bed, Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::gas_model::{ConstantGas, GasModel};
use calcine_coupler::setup::{GasPatch, Schedule, WallHeat, WallVelocity};
use calcine_coupler::time::{Clocks, Ticks};

use crate::openfoam_support::{
    CELLS, Duct, PRESSURE, SIDE, SPEED, TEMPERATURE, bed, exchange_of_nothing, inviscid, mesh,
    no_exchange, setup, stop,
};

fn closure(balance: &Balance) -> f64 {
    let error = balance.stored - balance.boundary - balance.exchange - balance.source;
    let terms = balance.stored_magnitude
        + balance.boundary_magnitude
        + balance.exchange.abs()
        + balance.source_magnitude;
    error.abs() / terms
}

#[test]
fn uniform_flow_through_an_empty_duct_stays_uniform() {
    let folder = tempfile::tempdir().unwrap();
    let mut duct = Duct::launch(&setup(), folder.path());
    assert_eq!(duct.gas.about().name, "OpenFOAM");
    let convergence = duct.advance(20, &bed(1.0), &no_exchange());
    assert!(convergence.converged, "{convergence:?}");
    let fields = duct.gas.fields();
    for cell in 0..CELLS {
        assert!((fields.temperature[cell] - TEMPERATURE).abs() < 1e-9);
        assert!((fields.pressure[cell] - PRESSURE).abs() < 1e-9);
        let expected = Vec3::new(0.0, 0.0, SPEED);
        assert!((fields.velocity[cell] - expected).norm() < 1e-11);
        assert!(fields.pressure_gradient[cell].norm() < 1e-8);
        // OpenFOAM's gas constant is 8314.47 J/kmol/K, 9e-7 above ours.
        let density = GasProperties::air().density(PRESSURE, TEMPERATURE);
        assert!((fields.density[cell] / density - 1.0).abs() < 2e-6);
    }
    duct.gas.finish_run(&duct.supervisor).unwrap();
}

#[test]
fn gas_at_rest_carries_its_weight_across_a_jump_of_the_void_fraction() {
    let folder = tempfile::tempdir().unwrap();
    let mut still = setup();
    still.velocity = Vec3::zeros();
    still.gravity = Vec3::new(0.0, 0.0, -9.81);
    stop(&mut still);
    let mut packed = bed(1.0);
    packed.void_fraction[4..8].fill(0.4);
    let mut duct = Duct::launch(&still, folder.path());
    duct.advance(10, &packed, &no_exchange());
    let fields = duct.gas.fields();
    let weight = fields.density[0] * 9.81;
    for cell in 0..CELLS {
        assert!(
            fields.velocity[cell].norm() < 1e-12,
            "{}",
            fields.velocity[cell]
        );
        let above = SIDE * (CELLS as f64 - 0.5 - cell as f64);
        assert!((fields.pressure[cell] - PRESSURE - weight * above).abs() < 1e-10);
        assert!((fields.pressure_gradient[cell].z + weight).abs() < 1e-8);
    }
}

#[test]
fn gas_at_rest_stays_at_rest_on_a_sheared_mesh() {
    // Each layer of cells is displaced, so that lines between centres are oblique to their faces.
    let folder = tempfile::tempdir().unwrap();
    let mut sheared = mesh([3, 2, CELLS]).topology().clone();
    for point in &mut sheared.points {
        point.x += 0.3 * point.z;
    }
    let sheared = Mesh::new(sheared).unwrap();
    let cells = sheared.cells();
    let mut still = setup();
    still.velocity = Vec3::zeros();
    still.gravity = Vec3::new(0.0, 0.0, -9.81);
    stop(&mut still);
    let mut packed = Bed {
        void_fraction: vec![1.0; cells],
    };
    packed.void_fraction[cells / 3..2 * cells / 3].fill(0.4);
    let mut duct = Duct::launch_on(sheared, &still, folder.path());
    duct.advance(20, &packed, &exchange_of_nothing(cells));
    let fields = duct.gas.fields();
    let weight = fields.density[0] * 9.81;
    for cell in 0..cells {
        assert!(
            fields.velocity[cell].norm() < 1e-10,
            "{}",
            fields.velocity[cell]
        );
        assert!((fields.pressure_gradient[cell].z + weight).abs() < 1e-4 * weight);
    }
}

/// Points displaced by up to 15 % of a cell's width, so that faces are warped: OpenFOAM finds the same cells as Calcine does,
/// and pressure carried along such faces does not drive the gas (5e-3 m/s without). The outlet stays level: one pressure on
/// faces of different heights drives a flow.
#[test]
fn gas_at_rest_stays_at_rest_where_faces_are_warped() {
    let folder = tempfile::tempdir().unwrap();
    let mut warped = mesh([3, 2, CELLS]).topology().clone();
    for (number, point) in warped.points.iter_mut().enumerate() {
        let phase = number as f64;
        let way = Vec3::new(phase.sin(), (1.7 * phase).cos(), (2.3 * phase).sin());
        if point.z < SIDE * CELLS as f64 - 1e-9 {
            *point += 0.05 * SIDE * way;
        }
    }
    let warped = Mesh::new(warped).unwrap();
    let cells = warped.cells();
    let mut still = setup();
    still.velocity = Vec3::zeros();
    still.gravity = Vec3::new(0.0, 0.0, -9.81);
    stop(&mut still);
    let empty = Bed {
        void_fraction: vec![1.0; cells],
    };
    let mut duct = Duct::launch_on(warped, &still, folder.path());
    duct.advance(20, &empty, &exchange_of_nothing(cells));
    let fields = duct.gas.fields();
    let weight = fields.density[0] * 9.81;
    for cell in 0..cells {
        let speed = fields.velocity[cell].norm();
        assert!(speed < 1e-10, "cell {cell}: {speed} m/s");
        assert!((fields.pressure_gradient[cell].z + weight).abs() < 1e-4 * weight);
    }
}

/// Air of 1 m/s through a duct of 60 × 10 × 100 mm that leans by so many degrees, in windows of 5 ms: the fastest cell in m/s
/// after 0.2 s, as `native-solver/tests/skewed.rs` has it.
/// Speed of the fastest cell in m/s after so many windows of a length in s in an empty mesh, each of which converges.
fn fastest_after(duct: &mut Duct, (windows, seconds): (usize, f64), cells: usize) -> f64 {
    let span = Ticks::from_seconds(seconds).unwrap();
    duct.window.span = Clocks {
        motion: span,
        process: span,
    };
    let empty = Bed {
        void_fraction: vec![1.0; cells],
    };
    for window in 0..windows {
        let done = duct.advance(1, &empty, &exchange_of_nothing(cells));
        assert!(done.converged, "window {window}: {done:?}");
    }
    let speeds = duct.gas.fields().velocity.iter().map(|u| u.norm());
    speeds.fold(0.0, f64::max)
}

#[test]
fn air_passes_a_duct_that_leans_by_up_to_65_degrees() {
    for (degrees, expected) in [
        (35.0_f64, 2.207_245_5),
        (55.0, 3.588_852_1),
        (65.0, 4.930_512_1),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let mut leaning = leaning_box().topology().clone();
        for point in &mut leaning.points {
            point.x += point.z * degrees.to_radians().tan();
        }
        let leaning = Mesh::new(leaning).unwrap();
        let cells = leaning.cells();
        let mut air = setup();
        air.velocity = Vec3::zeros();
        air.controls.outer_iterations = 100;
        air.controls.outer_tolerance = 1e-8;
        for (name, patch) in &mut air.patches {
            if name == "bottom" {
                *patch = GasPatch::inlet(Schedule::constant(1.0), Schedule::constant(TEMPERATURE));
            }
        }
        let mut duct = Duct::launch_on(leaning, &air, folder.path());
        let fastest = fastest_after(&mut duct, (40, 5e-3), cells);
        assert!(
            (fastest / expected - 1.0).abs() < 1e-5,
            "{degrees} degrees: {fastest}"
        );
    }
}

/// The prisms of `native-solver/tests/stretched.rs`: the fastest cell is that of the native gas.
#[test]
fn a_viscous_fluid_passes_thin_prisms_as_natively() {
    let folder = tempfile::tempdir().unwrap();
    let thin = prism_box(
        &BoxSpec {
            origin: Vec3::zeros(),
            size: Vec3::new(2.0, 1.0, 0.1),
            cells: [12, 6, 6],
            patches: ["bottom", "top", "side", "side", "side", "side"].map(str::to_owned),
        },
        |point| point,
    )
    .unwrap();
    let cells = thin.cells();
    let mut viscous = setup();
    viscous.velocity = Vec3::new(1.0, 0.0, 0.0);
    viscous.properties = GasModel::Constant(ConstantGas {
        density: 1.0,
        heat_capacity: 1000.0,
        viscosity: 0.1,
        conductivity: 1.0,
    });
    viscous.controls.outer_iterations = 60;
    viscous.controls.outer_tolerance = 1e-8;
    for (name, patch) in &mut viscous.patches {
        match name.as_str() {
            "bottom" => {
                *patch = GasPatch::inlet(Schedule::constant(1.0), Schedule::constant(TEMPERATURE));
            }
            "side" => {
                *patch = GasPatch::Wall {
                    velocity: WallVelocity::NoSlip,
                    heat: WallHeat::Adiabatic,
                };
            }
            _ => {}
        }
    }
    let mut duct = Duct::launch_on(thin, &viscous, folder.path());
    let fastest = fastest_after(&mut duct, (10, 0.1), cells);
    assert!(
        (fastest / FASTEST_OF_THIN_PRISMS - 1.0).abs() < 1e-5,
        "{fastest}"
    );
}

/// The graded tetrahedra of `native-solver/tests/stretched.rs`: uniform from rest at ν Δt/h² of 6e-4, 57 and 570, those at edges of walls without friction and of the outlet too.
#[test]
fn a_flow_between_walls_without_friction_is_uniform_in_every_tetrahedron() {
    let spec = BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(1.0, 0.6, 0.5),
        cells: [8, 6, 5],
        patches: ["bottom", "top", "side", "side", "side", "side"].map(str::to_owned),
    };
    let graded = |point: Vec3| {
        let y = point.y / 0.6;
        Vec3::new(point.x, 0.6 * (0.5 * y + 0.5 * y * y), point.z)
    };
    for (viscosity, window) in [(1e-4, 0.02), (1.0, 0.2), (10.0, 0.2)] {
        let folder = tempfile::tempdir().unwrap();
        let tetrahedra = tetrahedron_box(&spec, graded).unwrap();
        let cells = tetrahedra.cells();
        let mut fluid = setup();
        fluid.velocity = Vec3::zeros();
        fluid.properties = GasModel::Constant(ConstantGas {
            density: 1.0,
            heat_capacity: 1000.0,
            viscosity,
            conductivity: 1.0,
        });
        fluid.controls.outer_iterations = 30;
        fluid.controls.outer_tolerance = 1e-6;
        for (name, patch) in &mut fluid.patches {
            if name == "bottom" {
                *patch = GasPatch::inlet(Schedule::constant(1.0), Schedule::constant(TEMPERATURE));
            }
        }
        let mut duct = Duct::launch_on(tetrahedra, &fluid, folder.path());
        fastest_after(&mut duct, (4, window), cells);
        let velocities = duct.gas.fields().velocity.iter();
        let errors = velocities.map(|u| (u - Vec3::x()).norm());
        let worst = errors.fold(0.0, f64::max);
        assert!(worst < 2e-3, "{viscosity} Pa s: {worst} m/s");
    }
}

/// In m/s (`native-solver/tests/stretched.rs`).
const FASTEST_OF_THIN_PRISMS: f64 = 1.565_282_4;

fn leaning_box() -> Mesh {
    box_mesh(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(0.06, 0.01, 0.1),
        cells: [12, 2, 20],
        patches: ["side", "side", "side", "side", "bottom", "top"].map(str::to_owned),
    })
    .unwrap()
}

#[test]
fn a_slab_at_one_temperature_heats_the_gas_as_the_upwind_scheme_s_exact_power_law() {
    // Steady, without conduction: m' c_p (T_c − T_{c−1}) = K (T_s − T_c), so each cell of the slab
    // multiplies T_s − T by 1/(1 + K/(m' c_p)). The conduction of air is made negligible.
    let folder = tempfile::tempdir().unwrap();
    let mut thin = setup();
    thin.properties = inviscid();
    let mut exchange = no_exchange();
    let (coefficient, slab) = (0.02, 400.0);
    for cell in 3..9 {
        exchange.heat_coefficient[cell] = coefficient;
        exchange.heat_source[cell] = coefficient * slab;
    }
    let mut duct = Duct::launch(&thin, folder.path());
    duct.advance(400, &bed(0.5), &exchange);
    let fields = duct.gas.fields();
    let flow = fields.density[0] * SPEED * SIDE * SIDE;
    let factor = 1.0 / (1.0 + coefficient / (flow * GasProperties::air().heat_capacity));
    for cell in 0..CELLS {
        let cells = (cell as i32 - 2).clamp(0, 6);
        let expected = slab - (slab - TEMPERATURE) * factor.powi(cells);
        let found = fields.temperature[cell];
        // 1e-8 K: Newton's tolerance of OpenFOAM's temperature is 1e-4 of T, but it is exact for
        // a constant heat capacity; what remains is the approach to steady state.
        assert!(
            (found - expected).abs() < 1e-8,
            "cell {cell}: {found} K, {expected} K"
        );
    }
}

#[test]
fn mass_and_energy_close_while_hot_gas_displaces_cold() {
    let folder = tempfile::tempdir().unwrap();
    let mut hot = setup();
    for (_, patch) in &mut hot.patches {
        if let GasPatch::Inlet { temperature, .. } = patch {
            *temperature = Schedule(vec![(0.0, 300.0), (0.2, 400.0)]);
        }
    }
    let mut exchange = no_exchange();
    exchange.heat_coefficient.fill(0.005);
    exchange.heat_source.fill(0.005 * 310.0);
    exchange.drag_coefficient[2..10].fill(1e-4);
    let mut duct = Duct::launch(&hot, folder.path());
    let mut worst = [0.0_f64; 2];
    let mut owed = 0.0_f64;
    for _ in 0..40 {
        let convergence = duct.attempt(&bed(0.48), &exchange);
        assert!(convergence.converged, "{convergence:?}");
        assert!(convergence.volume_residual < 1e-8, "{convergence:?}");
        worst[0] = worst[0].max(closure(&duct.received.mass));
        worst[1] = worst[1].max(closure(&duct.received.energy));
        assert!(
            closure(&duct.received.momentum[2]) < 1e-6,
            "{:?}",
            duct.received
        );
        // AF 50: without what the two clocks owe momentum would stay open by that.
        let [.., along] = &duct.received.momentum;
        let parts = along.boundary_magnitude + along.source_magnitude;
        owed = owed.max(duct.received.storage_clock.z.abs() / parts);
        // The reported exchange is what the particles give at the solved temperature.
        let taken: f64 = duct.received.heat.iter().sum::<f64>() * 0.05;
        assert!((taken / duct.received.energy.exchange - 1.0).abs() < 1e-12);
        duct.commit();
    }
    eprintln!(
        "mass closes to {:.1e}, energy to {:.1e}",
        worst[0], worst[1]
    );
    assert!(worst[0] < 1e-11 && worst[1] < 1e-11, "{worst:?}");
    assert!(owed > 1e-3, "{owed}");
    assert!(duct.gas.fields().temperature[0] > 390.0);
}

#[test]
fn mass_and_energy_close_in_a_wide_duct_with_hot_walls_that_gas_sticks_to() {
    let folder = tempfile::tempdir().unwrap();
    let mut hot = setup();
    for (_, patch) in &mut hot.patches {
        if let GasPatch::Wall { velocity, heat } = patch {
            *velocity = WallVelocity::NoSlip;
            *heat = WallHeat::Temperature(Schedule(vec![(0.0, 300.0), (0.5, 500.0)]));
        }
    }
    hot.gravity = Vec3::new(0.0, 0.0, -9.81);
    let wide = mesh([5, 4, CELLS]);
    let cells = wide.cells();
    let mut duct = Duct::launch_on(wide, &hot, folder.path());
    let uneven = Bed {
        void_fraction: (0..cells)
            .map(|c| 0.4 + 0.6 * ((c * 7 % 11) as f64 / 11.0))
            .collect(),
    };
    let mut exchange = exchange_of_nothing(cells);
    for cell in cells / 4..cells / 2 {
        exchange.drag_coefficient[cell] = 1e-5;
    }
    for _ in 0..20 {
        let convergence = duct.attempt(&uneven, &exchange);
        assert!(convergence.converged, "{convergence:?}");
        assert!(
            closure(&duct.received.mass) < 1e-12,
            "{:?}",
            duct.received.mass
        );
        assert!(
            closure(&duct.received.energy) < 1e-11,
            "{:?}",
            duct.received.energy
        );
        for momentum in &duct.received.momentum {
            assert!(closure(momentum) < 1e-6, "{momentum:?}");
        }
        duct.commit();
    }
    let hottest = duct
        .gas
        .fields()
        .temperature
        .iter()
        .copied()
        .fold(0.0, f64::max);
    assert!(hottest > 320.0 && hottest < 500.0, "{hottest} K");
}

#[test]
fn a_plug_s_pressure_drop_is_exact_to_its_half_cells() {
    // dp/dz = −K u/(ε V) in the plug, half a cell on either side of each centre, and none in the
    // free duct; viscosity is made negligible.
    let folder = tempfile::tempdir().unwrap();
    let (void_fraction, coefficient) = (0.4, 1e-3);
    let mut plug = bed(1.0);
    let mut exchange = no_exchange();
    for cell in 4..8 {
        plug.void_fraction[cell] = void_fraction;
        exchange.drag_coefficient[cell] = coefficient;
    }
    let mut thin = setup();
    thin.properties = inviscid();
    let mut duct = Duct::launch(&thin, folder.path());
    let convergence = duct.advance(60, &plug, &exchange);
    assert!(convergence.converged, "{convergence:?}");
    let fields = duct.gas.fields();
    let speed = SPEED / void_fraction;
    let gradient = coefficient * speed / (void_fraction * SIDE.powi(3));
    let flow = fields.density[0] * SPEED;
    // Steady upwind momentum flux G (u_c − u_{c−1}) enters where the gas speeds up (cell 4) and
    // slows down (cell 8), per volume of pores.
    let up = flow * (speed - SPEED) / (void_fraction * SIDE);
    let down = flow * (SPEED - speed) / SIDE;
    let mut pressure = PRESSURE;
    for cell in (0..CELLS).rev() {
        let slope = match cell {
            4 => gradient + up,
            5..8 => gradient,
            8 => down,
            _ => 0.0,
        };
        pressure += 0.5 * SIDE * slope;
        let found = fields.pressure[cell];
        assert!(
            (found - pressure).abs() < 1e-7,
            "cell {cell}: {found} Pa, {pressure} Pa"
        );
        assert!((fields.pressure_gradient[cell].z + slope).abs() < 1e-5);
        pressure += 0.5 * SIDE * slope;
    }
}
