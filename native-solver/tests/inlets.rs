//! What enters through inlets (docs/theory.md, BND-1): exactly what the case says at any cell Péclet number, and inside
//! the profile of Danckwerts' inlet. With OpenFOAM: `adapters/tests/openfoam_inlets.rs`.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

use calcine_coupler::part::Gas;
use calcine_coupler::physics::gas_model::GasModel;
use calcine_coupler::physics::thermo::Mixture;
use calcine_coupler::setup::{
    CompositionSchedule, Convection, GasPatch, InletFlow, InletScalars, Schedule,
};

use crate::common::*;

/// Height of a cell in m; each is a cube.
const HEIGHT: f64 = 0.01;
/// Mass fractions of CH4 and N2 of the gas that flows at 400 K into a duct of nitrogen of 300 K.
const FUEL: [f64; 2] = [0.3, 0.7];

/// The duct at a Péclet number u h/D of its cells, D = μ/(ρ Sc) of the inlet's gas, and the velocity of its inlet in m/s.
fn fuelled(peclet: f64, scalars: InletScalars, convection: Convection) -> (Driver, GasModel, f64) {
    let gas = GasModel::Mixture(Mixture::new(["CH4", "N2"]).unwrap());
    let diffusivity = gas.viscosity(400.0, &FUEL) / 0.7 / gas.density(ATMOSPHERE, 400.0, &FUEL);
    let velocity = peclet * diffusivity / HEIGHT;
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(velocity)),
        temperature: Schedule::constant(400.0),
        composition: Some(CompositionSchedule(vec![(0.0, FUEL.to_vec())])),
        turbulence: None,
        scalars,
    };
    let mut setup = setup(&[("bottom", bottom), ("top", outlet()), ("side", slip())]);
    setup.properties = gas.clone();
    setup.composition = vec![0.0, 1.0];
    setup.schmidt = 0.7;
    setup.controls.convection = convection;
    setup.controls.linear_tolerance = Some(1e-14);
    let mesh = duct([HEIGHT, HEIGHT, 12.0 * HEIGHT], [1, 1, 12]);
    (Driver::new(&mesh, &setup), gas, velocity)
}

/// Fuel and enthalpy that entered over a window, over what the case says: what the cells stored and what left with the gas
/// of the last cell.
fn entered(driver: &Driver, gas: &GasModel, velocity: f64, span: f64) -> [f64; 2] {
    let area = HEIGHT * HEIGHT;
    let fed = gas.density(ATMOSPHERE, 400.0, &FUEL) * velocity * area * span;
    let left = fed - driver.received.mass.stored;
    let fields = driver.gas.fields();
    let last = &fields.composition[22..];
    let fuel = driver.received.species[0].stored + left * last[0];
    let heat = driver.received.energy.stored + left * gas.enthalpy(fields.temperature[11], last);
    [
        fuel / (fed * FUEL[0]),
        heat / (fed * gas.enthalpy(400.0, &FUEL)),
    ]
}

#[test]
fn what_enters_is_what_the_case_says_at_any_peclet_number() {
    let mut worst = 0.0_f64;
    for convection in [Convection::Upwind, Convection::VanLeer] {
        for peclet in [0.01, 1.0, 100.0] {
            let (mut driver, gas, velocity) = fuelled(peclet, InletScalars::Flux, convection);
            let span = HEIGHT / velocity;
            for _ in 0..20 {
                assert!(driver.window(span, 1.0).converged);
                for share in entered(&driver, &gas, velocity, span) {
                    worst = worst.max((share - 1.0).abs());
                }
            }
        }
    }
    println!("largest deviation {worst:.1e}");
    assert!(worst < 1e-10, "{worst:.1e}");
}

#[test]
fn an_inlet_that_holds_the_face_lets_species_and_heat_in_beside_the_flow() {
    let (mut driver, gas, velocity) = fuelled(0.01, InletScalars::Value, Convection::Upwind);
    let span = HEIGHT / velocity;
    driver.window(span, 1.0);
    let [fuel, heat] = entered(&driver, &gas, velocity, span);
    println!("fuel {fuel:.2}, heat {heat:.2} of what flows in");
    assert!(fuel > 2.0 && heat > 2.0, "{fuel} {heat}");
}

#[test]
fn an_inlet_without_flow_is_closed_to_species_and_heat() {
    let (mut driver, ..) = fuelled(0.0, InletScalars::Flux, Convection::VanLeer);
    for _ in 0..5 {
        driver.window(1.0, 1.0);
    }
    let fields = driver.gas.fields();
    assert!(fields.composition.chunks(2).all(|one| one[0].abs() < 1e-14));
    assert!(fields.temperature.iter().all(|t| (t - 300.0).abs() < 1e-10));
}

/// C/C_in of Danckwerts' reactor with axial dispersion at x = z/L (Chem. Eng. Sci. 2 (1953) 1, doi
/// 10.1016/0009-2509(53)80001-1): C″/Pe − C′ − Da C = 0, C − C′/Pe = 1 at 0, C′ = 0 at 1.
fn danckwerts(peclet: f64, damkoehler: f64, x: f64) -> f64 {
    let a = (1.0 + 4.0 * damkoehler / peclet).sqrt();
    let up = (0.5 * peclet * (1.0 + a), 0.5 * peclet * (1.0 - a));
    // C = (r₂ e^(r₂ + r₁ x) − r₁ e^(r₁ + r₂ x))/N, from the condition at 1; N from that at 0.
    let shape = |x: f64| up.1 * (up.1 + up.0 * x).exp() - up.0 * (up.0 + up.1 * x).exp();
    let slope = up.0 * up.1 * (up.1.exp() - up.0.exp());
    shape(x) / (shape(0.0) - slope / peclet)
}

#[test]
fn the_closed_form_is_danckwerts_at_the_outlet() {
    for (peclet, damkoehler) in [(0.5, 2.0), (5.0, 2.0), (20.0, 0.3)] {
        let a = f64::sqrt(1.0 + 4.0 * damkoehler / peclet);
        let up = (1.0 + a).powi(2) * (0.5 * a * peclet).exp();
        let down = (1.0 - a).powi(2) * (-0.5 * a * peclet).exp();
        let outlet = 4.0 * a * (0.5 * peclet).exp() / (up - down);
        assert!((danckwerts(peclet, damkoehler, 1.0) / outlet - 1.0).abs() < 1e-12);
    }
}

/// Mass fractions of a trace of carbon monoxide in nitrogen.
const TRACE: [f64; 2] = [1e-6, 1.0 - 1e-6];

/// Root mean square error of C/C_in in a reactor of so many cells, from which the particles of each cell take the trace by
/// a reaction of first order.
fn reactor_error(peclet: f64, damkoehler: f64, cells: usize) -> f64 {
    let gas = GasModel::Mixture(Mixture::new(["CO", "N2"]).unwrap());
    let bottom = GasPatch::Inlet {
        flow: InletFlow::SuperficialVelocity(Schedule::constant(1.0)),
        temperature: Schedule::constant(300.0),
        composition: Some(CompositionSchedule(vec![(0.0, TRACE.to_vec())])),
        turbulence: None,
        scalars: InletScalars::Flux,
    };
    let mut setup = setup(&[("bottom", bottom), ("top", outlet()), ("side", slip())]);
    let density = gas.density(ATMOSPHERE, 300.0, &TRACE);
    setup.schmidt = gas.viscosity(300.0, &TRACE) * peclet / density;
    setup.composition = TRACE.to_vec();
    setup.properties = gas;
    setup.controls.convection = Convection::VanLeer;
    setup.controls.linear_tolerance = Some(1e-14);
    let mesh = duct([0.1, 0.1, 1.0], [1, 1, cells]);
    let mut driver = Driver::new(&mesh, &setup);
    driver.exchange.species.reset(cells, 2);
    for cell in 0..cells {
        driver.exchange.species.coefficient[2 * cell] =
            damkoehler * density * mesh.cell_volume()[cell];
    }
    for _ in 0..40 {
        driver.window(1.0, 1e3);
    }
    let found = driver.gas.fields().composition;
    rms(&mesh, |cell| {
        let x = mesh.cell_centre()[cell].z;
        found[2 * cell] / TRACE[0] - danckwerts(peclet, damkoehler, x)
    })
}

#[test]
fn a_reactor_with_axial_dispersion_follows_danckwerts_with_second_order() {
    for (peclet, damkoehler) in [(0.5, 2.0), (5.0, 2.0), (20.0, 1.0)] {
        let errors = [10, 20, 40].map(|cells| reactor_error(peclet, damkoehler, cells));
        let found = orders(&errors);
        println!("Pe {peclet}, Da {damkoehler}: errors {errors:?}, orders {found:?}");
        assert!((1.9..2.3).contains(&found[1]), "{found:?}");
        assert!(errors[2] < 1e-3, "{errors:?}");
    }
}
