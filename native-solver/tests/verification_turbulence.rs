//! Verification of the eddies: decay in time and along a duct against the model's closed form, a channel
//! against the correlation of its friction and the law of the wall, the bed, and the two clocks.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)]

use std::sync::Arc;

use calcine_coupler::mesh::Mesh;
use calcine_coupler::part::{Gas, Part};
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::turbulence::{KEpsilon, LogLaw};
use calcine_coupler::setup::{Convection, GasPatch, InletTurbulence, Schedule, Turbulence};
use calcine_native::gas::NativeGas;

use crate::common::*;

/// The model with k in m²/s² and its length scale in m at the start.
fn k_epsilon(energy: f64, length_scale: f64) -> Turbulence {
    Turbulence::KEpsilon {
        energy,
        length_scale,
        prandtl: 0.85,
        schmidt: 0.7,
        iterations: 1000,
        in_bed: false,
    }
}

/// An inlet of 300 K with eddies.
fn turbulent_inlet(velocity: f64, intensity: f64, length_scale: f64) -> GasPatch {
    let GasPatch::Inlet {
        flow,
        temperature,
        composition,
        ..
    } = GasPatch::inlet(Schedule::constant(velocity), Schedule::constant(300.0))
    else {
        panic!("an inlet");
    };
    GasPatch::Inlet {
        flow,
        temperature,
        composition,
        turbulence: Some(InletTurbulence {
            intensity,
            length_scale,
        }),
        scalars: Default::default(),
    }
}

/// Relative error of k after 0.1 s in still air, in so many steps.
fn decay_error(steps: u32) -> f64 {
    let mut setup = setup(&[("side", slip()), ("bottom", slip()), ("top", slip())]);
    let (energy, dissipation) = (1.0, 10.0);
    setup.turbulence = k_epsilon(energy, 0.09f64.powf(0.75) / dissipation);
    let mut driver = Driver::new(&duct([0.1, 0.1, 0.1], [2, 2, 2]), &setup);
    for _ in 0..steps {
        driver.window(0.1 / f64::from(steps), 1.0);
    }
    let exact = KEpsilon::STANDARD.decayed(energy, dissipation, 0.1);
    let found = driver.gas.fields().turbulence.energy;
    let spread = found.iter().map(|k| (k / found[0] - 1.0).abs());
    assert!(spread.fold(0.0, f64::max) < 1e-12);
    found[0] / exact - 1.0
}

#[test]
fn eddies_in_still_air_decay_as_the_closed_form_says_to_first_order_in_the_step() {
    let errors = [25, 50, 100, 200].map(|steps| decay_error(steps).abs());
    let orders = orders(&errors);
    println!("{errors:.5?}, orders {orders:.3?}");
    assert!(orders.iter().all(|order| (0.95..1.05).contains(order)));
    assert!(errors[3] < 7e-3);
}

/// Root mean square of the relative error of k along a duct of so many cells, after twelve transit times.
fn duct_error(cells: usize) -> f64 {
    let (speed, length) = (10.0, 1.0);
    // k/ε of 20 ms: k falls to a fifth. ν_t is 1e-5 of the speed times the length, and diffuses little.
    let (intensity, scale) = (0.02, 8.0e-4);
    let mut setup = setup(&[
        ("side", slip()),
        ("bottom", turbulent_inlet(speed, intensity, scale)),
        ("top", outlet()),
    ]);
    setup.turbulence = k_epsilon(0.06, scale);
    setup.velocity = Vec3::new(0.0, 0.0, speed);
    setup.properties = inviscid();
    let mesh = duct([0.1, 0.1, length], [1, 1, cells]);
    let mut driver = Driver::new(&mesh, &setup);
    for _ in 0..60 {
        driver.window(0.02, 1.0);
    }
    let (energy, dissipation) = (0.06, KEpsilon::STANDARD.dissipation(0.06, scale));
    let fields = driver.gas.fields();
    rms(&mesh, |cell| {
        let time = mesh.cell_centre()[cell].z / speed;
        let exact = KEpsilon::STANDARD.decayed(energy, dissipation, time);
        fields.turbulence.energy[cell] / exact - 1.0
    })
}

#[test]
fn eddies_carried_along_a_duct_decay_as_the_closed_form_says_to_first_order_in_the_cell() {
    let errors = [20, 40, 80, 160].map(duct_error);
    let orders = orders(&errors);
    println!("{errors:.5?}, orders {orders:.3?}");
    // Upwind: rising to 1.
    assert!(orders[0] > 0.8 && orders[1] > 0.88 && (0.94..1.05).contains(&orders[2]));
    assert!(errors[3] < 7e-3);
}

/// A plane channel of half height δ, from its wall to its plane of symmetry.
struct Channel {
    mesh: Arc<Mesh>,
    driver: Driver,
    across: usize,
    along: usize,
}

const HALF: f64 = 0.05;
const SPEED: f64 = 13.0;
const DENSITY: f64 = 1.2;
const VISCOSITY: f64 = 1.8e-5;

impl Channel {
    fn new(across: usize, along: usize, factor: f64, windows: usize) -> Self {
        let patches = ["wall", "axis", "side", "side", "bottom", "top"];
        let mesh = named_box([HALF, 0.01, 120.0 * HALF], [across, 1, along], patches);
        let mut setup = setup(&[
            ("wall", no_slip()),
            ("axis", GasPatch::Symmetry),
            ("side", GasPatch::Symmetry),
            ("bottom", turbulent_inlet(SPEED, 0.05, 0.14 * HALF)),
            ("top", outlet()),
        ]);
        setup.properties = fluid(DENSITY, 1000.0, VISCOSITY, 0.026);
        setup.velocity = Vec3::new(0.0, 0.0, SPEED);
        setup.turbulence = k_epsilon(0.6, 0.14 * HALF);
        setup.controls.convection = Convection::VanLeer;
        setup.controls.outer_iterations = 4;
        let mut driver = Driver::new(&mesh, &setup);
        for _ in 0..windows {
            driver.window(0.02, factor);
        }
        Self {
            mesh,
            driver,
            across,
            along,
        }
    }

    /// Cells of the cross-section so many cells before the end, from the wall on.
    fn section(&self, before: usize) -> std::ops::Range<usize> {
        let first = (self.along - before) * self.across;
        first..first + self.across
    }

    /// Friction velocity in m/s from the pressure that the flow loses: τ_w = −δ dp/dz.
    fn friction_velocity(&self) -> f64 {
        let fields = self.driver.gas.fields();
        let (up, down) = (self.section(15).start, self.section(5).start);
        let place = |cell: usize| self.mesh.cell_centre()[cell].z;
        let fall = fields.pressure[up] - fields.pressure[down];
        (HALF * fall / (place(down) - place(up)) / DENSITY).sqrt()
    }
}

#[test]
fn friction_in_a_channel_follows_the_correlation_of_dean_and_velocity_the_law_of_the_wall() {
    // Dean 1978, doi 10.1115/1.3448633: c_f = 0.073 Re^(-1/4) on the whole height.
    let reynolds = DENSITY * SPEED * 2.0 * HALF / VISCOSITY;
    let coefficient = 0.073 * reynolds.powf(-0.25);
    for across in [10, 16, 24] {
        let channel = Channel::new(across, 60, 1.0, 150);
        let friction = channel.friction_velocity();
        let found = 2.0 * (friction / SPEED).powi(2);
        let fields = channel.driver.gas.fields();
        let law = LogLaw::SMOOTH;
        let limit = law.laminar_limit();
        let mut worst: f64 = 0.0;
        for cell in channel.section(10) {
            let y = channel.mesh.cell_centre()[cell].x;
            let plus = DENSITY * friction * y / VISCOSITY;
            let speed = fields.velocity[cell].z / friction;
            if plus > 30.0 && y < 0.3 * HALF {
                worst = worst.max((speed / law.speed(plus, limit) - 1.0).abs());
            }
            println!(
                "y+ {plus:7.1} u+ {speed:.2} law {:.2}",
                law.speed(plus, limit)
            );
        }
        let first = DENSITY * friction * 0.5 * HALF / across as f64 / VISCOSITY;
        println!(
            "{across} cells, Re_tau {:.0}, y+ {first:.0}: c_f {found:.5} Dean {coefficient:.5} ratio {:.3}, law within {worst:.4}",
            DENSITY * friction * HALF / VISCOSITY,
            found / coefficient
        );
        assert!((found / coefficient - 1.0).abs() < 0.08);
        assert!(worst < 0.05);
    }
}

/// A duct with walls and a bed in its middle third, through which turbulent air flows.
fn duct_with_bed() -> Driver {
    let mut setup = setup(&[
        ("side", no_slip()),
        ("bottom", turbulent_inlet(5.0, 0.3, 5e-4)),
        ("top", outlet()),
    ]);
    setup.turbulence = k_epsilon(1.0, 5e-4);
    setup.velocity = Vec3::new(0.0, 0.0, 5.0);
    setup.controls.outer_iterations = 5;
    let mesh = duct([0.04, 0.04, 0.12], [4, 4, 12]);
    let mut driver = Driver::new(&mesh, &setup);
    for cell in 64..128 {
        driver.bed.void_fraction[cell] = 0.5;
        driver.exchange.drag_coefficient[cell] = 1e-3;
    }
    driver
}

#[test]
fn eddies_that_enter_a_bed_decay_there_and_carry_nothing() {
    let mut driver = duct_with_bed();
    for _ in 0..200 {
        driver.window(2e-3, 1.0);
    }
    let eddies = driver.gas.fields().turbulence;
    let layer = |k: usize| {
        let cells = 16 * k..16 * (k + 1);
        let mean = |list: &[f64]| list[cells.clone()].iter().sum::<f64>() / 16.0;
        (mean(eddies.energy), mean(eddies.viscosity))
    };
    for k in 0..12 {
        let (energy, viscosity) = layer(k);
        println!("layer {k}: k {energy:.2e}, mu_t {viscosity:.1e}");
        assert_eq!(viscosity == 0.0, (4..8).contains(&k));
    }
    // The last layer of the bed has some from behind it.
    assert!((4..7).all(|k| layer(k).0 < 0.95 * layer(k - 1).0));
    assert!(layer(6).0 < 0.7 * layer(3).0);
}

#[test]
fn turbulence_is_resumed_and_repeated_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let mut through = duct_with_bed();
    for _ in 0..10 {
        through.window(2e-3, 1.0);
    }
    through.gas.checkpoint(folder.path()).unwrap();
    let mut resumed = duct_with_bed();
    resumed.gas.restore(folder.path()).unwrap();
    resumed.clocks = through.clocks;
    assert_eq!(resumed.bits(), through.bits());
    for _ in 0..10 {
        // An attempt that is not committed leaves nothing.
        resumed.attempt(2e-3, 1.0);
        through.window(2e-3, 1.0);
        resumed.window(2e-3, 1.0);
        assert_eq!(resumed.bits(), through.bits());
    }
}

#[test]
fn a_run_goes_on_with_the_eddies_of_another() {
    let folder = tempfile::tempdir().unwrap();
    let mut first = duct_with_bed();
    for _ in 0..50 {
        first.window(2e-3, 1.0);
    }
    first.gas.checkpoint(folder.path()).unwrap();
    let mut second = duct_with_bed();
    second.gas.take_over(folder.path()).unwrap();
    second.attempt(2e-3, 1.0);
    let (before, after) = (first.gas.fields(), second.gas.fields());
    assert_eq!(before.turbulence.energy, after.turbulence.energy);
    assert_eq!(before.turbulence.dissipation, after.turbulence.dissipation);
}

#[test]
fn the_steady_eddies_do_not_depend_on_the_pace_of_the_process_clock() {
    let slow = Channel::new(8, 30, 1.0, 120);
    let fast = Channel::new(8, 30, 678.0, 120);
    let energy = |channel: &Channel| channel.driver.gas.fields().turbulence.energy.to_vec();
    let (slow, fast) = (energy(&slow), energy(&fast));
    let worst = slow.iter().zip(&fast).map(|(a, b)| (a / b - 1.0).abs());
    let worst = worst.fold(0.0, f64::max);
    println!("AF 1 and 678: k within {worst:.1e}");
    assert!(worst < 1e-6);
}

#[test]
fn an_inlet_without_eddies_is_refused() {
    let mut setup = setup(&[
        ("side", slip()),
        ("bottom", inlet(1.0, 300.0)),
        ("top", outlet()),
    ]);
    setup.turbulence = k_epsilon(0.1, 1e-3);
    let error = NativeGas::new(duct([0.1; 3], [1, 1, 2]), &setup).unwrap_err();
    assert!(
        error.to_string().contains("says nothing of its eddies"),
        "{error}"
    );
}
