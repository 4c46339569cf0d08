//! Openings to surroundings at rest, and gas that comes back in through outlets (docs/theory.md, BND-1).
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine_coupler::boundary_value::{BoundaryQuantity, BoundaryValue};
use calcine_coupler::part::Gas;
use calcine_coupler::physics::Vec3;
use calcine_coupler::physics::gas::GasProperties;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{
    CompositionSchedule, Convection, GasPatch, PatchGas, Schedule, WallHeat,
};

use crate::common::*;

const GRAVITY: f64 = 9.81;

/// Gas of a temperature beyond a patch.
fn air_of(temperature: f64) -> PatchGas {
    PatchGas {
        temperature: Schedule::constant(temperature),
        composition: None,
    }
}

/// An opening to air of 300 K whose pressure is that of the atmosphere at the height of the origin.
fn opening() -> GasPatch {
    GasPatch::Opening {
        pressure: Schedule::constant(ATMOSPHERE),
        at: Vec3::zeros(),
        gas: air_of(300.0),
    }
}

/// A chimney of 1 m whose gas is held at 500 K, with a drag of k u a volume, steady.
fn chimney(drag: f64, convection: Convection) -> Driver {
    let cells = 20;
    let mesh = duct([0.1, 0.1, 1.0], [1, 1, cells]);
    let mut setup = setup(&[("bottom", opening()), ("top", opening()), ("side", slip())]);
    setup.gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    setup.temperature = 500.0;
    setup.controls.convection = convection;
    let mut driver = Driver::new(&mesh, &setup);
    driver.exchange.heat_coefficient.fill(1e8);
    driver.exchange.heat_source.fill(500e8);
    for (cell, volume) in mesh.cell_volume().iter().enumerate() {
        driver.exchange.drag_coefficient[cell] = drag * volume;
    }
    for _ in 0..300 {
        driver.window(0.1, 1.0);
    }
    assert!(driver.window(0.1, 1.0).converged);
    driver
}

/// Mass flux G in kg/m²/s of that chimney by the closed form
///
/// (ρ_c − ρ_h) g H = ½ ρ_c u_c² + G (u_h − u_c) + k u_h H,   G = ρ_c u_c = ρ_h u_h:
///
/// the draught accelerates air to its speed in the opening, expands it and drives it through.
fn draught(drag: f64) -> f64 {
    let [cold, hot] = [300.0, 500.0].map(|kelvin| AIR.density(ATMOSPHERE, kelvin));
    let square = 0.5 / cold + 1.0 / hot - 1.0 / cold;
    let linear = drag / hot;
    let push = (cold - hot) * GRAVITY;
    ((linear * linear + 4.0 * square * push).sqrt() - linear) / (2.0 * square)
}

#[test]
fn a_chimney_draws_what_its_draught_drives_through_its_resistance() {
    for convection in [Convection::Upwind, Convection::VanLeer] {
        for drag in [0.1, 2.0, 50.0] {
            let driver = chimney(drag, convection);
            let found = driver.gas.fields().velocity[10].z * AIR.density(ATMOSPHERE, 500.0);
            let exact = draught(drag);
            println!("k {drag}: {found} kg/m²/s, closed form {exact}");
            assert!((found / exact - 1.0).abs() < 1e-6, "{found} {exact}");
        }
    }
}

#[test]
fn a_chimney_in_air_as_warm_as_its_own_stops() {
    let mut driver = chimney(2.0, Convection::Upwind);
    for patch in ["bottom", "top"] {
        let value = BoundaryValue {
            patch: patch.into(),
            quantity: BoundaryQuantity::Temperature(500.0),
        };
        driver.gas.set_boundary(&value).unwrap();
    }
    for _ in 0..300 {
        driver.window(0.1, 1.0);
    }
    let fields = driver.gas.fields();
    let fastest = fields.velocity.iter().map(|u| u.norm()).fold(0.0, f64::max);
    assert!(fastest < 1e-8, "{fastest} m/s");
}

#[test]
fn still_air_in_a_box_with_openings_at_any_height_stays_at_rest() {
    let patches = ["west", "side", "side", "side", "side", "top"];
    let mesh = named_box([0.2, 0.1, 0.3], [4, 2, 6], patches);
    let elsewhere = GasPatch::Opening {
        pressure: Schedule::constant(ATMOSPHERE - AIR.density(ATMOSPHERE, 300.0) * GRAVITY * 0.3),
        at: Vec3::new(7.0, 0.0, 0.3),
        gas: air_of(300.0),
    };
    let mut setup = setup(&[("west", opening()), ("side", no_slip()), ("top", elsewhere)]);
    setup.gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    setup.controls.linear_tolerance = Some(1e-14);
    let mut driver = Driver::new(&mesh, &setup);
    for (cell, share) in scatter(mesh.cells(), 3).into_iter().enumerate() {
        driver.bed.void_fraction[cell] = 0.4 + 0.6 * share;
    }
    let mut fastest = 0.0_f64;
    for _ in 0..20 {
        driver.window(0.05, 10.0);
        let speeds = driver.gas.fields().velocity.iter().map(|u| u.norm());
        fastest = speeds.fold(fastest, f64::max);
    }
    println!("fastest {fastest:.1e} m/s");
    assert!(fastest < 1e-10, "{fastest:.1e}");
}

#[test]
fn a_heated_box_draws_in_what_leaves_it() {
    let patches = ["west", "east", "side", "side", "floor", "top"];
    let mesh = named_box([0.2, 0.02, 0.2], [10, 1, 10], patches);
    let mut setup = setup(&[
        ("west", opening()),
        ("east", opening()),
        ("side", slip()),
        ("floor", wall(WallHeat::Flux(Schedule::constant(500.0)))),
        ("top", opening()),
    ]);
    setup.gravity = Vec3::new(0.0, 0.0, -GRAVITY);
    // So viscous that the plume is steady.
    setup.properties = GasProperties {
        sutherland_coefficient: 50.0 * AIR.sutherland_coefficient,
        ..AIR
    }
    .into();
    let mut driver = Driver::new(&mesh, &setup);
    for _ in 0..300 {
        driver.window(0.05, 1.0);
    }
    let received = &driver.received;
    let (net, passing) = (received.mass.boundary, received.mass.boundary_magnitude);
    let fields = driver.gas.fields();
    let fastest = fields.velocity.iter().map(|u| u.norm()).fold(0.0, f64::max);
    let coldest = fields.temperature.iter().copied().fold(f64::MAX, f64::min);
    println!(
        "{net:.1e} kg of {passing:.2e} kg stay; fastest {fastest:.3} m/s, coldest {coldest:.3} K, energy {:.1e}",
        closure(&received.energy)
    );
    assert!(net.abs() < 1e-8 * passing, "{net} of {passing}");
    assert!(fastest > 0.05 && coldest > 300.0 - 1e-9);
    assert!(closure(&received.energy) < 1e-11);
    assert!(driver.gas.backflow().is_none());
}

/// A duct with an outlet at each end, the upper one of more pressure.
fn drawn_in(backflow: Option<PatchGas>) -> Driver {
    let top = GasPatch::Outlet {
        pressure: Schedule::constant(ATMOSPHERE + 2.0),
        backflow,
    };
    let mesh = duct([0.01, 0.01, 0.1], [1, 1, 10]);
    let mut setup = setup(&[("bottom", outlet()), ("top", top), ("side", slip())]);
    setup.properties = GasModel::Mixture(Mixture::new(["N2", "CO2"]).unwrap());
    setup.composition = vec![1.0, 0.0];
    let mut driver = Driver::new(&mesh, &setup);
    // 10 Pa s/m over the duct: 0.2 m/s.
    driver.exchange.drag_coefficient.fill(1e-4);
    for _ in 0..400 {
        driver.window(0.05, 1.0);
    }
    driver
}

#[test]
fn gas_that_comes_back_in_through_an_outlet_is_that_of_its_backflow() {
    let driver = drawn_in(Some(PatchGas {
        temperature: Schedule::constant(450.0),
        composition: Some(CompositionSchedule(vec![(0.0, vec![0.25, 0.75])])),
    }));
    let fields = driver.gas.fields();
    assert!(fields.velocity[5].z < -0.01);
    assert!(fields.temperature.iter().all(|t| (t - 450.0).abs() < 1e-7));
    let fractions = fields.composition.chunks(2);
    assert!(fractions.clone().all(|one| (one[1] - 0.75).abs() < 1e-10));
    assert!(driver.gas.backflow().is_none());
    for species in &driver.received.species {
        assert!(closure(species) < 1e-11);
    }
}

#[test]
fn gas_that_comes_back_in_as_that_of_the_cell_is_told() {
    let driver = drawn_in(None);
    let fields = driver.gas.fields();
    assert!(fields.temperature.iter().all(|t| (t - 300.0).abs() < 1e-7));
    let told = driver.gas.backflow().unwrap();
    assert_eq!((told.faces, told.cell), (1, 9));
    assert!((told.velocity / -fields.velocity[9].z - 1.0).abs() < 1e-6);
}
