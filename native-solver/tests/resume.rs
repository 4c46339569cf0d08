//! Checkpoints and failures of the native parts.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)]

use std::f64::consts::PI;
use std::time::Duration;

use calcine_coupler::error::FailureKind;
use calcine_coupler::part::{
    Bed as VoidFractions, CellReceived, Gas, Part, ParticlePush, ParticleReceived, Particles,
};
use calcine_coupler::physics::Vec3;
use calcine_coupler::setup::{ParticleSetup, TimeScheme};
use calcine_coupler::supervisor::{Interrupts, Supervisor};
use calcine_coupler::time::{Clocks, Ticks, Window};
use calcine_native::gas::{NativeError, NativeGas};
use calcine_native::particles::NativeParticles;

use crate::common::*;

fn patches() -> [(&'static str, calcine_coupler::setup::GasPatch); 3] {
    [
        ("bottom", inlet(0.5, 400.0)),
        ("top", outlet()),
        ("side", slip()),
    ]
}

fn column() -> Driver {
    column_by(TimeScheme::ImplicitEuler)
}

fn column_by(scheme: TimeScheme) -> Driver {
    let mut setup = setup(&patches());
    setup.controls.time_scheme = scheme;
    let mut driver = Driver::new(&duct([0.01, 0.01, 0.12], [1, 1, 12]), &setup);
    for cell in 1..11 {
        driver.bed.void_fraction[cell] = 0.476;
        driver.exchange.drag_coefficient[cell] = 1e-5;
        driver.exchange.heat_coefficient[cell] = 0.01;
        driver.exchange.heat_source[cell] = 3.0;
    }
    driver
}

#[test]
fn a_checkpoint_changes_nothing_and_a_resumed_gas_goes_on_alike() {
    for (scheme, factor) in [(TimeScheme::ImplicitEuler, 50.0), (TimeScheme::Sdirk2, 1.0)] {
        let folder = tempfile::tempdir().unwrap();
        let new = || column_by(scheme);
        let (mut alone, mut through, mut resumed) = (new(), new(), new());
        for _ in 0..20 {
            alone.window(1e-3, factor);
            through.window(1e-3, factor);
        }
        // An attempt without a commit leaves no trace either.
        through.attempt(1e-3, factor);
        through.gas.checkpoint(folder.path()).unwrap();
        resumed.gas.restore(folder.path()).unwrap();
        resumed.clocks = through.clocks;
        assert_eq!(resumed.bits(), alone.bits());
        for _ in 0..20 {
            for column in [&mut alone, &mut through, &mut resumed] {
                column.window(1e-3, factor);
            }
            for other in [&through, &resumed] {
                assert_eq!(other.bits(), alone.bits());
                assert_eq!(other.received, alone.received);
            }
        }
    }
}

#[test]
fn a_checkpoint_before_the_first_window_is_taken_up_too() {
    let folder = tempfile::tempdir().unwrap();
    let mut gas = column();
    gas.attempt(1e-3, 1.0);
    gas.gas.checkpoint(folder.path()).unwrap();
    let mut resumed = column();
    resumed.gas.restore(folder.path()).unwrap();
    gas.window(1e-3, 1.0);
    resumed.window(1e-3, 1.0);
    assert_eq!(resumed.bits(), gas.bits());
}

#[test]
fn a_state_of_another_mesh_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut driver = column();
    driver.window(1e-3, 1.0);
    driver.gas.checkpoint(folder.path()).unwrap();
    let mesh = duct([0.01, 0.01, 0.12], [1, 1, 24]);
    let mut other = NativeGas::new(mesh, &setup(&patches())).unwrap();
    let text = other.restore(folder.path()).unwrap_err().to_string();
    assert!(text.contains("12 values, the run needs 24"), "{text}");
}

#[test]
fn divergence_is_said_with_field_number_cell_and_place() {
    let mut driver = column();
    driver.exchange.heat_source[7] = -1e6;
    let window = Window {
        span: Clocks {
            motion: Ticks::from_seconds(1e-3).unwrap(),
            process: Ticks::from_seconds(1e-3).unwrap(),
        },
        ..Window::default()
    };
    let supervisor = Supervisor::new(Duration::from_secs(1), Interrupts::default());
    driver
        .gas
        .start(&window, &driver.bed, &driver.exchange)
        .unwrap();
    let mut received = CellReceived::default();
    let error = driver.gas.finish(&supervisor, &mut received).unwrap_err();
    assert_eq!(error.kind, FailureKind::Diverged);
    let text = error.to_string();
    assert!(text.contains("temperature of -"), "{text}");
    assert!(
        text.contains("in cell 7 at (0.005000, 0.005000, 0.075000) m"),
        "{text}"
    );
}

#[test]
fn inputs_that_no_gas_can_take_are_refused_with_their_place() {
    let mut driver = column();
    driver.bed.void_fraction[3] = 0.0;
    let start = |driver: &mut Driver| {
        let (bed, exchange) = (driver.bed.clone(), driver.exchange.clone());
        driver
            .gas
            .start(&Window::default(), &bed, &exchange)
            .unwrap_err()
            .to_string()
    };
    let text = start(&mut driver);
    assert!(text.contains("void fraction of 0 in cell 3 at"), "{text}");
    driver.bed.void_fraction.pop();
    let text = start(&mut driver);
    assert!(
        text.contains("void fraction has 11 values for 12 cells"),
        "{text}"
    );
    let mut driver = column();
    driver.exchange.heat_coefficient[5] = f64::NAN;
    let text = start(&mut driver);
    assert!(text.contains("NaN W/K"), "{text}");
}

#[test]
fn setups_that_fit_no_mesh_are_refused_by_the_name_of_the_patch() {
    let mesh = duct([0.01, 0.01, 0.12], [1, 1, 12]);
    let refused = |patches: &[(&str, calcine_coupler::setup::GasPatch)]| {
        NativeGas::new(mesh.clone(), &setup(patches)).unwrap_err()
    };
    let [bottom, top, side] = patches();
    let error = refused(&[bottom.clone(), top.clone()]);
    assert!(matches!(error, NativeError::NoCondition { patch } if patch == "side"));
    let error = refused(&[bottom.clone(), top.clone(), side.clone(), ("lid", slip())]);
    assert!(error.to_string().contains("`gas.patch.lid`"), "{error}");
    let mut filled = setup(&[bottom, ("top", slip()), side.clone()]);
    filled.properties = water();
    let error = NativeGas::new(mesh.clone(), &filled).unwrap_err();
    assert!(matches!(error, NativeError::NoOutlet));
    let error = refused(&[("bottom", inlet(0.5, -3.0)), top, side]);
    let text = "the temperature of patch `bottom` is -3 K; it must be positive";
    assert_eq!(error.to_string(), text);
}

fn two_spheres() -> ParticleSetup {
    ParticleSetup {
        id: vec![1, 2],
        population: vec![0, 1],
        position: vec![Vec3::new(0.0, 0.0, 0.01), Vec3::new(0.0, 0.0, 0.02)],
        radius: vec![0.005, 0.0025],
        density: vec![2500.0, 1000.0],
        ..ParticleSetup::default()
    }
}

#[test]
fn frozen_particles_weigh_what_they_should_and_hand_the_impulse_to_their_support() {
    let mut particles = NativeParticles::new(&two_spheres()).unwrap();
    let mass = particles.fields().mass[0];
    assert!((mass / (2500.0 * PI * 0.01f64.powi(3) / 6.0) - 1.0).abs() < 1e-15);
    let window = Window {
        span: Clocks {
            motion: Ticks::from_seconds(2e-3).unwrap(),
            process: Ticks::from_seconds(0.1).unwrap(),
        },
        ..Window::default()
    };
    let push = ParticlePush {
        force: vec![Vec3::new(0.0, 0.0, 3.0), Vec3::new(1.0, 0.0, 0.0)],
        ..ParticlePush::default()
    };
    let supervisor = Supervisor::new(Duration::from_secs(1), Interrupts::default());
    let mut received = ParticleReceived::default();
    particles
        .start(&window, &VoidFractions::default(), &push)
        .unwrap();
    particles.finish(&supervisor, &mut received).unwrap();
    particles.commit().unwrap();
    assert_eq!(
        received.impulse,
        [push.force[0] * 2e-3, push.force[1] * 2e-3]
    );
    assert_eq!(particles.fields().velocity, [Vec3::zeros(); 2]);
    assert_eq!(particles.fields().position, two_spheres().position);
    assert!(particles.finish(&supervisor, &mut received).is_err());
}

#[test]
fn frozen_particles_come_back_from_a_checkpoint() {
    let folder = tempfile::tempdir().unwrap();
    let mut particles = NativeParticles::new(&two_spheres()).unwrap();
    particles.checkpoint(folder.path()).unwrap();
    let mut resumed = NativeParticles::new(&two_spheres()).unwrap();
    resumed.restore(folder.path()).unwrap();
    assert_eq!(resumed.fields().mass, particles.fields().mass);
    assert_eq!(resumed.fields().position, particles.fields().position);
    assert_eq!(resumed.fields().population, [0, 1]);
}

#[test]
fn particles_of_no_size_are_refused() {
    let flat = ParticleSetup {
        radius: vec![0.005, 0.0],
        ..two_spheres()
    };
    let text = NativeParticles::new(&flat).unwrap_err().to_string();
    assert_eq!(text, "the radius of particle 2 is 0 m; it must be positive");
}
