//! The gas in thin layers of prisms, in windows of many diffusion times of a cell.
#![allow(clippy::unwrap_used)]

use std::sync::Arc;

use calcine_coupler::conformance::manufactured::prisms::prism_box;
use calcine_coupler::conformance::manufactured::tetrahedra::tetrahedron_box;
use calcine_coupler::mesh::Mesh;
use calcine_coupler::mesh::block::{BoxSpec, box_mesh};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{GasPatch, WallHeat, WallVelocity};

use crate::common::*;

/// A duct of 2 × 1 m and a height, of 12 × 6 × 6 hexahedra, and what becomes of the box that they make.
fn duct_of(height: f64, cut: impl Fn(&BoxSpec) -> Mesh) -> Arc<Mesh> {
    let patches = ["in", "out", "wall", "wall", "wall", "wall"];
    Arc::new(cut(&BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(2.0, 1.0, height),
        cells: [12, 6, 6],
        patches: patches.map(str::to_owned),
    }))
}

/// 1 m/s of a fluid of 1 kg/m³ and a viscosity in Pa s through such a duct, by the default controls but for those that are set.
fn viscous(mesh: &Arc<Mesh>, viscosity: f64, set: impl FnOnce(&mut GasSetup)) -> Driver {
    let mut setup = setup(&[
        ("in", inlet(1.0, 300.0)),
        ("out", outlet()),
        ("wall", no_slip()),
    ]);
    setup.properties = fluid(1.0, 1000.0, viscosity, 1.0);
    setup.velocity = Vec3::new(1.0, 0.0, 0.0);
    setup.controls.outer_iterations = 20;
    setup.controls.outer_tolerance = 1e-6;
    setup.controls.linear_tolerance = None;
    set(&mut setup);
    Driver::new(mesh, &setup)
}

/// Windows of so many seconds that make one.
fn advance(driver: &mut Driver, window: f64) {
    for number in 0..(1.0 / window).round() as usize {
        let done = driver.window(window, 1.0);
        // The first starts with the same velocity beside walls as elsewhere.
        assert!(
            done.converged || number == 0,
            "{window} s, window {number}: {done:?}"
        );
    }
}

/// Pressure gradient in Pa/m between 1 and 1.6 m behind the inlet after a second.
fn gradient(mesh: &Arc<Mesh>, viscosity: f64, window: f64) -> f64 {
    let mut driver = viscous(mesh, viscosity, |_| {});
    advance(&mut driver, window);
    let pressure = driver.gas.fields().pressure;
    // By least squares.
    let centres = mesh.cell_centre().iter().zip(pressure);
    let inside = centres.filter(|(centre, _)| centre.x > 1.0 && centre.x < 1.6);
    let (mut count, mut sums) = (0.0, [0.0; 4]);
    for (centre, &value) in inside {
        let x = centre.x - 1.3;
        count += 1.0;
        for (sum, part) in sums.iter_mut().zip([x, value, x * x, x * value]) {
            *sum += part;
        }
    }
    let [x, p, xx, xp] = sums.map(|sum| sum / count);
    (xp - x * p) / (xx - x * x)
}

/// Layers as thick as the prisms are wide, and up to 30 times thinner; ν Δt/Δz² from 7e-4 to 4e4. Where viscosity rules the pressure gradient is that of
/// plane ducts between side walls, 12 μ u/(h² (1 − 0.630 h/w)), off by what six layers give, on prisms as on hexahedra.
#[test]
fn thin_prisms_run_by_the_default_controls() {
    for height in [1.0, 0.3, 0.1, 0.03] {
        let prisms = duct_of(height, |spec| prism_box(spec, |point| point).unwrap());
        let hexahedra = duct_of(height, |spec| box_mesh(spec).unwrap());
        for viscosity in [1e-3, 0.1, 10.0] {
            for window in [0.02, 0.1] {
                let [found, other] =
                    [&prisms, &hexahedra].map(|mesh| gradient(mesh, viscosity, window));
                let what = format!("{height} m, {viscosity} Pa s, {window} s");
                assert!(
                    (found / other - 1.0).abs() < 0.04,
                    "{what}: {found}, {other} Pa/m"
                );
                if viscosity >= 0.1 && height <= 0.1 {
                    let exact = -12.0 * viscosity / (height * height * (1.0 - 0.630 * height));
                    assert!(
                        (found / exact - 1.0).abs() < 0.12,
                        "{what}: {found}, {exact} Pa/m"
                    );
                }
            }
        }
    }
}

/// The fastest cell in m/s after a second in layers ten times thinner than wide, viscosity 0.1 Pa s; `adapters/tests/openfoam_flow.rs` has it within 1e-5.
#[test]
fn the_fastest_cell_between_thin_prisms_is_that_of_other_windows() {
    let mesh = duct_of(0.1, |spec| prism_box(spec, |point| point).unwrap());
    for window in [0.02_f64, 0.1] {
        let mut driver = viscous(&mesh, 0.1, |setup| {
            setup.controls.outer_iterations = 50;
            setup.controls.outer_tolerance = 1e-8;
        });
        advance(&mut driver, window);
        let speeds = driver.gas.fields().velocity.iter().map(|u| u.norm());
        let fastest = speeds.fold(0.0, f64::max);
        assert!(
            (fastest / 1.565_282_4 - 1.0).abs() < 1e-5,
            "{window} s: {fastest}"
        );
    }
}

/// A flat closed box whose lid moves, of hexahedra and of prisms 20 times thinner than wide, ν Δt/Δz² 24 and 2400: pressure corrections alone grow in each outer iteration, which is
/// accelerated. Between free-slip sides the gas flows as in a film, u = A ζ² + B ζ + C without a net flow, where a half cell at a wall has its linear slope: A = 3/(1 + 2/n²), B = 1 − A,
/// C = −A/(4 n²) with n layers; ends two cells away and more still show.
#[test]
fn thin_cells_under_a_moving_lid_run_by_the_default_controls() {
    let layers = 10;
    let spec = BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(2.5, 0.5, 1.0 / 16.0),
        cells: [20, 4, layers],
        patches: ["wall", "wall", "side", "side", "wall", "lid"].map(str::to_owned),
    };
    let square = (layers as f64).powi(2);
    let bend = 3.0 / (1.0 + 2.0 / square);
    let film = |height: f64| bend * height * height + (1.0 - bend) * height - bend / (4.0 * square);
    let meshes = [box_mesh(&spec), prism_box(&spec, |point| point)];
    for mesh in meshes {
        let mesh = Arc::new(mesh.unwrap());
        for sides in [slip(), no_slip()] {
            let [brief, long] = [0.01, 1.0].map(|window| under_lid(&mesh, sides.clone(), window));
            for (one, other) in brief.iter().zip(&long) {
                assert!((one - other).norm() < 1e-4, "{one}, {other}");
            }
            if matches!(
                sides,
                GasPatch::Wall {
                    velocity: WallVelocity::NoSlip,
                    ..
                }
            ) {
                continue;
            }
            for (centre, velocity) in mesh.cell_centre().iter().zip(long) {
                if (centre.x - 1.25).abs() < 0.2 {
                    let exact = film(16.0 * centre.z);
                    let error = (velocity - Vec3::new(exact, 0.0, 0.0)).norm();
                    assert!(error < 0.01, "{centre}: {velocity}, {exact}");
                }
            }
        }
    }
}

/// Velocities after eight windows from rest, all of which but the first converge.
fn under_lid(mesh: &Arc<Mesh>, sides: GasPatch, window: f64) -> Vec<Vec3> {
    let mut setup = setup(&[("wall", no_slip()), ("side", sides), ("lid", moving_lid())]);
    setup.properties = fluid(1.0, 1000.0, 0.0937, 1.0);
    setup.controls.outer_iterations = 30;
    setup.controls.outer_tolerance = 1e-6;
    setup.controls.linear_tolerance = None;
    let mut driver = Driver::new(mesh, &setup);
    let done: Vec<_> = (0..8).map(|_| driver.window(window, 1.0)).collect();
    let rest = &done[1..];
    assert!(
        rest.iter().all(|done| done.converged),
        "{window} s: {done:?}"
    );
    driver.gas.fields().velocity.to_vec()
}

fn moving_lid() -> GasPatch {
    GasPatch::Wall {
        velocity: WallVelocity::Moving(Vec3::new(1.0, 0.0, 0.0)),
        heat: WallHeat::Adiabatic,
    }
}

/// Tetrahedra of 1 × 0.6 × 0.5 m, the ones at one side three times thinner than those at the other (57°).
fn graded_tetrahedra() -> Arc<Mesh> {
    let spec = BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(1.0, 0.6, 0.5),
        cells: [8, 6, 5],
        patches: ["in", "out", "wall", "wall", "wall", "wall"].map(str::to_owned),
    };
    let graded = |point: Vec3| {
        let y = point.y / 0.6;
        Vec3::new(point.x, 0.6 * (0.5 * y + 0.5 * y * y), point.z)
    };
    Arc::new(tetrahedron_box(&spec, graded).unwrap())
}

/// A flow that starts from rest between walls without friction is uniform at once, in all cells: those at edges of two of them, and of one and the outlet, too. ν Δt/h²
/// from 6e-5 to 570, Courant numbers from 0.02 to 3.
#[test]
fn a_flow_between_walls_without_friction_is_uniform_in_every_tetrahedron() {
    let mesh = graded_tetrahedra();
    for viscosity in [1e-4, 1e-2, 0.1, 1.0, 10.0] {
        for window in [2e-3, 0.02, 0.2] {
            let mut setup = setup(&[
                ("in", inlet(1.0, 300.0)),
                ("out", outlet()),
                ("wall", slip()),
            ]);
            setup.properties = fluid(1.0, 1000.0, viscosity, 1.0);
            setup.controls.outer_iterations = 30;
            setup.controls.outer_tolerance = 1e-6;
            setup.controls.linear_tolerance = None;
            let mut driver = Driver::new(&mesh, &setup);
            for number in 0..4 {
                let done = driver.window(window, 1.0);
                let what = format!("{viscosity} Pa s, {window} s, window {number}");
                assert!(done.converged, "{what}: {done:?}");
                let fields = driver.gas.fields();
                let errors = fields.velocity.iter().map(|u| (u - Vec3::x()).norm());
                let worst = errors.fold(0.0, f64::max);
                assert!(worst < 2e-3, "{what}: {worst} m/s");
            }
        }
    }
}

/// Gas of two wall temperatures in a closed box of tetrahedra comes to rest, and windows of gas at rest converge, though all that is left of its forces is round-off.
#[test]
fn gas_at_rest_in_a_closed_box_of_tetrahedra_converges() {
    let spec = BoxSpec {
        origin: Vec3::zeros(),
        size: Vec3::new(0.01, 0.01, 0.01),
        cells: [4, 4, 4],
        patches: ["cold", "hot", "side", "side", "side", "side"].map(str::to_owned),
    };
    let mesh = Arc::new(tetrahedron_box(&spec, |point| point).unwrap());
    let mut setup = setup(&[
        ("cold", warm_wall(300.0)),
        ("hot", warm_wall(600.0)),
        ("side", no_slip()),
    ]);
    setup.controls.outer_iterations = 30;
    setup.controls.outer_tolerance = 1e-6;
    setup.controls.linear_tolerance = None;
    let mut driver = Driver::new(&mesh, &setup);
    for number in 0..20 {
        let done = driver.window(1.0, 1.0);
        // While the gas still expands, a window may end at its limit of outer iterations, near its tolerance.
        let heating = number < 10 && done.residual < 1e-4;
        assert!(done.converged || heating, "window {number}: {done:?}");
    }
    let speeds = driver.gas.fields().velocity.iter().map(|u| u.norm());
    assert!(speeds.fold(0.0, f64::max) < 1e-8);
}
